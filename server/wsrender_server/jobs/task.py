"""What travels between dispatcher, workers and their kernel processes. All of it is plain, picklable data."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Any


class Step(StrEnum):
    """What a task does."""

    PLAN = "plan"
    SHARD = "shard"
    FINISH = "finish"


@dataclass(frozen=True)
class Task:
    """One step of a computation. ``token`` names its attempt; whoever stops an attempt names it.

    ``resolved`` is what the plan settled (None: plan first); ``seconds`` goes into ``timing_s``.
    """

    step: Step
    computation: str
    token: str
    document: dict[str, Any]
    resolved: dict[str, Any] | None = None
    shard: int = 0
    seconds: dict[str, float] | None = None


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
