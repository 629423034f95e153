"""
How do I run a job on a server?
===============================

``wsrender serve`` starts one; here a server of this script's own stands in for it, on a free port.
"""

import tempfile
from pathlib import Path

from wsrender_server.local_server import LocalServer

import wsrender as ws

with LocalServer(Path(tempfile.mkdtemp())) as server, ws.Client(server.url) as client:
    job = client.submit(
        {
            "analysis": "workspace",
            "robot": {"library": "ur5e"},
            "sampling": {"method": "sobol", "count": 1 << 16},
            "indices": ["manipulability"],
            "refined_volume": None,
        }
    )
    result = job.wait().result()
    print(result.summary())
    figure = result.plot.slice(y=0.0)  # files of a result are fetched when they are first used

# Picture: Slice at y = 0 of the result that the server has computed.
figure
