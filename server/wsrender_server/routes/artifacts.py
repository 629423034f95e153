"""Results: the document, the files and plots."""

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Depends, Query, Request, Response
from fastapi import Path as PathParameter
from pydantic import ConfigDict, Field
from starlette.concurrency import run_in_threadpool

from wsrender import __version__
from wsrender.documents.format import FORMAT
from wsrender.results.export import formats
from wsrender.results.presentation import all_pictures
from wsrender_server.auth import Reader
from wsrender_server.conversions import draw, files_for_plot
from wsrender_server.hosts import address
from wsrender_server.jobs.faults import ResultExpired
from wsrender_server.jobs.records import ENDED, ArtifactRecord, JobRecord, JobState
from wsrender_server.parts import Parts, Server
from wsrender_server.problems import HttpProblem, problem_responses
from wsrender_server.query import OneOf
from wsrender_server.routes.files import content_response, file_response
from wsrender_server.routes.job_views import JobId, Page, View, WarningView, found

router = APIRouter(prefix="/v1", tags=["results"])

PICTURE = formats.rows("picture", own=True)[0]
BINARY = {"schema": {"type": "string", "format": "binary"}}
ETAG = {"ETag": {"description": "SHA-256 of the content.", "schema": {"type": "string"}}}
_ANY = {"*/*": BINARY, "application/json": {}}
PARTLY: dict[int | str, dict[str, Any]] = {
    206: {"description": "The bytes of the range asked for", "headers": ETAG, "content": {"*/*": BINARY}},
    304: {"description": "The client has it already", "headers": ETAG},
}
"""Answers with a part of something large, and to who has it."""
_FILE_RESPONSES: dict[int | str, dict[str, Any]] = {
    **PARTLY,
    200: {"description": "The file, of its own media type", "headers": ETAG, "content": _ANY},
    206: {"description": "The range asked for", "headers": ETAG, "content": _ANY},
}
_RESULT_RESPONSES: dict[int | str, dict[str, Any]] = {
    **PARTLY,
    200: {"description": "The document", "headers": ETAG},
}
INDEX = Query(max_length=256, description="Name of an index; the first by default.")
STATISTIC = Query(description="Statistic per voxel; the maximum by default, if it was kept.")
AT = Query(allow_inf_nan=False, description="Coordinate of the plane [m]; the plane with most voxels by default.")
_SUFFIX = OneOf(lambda: formats.suffixes(formats.rows("picture")))
Statistic = Literal["count", "maximum", "mean", "minimum"]
RESULT = "result.json"


class ArtifactView(View):
    """A file of a result."""

    name: str
    """Its name in a result folder."""
    media_type: str
    """Its media type."""
    bytes: int
    """Its size."""
    sha256: str
    """SHA-256 of its content, also its entity tag."""
    shape: list[int] | None
    """Shape of what it holds."""
    units: dict[str, str]
    """Units of what it holds, by name."""
    frame: str | None
    """Frame that its coordinates refer to."""
    href: str
    """Where it is."""


class HeadlineView(View):
    """The number that an analysis is about."""

    quantity: Literal["volume", "area", "length"]
    """What is measured."""
    value: float | None
    """The measure; null where there is none."""
    ci95: tuple[float, float] | None
    """Interval that holds it with 95 % confidence."""
    unit: Literal["m3", "m2", "m"]
    """Unit of value and interval."""
    reason: str
    """Why there is none."""


class ResultDocument(View):
    """What an analysis has found; the fields beside these are those of the analysis.

    Of one that this version has computed they are as its schema says, `WorkspaceResult` and so on.
    """

    model_config = ConfigDict(use_attribute_docstrings=True, extra="allow")

    format: int = Field(json_schema_extra={"const": FORMAT})
    """Format of the document; results of earlier versions are answered in this one."""
    analysis: str = Field(examples=["workspace"])
    """Name of the analysis."""
    headline: HeadlineView
    """The number that the analysis is about."""
    warnings: list[WarningView]
    """What should be known of the model and the numbers."""


def _finished(server: Server, principal: Reader, job_id: JobId) -> JobRecord:
    job = found(server.store.get(principal.owner, job_id))
    if job.state == JobState.EXPIRED and job.error is not None:
        raise ResultExpired(job.error["message"])
    if job.state != JobState.SUCCEEDED:
        waiting = job.state not in ENDED
        detail = f"the job is {job.state}; it has no result" + (" yet" if waiting else "")
        raise HttpProblem(409, detail, "no_result", retryable=waiting)
    return job


Finished = Annotated[JobRecord, Depends(_finished)]


@router.get(
    "/jobs/{job_id:id}/result",
    summary="The result document",
    response_model=ResultDocument,
    responses=_RESULT_RESPONSES | problem_responses(401, 403, 404, 409, 416, 422, 429),
)
async def get_result(server: Server, job: Finished, request: Request) -> Response:
    """Values with units, volumes, hashes, versions, timings, warnings, and the list of files; 409 while there is none.

    `headline` is the number that the analysis is about, `warnings` what should be known of it: each has code, message,
    remedy and field; `other_version` says that another version of wsrender has computed it.
    """
    # It may be as long as a job document: it goes out as the file that it is, and nobody here reads it.
    record, path = await run_in_threadpool(artifact_of, server, job, RESULT)
    sha256 = record.sha256
    with not_found_if_gone(RESULT, path):
        if job.version != __version__:
            path, sha256 = await readable(server.converted.renewed(job.owner, path, record, job.version))
        return await run_in_threadpool(file_response, request, path, sha256, "application/json")


@router.get(
    "/jobs/{job_id:id}/artifacts",
    summary="List the files of a result",
    response_model=Page[ArtifactView],
    responses=problem_responses(401, 403, 404, 409, 422),
)
def list_artifacts(server: Server, job: Finished) -> Page[ArtifactView]:
    """All files in one page; 409 while there is no result."""
    records = server.store.artifacts(job.owner, job.id)
    path = address(f"/v1/jobs/{job.id}/artifacts")
    return Page(items=[ArtifactView.of(record, href=f"{path}/{record.name}") for record in records])


@router.get(
    "/jobs/{job_id:id}/artifacts/{name:path}",
    summary="Download a file of a result",
    response_class=Response,
    responses=_FILE_RESPONSES | problem_responses(401, 403, 404, 409, 416, 422, 429),
)
async def get_artifact(
    server: Server,
    job: Finished,
    request: Request,
    name: Annotated[str, PathParameter(description="Name of the file.", examples=["plots/robot.png"])],
    format: Annotated[
        Annotated[str, OneOf(formats.convertible)] | None,
        Query(description="Another format of what the file holds, by its ending."),
    ] = None,
) -> Response:
    """With Range, If-Range and If-None-Match; the entity tag is the SHA-256 of the content. `format` converts."""
    record, path = await run_in_threadpool(artifact_of, server, job, name)
    sha256, media_type, own_name = record.sha256, record.media_type, name
    with not_found_if_gone(name, path):
        if format is not None and not name.endswith(f".{format}"):
            path, sha256 = await server.converted.get(job.owner, path, record, format)
            own_name = f"{name.rpartition('.')[0]}.{format}"
            media_type = formats.media_type(own_name)
        return await run_in_threadpool(file_response, request, path, sha256, media_type, own_name)


router.add_api_route("/jobs/{job_id:id}/artifacts/{name:path}", get_artifact, methods=["HEAD"], include_in_schema=False)


@router.get(
    "/jobs/{job_id:id}/plots/{plot}",
    summary="Draw a plot",
    response_class=Response,
    responses={
        **PARTLY,
        200: {
            "description": "The plot",
            "headers": ETAG,
            "content": {row.media_type: BINARY for row in formats.rows("picture")},
        },
        **problem_responses(401, 403, 404, 409, 416, 422, 429),
    },
)
async def get_plot(
    server: Server,
    job: Finished,
    request: Request,
    plot: Annotated[str, OneOf(lambda: list(all_pictures()))],
    format: Annotated[str, _SUFFIX, Query(description="Format of the picture.")] = PICTURE.suffix,
    index: Annotated[str | None, INDEX] = None,
    statistic: Annotated[Statistic | None, STATISTIC] = None,
    axis: Annotated[Literal["x", "y", "z"] | None, Query(description="Normal of the plane of `slice`.")] = None,
    at: Annotated[float | None, AT] = None,
) -> Response:
    """Any picture that results have: the arm in its workspace, sampled positions, planes of voxels, and so on.

    404 where the result has no data for it. Its pictures are among its files too, as `plots/<name>.png`.
    """
    options = {"axis": axis, axis or "z": at, "index": index, "statistic": statistic}
    return await drawn(request, server, job, plot, formats.by_ending("picture", f"{plot}.{format}"), options)


async def drawn(
    request: Request,
    server: Parts,
    job: JobRecord,
    plot: str,
    format: formats.Format,
    options: dict[str, Any],
    instead: Mapping[str, str] = MappingProxyType({}),
    headers: Mapping[str, str] = MappingProxyType({}),
) -> Response:
    """A picture of the result's files, or of those ``instead`` of them, with more ``headers``."""
    records, result = await run_in_threadpool(_listed, server, job)
    with not_found_if_gone(RESULT, Path(result)):
        wanted = await readable(server.side_process.run(files_for_plot, result, plot, records, owner=job.owner))
    files = {**await run_in_threadpool(files_of, server, job, wanted), **instead}
    with not_found_if_gone(", ".join(files), *map(Path, (result, *files.values()))):
        content = await or_404(server.side_process.run(draw, result, files, plot, format, options, owner=job.owner))
    return content_response(request, content, format.media_type, headers)


def _listed(server: Parts, job: JobRecord) -> tuple[list[str], str]:
    """Names of the files of a result, and where its document is."""
    names = [record.name for record in server.store.artifacts(job.owner, job.id)]
    return names, files_of(server, job, [RESULT])[RESULT]


def files_of(server: Parts, job: JobRecord, names: Iterable[str]) -> dict[str, str]:
    """Files of a result by name. Raises HttpProblem 404 where one is gone."""
    paths = {name: server.store.artifact_path(job.owner, job.id, name) for name in names}
    for name, path in paths.items():
        if path is None:
            raise _gone(name)
    return {name: str(path) for name, path in paths.items()}


async def or_404(answer: Any, status: int = 404) -> Any:
    """What was awaited of a request's parameters; a picture or plane of what the result does not hold is not found."""
    try:
        return await answer
    except HttpProblem as error:
        if error.code == "invalid_input":
            error.status = status
        error.errors = [(pointer.removeprefix("#/"), detail) for pointer, detail in error.errors]  # there is no body
        raise


async def readable(answer: Any) -> Any:
    """What was awaited; a document in a form that this version does not read is answered with 422."""
    return await or_404(answer, 422)


def artifact_of(server: Parts, job: JobRecord, name: str) -> tuple[ArtifactRecord, Path]:
    """A file of a result. Raises HttpProblem 404 where it has none of that name."""
    record = next((record for record in server.store.artifacts(job.owner, job.id) if record.name == name), None)
    path = None if record is None else server.store.artifact_path(job.owner, job.id, name)
    if record is None or path is None:
        raise _gone(name)
    return record, path


def data_of(server: Parts, job: JobRecord, kind: str, name: str) -> tuple[ArtifactRecord, Path]:
    """The file of a table or volume of a result, by its name and the kind of thing, the parameter that it stands in.

    Raises HttpProblem 404 where it has none, with the names of those that it has.
    """
    ending = formats.kept(kind).file("")
    records = {record.name.removesuffix(ending): record for record in server.store.artifacts(job.owner, job.id)
               if record.name.endswith(ending) and "/" not in record.name}  # fmt: skip
    path = server.store.artifact_path(job.owner, job.id, f"{name}{ending}") if name in records else None
    if path is None:
        detail = f"the result has no {kind} {name[:256]!r}; it has {', '.join(records) or 'none'}"
        choices = {"choices": list(records)} if records else {}
        raise HttpProblem(404, detail, "artifact_not_found", errors=[(kind, detail)], extra=choices)
    return records[name], path


@contextmanager
def not_found_if_gone(name: str, *paths: Path) -> Iterator[None]:
    """Whatever goes wrong with files that were there a moment ago, and are not: they went with their job."""
    try:
        yield
    except (OSError, HttpProblem):
        if all(path.exists() for path in paths):
            raise
        raise _gone(name) from None


def _gone(name: str) -> HttpProblem:
    return HttpProblem(404, f"the result has no file {name!r}", "artifact_not_found")
