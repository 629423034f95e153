"""What the store and the engine raise on purpose.

::

    WsrenderError
    └── JobFault
        ├── IdempotencyConflict     the idempotency key was used with another body
        ├── InvalidTransition       the job's state does not allow what was asked
        ├── QueueFull               the owner has as many unfinished jobs as allowed
        ├── QuotaExceeded           the owner's models take as many bytes as allowed, or webhooks are as many
        ├── ResultExpired           the job has succeeded, and its result is no longer kept
        ├── StoreUnavailable        the database is locked, gone or on a full disk; try again
        │   └── CommitUnknown       it was gone before it said whether it took the change
        ├── DiskFull                less disk is free than the server keeps in reserve; try again
        ├── EngineUnavailable       no scheduler or worker answers; try again
        │   └── EngineSlow          the scheduler is there, and takes its time
        └── TargetNotAllowed        this server sends no webhooks there
"""

from wsrender.errors import InputError, WsrenderError


class JobFault(WsrenderError):  # noqa: N818
    """Base of the job server's own errors; ``retryable`` says whether trying again later may help."""

    code = "job_fault"
    retryable = False


class IdempotencyConflict(JobFault):
    """The idempotency key was used before with another body."""

    code = "idempotency_key_reused"


class InvalidTransition(JobFault):
    """The job's state does not allow what was asked; ``state`` is that state."""

    code = "invalid_transition"

    def __init__(self, state: str, action: str, subject: str = "a job"):
        self.state = state
        super().__init__(f"{subject} that is {state} cannot be {action}")


class QueueFull(JobFault):
    """The owner has as many unfinished jobs as allowed."""

    code = "queue_full"
    retryable = True

    def __init__(self, limit: int):
        self.limit = limit
        super().__init__(f"{limit} unfinished jobs are allowed at a time; wait for one to end or cancel one")


class QuotaExceeded(JobFault):
    """The owner's models take as many bytes, or their webhooks are as many, as allowed."""

    code = "quota_exceeded"


class ResultExpired(JobFault):
    """The job has succeeded, and its result is no longer kept; it can be retried."""

    code = "result_expired"


class StoreUnavailable(JobFault):
    """The database is locked, gone or on a full disk; nothing was changed."""

    code = "database_unavailable"
    retryable = True


class CommitUnknown(StoreUnavailable):
    """The database was lost between a commit and its answer: the change was made, or it was not."""


class DiskFull(JobFault):
    """Less disk is free than the server keeps in reserve; nothing was changed."""

    code = "disk_full"
    retryable = True


class EngineUnavailable(JobFault):
    """No scheduler or worker answers."""

    code = "engine_unavailable"
    retryable = True


class EngineSlow(EngineUnavailable):
    """The scheduler is connected, and has not answered in time: nothing is lost."""


class TargetNotAllowed(JobFault, InputError):  # noqa: N818
    """The server sends no webhooks to such a ``url``."""

    code = "target_not_allowed"

    def __init__(self, message: str):
        InputError.__init__(self, "url", message)
