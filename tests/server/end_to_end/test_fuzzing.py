"""A real server keeps to its OpenAPI document: all checks and phases of schemathesis, in the time that a test has."""

import subprocess
import sys

SECONDS = 30


def test_fuzzing_finds_nothing(server, tmp_path):
    command = [sys.executable, "-m", "schemathesis.cli", "run", f"{server.url}/openapi.json", "--checks", "all"]
    command += ["--max-time", str(SECONDS), "--max-response-time", "60", "--seed", "7", "--no-color"]
    report = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=240)
    assert report.returncode == 0, report.stdout[-6000:] + report.stderr[-2000:]
    for phase in ("Examples", "Coverage", "Fuzzing", "Stateful"):
        assert f"✅ {phase}" in report.stdout
    assert '"status": 500' not in server.log.read_text()
