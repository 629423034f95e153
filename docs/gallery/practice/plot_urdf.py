"""
How do I load my own URDF?
==========================

A path, or the text itself. What the model leaves out or seems to mean otherwise is a warning that says what to give.
"""

import wsrender as ws

urdf = '<robot name="two_link"><link name="base"/>'
for number, (parent, offset) in enumerate([("base", 0.2), ("link1", 0.4), ("link2", 0.3)], start=1):
    urdf += f'<link name="link{number}"/><joint name="joint{number}" type="revolute">'
    urdf += f'<parent link="{parent}"/><child link="link{number}"/><origin xyz="0 0 {offset}"/>'
    urdf += f'<axis xyz="0 {int(number > 1)} {int(number == 1)}"/><limit lower="-2" upper="2" effort="9" velocity="2"/>'
    urdf += "</joint>"
urdf += '<link name="palm"/><joint name="held" type="fixed"><parent link="link3"/><child link="palm"/>'
urdf += '<origin xyz="0 0 0.25"/></joint></robot>'

robot = ws.load_robot(urdf, tip="palm")
print(robot)
print(robot.joint_names, robot.lower_limits, robot.upper_limits)

# %%

result = ws.analyze(robot, ws.Grid(60), ["manipulability"], device="cpu")
print(result.summary())

# Picture: The arm as sticks in the sampled positions, coloured by manipulability.
result.plot.robot()
