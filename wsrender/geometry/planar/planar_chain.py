"""Arms whose end effector stays in a plane, found from their chain, and what each of their joints does.

A joint turns what follows about a point, or slides it along a direction. The boundary of the set that it sweeps can lie
at its limits, and along paths of points of the set within.
"""

import json
from dataclasses import dataclass
from enum import IntEnum
from itertools import accumulate

import numpy as np

from wsrender.errors import ModelError
from wsrender.geometry.planar.curves import FULL, TURN, Curves, cross, rotation, turned_left
from wsrender.geometry.reference_frames import reference_frames
from wsrender.robots.chain import Chain
from wsrender.short_repr import short_repr

# Sine of the angle by which an axis may be off: models are written with some ten digits.
_ALIGNED = 1e-9


@dataclass(frozen=True, eq=False)
class PlanarJoint:
    """A joint at the chain's reference configuration, where it is displaced by 0.

    It moves what follows by ``displacement`` = ``sign`` × (scale q + offset), between ``low`` and ``high`` [rad or m].
    """

    name: str
    revolute: bool
    center: np.ndarray  # (2,) [m] of a revolute joint
    direction: np.ndarray  # (2,) of unit length, of a prismatic joint
    low: float
    high: float
    scale: float = 1.0  # displacement = scale q + offset, sign included
    offset: float = 0.0

    __repr__ = short_repr

    @property
    def full(self) -> bool:
        """Whether the joint makes a whole turn."""
        return self.revolute and self.high - self.low >= FULL

    def coordinate(self, displacement: float) -> float:
        """Value of the joint's coordinate q [rad or m] at a displacement."""
        return (displacement - self.offset) / self.scale

    def move(self, points: np.ndarray, displacement: float) -> np.ndarray:
        """Points (…, 2) [m] moved by a displacement."""
        if self.revolute:
            return self.center + (points - self.center) @ rotation(displacement).T
        return points + displacement * self.direction

    def move_curves(self, curves: Curves, displacement: float) -> Curves:
        """Curves moved by a displacement."""
        if self.revolute:
            return curves.rotated(self.center, displacement)
        return curves.shifted(displacement * self.direction)

    def paths(self, points: np.ndarray) -> Curves:
        """Where the joint moves points (K, 2): arcs or lines from ``low`` to ``high``."""
        return self._traces(points, self.low, self.high)

    def orbits(self, points: np.ndarray) -> Curves:
        """What the joint can move to points (K, 2): their paths under the inverse motion."""
        return self._traces(points, -self.high, -self.low)

    def _traces(self, points: np.ndarray, low: float, high: float) -> Curves:
        count = len(points)
        if not self.revolute:
            return Curves.of_lines(points, self.direction, np.full(count, low), np.full(count, high))
        offset = points - self.center
        angle = np.arctan2(offset[:, 1], offset[:, 0])
        radius = np.hypot(offset[:, 0], offset[:, 1])
        last = low + TURN if self.full else high
        return Curves.of_arcs(np.broadcast_to(self.center, (count, 2)), radius, angle + low, angle + last)

    def displacement(self, start: np.ndarray, point: np.ndarray) -> float:
        """Displacement within the limits that moves ``start`` (2,) to ``point`` (2,), or nearest to it."""
        if not self.revolute:
            return float(np.clip((point - start) @ self.direction, self.low, self.high))
        a, b = start - self.center, point - self.center
        angle = float(np.arctan2(a[0] * b[1] - a[1] * b[0], a @ b))
        middle = (self.low + self.high) / 2
        nearest = angle + TURN * np.round((middle - angle) / TURN)
        return float(np.clip(nearest, self.low, self.high))

    def along_itself(self, curves: Curves, tolerance: float) -> np.ndarray:
        """Whether the joint moves whole curves along their own lines or circles, (N,)."""
        if not self.revolute:
            return ~curves.arc & (np.abs(cross(curves.direction, self.direction)) * curves.span <= tolerance)
        offset = self.center - curves.base
        return curves.arc & (np.hypot(offset[:, 0], offset[:, 1]) <= tolerance)

    def stationary(self, curves: Curves, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
        """(rows (K,), points (K, 2)) of curves where the motion runs along them: there the swept set may end.

        Turning: points nearest and farthest from the centre, feet of perpendiculars; of an arc about the centre, whose
        every point is one, the start. Sliding: points of arcs whose tangent is parallel to the slide.
        """
        if not self.revolute:
            middle = np.arctan2(*turned_left(self.direction)[::-1])
            return _held(curves, [np.where(curves.arc, middle + k * np.pi, np.nan) for k in (0, 1)])
        offset = self.center - curves.base
        foot = (offset * curves.direction).sum(axis=1)
        towards = np.arctan2(offset[:, 1], offset[:, 0])
        concentric = self.along_itself(curves, tolerance)
        nearest = np.where(concentric, curves.low, np.where(curves.arc, towards, foot))
        farthest = np.where(curves.arc & ~concentric, towards + np.pi, np.nan)
        return _held(curves, [nearest, farthest])


def _held(curves: Curves, parameters: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Rows and points of those parameters that their curves hold; NaN is none."""
    rows, points = [], []
    for t in parameters:
        with np.errstate(invalid="ignore"):
            held = np.flatnonzero(curves.holds(t))
        rows.append(held)
        points.append(curves[held].at(t[held]))
    return np.concatenate(rows), np.concatenate(points)


class Source(IntEnum):
    """Where a candidate comes from: the inner boundary at a limit of the joint, or the path of one of its points."""

    LOWER = 0
    UPPER = 1
    PATH = 2


@dataclass(frozen=True, eq=False)
class Candidates:
    """N curves that may hold a boundary, each moved from piece ``parent`` of the set before, (N,), −1: from its point.

    ``point`` (N, 2) [m] is the point whose path a curve is, where it is one.
    """

    curves: Curves
    source: np.ndarray
    parent: np.ndarray
    point: np.ndarray

    __repr__ = short_repr


def candidates(
    joint: PlanarJoint, curves: Curves, points: np.ndarray, piece_of_point: np.ndarray, tolerance: float
) -> Candidates:
    """Candidates of a set with the boundary, or all points, ``curves`` and the vertices ``points`` on them.

    A whole turn has no limits. Points that the joint does not move have no path.
    """
    rows, stationary = joint.stationary(curves, tolerance)
    points = np.concatenate([points, stationary])
    piece = np.concatenate([piece_of_point, rows])
    paths = joint.paths(points)
    moving = paths.length > tolerance
    parts = [(paths[moving], Source.PATH, piece[moving], points[moving])]
    if not joint.full:
        nowhere = np.full((len(curves), 2), np.nan)
        for source, limit in ((Source.LOWER, joint.low), (Source.UPPER, joint.high)):
            parts.append((joint.move_curves(curves, limit), source, np.arange(len(curves)), nowhere))
    return Candidates(
        Curves.joined([part[0] for part in parts]),
        np.concatenate([np.full(len(part[0]), part[1]) for part in parts]),
        np.concatenate([part[2] for part in parts]),
        np.concatenate([part[3] for part in parts]),
    )


@dataclass(frozen=True, eq=False)
class Plane:
    """A plane of the world: ``origin`` (3,) [m], the point nearest to the world's, and axes (2, 3) of unit length."""

    origin: np.ndarray
    axes: np.ndarray

    __repr__ = short_repr

    @property
    def normal(self) -> np.ndarray:
        """Unit normal (3,): the third axis of a right-handed frame."""
        return np.cross(*self.axes)

    def in_world(self, points: np.ndarray) -> np.ndarray:
        """Points (…, 2) of the plane as world positions (…, 3) [m]."""
        return self.origin + points @ self.axes

    def coordinates(self, positions: np.ndarray) -> np.ndarray:
        """Coordinates (…, 2) in the plane of world positions (…, 3) [m]."""
        return positions @ self.axes.T


@dataclass(frozen=True, eq=False)
class PlanarChain:
    """The joints that move, base to tip, and the ``tip`` (2,) [m], at the configuration where they are displaced by 0.

    Coordinates are those of ``plane`` less ``shift`` (2,): the base frame's origin, so that an arm far from the world's
    loses no digits.
    """

    joints: tuple[PlanarJoint, ...]
    tip: np.ndarray
    plane: Plane
    shift: np.ndarray

    __repr__ = short_repr

    @property
    def size(self) -> float:
        """Upper bound of the distances in the chain: links and slides, one after the other [m]."""
        centers = [joint.center for joint in self.joints if joint.revolute]
        links = np.diff([*centers, self.tip], axis=0) if centers else np.zeros((1, 2))
        slides = [max(abs(joint.low), abs(joint.high)) for joint in self.joints if not joint.revolute]
        return float(np.hypot(links[:, 0], links[:, 1]).sum() + sum(slides))


def planar_chain(chain: Chain, holding: str = "locked={}") -> PlanarChain:
    """The planar chain of an arm; joints whose limits are equal are held there.

    ``holding``: how the caller holds joints, with {} in the place of their values by name. Raises ModelError, naming
    the joint, where a joint turns about another axis than the first or slides out of the plane, with joints to hold so
    that the others stay in one, and for coupled joints.
    """
    moving, frames, from_last = _frames(chain)
    tip = frames[-1, :3, :3] @ from_last + frames[-1, :3, 3] if len(moving) else from_last
    plane_axes = _plane_axes(frames, chain.joint_is_revolute[moving])
    normal = np.cross(*plane_axes)
    _check(chain, frames, moving, normal, holding)
    base = chain.T_world_base[:3, 3]
    joints = tuple(_joint(chain, *joint, base, plane_axes) for joint in zip(moving.tolist(), frames, strict=True))
    plane = Plane((tip @ normal) * normal, plane_axes)
    return PlanarChain(joints, plane_axes @ (tip - base), plane, plane_axes @ base)


def _frames(chain: Chain) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The joints that move (K,), their frames in the world (K, 4, 4), and the tip in the last of them (3,) [m]."""
    moving, T, from_last = reference_frames(chain)
    return moving, np.array(list(accumulate(T, np.matmul))).reshape(-1, 4, 4), from_last


def _plane_axes(frames: np.ndarray, revolute: np.ndarray) -> np.ndarray:
    """Axes (2, 3) of the plane, as near as can be to two of the world's in the order x, y, z."""
    normal = _normal(frames, revolute)
    first = next(axis for axis in np.eye(3) if abs(axis @ normal) < 0.9)
    first = first - (first @ normal) * normal
    first /= np.linalg.norm(first)
    second = np.cross(normal, first)
    return np.array([first, second * np.sign(second[np.abs(second).argmax()])])


def _normal(frames: np.ndarray, revolute: np.ndarray) -> np.ndarray:
    """The axis of the first joint that turns; of slides alone, the normal of the first two directions."""
    if revolute.any():
        return frames[revolute.argmax(), :3, 2]
    slides = frames[:, :3, 2]
    for slide in slides[1:]:
        normal = np.cross(slides[0], slide)
        if np.linalg.norm(normal) > _ALIGNED:
            return normal / np.linalg.norm(normal)
    along = slides[0] if len(slides) else np.array([0.0, 0.0, 1.0])
    # A single direction lies in many planes: that of z or y which holds it best.
    across = np.eye(3)[2 if abs(along[2]) < 0.9 else 1]
    normal = across - (across @ along) * along if len(slides) else along
    return normal / np.linalg.norm(normal)


def _check(chain: Chain, frames: np.ndarray, moving: np.ndarray, normal: np.ndarray, holding: str) -> None:
    leaving = _leaving(chain, frames, moving, normal)
    if not leaving.any():
        return
    i, axis = moving[leaving][0], frames[leaving][0, :3, 2]
    how = "turns about" if chain.joint_is_revolute[i] else "slides along"
    what = f"joint {chain.joint_names[chain.joint_source[i]]!r} {how} {_shown(axis)}"
    held = holding.replace("{}", json.dumps(_planar_when_held(chain)))
    plane = f"out of the plane with normal {_shown(normal)}"
    raise ModelError("robot", f"the arm is not planar: {what}, {plane}; hold what leaves a plane, such as with {held}")


def _leaving(chain: Chain, frames: np.ndarray, moving: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Which of the moving joints (K,) turn about another axis than the normal, or slide along it."""
    axes, revolute = frames[:, :3, 2], chain.joint_is_revolute[moving]
    return np.where(revolute, np.linalg.norm(np.cross(axes, normal), axis=1), np.abs(axes @ normal)) > _ALIGNED


def _planar_when_held(chain: Chain) -> dict[str, float]:
    """Joints to hold, by name, and values within their limits at which the others move the tip in a plane."""
    held: dict[str, float] = {}
    while True:
        moving, frames, _ = _frames(chain.held(held))
        leaving = _leaving(chain, frames, moving, np.cross(*_plane_axes(frames, chain.joint_is_revolute[moving])))
        if not leaving.any():
            return held
        for k in chain.joint_source[moving[leaving]]:
            low, high = chain.lower_limits[k], chain.upper_limits[k]
            held[chain.joint_names[k]] = float(np.clip(0.0, low, high))


def _shown(vector: np.ndarray) -> str:
    return "(" + ", ".join(f"{x + 0.0:.4g}" for x in np.round(vector, 4)) + ")"


def _joint(chain: Chain, i: int, frame: np.ndarray, base: np.ndarray, plane_axes: np.ndarray) -> PlanarJoint:
    k, revolute = chain.joint_source[i], bool(chain.joint_is_revolute[i])
    sign = np.sign(frame[:3, 2] @ np.cross(*plane_axes)) if revolute else 1.0
    scale, offset = sign * chain.joint_scale[i], sign * chain.joint_offset[i]
    low, high = sorted(scale * limit + offset for limit in (chain.lower_limits[k], chain.upper_limits[k]))
    direction = plane_axes @ frame[:3, 2]
    return PlanarJoint(
        name=chain.joint_names[k],
        revolute=revolute,
        center=plane_axes @ (frame[:3, 3] - base),
        direction=np.zeros(2) if revolute else direction / np.linalg.norm(direction),
        low=float(low),
        high=float(high),
        scale=float(scale),
        offset=float(offset),
    )
