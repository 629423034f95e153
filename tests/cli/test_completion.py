"""What the shell offers for values, asked as bash asks it."""

import os
import subprocess
import sys

import pytest

import wsrender as ws
from wsrender.cli import completion
from wsrender.client.job import FINISHED
from wsrender.results.render import VIEWS
from wsrender.robots import library


def offered(line, folder="."):
    """Words that bash would offer at the end of a line."""
    words = line.split(" ")
    asked = {"_WSRENDER_COMPLETE": "complete_bash", "COMP_WORDS": line, "COMP_CWORD": str(len(words) - 1)}
    path = os.pathsep.join(each for each in sys.path if each)
    run = subprocess.run(
        [sys.executable, "-m", "wsrender"], env={**os.environ, **asked, "PYTHONPATH": path}, cwd=folder,
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert run.stderr == ""
    return run.stdout.split()


def test_the_shell_is_offered_robots_and_files(tmp_path):
    for name in ("arm.urdf", "ur_job.json", "notes.txt"):
        (tmp_path / name).touch()
    (tmp_path / "ur_models").mkdir()
    robots = [name for name in library.names() if name.startswith("ur")]
    assert "ur5e" in robots
    assert offered("wsrender run ur", tmp_path) == [*robots, "ur_models/", "ur_job.json"]


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("wsrender run ur5e --sampling b", ["boundary"]),
        ("wsrender run ur5e --indices kin", ["kinematic"]),
        ("wsrender submit ur5e --precision f", ["float32", "float64"]),
        ("wsrender render out --view s", ["solid", "scatter", "slice"]),
        ("wsrender jobs list --state q", ["queued"]),
        ("wsrender reproduce ga", ["gao"]),
    ],
)
def test_the_shell_is_offered_values(line, words):
    assert offered(line) == words


def test_every_value_is_one_that_is_taken():
    assert tuple(VIEWS) == completion.VIEWS
    assert set(FINISHED) < set(completion.STATES)
    assert set(library.names()) <= set(completion.job(""))
    offered_indices = completion.indices("manipulability,")
    assert "manipulability,manipulability" not in offered_indices
    ws.evaluate_indices("ur5e", [0.1] * 6, [each.partition(",")[2] for each in offered_indices][:8])
