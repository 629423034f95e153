"""Robots of random primitives, and MuJoCo's own word on which configurations collide."""

import mujoco
import numpy as np

import wsrender as ws
from wsrender.pipeline.constraints.collision import CollisionConstraint

KINDS = ("sphere", "capsule", "cylinder", "ellipsoid", "box")


def random_text(seed: int, joints: int) -> str:
    """MJCF of a chain of random hinges and slides with random primitives and contact bits."""
    random = np.random.default_rng(seed)

    def geom(bits: int) -> str:
        kind = KINDS[random.integers(len(KINDS))]
        size, quat = random.uniform(0.03, 0.11, 3), random.normal(size=4)
        place = f'pos="{_numbers(random.uniform(-0.1, 0.1, 3))}" quat="{_numbers(quat)}"'
        return f'<geom type="{kind}" size="{_numbers(size)}" {place} contype="{bits}" conaffinity="1"/>'

    body = '<site name="tip" pos="0 0 0.1"/>'
    for number in reversed(range(joints)):
        kind, (low, span) = ("hinge", (random.uniform(-3, 0), random.uniform(0.5, 3.5)))
        if random.random() < 0.25:
            kind, (low, span) = "slide", (random.uniform(-0.3, 0), random.uniform(0.1, 0.5))
        geoms = "".join(geom(int(random.integers(2)) or 1) for _ in range(random.integers(0, 3)))
        place = f'pos="{_numbers(random.uniform(-0.25, 0.25, 3))}" quat="{_numbers(random.normal(size=4))}"'
        joint = f'<joint name="j{number}" type="{kind}" axis="0 0 1" range="{_numbers([low, low + span])}"/>'
        inertial = '<inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>'
        body = f'<body name="b{number}" {place}>{inertial}{joint}{geoms}{body}</body>'
    base = f'<body name="base">{geom(1)}{body}</body>'
    return f'<mujoco><compiler angle="radian" autolimits="true"/><worldbody>{base}</worldbody></mujoco>'


def _numbers(values) -> str:
    return " ".join(f"{value:.17g}" for value in values)


def drawn(robot: ws.Robot, count: int, seed: int = 0) -> np.ndarray:
    """Random configurations (N, n) within the limits, as single precision holds them."""
    random = np.random.default_rng(seed).random((count, robot.chain.n))
    low, high = robot.lower_limits, robot.upper_limits
    return (low + random * (high - low)).astype(np.float32).astype(np.float64)


def collides(robot: ws.Robot, q: np.ndarray, pairs: np.ndarray | None = None) -> np.ndarray:
    """Whether MuJoCo's own pipeline reports a contact between the robot's ``pairs`` of shapes, (N,) bool."""
    bodies = robot.bodies
    model, data = bodies.model, mujoco.MjData(bodies.model)
    model.geom_margin[:] = 0
    # With its default, 1e-6, cylinders of unitree_g1_left_arm that overlap by 59 µm have no contact, at one of 20,000.
    model.opt.ccd_tolerance, model.opt.ccd_iterations = 1e-9, 200  # fewer end in warnings in a file
    own = np.zeros((model.ngeom, model.ngeom), bool)
    for a, b in bodies.pairs if pairs is None else pairs:
        a, b = bodies.shapes[a].geom, bodies.shapes[b].geom
        own[a, b] = own[b, a] = True
    found = np.zeros(len(q), bool)
    for i, qpos in enumerate(bodies.qpos(q)):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        mujoco.mj_collision(model, data)
        if data.ncon:
            found[i] = own[tuple(data.contact.geom[data.contact.dist < 0].T)].any()
    return found


def nearest(constraint: CollisionConstraint, q: np.ndarray) -> np.ndarray:
    """Least signed distance (N,) [m] over a constraint's pairs, by MuJoCo."""
    pairs, distances = constraint.own, constraint.distances
    from wsrender.collision.distance import frames_of

    frames, least = frames_of(constraint.chain, q), np.full(len(q), np.inf)
    for a, b in pairs.pairs:
        T_a, T_b = (frames[:, pairs.solids[k].joint + 1] @ pairs.solids[k].T for k in (a, b))
        least = np.minimum(least, distances.between(a, b, T_a, T_b, 2.0))
    return least
