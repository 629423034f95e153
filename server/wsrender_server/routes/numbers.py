"""Numbers of results as text and for other programs: planes of voxels, volumes, tables, histograms."""

from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar

from fastapi import APIRouter, Header, Query, Request, Response
from fastapi import Path as PathParameter
from pydantic import Field
from starlette.concurrency import run_in_threadpool

from wsrender.results.export import formats
from wsrender.results.export.artifacts import part_file
from wsrender.results.presentation import PLANE
from wsrender_server.extracts import MOST_VALUES, TextFormat, histogram_content, slice_content, table_content
from wsrender_server.jobs.records import ArtifactRecord, JobRecord
from wsrender_server.parts import Parts, Server
from wsrender_server.problems import HttpProblem, problem_responses
from wsrender_server.query import OneOf
from wsrender_server.routes.artifacts import (
    AT,
    BINARY,
    ETAG,
    INDEX,
    PARTLY,
    PICTURE,
    STATISTIC,
    Finished,
    Statistic,
    data_of,
    drawn,
    not_found_if_gone,
    or_404,
)
from wsrender_server.routes.files import content_response, file_response
from wsrender_server.routes.job_views import View

router = APIRouter(prefix="/v1", tags=["results"])

# What a plane of voxels comes as; the first is what is sent where a request says nothing.
SLICES = {
    "npy": "application/x-npy",
    "raw": "application/octet-stream",
    "png": PICTURE.media_type,
    "json": "application/json",
    "csv": "text/csv",
}
TEXTS: dict[TextFormat, str] = {"json": "application/json", "csv": "text/csv"}
BY_ACCEPT = {"Vary": "Accept"}  # for caches on the way
LARGEST_PLACE = 2**53  # of a row: what JSON's readers count to
_FORMAT = Query(description="JSON, or CSV with a line of names first.")
_VOLUME = Query(max_length=256, description="Which volume, where the result has several: name of its file.")
_VOLUME_FORMAT = OneOf(lambda: formats.suffixes(formats.rows("volume")))
_KEPT = formats.kept("volume").suffix


T = TypeVar("T")
# Of a plane; the schema of a tuple (prefixItems) is misread by schemathesis 4.32 in answers of many types.
Pair = Annotated[list[T], Field(min_length=2, max_length=2)]


class SliceView(View):
    """A plane of voxels."""

    name: str
    """Name of the array, such as `maximum_manipulability`, or `count`."""
    unit: str
    """Its unit."""
    axis: Literal["x", "y", "z"]
    """Normal of the plane."""
    at_m: float
    """Where its voxels' centres are along that axis [m]."""
    axes: Pair[Literal["x", "y", "z"]]
    """The axes that the values run over."""
    origin_m: Pair[float]
    """Lower corner of the first voxel along these axes [m]."""
    voxel_size_m: float
    """Edge of a voxel [m]."""
    shape: Pair[int]
    """Voxels along each of these axes."""
    values: list[list[float | None]]
    """`values[i][j]`: what the voxel i along the first axis, j along the second holds; null where it is empty."""


class ColumnView(View):
    """A column of a table."""

    name: str
    """Its name; of k numbers in each row there are k columns, `position_0`, `position_1` …"""
    unit: str
    """Its unit; "1": none."""
    values: list[float | bool | str | None]
    """A value for each row; null where a number is not finite."""


class TableView(View):
    """Rows of a table."""

    name: str
    """Its name."""
    rows: int
    """Rows that the whole table has."""
    offset: int
    """Number of the first row here, counted from 0."""
    columns: list[ColumnView]
    """Its columns, in the order of the file, or as asked for."""


class HistogramView(View):
    """How the values of an index are spread over the samples."""

    index: str
    """Name of the index."""
    unit: str
    """Its unit."""
    samples: int
    """Samples that have a finite value; others, such as those with NaN, are not counted."""
    mean: float
    """Mean of the values."""
    below: float
    """Share of them below the first edge."""
    above: float
    """Share of them above the last edge."""
    edges: list[float]
    """Where intervals begin and end: one more than there are intervals."""
    share: list[float]
    """Share of the samples in each interval."""


def _responses(description: str, *types: str) -> dict[int | str, dict[str, Any]]:
    """Those of a route that answers with one of these types, whole or in part."""
    content = {kind: {} if kind == "application/json" else BINARY for kind in types}
    return {
        **PARTLY,
        200: {"description": description, "headers": ETAG, "content": content},
        **problem_responses(401, 403, 404, 409, 416, 422, 429),
    }


@router.get(
    "/jobs/{job_id:id}/volume",
    summary="A volume in any format",
    response_class=Response,
    responses=_responses("The file", *(row.media_type for row in formats.rows("volume", own=True))),
)
async def get_volume(
    server: Server,
    job: Finished,
    request: Request,
    format: Annotated[str, _VOLUME_FORMAT, Query(description="Format of the file, by its ending.")] = _KEPT,
    volume: Annotated[str, _VOLUME] = "volume",
) -> Response:
    """All voxels; the order of their axes is that of the format.

    `npz` (NumPy) and `mat` (MATLAB): arrays are indexed x, y, z, as `count(i, j, k)`, vectors x, y, z, component; `mat`
    has `origin_m`, the lower corner of the first voxel, and `voxel_size_m`, `npz` both in the JSON text `wsrender`.
    `vtkhdf` (HDF5, as it is kept) and `vti` (VTK): x is fastest, so arrays that h5py reads are indexed z, y, x.
    `csv` and `parquet`: a row for each occupied voxel, z fastest, with its lattice index `i`, `j`, `k` and its centre
    `x`, `y`, `z` [m] in the world frame. The voxel i, j, k of the lattice has its centre at (i + 0.5) `voxel_size_m`
    along x, and so on. Files of other formats than the kept one are made when they are first asked for.
    """
    record, path = await run_in_threadpool(data_of, server, job, "volume", volume)
    sha256, media_type = record.sha256, record.media_type
    with not_found_if_gone(record.name, path):
        if format != _KEPT:
            path, sha256 = await server.converted.get(job.owner, path, record, format)
            media_type = formats.by_ending("volume", f"{volume}.{format}").media_type
        return await run_in_threadpool(file_response, request, path, sha256, media_type, f"{volume}.{format}")


@router.get(
    "/jobs/{job_id:id}/volume/slice",
    summary="A plane of voxels",
    response_model=SliceView,
    responses=_responses("The plane", *SLICES.values()),
)
async def get_slice(
    server: Server,
    job: Finished,
    request: Request,
    axis: Annotated[Literal["x", "y", "z"], Query(description="Normal of the plane.")] = "z",
    at: Annotated[float | None, AT] = None,
    index: Annotated[str | None, INDEX] = None,
    statistic: Annotated[Statistic | None, STATISTIC] = None,
    volume: Annotated[str, _VOLUME] = "volume",
    format: Annotated[
        Literal["npy", "raw", "png", "json", "csv"] | None,
        Query(description="What it comes as; by default what the header Accept likes best, or npy."),
    ] = None,
    accept: Annotated[str, Header(include_in_schema=False)] = "*/*",
) -> Response:
    """As npy, raw (float32, little-endian), png, json or csv, by `format` or by the header Accept.

    The array runs over the two other axes in the order x, y, z, NaN (in JSON null) where empty. Headers X-Shape,
    X-Origin-M (lower corner of its first voxel), X-Voxel-Size-M, X-At-M (centre of the plane) and X-Array say where it
    is. As CSV each occupied voxel is a row: its centre `x`, `y`, `z` [m], and the value. 404 where the volume does not
    hold what was asked for, 409 for text of very large planes.
    """
    kind = format or _best(accept)
    record, path = await run_in_threadpool(data_of, server, job, "volume", volume)
    if kind == PICTURE.suffix:
        options = {"axis": axis, axis: at, "index": index, "statistic": statistic}
        return await drawn(request, server, job, PLANE, PICTURE, options, {part_file("volume"): str(path)}, BY_ACCEPT)
    with not_found_if_gone(record.name, path):
        making = server.side_process.run(slice_content, str(path), axis, at, index, statistic, kind, owner=job.owner)
        content, headers = await or_404(making)
    return content_response(request, content, SLICES[kind], {**headers, **BY_ACCEPT})


@router.get(
    "/jobs/{job_id:id}/tables/{table}",
    summary="Rows of a table",
    response_model=TableView,
    responses=_responses("The rows", *TEXTS.values()),
)
async def get_table(
    server: Server,
    job: Finished,
    request: Request,
    table: Annotated[
        str, PathParameter(max_length=256, description="Name of its file, without .parquet.", examples=["targets"])
    ],
    columns: Annotated[
        str | None,
        Query(max_length=4096, description="Names with commas between them, as a line of CSV; all by default."),
    ] = None,
    offset: Annotated[int, Query(ge=0, le=LARGEST_PLACE, description="The first row, counted from 0.")] = 0,
    limit: Annotated[
        int | None, Query(ge=1, le=MOST_VALUES, description="Rows at most; all that follow by default.")
    ] = None,
    format: Annotated[TextFormat, _FORMAT] = "json",
) -> Response:
    """A table of the result, such as `targets` of a reachability; its `sample`, or the `map`, where that was kept.

    A million values come at a time: 409 where there are more, never fewer rows than were asked for. Whole tables are
    files: `/artifacts/map.parquet?format=csv`.
    """
    record, path = await run_in_threadpool(data_of, server, job, "table", table)
    with not_found_if_gone(record.name, path):
        making = server.side_process.run(
            table_content, str(path), table, columns, offset, limit, format, owner=job.owner
        )
        content = await or_404(making)
    return content_response(request, content, TEXTS[format])


@router.get(
    "/jobs/{job_id:id}/histogram",
    summary="How an index is distributed",
    response_model=HistogramView,
    responses=_responses("The histogram", *TEXTS.values()),
)
async def get_histogram(
    server: Server,
    job: Finished,
    request: Request,
    index: Annotated[str | None, INDEX] = None,
    bins: Annotated[int | None, Query(ge=1, le=10_000, description="Intervals; by default as many as drawn.")] = None,
    lower: Annotated[
        float | None, Query(allow_inf_nan=False, description="The first edge; the least value by default.")
    ] = None,
    upper: Annotated[
        float | None, Query(allow_inf_nan=False, description="The last edge; the largest value by default.")
    ] = None,
    format: Annotated[TextFormat, _FORMAT] = "json",
) -> Response:
    """Share of the samples in each interval of an index: the numbers of the picture `histogram`.

    It is that of the kept sample, or of the whole map where there is none. Values that are the same but for rounding
    are one interval.
    """
    record, path = await run_in_threadpool(_samples_of, server, job)
    with not_found_if_gone(record.name, path):
        making = server.side_process.run(
            histogram_content, str(path), index, bins, lower, upper, format, owner=job.owner
        )
        content = await or_404(making)
    return content_response(request, content, TEXTS[format])


def _samples_of(server: Parts, job: JobRecord) -> tuple[ArtifactRecord, Path]:
    """The file of the samples that pictures show. Raises HttpProblem 404 where the result keeps none."""
    names = [record.name for record in server.store.artifacts(job.owner, job.id)]
    return data_of(server, job, "table", "sample" if part_file("sample") in names else "map")


def _best(accept: str) -> str:
    """What an Accept header likes best of `SLICES`, the first of equals; HttpProblem 406 where it likes none."""
    weights: dict[str, float] = {}
    for part in accept.split(","):
        name, *parameters = (word.strip() for word in part.lower().split(";"))
        quality = next((word[2:] for word in parameters if word.startswith("q=")), "1")
        weights[name] = float(quality) if quality.replace(".", "", 1).isdecimal() else 0.0
    wildcard = weights.get("*/*", 0.0)
    liked = {
        kind: weights.get(media_type, weights.get(media_type.partition("/")[0] + "/*", wildcard))
        for kind, media_type in SLICES.items()
    }
    best = max(SLICES, key=lambda kind: liked[kind])
    if liked[best] <= 0:
        raise HttpProblem(406, f"comes as {', '.join(SLICES.values())}; the request accepts {accept[:200]}")
    return best
