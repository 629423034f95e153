"""Platform poses from which no small motion leads to one that a leg reaches: proofs, where a distance bounds it.

A leg reaches its platform joint e where e lies in a set S. If |e - e'| > d for every e' in S, no motion of e by at most
d leads into it. UPS: S is a shell, and the distance is known. PUS and cranks: e' in S has an elbow at a link's length l
from it, so | |e - elbow| - l| ≤ d for one of the elbows that the limits, and the branch as seen from within d, allow.
"""

import numpy as np

from wsrender.mechanisms.mechanism import Mechanism
from wsrender.robots.reachable_box import reachable_box

ROUNDING = 1e-12  # of lengths [m]: nothing is proven by less


def proves_all(mechanism: Mechanism) -> bool:
    """Whether whatever a mechanism does not reach is proven by ever smaller motions.

    Not where cones of other joints than those at the base of UPS legs limit it, distances of legs, or legs that are
    solved numerically.
    """
    kinds = np.array(mechanism.kinds)
    turning = (mechanism.base_cone_cosine > -1) & (kinds != "UPS")
    free = not turning.any() and not (mechanism.platform_cone_cosine > -1).any()
    return free and not mechanism.constraints and not mechanism.numeric and mechanism.bodies is None


def surely_unreached(mechanism: Mechanism, poses: np.ndarray, within_m: np.ndarray) -> np.ndarray:
    """Whether no pose with platform joints within so much (N,) [m] of those of poses (N, 4, 4) is reached, (N,)."""
    position, rotation = poses[:, :3, 3], poses[:, :3, :3]
    joints = position[:, None] + np.einsum("nij,lj->nli", rotation, mechanism.platform)
    within = within_m + ROUNDING
    found = np.zeros(len(poses), bool)
    for k, kind in enumerate(mechanism.kinds):
        proof = {"UPS": _ups, "PUS": _pus}.get(kind, _crank)
        found |= proof(mechanism, k, joints[:, k], within)
    for leg in mechanism.numeric:
        tips = leg.targets(poses)[:, :3, 3]
        low, high = reachable_box(leg.chain, leg.chain.lower_limits, leg.chain.upper_limits)
        found |= np.linalg.norm(np.maximum(low - tips, 0) + np.maximum(tips - high, 0), axis=1) > within
    return found


def _ups(mechanism: Mechanism, k: int, joint: np.ndarray, within: np.ndarray) -> np.ndarray:
    reach = joint - mechanism.base[k]
    length = np.linalg.norm(reach, axis=1)
    out = (length - mechanism.upper[k] > within) | (mechanism.lower[k] - length > within)
    if mechanism.base_cone_cosine[k] > -1:
        cosine = reach @ mechanism.base_cone_axis[k] / np.maximum(length, ROUNDING)
        beyond = np.arccos(np.clip(cosine, -1, 1)) - np.arccos(mechanism.base_cone_cosine[k])
        out |= length * np.sin(np.clip(beyond, 0, np.pi / 2)) > within
    return out


def _pus(mechanism: Mechanism, k: int, joint: np.ndarray, within: np.ndarray) -> np.ndarray:
    reach, axis = joint - mechanism.base[k], mechanism.axis[k]
    along = reach @ axis
    off = np.linalg.norm(reach - along[:, None] * axis, axis=1)
    lower = np.full(len(joint), mechanism.lower[k])
    upper = np.full(len(joint), mechanism.upper[k])
    minus, plus = mechanism.branches[k]
    if not plus:
        upper = np.minimum(upper, along + within)
    if not minus:
        lower = np.maximum(lower, along - within)
    nearest = np.hypot(off, np.clip(along, lower, upper) - along)
    farthest = np.hypot(off, np.maximum(np.abs(lower - along), np.abs(upper - along)))
    return (lower > upper) | _far(mechanism, k, nearest, farthest, within)


def _crank(mechanism: Mechanism, k: int, joint: np.ndarray, within: np.ndarray) -> np.ndarray:
    reach, crank = joint - mechanism.base[k], mechanism.crank[k]
    a, b = reach @ mechanism.zero[k], reach @ np.cross(mechanism.axis[k], mechanism.zero[k])
    across, direction = np.hypot(a, b), np.arctan2(b, a)
    minus, plus = mechanism.branches[k]
    # Angles from the joint's direction: before it on the branch minus, beyond it on plus; it turns by at most `turn`.
    turn = np.arcsin(np.clip(within / np.maximum(across, ROUNDING), 0, 1))
    first, last = np.where(minus, -np.pi, 0.0) - turn, np.where(plus, np.pi, 0.0) + turn
    low, high = _cosines(mechanism.lower[k] - direction, mechanism.upper[k] - mechanism.lower[k], first, last)
    square = (reach**2).sum(axis=1) + crank**2
    nearest, farthest = (np.sqrt(np.maximum(square - 2 * crank * across * c, 0.0)) for c in (high, low))
    return (low > high) | _far(mechanism, k, nearest, farthest, within)


def _far(mechanism: Mechanism, k: int, nearest: np.ndarray, farthest: np.ndarray, within: np.ndarray) -> np.ndarray:
    """Whether no elbow is at a link's length."""
    return (nearest - mechanism.link[k] > within) | (mechanism.link[k] - farthest > within)


def _cosines(start: np.ndarray, width: float, first: np.ndarray, last: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Least and largest cosine of angles start … start + width, modulo 2π, within first … last; else 2 and -2."""
    low, high = np.full(len(start), 2.0), np.full(len(start), -2.0)
    for turns in range(-2, 3):
        begin = start % (2 * np.pi) + 2 * np.pi * turns
        begin, end = np.maximum(begin, first), np.minimum(begin + width, last)
        at_ends = np.cos(begin), np.cos(end)
        top = 2 * np.pi * np.ceil(begin / (2 * np.pi)) <= end
        bottom = 2 * np.pi * np.ceil((begin - np.pi) / (2 * np.pi)) + np.pi <= end
        some = begin <= end
        low = np.where(some, np.minimum(low, np.where(bottom, -1.0, np.minimum(*at_ends))), low)
        high = np.where(some, np.maximum(high, np.where(top, 1.0, np.maximum(*at_ends))), high)
    return low, high
