"""The demonstration: a server, a real analysis over HTTP, its maps, volume and pictures in a folder."""

import tempfile
from pathlib import Path
from typing import Any

from wsrender.client import Client
from wsrender.results.result import Result
from wsrender_server.local_server import LocalServer


def job_document(robot: str) -> dict[str, Any]:
    """A workspace analysis that shows everything and takes seconds."""
    return {
        "analysis": "workspace",
        "robot": {"library": robot},
        "keep_map": True,
    }


def demonstrate(robot: str, output: Path) -> Result:
    """Run the demonstration; the result is in ``output`` when this returns, the server is gone."""
    with (
        tempfile.TemporaryDirectory(prefix="wsrender-demo-", ignore_cleanup_errors=True) as data,
        LocalServer(Path(data)) as server,
        Client(server.url) as client,
    ):
        result = client.submit(job_document(robot)).wait(progress=True).result()
        result.save(output)
        return result
