"""Configurations that hold a pose to the last digits: corrected on the true chain, told apart, and what they are."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from wsrender.robots.kinematics import Kinematics

EXACT = 1e-9  # m and rad: a configuration holds a pose
SETTLED = 1e-13  # m/reach and rad: what is left is rounding
STEPS = 40  # near a double root each halves what is left of the joints
SAME = 1e-6  # rad and reaches: closer postures are one
CLOSE = 1e-3  # they may be one, if the pose holds between them
NEARLY_SINGULAR = 1e-3  # sigma_min below which joints move a thousand times as far as the pose
SINGULAR = 1e-6  # a singular value that counts as 0: the pose holds within EXACT a thousandth of a radian aside
ASIDE = 1e-2  # rad and reaches: how far a family is followed to see whether it is one
TURN = 2 * np.pi


@dataclass(frozen=True, eq=False)
class PoseHolder:
    """Holds poses with a ``chain`` near the world's origin.

    ``kind``: whole ones ("pose"), positions with the direction of the tip's z ("axis"), or positions alone.
    """

    chain: Kinematics
    kind: str = "pose"

    @property
    def rows(self) -> int:
        """How many numbers say what a pose asks for."""
        return {"pose": 6, "axis": 5, "position": 3}[self.kind]

    @property
    def length(self) -> float:
        """What lengths are divided by [m]: the reach."""
        return float(self.chain.reach) if np.isfinite(self.chain.reach) and self.chain.reach > 0 else 1.0

    @property
    def scale(self) -> np.ndarray:
        """What a step of 1 moves each coordinate by (n,) [rad or m]."""
        return np.where(self.chain.revolute, 1.0, self.length)

    def errors(self, q: np.ndarray, T: np.ndarray) -> np.ndarray:
        """What is left to poses ``T`` (M, 4, 4) at ``q`` (M, n), (M, 6): metres, then a rotation vector, in the world.

        Of positions no rotation is left, of axes the smallest that brings z to z.
        """
        at = self.chain.poses(q)
        left = np.zeros((len(q), 6))
        left[:, :3] = T[:, :3, 3] - at[:, :3, 3]
        if self.kind == "pose" and len(q):
            turn = T[:, :3, :3] @ at[:, :3, :3].transpose(0, 2, 1)
            left[:, 3:] = Rotation.from_matrix(turn).as_rotvec()
        if self.kind == "axis":
            about = np.cross(at[:, :3, 2], T[:, :3, 2])
            sine, cosine = np.linalg.norm(about, axis=1), np.einsum("mi,mi->m", at[:, :3, 2], T[:, :3, 2])
            about = np.where(sine[:, None] > 0, about / np.maximum(sine, 1e-300)[:, None], at[:, :3, 0])
            left[:, 3:] = about * np.arctan2(sine, cosine)[:, None]
        return left

    def _asked(self, q: np.ndarray, motions: np.ndarray) -> np.ndarray:
        """What a pose asks for of ``motions`` (M, 6, k) of the tip, (M, rows, k): of turns those about its x and y."""
        if self.kind != "axis":
            return motions[:, : self.rows]
        across = self.chain.poses(q)[:, :3, :2].transpose(0, 2, 1)
        return np.concatenate([motions[:, :3], across @ motions[:, 3:]], axis=1)

    @property
    def moving(self) -> np.ndarray:
        """Coordinates (m,) that nothing holds."""
        return np.flatnonzero(self.chain.lower_limits < self.chain.upper_limits)

    def jacobians(self, q: np.ndarray) -> np.ndarray:
        """Jacobians (M, rows, m) of the `moving` coordinates without units: lengths, of slides too, over the reach."""
        J = self._asked(q, self.chain.jacobians(q) * self.scale)[..., self.moving]
        J[:, :3] /= self.length
        return J

    def polished(self, q: np.ndarray, T: np.ndarray, frozen: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Configurations within the limits that hold ``T`` best, from near ones ``q`` (M, n), and `errors` there.

        ``frozen`` (M, n) bool: coordinates that stay.

        Steps of Levenberg's with the squared error as damping, which converge at double roots too (Yamashita,
        Fukushima 2001).
        """
        q = self._within(q)
        left = self.errors(q, T)
        best, least = q.copy(), self._sizes(left)
        at = np.flatnonzero(least > SETTLED)
        for _ in range(STEPS):
            if not len(at):
                break
            scaled = self._asked(q[at], left[at, :, None])[..., 0]
            scaled[:, :3] /= self.length
            J = self.jacobians(q[at])
            if frozen is not None:
                J *= ~frozen[at][:, None, self.moving]
            moved = q[at] + self.along(_step(J, scaled))
            held = np.abs(self._within(moved) - moved)[:, self.moving] > TURN * 1e-12
            held &= ~self.chain.periodic[self.moving]
            blocked = np.flatnonzero(held.any(axis=1))
            J[blocked] *= ~held[blocked, None]
            moved[blocked] = q[at[blocked]] + self.along(_step(J[blocked], scaled[blocked]))
            q[at] = self._within(moved)
            left[at] = self.errors(q[at], T[at])
            size = self._sizes(left[at])
            better = size < least[at]
            best[at[better]], least[at[better]] = q[at[better]], size[better]
            at = at[(size > SETTLED) & (better | (size > EXACT))]
        return best, self.errors(best, T)

    def holds(self, left: np.ndarray) -> np.ndarray:
        """Whether `errors` (M, 6) are none to the tolerance, (M,) bool."""
        return (np.linalg.norm(left[:, :3], axis=1) <= EXACT) & (np.linalg.norm(left[:, 3:], axis=1) <= EXACT)

    def distances(self, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        """Largest difference of any coordinate [rad or reaches], turns apart; (…, n) to (…)."""
        apart = np.abs(a - b) / self.scale
        turned = np.abs(np.remainder(apart + np.pi, TURN) - np.pi)
        return np.where(self.chain.revolute, turned, apart).max(axis=-1)

    def distinct(self, pose: np.ndarray, q: np.ndarray, T: np.ndarray) -> np.ndarray:
        """Which (K,) of postures ``q`` (M, n) of poses by number ``pose`` (M,), ascending, are not an earlier one.

        Closer ones than SAME are one, and those between which the pose ``T`` (N, 4, 4) holds.
        """
        dropped = np.zeros(len(q), bool)
        # Rows of one pose stand together: each is compared with those a few rows further on.
        for ahead in range(1, int(np.bincount(pose).max(initial=1))):
            first = np.arange(len(q) - ahead)
            first = first[(pose[first] == pose[first + ahead]) & ~dropped[first] & ~dropped[first + ahead]]
            apart = self.distances(q[first], q[first + ahead])
            same = apart < SAME
            near = np.flatnonzero((apart < CLOSE) & ~same)
            middle = q[first[near]] + self._turned(q[first[near] + ahead] - q[first[near]]) / 2
            same[near] = self.holds(self.errors(middle, T[pose[first[near]]]))
            dropped[first[same] + ahead] = True
        return np.flatnonzero(~dropped)

    @cached_property
    def freedoms(self) -> int:
        """Freedoms of the pose that the joints move: the rank of the Jacobian at most configurations."""
        chain = self.chain
        low, high = (np.where(np.isfinite(ends), ends, 0.0) for ends in (chain.lower_limits, chain.upper_limits))
        q = low + np.random.default_rng(0).random((8, chain.n)) * (high - low)
        s = np.linalg.svd(self.jacobians(q), compute_uv=False)
        return int((s > 1e-9 * s.max(initial=1e-300)).sum(axis=1).max())

    def sigma_min(self, q: np.ndarray) -> np.ndarray:
        """Smallest singular value (M,) of the Jacobian, of those that are not always 0, lengths over the reach."""
        if not len(q):
            return np.zeros(0)
        return np.linalg.svd(self.jacobians(q), compute_uv=False)[:, max(self.freedoms, 1) - 1]

    def nullity(self, q: np.ndarray) -> np.ndarray:
        """Freedoms (M,) int of the joints at ``q`` (M, n) that do not move the pose."""
        s = np.linalg.svd(self.jacobians(q), compute_uv=False) if len(q) else np.zeros((0, 0))
        return len(self.moving) - (s > SINGULAR).sum(axis=1)

    def families(self, q: np.ndarray, T: np.ndarray) -> np.ndarray:
        """Whether the arm can move from postures ``q`` (M, n) while the tip stays, within the limits, (M,) bool."""
        free = self.along(self.null_vectors(q))
        found = np.zeros(len(q), bool)
        for way in (ASIDE, -ASIDE):
            moved, left = self.polished(q + way * free, T)
            found |= self.holds(left) & (self.distances(moved, q) > abs(way) / 4)
        return found

    def turns(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Least and largest whole turns (M, n) int that hinges may be moved by within the limits; 0 of others."""
        chain = self.chain
        hinged = chain.revolute & ~chain.periodic
        with np.errstate(invalid="ignore"):
            least = np.ceil((chain.lower_limits - q - EXACT) / TURN)
            most = np.floor((chain.upper_limits - q + EXACT) / TURN)
        return np.where(hinged, least, 0).astype(int), np.where(hinged, most, 0).astype(int)

    def along(self, step: np.ndarray) -> np.ndarray:
        """Steps (M, m) of the `moving` coordinates as those of configurations (M, n) [rad or m]."""
        whole = np.zeros((len(step), self.chain.n))
        whole[:, self.moving] = step
        return whole * self.scale

    def null_vectors(self, q: np.ndarray) -> np.ndarray:
        """Unit vectors (M, m) of the `moving` coordinates along which the pose changes least."""
        return np.linalg.svd(self.jacobians(q), full_matrices=True)[2][:, -1]

    def difference(self, by: np.ndarray) -> np.ndarray:
        """Differences (M, n) [rad or m] of hinges without limits within half a turn."""
        return np.where(self.chain.periodic, np.remainder(by + np.pi, TURN) - np.pi, by)

    def _turned(self, by: np.ndarray) -> np.ndarray:
        """Differences (M, n) without whole turns."""
        return np.where(self.chain.revolute, np.remainder(by + np.pi, TURN) - np.pi, by)

    def _within(self, q: np.ndarray) -> np.ndarray:
        chain = self.chain
        inside = np.clip(q, chain.lower_limits, chain.upper_limits)
        return np.where(chain.periodic, np.remainder(q + np.pi, TURN) - np.pi, inside)

    def _sizes(self, left: np.ndarray) -> np.ndarray:
        return np.maximum(np.linalg.norm(left[:, :3], axis=1) / self.length, np.linalg.norm(left[:, 3:], axis=1))


def _step(J: np.ndarray, left: np.ndarray) -> np.ndarray:
    """Levenberg's step (M, m) for what is left (M, rows), at most 0.2."""
    U, s, V = np.linalg.svd(J, full_matrices=False)
    damped = s / (s**2 + np.einsum("mr,mr->m", left, left)[:, None] + 1e-30)
    step = (V.transpose(0, 2, 1) @ (damped[..., None] * (U.transpose(0, 2, 1) @ left[..., None])))[..., 0]
    return step * np.minimum(1.0, 0.2 / np.maximum(np.abs(step).max(axis=1, keepdims=True, initial=0.0), 1e-300))
