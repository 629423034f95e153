"""
Which of these robots does my task?
===================================

The same targets, several robots: each is placed at its best, and the map says which serves most from where.
"""

import wsrender as ws

targets = [(0.45 + 0.1 * k, 0.2 * (k % 2), 0.15) for k in range(6)]
over = {"x_m": [-0.8, 1.2, 0.2], "y_m": [-0.8, 0.8, 0.2], "yaw_deg": [0, 360, 90]}
robots = ["ur3e", "ur5e", "puma560"]
result = ws.base_placement(
    robots=robots, points_m=targets, quats_wxyz=[(0, 1, 0, 0)] * 6, over=over, refine=False, device="cpu"
)
print(result.summary())

# Picture: A map for each robot of how many targets it serves from where, and one of which robot serves most.
result.plot.arms_map()
