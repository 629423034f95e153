"""Values printed in papers and closed forms."""

import re

import numpy as np
import pytest

import wsrender as ws
from wsrender.robots import library

# Zhang, Cursi, Yang, WSRender, IEEE RA-L 4(4), 2019, Table III; more digits from the authors' program.
PHANTOM_OMNI = {
    "manipulability": (0.553439, 1e-6),
    "inverse_condition_number": (0.524011, 1e-6),
    "minimum_singular_value": (0.525039, 1e-6),
    # The program's determinant is not exactly 0 where the elbow is straight, and its sixth root is large.
    "order_independent_manipulability": (0.8548, 3e-4),
    "harmonic_mean_manipulability": (0.273304, 1e-6),
    "isotropy": (0.8602, 3e-4),
}
PROGRAM = {"convention": "wsrender_code", "precision": "float64", "device": "cpu"}


def test_table_3_of_the_phantom_omni():
    sampling = ws.Grid(60, locked={"joint4": 0.0, "joint5": np.pi / 2, "joint6": 0.0})
    result = ws.analyze("phantom_omni", sampling, voxel_size_m=0.01, **PROGRAM)
    assert result.document["sampling"]["samples"] == 60**3
    found = result.global_indices["joint_mean"]
    wrong = {name: found[name] for name, (value, width) in PHANTOM_OMNI.items() if abs(found[name] - value) > width}
    assert not wrong


def test_dynamic_harmonic_mean_of_the_puma_560(tmp_path):
    """G11: the library's robot with the limits of the paper, ±180°."""
    text = re.sub(r'range="[^"]*"', 'range="-180 180"', library.find("puma560").read_text(encoding="utf-8"))
    (tmp_path / "puma560.xml").write_text(text, encoding="utf-8")
    robot = ws.load_robot(tmp_path / "puma560.xml")
    sampling = ws.Grid(60, locked={"joint4": 0.0, "joint5": 0.0, "joint6": 0.0})
    index = "dynamic_harmonic_mean_manipulability"
    result = ws.analyze(robot, sampling, [index], voxel_size_m=0.05, **PROGRAM)
    assert result.global_indices["joint_mean"][index] == pytest.approx(0.634255176, abs=5e-9)


def planar(l1, l2):
    rows = [ws.DHRow(a=l1), ws.DHRow(a=l2)]
    return ws.load_robot(ws.DHTable(convention="standard", rows=rows))


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize(
    ("lengths", "degrees", "condition"),
    [((0.3, 0.3), 131.8103149, 1.618033988750), ((0.3 * np.sqrt(2), 0.3), 135.0, 1.0)],
    ids=["equal links: golden ratio", "isotropic"],
)
def test_best_condition_of_a_2r_arm(lengths, degrees, condition, sign):
    """Salisbury & Craig 1982: isotropic at 135° for l1 = √2 l2."""
    robot = planar(*lengths)
    turns = sign * np.radians(degrees) + np.array([0.0, -0.01, 0.01])
    q = np.column_stack([np.full(3, 0.7), turns])
    inverse = ws.evaluate_indices(robot, q, ["inverse_condition_number"], ["x", "y"], device="cpu")
    best, below, above = inverse["inverse_condition_number"]
    assert 1.0 / best == pytest.approx(condition, abs=1e-12 if condition > 1 else 1e-9)
    assert best > max(below, above)
