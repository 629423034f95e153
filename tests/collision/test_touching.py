"""Every pair of kinds of solids, from apart to deep inside each other, against convex optimisation."""

from dataclasses import replace
from itertools import combinations_with_replacement

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.collision.convex import depth_along, touch
from tests.collision.test_labels import labels
from wsrender.collision import certificates as certified
from wsrender.collision import store
from wsrender.collision.certificates import FREE, HIT, MIXED, certificates
from wsrender.collision.distance import Distances, frames_of
from wsrender.collision.solids import BASE, Pairs, Solid
from wsrender.engine import collision as engine
from wsrender.pipeline.constraints.collision import CollisionConstraint

SIZES = {"capsule": (0.02, 0.19, 0.0), "half_space": (1.0, 1.0, 1.0)}
VERTICES = np.random.default_rng(3).normal(size=(30, 3)) * [0.11, 0.07, 0.05]
KINDS = ("sphere", "capsule", "cylinder", "ellipsoid", "box", "hull")
PAIRS = [("half_space", kind) for kind in KINDS] + list(combinations_with_replacement(KINDS, 2))
COUNT = 1000


def solid(kind, joint=BASE):
    size = np.array(SIZES.get(kind, (0.11, 0.07, 0.05)))
    return Solid(f"{kind} {joint}", kind, joint, np.eye(4), size, VERTICES if kind == "hull" else None)


def moving(**joints):
    """A robot whose last joint moves by joints along or about axes, by name: (type, axis, range)."""
    body, inertial = '<site name="tip"/>', '<inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>'
    for name, (kind, axis, reach) in reversed(joints.items()):
        joint = f'<joint name="{name}" type="{kind}" axis="{axis}" range="-{reach} {reach}"/>'
        body = f'<body name="{name}">{inertial}{joint}{body}</body>'
    text = f'<mujoco><compiler angle="radian"/><worldbody><body name="base">{body}</body></worldbody></mujoco>'
    return ws.load_robot(text)


def free_body():
    """A robot whose last joint stands anywhere."""
    axes = {"x": "1 0 0", "y": "0 1 0", "z": "0 0 1"}
    slides = {name: ("slide", axis, 1) for name, axis in axes.items()}
    return moving(**slides, **{f"about_{name}": ("hinge", axes[name], 3.2) for name in "zyx"})


def poses(seed, spread=0.1):
    """Configurations (N, 6) of the free body around the origin, a part of them aligned, concentric or both."""
    random = np.random.default_rng(seed)
    q = np.column_stack([random.normal(size=(COUNT, 3)) * spread, random.uniform(-3.14, 3.14, (COUNT, 3))])
    q[:40, 3:] = np.pi / 2 * random.integers(-1, 2, (40, 3))
    q[20:60, :3] = 0
    q[60:100, :2] = 0
    return q.astype(np.float32).astype(np.float64)


@pytest.mark.parametrize(("kind", "other"), PAIRS)
def test_labels_and_distances_of_two_kinds(kind, other, device, tmp_path, monkeypatch):
    monkeypatch.setenv(store.FOLDER, str(tmp_path))
    robot, pair = free_body(), (solid(kind), solid(other, 5))
    q = poses(PAIRS.index((kind, other)))
    frames = frames_of(robot.chain, q)
    T_a, T_b = frames[:, 0], frames[:, 6]
    touching, apart = touch(pair[0], T_a, pair[1], T_b)
    assert not (touching & apart).any()
    assert (touching | apart).mean() > 0.99
    assert min(touching.mean(), apart.mean()) > 0.02
    distance = Distances(pair).between(0, 1, T_a, T_b, 2.0)
    assert (distance[touching] < 1e-6).all()
    assert (distance[apart] > -1e-6).all()
    if kind != "half_space":
        directions = np.random.default_rng(0).normal(size=(400, 3))
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        assert (-distance <= depth_along(pair[0], T_a, pair[1], T_b, directions) + 1e-7).all()

    constraint = CollisionConstraint("self_collision", robot.chain, pair, np.array([[0, 1]]))
    asked = []
    own = engine.blocked_by
    monkeypatch.setattr(engine, "blocked_by", lambda *args: asked.append(len(args[3])) or own(*args))
    blocked = labels(robot, q, (constraint,), device=device) > 0
    clear = np.abs(distance) > 1e-6
    assert np.array_equal(blocked[clear & (touching | apart)], touching[clear & (touching | apart)])
    assert sum(asked) < 0.1 * COUNT  # the rest is the kernels' own word


@pytest.mark.parametrize("name", ["capsule", "box"])
def test_tables_of_a_capsule_whose_axis_passes_through_a_box(name, monkeypatch):
    """MuJoCo says of some that they are apart (`wsrender.collision.distance`)."""
    monkeypatch.setattr(certified, "CELLS", 64)
    chain, random = moving(x=("slide", "1 0 0", 0.1), y=("slide", "0 1 0", 0.1)).chain, np.random.default_rng(5)
    still, other = solid("box" if name == "capsule" else "capsule"), solid(name, 1)
    for turn in Rotation.random(4, rng=random).as_matrix():
        T = np.eye(4)
        T[:3, :3] = turn
        pairs = Pairs.of((still, replace(other, T=T)), (np.array([[0, 1]]), 0.0, False))
        (table,) = certificates(pairs, chain, Distances(pairs.solids)).tables
        q = random.uniform(-0.1, 0.1, (2000, 2))
        frames = frames_of(chain, q)
        touching, apart = touch(pairs.solids[0], frames[:, 0], pairs.solids[1], frames[:, 2] @ T)
        label = table.labels[tuple(((q + 0.1) / 0.2 * table.labels.shape).astype(int).T)]
        assert (label[touching] != FREE).all()
        assert (label[apart] != HIT).all()
        assert (label == MIXED).mean() < 0.5
