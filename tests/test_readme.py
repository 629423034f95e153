"""What the README shows works as it is written."""

import re
from pathlib import Path

import wsrender as ws
from tests.snippets import CLONE, blocks, run
from wsrender.analyses.jobs import parse_job
from wsrender.analyses.registry import job_classes

README = (CLONE / "README.md").read_text(encoding="utf-8")


def test_python_example(tmp_path, monkeypatch, capsys):
    names = run(CLONE / "README.md", tmp_path, monkeypatch)
    assert "manipulability" in capsys.readouterr().out
    assert (tmp_path / "slice.png").read_bytes().startswith(b"\x89PNG")
    assert (tmp_path / "out" / "result.json").is_file()
    assert names["robot"].forward_kinematics([0, -1.5, 1.5, 0, 1, 0]).shape == (1, 4, 4)
    assert list(names["found"].labels) == ["reachable", "unreachable"]
    assert list(names["found"].reasons) == ["", "out of reach"]


def test_job_document():
    (example,) = blocks(README, "json")
    assert parse_job(example).robot.library == "phantom_omni"


def test_every_analysis_is_listed_with_its_function():
    listed = dict(re.findall(r"^\| `(\w+)` \| `ws\.(\w+)`", README, flags=re.MULTILINE))
    assert listed.keys() == job_classes().keys()
    assert set(listed.values()) <= set(ws.__all__)


def test_the_output_table_lists_the_files_of_a_result(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    ws.analyze("scara", sampling=ws.Grid(3), task=["x", "y"], voxel_size_m=0.05, keep_map=True).save("out")
    listed = set(re.findall(r"`([\w/.]+)`", README.split("## Reading the output")[1].split("\n\n")[1]))
    written = {path.name for path in Path("out").iterdir()}
    assert {name.strip("/") for name in listed} >= written
