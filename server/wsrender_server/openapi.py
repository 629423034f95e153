"""The OpenAPI document, as generators of clients need it: whatever the settings, the same operations and names."""

import json
import re
from collections.abc import Callable, Mapping
from typing import Any

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi
from pydantic.json_schema import models_json_schema

from wsrender import __version__
from wsrender.analyses.registry import result_classes
from wsrender.results.view.manifest import MANIFEST
from wsrender_server.job_body import body_schemas
from wsrender_server.problems import Problem

_SCHEMAS = "#/components/schemas/"
_REFERENCE = re.compile(f'"{_SCHEMAS}([^"]+)"')
BINARY = {"type": "string", "format": "binary"}


def _header(name: str, description: str) -> dict[str, Any]:
    return {
        "name": name,
        "in": "header",
        "required": False,
        "description": description,
        "schema": {"type": "string"},
    }


# By the status that answers them.
_HEADERS = {
    "304": [_header("If-None-Match", "Entity tags that the client has; 304 where the file's is among them.")],
    "206": [
        _header(
            "Range", "Bytes of the file, such as `bytes=100-`: what is still missing of a download that broke off."
        ),
        _header("If-Range", "Entity tag that the file must still have; else it comes whole, whatever the range."),
    ],
}


def openapi_document(app: FastAPI, keys_needed: bool) -> dict[str, Any]:
    """The document of an application; ``keys_needed``: whether a key must be given, or only may."""
    document = get_openapi(
        title=app.title,
        version=app.version,
        description=app.description,
        license_info=app.license_info,
        routes=app.routes,
        openapi_version=app.openapi_version,
    )
    schemas = document["components"]["schemas"]
    schemas |= body_schemas()
    schemas |= _view_schemas()
    schemas |= result_schemas()
    schemas["ResultDocument"]["allOf"] = [_as_its_analysis_says(name) for name in result_classes()]
    schemas["Problem"] = Problem.model_json_schema(ref_template="#/components/schemas/{model}")
    schemas |= schemas["Problem"].pop("$defs", {})
    for unused in ("HTTPValidationError", "ValidationError"):
        schemas.pop(unused, None)
    for operation in (operation for path in document["paths"].values() for operation in path.values()):
        for status, headers in _HEADERS.items():
            if status in operation["responses"]:
                operation.setdefault("parameters", []).extend(headers)
        _type_bodies(operation)
        if not keys_needed and "security" in operation:
            operation["security"].append({})
    return document


def _type_bodies(operation: dict[str, Any]) -> None:
    """What is neither JSON nor text is binary, and so is XML, whose bytes say how they are to be read."""
    bodies = [operation.get("requestBody", {}), *operation["responses"].values()]
    for content in (body.get("content", {}) for body in bodies):
        if "application/json" in content and "application/octet-stream" in content:
            content["application/json"] = content.pop("application/json")  # generators take the first: the default
    for media_type, content in (item for body in bodies for item in body.get("content", {}).items()):
        if media_type == "text/event-stream":  # a schema would be that of each event
            continue
        if not media_type.endswith("json"):
            content["schema"] = {"type": "string"} if media_type.startswith("text/") else dict(BINARY)
        elif not content.get("schema"):  # a description of messages
            content["schema"] = {"type": "object"}


def result_schemas() -> dict[str, Any]:
    """A schema for the result documents of each analysis, such as ``WorkspaceResult``, and for their parts."""
    classes = result_classes().values()
    _, found = models_json_schema([(each, "validation") for each in classes], ref_template=f"{_SCHEMAS}{{model}}")
    return _named(found["$defs"], lambda name: name if "Result" in name else f"Result{name}")


def _as_its_analysis_says(analysis: str) -> dict[str, Any]:
    """That a document of an analysis, if this version has made it, keeps to the schema of these."""
    own = {"properties": {"wsrender": {"const": __version__}}, "required": ["wsrender"]}
    about = {"properties": {"analysis": {"const": analysis}, "provenance": own}, "required": ["analysis", "provenance"]}
    return {"if": about, "then": {"$ref": f"{_SCHEMAS}{result_classes()[analysis].__name__}"}}


def _view_schemas() -> dict[str, Any]:
    """The manifest of a view."""
    found = MANIFEST.json_schema(ref_template=f"{_SCHEMAS}{{model}}")
    schemas = {**found.pop("$defs"), "Manifest": found}
    return _named(schemas, lambda name: name if name.startswith(("View", "Manifest")) else f"View{name}")


def _named(schemas: Mapping[str, Any], new: Callable[[str], str]) -> dict[str, Any]:
    """Schemas, which refer to each other, by new names, which are their titles, too: generators call classes so."""
    text = json.dumps({new(name): schema | {"title": new(name)} for name, schema in schemas.items()})
    return json.loads(_REFERENCE.sub(lambda match: f'"{_SCHEMAS}{new(match[1])}"', text))
