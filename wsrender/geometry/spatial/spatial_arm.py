"""The joints of an arm that move its end point, displaced from where they stand at zero."""

from dataclasses import dataclass

import numpy as np

from wsrender.geometry.reference_frames import reference_frames
from wsrender.robots.chain import Chain

TURN = 2 * np.pi
_FULL = TURN * (1 - 1e-12)


@dataclass(frozen=True, eq=False)
class SpatialArm:
    """``n`` joints from base to tip, displaced by d (n,) [rad or m] between ``low`` and ``high``.

    ``T[i]`` (4, 4) is the frame of joint i, its axis z, at displacement 0 in the moved frame of the joint before it (in
    the world for i = 0); ``tip`` (3,) [m] is the end point in the last joint's frame. ``inverted`` joints are displaced
    against their coordinate: their upper limit is ``low``.
    """

    names: tuple[str, ...]
    revolute: np.ndarray
    low: np.ndarray
    high: np.ndarray
    inverted: np.ndarray
    T: np.ndarray
    tip: np.ndarray

    @property
    def n(self) -> int:
        """Number of joints."""
        return len(self.names)

    @property
    def full(self) -> np.ndarray:
        """Whether each joint makes whole turns: it is never stopped, (n,)."""
        return self.revolute & (self.high - self.low >= _FULL)

    @property
    def size(self) -> float:
        """Upper bound of the distance from the first joint's axis to the end point, slides included [m]."""
        slides = np.where(self.revolute, 0.0, np.maximum(np.abs(self.low), np.abs(self.high)))
        return float(np.linalg.norm(self.T[1:, :3, 3], axis=1).sum() + np.linalg.norm(self.tip) + slides.sum())

    def motion(self, d: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """End points (N, 3) [m] at displacements (N, n), linear Jacobians (N, 3, n), axes (N, n, 3), 0 of slides."""
        R = np.broadcast_to(np.eye(3), (len(d), 3, 3))
        p = np.zeros((len(d), 3))
        origins, axes = [], []
        for i in range(self.n):
            p = p + R @ self.T[i, :3, 3]
            R = R @ self.T[i, :3, :3]
            origins.append(p)
            axes.append(R[:, :, 2])
            if self.revolute[i]:
                R = R @ _turned(d[:, i])
            else:
                p = p + R[:, :, 2] * d[:, i, None]
        p = p + R @ self.tip
        J = [
            np.cross(axis, p - origin) if turns else axis
            for axis, origin, turns in zip(axes, origins, self.revolute, strict=True)
        ]
        turning = np.stack(axes, axis=1) * self.revolute[:, None]
        return p, np.stack(J, axis=2), turning

    def position(self, d: np.ndarray) -> np.ndarray:
        """End points (N, 3) [m] at displacements (N, n)."""
        return self.motion(d)[0]

    def nearest_turn(self, d: np.ndarray) -> np.ndarray:
        """Displacements (…, n) with those of turning joints a whole number of turns nearer to the middle."""
        middle = (self.low + self.high) / 2
        return np.where(self.revolute, d + TURN * np.round((middle - d) / TURN), d)

    def limits_of(self, joint: int) -> tuple[tuple[str, float], ...]:
        """("lower" or "upper", displacement) of each end at which a joint is stopped."""
        if self.full[joint]:
            return ()
        low, high = float(self.low[joint]), float(self.high[joint])
        return (("upper", low), ("lower", high)) if self.inverted[joint] else (("lower", low), ("upper", high))


def spatial_arm(chain: Chain) -> SpatialArm:
    """The joints of a chain that move; those whose limits are equal are held there.

    Raises ModelError, naming the joint, where several joints follow one.
    """
    kept, T, tip = reference_frames(chain)
    source, scale, offset = chain.joint_source[kept], chain.joint_scale[kept], chain.joint_offset[kept]
    ends = np.sort([scale * chain.lower_limits[source] + offset, scale * chain.upper_limits[source] + offset], axis=0)
    return SpatialArm(
        names=tuple(chain.joint_names[k] for k in source),
        revolute=chain.joint_is_revolute[kept].astype(bool),
        low=ends[0],
        high=ends[1],
        inverted=scale < 0,
        T=T,
        tip=tip,
    )


def _turned(angle: np.ndarray) -> np.ndarray:
    R = np.zeros((len(angle), 3, 3))
    c, s = np.cos(angle), np.sin(angle)
    R[:, 0, 0], R[:, 0, 1], R[:, 1, 0], R[:, 1, 1], R[:, 2, 2] = c, -s, s, c, 1.0
    return R
