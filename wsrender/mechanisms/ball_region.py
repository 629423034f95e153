"""Constant-orientation workspaces that are intersections of balls and complements of balls ([SNK], Merlet 1999).

A leg of variable length holds its platform joint in a spherical shell. A pair of links of one length that share their
platform joint, with sliders on either side of it on one rail, holds it inside the balls around the inner ends of the
sliders' ranges and outside those around the outer ends. For the platform's position these are balls too, shifted by
the turned platform point.
"""

from dataclasses import dataclass

import numpy as np

from wsrender.errors import InputError
from wsrender.mechanisms.mechanism import Mechanism
from wsrender.volume.table import Table

THINNEST = 1e-8  # range of a leg, relative to its longest: below it surfaces count as one (`exact.surfaces.APART`)
UNITS = {"center": "m", "radius": "m", "area": "m^2"}


@dataclass(frozen=True, eq=False)
class BallRegion:
    """Points inside all of some balls, outside all of others, and in a box; base frame [m].

    ``inside_centres`` (A, 3), ``inside_radii`` (A,), ``outside_centres`` (B, 3), ``outside_radii`` (B,); ``lower`` and
    ``upper`` (3,) are the box, infinite where it has no side. The boundary belongs to the region. ``limits`` says which
    leg is at which limit, "lower" or "upper", on each ball's surface, inside balls first; empty where nobody knows.
    """

    inside_centres: np.ndarray
    inside_radii: np.ndarray
    outside_centres: np.ndarray
    outside_radii: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    limits: tuple[tuple[int, str], ...] = ()

    def contains(self, points: np.ndarray) -> np.ndarray:
        """Whether points (N, 3) [m] lie in the region, (N,) bool."""
        inside = np.all((points >= self.lower) & (points <= self.upper), axis=1)
        for center, radius in zip(self.inside_centres, self.inside_radii, strict=True):
            inside &= ((points - center) ** 2).sum(axis=1) <= radius**2
        for center, radius in zip(self.outside_centres, self.outside_radii, strict=True):
            inside &= ((points - center) ** 2).sum(axis=1) >= radius**2
        return inside

    def sides_of_box(self) -> tuple[np.ndarray, np.ndarray]:
        """Outward normals (P, 3) and offsets (P,) [m] of the box's finite sides, lower first: x · normal ≤ offset."""
        below, above = np.isfinite(self.lower), np.isfinite(self.upper)
        normals = np.concatenate([-np.eye(3)[below], np.eye(3)[above]])
        return normals, np.concatenate([-np.asarray(self.lower)[below], np.asarray(self.upper)[above]])


def ball_region(mechanism: Mechanism, rotation: np.ndarray) -> BallRegion:
    """The constant-orientation workspace of a mechanism at a platform orientation (3, 3), both in the base frame.

    Raises InputError where a leg is neither UPS nor one of a pair of PUS legs, or where a joint's cone or the distance
    of the legs is limited: then the workspace is bounded by other surfaces too; and where a leg hardly moves.
    """
    if mechanism.constraints:
        raise InputError("minimum_leg_distance_m", "must be null: else not only spheres bound the workspace")
    if mechanism.bodies:
        raise InputError("bodies", "must be null: else not only spheres bound the workspace")
    for leg in mechanism.numeric:
        raise InputError(f"legs.{leg.number}", "is solved numerically: what bounds the workspace is unknown")
    shift = mechanism.platform @ rotation.T
    inside: list[tuple[np.ndarray, float]] = []
    outside: list[tuple[np.ndarray, float]] = []
    at_inside: list[tuple[int, str]] = []
    at_outside: list[tuple[int, str]] = []
    for k, kind in enumerate(mechanism.kinds):
        if max(mechanism.base_cone_cosine[k], mechanism.platform_cone_cosine[k]) > -1:
            raise InputError(f"legs.{k}", "must have no cone: else not only spheres bound the workspace")
        _check_range(mechanism, k)
        if kind == "UPS":
            inner, outer = (mechanism.base[k], mechanism.upper[k]), (mechanism.base[k], mechanism.lower[k])
            sides = "upper", "lower"
        elif kind == "PUS" and _has_partner(mechanism, k):
            near, far, sides = mechanism.lower[k], mechanism.upper[k], ("lower", "upper")
            if mechanism.branches[k, 0]:  # the slider on the lower side
                near, far, sides = far, near, sides[::-1]
            rail, axis, link = mechanism.base[k], mechanism.axis[k], mechanism.link[k]
            inner, outer = (rail + near * axis, link), (rail + far * axis, link)
        else:
            raise InputError(
                f"legs.{k}", f"is a {kind} leg; spheres alone bound the workspace of UPS legs and pairs of PUS legs"
            )
        inside.append((inner[0] - shift[k], float(inner[1])))
        at_inside.append((k, sides[0]))
        if outer[1] > 0:
            outside.append((outer[0] - shift[k], float(outer[1])))
            at_outside.append((k, sides[1]))
    box = mechanism.region_lower, mechanism.region_upper
    return BallRegion(*_stacked(inside), *_stacked(outside), *box, (*at_inside, *at_outside))


def _check_range(mechanism: Mechanism, leg: int) -> None:
    lower, upper = mechanism.lower[leg], mechanism.upper[leg]
    longest = max(abs(lower), abs(upper), mechanism.link[leg])
    if upper - lower < THINNEST * longest:
        message = f"must have limits {THINNEST * longest:.3g} m apart or more, not {upper - lower:.3g} m"
        raise InputError(f"legs.{leg}", f"{message}: surfaces so near each other are one in float64")


def _stacked(balls: list[tuple[np.ndarray, float]]) -> tuple[np.ndarray, np.ndarray]:
    """Centres (A, 3) and radii (A,)."""
    return np.array([center for center, _ in balls]).reshape(-1, 3), np.array([radius for _, radius in balls])


def _has_partner(mechanism: Mechanism, leg: int) -> bool:
    """Whether another PUS leg has the same rail, link and platform joint, and its slider on the other side."""
    return any(_are_pair(mechanism, leg, other) for other in range(len(mechanism.kinds)) if other != leg)


def _are_pair(mechanism: Mechanism, a: int, b: int) -> bool:
    if mechanism.kinds[b] != "PUS":
        return False
    same = all(
        np.array_equal(getattr(mechanism, name)[a], getattr(mechanism, name)[b])
        for name in ("base", "axis", "link", "platform")
    )
    one_each = mechanism.branches[[a, b]].sum(axis=1).tolist() == [1, 1]
    minus, plus = (a, b) if mechanism.branches[a, 0] else (b, a)
    apart = mechanism.branches[minus, 0] and mechanism.branches[plus, 1]
    return bool(same and one_each and apart and mechanism.upper[minus] <= mechanism.lower[plus])


def region_of(mechanism: Mechanism, rotation: np.ndarray) -> BallRegion:
    """The ball region of a job's mechanism; InputError where other surfaces bound the workspace."""
    try:
        return ball_region(mechanism, rotation)
    except InputError as error:
        raise error.within("mechanism") from None


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
