"""
What does a rail or a torso add?
================================

``mount`` puts joints below any robot: here a rail of a metre along x, so that the chain has seven joints.
"""

import wsrender as ws

on_rail = ws.load_robot("ur5e", mount=[{"name": "rail", "axis": "x", "limits": [0, 1]}])
print(on_rail.joint_names)

result = ws.analyze(on_rail, ws.Sobol(1 << 18), ["manipulability"], refined_volume=0.03, device="cpu")
print(result.summary())

# Picture: Slice at z = 0.2 m: a disc drawn out along x by the rail.
result.plot.slice(z=0.2)
