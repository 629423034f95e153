"""What a job takes: the one account from which its estimate, the limit of its samples and the check of memory come."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from wsrender.errors import ResourceError
from wsrender.memory import SHARE, available_bytes


@dataclass(frozen=True)
class Cost:
    """Samples, memory, files and time of a job, as planning knows them.

    ``samples``: configurations, points, poses or pairs that the analysis decides, those of refined volumes not among
    them. ``memory_bytes``: the largest arrays that are held at a time. ``file_bytes``: the artifacts' numbers, of
    compressed files before they are compressed. ``seconds``: on idle cores or a GPU, from plan to result.
    """

    samples: float
    memory_bytes: float
    file_bytes: float
    seconds: float

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


# Of pictures as drawn of small jobs of a six-joint arm, measured by benchmarks/cost.py: bytes of each, and one core's
# seconds; the numbers of the histogram are in its.
PICTURE_BYTES = {
    "slices": 8.0e4,
    "scatter": 4.2e5,
    "histogram": 1.3e5,
    "robot": 1.6e5,
    "arm": 1.05e5,  # in one posture
    "posture": 1.6e5,
    "product": 9.0e4,
    "comparison": 1.4e5,
    "targets": 1.1e5,
    "refinements": 5.0e4,
    "other": 1.2e5,
}
PICTURE_S = 0.35
DOCUMENT_BYTES = 1.0e4  # of a result document, without what is listed in it
SURFACE_BYTES = 750.0  # ply and glb of the voxels' surface, by the number of voxels to the power 2/3
DECIDED_PER_S = 2e4  # points decided by inverse kinematics on one core, rounded down from benchmarks/inverse.py
REFINED_S = 1.0  # of a refined volume with a tolerance of REFINED_TO, a six-joint arm on one core
REFINED_TO = 0.01


def pictures_cost(*names: str) -> tuple[float, float]:
    """Bytes and seconds of pictures by their names."""
    return sum(PICTURE_BYTES[name] for name in names), PICTURE_S * len(names)


def surface_bytes(voxels: float) -> float:
    """Bytes of the surface of so many voxels, as ply and glb."""
    return SURFACE_BYTES * voxels ** (2 / 3)


def refined_seconds(tolerance: float | None) -> float:
    """Seconds of a refined volume; 0 of none."""
    return 0.0 if tolerance is None else REFINED_S * max(1.0, REFINED_TO / tolerance)


def in_turn(costs: Iterable[Cost]) -> Cost:
    """Of parts that run one after the other: memory of the largest, all else of all."""
    costs = list(costs)
    return Cost(
        sum(cost.samples for cost in costs),
        max(cost.memory_bytes for cost in costs),
        sum(cost.file_bytes for cost in costs),
        sum(cost.seconds for cost in costs),
    )


def check_memory(needed: float, field: str, of: str, remedy: str) -> None:
    """Whether so many bytes can be taken; raises ResourceError, naming the ``field`` that asks for them.

    ``of``: what needs them, in the plural; ``remedy``: what to do instead.
    """
    free = available_bytes()
    if needed > SHARE * free:
        numbers = f"{needed / 2**30:.1f} GiB; {free / 2**30:.1f} GiB are free"
        raise ResourceError(field, f"{of} need {numbers}: {remedy}")
