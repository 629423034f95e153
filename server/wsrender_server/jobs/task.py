"""What travels between dispatcher, workers and their kernel processes. All of it is plain, picklable data."""

from dataclasses import astuple, dataclass
from enum import StrEnum
from typing import Any, Self

from wsrender_server.jobs.documents import CanonicalDocument
from wsrender_server.settings import Settings


class Step(StrEnum):
    """What a task does."""

    PLAN = "plan"
    SHARD = "shard"
    FINISH = "finish"


@dataclass(frozen=True)
class TaskLimits:
    """What a task may take: of a server's settings, or of a worker's."""

    memory_bytes: int
    planning_memory_bytes: int
    planning_s: float
    samples: int

    @classmethod
    def of(cls, settings: Settings) -> Self:
        """The limits that the settings set."""
        planning = settings.max_planning_memory_bytes, settings.max_planning_s
        return cls(settings.max_memory_bytes, *planning, settings.max_samples)

    def within(self, other: "TaskLimits | None") -> "TaskLimits":
        """The smaller of each."""
        return self if other is None else TaskLimits(*map(min, astuple(self), astuple(other)))


@dataclass(frozen=True)
class Task:
    """One step of a computation. ``token`` names its attempt; whoever stops an attempt names it.

    Of a long ``document`` the data folder holds the text, as that of the computation. ``resolved`` is what the plan
    settled (None: plan first); ``seconds`` goes into ``timing_s``; ``limits`` are those of the server, None: a
    worker's own only.
    """

    step: Step
    computation: str
    token: str
    document: CanonicalDocument
    resolved: dict[str, Any] | None = None
    shard: int = 0
    seconds: dict[str, float] | None = None
    limits: TaskLimits | None = None


class Verdict(StrEnum):
    """How a task ended."""

    DONE = "done"
    FAILED = "failed"
    STOPPED = "stopped"
    LOST = "lost"  # through no fault of the job, as far as can be told: worth another try


@dataclass(frozen=True)
class Outcome:
    """End of a task: a value, or an error (code, message, retryable, perhaps field and problems)."""

    verdict: Verdict
    value: Any = None
    error: dict[str, Any] | None = None


def error(code: str, message: str, *, retryable: bool = False, **more: Any) -> dict[str, Any]:
    """An error as jobs keep it."""
    return {"code": code, "message": message, "retryable": retryable, **more}
