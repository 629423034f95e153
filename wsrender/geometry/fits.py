"""Least-squares lines, circles and spheres through points."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class CircleFit:
    """The circle, or sphere, with the least squares of r² − R²; ``error`` is their mean [m⁴]."""

    center: np.ndarray  # (2,) or (3,) [m]
    radius: float  # [m]
    error: float


def fit_line(points: np.ndarray) -> float:
    """Mean squared perpendicular distance [m²] of points (K, 2) [m] from the line with the least: their principal axis.

    (Pearson 1901.)
    """
    offset = points - points.mean(axis=0)
    return float(np.linalg.eigvalsh(offset.T @ offset / len(points))[0])


def fit_circle(points: np.ndarray) -> CircleFit:
    """Circle through points (K, 2) that are not on a line, or sphere through points (K, 3) not in a plane [m].

    Linear in the centre and R² − |centre|² (Kåsa 1976).
    """
    middle = points.mean(axis=0)
    offset = points - middle
    squares = (offset**2).sum(axis=1)
    rows = np.column_stack([2 * offset, np.ones(len(points))])
    solved = np.linalg.lstsq(rows, squares, rcond=None)[0]
    residual, center = squares - rows @ solved, solved[:-1]
    return CircleFit(middle + center, float(np.sqrt(solved[-1] + center @ center)), float((residual**2).mean()))
