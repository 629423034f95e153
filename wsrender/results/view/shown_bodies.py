"""The bodies of a result's arms in the configurations that its skeleton shows: what pictures draw instead of sticks."""

import warnings
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from wsrender.results.drawing.faces import Faces
from wsrender.results.view.robots import ShownArm, arms_of
from wsrender.robot import link_shapes
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.table import Table

MOST_TRIANGLES = 1_000_000  # of an arm: matplotlib takes seconds for as many
SHARES = np.linspace(0.25, 0.75, 9)  # of the ranges of joints, at which analyses show arms
PLAIN = (0.5, 0.5, 0.5)  # MuJoCo's grey, of bodies without a colour
LINKS = ((0.85, 0.87, 0.89), (0.62, 0.69, 0.76))  # instead, link by link, as the page paints them
_SAME = 1e-6  # of an arm's size: a stored skeleton is one of a configuration


def bodies_shown(
    document: Mapping[str, Any], tables: Mapping[str, Table], samples: DistributionMap | None, skeleton: np.ndarray
) -> list[Faces | None]:
    """What is seen of the robot in each row of a skeleton (K, L+2, 3), as the viewer draws it.

    None where its job's robot has no shapes or cannot be had, and where no configuration that the result tells of has
    this skeleton.
    """
    arms, several = arms_of(document, tables, None, []), bool(document.get("robots"))
    if not arms:
        return [None] * len(skeleton)
    by_number = {arm.number: arm for arm in arms}
    shown = [by_number.get(k if several else 0) for k in range(len(skeleton))]
    return [
        None if arm is None else _shown(arm, row, document, tables, samples)
        for arm, row in zip(shown, skeleton, strict=True)
    ]


def bodies_at(arm: ShownArm, q: np.ndarray) -> Faces | None:
    """What is seen of an arm where it stands at a configuration (n,)."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # said when the robot was loaded
        shapes = link_shapes(arm.robot, q)
    if not shapes or sum(len(each.faces) for each in shapes) > MOST_TRIANGLES:
        return None
    first = np.cumsum([0, *(len(each.vertices) for each in shapes)])
    of = [LINKS[(each.frame + 1) % 2] if each.color == PLAIN else each.color for each in shapes]
    colors = list(dict.fromkeys(of))
    number = np.concatenate([np.full(len(each.faces), colors.index(c)) for each, c in zip(shapes, of, strict=True)])
    T = _moved(arm)
    vertices = np.concatenate([each.vertices for each in shapes]) @ T[:3, :3].T + T[:3, 3]
    triangles = np.concatenate([each.faces + start for each, start in zip(shapes, first[:-1], strict=True)])
    return Faces(vertices, triangles, number, {}, dict(enumerate(colors)))


def _shown(
    arm: ShownArm,
    row: np.ndarray,
    document: Mapping[str, Any],
    tables: Mapping[str, Table],
    samples: DistributionMap | None,
) -> Faces | None:
    T = _moved(arm)
    for q in _told(arm, document, tables, samples):
        if not len(q):
            continue
        points = arm.robot.skeleton(q) @ T[:3, :3].T + T[:3, 3]
        if points.shape[1] > len(row):
            return None
        size = np.ptp(points, axis=1).max()
        apart = np.abs(points - row[: points.shape[1]]).max(axis=(1, 2))
        if apart.min() < _SAME * size:
            return bodies_at(arm, q[apart.argmin()])
    return None


def _told(
    arm: ShownArm, document: Mapping[str, Any], tables: Mapping[str, Table], samples: DistributionMap | None
) -> Iterator[np.ndarray]:
    """Configurations (N, n) of an arm that a result tells of."""
    chain, names = arm.robot.chain, list(arm.robot.joint_names)
    lower, upper = chain.within(0.0), chain.within(1.0)
    turn = np.where(np.isfinite(chain.upper_limits - chain.lower_limits), 0.0, np.pi)  # drawn from a whole one
    spread = lower - turn + SHARES[:, None] * (upper - lower + 2 * turn)
    for joint, value in ((document.get("sampling") or {}).get("locked") or {}).items():
        if joint in names:
            spread[:, names.index(joint)] = value
    yield spread
    for table in tables.values():
        for prefix in {column[: -len(name)] for name in names[:1] for column in table.columns if column.endswith(name)}:
            if all(prefix + name in table.columns for name in names):
                q = np.stack([table[prefix + name] for name in names], axis=1).astype(float)
                yield q[np.isfinite(q).all(axis=1)]
    kept = None if samples is None else samples.configuration
    if kept is not None and len(kept) and kept.shape[1] == len(names):
        yield kept


def _moved(arm: ShownArm) -> np.ndarray:
    """From where its model has it to where an arm stands."""
    return arm.T_world_base @ np.linalg.inv(arm.robot.chain.T_world_base)
