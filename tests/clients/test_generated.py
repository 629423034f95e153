"""Clients that generators make of a server's description: as their README says, typed strictly, and used."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest
from wsrender_server.local_server import LocalServer

HERE = Path(__file__).parent.parent.parent / "clients" / "openapi"
STEP_S = 200


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    with LocalServer(tmp_path_factory.mktemp("data")) as server:
        yield server


def commands(language, url):
    """What the README says to type for a language."""
    text = (HERE / "README.md").read_text().partition(f"## {language}")[2]
    (lines,) = re.findall(r"```sh\n(.*?)```", text.partition("\n## ")[0], re.DOTALL)
    return lines.replace("http://127.0.0.1:8000", url)


def walked(language, url, folder, *more):
    """The last lines of the commands, typed in a folder that holds the files of the README's; what else is typed."""
    shutil.copytree(HERE, folder, dirs_exist_ok=True, ignore=shutil.ignore_patterns("node_modules"))
    script = "\n".join(("set -euo pipefail", *more, commands(language, url)))
    done = subprocess.run(["bash", "-c", script], cwd=folder, capture_output=True, text=True, timeout=STEP_S)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def check(told):
    assert re.search(r"^indices_at: .*\bindices\b.*\bprovenance\b", told, re.M), told
    assert re.search(r"^workspace: .*result\.json", told, re.M), told
    assert re.search(r"^cancel: .*canceled$", told, re.M), told
    assert re.search(r"^refused: invalid_document #/voxel_size_m$", told, re.M), told


def test_python(server, tmp_path):
    for program in ("openapi-python-client", "pyright"):
        if shutil.which(program) is None:
            pytest.skip(f"{program} is not installed: pip install wsrender[test-clients]")
    pytest.importorskip("httpx", reason="what is generated needs it: pip install wsrender[test-clients]")
    check(walked("Python", server.url, tmp_path))
    (tmp_path / "pyrightconfig.json").write_text('{"include": ["walk.py"], "typeCheckingMode": "strict"}')
    python = shutil.which("python")
    checked = subprocess.run(["pyright", "--pythonpath", python], cwd=tmp_path, capture_output=True, text=True)
    assert checked.returncode == 0, checked.stdout


def test_typescript(server, tmp_path):
    if shutil.which("npm") is None:
        pytest.skip("npm is not installed: pip install wsrender[test-clients]")
    check(walked("TypeScript", server.url, tmp_path, f"export npm_config_cache='{tmp_path}/cache'"))
