"""What a job takes: the one account from which its estimate, the limit of its samples and the check of memory come."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from wsrender.errors import ResourceError
from wsrender.memory import SHARE, available_bytes
from wsrender.volume.lattice import rounded_up


@dataclass(frozen=True)
class Asks:
    """The field of a job that asks for most of its memory, and what to do where that is not there.

    ``voxel_size_m``: the edge of its voxels [m], where larger ones are the remedy.
    """

    field: str = "analysis"
    remedy: str = "ask for less"
    voxel_size_m: float | None = None


@dataclass(frozen=True)
class Cost:
    """Samples, memory, files and time of a job, as planning knows them.

    ``samples``: configurations, points, poses or pairs that the analysis decides, those of refined volumes not among
    them. ``memory_bytes``: the largest arrays that the host holds at a time, from plan to result; ``asks``: who asks
    for most of them. ``file_bytes``: the artifacts' numbers, of compressed files before they are compressed.
    ``seconds``: on idle cores or a GPU, from plan to saved files.
    """

    samples: float
    memory_bytes: float
    file_bytes: float
    seconds: float
    asks: Asks = field(default=Asks(), compare=False)

    def estimate(self) -> dict[str, float]:
        """As the HTTP interface and the command line give it; ``bytes`` is the name that ``memory_bytes`` had first."""
        return {
            "samples": float(self.samples),
            "bytes": float(self.memory_bytes),
            "memory_bytes": float(self.memory_bytes),
            "file_bytes": float(self.file_bytes),
            "seconds": float(self.seconds),
        }


NOTHING = Cost(0, 0, 0, 0)


class Costed:
    """A plan whose estimate is its cost."""

    cost: Any  # a Cost: field or property of the plan

    @property
    def estimate(self) -> dict[str, float]:
        """Samples, bytes of memory and files, and seconds: see `Cost`."""
        return self.cost.estimate()


# Of pictures as drawn of small jobs of a six-joint arm: bytes of each, and one core's seconds; the numbers of the
# histogram are in its. All below was measured by benchmarks/cost.py.
PICTURES = {
    "slices": (8.0e4, 0.25),
    "scatter": (4.2e5, 0.25),
    "histogram": (1.3e5, 0.4),
    "robot": (1.6e5, 0.2),
    "arm": (1.05e5, 0.2),  # in one posture
    "surface": (1.6e5, 1.1),  # of a volume, with arms in it
    "arm_in_surface": (1.4e5, 1.0),
    "posture": (1.6e5, 0.2),
    "admission": (6.0e4, 0.25),
    "share": (8.0e4, 0.25),
    "labels": (6.0e4, 0.25),
    "field": (2.0e4, 1.3),  # without its arrows
    "product": (9.0e4, 0.2),
    "comparison": (1.4e5, 0.4),
    "targets": (1.1e5, 0.12),
    "postures": (2.5e5, 0.4),
    "placements": (4.5e4, 0.2),
    "arms_map": (8.0e4, 0.4),
    "pareto": (6.0e4, 0.2),
    "mapping": (2.2e5, 0.3),
    "scales": (9.0e4, 0.15),
    "refinements": (5.0e4, 0.1),
    "map": (6.5e5, 0.7),  # of a five-bar
    "patches": (2.5e5, 1.7),
    "other": (1.2e5, 0.15),
}
DOCUMENT_BYTES = 1.0e4  # of a result document, without what is listed in it
LISTED_BYTES, LISTED_MEMORY = 26.0, 27.0  # of a number that the document lists: in the file, and as a Python object
SURFACE_BYTES = 750.0  # ply and glb of the voxels' surface, by the number of voxels to the power 2/3
WRITTEN_PER_S = 6e7  # bytes of files
DECIDED_PER_S = 2e5  # points decided by inverse kinematics on one core, most of them within reach
SEARCHED_PER_S = 3e3  # targets under constraints, on one core, where many are blocked narrowly
STARTS_S = 1.0  # of the admitted samples that searches of targets start from
LEFT = 1e-3  # share of poses with closed forms that all postures leave open: singular ones, and near a boundary
REFINED_S = 0.7  # of a refined volume with a tolerance of REFINED_TO, a six-joint arm on one core
REFINED_TO = 0.01
REFINED_BYTES = 4e7  # of its points, cells and tries
SEARCHED_S, SEARCHED_BYTES = 5.0, 2e8  # of a free volume under constraints: with samples, of which it takes starts


def pictures_cost(*names: str) -> tuple[float, float]:
    """Bytes and seconds of pictures by their names."""
    return sum(PICTURES[name][0] for name in names), sum(PICTURES[name][1] for name in names)


def surface_bytes(voxels: float) -> float:
    """Bytes of the surface of so many voxels, as ply and glb."""
    return SURFACE_BYTES * voxels ** (2 / 3)


def refined_seconds(tolerance: float | None, searched: bool = False) -> float:
    """Seconds of a refined volume, ``searched`` under constraints or not; 0 of none."""
    each = SEARCHED_S if searched else REFINED_S
    return 0.0 if tolerance is None else each * max(1.0, REFINED_TO / tolerance)


def refined_bytes(tolerance: float | None, searched: bool = False) -> float:
    """Bytes that are held while a volume is refined; 0 of none."""
    return 0.0 if tolerance is None else SEARCHED_BYTES if searched else REFINED_BYTES


def in_turn(costs: Iterable[Cost]) -> Cost:
    """Of parts that run one after the other: memory of the largest, all else of all."""
    costs = list(costs)
    largest = max(costs, key=lambda cost: cost.memory_bytes)
    return Cost(
        sum(cost.samples for cost in costs),
        largest.memory_bytes,
        sum(cost.file_bytes for cost in costs),
        sum(cost.seconds for cost in costs),
        largest.asks,
    )


def fits(needed: float) -> bool:
    """Whether so many bytes of memory can be taken."""
    return needed <= SHARE * available_bytes()


def check_memory(cost: Cost) -> None:
    """Whether the memory of a job can be taken; raises ResourceError, naming the field that asks for most of it."""
    needed, free, asks = cost.memory_bytes, available_bytes(), cost.asks
    if needed <= SHARE * free:
        return
    remedy = asks.remedy
    if asks.voxel_size_m is not None:
        smallest = asks.voxel_size_m * (needed / max(SHARE * free, 1.0)) ** (1 / 3)
        remedy = f"choose {rounded_up(smallest, 2):g} or more"
    numbers = f"{needed / 2**30:.1f} GiB of memory; {free / 2**30:.1f} GiB are free"
    raise ResourceError(asks.field, f"makes a job of {numbers}: {remedy}")
