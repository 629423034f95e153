"""
How do I load a xacro file of a ROS package?
============================================

As any other model, by its path; ``xacro`` gives its arguments, ``packages`` the folders of packages that it names.
"""

import tempfile
from pathlib import Path

import wsrender as ws

MACRO = """<robot name="mast" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="reach" default="0.3"/>
  <link name="base"/>
  <xacro:macro name="segment" params="number parent axis">
    <link name="link${number}"/>
    <joint name="joint${number}" type="revolute">
      <parent link="${parent}"/><child link="link${number}"/>
      <origin xyz="0 0 $(arg reach)"/><axis xyz="${axis}"/>
      <limit lower="-1.5" upper="1.5" effort="10" velocity="2"/>
    </joint>
  </xacro:macro>
  <xacro:segment number="1" parent="base" axis="0 0 1"/>
  <xacro:segment number="2" parent="link1" axis="0 1 0"/>
  <xacro:segment number="3" parent="link2" axis="0 1 0"/>
  <link name="hand"/>
  <joint name="wrist" type="fixed"><parent link="link3"/><child link="hand"/><origin xyz="0 0 0.2"/></joint>
</robot>
"""
path = Path(tempfile.mkdtemp()) / "mast.urdf.xacro"
path.write_text(MACRO)
for reach in ("0.3", "0.4"):
    robot = ws.load_robot(path, xacro={"reach": reach})
    result = ws.analyze(robot, ws.Grid(40), ["manipulability"], device="cpu")
    print(reach, "m:", f"{result.document['headline']['value']:.3f} m³")

# Picture: Planes through the workspace of the longer arm: a part of a shell around the axis, open below.
result.plot.slices()
