"""
From where can one tool pose be reached?
========================================

The inverse question: fix the tool's pose, move the base over x, y and yaw.
"""

import wsrender as ws

hole = {"position_m": [0.5, 0.1, 0.2], "quat_wxyz": [0, 1, 0, 0]}
over = {"x_m": [-0.8, 1.8, 0.05], "y_m": [-1.2, 1.4, 0.05], "yaw_deg": [0, 360, 45]}
result = ws.inverse_reachability("ur5e", hole, over, device="cpu")
print(result.summary())

# Picture: Map of the share of yaws from which the pose is reached: it is 1 in a ring around the hole.
result.plot.base_map()
