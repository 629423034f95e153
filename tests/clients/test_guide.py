"""The guide on clients: its requests, typed into a shell."""

import json
import shutil
import subprocess

import pytest
from wsrender_server.local_server import LocalServer

from tests.snippets import CLONE, blocks

PATIENCE_S = 200


def test_the_whole_of_it(tmp_path):
    if shutil.which("curl") is None:
        pytest.skip("needs curl")
    (typed,) = blocks((CLONE / "docs" / "guides" / "clients.md").read_text(encoding="utf-8"), "sh")
    with LocalServer(tmp_path / "data") as server:
        assert typed.count("localhost:8000") == 3
        typed = typed.replace("localhost:8000", server.url.removeprefix("http://"))
        done = subprocess.run(
            ["bash", "-euo", "pipefail", "-c", typed],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            timeout=PATIENCE_S,
            check=True,
        )
    state, end = json.JSONDecoder().raw_decode(done.stdout)
    assert state["state"] == "succeeded"
    result = json.loads(done.stdout[end:])
    assert result["job"]["robot"]["library"] == "ur5e" and result["headline"]["unit"] == "m3"
