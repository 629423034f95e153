"""The site as it is built, served from this process."""

import hashlib
import os
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from shutil import copytree, ignore_patterns

CLONE = Path(__file__).parents[2]
SCRIPTS = sorted(CLONE.glob("docs/gallery/*/plot_*.py"))
TUTORIALS = [path for path in sorted(CLONE.glob("docs/tutorials/*.md")) if path.stem != "index"]
CHOSEN = 8


def chosen() -> list[str]:
    """Names of the scripts that are run: all if DOCS_CHOICE is "all", else some by its hash, such as a commit's."""
    return _of([path.stem for path in SCRIPTS], CHOSEN)


def all_chosen() -> bool:
    """Whether all scripts are run, as in the long measurement."""
    return os.environ.get("DOCS_CHOICE") == "all"


def _of(names: list[str], count: int) -> list[str]:
    if all_chosen():
        return names
    choice = os.environ.get("DOCS_CHOICE", "")
    return sorted(names, key=lambda name: hashlib.sha256(f"{choice}{name}".encode()).digest())[:count]


def build(folder: Path) -> Path:
    """Build the site of a copy of its sources, warnings being errors, and return its folder."""
    source = copytree(CLONE / "docs", folder / "docs", ignore=ignore_patterns("generated", "_build"))
    command = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", str(source), str(folder / "site")]
    known = os.pathsep.join(str(CLONE / each) for each in ("", "kernels", "server"))
    run = chosen() + _of([path.stem for path in TUTORIALS], 1)
    environment = os.environ | {"DOCS_GALLERY": ",".join(run), "PYTHONPATH": known}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder / "site"


class _Quiet(SimpleHTTPRequestHandler):
    def log_message(self, format, *args):
        pass


@contextmanager
def serving(folder: Path) -> Iterator[str]:
    """Address of a server of a folder."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(_Quiet, directory=str(folder)))
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_port}/"
    finally:
        server.shutdown()
        server.server_close()
        thread.join()
