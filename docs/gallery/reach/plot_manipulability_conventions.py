"""
How does manipulability relate to MATLAB's and Corke's?
=======================================================

Yoshikawa's measure is the product of the singular values of a Jacobian: of *which* rows makes the difference.
MATLAB's ``manipulabilityIndex`` and Corke's ``manipulability`` take all six by default, wsrender the three of the
linear velocity unless ``task`` says otherwise.
"""

import numpy as np

import wsrender as ws

robot, q = ws.load_robot("ur5e"), [0.3, -1.5, 1.5, 0.2, 1, 0]
J = robot.jacobian(q)[0]
for task, rows in {"linear": J[:3], "full": J}.items():
    by_hand = np.sqrt(np.linalg.det(rows @ rows.T))
    (value,) = ws.evaluate_indices(robot, q, ["manipulability"], task=task)["manipulability"]
    print(f"{task:7s} wsrender {value:.6f}  by hand √det(J Jᵀ) {by_hand:.6f}")

# %%
# How the two differ over the workspace:

linear, full = (
    ws.analyze("ur5e", ws.Sobol(1 << 17), ["manipulability"], task=task, refined_volume=None, device="cpu")
    for task in ("linear", "full")
)

# Picture: Histogram of manipulability of the linear rows.
linear.plot.histogram("manipulability")

# %%

# Picture: Histogram of manipulability of all six rows, with more weight at zero, where the wrist is singular too.
full.plot.histogram("manipulability")
