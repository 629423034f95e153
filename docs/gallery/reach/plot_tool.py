"""
How do I set the tool (TCP), and what does it change?
=====================================================

Everything is computed for the robot's *tip*. ``tool`` moves it: here a gripper of 0.15 m along the flange's z axis.
"""

import wsrender as ws

bare = ws.load_robot("ur5e")
gripping = ws.load_robot("ur5e", tool=ws.Transform(position_m=(0, 0, 0.15)))
q = [0, -1.5, 1.5, 0, 1, 0]
print("flange ", bare.forward_kinematics(q)[0, :3, 3].round(3))
print("gripper", gripping.forward_kinematics(q)[0, :3, 3].round(3))

# %%
# A longer tool reaches farther.

common = {"indices": ["manipulability"], "device": "cpu"}
results = ws.robot_comparison([bare, gripping], ws.Sobol(1 << 17), names=["bare", "gripper"], **common)
print(results.summary())

# Picture: Planes through both workspaces, one arm a row; with the gripper it is larger, and moves better far out.
results.plot.comparison()
