"""Refined volumes, areas and lengths in result documents, and the labels of voxels."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.pipeline.constraints.region import RegionConstraint
from wsrender.reach.free_volume import ALL_BLOCKED, FREE
from wsrender.reach.measure_refinement import (
    RefinedMeasure,
    free_measures,
    refined_measure,
    refined_measures,
)
from wsrender.reach.volume_estimate import Inside
from wsrender.reach.voxel_labels import label_voxels
from wsrender.robots.kinematics import Kinematics
from wsrender.volume.measure import UNITS
from wsrender.volume.volume_data import VolumeData

if TYPE_CHECKING:
    from wsrender.robot.arms_collision import ArmsApart

Progress = Callable[[int, int, str], None]
VOLUME, VOXELS = "refined volume", "labels of voxels"  # what is going on


@dataclass(frozen=True, eq=False)
class RefinedRobot:
    """What inverse kinematics says of one robot: the entry of its refined measure, the labelled voxels; None unasked.

    ``measure``: see `measure_entry`.
    """

    measure: dict[str, Any] | None
    voxels: VolumeData | None


def refined(
    chain: Kinematics,
    tolerance: float,
    seed: int,
    device: str,
    progress: Progress | None,
    threads: int | None,
    constraints: Sequence[Constraint] = (),
) -> dict[str, Any]:
    """The entry of the refined volume, area or length of a chain.

    Under constraints other than a region it is what is free, and has ``parts``: see `_parts`.
    """
    region, others = divided(constraints)
    options = {"seed": seed, "device": device, "threads": threads, "progress": _named(progress, VOLUME)}
    if not others:
        return measure_entry(refined_measure(chain, tolerance, region=region, **options), tolerance)
    found = free_measures([chain], [others], {FREE: 1}, tolerance, region=region, **options)
    return _free_entry(found[FREE], tolerance)


def _free_entry(found: Mapping[str, RefinedMeasure], tolerance: float) -> dict[str, Any]:
    """The entry of what is free, with ``parts``."""
    return measure_entry(found[FREE], tolerance) | {"parts": _parts(found)}


def _parts(found: Mapping[str, RefinedMeasure]) -> dict[str, Any]:
    """What is free, blocked in all and by each constraint, and what was left undecided, with 95 % intervals."""
    of_each = {name: {"value": each.value, "ci95": each.ci95 and list(each.ci95)} for name, each in found.items()}
    free, blocked = of_each.pop(FREE), of_each.pop(ALL_BLOCKED)
    undecided = {"value": found[FREE].undecided, "ci95": list(found[FREE].undecided_ci95)}
    return {"free": free, "blocked": blocked | {"by": of_each}, "undecided": undecided}


def divided(constraints: Sequence[Constraint]) -> tuple[RegionConstraint | None, list[Constraint]]:
    """The region, which is asked of targets themselves, and the other constraints."""
    region = next((each for each in constraints if isinstance(each, RegionConstraint)), None)
    return region, [each for each in constraints if each is not region]


def labelled(
    chain: Kinematics,
    volume: VolumeData,
    seed: int,
    device: str,
    progress: Progress | None,
    threads: int | None,
    constraints: Sequence[Constraint] = (),
) -> VolumeData:
    """The labels of a workspace's ``volume``."""
    options = {"seed": seed, "device": device, "threads": threads, "progress": _named(progress, VOXELS)}
    return label_voxels(chain, volume, constraints, **options)


def refined_together(
    chains: Sequence[Kinematics],
    events: Mapping[str, Inside],
    tolerance: float,
    device: str,
    progress: Progress | None,
    threads: int | None,
    constraints: Sequence[Sequence[Constraint]],
    apart: "Mapping[tuple[int, int], ArmsApart]",
) -> dict[str, dict[str, Any]]:
    """Entries of what so many of several placed chains reach, by event; see `refined`.

    ``constraints`` of each chain have the same names. ``apart``: arms, by their places, that must keep apart where two
    reach a point together.
    """
    options = {"device": device, "threads": threads, "progress": _named(progress, VOLUME)}
    divisions = [divided(each) for each in constraints]
    region, others = divisions[0][0], [each for _, each in divisions]
    if not others[0] and not apart:
        found = refined_measures(chains, events, tolerance, region=region, **options)
        return {name: measure_entry(measure, tolerance) for name, measure in found.items()}
    least = {name: event.least for name, event in events.items()}
    free = free_measures(chains, others, least, tolerance, apart=apart, region=region, **options)
    return {name: _free_entry(found, tolerance) for name, found in free.items()}


def measure_entry(found: RefinedMeasure, tolerance: float) -> dict[str, Any]:
    """What a document says of a volume, area or length with its 95 % interval; ``value`` None where there is none."""
    return {
        "quantity": found.quantity,
        "value": found.value,
        "unit": found.unit,
        "reason": found.reason,
        "ci95": None if found.ci95 is None else list(found.ci95),
        "tolerance": tolerance,
        "met": found.met,
        "undecided": found.undecided,
        "points": found.points,
        "position_tolerance_m": found.position_tolerance_m,
        "false_negatives": [{"tested": f.tested, "missed": f.missed} for f in found.false_negatives],
    }


def by_measure(measure: dict[str, Any] | None, entry: Any) -> dict[str, Any]:
    """The ``entry`` under what the measure is, {"volume_m3": {"refined": …}} …: None there where it has no value.

    Beside it the parts of a measure under constraints, free, blocked and undecided.
    """
    quantity = measure["quantity"] if measure else "volume"
    known = measure is not None and measure["value"] is not None
    parts = measure.get("parts", {}) if measure and known else {}
    if isinstance(entry, dict):
        entry = {name: value for name, value in entry.items() if name != "parts"}
    found = {"volume_m3": {"refined": None}}
    return found | {f"{quantity}_{UNITS[quantity]}": {"refined": entry if known else None, **parts}}


def volume_entry(measure: dict[str, Any]) -> dict[str, Any]:
    """A `measure_entry` as a volume [m³]: 0 of what is flat, or stays on a surface or curve."""
    entry = {name: value for name, value in measure.items() if name not in ("quantity", "unit", "reason", "parts")}
    solid = measure["quantity"] == "volume" and measure["value"] is not None
    return entry if solid else entry | {"value": 0.0, "ci95": [0.0, 0.0], "met": True, "undecided": 0.0}


def _named(progress: Progress | None, message: str) -> Callable[[int, int], None] | None:
    return None if progress is None else lambda done, total: progress(done, total, message)
