"""The states of a job and of the computation it waits for."""

from enum import StrEnum


class JobState(StrEnum):
    """State of a job, as a client sees it."""

    QUEUED = "queued"
    RUNNING = "running"
    CANCELING = "canceling"
    SUCCEEDED = "succeeded"
    FAILED = "failed"
    CANCELED = "canceled"
    TIMED_OUT = "timed_out"


class ComputationState(StrEnum):
    """State of a computation, which one or more jobs of one owner wait for."""

    WAITING = "waiting"
    RUNNING = "running"
    STOPPING = "stopping"
    SUCCEEDED = "succeeded"
    FAILED = "failed"
    STOPPED = "stopped"


LIVE = (JobState.QUEUED, JobState.RUNNING)  # jobs for which a computation goes on
ENDED = (JobState.SUCCEEDED, JobState.FAILED, JobState.CANCELED, JobState.TIMED_OUT)
RETRYABLE = (JobState.FAILED, JobState.CANCELED, JobState.TIMED_OUT)
UNFINISHED = (ComputationState.WAITING, ComputationState.RUNNING, ComputationState.STOPPING)

NEXT: dict[JobState, tuple[JobState, ...]] = {
    JobState.QUEUED: (
        JobState.RUNNING,
        JobState.CANCELING,
        JobState.SUCCEEDED,
        JobState.FAILED,
        JobState.CANCELED,
    ),
    JobState.RUNNING: (
        JobState.CANCELING,
        JobState.SUCCEEDED,
        JobState.FAILED,
        JobState.CANCELED,
        JobState.TIMED_OUT,
    ),
    JobState.CANCELING: (JobState.CANCELED,),
    JobState.SUCCEEDED: (),
    JobState.FAILED: (JobState.QUEUED, JobState.RUNNING, JobState.SUCCEEDED),
    JobState.CANCELED: (JobState.QUEUED, JobState.RUNNING, JobState.SUCCEEDED),
    JobState.TIMED_OUT: (JobState.QUEUED, JobState.RUNNING, JobState.SUCCEEDED),
}
"""The states that may follow each state; an ended job moves again only by a retry."""
