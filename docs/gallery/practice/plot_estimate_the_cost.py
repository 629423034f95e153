"""
How long will this job take, and how much memory?
=================================================

``ws.run.plan`` resolves a job without running it: its estimate has samples, bytes of memory and of files, and seconds.
A server says the same of a job document, and checks its limits against it.
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
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
for name, value in ws.run.plan(job).estimate.items():
    print(f"{name:13s} {value:,.3g}")

# %%
# Of a server, as the form in the browser shows it; here a server of this script's own stands in for one:

with LocalServer(Path(tempfile.mkdtemp())) as server, ws.Client(server.url) as client:
    estimate = client.estimate(job)
megabytes = estimate["memory_bytes"] / 1e6
print(f"{estimate['samples']:,.0f} samples, {megabytes:.1f} MB of memory, {estimate['seconds']:.1f} s")

# %%
# More samples, more time:

samples = [1 << k for k in range(16, 31, 2)]
estimates = [ws.run.plan(job | {"sampling": {"method": "sobol", "count": count}}).estimate for count in samples]
figure, axes = plt.subplots(figsize=(6, 3.4), layout="constrained")
axes.loglog(samples, [each["seconds"] for each in estimates], "o-")
axes.set(xlabel="samples", ylabel="estimated time [s]")

# Picture: The estimated seconds over the number of samples: level where few are drawn, then in proportion to them.
figure
