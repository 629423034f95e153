"""Every configuration of a three-joint arm that reaches a point, in closed form.

The first joint keeps two numbers of a point: its height along the axis and distance from it (turning), or the two
coordinates across the slide. Both, as functions of the other joints, are linear in the second joint's motion, so that
joint can be eliminated (Pieper 1968): what is left is one condition on the third joint, a trigonometric polynomial of
degree 2 if it turns, a polynomial of degree 4 if it slides.
"""

import numpy as np

from wsrender.geometry.spatial.spatial_arm import TURN, SpatialArm

# Sine of the angle below which two directions count as parallel: models are written with some ten digits.
_PARALLEL = 1e-9
_NEGLIGIBLE = 1e-12  # coefficients that are rounding, relative to the largest
_ON_CIRCLE = 1e-7  # a double root is computed with half the digits
_CLOSED = 1e-7  # positions that a solution must reproduce, relative to the arm's size


class ThreeJointInverse:
    """Inverse kinematics of positions for an arm of three joints whose positions fill a volume."""

    def __init__(self, arm: SpatialArm):
        assert arm.n == 3
        self.arm = arm
        self._size = max(arm.size, 1e-300)
        A, b = arm.T[1, :3, :3], arm.T[1, :3, 3]
        self._A, self._b = A, b
        inner = (A.T @ b) / self._size
        # Rows of the two conditions on the second joint's motion v of the point across its axis: G v = k.
        rows = (A[2], inner) if arm.revolute[0] else (A[0], A[1])
        self._rows = np.array(rows)
        self._G = self._rows[:, :2]
        scale = np.linalg.norm(self._G, axis=1)
        crossed = abs(np.linalg.det(self._G))
        self._independent = bool(crossed > _PARALLEL * scale.prod() and scale.min() > _PARALLEL)

    def solutions(self, points: np.ndarray, first_limited: bool = True) -> np.ndarray:
        """Displacements (N, 8, 3) that reach points (N, 3) [m] within the limits, NaN where there are fewer.

        ``first_limited``: whether the first joint's limits count.
        """
        arm = self.arm
        if not len(points):
            return np.empty((0, 8, 3))
        T = arm.T[0]
        p = (points - T[:3, 3]) @ T[:3, :3]
        third = self._third(p)
        found = []
        for column in range(third.shape[1]):
            d3 = third[:, column]
            found += [np.stack([*first_two, d3], axis=1) for first_two in self._first_two(p, self._before(d3))]
        d = np.full((len(points), 8, 3), np.nan)
        d[:, : len(found)] = np.stack(found, axis=1)
        with np.errstate(invalid="ignore"):
            d = arm.nearest_turn(d)
            within = (d >= arm.low) & (d <= arm.high) | arm.full
            valid = np.all(
                within[:, :, 0 if first_limited else 1 :] & np.isfinite(d).all(axis=2, keepdims=True), axis=2
            )
            rows, columns = np.nonzero(valid)
            off = np.linalg.norm(arm.position(d[rows, columns]) - points[rows], axis=1) > _CLOSED * self._size
        valid[rows[off], columns[off]] = False
        d[~valid] = np.nan
        return d

    def reaches(self, points: np.ndarray) -> np.ndarray:
        """Whether the arm reaches points (N, 3) [m], (N,) bool."""
        return np.any(np.isfinite(self.solutions(points)[:, :, 0]), axis=1)

    def _before(self, d3: np.ndarray) -> np.ndarray:
        """The end point (…, 3) in the second joint's moved frame, at displacements of the third (…)."""
        T, tip = self.arm.T[2], self.arm.tip
        if self.arm.revolute[2]:
            c, s = np.cos(d3), np.sin(d3)
            local = np.stack([c * tip[0] - s * tip[1], s * tip[0] + c * tip[1], np.full_like(c, tip[2])], axis=-1)
        else:
            local = tip + d3[..., None] * np.array([0.0, 0.0, 1.0])
        return local @ T[:3, :3].T + T[:3, 3]

    def _right_sides(self, p: np.ndarray, w: np.ndarray) -> np.ndarray:
        """The right-hand sides k (…, 2) of G v = k, for points p in the first joint's frame and w in the second's."""
        b, rows = self._b, self._rows
        if self.arm.revolute[0]:
            first = p[..., 2] - b[2]
            second = ((p * p).sum(-1) - (w * w).sum(-1) - b @ b) / (2 * self._size)
        else:
            first, second = p[..., 0] - b[0], p[..., 1] - b[1]
        return np.stack([first - rows[0, 2] * w[..., 2], second - rows[1, 2] * w[..., 2]], axis=-1)

    def _condition(self, p: np.ndarray, w: np.ndarray) -> np.ndarray:
        """The condition (…) on the third joint alone: 0 where the other two can do the rest."""
        if self.arm.revolute[1]:
            k = self._right_sides(p, w)
            if self._independent:
                v = k @ np.linalg.inv(self._G).T
                return (v * v).sum(-1) - (w[..., :2] ** 2).sum(-1)
            return k @ self._across()
        y, slide = w @ self._A.T + self._b, self._A[:, 2]
        if not self.arm.revolute[0]:
            return (p - y)[..., 0] * slide[1] - (p - y)[..., 1] * slide[0]
        if abs(slide[2]) <= _PARALLEL:
            return y[..., 2] - p[..., 2]
        y = y + ((p - y)[..., 2] / slide[2])[..., None] * slide
        return (y * y).sum(-1) - (p * p).sum(-1)

    def _across(self) -> np.ndarray:
        """The combination (2,) of both conditions in which the second joint does not appear."""
        u = np.linalg.svd(self._G)[0]
        return u[:, 1]

    def _third(self, p: np.ndarray) -> np.ndarray:
        """Displacements (N, K) of the third joint, NaN where there are fewer."""
        if self.arm.revolute[2]:
            nodes = np.arange(5) * (TURN / 5)
            values = self._condition(p[:, None], self._before(nodes)[None])
            return _angles(np.fft.fft(values, axis=1)[:, :3] / 5)
        middle, half = (self.arm.low[2] + self.arm.high[2]) / 2, (self.arm.high[2] - self.arm.low[2]) / 2
        nodes = np.cos((np.arange(5) + 0.5) * np.pi / 5)
        values = self._condition(p[:, None], self._before(middle + half * nodes)[None])
        return middle + half * _real_roots(values @ np.linalg.inv(np.vander(nodes)).T)

    def _first_two(self, p: np.ndarray, w: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
        """Displacements of the first two joints, one or two pairs of (N,), for end points w (N, 3) of the second."""
        found = []
        for d2, y in self._second(p, w):
            if self.arm.revolute[0]:
                d1 = np.arctan2(p[:, 1], p[:, 0]) - np.arctan2(y[:, 1], y[:, 0])
            else:
                d1 = p[:, 2] - y[:, 2]
            found.append((d1, d2))
        return found

    def _second(self, p: np.ndarray, w: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
        """(displacement (N,) of the second joint, end point (N, 3) in the first one's moved frame)."""
        if self.arm.revolute[1]:
            turned = self._turned_by_second(p, w)
            return [
                (
                    np.arctan2(v[:, 1], v[:, 0]) - np.arctan2(w[:, 1], w[:, 0]),
                    np.column_stack([v, w[:, 2]]) @ self._A.T + self._b,
                )
                for v in turned
            ]
        y, slide = w @ self._A.T + self._b, self._A[:, 2]
        return [(d2, y + d2[:, None] * slide) for d2 in self._slid_by_second(p, y, slide)]

    def _turned_by_second(self, p: np.ndarray, w: np.ndarray) -> list[np.ndarray]:
        """The end point across the second axis (N, 2), after that joint has turned it."""
        k = self._right_sides(p, w)
        if self._independent:
            return [k @ np.linalg.inv(self._G).T]
        u, sigma, along = np.linalg.svd(self._G)
        x = k @ u[:, 0] / sigma[0]
        y = _root((w[:, :2] ** 2).sum(-1) - x * x, self._size**2)
        return [x[:, None] * along[0] + (sign * y)[:, None] * along[1] for sign in (1.0, -1.0)]

    def _slid_by_second(self, p: np.ndarray, y: np.ndarray, slide: np.ndarray) -> list[np.ndarray]:
        if not self.arm.revolute[0]:
            return [(p - y)[:, :2] @ slide[:2] / (slide[:2] @ slide[:2])]
        if abs(slide[2]) > _PARALLEL:
            return [(p - y)[:, 2] / slide[2]]
        half = y @ slide
        root = _root(half**2 - (y * y).sum(-1) + (p * p).sum(-1), self._size**2)
        return [-half + root, -half - root]


def _angles(c: np.ndarray) -> np.ndarray:
    """Zeros (N, 4 or 2) of Re(c0 + 2 c1 e^{ix} + 2 c2 e^{2ix}), c (N, 3) complex; NaN where they are not real."""
    largest = np.abs(c).max(axis=1)
    if np.abs(c[:, 2]).max() <= _NEGLIGIBLE * max(largest.max(), 1e-300):
        amplitude, angle = 2 * np.abs(c[:, 1]), np.angle(c[:, 1])
        with np.errstate(invalid="ignore", divide="ignore"):
            ratio = -np.real(c[:, 0]) / amplitude
            ratio = np.where(np.abs(ratio) <= 1 + _ON_CIRCLE**2, np.clip(ratio, -1, 1), np.nan)
            half = np.arccos(ratio)
        return np.stack([half - angle, -half - angle], axis=1)
    lead = _not_zero(c[:, 2], largest)
    z = _zeros(np.stack([lead, c[:, 1], c[:, 0], c[:, 1].conj(), lead.conj()], axis=1))
    with np.errstate(invalid="ignore", divide="ignore"):
        x = np.where(np.abs(np.log(np.abs(z))) < _ON_CIRCLE, np.angle(z), np.nan)
        for _ in range(2):
            e1, e2 = c[:, 1:2] * np.exp(1j * x), c[:, 2:] * np.exp(2j * x)
            value = np.real(c[:, :1]) + 2 * np.real(e1 + e2)
            slope = -2 * np.imag(e1 + 2 * e2)
            step = value / slope
            x = np.where(np.abs(step) < 1e-4, x - step, x)
    return x


def _real_roots(c: np.ndarray) -> np.ndarray:
    """Real zeros (N, degree) of polynomials c (N, 5), highest power first; NaN where they are not real."""
    largest = max(np.abs(c).max(), 1e-300)
    while c.shape[1] > 3 and np.abs(c[:, 0]).max() <= _NEGLIGIBLE * largest:
        c = c[:, 1:]
    if c.shape[1] == 3:
        return _quadratic_roots(c)
    z = _zeros(np.column_stack([_not_zero(c[:, 0], np.abs(c).max(axis=1)), c[:, 1:]]))
    return np.where(np.abs(np.imag(z)) < _ON_CIRCLE * np.maximum(np.abs(z), 1), np.real(z), np.nan)


def _not_zero(lead: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """Leading coefficients (N,) of polynomials whose largest are ``scale``: one that vanishes sends a zero far away."""
    return np.where(np.abs(lead) < 1e-14 * scale, 1e-14 * scale, lead)


def _zeros(c: np.ndarray) -> np.ndarray:
    """Zeros (N, degree) of polynomials c (N, degree + 1), highest power first: the companion matrices' eigenvalues."""
    degree = c.shape[1] - 1
    companion = np.zeros((len(c), degree, degree), c.dtype)
    companion[:, np.arange(1, degree), np.arange(degree - 1)] = 1
    companion[:, :, -1] = -c[:, :0:-1] / c[:, :1]
    return np.linalg.eigvals(companion)


def _quadratic_roots(c: np.ndarray) -> np.ndarray:
    """Real zeros (N, 2) of a x² + b x + c; a may vanish."""
    a, half, end = c[:, 0], c[:, 1] / 2, c[:, 2]
    root = _root(half**2 - a * end, np.maximum(half**2, np.abs(a * end)))
    with np.errstate(invalid="ignore", divide="ignore"):
        larger = -(half + np.where(half >= 0, root, -root))
        return np.stack([larger / np.where(a == 0, np.nan, a), end / np.where(larger == 0, np.nan, larger)], axis=1)


def _root(squared: np.ndarray, scale: np.ndarray | float) -> np.ndarray:
    """Square roots; 0 of what is below 0 by rounding only, relative to ``scale``, and NaN of what is farther below."""
    with np.errstate(invalid="ignore"):
        return np.sqrt(np.where(squared >= -(_ON_CIRCLE**2) * scale, np.maximum(squared, 0.0), np.nan))
