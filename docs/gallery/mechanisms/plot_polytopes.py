"""
How fast, and how strong, in every direction?
=============================================

Limits of joint velocities and torques become polytopes at the tip: the largest ball inside is what there is in *every*
direction.
"""

import wsrender as ws

fast = ws.load_robot("ur5e", velocity_limits={f"joint{k}": 3.14 for k in range(1, 7)})
velocity = ws.polytope(fast, [0, -1, 1, 0, 1, 0], "velocity")
print(f"in every direction {velocity.radius:.2f} m/s; {len(velocity.vertices)} vertices, {len(velocity.facets)} facets")

result = ws.indices_at(fast, [[0, -1, 1, 0, 1, 0]], polytopes=["velocity", "force"], device="cpu")

# Picture: The polytopes of velocity and force at the tip of the arm.
result.plot.polytopes()
