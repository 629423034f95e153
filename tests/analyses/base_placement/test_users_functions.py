"""Constraints and indices of users see where the base stands: as of the robot placed there, against brute force."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.analyses.base_placement.test_base_placement import DOWN, RING, TURNED, bases_of, job, labels_of, seen_from
from tests.reference import closed_form_inverse as closed_form
from tests.reference.published_robots import dh_table
from wsrender.documents.constraints import Constraints
from wsrender.indices import index_catalogue
from wsrender.pipeline.constraints import registry
from wsrender.robot.constraints import constraints_for
from wsrender.run import execute, plan

ROWS = [{"a": a, "alpha_deg": 90, "d": 0.2, "limits_deg": [-180, 180]} for a in (0.1, 0.4, 0.3)]
WEIGHTLESS = {"dh": {"convention": "standard", "rows": ROWS}}
GRAVITY = (1.0, 2.0, -9.0)
OVER = {
    "x_m": [-0.6, 0.6, 0.4],
    "y_m": [-0.4, 0.4, 0.4],
    "z_m": -0.2,
    "pitch_deg": [0, 40, 40],
    "yaw_deg": [0, 360, 90],
}


@pytest.fixture(autouse=True)
def added(monkeypatch):
    """What the test adds is forgotten."""
    monkeypatch.setattr(registry, "_ADDED", {})
    monkeypatch.setattr(index_catalogue, "_ADDED", dict(index_catalogue._ADDED))


def seen(q, J, frames, position, axes, share=0.3):
    """Of what the base's place and turns change."""
    return frames[2].position[2] + share * q[1] * axes[0][1] + J[0][1] * position[1] + J[4][2] - frames[1].axes[1][0]


def elbow_up(q, position, axes, frames, J, height=0.0):
    return frames[2].position[2] - height + 0.1 * J[1][0]


def every_solution(robot, bases):
    """Poses' solutions (P, K, s, n) and which are within limits, (P, K, s)."""
    positions, rotations = seen_from(bases, RING, [DOWN] * 6)
    with np.errstate(invalid="ignore"):
        arm = closed_form.puma560_arm(positions.reshape(-1, 3))
        q = closed_form.with_spherical_wrist("puma560", arm, rotations.reshape(-1, 3, 3))
    inside = closed_form.within_limits(q, robot.lower_limits, robot.upper_limits, robot.chain.revolute)
    low, high = robot.lower_limits, robot.upper_limits
    q = (low + high) / 2 + np.remainder(q - (low + high) / 2 + np.pi, 2 * np.pi) - np.pi
    return (each.reshape(len(bases), 6, *each.shape[1:]) for each in (q, inside))


def values_at(robot, bases, q, inside, function):
    """``function`` (robot, q) of the robot placed at each base; -inf where there is no solution."""
    values = np.full(inside.shape, -np.inf)
    for k, base in enumerate(bases):
        where = ws.Transform(
            position_m=base[:3, 3], quat_wxyz=Rotation.from_matrix(base[:3, :3]).as_quat(scalar_first=True)
        )
        values[k][inside[k]] = function(robot.placed(where), q[k][inside[k]])
    return values


@pytest.mark.parametrize("mounting", ["floor", "wall"])
def test_an_index_is_that_of_the_robot_where_it_stands(mounting):
    ws.register_index("seen", seen, range=(-np.inf, np.inf), options=[ws.Option("share", 0.3)])
    over = OVER if mounting == "floor" else OVER | {"pitch_deg": 0, "x_m": [-1, 0, 0.5]}
    document = job(dh_table("puma560"), RING, [DOWN] * 6, over=over, mounting=mounting, index="seen")
    result, robot, bases = execute(document), ws.load_robot(dh_table("puma560")), bases_of(document)
    q, inside = every_solution(robot, bases)
    values = values_at(robot, bases, q, inside, lambda there, q: ws.evaluate_indices(there, q, ["seen"])["seen"])
    best = values.max(axis=2)
    served = np.isfinite(best)
    least = np.where(served.any(axis=1), np.where(served, best, np.inf).min(axis=1), np.nan)
    assert 0.05 < served.mean() < 0.95 and ((labels_of(result) == "served") == served).all()
    assert result.tables["placements"]["seen"] == pytest.approx(least, abs=1e-6, nan_ok=True)
    assert result.document["best"]["seen"] == pytest.approx(least[served.sum(1) == served.sum(1).max()].max(), abs=1e-6)


@pytest.mark.parametrize("on_host", [False, True])
def test_a_constraint_blocks_where_all_postures_of_the_robot_there_violate_it(on_host):
    above = {"height": 0.02 if on_host else 0.2}
    if on_host:
        ws.register_constraint("own", lambda q, poses, height=0.0: poses[:, 1, 3] * q[:, 2] > height, on_host=True)
    else:
        ws.register_constraint("own", elbow_up)
    document = job(dh_table("puma560"), RING, [DOWN] * 6, over=OVER, constraints={"own": above})
    result, robot, bases = execute(document), ws.load_robot(dh_table("puma560")), bases_of(document)
    q, inside = every_solution(robot, bases)

    def admitted(there, q):
        (own,) = constraints_for(there, Constraints(own=above))
        return np.where(own.host(q, there.chain.poses(q)) == 0, 1.0, 0.0)

    best = values_at(robot, bases, q, inside, admitted).max(axis=2)
    expected = np.select([best > 0.5, best > -0.5], ["served", "own"], "unreachable")
    assert (labels_of(result) == expected).all() and 0.05 < (expected == "own").mean() < 0.5
    assert (result.tables["targets"]["label"] == "reachable").sum() == (expected == "served").sum(axis=1).max()


def test_yaws_are_all_tried_where_a_function_may_see_them():
    ws.register_constraint("own", elbow_up)
    for constraints, alike in (({}, 6), ({"own": True}, 1)):
        assert plan(job("ur5e", RING, [DOWN] * 6, over=TURNED, constraints=constraints))._alike == alike


def test_functions_of_all_that_there_is_move_with_the_arm():
    """Of an arm that is moved and turned, they are those of the same arm placed there."""

    def everything(q, position, axes, J, M, g, limits, frames):
        first = q[1] * limits.upper[2] + J[0][1] * J[4][2] + M[1][2] - g[1] / limits.effort[1]
        return first + frames[2].position[2] * frames[1].axes[0][1] + position[0] * axes[1][2]

    ws.register_constraint("own", everything)
    random = np.random.default_rng(1)
    robot = ws.load_robot("ur5e", placement=ws.Transform(position_m=(0.2, 0.1, 0), rpy_deg=(20, -35, 70)))
    (own,) = constraints_for(robot, Constraints(own=True), gravity=GRAVITY)
    q = random.uniform(robot.lower_limits, robot.upper_limits, (20, 6))
    moved = np.tile(np.eye(4), (20, 1, 1))
    moved[:, :3, :3] = Rotation.random(20, rng=random).as_matrix()
    moved[:, :3, 3] = random.normal(size=(20, 3))
    found = own.values(q, moved @ robot.chain.poses(q), moved)
    for k, D in enumerate(moved):
        base = D @ robot.chain.T_world_base
        turn = Rotation.from_matrix(base[:3, :3]).as_quat(scalar_first=True)
        there = robot.placed(ws.Transform(position_m=base[:3, 3], quat_wxyz=turn))
        (placed,) = constraints_for(there, Constraints(own=True), gravity=GRAVITY)
        assert found[k] == pytest.approx(placed.values(q[k : k + 1], there.chain.poses(q[k : k + 1]))[0], abs=1e-9)


def test_what_users_functions_lack_is_said():
    ws.register_constraint("heavy", lambda q, position, axes, g: g[1])
    with pytest.raises(ws.InputError, match=r"constraints\.heavy: takes g, and the model of"):
        plan(job(WEIGHTLESS, RING, over=OVER, constraints={"heavy": True}))
    with pytest.raises(ws.InputError, match=r"constraints\.light: unknown constraint; allowed: .*heavy"):
        plan(job("ur5e", RING, [DOWN] * 6, over=OVER, constraints={"light": True}))
