"""
How long will this job take, and how much memory?
=================================================

A server estimates a job without running it: samples, bytes and, once it has timed such jobs, seconds. The same numbers
are what its limits are checked against.
"""

import tempfile
from pathlib import Path

from wsrender_server.local_server import LocalServer

import wsrender as ws

job = {
    "analysis": "workspace",
    "robot": {"library": "ur5e"},
    "sampling": {"method": "sobol", "count": 1 << 20},
    "indices": ["manipulability"],
    "refined_volume": None,
    "device": "cpu",
}
with LocalServer(Path(tempfile.mkdtemp())) as server, ws.Client(server.url) as client:
    estimate = client.estimate(job)
for name, value in estimate.items():
    print(f"{name:22s} {type(value).__name__ if isinstance(value, dict | list) else value}")
