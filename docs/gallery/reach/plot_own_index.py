"""
How do I add an index of my own?
================================

An index is arithmetic on the singular values of the Jacobian, or on what else its parameters name (``q``, ``J``, ``M``,
``g``, ``limits``, ``frames``, ``position``, ``axes``). It is traced into the kernel, and runs as fast as the built-in
ones.
"""

import wsrender as ws

ws.register_index("spread", lambda sigma, m, n: sigma[0] - sigma[-1], unit="m")
ws.register_index("elbow_load", lambda g, limits: abs(g[2]) / limits.effort[2], unit="1")
print(ws.evaluate_indices(ws.load_robot("ur5e"), [0, -1.5, 1.5, 0, 1, 0], ["spread", "elbow_load"]))

# %%
# Over the workspace: which share of its torque the elbow needs against gravity, at most in each voxel.

result = ws.analyze("ur5e", ws.Sobol(1 << 17), ["elbow_load"], refined_volume=None, device="cpu")

# Picture: Slice at y = 0: the largest load of the elbow is about an eighth of its torque, less at top and bottom.
result.plot.slice(y=0.0, index="elbow_load")
