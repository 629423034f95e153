"""What to know of volumes made of voxels: where samples were too few, and where voxels are not the volume."""

from collections.abc import Iterator, Mapping
from typing import Any

from wsrender.notices import Notice

MOST_HOLES = 0.005  # of the occupied voxels
MOST_UNSEEN = 0.2  # of them, where nothing but the samples is known: a rougher measure, as large at thin borders
MOST_DIFFERENCE = 0.1  # of the refined volume
_REMEDY = "take more samples, or larger voxels"
# Samples of a chain of many joints crowd in the middle: of 12 hinges of ±180° 2^24 leave 69 holes to 100 voxels of the
# default size, 55 of three times that, and 2^16 tell neither figure.
_SELDOM = "; an arm of many joints seldom comes near the end of its reach, which the headline counts all the same"


def few_samples(holes: float | None, unseen: float) -> Iterator[Notice]:
    """That samples leave ``holes``, a share of the occupied voxels; None: unknown, then by the share ``unseen``."""
    remedy = _REMEDY
    if holes is not None and holes > MOST_HOLES:
        found = f"for every 100 voxels that hold a sample about {_count(100 * holes)} are empty though wholly reachable"
        remedy += _SELDOM
    elif holes is None and unseen > MOST_UNSEEN:
        found = f"for every 100 voxels that hold a sample more samples would find at least {_count(100 * unseen)}"
    else:
        return
    yield Notice("few_samples", f"too few samples for voxels of this size: {found}", remedy, "voxel_size_m")


def _count(number: float) -> str:
    """Two digits, written out: 0.52, 69, 291."""
    return f"{number:.2g}" if number < 10 else f"{number:.0f}"


def tolerance_not_met(measure: Mapping[str, Any] | None) -> Iterator[Notice]:
    """That the interval of a refined measure, its entry in a result document, is wider than asked."""
    if measure and measure["value"] is not None and not measure["met"]:
        name = measure.get("quantity", "volume")
        message = f"the refined {name} has a wider interval than asked for: {measure['points']} points were decided"
        yield Notice(
            "tolerance_not_met",
            f"{message}, the most there may be",
            "read the interval, or give a larger refined_volume",
            "refined_volume",
        )


def occupied_differs(occupied: float, refined: float | None, reached: str = "reachable") -> Iterator[Notice]:
    """That the occupied voxels are another volume [m³] than the one that inverse kinematics finds to be ``reached``."""
    if refined and abs(occupied - refined) > MOST_DIFFERENCE * refined:
        more = f"{100 * (occupied / refined - 1):+.0f} %"
        yield Notice(
            "occupied_differs",
            f"the occupied voxels make {occupied:.4g} m³, {more} from the {reached} volume of {refined:.4g} m³",
            "take the headline for the volume; more samples and smaller voxels bring the two together",
            "voxel_size_m",
        )
