"""
What is left with a joint locked, or with narrower limits?
==========================================================

A brake that holds a joint, a cable that allows half a turn: ``locked`` of the sampling and ``limits`` of the robot.
"""

import wsrender as ws

common = {"indices": ["manipulability"], "voxel_size_m": 0.05, "device": "cpu"}
whole = ws.analyze("ur5e", ws.Sobol(1 << 17), **common)
locked = ws.analyze("ur5e", ws.Sobol(1 << 17, locked={"joint3": 1.2}), **common)
narrow = ws.load_robot("ur5e", limits={"joint1": (-1.5, 1.5), "joint2": (-2.5, 0.0)})
narrowed = ws.analyze(narrow, ws.Sobol(1 << 17), **common)

for name, result in {"whole": whole, "joint 3 locked": locked, "narrowed": narrowed}.items():
    headline = result.document["headline"]
    print(f"{name:15s} {headline['value']:.3f} m³  {headline['ci95'][0]:.3f} … {headline['ci95'][1]:.3f}")

# %%
# With the elbow locked the wrist's centre stays on a sphere around the shoulder; what thickness is left is the wrist's.

# Picture: Slice at y = 0 with the elbow locked: a shell around the shoulder instead of a filled disc.
locked.plot.slice(y=0.0)

# %%
# Narrower limits cut a part out of the workspace. Voxels this small have too few samples, as the warnings above the
# picture say; the headline does not suffer from it.

# Picture: Slice at z = 0.3 m with narrower limits: a wedge on one side is gone.
narrowed.plot.slice(z=0.3)
