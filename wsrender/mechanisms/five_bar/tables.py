"""What is known of a five-bar as tables: boundary, loci, iso-curves, aspects, postures."""

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from wsrender.mechanisms.five_bar.aspects import Aspect
from wsrender.mechanisms.five_bar.condition_numbers import conditioning
from wsrender.mechanisms.five_bar.isotropy import JointMap, PlaneLattice, iso_curves, isotropic_b, isotropic_points
from wsrender.mechanisms.five_bar.loci import LocusPiece, end_point, least_kappa_a_curves, pieces
from wsrender.mechanisms.five_bar.mechanism import FiveBar, wrapped
from wsrender.mechanisms.five_bar.region import LEGS, Arc, ArcRegion
from wsrender.volume.table import Table

POSTURE = {"position": "m", "theta": "rad"}
INDICES = ("inverse_kappa_a", "inverse_kappa_b", "inverse_kappa_j", "manipulability")
PIECE_SEGMENTS = 360
ARC_SEGMENTS = 180  # of a turn
ON_BORDER = 1e-9  # sine of the angle between distal links that are in line
_ENDS = 1e-9  # share of an arc left out at its ends, where rounding may put a corner out of reach


def boundary_table(regions: dict[str, ArcRegion]) -> Table:
    """The arcs of every working mode's workspace, loop by loop with the interior on the left."""
    rows = [
        (mode, loop, arc.name, arc.center, arc.radius, arc.start, arc.sweep)
        for mode, region in regions.items()
        for loop, arcs in enumerate(region.loops)
        for arc in arcs
    ]
    names = ("working_mode", "loop", "arc", "center", "radius", "start", "sweep")
    kinds = (str, int, str, float, float, float, float)
    columns = {
        name: np.array([row[k] for row in rows], kind) for k, (name, kind) in enumerate(zip(names, kinds, strict=True))
    }
    columns["center"] = columns["center"].reshape(-1, 2)
    return Table(columns, {"center": "m", "radius": "m", "start": "rad", "sweep": "rad"})


def loci_table(five_bar: FiveBar, regions: dict[str, ArcRegion], type_2: Iterable[LocusPiece]) -> Table:
    """Vertices of the loci in every working mode, curve by curve, each vertex on its locus.

    ``kind``: type_1 (det B = 0: the boundary but for limits), joint_limit, type_2 (det A = 0), least_kappa_a (the
    distal links at right angles: κ(A) = 1 where they are equal), isotropic_b (κ(B) = 1), isotropic_j (points
    with κ(J) = 1).
    """
    curves = []
    least = [piece for curve in least_kappa_a_curves(five_bar) for piece in pieces(curve)]
    for mode, region in regions.items():
        for arc in (arc for loop in region.loops for arc in loop):
            kind = "type_1" if arc.name.endswith(("outer", "inner")) else "joint_limit"
            curves.append((kind, mode, _arc_angles(five_bar, mode, arc)))
        for piece in (piece for piece in [*type_2, *least] if piece.working_mode == mode):
            curves.append((piece.curve.kind, mode, piece.angles(PIECE_SEGMENTS)))
        curves += [("isotropic_b", mode, run) for run in isotropic_b(five_bar, mode)]
        curves += [("isotropic_j", mode, posture[None]) for posture in isotropic_points(five_bar, mode)]
    labels = {"kind": [kind for kind, *_ in curves], "working_mode": [mode for _, mode, _ in curves]}
    return _curves_table(five_bar, [angles for *_, angles in curves], labels)


def _arc_angles(five_bar: FiveBar, working_mode: str, arc: Arc) -> np.ndarray:
    """Postures along an arc of the boundary, θ1 … θ4 (N, 4): its own leg's from the arc, the other's from P."""
    share = np.linspace(_ENDS, 1 - _ENDS, max(int(ARC_SEGMENTS * abs(arc.sweep) / (2 * np.pi)), 8) + 1)
    leg = LEGS.index(arc.name.split()[0])
    free = replace(five_bar, limits_rad=(None, None))
    points, along = arc.points(share), arc.first + share * (arc.last - arc.first)
    signs = [1 if sign == "+" else -1 for sign in working_mode]
    limits = five_bar.limits_rad[leg]
    end = arc.name.split()[1]
    if end in ("outer", "inner"):
        own = along, along + (np.pi * signs[leg] if end == "inner" else 0.0)
    else:
        assert limits is not None
        held = np.full(len(share), limits[0] if end == "low" else limits[1])
        own = held, held + signs[leg] * along
    other = free.leg_angles(points, 1 - leg, signs[1 - leg])
    pair = (own, other) if leg == 0 else (other, own)
    return np.stack([pair[0][0], pair[1][0], pair[0][1], pair[1][1]], axis=1)


def iso_table(
    five_bar: FiveBar, lattice: PlaneLattice, maps: dict[str, dict[str, np.ndarray]], kappas: Sequence[float]
) -> Table:
    """Vertices of the iso-conditioning curves of ``maps`` (mode, then inverse_kappa), curve by curve."""
    curves = [
        (quantity.removeprefix("inverse_"), mode, kappa, angles)
        for mode, values in maps.items()
        for quantity in INDICES[:3]
        for kappa, angles in iso_curves(five_bar, mode, lattice, values[quantity], quantity, kappas)
    ]
    labels = {name: [curve[k] for curve in curves] for k, name in enumerate(("quantity", "working_mode", "level"))}
    return _curves_table(five_bar, [angles for *_, angles in curves], labels)


def _curves_table(five_bar: FiveBar, runs: list[np.ndarray], labels: dict[str, list]) -> Table:
    counts = [len(run) for run in runs]
    angles = np.concatenate([np.empty((0, 4)), *runs])
    columns = {name: np.repeat(np.array(values, None if values else str), counts) for name, values in labels.items()}
    columns["curve"] = np.repeat(np.arange(len(runs)), counts)
    # Which assembly mode: the sign of sin(θ4 − θ3), 0 on the type-2 loci.
    sine = np.sin(angles[:, 3] - angles[:, 2])
    columns["assembly"] = np.where(np.abs(sine) < ON_BORDER, 0, np.sign(sine)).astype(np.int8)
    columns |= {"position": end_point(five_bar, angles), "theta": _principal(five_bar, angles)}
    return Table(columns, POSTURE)


def _principal(five_bar: FiveBar, angles: np.ndarray) -> np.ndarray:
    """θ1 and θ2 less whole turns: within limits, or in [−π, π]."""
    turned = []
    for leg in (0, 1):
        limits = five_bar.limits_rad[leg]
        middle = sum(limits) / 2 if limits else 0.0
        turned.append(middle + wrapped(angles[:, leg] - middle))
    return np.stack(turned, axis=1)


def joint_table(found: JointMap) -> Table:
    """The joint-space map: a row for each posture on the lattice of θ1 and θ2."""
    columns = {
        "cell": found.cell,
        "theta": found.angles[:, :2],
        "position": found.position,
        "working_mode": found.working_mode,
        "assembly_mode": found.assembly_mode,
    }
    return Table(columns | {name: getattr(found.conditioning, name) for name in INDICES[:3]}, POSTURE)


def outlines_table(aspects: Sequence[Aspect]) -> Table:
    """Vertices of the aspects' boundaries, loop by loop; ``aspect`` counts them in the order given."""
    loops = [(number, loop, line) for number, each in enumerate(aspects) for loop, line in enumerate(each.loops)]
    counts = [len(line) for *_, line in loops]
    owners = [aspects[number] for number, *_ in loops]
    columns = {
        "aspect": np.repeat(np.array([number for number, *_ in loops], int), counts),
        "working_mode": np.repeat(np.array([each.working_mode for each in owners], str), counts),
        "assembly_mode": np.repeat(np.array([each.assembly_mode for each in owners], str), counts),
        "area": np.repeat(np.array([each.area_m2 for each in owners], float), counts),
        "loop": np.repeat(np.array([loop for _, loop, _ in loops], int), counts),
        "position": np.concatenate([np.empty((0, 2)), *(line for *_, line in loops)]),
    }
    return Table(columns, {"area": "m^2", "position": "m"})


def postures_table(five_bar: FiveBar, modes: Sequence[str], angles: np.ndarray) -> Table:
    """Postures (N, 4) by name: joints A, C, P, D, B [m] and indices; NaN rows could not be assumed."""
    elbows = five_bar.elbows(angles)
    found = conditioning(five_bar, angles)
    bases = np.broadcast_to(five_bar.bases, (len(angles), 2, 2))
    chain = np.concatenate(
        [bases[:, :1], elbows[:, :1], end_point(five_bar, angles)[:, None], elbows[:, 1:], bases[:, 1:]], 1
    )
    columns = {"working_mode": np.array(modes, str), "angles": angles, "chain": chain.reshape(-1, 10)}
    columns |= {name: getattr(found, name) for name in INDICES}
    return Table(columns, {"angles": "rad", "chain": "m", "manipulability": "m^2"})
