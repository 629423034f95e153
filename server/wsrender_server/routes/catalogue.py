"""What can be asked for: analyses with their JSON Schema, library robots; models uploaded by users."""

import codecs
from datetime import datetime
from functools import cache
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Path, Request, Response
from pydantic import Field

from wsrender.analyses.jobs import job_schema
from wsrender.analyses.registry import job_classes
from wsrender.documents.array_files import TABLE_TYPES
from wsrender.documents.shapes import MEDIA_TYPES
from wsrender.robots import archives, library
from wsrender_server.admission import check_archive, check_model, decoded_model
from wsrender_server.auth import Reader, Submitter
from wsrender_server.hosts import address
from wsrender_server.job_body import held_body
from wsrender_server.parts import Server
from wsrender_server.problems import HttpProblem, problem_responses
from wsrender_server.query import Identifier
from wsrender_server.routes.artifacts import BINARY, ETAG, PARTLY
from wsrender_server.routes.files import content_response, file_response
from wsrender_server.routes.job_views import Page, View

XML_TYPES = ("application/xml", "text/xml")
ZIP_TYPE = "application/zip"
MOST_NAMED, LONGEST_NAME = 100, 500  # of files that are missing
FILE_TYPES = tuple(dict.fromkeys([*MEDIA_TYPES.values(), *TABLE_TYPES.values(), ZIP_TYPE]))
ANY_TYPE = "application/octet-stream"  # what it is stands in its first bytes
LOOKED_AT = 1024  # bytes
EXAMPLE_MODELS = {
    "mjcf": {
        "summary": "A model as MJCF",
        "value": '<mujoco><worldbody><body><joint name="hinge" axis="0 0 1" range="-90 90"/><geom size="0.1"/>'
        '<site name="tool" pos="0.5 0 0"/></body></worldbody></mujoco>',
    },
    "urdf": {
        "summary": "A model as URDF",
        "value": '<robot name="hinge"><link name="base"/><link name="arm"/><link name="tool"/>'
        '<joint name="hinge" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>'
        '<limit lower="-1.5" upper="1.5" effort="10" velocity="1"/></joint>'
        '<joint name="flange" type="fixed"><parent link="arm"/><child link="tool"/><origin xyz="0.5 0 0"/></joint>'
        "</robot>",
    },
    "points": {"summary": "A table of points as CSV", "value": "x,y,z\n0.4,0.2,0.3\n0.5,0.0,0.2\n"},
}

router = APIRouter(prefix="/v1")


class AnalysisView(View):
    """An analysis."""

    id: str
    """Its name, the field `analysis` of its documents."""
    title: str
    """Its name in words."""
    description: str
    """What it does."""
    schema_: dict[str, Any] = Field(alias="schema")
    """JSON Schema of its documents."""


class RobotView(View):
    """A robot of the library."""

    name: str
    """Its name, for `{"library": name}`."""
    joints: int
    """Number of joints."""
    description: str
    """What it is."""
    source: str
    """Where its numbers come from."""
    full_name: str | None
    """Its maker's name for it."""
    maker: str | None
    """Who makes it; null for an arm of a paper."""
    payload_kg: float | None
    """What its maker rates it for [kg]; null where that is not published."""
    reach_m: float | None
    """Its reach [m], as its maker measures it."""
    closed_form: str | None
    """The class of arms by whose closed form its inverse kinematics are solved; null: of none."""
    frames: str | None
    """Which frames of its maker, or of ROS, "world" and "tool" are."""


class ModelView(View):
    """An uploaded model."""

    sha256: str
    """SHA-256 of its text, for `{"model": sha256}`."""
    bytes: int
    """Its size."""
    href: str
    """Where it is."""


class UploadedModelView(ModelView):
    """What was uploaded."""

    missing_files: list[str]
    """Meshes and other files that its text names and that are not in it, the first 100: upload the folder as a ZIP."""


class KeptModelView(ModelView):
    """A model that is kept."""

    created_at: datetime
    """When it was uploaded."""


@router.get(
    "/analyses",
    tags=["catalogue"],
    summary="List the analyses",
    response_model=Page[AnalysisView],
    responses={
        200: {"description": "The analyses", "headers": ETAG},
        304: PARTLY[304],
        **problem_responses(401, 403, 416),
    },
)
def list_analyses(principal: Reader, request: Request) -> Response:
    """Every analysis, with the JSON Schema of its documents; all in one page."""
    page = Page[AnalysisView](items=[_analysis(name) for name in job_classes()])
    return content_response(request, page.model_dump_json(by_alias=True).encode(), "application/json")


@router.get(
    "/analyses/{analysis}",
    tags=["catalogue"],
    summary="Look at an analysis",
    response_model=AnalysisView,
    responses=problem_responses(401, 403, 404, 422),
)
def get_analysis(
    principal: Reader, analysis: Annotated[str, Path(description="Its name.", examples=["workspace"])]
) -> AnalysisView:
    """One analysis, with the JSON Schema of its documents."""
    if analysis not in job_classes():
        raise HttpProblem(404, f"there is no analysis {analysis!r}; there are: {', '.join(job_classes())}")
    return _analysis(analysis)


@router.get(
    "/robots",
    tags=["catalogue"],
    summary="List the library robots",
    response_model=Page[RobotView],
    responses=problem_responses(401, 403),
)
def list_robots(principal: Reader) -> Page[RobotView]:
    """The robots that jobs can name; all in one page."""
    return Page(items=[RobotView.of(robot) for robot in library.describe()])


async def _uploaded_body(request: Request) -> tuple[str, bytes]:
    media_type = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if media_type not in (ANY_TYPE, *XML_TYPES, *FILE_TYPES):
        allowed = ", ".join((ANY_TYPE, "application/xml", *FILE_TYPES))
        raise HttpProblem(415, f"the body must be {allowed}, not {media_type or 'of no type'}")
    body = await held_body(request, request.app.state.parts.uploads)
    return _type_of(body) if media_type == ANY_TYPE else media_type, body


def _type_of(body: bytes) -> str:
    """What a file that no header describes is, by its first bytes; of meshes and tables the jobs that name them see."""
    if archives.is_archive(body):
        return ZIP_TYPE
    start = body[:LOOKED_AT].lstrip(codecs.BOM_UTF8).lstrip()
    return XML_TYPES[0] if start.startswith((b"<", codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)) else ANY_TYPE


# As a client knows it that is made from the description; that one type is enough, and can be meant by each file.
_MODEL_BODY = {
    "requestBody": {
        "required": True,
        "content": {ANY_TYPE: {"examples": EXAMPLE_MODELS}},
    }
}


@router.post(
    "/models", tags=["models"], summary="Upload a model, a mesh or a table", status_code=201,
    response_model=UploadedModelView,
    responses={
        201: {
            "headers": {"Location": {"description": "The model.", "schema": {"type": "string"}}},
            "links": {"model": {"operationId": "get_model", "parameters": {"sha256": "$response.body#/sha256"}}},
        },
        **problem_responses(401, 403, 408, 409, 413, 415, 422, 429),
    },
    openapi_extra=_MODEL_BODY,
)  # fmt: skip
def upload_model(
    server: Server,
    principal: Submitter,
    response: Response,
    body: Annotated[tuple[str, bytes], Depends(_uploaded_body)],
) -> UploadedModelView:
    """MJCF or URDF text, root element `<mujoco>` or `<robot>`, without document types, entities or outside files.

    Or a ZIP of such a model with the files that it includes and its meshes: plain files of relative names, each once,
    stored or deflated, no links, at most 5000 files and 512 MiB unpacked; `entry` beside `model` names the model in it
    where several could be meant. Or an STL, OBJ or PLY mesh, for `{"shape": "mesh", "model": sha256}`, heights in an
    NPY file, for a `height_field`, or a table, CSV, Parquet or NPY: of targets, for `"targets": {"model": sha256}`, of
    joint values, for `"configurations": {"model": sha256}`, or of points, for `"left": {"model": sha256}`. Each is read
    by the jobs that name it; meshes of a model travel in a ZIP alone.

    No upload is larger than the server's setting `WSRENDER_MAX_UPLOAD_BYTES`, 64 MiB where it is not set.

    A header Content-Type of one of these says which it is: application/xml, application/zip, model/stl, model/obj,
    model/ply, application/x-npy, text/csv or application/vnd.apache.parquet. As application/octet-stream the first
    bytes say it.
    """
    media_type, text = body
    missing: list[str] = []
    if media_type in XML_TYPES:
        named = archives.files_named(check_model("document", decoded_model(text)))
        missing = [name[:LONGEST_NAME] for name in named[:MOST_NAMED]]
    elif media_type == ZIP_TYPE:
        check_archive("document", text)
    elif not text:
        raise HttpProblem(409, "the file is empty", "invalid_model")
    sha256 = server.store.put_model(principal.owner, text)
    response.headers["Location"] = href = address(f"/v1/models/{sha256}")
    return UploadedModelView(sha256=sha256, bytes=len(text), href=href, missing_files=missing)


@router.get(
    "/models", tags=["models"], summary="List your models", response_model=Page[KeptModelView],
    responses=problem_responses(401, 403),
)  # fmt: skip
def list_models(server: Server, principal: Reader) -> Page[KeptModelView]:
    """What you have uploaded, newest first; all in one page."""
    records = server.store.list_models(principal.owner)
    return Page(items=[KeptModelView.of(record, href=address(f"/v1/models/{record.sha256}")) for record in records])


def _model_not_found() -> HttpProblem:
    return HttpProblem(404, "there is no such model, or it is not yours", "model_not_found")


ModelId = Annotated[str, Identifier(64, _model_not_found), Path(description="SHA-256 of the model.")]


@router.get(
    "/models/{sha256}", tags=["models"], summary="Get back a model", response_class=Response,
    responses={
        **PARTLY,
        200: {"description": "The model", "headers": ETAG, "content": {"application/xml": BINARY, ANY_TYPE: BINARY}},
        **problem_responses(401, 403, 404, 416, 422),
    },
)  # fmt: skip
def get_model(
    server: Server,
    principal: Reader,
    request: Request,
    sha256: ModelId,
) -> Response:
    """The text as it was uploaded, with Range, If-Range and If-None-Match."""
    path = server.store.model_path(principal.owner, sha256)
    if path is None:
        raise _model_not_found()
    try:
        with path.open("rb") as file:
            is_text = _type_of(file.read(LOOKED_AT)) in XML_TYPES
        return file_response(request, path, sha256, XML_TYPES[0] if is_text else ANY_TYPE, sha256)
    except FileNotFoundError:  # it was deleted meanwhile
        raise _model_not_found() from None


@cache
def _analysis(name: str) -> AnalysisView:
    schema = job_schema(name)
    title = name.replace("_", " ").capitalize()
    return AnalysisView(id=name, title=title, description=schema.get("description", title), schema=schema)


@router.delete(
    "/models/{sha256}", tags=["models"], summary="Delete a model", status_code=204, response_class=Response,
    responses=problem_responses(401, 403, 404, 409, 422),
)  # fmt: skip
def delete_model(server: Server, principal: Submitter, sha256: ModelId) -> Response:
    """Forget what you have uploaded; 409 while an unfinished job needs it. Results that were computed with it stay."""
    if not server.store.delete_model(principal.owner, sha256):
        raise _model_not_found()
    return Response(status_code=204)
