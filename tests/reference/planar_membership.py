"""Whether a planar arm reaches points: complex numbers and damped least squares from many starts. Slow and obvious."""

import numpy as np
from scipy.spatial import KDTree

ITERATIONS = 150


class PlanarArm:
    """Joints of `PlanarJoint` fields, base to tip, and the tip as a complex number."""

    def __init__(self, joints, tip):
        self.turns = [joint.revolute for joint in joints]
        self.center = [complex(*joint.center) for joint in joints]
        self.direction = [complex(*joint.direction) for joint in joints]
        self.low = np.array([joint.low for joint in joints])
        self.high = np.array([joint.high for joint in joints])
        self.tip = complex(*tip)

    def positions(self, q):
        """Complex positions (N,) at displacements q (N, n)."""
        return self._points(q)[0]

    def _points(self, q):
        """The tip moved by joints k … n, for each k and then n + 1: (n + 1, N)."""
        points = [np.full(len(q), self.tip)]
        for k in reversed(range(q.shape[1])):
            z = points[-1]
            moved = self.center[k] + np.exp(1j * q[:, k]) * (z - self.center[k])
            points.append(moved if self.turns[k] else z + q[:, k] * self.direction[k])
        return np.array(points[::-1])

    def derivatives(self, q):
        """Complex derivative of the position by each displacement, (N, n)."""
        points, turned, out = self._points(q), np.ones(len(q), complex), []
        for k in range(q.shape[1]):
            rate = 1j * (points[k] - self.center[k]) if self.turns[k] else self.direction[k]
            out.append(turned * rate)
            if self.turns[k]:
                turned = turned * np.exp(1j * q[:, k])
        return np.stack(out, axis=1)

    def residuals(self, points, starts=24, seed=0):
        """Least distance (K,) to complex points (K,) found by damped least squares within the limits."""
        rng = np.random.default_rng(seed)
        samples = self.low + (self.high - self.low) * rng.random((20_000, len(self.low)))
        ends = np.where(rng.random(samples.shape) < 0.5, self.low, self.high)
        samples = np.where(rng.random(samples.shape) < 0.3, ends, samples)
        at = self.positions(samples)
        tree = KDTree(np.column_stack([at.real, at.imag]))
        near = tree.query(np.column_stack([points.real, points.imag]), k=starts)[1]
        q = samples[near.ravel()]
        goal = np.repeat(points, starts)
        best = np.abs(self.positions(q) - goal)
        damping = np.full(len(q), 1e-3)
        for _ in range(ITERATIONS):
            if not (best > 1e-9).any():
                break
            trial = self._step(q, goal, damping)
            error = np.abs(self.positions(trial) - goal)
            better = error < best
            q[better], best[better] = trial[better], error[better]
            damping = np.where(better, damping / 3, np.minimum(damping * 4, 1e3))
        return best.reshape(-1, starts).min(axis=1)

    def _step(self, q, goal, damping):
        """One damped least-norm step; joints that would leave their limits stay there."""
        J, error = self.derivatives(q), goal - self.positions(q)
        for _ in range(2):
            a = (np.abs(J.real) ** 2).sum(axis=1) + damping
            b = (J.real * J.imag).sum(axis=1)
            d = (np.abs(J.imag) ** 2).sum(axis=1) + damping
            det = a * d - b * b
            x, y = (d * error.real - b * error.imag) / det, (a * error.imag - b * error.real) / det
            step = J.real * x[:, None] + J.imag * y[:, None]
            blocked = ((q >= self.high) & (step > 0)) | ((q <= self.low) & (step < 0))
            J = np.where(blocked, 0, J)
        return np.clip(q + np.where(blocked, 0, step), self.low, self.high)
