"""Self-motions of three-joint planar arms counted by following them, step by step, from many starts."""

import numpy as np

STEP, STEPS, STARTS = 0.03, 800, 40  # [rad or m]
ON = 1e-9  # distance from the point at which a posture reaches it


class SelfMotionTracing:
    """Of a `PlanarArm` of three joints; those in ``full`` (3,) turn without limits."""

    def __init__(self, arm, full):
        self.arm, self.full = arm, np.array(full)
        self.low, self.high = np.where(full, -np.inf, arm.low), np.where(full, np.inf, arm.high)

    def count(self, points, seed=0):
        """Number of separate curves of postures that reach each complex point (K,)."""
        rng = np.random.default_rng(seed)
        goals = np.repeat(points, STARTS)
        q = self.arm.low + (self.arm.high - self.arm.low) * rng.random((len(goals), 3))
        for _ in range(60):
            q = np.clip(self._corrected(q, goals), self.low, self.high)
        reached = np.abs(self.arm.positions(q) - goals) < ON
        q, goals, owner = q[reached], goals[reached], np.repeat(np.arange(len(points)), STARTS)[reached]
        paths = np.concatenate([self._followed(q, goals, sign) for sign in (1, -1)])  # (2 T, N, 3)
        return np.array([self._separate(q[owner == k], paths[:, owner == k]) for k in range(len(points))])

    def _corrected(self, q, goals):
        """A Newton step of least norm towards the goals."""
        J, error = self.arm.derivatives(q), goals - self.arm.positions(q)
        a, b, d = (J.real**2).sum(axis=1), (J.real * J.imag).sum(axis=1), (J.imag**2).sum(axis=1)
        det = np.maximum(a * d - b * b, 1e-12)
        x, y = (d * error.real - b * error.imag) / det, (a * error.imag - b * error.real) / det
        step = J.real * x[:, None] + J.imag * y[:, None]
        size = np.linalg.norm(step, axis=1, keepdims=True)
        return q + step * np.minimum(1.0, 0.3 / np.maximum(size, 1e-30))

    def _followed(self, q, goals, sign):
        """Postures (T, N, 3) along the self-motions through q (N, 3), as far as the first beyond a limit."""
        path, tangent = [q], None
        for _ in range(STEPS):
            J = self.arm.derivatives(q)
            direction = np.cross(J.real, J.imag)
            direction /= np.maximum(np.linalg.norm(direction, axis=1, keepdims=True), 1e-30)
            before = sign * direction if tangent is None else tangent
            tangent = direction * np.where((direction * before).sum(axis=1, keepdims=True) < 0, -1, 1)
            beyond = ((q < self.low) | (q > self.high)).any(axis=1, keepdims=True)
            q = np.where(beyond, np.nan, q) + STEP * tangent
            for _ in range(3):
                q = self._corrected(q, goals)
            path.append(q)
        return np.array(path)

    def _separate(self, q, paths):
        """How many paths (T, S, 3) it takes to pass all the starts q (S, 3)."""
        left, count = np.arange(len(q)), 0
        while len(left):
            path = paths[:, left[0]]
            path = path[np.isfinite(path[:, 0])]
            apart = path[:, None] - q[left]
            apart = np.where(self.full, np.mod(apart + np.pi, 2 * np.pi) - np.pi, apart)
            left, count = left[np.linalg.norm(apart, axis=2).min(axis=0) > 0.6 * STEP], count + 1
        return count
