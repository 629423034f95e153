"""
Which of two arms serves which targets, and where should the second stand?
==========================================================================

One arm is there; the other's place is looked for, so that both together serve most.
"""

import wsrender as ws

targets = [(0.3 + 0.25 * k, 0.1, 0.2) for k in range(6)]
result = ws.two_arm_placement(
    targets,
    [[0, 1, 0, 0]] * 6,
    first={"robot": "ur5e", "over": {}},
    second={"robot": "ur5e", "over": {"x_m": [0.6, 2.2, 0.2], "y_m": [-0.8, 0.8, 0.2]}},
    device="cpu",
)
print(result.summary())

# Picture: The targets, coloured by the arm that serves them, with the bases of both.
result.plot.shares()
