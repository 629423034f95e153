"""The exact volume of a mechanism's constant-orientation workspace, and its derivative by design parameters."""

from collections.abc import Callable

import numpy as np

from wsrender.mechanisms.ball_region import BallRegion
from wsrender.mechanisms.exact import exact_volumes
from wsrender.mechanisms.exact.surfaces import make_up

STEP = 1e-6  # of a parameter's range, for differences of centres and radii, which are smooth in the parameters

Regions = Callable[[np.ndarray], list[BallRegion]]


def volumes_of(regions: list[BallRegion]) -> np.ndarray:
    """Volumes (N,) [m³], NaN of regions too thin for float64; those with the same numbers of balls are joined."""
    kinds: dict[tuple, list[int]] = {}
    for k, region in enumerate(regions):
        kinds.setdefault(make_up(region), []).append(k)
    volumes = np.empty(len(regions))
    for rows in kinds.values():
        volumes[rows] = exact_volumes([regions[k] for k in rows]).volume
    return volumes


def volume_gradient(regions_at: Regions, design: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
    """Derivatives (n,) of the volume by the parameters at a design (n,), all within bounds.

    Exact derivatives by centres and radii, times differences of these by the parameters.
    """
    (here,) = regions_at(design[None])
    exact = exact_volumes([here])
    slopes = np.concatenate([exact.by_centre[0].ravel(), exact.by_radius[0], exact.by_bound[0]])
    gradient = np.empty(len(design))
    for k, step in enumerate(STEP * (upper - lower)):
        ends = np.repeat(design[None], 2, axis=0)
        ends[:, k] = max(design[k] - step, lower[k]), min(design[k] + step, upper[k])
        before, after = (_numbers(region) for region in regions_at(ends))
        gradient[k] = slopes @ (after - before) / (ends[1, k] - ends[0, k])
    return gradient


def _numbers(region: BallRegion) -> np.ndarray:
    """All centres, radii and finite bounds of a region, as `ExactVolumes` orders their derivatives."""
    bounds = np.concatenate([region.lower, region.upper])
    return np.concatenate(
        [
            region.inside_centres.ravel(),
            region.outside_centres.ravel(),
            region.inside_radii,
            region.outside_radii,
            bounds[np.isfinite(bounds)],
        ]
    )
