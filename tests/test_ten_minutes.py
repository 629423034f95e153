"""The first ten minutes of newcomers, typed as the page has them, in the environment of the tests; and its claims.

`python tests/ten_minutes.py` does so in a fresh environment, and with robots of others.
"""

import os
import re
import sys
from pathlib import Path

import numpy as np
import pytest

import wsrender as ws
from tests import ten_minutes
from tests.ten_minutes import CELL, CLONE, MATLAB, MECHANISM, part_of

# A welding arm's lengths, by hand: base to shoulder, upper arm, forearm, wrist, flange [m].
OFFSETS = [(0, 0, 0.3), (0.15, 0, 0.2), (0, 0, 0.6), (0.3, 0, 0.12), (0.35, 0, 0), (0.09, 0, 0)]
AXES = ["0 0 1", "0 1 0", "0 1 0", "1 0 0", "0 1 0", "1 0 0"]


@pytest.fixture
def arm(tmp_path):
    """A URDF as a newcomer has one, with meshes that are not there."""
    lines = ['<robot name="welder"><link name="base_link"/>']
    mesh = '<collision><geometry><mesh filename="package://welder/meshes/link.stl"/></geometry></collision>'
    for k, (offset, axis) in enumerate(zip(OFFSETS, AXES, strict=True), start=1):
        lines.append(f'<link name="link_{k}">{mesh}</link><joint name="joint_{k}" type="revolute">')
        lines.append(f'<parent link="{f"link_{k - 1}" if k > 1 else "base_link"}"/><child link="link_{k}"/>')
        lines.append(f'<origin xyz="{" ".join(map(str, offset))}"/><axis xyz="{axis}"/>')
        lines.append('<limit lower="-2.5" upper="2.5" effort="100" velocity="3"/></joint>')
    lines.append('<link name="tool0"/><joint name="flange" type="fixed"><parent link="link_6"/><child link="tool0"/>')
    path = tmp_path / "welder.urdf"
    path.write_text("".join([*lines, '<origin xyz="0.1 0 0"/></joint></robot>']), encoding="utf-8")
    return path


def spent(part, folder, urdf=None):
    """What is printed; as the fresh environment, but with this one's packages, kernels and tables."""
    also = {name: os.environ[name] for name in ("WARP_CACHE_PATH", "WSRENDER_CACHE_DIR") if name in os.environ}
    path = os.pathsep.join(str(CLONE / each) for each in ("", "kernels", "server"))
    typed = folder / "typed"
    typed.mkdir()
    return ten_minutes.spend(
        part, Path(sys.executable).parent, typed, urdf, {"PYTHONPATH": path, **also}
    ), typed / "here"


def test_from_matlab_with_a_urdf(tmp_path, arm):
    printed, here = spent(MATLAB, tmp_path, arm)
    assert "<Robot welder: 6 joints, world to tool0>" in printed and "['reachable']" in printed
    assert int(re.findall(r"(\d+) postures", printed)[0]) >= 1
    volumes = re.findall(r"reachable volume ([\d.]+) m³ \(95 %: ([\d.]+) … ([\d.]+)\)", printed)
    (first, *_), (last, low, high) = ([float(number) for number in each] for each in volumes)
    assert low <= last <= high and first == pytest.approx(last, rel=0.03)
    for path in ("first_look/result.json", "slice.png", "out/volume.mat", "out/result.json"):
        assert (here / path).stat().st_size > 1000
    found = ws.Result.load(here / "out").document["headline"]
    reach = sum(np.linalg.norm(offset) for offset in OFFSETS[1:]) + 0.1
    assert 0.2 * 4 / 3 * np.pi * reach**3 < found["value"] < 4 / 3 * np.pi * reach**3


def test_with_a_parallel_mechanism(tmp_path):
    printed, here = spent(MECHANISM, tmp_path)
    volume = float(re.findall(r"reachable volume ([\d.]+) m³ \(exact\)", printed)[0])
    assert volume == pytest.approx(*by_counting())
    assert printed.count("[[0.1  0.35]]") == 1
    for name in ("level.png", "moves.png"):
        assert (here / name).read_bytes().startswith(b"\x89PNG")


def by_counting():
    """The volume of the page's hexapod by random points whose legs are within their lengths, and its error."""
    base, platform = np.deg2rad([-15, 15, 105, 135, 225, 255]), np.deg2rad([45, 75, 165, 195, 285, 315])
    on = [r * np.stack([np.cos(a), np.sin(a), 0 * a], axis=1) for r, a in ((0.4, base), (0.25, platform))]
    # Neighbours of a joint of the base are those of the platform that are nearest by angle.
    nearest = np.argmin(np.abs((base[:, None] - platform + np.pi) % (2 * np.pi) - np.pi), axis=1)
    points = np.random.default_rng(0).uniform([-0.4, -0.4, 0.3], [0.4, 0.4, 0.65], (400_000, 3))
    legs = np.linalg.norm(points[:, None] + on[1][nearest] - on[0], axis=2)
    inside = ((legs > 0.45) & (legs < 0.65)).all(axis=1).mean()
    box = 0.8 * 0.8 * 0.35
    return box * inside, None, 4 * box * np.sqrt(inside / len(points))


def test_with_a_cell_and_ten_targets(tmp_path):
    printed, here = spent(CELL, tmp_path)
    labels = dict(re.findall(r"^(.{20})(\w+)", printed, flags=re.MULTILINE)[:10])
    labels = {name.strip(): label for name, label in labels.items()}
    assert len(labels) == 10
    assert {name for name, label in labels.items() if label == "blocked"} == {"part in the bin", "behind the wall"}
    assert {name for name, label in labels.items() if label == "unreachable"} == {"far shelf"}
    words, text = {"Seven": 7, "Two": 2, "eight": 8}, part_of("ten_minutes.md", CELL)
    said = {noun: words[count] for count, noun in re.findall(r"\b(Seven|Two) are \*?(\w+)", text)}
    assert said == {"reached": list(labels.values()).count("reachable"), "blocked": 2}
    (served,) = re.findall(r"It serves (\w+)\.", text)
    assert f"{words[served]} served" in printed
    assert ws.Result.load(here / "out").tables["targets"]["proven"][list(labels).index("far shelf")]
    for name in ("targets.png", "places.png"):
        assert (here / name).read_bytes().startswith(b"\x89PNG")


def test_robots_of_others_are_where_they_are_said_to_be():
    pytest.importorskip("rtbdata", reason="needs the extra test-models")
    pytest.importorskip("pybullet_data", reason="needs the extra test-models")
    for name in ten_minutes.URDFS:
        assert ten_minutes.urdf_of(name).is_file()


def test_what_has_not_ended_in_ten_minutes_is_told(monkeypatch):
    """As a part that took too long, not as a fault of the long run."""
    monkeypatch.setattr(ten_minutes, "LONGEST_S", 0.01)
    monkeypatch.setattr(ten_minutes, "_fresh", lambda: Path(sys.executable).parent)
    found = ten_minutes.PARTS["mechanism"]()
    assert found["lines"] is None and found["seconds"] >= 0 and found["cpu_seconds"] >= 0
    monkeypatch.undo()
    (told,) = ten_minutes.violations({"mechanism": found, "cell": {"seconds": 599.0, "cpu_seconds": 9.0, "lines": 3}})
    assert told.startswith("mechanism: ")
