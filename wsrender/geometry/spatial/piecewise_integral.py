"""Integrals over rectangles of functions that are smooth but for jumps and kinks along curves."""

from collections.abc import Callable

import numpy as np

# values (N,) and signatures (N,) of points (u, v) (N,): where the signature changes the values may jump.
Piecewise = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]

_FIRST_PANELS = 6
_OUTER, _INNER = np.polynomial.legendre.leggauss(7), np.polynomial.legendre.leggauss(12)
_SCANNED = 48  # points of each line among which jumps are looked for
_BISECTIONS = 40


def piecewise_integral(
    function: Piecewise, u: tuple[float, float], v: tuple[float, float], tolerance: float, most_lines: int
) -> tuple[float, float]:
    """∫∫ function du dv, and how much its last halving changed it.

    Gauss–Legendre quadrature on lines of constant u, divided where the signature changes; panels of lines are halved
    where that matters, until the change is below ``tolerance`` (relative) or there are ``most_lines``.
    """
    edges = np.linspace(*u, _FIRST_PANELS + 1)
    low, high = edges[:-1], edges[1:]
    whole = _panels(function, low, high, v)
    lines, total, settled_error = len(low) * len(_OUTER[0]), 0.0, 0.0
    while len(low):
        middle = (low + high) / 2
        halves = _panels(function, np.concatenate([low, middle]), np.concatenate([middle, high]), v).reshape(2, -1)
        lines += 2 * len(low) * len(_OUTER[0])
        error = np.abs(halves.sum(axis=0) - whole)
        scale = abs(total + halves.sum())
        share = tolerance * scale * (high - low) / (u[1] - u[0])
        open_ = (error > share) & (lines < most_lines)
        total += halves[:, ~open_].sum()
        settled_error += error[~open_].sum()
        low, high = np.concatenate([low[open_], middle[open_]]), np.concatenate([middle[open_], high[open_]])
        whole = halves[:, open_].ravel()
    return float(total), float(settled_error)


def _panels(function: Piecewise, low: np.ndarray, high: np.ndarray, v: tuple[float, float]) -> np.ndarray:
    """Integrals (P,) over u in low … high (P,)."""
    x, weight = _OUTER
    half = (high - low) / 2
    u = (low + high)[:, None] / 2 + half[:, None] * x
    return half * (_lines(function, u.ravel(), v).reshape(u.shape) @ weight)


def _lines(function: Piecewise, u: np.ndarray, v: tuple[float, float]) -> np.ndarray:
    """Integrals (N,) over v at u (N,)."""
    grid = np.linspace(*v, _SCANNED)
    inner = grid + np.concatenate([[1e-9], np.zeros(_SCANNED - 2), [-1e-9]]) * (v[1] - v[0])
    signature = function(np.repeat(u, _SCANNED), np.tile(inner, len(u)))[1].reshape(len(u), _SCANNED)
    line, k = np.nonzero(np.diff(signature, axis=1))
    left, right, before = grid[k], grid[k + 1], signature[line, k]
    for _ in range(_BISECTIONS):
        middle = (left + right) / 2
        same = function(u[line], middle)[1] == before
        left, right = np.where(same, middle, left), np.where(same, right, middle)
    ends = np.full(len(u), v[1])
    lines = np.arange(len(u))
    start_line = np.concatenate([lines, line, lines])
    cuts = np.concatenate([np.full(len(u), v[0]), (left + right) / 2, ends])
    order = np.lexsort((cuts, start_line))
    cuts, start_line = cuts[order], start_line[order]
    piece = np.flatnonzero(np.diff(start_line) == 0)
    x, weight = _INNER
    half = (cuts[piece + 1] - cuts[piece]) / 2
    at = (cuts[piece + 1] + cuts[piece])[:, None] / 2 + half[:, None] * x
    values = function(np.repeat(u[start_line[piece]], len(x)), at.ravel())[0].reshape(at.shape)
    return np.bincount(start_line[piece], half * (values @ weight), len(u))
