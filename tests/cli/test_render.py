"""``wsrender render`` on a saved folder: what it passes on, and what it refuses."""

import numpy as np
import pytest

import wsrender as ws
from tests.results.export.sample_data import random_map, random_volume
from wsrender import cli
from wsrender.results.render import Box, Floor, Table, composition


@pytest.fixture
def folder(tmp_path):
    document = {"analysis": "workspace", "robot": {"name": "arm"}}
    volume = random_volume((6, 5, 4), names=("manipulability",))
    ws.Result(document, sample=random_map(50, names=("manipulability",)), volume=volume).save(tmp_path / "out")
    return tmp_path / "out"


@pytest.fixture
def wsrender(capsys, monkeypatch):
    """Run the command line without OpenGL: exit code, output, error."""
    monkeypatch.setattr(composition, "drawn", lambda scene: np.zeros((*scene.size[::-1], 3), np.uint8))

    def run(*arguments):
        with pytest.raises(SystemExit) as ended:
            cli.main(["render", *map(str, arguments)])
        written = capsys.readouterr()
        return ended.value.code, written.out, written.err

    return run


def test_a_picture_is_written_and_named(wsrender, folder, tmp_path):
    path = tmp_path / "view.svg"
    assert wsrender(folder, "--with", folder, "--view", "slice", "-o", path) == (0, f"{path}\n", "")
    assert "arm 2" in path.read_text(encoding="utf-8")


def test_options_reach_the_picture(wsrender, folder, tmp_path, monkeypatch):
    seen = {}
    monkeypatch.setattr(ws.Result, "render", lambda self, view, path, **options: seen.update(options, view=view))
    wsrender(
        folder, "--view", "isosurface", "--threshold", 0.7, "--alpha", 0.2, "--index", "manipulability",
        "--statistic", "mean", "--x", 0.1, "--floor", -0.2, "--table", "0,0,.5,1,2", "--box=-1,0,0,1,1,1",
        "--azimuth", 30, "--elevation", 10, "--robot", "scara", "-o", tmp_path / "view.png",
    )  # fmt: skip
    assert seen == {
        "view": "isosurface", "threshold": 0.7, "alpha": 0.2, "index": "manipulability", "statistic": "mean",
        "at": (0.1, None, None), "azimuth_deg": 30, "elevation_deg": 10, "robot": "scara", "others": [],
        "environment": [Floor(-0.2), Table((0, 0, 0.5), (1, 2), -0.2), Box((-1, 0, 0), (1, 1, 1))],
    }  # fmt: skip


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--box", "1,2,3"), '--box: must be 6 numbers separated by commas, not "1,2,3"'),
        (("--table", "a,b,c,d,e"), '--table: must be 5 numbers separated by commas, not "a,b,c,d,e"'),
        (("-o", "view.bmp"), '--output: must end in .png or .svg, not "view.bmp"'),
        (("-o", "nowhere/view.png"), "--output: the folder nowhere does not exist"),
        (
            ("--view", "side"),
            "view: 'side' is not a view; allowed: boundary, solid, scatter, volume, slice, isosurface",
        ),
    ],
)
def test_wrong_options_are_named(wsrender, folder, options, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert wsrender(folder, *options) == (2, "", f"error: {message}\n")


def test_another_robot_is_refused(wsrender, tmp_path):
    robot = {"name": "arm", "model_hash": "0123456789abcdef", "chain_hash": "0"}
    volume = random_volume((6, 5, 4), names=("manipulability",))
    ws.Result({"analysis": "workspace", "robot": robot}, volume=volume).save(tmp_path / "out")
    code, _, error = wsrender(tmp_path / "out", "--robot", "scara", "-o", tmp_path / "view.png")
    assert code == 2 and not (tmp_path / "view.png").exists()
    assert error.startswith("error: robot: scara (model ") and "the result, arm (model 01234567)" in error
