"""Views of results and robots for a page: a manifest, blobs by name; the exact values of a voxel."""

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Query, Request, Response
from fastapi import Path as PathParameter
from starlette.concurrency import run_in_threadpool

from wsrender.errors import ModelError
from wsrender.results.view.blobs import Encoding
from wsrender.robots import library
from wsrender_server.auth import Reader, Submitter
from wsrender_server.extracts import voxel_values
from wsrender_server.job_body import job_body
from wsrender_server.parts import Parts, Server
from wsrender_server.problems import HttpProblem, problem_responses
from wsrender_server.routes.artifacts import (
    RESULT,
    Finished,
    artifact_of,
    data_of,
    files_of,
    not_found_if_gone,
    or_404,
)
from wsrender_server.routes.files import file_response
from wsrender_server.routes.job_views import View
from wsrender_server.views import Shown, data_files

router = APIRouter(prefix="/v1", tags=["views"])

OCTETS, GLB, JSON = "application/octet-stream", "model/gltf-binary", "application/json"
_BINARY = {"schema": {"type": "string", "format": "binary"}}
_ETAG = {"ETag": {"description": "Of the content.", "schema": {"type": "string"}}}
_UNCHANGED = {304: {"description": "The client has it already", "headers": _ETAG}}
_MANIFEST_RESPONSES: dict[int | str, dict[str, Any]] = {
    200: {
        "description": "The manifest",
        "headers": _ETAG,
        "content": {JSON: {"schema": {"$ref": "#/components/schemas/Manifest"}}},
    },
    **_UNCHANGED,
}
_BLOB_RESPONSES: dict[int | str, dict[str, Any]] = {
    200: {"description": "The blob", "headers": _ETAG, "content": {OCTETS: _BINARY, GLB: _BINARY}},
    206: {"description": "The range asked for", "headers": _ETAG, "content": {OCTETS: _BINARY, GLB: _BINARY}},
    **_UNCHANGED,
}
_EDITED = {
    "requestBody": {
        "required": True,
        "content": {
            JSON: {
                "schema": {"$ref": "#/components/schemas/Edited"},
                "example": {"robot": {"library": "scara"}, "environment": {"items": [{"shape": "half_space"}]}},
            }
        },
    }
}
Channels = Annotated[
    Encoding,
    Query(description="What channels are named in: halves, bytes of 255 steps, or the numbers in single precision."),
]
BLOB_NAME = "^[a-z0-9][a-z0-9._]{0,99}$"
Blob = Annotated[
    str, PathParameter(pattern=BLOB_NAME, description="Name of a blob.", examples=["volume0.channel0.float16"])
]
RobotBlob = Annotated[
    str, PathParameter(pattern=BLOB_NAME, description="Name of a blob.", examples=["robot0.link0.glb"])
]
RobotName = Annotated[str, PathParameter(description="Name of a library robot.", examples=["ur5e"])]


class VoxelValue(View):
    """What a voxel holds of an index."""

    name: str
    """Name of the index, or of a vector."""
    statistic: str
    """Statistic of the samples in the voxel; of a vector its mean's component x, y or z."""
    unit: str
    """Its unit."""
    value: float | None
    """The number of the file; null: there is none."""


class VoxelView(View):
    """A voxel of a volume."""

    cell: tuple[int, int, int]
    """Its place in the file's arrays, counted from 0."""
    center_m: tuple[float, float, float]
    """Its centre in the world [m]."""
    count: int
    """Samples in it."""
    values: list[VoxelValue]
    """What it holds."""


@router.get(
    "/jobs/{job_id:id}/view",
    summary="What the view of a result is made of",
    response_class=Response,
    responses=_MANIFEST_RESPONSES | problem_responses(401, 403, 404, 409, 416, 422, 429),
)
async def get_view(server: Server, job: Finished, request: Request, channels: Channels = "float16") -> Response:
    """A manifest as JSON: robots, volumes, surfaces, points, maps, plots, and of bulk data the names of blobs.

    Volumes have occupancy and a channel for each statistic of an index; large ones come in larger voxels too, to be
    shown first, and very large ones in no others, which is said. `omitted` tells what is not shown, and why.
    """
    shown = await run_in_threadpool(_of_job, server, job)

    async def made() -> Path:
        return await server.views.manifest(job.owner, shown, channels)

    return await _answer(request, made, shown, f"manifest.{channels}", JSON)


@router.get(
    "/jobs/{job_id:id}/view/blobs/{blob}",
    summary="Bulk data of a result's view",
    response_class=Response,
    responses=_BLOB_RESPONSES | problem_responses(401, 403, 404, 409, 416, 422, 429),
)
async def get_view_blob(server: Server, job: Finished, request: Request, blob: Blob) -> Response:
    """Numbers, little-endian, of the type that the manifest says, or a GLB file.

    Channels are there in every encoding: `float16`, `uint8` and `float32` may stand for each other at the end of their
    names.
    """
    shown = await run_in_threadpool(_of_job, server, job)
    return await _blob(server, job.owner, request, shown, blob)


@router.get(
    "/jobs/{job_id:id}/volume/voxel",
    summary="The exact values of a voxel",
    response_model=VoxelView,
    responses=problem_responses(401, 403, 404, 409, 422, 429),
)
async def get_voxel(
    server: Server,
    job: Finished,
    x: Annotated[float, Query(allow_inf_nan=False, description="Coordinate of a point in it [m].", examples=[0.3])],
    y: Annotated[float, Query(allow_inf_nan=False, description="Coordinate of a point in it [m].", examples=[0.1])],
    z: Annotated[float, Query(allow_inf_nan=False, description="Coordinate of a point in it [m].", examples=[0.2])],
    volume: Annotated[str, Query(max_length=256, description="Which volume: name of its file.")] = "volume",
) -> VoxelView:
    """What the voxel that holds a point holds, as the file has it; 404 for a point outside the volume."""
    record, path = await run_in_threadpool(data_of, server, job, "volume", volume)
    with not_found_if_gone(record.name, path):
        return VoxelView.model_validate(
            await or_404(server.side_process.run(voxel_values, str(path), (x, y, z), owner=job.owner))
        )


@router.get(
    "/robots/{robot}/view",
    summary="What the view of a library robot is made of",
    response_class=Response,
    responses=_MANIFEST_RESPONSES | problem_responses(401, 403, 404, 409, 416, 422, 429),
)
async def get_robot_view(server: Server, principal: Reader, request: Request, robot: RobotName) -> Response:
    """A manifest with the robot alone: its chain, from which its pose follows, and a GLB file for each link."""
    shown = _of_library(robot)

    async def made() -> Path:
        return await server.views.manifest(principal.owner, shown, "float16")

    return await _answer(request, made, shown, "manifest.float16", JSON)


@router.get(
    "/robots/{robot}/view/blobs/{blob}",
    summary="The bodies of a link of a library robot",
    response_class=Response,
    responses=_BLOB_RESPONSES | problem_responses(401, 403, 404, 409, 416, 422, 429),
)
async def get_robot_blob(
    server: Server, principal: Reader, request: Request, robot: RobotName, blob: RobotBlob
) -> Response:
    """A GLB file, its coordinates those of the frame that the manifest names for the link."""
    return await _blob(server, principal.owner, request, _of_library(robot), blob)


@router.post(
    "/robots:view",
    summary="The view of a robot or an environment that is edited",
    response_class=Response,
    responses={
        200: {"description": "The view as one message", "content": {OCTETS: _BINARY}},
        **problem_responses(401, 403, 404, 408, 409, 413, 415, 422, 429),
    },
    openapi_extra=_EDITED,
)
async def view_edited(server: Server, principal: Submitter, text: Annotated[bytes, Depends(job_body)]) -> Response:
    """A robot, as job documents have it, with `base` and `tip`, and an `environment`; each may be absent.

    The answer is one message: a little-endian uint32, the length of a header; the header, JSON with `manifest` and
    `blobs` (names and sizes in bytes), padded by spaces to a multiple of 4; then the blobs, one after the other.
    """
    await server.admissions.check_edited(principal.owner, text)
    return Response(await server.views.preview(principal.owner, text), media_type=OCTETS)


async def _blob(server: Parts, owner: str, request: Request, shown: Shown, blob: str) -> Response:
    async def made() -> Path:
        return await server.views.blob(owner, shown, blob)

    return await _answer(request, made, shown, blob, GLB if blob.endswith(".glb") else OCTETS)


async def _answer(request: Request, made: Callable[[], Any], shown: Shown, name: str, media_type: str) -> Response:
    """A file of a view, which is made once more where it was removed before it was opened."""
    for last in (False, True):
        path = await or_404(made())
        try:
            return await run_in_threadpool(file_response, request, path, f"{shown.key[:32]}-{name}", media_type, name)
        except FileNotFoundError:
            if last:
                raise
    raise AssertionError


def _of_job(server: Parts, job: Any) -> Shown:
    """The files of a finished job. Raises HttpProblem 404 where they are gone."""
    names = [record.name for record in server.store.artifacts(job.owner, job.id)]
    record, path = artifact_of(server, job, RESULT)
    return Shown(result=str(path), sha256=record.sha256, files=files_of(server, job, data_files(names)))


def _of_library(robot: str) -> Shown:
    try:
        library.find(robot)
    except ModelError as error:
        raise HttpProblem(404, error.message, "robot_not_found") from None
    return Shown(robot=robot)
