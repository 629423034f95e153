"""Shapes fitted to meshes, and models written from URDFs, for the library."""

import mujoco
import numpy as np
import pytest
import trimesh
from scipy.spatial import cKDTree

from tests.library.fit import Shape, excess, fit
from tests.library.from_urdf import links_of, mjcf, text_of
from wsrender.robots import load_mjcf, load_urdf


def elbow():
    """A housing about y and a tube along z, as one mesh of two bodies."""
    housing = trimesh.creation.cylinder(0.07, 0.16).apply_transform(
        trimesh.transformations.rotation_matrix(np.pi / 2, [1, 0, 0])
    )
    tube = trimesh.creation.cylinder(0.04, 0.5).apply_translation([0, 0, 0.25])
    return trimesh.util.concatenate([housing, tube])


MESHES = {
    "an elbow": elbow(),
    "a box": trimesh.creation.box([0.1, 0.2, 0.4]),
    "a capsule": trimesh.creation.capsule(0.3, 0.05, count=[16, 16]),
    "a bent tube": trimesh.creation.torus(0.2, 0.03, 24, 12),
}


@pytest.mark.parametrize("parts", [0, 4])
@pytest.mark.parametrize("name", MESHES)
def test_shapes_contain_the_mesh_and_exceed_it_by_the_bound(name, parts):
    """Containment by points anywhere on the surface; the bound by other points than those that it is found by."""
    mesh = MESHES[name]
    shapes = fit(mesh, [(np.zeros(3), np.array([0.0, 1.0, 0.0]))], parts)
    points = trimesh.sample.sample_surface(mesh, 20_000, seed=7)[0]
    assert np.max([shape.depth(points) for shape in shapes], axis=0).min() >= 0
    bound, near = excess(mesh, shapes), cKDTree(trimesh.sample.sample_surface(mesh, 100_000, seed=9)[0])
    around = np.random.default_rng(3).uniform(mesh.bounds[0] - 0.05, mesh.bounds[1] + 0.05, (200_000, 3))
    depth = np.max([shape.depth(around) for shape in shapes], axis=0)
    skin = around[(depth > 0) & (depth < 0.003)]
    assert near.query(skin)[0].max() <= bound + 0.002  # how far apart the near points are


def test_a_housing_and_a_tube_are_two_cylinders():
    shapes = fit(elbow(), [(np.zeros(3), np.array([0.0, 1.0, 0.0]))])
    small, large = sorted(shapes, key=lambda shape: shape.size[0])
    assert (small.kind, large.kind) == ("cylinder", "cylinder")
    assert small.size[0] == pytest.approx(0.04, abs=0.001) and large.size[0] == pytest.approx(0.07, abs=0.006)
    assert excess(elbow(), shapes) < 0.03


def test_a_body_that_is_not_convex_is_cut_into_parts():
    """Three bars along three axes, of which slabs across one axis part only one from the others."""
    bars = [trimesh.creation.box(bounds=[[0, 0, 0], 0.1 + 0.5 * np.eye(3)[k]]) for k in range(3)]
    slabs, cut = (sum(shape.volume for shape in fit(trimesh.util.concatenate(bars), parts=parts)) for parts in (0, 4))
    assert cut < 0.8 * slabs


def test_what_is_written_is_what_is_measured():
    shape = Shape("capsule", (0.05, 0.1), (0.1, 0.2, 0.3), (0.0, 1.0, 0.0))
    words = " ".join(f'{key}="{value}"' for key, value in shape.mjcf().items())
    geom = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody><geom {words}/></worldbody></mujoco>")
    assert geom.geom_pos[0] == pytest.approx(shape.center) and geom.geom_size[0, :2] == pytest.approx(shape.size)


URDF = """<robot name="two"><link name="base"><collision><geometry><box size=".2 .2 .1"/></geometry></collision></link>
<link name="upper"><inertial><origin xyz="0 0 .2"/><mass value="2"/>
<inertia ixx=".025" iyy=".02" izz=".01" ixy=".001" ixz="0" iyz="0"/></inertial>
<collision><origin xyz="0 0 .2"/><geometry><cylinder radius=".05" length=".4"/></geometry></collision></link>
<link name="lid"><inertial><origin xyz=".1 0 0" rpy="0 0 .5"/><mass value="1"/>
<inertia ixx=".003" iyy=".002" izz=".004" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="hand"/><link name="tip"/><link name="beyond"/>
<joint name="pan" type="revolute"><parent link="base"/><child link="upper"/><origin xyz="0 0 .1" rpy="1.5708 0 .3"/>
<axis xyz="0 0 1"/><limit lower="-1" upper="2" velocity="3" effort="40"/></joint>
<joint name="fix" type="fixed"><parent link="upper"/><child link="lid"/><origin xyz="0 .1 .3" rpy=".2 0 0"/></joint>
<joint name="slide" type="prismatic"><parent link="upper"/><child link="hand"/><origin xyz="0 0 .4"/>
<axis xyz="1 0 0"/><limit lower="0" upper=".2" velocity=".5" effort="10"/></joint>
<joint name="end" type="fixed"><parent link="hand"/><child link="tip"/><origin xyz="0 0 .1" rpy="0 .4 0"/></joint>
<joint name="on" type="fixed"><parent link="tip"/><child link="beyond"/></joint></robot>"""


def test_a_model_written_from_a_urdf_is_the_urdf(tmp_path):
    """But for the right angle, which the URDF writes with five digits: poses, limits and the mass matrix."""
    (tmp_path / "two.urdf").write_text(URDF)
    links, T_tip = links_of(tmp_path / "two.urdf", "base", "tip")
    ours = load_mjcf(text_of(mjcf("two", links, T_tip, "d", "s")))
    theirs = load_urdf(URDF.replace("1.5708", repr(np.pi / 2)), base="base", tip="tip")
    q = np.random.default_rng(0).uniform(ours.chain.lower_limits, ours.chain.upper_limits, (10, 2))
    np.testing.assert_allclose(ours.chain.poses(q), theirs.chain.poses(q), atol=1e-12)
    for field in ("lower_limits", "upper_limits", "velocity_limits", "effort_limits", "joint_names"):
        assert np.array_equal(getattr(ours.chain, field), getattr(theirs.chain, field)), field
    ours_m, theirs_m = (mass_matrix(robot.model, q[0]) for robot in (ours, theirs))
    np.testing.assert_allclose(ours_m, theirs_m, atol=1e-8)


def mass_matrix(model, q):
    data, M = mujoco.MjData(model), np.zeros((model.nv, model.nv))
    data.qpos[:] = q
    mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, M)
    return M
