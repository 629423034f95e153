"""The configuration in which a robot is shown before anybody has chosen one."""

from collections.abc import Callable

import numpy as np

from wsrender.robots.chain import Chain
from wsrender.robots.kinematics import Kinematics

STEP = np.deg2rad(15.0)  # in which revolute joints stand
SLIDES = 9  # places of a prismatic joint
STARTS = 24
SWEEPS = 4
AHEAD = np.array([0.48, -0.43, 0.30])  # where the tip is wanted, in reaches from the base: towards who looks
APART = 0.12  # reaches that parts of an arm which aren't neighbours keep
UPRIGHT = 0.9  # cosine up to which a base stands on a floor
ABOVE = 0.03  # reaches over the plane of the base
# What costs as much as a reach between the tip and where it is wanted:
BELOW, MEET = 5.0, 5.0  # a reach below, or too near
DOWN, HIGH = 0.1, 0.3  # a tool that looks down instead of sideways; an elbow that stands a reach high
MIDDLE = 0.03  # each joint at the end of its range instead of the middle


def stance(robot: Kinematics, free: Callable[[np.ndarray], bool] = lambda q: True) -> np.ndarray:
    """A posture that looks like an arm, (n,): bent, above its base, its tip ahead; the best of a coordinate search.

    Distances of its joints' origins decide; ``free`` says of which (n,) its bodies are apart: where none that was found
    is, the middle of the ranges, or the best all the same. The same for the same robot, within its limits; of one whose
    links are not known a quarter into the ranges.
    """
    chain = robot.geometry
    if chain is None:
        return robot.within(0.25)
    levels = [_levels(chain, joint) for joint in range(chain.n)]
    draw = np.random.default_rng(0)
    q = np.array([[draw.choice(each) for each in levels] for _ in range(STARTS)])
    q[0] = [each[len(each) // 2] for each in levels]
    for _ in range(SWEEPS):
        for joint, each in enumerate(levels):
            tried = np.repeat(q[:, None], len(each), axis=1)
            tried[:, :, joint] = each
            best = _costs(chain, tried.reshape(-1, chain.n)).reshape(len(q), -1).argmin(axis=1)
            q[:, joint] = each[best]
    best = q[_costs(chain, q).argsort(kind="stable")]
    return next((each for each in (*best, chain.within(0.5)) if free(each)), best[0])


def _range(chain: Chain) -> tuple[np.ndarray, np.ndarray]:
    """Ends of the ranges, within half a turn about 0 or about the middle where 0 isn't allowed."""
    lower, upper = chain.within(0.0), chain.within(1.0)
    middle = np.where((lower <= 0) & (upper >= 0), 0.0, (lower + upper) / 2)
    half = np.where(chain.revolute, np.pi, np.inf)
    return np.maximum(lower, middle - half), np.minimum(upper, middle + half)


def _levels(chain: Chain, joint: int) -> np.ndarray:
    """Values that a joint may have: round ones, or where none is within its range its middle."""
    lower, upper = (float(end[joint]) for end in _range(chain))
    if not chain.revolute[joint]:
        return np.linspace(lower, upper, SLIDES)
    found = STEP * np.arange(np.ceil(lower / STEP), np.floor(upper / STEP) + 1)
    return found if len(found) else np.array([(lower + upper) / 2])


def _costs(chain: Chain, q: np.ndarray) -> np.ndarray:
    """How little each posture (N, n) looks like an arm, (N,), in reaches."""
    reach = chain.reach if np.isfinite(chain.reach) and chain.reach > 0 else 1.0
    R, base = chain.T_world_base[:3, :3], chain.T_world_base[:3, 3]
    if R[2, 2] > UPRIGHT:
        R = np.eye(3)  # seen from the same side however it is turned
    frames = chain.frames(q)
    at = (frames[..., :3, 3] - base) @ R / reach
    cost = np.linalg.norm(at[:, -1] - AHEAD, axis=1)
    cost += BELOW * np.clip(ABOVE - at[:, 1:, 2], 0.0, None).sum(axis=1)
    cost += DOWN * frames[:, -1, :3, 2] @ R[:, 2] - HIGH * np.minimum(at[..., 2].max(axis=1), 0.6)
    cost += MEET * _nearness(at)
    lower, upper = _range(chain)
    span = np.where(upper > lower, upper - lower, 1.0)
    return cost + MIDDLE * np.abs(2 * (q - lower) / span - 1).sum(axis=1)


def _nearness(at: np.ndarray) -> np.ndarray:
    """By how much parts that aren't neighbours are too near to each other, (N,): origins and what is half-way."""
    points = np.empty((len(at), 2 * at.shape[1] - 1, 3))
    points[:, ::2], points[:, 1::2] = at, (at[:, 1:] + at[:, :-1]) / 2
    along = np.cumsum(np.linalg.norm(np.diff(points, axis=1, prepend=points[:, :1]), axis=2), axis=1)
    i, j = np.triu_indices(points.shape[1], 1)
    near = APART - np.linalg.norm(points[:, i] - points[:, j], axis=2)
    return np.where(along[:, j] - along[:, i] > 2 * APART, np.clip(near, 0.0, None), 0.0).sum(axis=1)
