"""Polytopes at configurations: against MuJoCo's J, M and g, linear programs, the indices' radii, and pycapacity."""

import numpy as np
import pytest
from scipy.optimize import linprog

import wsrender as ws
from tests.indices.test_chain_indices import CASES, ROWS, WALL, Case
from wsrender.geometry.polytopes import LIMIT_N, polytopes
from wsrender.indices.index_catalogue import find
from wsrender.robots.dynamics import gravity_torques, inertia_matrices

KINDS = ("velocity", "force", "acceleration")
DIRECTIONS = np.random.default_rng(5).normal(size=(40, 3))
SINGULAR = [0.0, -1.2, 0.0, 0.4, 0.3, 0.0]  # of the UR5e, its elbow stretched


def reach_along(case, row, kind, rows, limit):
    """How far the polytope goes along `DIRECTIONS` in the task's rows, by linear programs, (40,); NaN: it is empty."""
    J, _, M, g = case.at_rest(row)
    A, (back, forth), speeds = J[rows], case.efforts, case.robot.chain.velocity_limits
    if kind == "velocity":
        bounds, shift = np.stack([-speeds, speeds], axis=1), 0.0
    elif kind == "acceleration":
        A = A @ np.linalg.inv(M)
        bounds, shift = np.stack([back, forth], axis=1), -A @ g
    found = []
    for d in DIRECTIONS[:, rows]:
        if kind == "force":
            both = np.vstack([A.T, -A.T]), np.concatenate([forth - g, g - back])
            found.append(linprog(-d, A_ub=both[0], b_ub=both[1], bounds=[(-limit, limit)] * len(rows)).fun)
        else:
            found.append(linprog(-d @ A, bounds=bounds).fun - (d @ shift if kind == "acceleration" else 0.0))
    return np.array([np.nan if each is None else -each for each in found])


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("name", "task"), CASES)
def test_they_go_as_far_as_linear_programs_do(name, task, kind):
    """In world axes of an arm on a tilted base, in the task's rows; vertices and facets say the same."""
    case, rows = Case(name), ROWS[task]
    q, empty = case.configurations(12), 0
    for row in q:
        found = ws.polytope(case.robot, row, kind, task, gravity_m_s2=case.gravity, limit_N=500)
        expected = reach_along(case, row, kind, rows, 500)
        if not len(found.vertices):
            empty += 1
            assert np.isnan(expected).all() and found.radius == 0
            continue
        inner = found.vertices @ case.axes  # in base axes
        size = np.abs(inner).max()
        assert np.abs(np.delete(inner, rows, axis=1)).max(initial=0) < 1e-9 * size
        np.testing.assert_allclose((inner[:, rows] @ DIRECTIONS[:, rows].T).max(axis=0), expected, atol=1e-7 * size)
        slack = found.facets[:, 3] - found.vertices @ found.facets[:, :3].T
        on = np.abs(slack) < 1e-9 * size
        assert slack.min() > -1e-9 * size and (on.sum(axis=0) >= found.dimension).all()
        assert (on.sum(axis=1) >= found.dimension).all()
    assert empty < len(q)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("name", "task"), CASES)
def test_radii_are_those_of_the_indices(name, task, kind):
    case = Case(name, WALL)
    q = case.configurations(60)
    if name == "ur5e":
        q[0] = SINGULAR
    expected = case.values(q, f"{kind}_radius", "float64", "cpu", task)
    found = [ws.polytope(case.robot, row, kind, task, gravity_m_s2=case.gravity).radius for row in q]
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-9 * expected.max())
    assert (expected > 0).any() or (name, kind) == ("arm", "force")


def test_forces_are_cut_where_the_index_is_by_default():
    (limit,) = (option.default for option in find("force_radius").options if option.name == "limit_N")
    assert limit == LIMIT_N


def test_a_flat_polytope_is_a_polygon():
    """Of an arm in its plane, in three rows: no ball fits, and what the arm can do is a parallelogram."""
    rows = [{"a": 0.4, "limits_deg": [-150, 150]}, {"a": 0.3, "limits_deg": [-150, 150]}]
    arm = ws.load_robot(ws.DHTable(convention="standard", rows=rows), velocity_limits={"joint1": 1, "joint2": 2})
    flat, plane = (ws.polytope(arm, [0.3, 1.0], task=task) for task in ("linear", ["x", "y"]))
    J = arm.jacobian([0.3, 1.0])[0, :2] * [1, 2]
    for each in (flat, plane):
        assert each.dimension == 2 and len(each.vertices) == 4
        assert each.volume == pytest.approx(4 * abs(np.linalg.det(J)))
        assert each.mesh(1.0).area == pytest.approx(each.volume)
    assert flat.radius == 0
    assert plane.radius == pytest.approx(abs(np.linalg.det(J)) / np.linalg.norm(J, axis=0).max())
    stretched = ws.polytope(arm, [0.3, 0.0], task=["x", "y"])
    assert (stretched.dimension, len(stretched.vertices), stretched.radius) == (1, 2, 0.0)
    assert stretched.volume == pytest.approx(2 * (0.7 + 2 * 0.3))
    with pytest.raises(ws.InputError, match="mesh: the polytope of velocity has dimension 1 here, and no area"):
        stretched.mesh()


def test_meshes_are_closed_and_stand_at_the_tip(tmp_path):
    case = Case("franka_panda")
    (row,) = case.configurations(1, seed=3)
    tip = case.robot.forward_kinematics(row)[0, :3, 3]
    for kind in KINDS:
        found = ws.polytope(case.robot, row, kind)
        mesh = found.mesh(2.0, at_tip=False)
        assert mesh.is_watertight and mesh.volume == pytest.approx(8 * found.volume) and found.volume > 0
        mesh = found.mesh()
        offset = np.linalg.norm(mesh.vertices - tip, axis=1).max()
        assert offset == pytest.approx(0.3 * case.robot.chain.reach)
        for ending in ("stl", "obj", "ply", "glb"):
            mesh.export(tmp_path / f"{kind}.{ending}")
            assert (tmp_path / f"{kind}.{ending}").stat().st_size > 200


def test_what_the_robot_lacks_is_named():
    robot = ws.load_robot("ur5e")
    with pytest.raises(ws.InputError, match="kind: the polytope of velocity needs speeds, which ur5e lacks of joint1"):
        ws.polytope(robot, [0] * 6)
    with pytest.raises(ws.InputError, match="kind: 'power' is not allowed; velocity, force, acceleration are"):
        ws.polytope(robot, [0] * 6, "power")
    with pytest.raises(ws.InputError, match="q: must be one configuration, not 2"):
        ws.polytope(robot, [[0] * 6] * 2, "force")
    with pytest.raises(ws.InputError, match="task: must have linear rows for the polytope of force"):
        ws.polytope(robot, [0] * 6, "force", "angular")
    with pytest.raises(ws.InputError, match="scale: must be greater than 0"):
        ws.polytope(robot, [0.1] * 6, "force").mesh(0)


@pytest.mark.parametrize("name", ["ur5e", "franka_panda", "puma560"])
def test_vertices_are_those_of_pycapacity(name):
    """1,000 configurations, 1e-9 of the largest; it rounds torques to 1e-7, so forces are told in mN.

    Where its facets meet at grazing angles its vertices have fewer digits; then they are within the same facets.
    """
    reason = "pycapacity is not installed: pip install 'wsrender[test-models]'"
    theirs = pytest.importorskip("pycapacity.robot", reason=reason)
    plain = ws.load_robot(name)
    speeds = {joint: 2 + 0.1 * k for k, joint in enumerate(plain.joint_names)}
    efforts = {joint: 60 + 7.0 * k for k, joint in enumerate(plain.joint_names)}
    robot = ws.load_robot(name, velocity_limits=speeds, effort_limits=efforts)
    chain = robot.chain
    q = np.random.default_rng(1).uniform(chain.lower_limits, chain.upper_limits, (1_000, chain.n))
    J, M = chain.jacobians(q)[:, :3], inertia_matrices(chain, q)
    g, most, fast = gravity_torques(chain, q, np.array([0, 0, -9.81])), chain.efforts[1], chain.velocity_limits
    compared, grazing = dict.fromkeys(KINDS, 0), 0
    for kind in KINDS:
        for k, found in enumerate(polytopes(robot, q, kind, (0, 1, 2), limit_N=1e9)):
            if kind == "velocity":
                other = theirs.velocity_polytope(J[k], fast, -fast).vertices
            elif kind == "acceleration":
                other = theirs.acceleration_polytope(J[k], M[k], most, -most, g[k]).vertices
            elif (np.abs(g[k]) < most).all():
                other = theirs.force_polytope(J[k], 1e3 * most, -1e3 * most, 1e3 * g[k]).vertices / 1e3
            else:
                continue
            distance = np.linalg.norm(np.asarray(other).T[:, None] - found.vertices, axis=2)
            size = np.abs(found.vertices).max()
            if max(distance.min(axis=0).max(), distance.min(axis=1).max()) > 1e-9 * size:
                beyond = np.asarray(other).T @ found.facets[:, :3].T - found.facets[:, 3]
                assert beyond.max() < 1e-9 * size and np.abs(beyond.max(axis=0)).max() < 1e-9 * size, (kind, k)
                grazing += 1
            compared[kind] += 1
    assert grazing <= 3
    assert compared["velocity"] == compared["acceleration"] == 1_000 and compared["force"] > 500
