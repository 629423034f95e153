"""Labels where coordinates are unlike those of most robots: none, endless, far from zero, coupled, moved by others."""

import re

import numpy as np
import pytest

import wsrender as ws
from tests.collision.robots import drawn, nearest, random_text
from tests.collision.test_labels import SELF, labels, wrong
from wsrender.collision import certificates, program, store
from wsrender.collision.store import stored_program
from wsrender.robot.constraints import constraints_for
from wsrender.robots.model_warning import ModelWarning

INERTIAL = '<inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>'


def with_fingers(kind, apart):
    """An arm whose tip is held by two shapes on slides of their own, which stand still, so far from each other."""
    fingers = "".join(
        f'<body name="f{sign}" pos="0.5 {sign * (0.02 + apart / 2):.17g} 0">{INERTIAL}'
        f'<joint name="f{sign}" type="slide" axis="0 1 0" range="-0.1 0.1"/>'
        f'<geom name="g{sign}" type="{kind}" size="0.02 0.02 0.02"/></body>'
        for sign in (1, -1)
    )
    text = f"""<mujoco><compiler angle="radian" autolimits="true"/><worldbody><body name="base">
    <body name="one">{INERTIAL}<joint name="a" axis="0 0 1" range="-3 3"/>
    <body name="two" pos="0.5 0 0">{INERTIAL}<joint name="b" axis="0 1 0" range="-1 1"/>
    <site name="tip" pos="0.5 0 0"/>{fingers}</body></body></body></worldbody></mujoco>"""
    return ws.load_robot(text, tip="tip")


@pytest.mark.parametrize("kind", ["sphere", "box"])
@pytest.mark.parametrize("apart", [0.02, 5e-6, -5e-6])
def test_shapes_that_do_not_move_against_each_other(kind, apart, device):
    robot = with_fingers(kind, apart)
    (constraint,) = constraints_for(robot, SELF)
    corners = np.array([[a, b] for a in (-3, 0, 3) for b in (-1, 0, 1)], float)
    assert (labels(robot, corners, (constraint,), device=device) == (apart < 0)).all()


def near_boundary(constraint, q):
    """Configurations between free and colliding ones of ``q``, halved to a few micrometres of the boundary."""
    least = nearest(constraint, q)
    free, hit = q[least > 0], q[least < 0]
    count = min(len(free), len(hit), 400)
    free, hit = free[:count], hit[:count]
    for _ in range(40):
        middle = (free + hit) / 2
        blocked = (nearest(constraint, middle) < 0)[:, None]
        free, hit = np.where(blocked, free, middle), np.where(blocked, middle, hit)
    step = np.random.default_rng(0).normal(size=free.shape) * 2e-5
    return np.concatenate([free, hit, free + step, hit - step])


@pytest.mark.parametrize("precision", ["float32", "float64"])
@pytest.mark.parametrize(("seed", "far"), [(2, 10), (2, 3000), (7, 1000)])
def test_joints_without_limits_far_from_zero(seed, far, precision, device):
    hinge = r'type="hinge" axis="0 0 1" range="[^"]*"'
    robot = ws.load_robot(re.sub(hinge, 'type="hinge" axis="0 0 1" limited="false"', random_text(seed, 4)))
    constraints = constraints_for(robot, SELF)
    q = np.random.default_rng(seed).uniform(-far, far, (4000, robot.chain.n))
    slides = ~robot.chain.revolute
    if slides.any():
        q[:, slides] = drawn(robot, len(q))[:, slides]
    q = near_boundary(constraints[0], q)
    q = q if precision == "float64" else q.astype(np.float32).astype(np.float64)
    least = nearest(constraints[0], q)
    found = labels(robot, q, constraints, precision, device)
    assert 0.2 < (found > 0).mean() < 0.8
    assert not wrong(found > 0, least < 0, least).size


def test_limits_of_many_turns(device):
    hinge = r'type="hinge" axis="0 0 1" range="[^"]*"'
    text = re.sub(hinge, 'type="hinge" axis="0 0 1" range="900 1000"', random_text(7, 4))
    with pytest.warns(ModelWarning, match="look like degrees"):
        robot = ws.load_robot(text)
    constraints = constraints_for(robot, SELF)
    q = near_boundary(constraints[0], drawn(robot, 4000)).astype(np.float32).astype(np.float64)
    least = nearest(constraints[0], q)
    assert not wrong(labels(robot, q, constraints, device=device) > 0, least < 0, least).size


def test_every_cell_of_a_table(device, tmp_path, monkeypatch):
    """Of a table of few cells, each is looked at: labels of the kernels against MuJoCo's."""
    monkeypatch.setenv(store.FOLDER, str(tmp_path))
    for module in (certificates, program):
        monkeypatch.setattr(module, "CELLS", 32)
    text = f"""<mujoco><compiler angle="radian" autolimits="true"/><worldbody><body name="base">
    <geom type="box" size=".1 .1 .2" pos="0 0 -.3"/><body name="one">{INERTIAL}<joint axis="0 0 1" range="-2 3"/>
    <body name="two" pos=".1 0 0">{INERTIAL}<joint axis="0 1 0" range="-1 3"/>
    <geom type="box" size=".2 .02 .03" pos=".2 0 0"/><site name="tip" pos=".5 0 0"/></body></body></body>
    </worldbody></mujoco>"""
    robot = ws.load_robot(text)
    (constraint,) = constraints_for(robot, SELF)
    assert len(stored_program(constraint.own, constraint.chain, constraint.distances).tables) == 1
    low, high = robot.lower_limits, robot.upper_limits
    cells = np.stack(np.meshgrid(np.arange(32), np.arange(32), indexing="ij"), -1).reshape(-1, 1, 2)
    within = np.random.default_rng(0).uniform(0.02, 0.98, (32 * 32, 6, 2))
    q = (low + (cells + within) / 32 * (high - low)).reshape(-1, 2).astype(np.float32).astype(np.float64)
    least = nearest(constraint, q)
    assert not wrong(labels(robot, q, (constraint,), device=device) > 0, least < 0, least).size
