"""Least-squares lines and circles through points of a plane."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class CircleFit:
    """The circle with the least squares of r² − R²; ``error`` is their mean [m⁴]."""

    center: np.ndarray  # (2,) [m]
    radius: float  # [m]
    error: float


def fit_line(points: np.ndarray) -> float:
    """Mean squared perpendicular distance [m²] of points (K, 2) [m] from the line with the least: their principal axis.

    (Pearson 1901.)
    """
    offset = points - points.mean(axis=0)
    return float(np.linalg.eigvalsh(offset.T @ offset / len(points))[0])


def fit_circle(points: np.ndarray) -> CircleFit:
    """Circle through points (K, 2) [m] that are not on a line (Kåsa 1976): linear in the centre and R² − |centre|²."""
    middle = points.mean(axis=0)
    offset = points - middle
    squares = (offset**2).sum(axis=1)
    rows = np.column_stack([2 * offset, np.ones(len(points))])
    (x, y, constant), *_ = np.linalg.lstsq(rows, squares, rcond=None)
    residual = squares - rows @ (x, y, constant)
    return CircleFit(middle + np.array([x, y]), float(np.sqrt(constant + x * x + y * y)), float((residual**2).mean()))
