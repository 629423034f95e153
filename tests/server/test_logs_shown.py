"""A test that fails shows the logs of its servers: of one that fails once in thousands there is no second look."""

import subprocess
import sys
from pathlib import Path

CONFTEST = "from tests.server.conftest import pytest_runtest_makereport  # as the tests of servers have it\n"
FAILING = """
def test_that_fails(tmp_path):
    (tmp_path / "data").mkdir()
    (tmp_path / "data/server.log").write_text("a long story\\n" * 1000 + "how it ended")
    assert False
"""


def test_a_failure_shows_the_end_of_the_logs(tmp_path):
    (tmp_path / "conftest.py").write_text(CONFTEST)
    (tmp_path / "test_one.py").write_text(FAILING)
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", f"--rootdir={tmp_path}", str(tmp_path)]
    ran = subprocess.run(command, cwd=Path(__file__).parents[2], capture_output=True, text=True, timeout=240)
    assert ran.returncode == 1, ran.stdout + ran.stderr
    assert "data/server.log" in ran.stdout and "how it ended" in ran.stdout
    assert 300 < ran.stdout.count("a long story") < 600
