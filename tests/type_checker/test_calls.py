"""A type checker sees what is wrong in calls of the interface, and nothing in right ones."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import wsrender as ws

HERE = Path(__file__).parent
CALLS = 30
FIRST_WRONG = "# Each line below is wrong."


@pytest.mark.skipif(shutil.which("pyright") is None, reason="pyright is not installed: pip install pyright[nodejs]")
@pytest.mark.parametrize("calls", ["calls", "client_calls"])
def test_thirty_wrong_calls_are_reported_and_no_right_one(calls, tmp_path):
    right, wrong = ((HERE / f"{name}_{calls}.py").read_text() for name in ("right", "wrong"))
    lines = wrong.splitlines()
    expected = set(range(lines.index(FIRST_WRONG) + 2, len(lines) + 1))
    assert len(expected) == CALLS
    assert sum("(" in line and "import" not in line for line in right.splitlines()) >= CALLS
    for name, text in (("right", right), ("wrong", wrong)):
        (tmp_path / f"{name}.py").write_text(text)
    roots = Path(ws.__file__).parent.parent
    settings = {"extraPaths": [str(roots), str(roots / "kernels")], "typeCheckingMode": "standard"}
    (tmp_path / "pyrightconfig.json").write_text(json.dumps({"include": ["right.py", "wrong.py"], **settings}))
    command = ["pyright", "--outputjson", "--pythonpath", sys.executable, "-p", str(tmp_path)]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    found = json.loads(run.stdout)["generalDiagnostics"]
    reported = {(Path(each["file"]).stem, each["range"]["start"]["line"] + 1) for each in found}
    assert reported == {("wrong", line) for line in expected}, [each["message"] for each in found]
