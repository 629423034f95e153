"""Cells outside of which a chain reaches nothing, proven by interval arithmetic on parts of the joint box."""

import numpy as np

from wsrender.robots.chain import Chain
from wsrender.robots.kinematics import Kinematics
from wsrender.robots.reachable_box import reachable_boxes
from wsrender.volume.lattice import LatticeBlock

HALVINGS = 12  # of the joint box: a cover of 4096 boxes, found in some ten milliseconds
MARGIN = 1e-9  # of the reach, for rounding


def covered_cells(kinematics: Kinematics, block: LatticeBlock, dimension: int) -> np.ndarray:
    """Whether a cell may hold a position, bool, of the block's first ``dimension`` axes.

    Every cell may of a robot that is defined by a Python class: nothing is known to hold its reach.
    """
    shape = block.shape[:dimension]
    if (chain := kinematics.geometry) is None:
        return np.ones(shape, bool)
    low, high = (corner[:, :dimension] for corner in reachable_boxes(chain, *_parts(chain)))
    margin = MARGIN * (chain.reach or 1.0)
    first_voxel = np.array(block.first_voxel[:dimension])
    start, stop = (
        np.clip(np.floor(corner / block.voxel_size_m).astype(np.int64) - first_voxel, 0, np.array(shape) - 1)
        for corner in (low - margin, high + margin)
    )
    return _filled(start, stop + 1, shape)


def _parts(chain: Chain) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper corners (N, n) of parts of the joint box, halved where a joint moves the tip farthest."""
    lower, upper = chain.lower_limits[None], chain.upper_limits[None]
    travel = _travel(chain)
    for _ in range(HALVINGS):
        k = int(np.argmax(travel))
        if travel[k] == 0.0:
            break
        middle = (lower[:, k] + upper[:, k]) / 2
        below, above = upper.copy(), lower.copy()
        below[:, k] = above[:, k] = middle
        lower, upper = np.concatenate([lower, above]), np.concatenate([below, upper])
        travel[k] /= 2
    return lower, upper


def _travel(chain: Chain) -> np.ndarray:
    """Upper bound of the way that each coordinate's range can move the tip, (n,) [m]."""
    steps = np.linalg.norm(chain.T_joint[1:, :3, 3], axis=1) + chain.largest_slide[1:]
    tip = np.linalg.norm((chain.T_tip @ chain.T_tip_tool)[:3, 3])
    beyond = tip + np.append(np.cumsum(steps[::-1])[::-1], 0.0)
    per_unit = np.abs(chain.joint_scale) * np.where(chain.joint_is_revolute, beyond, 1.0)
    travel = np.zeros(chain.n)
    np.add.at(travel, chain.joint_source, per_unit)
    return travel * (chain.upper_limits - chain.lower_limits)


def _filled(start: np.ndarray, stop: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """Cells in any of the ranges start … stop (N, d), the latter excluded, from sums over the ranges' corners."""
    dimension = len(shape)
    grown = tuple(length + 1 for length in shape)
    total = np.zeros(int(np.prod(grown)), np.int64)
    for corner in np.ndindex((2,) * dimension):
        at = np.where(np.array(corner, bool), stop, start)
        counted = np.bincount(np.ravel_multi_index(tuple(at.T), grown), minlength=len(total))
        total += (-1) ** sum(corner) * counted
    summed = total.reshape(grown)
    for axis in range(dimension):
        summed = np.cumsum(summed, axis=axis)
    return summed[tuple(slice(0, length) for length in shape)] > 0
