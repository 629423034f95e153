"""What a job takes: the one account from which its estimate, the limit of its samples and the check of memory come."""

from collections.abc import Iterable
from dataclasses import dataclass

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
        numbers = f"{needed / 2**30:.3g} GiB; {free / 2**30:.1f} GiB are free"
        raise ResourceError(field, f"{of} need {numbers}: {remedy}")
