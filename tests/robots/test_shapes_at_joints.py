"""Shapes of library robots stand where their joints and masses are: a mesh in a wrong frame shows here.

Neither the numbers of a model nor its second source see that a mesh was put in turned or shifted. At each joint the
shapes of both links must come near its axis and each other; a link's centre of mass must lie in its shapes; and of an
arm whose links stand side by side, without that its kinematics say so, others' meshes tell the side.
"""

import mujoco
import numpy as np
import pytest

from tests.robots.test_shapes_contain_meshes import depths
from wsrender.robots import library

ROBOTS = {robot.name: robot.path for robot in library.describe()}
# How far shapes of one robot are apart, or off the axis, at worst [m].
GAP = {"default": 0.013, "doosan_m0609": 0.036, "doosan_m1013": 0.036}  # Doosan's capsules leave joints 3 and 5 out
OFF_AXIS = {
    "default": 0.02,
    "franka_panda": 0.05,  # shapes of the housings, which stand beside the axes
    "kuka_iiwa14": 0.031,
    "openarm_left_arm": 0.04,  # the hand's frame stands beyond its last axis
    "openarm_right_arm": 0.04,
    "unitree_g1_left_arm": 0.04,
    "unitree_g1_right_arm": 0.04,
    "unitree_z1": 0.071,  # Unitree's cylinders are of the tubes alone
}
# How far centres of mass are outside of shapes, where by more than a centimetre [m].
OUTSIDE = {
    ("franka_fr3", "fr3_link7"): 0.067,  # as Franka publishes it
    ("franka_panda", "link4"): 0.058,  # identified from motions, not measured; so are these
    ("franka_panda", "link5"): 0.022,
    ("franka_panda", "link6"): 0.012,
    ("kinova_gen3_lite", "forearm_link"): 0.060,  # Kinova's own numbers, on the other side of the joint than its mesh
    ("kinova_gen3_lite", "upper_wrist_link"): 0.048,  # likewise
    ("stanford_arm", "link1"): 0.072,  # of the book's arm, whose motors the shapes leave out
}


def shaped(model):
    """Geoms by body."""
    return {b: np.flatnonzero(model.geom_bodyid == b) for b in range(model.nbody)}


def links_at(model, joint):
    """Bodies with shapes that a joint joins, (before, behind); those without shapes are passed over."""
    own, body = shaped(model), int(model.jnt_bodyid[joint])
    parent, behind = int(model.body_parentid[body]), [body]
    while parent and not len(own[parent]):
        parent = int(model.body_parentid[parent])
    beside = [b for b in own if model.body_parentid[b] == 0 and not model.body_jntnum[b]]  # the base
    before = [parent] if parent else [b for b in beside if len(own[b])]
    while behind and not any(len(own[b]) for b in behind):
        behind = [b for b in range(1, model.nbody) if model.body_parentid[b] in behind]
    return before, [b for b in behind if len(own[b])]


def misfit(model, joint):
    """How far shapes at a joint are from its axis, and from each other [m], in the zero configuration."""
    data, own = mujoco.MjData(model), shaped(model)
    data.qpos[:] = 0
    mujoco.mj_kinematics(model, data)
    before, behind = links_at(model, joint)
    axis = data.xanchor[joint] + data.xaxis[joint] * np.linspace(-1.5, 1.5, 3001)[:, None]
    off = 0.0
    for bodies in (before, behind):
        nearest = [
            -depths(model, g, (axis - data.xpos[b]) @ data.xmat[b].reshape(3, 3)).max() for b in bodies for g in own[b]
        ]
        off = max(off, min(nearest, default=0.0))
    pairs = [(g, h) for a in before for g in own[a] for b in behind for h in own[b]]
    return off, min((mujoco.mj_geomDistance(model, data, *pair, 1.0, None) for pair in pairs), default=0.0)


def outside(model, body):
    """How far a body's centre of mass is outside of its shapes [m]; below zero inside."""
    return -max(depths(model, g, model.body_ipos[body][None])[0] for g in shaped(model)[body])


def sides(name):
    """Least and greatest coordinates of the shapes of each body in its frame [m]."""
    model = mujoco.MjModel.from_xml_path(str(library.find(name)))
    found = {}
    for b, geoms in shaped(model).items():
        ends = []
        for g in geoms:
            R, size, kind = np.empty(9), model.geom_size[g], mujoco.mjtGeom(model.geom_type[g])
            mujoco.mju_quat2Mat(R, model.geom_quat[g])
            R = R.reshape(3, 3)
            if kind == mujoco.mjtGeom.mjGEOM_BOX:
                half = np.abs(R) @ size
            elif kind == mujoco.mjtGeom.mjGEOM_CYLINDER:
                half = np.abs(R[:, 2]) * size[1] + size[0] * np.sqrt(np.maximum(1 - R[:, 2] ** 2, 0.0))
            else:
                half = np.abs(R[:, 2]) * size[1] + size[0]
            ends += [model.geom_pos[g] - half, model.geom_pos[g] + half]
        if ends:
            found[model.body(b).name] = np.min(ends, axis=0), np.max(ends, axis=0)
    return found


@pytest.mark.parametrize("name", ROBOTS)
def test_shapes_meet_at_the_axis_of_each_joint(name):
    model = mujoco.MjModel.from_xml_path(str(ROBOTS[name]))
    for joint in range(model.njnt):
        off, gap = misfit(model, joint)
        if model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE:
            assert off < OFF_AXIS.get(name, OFF_AXIS["default"]), model.joint(joint).name
        assert gap < GAP.get(name, GAP["default"]), model.joint(joint).name


def test_shifted_shapes_of_a_link_do_not_fit_its_joints():
    model = mujoco.MjModel.from_xml_path(str(ROBOTS["abb_irb2600_12_165"]))
    model.geom_pos[model.geom_bodyid == model.body("link_4").id] += (0.0, 0.0, 0.25)
    assert max(misfit(model, 3)[0], misfit(model, 4)[0]) > 0.1
    model = mujoco.MjModel.from_xml_path(str(ROBOTS["ur20"]))
    model.geom_pos[model.geom_bodyid == model.body("forearm_link").id] += (0.0, 0.0, -0.3)
    assert misfit(model, 2)[1] > 0.1


@pytest.mark.parametrize("name", ROBOTS)
def test_a_centre_of_mass_lies_in_its_shapes(name):
    model = mujoco.MjModel.from_xml_path(str(ROBOTS[name]))
    for body, geoms in shaped(model).items():
        if body and len(geoms) and model.body_mass[body] > 1e-6:
            link = model.body(body).name
            assert outside(model, body) < OUTSIDE.get((name, link), 0.01), link


def test_the_upper_arm_of_the_hc10dtp_stands_where_yaskawas_mesh_does():
    """Numbers are bounds of ros-industrial's meshes, motoman_hc10_support/meshes/hc10dt_b10/visual."""
    found = sides("yaskawa_hc10dtp")
    low, high = found["link2"]
    assert np.all(low <= np.array([-0.0957, -0.298, -0.096]) + 1e-4)
    assert np.all(high >= np.array([0.0957, -0.104, 0.778]) - 1e-3)
    assert low[1] > -0.31 and high[1] < -0.09  # at the right of the base, as seen from behind it
    assert found["link1"][0][1] < -0.114 < -found["link1"][1][1]  # its flange to the upper arm
    assert found["link3"][0][1] < -0.101 and found["link3"][1][0] > 0.114  # its flanges
