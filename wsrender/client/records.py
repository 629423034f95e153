"""What a server says, as types: dicts of plain data, whose keys a type checker knows.

They are the views of the server, by the same names; a newer server may say more.
"""

from collections.abc import Mapping
from typing import Literal, NotRequired, Protocol, TypeAlias, TypedDict, cast, get_args

from wsrender.errors import ServerError
from wsrender.version import __version__

JobState = Literal["queued", "running", "canceling", "succeeded", "failed", "canceled", "timed_out", "expired"]
STATES: tuple[JobState, ...] = get_args(JobState)
FINISHED: tuple[JobState, ...] = ("succeeded", "failed", "canceled", "timed_out", "expired")


class TypedJob(Protocol):
    """A job as `wsrender.analyses.jobs.parse_job` makes it of a document."""

    def model_dump(self, *, mode: Literal["json"]) -> dict[str, object]:
        """The document."""
        ...


JobDocument: TypeAlias = Mapping[str, object] | TypedJob


class ProblemField(TypedDict):
    """One bad field of a request."""

    pointer: str
    detail: str


class Problem(TypedDict):
    """What went wrong (RFC 9457)."""

    type: str
    title: str
    status: int
    detail: str
    code: str
    retryable: bool
    errors: NotRequired[list[ProblemField] | None]
    choices: NotRequired[list[str] | None]
    checks: NotRequired[dict[str, str] | None]
    request_id: NotRequired[str | None]


class JobProgress(TypedDict, total=False):
    """How far a job is; empty where the server has not said it."""

    fraction: float
    samples_done: int
    samples_total: int | None
    rate_per_s: float | None
    eta_s: float | None
    message: str


class JobLinks(TypedDict):
    """Where else to look."""

    self: str
    events: str
    result: str
    artifacts: str


class JobWarning(TypedDict):
    """Something that a user should know."""

    code: str
    message: str
    remedy: str
    field: str | None


class JobRecord(TypedDict):
    """A job as the server describes it; times are ISO 8601."""

    id: str
    analysis: str
    robots: list[str]
    state: JobState
    created_at: str
    started_at: str | None
    finished_at: str | None
    labels: dict[str, str]
    priority: int
    attempt: int
    timeout_s: float | None
    progress: JobProgress
    error: Problem | None
    last_event: int
    version: str
    warnings: list[JobWarning]
    links: JobLinks


class JobEvent(TypedDict):
    """Something that happened to a job."""

    id: str
    type: str
    data: dict[str, object]


class Analysis(TypedDict):
    """An analysis of the server, with the JSON Schema of its documents."""

    id: str
    title: str
    description: str
    schema: dict[str, object]


class LibraryRobot(TypedDict):
    """A robot of the server's library; payload [kg], reach [m]."""

    name: str
    joints: int
    description: str
    source: str
    full_name: str | None
    maker: str | None
    payload_kg: float | None
    reach_m: float | None
    closed_form: str | None
    frames: str | None


class Worker(TypedDict):
    """A worker that computes for the server."""

    address: str
    host: str
    target: str | None
    devices: list[str]
    busy: bool


class Estimate(TypedDict):
    """What a job would take: samples, bytes and seconds, of which null is little."""

    valid: bool
    samples: float
    bytes: float | None
    memory_bytes: float | None
    file_bytes: float | None
    seconds: float | None


def job_record(answer: Mapping[str, object], url: str) -> JobRecord:
    """What a server says of a job. Raises ServerError, naming both versions, where it says what no job is here."""
    named = isinstance(answer.get("id"), str)
    if named and answer.get("state") in STATES:
        return cast(JobRecord, answer)
    what = f"a job in the state {answer.get('state')!r}{'' if named else ' without an id'}"
    raise not_understood(url, what, answer.get("version"))


def not_understood(url: str, what: str, version: object = None) -> ServerError:
    """The error of an answer that this version of the client does not know."""
    server = (
        f"wsrender {version}" if isinstance(version, str) else "perhaps another version of wsrender, or no wsrender"
    )
    return ServerError(
        f"{url} ({server}) answers with {what}, which this client (wsrender {__version__}) does not know; "
        "install the version that the server has"
    )
