"""The robot library against the published tables, written out once more and evaluated in NumPy."""

import math
import re
import shutil
from pathlib import Path

import mujoco
import numpy as np
import pytest

import wsrender
from tests.reference import chain_kinematics, dh_product
from tests.reference.published_robots import (
    EFFORTS,
    FLANGE,
    IIWA_LINKS,
    INERTIAS,
    NAMES,
    STANFORD_LINKS,
    UR5E_LINKS,
    dh_table,
)
from tests.robots.test_bodies import contacts_of
from wsrender.analyses.jobs import parse_job
from wsrender.errors import ModelError
from wsrender.robots import library, load, load_dh, load_path, load_urdf
from wsrender.robots.dh import structural_length


def configurations(chain, count):
    generator = np.random.default_rng(20240611)
    return generator.uniform(chain.lower_limits, chain.upper_limits, (count, chain.n))


def mass_matrix(model, q):
    data, M = mujoco.MjData(model), np.zeros((model.nv, model.nv))
    data.qpos[:] = q
    mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, M)
    return M


# --- the folder -----------------------------------------------------------------------------------------


def test_the_library_has_every_robot_of_the_tables():
    assert set(NAMES) <= set(library.names())
    assert all(library.find(name).is_file() for name in NAMES)


def test_the_readme_of_the_project_counts_them():
    readme = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")
    assert f" {len(library.describe())} in the library" in readme


def test_an_unknown_robot_is_refused_with_the_names():
    with pytest.raises(ModelError, match=r'no robot "UR-5e"; did you mean "ur5e"\? It has: .*articulated, .*ur5e'):
        library.find("UR-5e")
    with pytest.raises(ModelError, match=r'no robot "nonesuch". It has: .*articulated, .*ur5e'):
        library.find("nonesuch")


@pytest.mark.parametrize("name", ["", ".", "../mjcf/ur5e", "ur5e/ur5e", "/etc/passwd", "*"])
def test_names_are_not_paths(name):
    with pytest.raises(ModelError, match="has no robot"):
        library.find(name)


def test_an_installed_package_uses_its_own_models(tmp_path, monkeypatch):
    package = tmp_path / "wsrender"
    shutil.copytree(library.find("scara").parent, package / "mjcf" / "scara")
    monkeypatch.setattr(wsrender, "__file__", str(package / "__init__.py"))
    assert library.names() == ["scara"]
    assert library.find("scara") == package / "mjcf" / "scara" / "scara.xml"


def test_descriptions_name_joints_and_source():
    described = {robot.name: robot for robot in library.describe()}
    assert list(described) == library.names()
    for name in NAMES:
        assert described[name].joints == len(dh_table(name).rows)
        assert len(described[name].description) > 20 and len(described[name].source) > 10


@pytest.mark.parametrize("name", NAMES)
def test_the_readme_states_the_numbers_and_their_source(name):
    text = (library.find(name).parent / "README.md").read_text()
    assert "## Source of every number" in text and "site `tool`" in text
    plain = text.replace("−", "-")
    for row in dh_table(name).rows:
        assert f"| {row.a:g} | {math.degrees(row.alpha):g} |" in plain
    for mass, center, *_ in INERTIAS.get(name, []):
        assert f"| {mass:g} |" in plain or f"| {mass} |" in plain or mass == 0
        assert all(f"{value:g}" in plain or f"{value}" in plain for value in center)


# --- kinematics -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", NAMES)
def test_plain_mujoco_compiles_the_model_without_a_warning(name, tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)  # MuJoCo writes its warnings to a file in the working folder
    model = mujoco.MjModel.from_xml_path(str(library.find(name)))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert not list(Path().iterdir()) and capfd.readouterr() == ("", "")
    assert all(warning.number == 0 for warning in data.warning)


@pytest.mark.parametrize("name", NAMES)
def test_poses_are_those_of_the_published_table(name):
    dh, flange = dh_table(name), dh_product.translation(0.0, FLANGE.get(name, 0.0))
    model = mujoco.MjModel.from_xml_path(str(library.find(name)))
    data, chain = mujoco.MjData(model), load_path(library.find(name)).chain
    for q in configurations(chain, 20):
        data.qpos[:] = q
        mujoco.mj_kinematics(model, data)
        T = dh_product.frames(dh, q)[-1] @ flange
        np.testing.assert_allclose(data.site("tool").xpos, T[:3, 3], atol=1e-12, rtol=0)
        np.testing.assert_allclose(data.site("tool").xmat.reshape(3, 3), T[:3, :3], atol=1e-12, rtol=0)
        np.testing.assert_allclose(chain_kinematics.forward_kinematics(chain, q), T, atol=1e-12, rtol=0)


@pytest.mark.parametrize("name", NAMES)
def test_limits_and_efforts_are_the_published_ones(name):
    chain, rows = load_path(library.find(name)).chain, dh_table(name).rows
    assert (chain.name, chain.tip_frame, chain.base_frame) == (name, "tool", "world")
    assert chain.joint_names == tuple(f"joint{k}" for k in range(1, len(rows) + 1))
    np.testing.assert_allclose(chain.lower_limits, [row.limits[0] for row in rows], rtol=1e-15, atol=0)
    np.testing.assert_allclose(chain.upper_limits, [row.limits[1] for row in rows], rtol=1e-15, atol=0)
    assert not chain.periodic.any()
    if name in EFFORTS:
        assert chain.effort_limits.tolist() == EFFORTS[name]
    else:
        assert chain.effort_limits is None


@pytest.mark.parametrize("name", NAMES)
def test_the_structural_length_is_that_of_the_table(name):
    rows = dh_table(name).rows
    slides = [max(map(abs, row.limits)) if row.joint == "prismatic" else abs(row.d) for row in rows]
    expected = sum(abs(row.a) for row in rows) + sum(slides) + FLANGE.get(name, 0.0)
    assert structural_length(load_path(library.find(name)).chain) == pytest.approx(expected, abs=1e-12)


def test_gao_6r_has_its_closed_form():
    """Gao and Xu's equations 3 to 5, with a0 along x."""
    a0, a1, d2, a2, d4 = 0.16, 0.17, 0.082, 0.307, 0.256
    chain = load_path(library.find("gao_6r")).chain
    for q in configurations(chain, 10):
        c1, s1, c2, s2 = np.cos(q[0]), np.sin(q[0]), np.cos(q[1]), np.sin(q[1])
        c23, s23 = np.cos(q[1] + q[2]), np.sin(q[1] + q[2])
        rho = a1 + a2 * c2 + d4 * s23
        expected = [a0 + c1 * rho + s1 * d2, s1 * rho - c1 * d2, a2 * s2 - d4 * c23]
        found = chain_kinematics.forward_kinematics(chain, q)[:3, 3]
        np.testing.assert_allclose(found, expected, atol=1e-12)


# --- inertia --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", NAMES)
def test_only_robots_with_published_inertias_have_them(name):
    chain = load_path(library.find(name)).chain
    assert chain.has_inertia == (name in {*INERTIAS, "kuka_iiwa14", "stanford_arm"})
    for q in configurations(chain, 5) if chain.has_inertia else ():
        assert np.linalg.eigvalsh(mass_matrix(load_path(library.find(name)).model, q))[0] > 1e-4


@pytest.mark.parametrize("name", sorted(INERTIAS))
def test_the_mass_matrix_is_that_of_the_published_inertias(name):
    dh, robot = dh_table(name), load_path(library.find(name))
    for q in configurations(robot.chain, 10):
        expected = dh_product.inertia_matrix(dh, q)
        np.testing.assert_allclose(mass_matrix(robot.model, q), expected, atol=1e-9 * expected.max())


def test_puma560_agrees_with_the_explicit_model_of_its_authors():
    """Armstrong, Khatib, Burdick 1986: abbreviated inertia and gravity terms, printed to two digits.

    Their drive inertias replace those of G² Jm, which differ by up to 7 %.
    """
    model = mujoco.MjModel.from_xml_path(str(library.find("puma560")))
    drives = np.array([1.14, 4.71, 0.827, 0.2, 0.179, 0.193])
    data = mujoco.MjData(model)
    for q in configurations(load_path(library.find("puma560")).chain, 20):
        c2, s2, c3, s3 = np.cos(q[1]), np.sin(q[1]), np.cos(q[2]), np.sin(q[2])
        c23, s23 = np.cos(q[1] + q[2]), np.sin(q[1] + q[2])
        M = mass_matrix(model, q) - np.diag(model.dof_armature) + np.diag(drives)
        assert M[1, 1] == pytest.approx(6.79 + 0.74 * s3, abs=0.06)
        assert M[2, 2] == pytest.approx(1.16, abs=0.02)
        assert M[0, 1] == pytest.approx(0.69 * s2 - 0.13 * c23 + 0.02 * c2, abs=0.03)
        assert M[1, 2] == pytest.approx(0.33 + 0.37 * s3 - 0.01 * c3, abs=0.02)
        data.qpos[:] = q
        mujoco.mj_forward(model, data)
        assert data.qfrc_bias[1] == pytest.approx(-37.2 * c2 - 8.4 * s23 + 1.0 * s2, abs=0.5)
        assert data.qfrc_bias[2] == pytest.approx(-8.4 * s23 + 0.25 * c23, abs=0.1)


def quarter_turns(turns):
    return " ".join(repr(turn * math.pi / 2) for turn in turns)


def urdf(links, base_turn, tip):
    """A URDF of links (origin, quarter turns, mass, centre, quarter turns of the tensor, its six numbers)."""
    parts = [
        '<link name="base"/><link name="link0"/><joint name="base" type="fixed"><parent link="base"/>',
        f'<child link="link0"/><origin rpy="0 0 {base_turn!r}"/></joint>',
    ]
    for k, (origin, rpy, mass, center, tensor_turns, tensor) in enumerate(links, start=1):
        names = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
        values = " ".join(f'{name}="{value!r}"' for name, value in zip(names, tensor, strict=True))
        parts += [
            f'<joint name="joint{k}" type="continuous"><parent link="link{k - 1}"/><child link="link{k}"/>',
            f'<origin xyz="{origin}" rpy="{quarter_turns(rpy)}"/><axis xyz="0 0 1"/></joint>',
            f'<link name="link{k}"><inertial><origin xyz="{center}" rpy="{quarter_turns(tensor_turns)}"/>',
            f'<mass value="{mass}"/><inertia {values}/>',
            "</inertial></link>",
        ]
    parts.append(
        f'<link name="tip"/><joint name="tip" type="fixed"><parent link="link{len(links)}"/>'
        f'<child link="tip"/><origin xyz="{tip}"/></joint>'
    )
    return f'<robot name="published">{"".join(parts)}</robot>'


def same_robot(library_robot, published):
    for q in configurations(library_robot.chain, 10):
        np.testing.assert_allclose(
            chain_kinematics.forward_kinematics(library_robot.chain, q),
            chain_kinematics.forward_kinematics(published.chain, q),
            atol=1e-12,
        )
        M = mass_matrix(published.model, q)
        np.testing.assert_allclose(mass_matrix(library_robot.model, q), M, atol=1e-9 * M.max())


def test_kuka_iiwa14_is_the_published_urdf():
    links = [(*link[:4], (0, 0, 0), (*link[4], 0.0, 0.0, 0.0)) for link in IIWA_LINKS]
    published = load_urdf(urdf(links, 0.0, "0 0 0.045"), base="base", tip="tip")
    same_robot(load_path(library.find("kuka_iiwa14")), published)


def test_ur5e_is_the_published_urdf_seen_from_its_base_frame():
    """From ROS's ``base``; ``base_link`` is the same turned by 180° about z."""
    links = [(*link[:4], (link[4], 0, 0), INERTIAS["ur5e"][k][2]) for k, link in enumerate(UR5E_LINKS)]
    published = load_urdf(urdf(links, 0.0, "0 0 0"), base="base", tip="tip")
    same_robot(load_path(library.find("ur5e")), published)


def test_stanford_arm_carries_the_moments_about_the_frames_origins():
    """Paul 1981's moments are about the origins of the DH frames, its centres of mass in decimetres."""
    model = mujoco.MjModel.from_xml_path(str(library.find("stanford_arm")))
    data = mujoco.MjData(model)
    q = np.array([0.3, -0.7, 0.5, 1.1, -0.4, 0.9])
    data.qpos[:] = q
    mujoco.mj_forward(model, data)
    frames = dh_product.frames(dh_table("stanford_arm"), q)
    for k, (T, (mass, published_center, moments)) in enumerate(zip(frames, STANFORD_LINKS, strict=True)):
        assert model.body_mass[k + 1] == mass
        center = T[:3, :3].T @ (data.xipos[k + 1] - T[:3, 3])
        np.testing.assert_allclose(center, published_center, atol=1e-12)
        R = T[:3, :3].T @ data.ximat[k + 1].reshape(3, 3)
        about_center = R @ np.diag(model.body_inertia[k + 1]) @ R.T
        shift = mass * (center @ center * np.eye(3) - np.outer(center, center))
        np.testing.assert_allclose(about_center + shift, np.diag(moments), atol=1e-10)
    assert model.dof_armature.tolist() == [0.953, 2.193, 0.782, 0.106, 0.097, 0.02]


@pytest.mark.parametrize("mechanism", library.mechanisms(), ids=lambda each: each.name)
def test_a_mechanism_is_not_a_robot(mechanism):
    """By its name and by its file, naming the analysis that takes it, which then does."""
    for source in (mechanism.name, mechanism.path):
        with pytest.raises(ModelError, match=f'"{mechanism.name}" is a mechanism with closed loops') as refused:
            load(source)
        analysis = refused.value.message.partition("the analysis ")[2].split(",")[0].split()[0]
        lengths = {"base_m": 1, "proximal_m": 1, "distal_m": 1}
        parse_job({"analysis": analysis} | (lengths if analysis == "five_bar" else {"mechanism": mechanism.name}))


# --- shapes ---------------------------------------------------------------------------------------------

# Radii of capsules along the links [m], of arms whose sources state no bodies; True: the base has one too.
ALONG_LINKS = {
    "articulated": (0.015, False), "cartesian": (0.015, False), "cylindrical": (0.015, False), "scara": (0.015, False),
    "slave_5r": (0.015, False), "spherical": (0.015, False), "dvrk_mtm": (0.02, False), "phantom_omni": (0.01, False),
    "gao_6r": (0.03, True), "puma560": (0.06, True), "stanford_arm": (0.04, True),
}  # fmt: skip


@pytest.mark.parametrize("name", ALONG_LINKS)
def test_capsules_are_those_along_the_links_of_the_table(name):
    radius, with_base = ALONG_LINKS[name]
    table = load_dh(dh_table(name).model_copy(update={"link_radius": radius})).bodies
    bodies = load_path(library.find(name)).bodies
    q = configurations(bodies.chain, 3)

    def placed(of):
        kept = [shape for shape in of.shapes if with_base or shape.body != "base"]
        poses = dict(zip((shape.name for shape in of.shapes), np.swapaxes(of.poses(q), 0, 1), strict=True))
        return {shape.name: (shape, poses[shape.name]) for shape in kept}

    found, expected = placed(bodies), placed(table)
    assert found.keys() == expected.keys()
    for key, (shape, poses) in found.items():
        theirs, T = expected[key]
        assert shape.kind == "capsule"
        np.testing.assert_allclose(shape.size, theirs.size, atol=1e-6)
        np.testing.assert_allclose(poses[..., :3, 3], T[..., :3, 3], atol=1e-6)
        np.testing.assert_allclose(np.abs((poses[..., 2] * T[..., 2]).sum(axis=-1)), 1.0, atol=1e-9)  # axes, either way

    def pairs(of):
        names = [{of.shapes[k].name for k in pair} for pair in of.pairs.tolist()]
        return sorted(sorted(pair) for pair in names if pair <= found.keys())

    assert pairs(bodies) == pairs(table)
    text = (library.find(name).parent / "README.md").read_text()
    assert f"capsules of radius {radius:g} m along the links" in text


@pytest.mark.parametrize("name", NAMES)
def test_shapes_stand_where_plain_mujoco_puts_them_and_pairs_are_those_that_it_tests(name):
    model, bodies = mujoco.MjModel.from_xml_path(str(library.find(name))), load_path(library.find(name)).bodies
    data, q = mujoco.MjData(model), configurations(bodies.chain, 5)
    assert len(bodies.shapes) == model.ngeom > 0
    for row, poses in zip(q, bodies.poses(q), strict=True):
        data.qpos[:] = row
        mujoco.mj_kinematics(model, data)
        np.testing.assert_allclose(poses[:, :3, 3], data.geom_xpos, atol=1e-12)
        np.testing.assert_allclose(poses[:, :3, :3], data.geom_xmat.reshape(-1, 3, 3), atol=1e-12)
    assert {frozenset(pair) for pair in bodies.pairs.tolist()} == contacts_of(model)


@pytest.mark.parametrize("name", NAMES)
def test_arms_are_free_in_the_middle_of_their_ranges(name):
    """And nowhere does a pair collide always; the README says how often the arm does."""
    bodies = load_path(library.find(name)).bodies
    data, q = mujoco.MjData(bodies.model), configurations(bodies.chain, 400)
    q[0] = (bodies.chain.lower_limits + bodies.chain.upper_limits) / 2
    collided, always = [], None
    for qpos in bodies.qpos(q):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(bodies.model, data)
        mujoco.mj_collision(bodies.model, data)
        pairs = {tuple(sorted(contact.geom.tolist())) for contact in data.contact if contact.dist < 0}
        collided.append(bool(pairs))
        always = pairs if always is None else always & pairs
    assert not collided[0] and not always
    said = re.search(r"([\d.]+) % collide with the arm itself", (library.find(name).parent / "README.md").read_text())
    assert 100 * np.mean(collided) == pytest.approx(float(said[1]) if said else 0.0, abs=8.0 if said else 0.0)
