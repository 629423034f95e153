"""A real server keeps to its OpenAPI document: all checks of schemathesis, each of its phases for a while."""

import os
import subprocess
import sys

import pytest

# At most, of a phase; one limit for all would be used up by the first. All examples are made first.
SECONDS = {"examples": 100, "coverage": 12, "fuzzing": 12, "stateful": 12}
# A part of a JSON document is no JSON, which the checks do not know: other tests ask for parts.
HOOKS = """
import schemathesis


@schemathesis.hook
def before_call(context, case, kwargs):
    for name in ("Range", "If-Range"):
        case.headers.pop(name, None)
"""


@pytest.mark.parametrize("phase", SECONDS)
def test_fuzzing_finds_nothing(server, tmp_path, phase):
    (tmp_path / "parts.py").write_text(HOOKS)
    known = os.environ | {"SCHEMATHESIS_HOOKS": "parts"}
    command = [sys.executable, "-m", "schemathesis.cli", "run", f"{server.url}/openapi.json", "--checks", "all"]
    command += ["--phases", phase, "--max-time", str(SECONDS[phase]), "--max-response-time", "60"]
    command += ["--seed", "7", "--no-color"]
    if phase == "stateful":  # which sends an idempotency key again with another body: that is refused
        command += ["--exclude-checks", "positive_data_acceptance"]
    report = subprocess.run(command, cwd=tmp_path, env=known, capture_output=True, text=True, timeout=240)
    assert report.returncode == 0, report.stdout[-6000:] + report.stderr[-2000:]
    assert f"✅ {phase.capitalize()}" in report.stdout, report.stdout[-2000:]
    assert '"status": 500' not in server.log.read_text()
