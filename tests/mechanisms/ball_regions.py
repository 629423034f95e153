"""Ball regions that tests share."""

from dataclasses import replace

import numpy as np

from tests.mechanisms.mechanisms import mechanism
from wsrender.documents.robot import Transform
from wsrender.mechanisms.ball_region import BallRegion, ball_region

NOWHERE = np.full(3, np.inf)


def region(inside=(), outside=(), lower=(-np.inf,) * 3, upper=(np.inf,) * 3) -> BallRegion:
    """Inside and outside balls as (x, y, z, radius), and a box."""
    inner, outer = (np.array(balls, np.float64).reshape(-1, 4) for balls in (inside, outside))
    return BallRegion(inner[:, :3], inner[:, 3], outer[:, :3], outer[:, 3], np.array(lower), np.array(upper))


def six_pus(euler_xyz_deg=(0.0, 0.0, 0.0), **parameters) -> BallRegion:
    rotation = Transform(euler_xyz_deg=euler_xyz_deg).matrix()[:3, :3]
    return ball_region(mechanism({"library": "six_pus", **parameters}), rotation)


def at_origin(document) -> BallRegion:
    return ball_region(mechanism(document), np.eye(3))


def moved(original: BallRegion, shift, factor: float) -> BallRegion:
    """The region scaled by a factor about the origin, then shifted."""
    return BallRegion(
        original.inside_centres * factor + shift,
        original.inside_radii * factor,
        original.outside_centres * factor + shift,
        original.outside_radii * factor,
        original.lower * factor + shift,
        original.upper * factor + shift,
    )


def random_region(seed: int) -> BallRegion:
    """A random mechanism's: shells of different centres and radii, some equal, some tangent, half of them in a box."""
    random = np.random.default_rng(seed)
    count = int(random.integers(1, 7))
    centres = random.normal(size=(count, 3)) * random.uniform(0.05, 0.7)
    radii = random.uniform(0.8, 1.6, count)
    holes = random.uniform(0, 0.9, count) * radii
    if random.random() < 0.3:
        radii[:], holes[:] = radii[0], holes[0]
    if random.random() < 0.2:
        centres[:, 2] = 0  # vertices in pairs
    box = random.random() < 0.5
    lower = np.where(random.random(3) < 0.5, -NOWHERE, random.uniform(-1, 0, 3)) if box else -NOWHERE
    upper = np.where(random.random(3) < 0.5, NOWHERE, random.uniform(0.2, 1, 3)) if box else NOWHERE
    return replace(region(), inside_centres=centres, inside_radii=radii, outside_centres=centres, outside_radii=holes,
                   lower=lower, upper=upper)  # fmt: skip
