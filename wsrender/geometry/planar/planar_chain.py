"""Arms whose end effector stays in a plane, found from their chain."""

import json
from dataclasses import dataclass
from itertools import accumulate

import numpy as np

from wsrender.errors import ModelError
from wsrender.geometry.planar.motion import PlanarJoint
from wsrender.geometry.reference_frames import reference_frames
from wsrender.robots.chain import Chain

# Sine of the angle by which an axis may be off: models are written with some ten digits.
_ALIGNED = 1e-9


@dataclass(frozen=True, eq=False)
class Plane:
    """A plane of the world: ``origin`` (3,) [m], the point nearest to the world's, and axes (2, 3) of unit length."""

    origin: np.ndarray
    axes: np.ndarray

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
