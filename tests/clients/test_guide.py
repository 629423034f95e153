"""The guide on clients: its requests, typed into a shell."""

import json
import os
import shutil
import subprocess
from unittest.mock import patch

import pytest
from wsrender_server.local_server import LocalServer

from tests.snippets import CLONE, blocks

PATIENCE_S = 200


def typed(number, tmp_path, **variables):
    """What the shell says to a block of the page, before a server of its own."""
    if shutil.which("curl") is None:
        pytest.skip("needs curl")
    block = blocks((CLONE / "docs" / "guides" / "clients.md").read_text(encoding="utf-8"), "sh")[number]
    with patch.dict(os.environ, variables), LocalServer(tmp_path / "data") as server:
        here = block.replace("localhost:8000", server.url.removeprefix("http://"))
        assert here != block
        done = subprocess.run(
            ["bash", "-euo", "pipefail", "-c", here],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            timeout=PATIENCE_S,
            check=True,
        )
    said, end = json.JSONDecoder().raw_decode(done.stdout)
    return said, json.loads(done.stdout[end:])


def test_the_whole_of_it(tmp_path):
    state, result = typed(0, tmp_path)
    assert state["state"] == "succeeded"
    assert result["job"]["robot"]["library"] == "ur5e" and result["headline"]["unit"] == "m3"


def test_a_webhook(tmp_path):
    webhook, tried = typed(1, tmp_path, WSRENDER_WEBHOOK_TARGETS="https://hooks.example.org")
    assert webhook["states"] == ["succeeded", "failed"] and webhook["secret"].startswith("whsec_")
    assert tried["message"].startswith("msg_")
