"""A real server keeps to its OpenAPI document: all checks of schemathesis, each of its phases for a while."""

import subprocess
import sys

import pytest

# At most, of a phase; one limit for all would be used up by the first. All examples are made first.
SECONDS = {"examples": 100, "coverage": 12, "fuzzing": 12, "stateful": 12}


@pytest.mark.parametrize("phase", SECONDS)
def test_fuzzing_finds_nothing(server, tmp_path, phase):
    command = [sys.executable, "-m", "schemathesis.cli", "run", f"{server.url}/openapi.json", "--checks", "all"]
    command += ["--phases", phase, "--max-time", str(SECONDS[phase]), "--max-response-time", "60"]
    command += ["--seed", "7", "--no-color"]
    if phase == "stateful":  # which sends an idempotency key again with another body: that is refused
        command += ["--exclude-checks", "positive_data_acceptance"]
    report = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=240)
    assert report.returncode == 0, report.stdout[-6000:] + report.stderr[-2000:]
    assert f"✅ {phase.capitalize()}" in report.stdout, report.stdout[-2000:]
    assert '"status": 500' not in server.log.read_text()
