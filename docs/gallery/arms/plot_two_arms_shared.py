"""
What do two arms reach together?
================================

Two haptic devices side by side: the volume that both reach, and what each reaches alone.
"""

import wsrender as ws

left = ws.load_robot("phantom_omni", placement=ws.Transform(position_m=(0, -0.1, 0)))
right = ws.load_robot("phantom_omni", placement=ws.Transform(position_m=(0, 0.1, 0)))
both = ws.shared_workspace([left, right], ws.Sobol(1 << 17), indices=["manipulability"], device="cpu")
print(both.summary())

# Picture: The two arms and, as a surface, the volume that both reach.
both.plot.robot()

# %%

# Picture: Interactive view of both workspaces and their intersection.
both
