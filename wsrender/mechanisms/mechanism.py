"""Parallel mechanisms as arrays: one row per leg, in the base frame."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations, product

import numpy as np

from wsrender.documents.legs import ClosedFormLeg, Cone, DeltaLeg, Leg, PUSLeg, RUSLeg, SerialLeg, UPSLeg
from wsrender.documents.mechanism import Delta, LegsMechanism, MechanismSpec, SixPUS, StewartGough
from wsrender.documents.robot import Transform
from wsrender.mechanisms.bodies import Solids, bodies_of
from wsrender.mechanisms.serial_leg import NumericLeg, numeric_leg
from wsrender.pipeline.constraints.leg_distance import LegDistance
from wsrender.robot import Robot


@dataclass(frozen=True, eq=False)
class Mechanism:
    """Geometry and limits of legs; points and axes in the base frame, those of the platform in its own [m].

    The arrays are those of L legs in closed form; ``numeric`` are the others.

    ``kinds`` (L,): "UPS", "PUS", "RUS" or "delta". ``base``, ``platform`` (L, 3): ends of the legs; ``axis`` (L, 3):
    unit vector of the rail or of the crank's axis, ``zero`` (L, 3) of the crank at angle 0; ``crank``, ``link`` (L,)
    their lengths. ``lower``, ``upper`` (L,): limits of length, slider [m] or crank angle [rad]. ``branches`` (L, 2)
    bool: whether the solution "minus", "plus" of the actuated joint counts. ``base_cone_axis`` (L, 3) and
    ``base_cone_cosine`` (L,), -1 where there is none, limit the direction of the link at its base-side joint;
    ``platform_cone_…`` at the platform. What a kind of leg does not have is 0.
    ``region_lower``, ``region_upper`` (3,): box of the platform's origin, infinite where it has no side.
    ``constraints``: of `LegDistance`, where two legs may not come closer. ``T_world_base`` (4, 4). ``home`` (4, 4): a
    pose that is reached, in the base frame, or None. ``bodies``: solids that keep apart, or None.
    """

    name: str
    kinds: tuple[str, ...]
    base: np.ndarray
    platform: np.ndarray
    axis: np.ndarray
    zero: np.ndarray
    crank: np.ndarray
    link: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    branches: np.ndarray
    base_cone_axis: np.ndarray
    base_cone_cosine: np.ndarray
    platform_cone_axis: np.ndarray
    platform_cone_cosine: np.ndarray
    region_lower: np.ndarray
    region_upper: np.ndarray
    constraints: tuple[LegDistance, ...]
    T_world_base: np.ndarray
    home: np.ndarray | None
    numeric: tuple[NumericLeg, ...] = ()
    bodies: Solids | None = None

    @property
    def n(self) -> int:
        """Number of legs in closed form."""
        return len(self.kinds)

    @property
    def translational(self) -> bool:
        """Whether parallelograms keep the platform from turning."""
        return "delta" in self.kinds

    @property
    def branched(self) -> bool:
        """Whether a leg may stand on either of two branches."""
        return bool(self.branches.all(axis=1).any())

    @property
    def revolute(self) -> tuple[bool, ...]:
        """Whether each actuated joint turns, or slides: those of legs in closed form, then of the others."""
        closed = tuple(kind not in ("UPS", "PUS") for kind in self.kinds)
        return closed + tuple(bool(turns) for leg in self.numeric for turns in leg.chain.revolute[leg.actuated])

    def on_each_branch(self) -> "list[Mechanism]":
        """The mechanism with every leg on one branch, once for each combination; the first prefers "plus"."""
        choices = [[k for k in (1, 0) if allowed[k]] for allowed in self.branches]
        return [replace(self, branches=np.eye(2, dtype=bool)[list(chosen)]) for chosen in product(*choices)]

    @property
    def numbers(self) -> list[int]:
        """Places of the legs in closed form among all legs of the document."""
        numeric = {leg.number for leg in self.numeric}
        return [k for k in range(len(self.kinds) + len(numeric)) if k not in numeric]

    @property
    def degrees_of_freedom(self) -> int:
        """Degrees of freedom of the platform where the legs are actuated: 3 of a delta, else 6."""
        return 3 if self.translational else 6


def mechanism_of(spec: MechanismSpec, robots: Sequence[Robot] | None = None) -> Mechanism:
    """The mechanism of a document; ``robots``: those of its serial legs, if they are loaded.

    Raises ModelError and InputError for a serial leg that is no robot.
    """
    of_document = legs_of(spec)
    legs = [leg for leg in of_document if not isinstance(leg, SerialLeg)]
    serial = [(k, leg) for k, leg in enumerate(of_document) if isinstance(leg, SerialLeg)]
    given = [None] * len(serial) if robots is None else robots
    name = spec.name if isinstance(spec, LegsMechanism) else spec.library
    region = spec.region
    numeric = tuple(numeric_leg(k, leg, robot) for (k, leg), robot in zip(serial, given, strict=True))
    return Mechanism(
        name=name,
        kinds=tuple(leg.type for leg in legs),
        base=_rows(leg.base_m for leg in legs),
        platform=_rows(leg.platform_m for leg in legs),
        axis=_rows(_unit(leg.axis) if isinstance(leg, PUSLeg | RUSLeg) else _NONE for leg in legs),
        zero=_rows(_at_right_angles(leg) if isinstance(leg, RUSLeg) else _NONE for leg in legs),
        crank=np.array([leg.crank_m if isinstance(leg, RUSLeg) else 0.0 for leg in legs]),
        link=np.array([leg.link_m if isinstance(leg, PUSLeg | RUSLeg) else 0.0 for leg in legs]),
        lower=np.array([_limits(leg)[0] for leg in legs]),
        upper=np.array([_limits(leg)[1] for leg in legs]),
        branches=np.array([_branches(leg) for leg in legs], bool).reshape(-1, 2),
        base_cone_axis=_rows(_cone(leg.base_cone)[0] for leg in legs),
        base_cone_cosine=np.array([_cone(leg.base_cone)[1] for leg in legs]),
        platform_cone_axis=_rows(_cone(leg.platform_cone)[0] for leg in legs),
        platform_cone_cosine=np.array([_cone(leg.platform_cone)[1] for leg in legs]),
        region_lower=np.array([-np.inf if side is None else side for side in region.lower_m]),
        region_upper=np.array([np.inf if side is None else side for side in region.upper_m]),
        constraints=_constraints(spec.minimum_leg_distance_m, legs),
        T_world_base=(spec.placement or Transform()).matrix(),
        home=spec.home.matrix() if spec.home else None,
        numeric=numeric,
        bodies=bodies_of(
            spec.bodies,
            (spec.placement or Transform()).matrix(),
            _apart(legs),
            [(np.array(leg.base_m), np.array(leg.platform_m)) for leg in legs],
            numeric,
            moves=bool(spec.before),
        ),
    )


def _constraints(least_m: float | None, legs: Sequence[ClosedFormLeg]) -> tuple[LegDistance, ...]:
    """That legs keep a distance, if asked; those that share an end, or a rail, may touch."""
    pairs = _apart(legs)
    return (LegDistance(least_m, pairs),) if least_m and pairs else ()


def _apart(legs: Sequence[ClosedFormLeg]) -> tuple[tuple[int, int], ...]:
    """Pairs of legs that share neither an end nor a rail."""
    return tuple((a, b) for a, b in combinations(range(len(legs)), 2) if not _share_an_end(legs[a], legs[b]))


def _share_an_end(a: ClosedFormLeg, b: ClosedFormLeg) -> bool:
    return np.array_equal(a.base_m, b.base_m) or np.array_equal(a.platform_m, b.platform_m)


def legs_of(spec: MechanismSpec) -> tuple[Leg, ...]:
    """The legs of a document, those of a library mechanism from its parameters."""
    match spec:
        case StewartGough():
            return _stewart_gough(spec)
        case SixPUS():
            return _six_pus(spec)
        case Delta():
            return _delta(spec)
        case LegsMechanism():
            return spec.legs


def _stewart_gough(spec: StewartGough) -> tuple[Leg, ...]:
    """Base pairs at 0, 120, 240°, platform pairs half way between: leg 2k and 2k + 1 go to neighbouring pairs."""
    pairs = np.array([0, 0, 120, 120, 240, 240])
    sides = np.array([-0.5, 0.5] * 3)
    base = spec.base_points_m or _on_circle(spec.base_radius_m, pairs + sides * spec.base_angle_deg)
    turned = pairs + sides * (120 - spec.platform_angle_deg)
    platform = spec.platform_points_m or _on_circle(spec.platform_radius_m, turned)
    return tuple(UPSLeg(base_m=b, platform_m=p, length_m=spec.length_m) for b, p in zip(base, platform, strict=True))


def _six_pus(spec: SixPUS) -> tuple[Leg, ...]:
    """[SNK]: n_i = (cos φ, sin φ, 0), φ = -90°, 30°, 150°; rails along z × n_i; legs minus, plus of each pair."""
    a, b = spec.slide_m
    legs: list[Leg] = []
    for link, azimuth in zip(spec.link_m, (-90, 30, 150), strict=True):
        n = _directions(np.array([azimuth]))[0]
        shared = {
            "base_m": n * spec.side_m / (2 * np.sqrt(3)),
            "platform_m": n * spec.platform_m / np.sqrt(3),
            "axis": (-n[1], n[0], 0.0),
            "link_m": link,
        }
        legs.append(PUSLeg(**shared, slide_m=(-b, -a), branch="minus"))
        legs.append(PUSLeg(**shared, slide_m=(a, b), branch="plus"))
    return tuple(legs)


def _delta(spec: Delta) -> tuple[Leg, ...]:
    """Cranks in the planes at 0, 120, 240°; positive angles turn them down. The elbows stay outside: branch minus."""
    return tuple(
        DeltaLeg(
            base_m=spec.base_radius_m * n,
            platform_m=spec.platform_radius_m * n,
            axis=(-n[1], n[0], 0.0),
            zero=n,
            crank_m=spec.crank_m,
            link_m=spec.link_m,
            angle_deg=spec.angle_deg,
            branch="minus",
        )
        for n in _directions(np.array([0, 120, 240]))
    )


def _directions(azimuth_deg: np.ndarray) -> np.ndarray:
    """Horizontal unit vectors (N, 3)."""
    azimuth = np.deg2rad(azimuth_deg)
    return np.stack([np.cos(azimuth), np.sin(azimuth), np.zeros(len(azimuth))], axis=1)


def _on_circle(radius: float, azimuth_deg: np.ndarray) -> np.ndarray:
    return radius * _directions(azimuth_deg)


_NONE = np.zeros(3)


def _rows(vectors) -> np.ndarray:
    return np.array(list(vectors), np.float64).reshape(-1, 3)


def _unit(vector) -> np.ndarray:
    return np.array(vector) / np.linalg.norm(vector)


def _at_right_angles(leg: RUSLeg) -> np.ndarray:
    """The direction at angle 0, freed of what rounding left of the axis in it."""
    axis, zero = _unit(leg.axis), _unit(leg.zero)
    return _unit(zero - (zero @ axis) * axis)


def _limits(leg: ClosedFormLeg) -> tuple[float, float]:
    match leg:
        case UPSLeg():
            return leg.length_m
        case PUSLeg():
            return leg.slide_m
        case _:
            lower, upper = np.deg2rad(leg.angle_deg)
            return float(lower), float(upper)


def _branches(leg: ClosedFormLeg) -> tuple[bool, bool]:
    """Whether "minus", "plus" count; a UPS leg has one length, called plus."""
    branch = "plus" if isinstance(leg, UPSLeg) else leg.branch
    return branch != "plus", branch != "minus"


def _cone(cone: Cone | None) -> tuple[np.ndarray, float]:
    return (_NONE, -1.0) if cone is None else (_unit(cone.axis), float(np.cos(np.deg2rad(cone.half_angle_deg))))
