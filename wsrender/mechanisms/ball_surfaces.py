"""The surfaces that bound a ball region, as a table."""

import numpy as np

from wsrender.mechanisms.ball_region import BallRegion
from wsrender.volume.table import Table

UNITS = {"center": "m", "radius": "m", "area": "m^2"}


def surface_table(region: BallRegion, area: np.ndarray, T_world_base: np.ndarray) -> Table:
    """A row for every surface of a region, in the order in which meshes number them, world frame.

    ``area`` (K,) [m²] is what of each bounds the region. Columns: ``kind`` (inside: the region is inside the ball,
    outside, or plane), ``leg``, counted from 1 (0: none), and the ``limit`` at which it is there, ``center`` and
    ``radius`` of a ball (NaN radius of a plane, whose centre is a point of it), ``normal`` of a plane, out of the
    region (NaN of a ball).
    """
    R, shift = T_world_base[:3, :3], T_world_base[:3, 3]
    normals, offsets = region.sides_of_box()
    balls, planes = len(region.inside_radii) + len(region.outside_radii), len(normals)
    kinds = ["inside"] * len(region.inside_radii) + ["outside"] * len(region.outside_radii) + ["plane"] * planes
    limits = [*(region.limits or [(-1, "")] * balls), *[(-1, "")] * planes]
    centres = np.concatenate([region.inside_centres, region.outside_centres, offsets[:, None] * normals])
    columns = {
        "kind": np.array(kinds, str),
        "leg": np.array([leg + 1 for leg, _ in limits], np.int64),
        "limit": np.array([limit for _, limit in limits], str),
        "center": centres @ R.T + shift,
        "radius": np.concatenate([region.inside_radii, region.outside_radii, np.full(planes, np.nan)]),
        "normal": np.concatenate([np.full((balls, 3), np.nan), normals @ R.T]),
        "area": area,
    }
    return Table(columns, UNITS)
