"""Bodies of submissions: read strictly, and described by a JSON Schema that says as much as one can."""

import copy
import json
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, partial
from itertools import islice
from typing import Annotated, Any

from fastapi import Request
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, StringConstraints, ValidationError

from wsrender.analyses.jobs import job_schema
from wsrender.analyses.registry import job_classes
from wsrender.documents.problems import MOST_PROBLEMS, listed, path_text, worded
from wsrender.documents.quantities import integer, real
from wsrender.documents.reading import read_json
from wsrender.errors import DocumentError, InputError
from wsrender.indices import catalogue
from wsrender.indices.index_catalogue import names_of
from wsrender.pipeline.constraints.host_function import on_host
from wsrender.pipeline.constraints.registry import added_constraints
from wsrender.results.view import Edited
from wsrender.robots import library
from wsrender_server.jobs.store import HIGHEST_PRIORITY, LONGEST_TEXT, MOST_LABELS
from wsrender_server.problems import HttpProblem, pointer, problem_of_error, refusal
from wsrender_server.requests import at_end

JSON_TYPES = ("application/json", "text/json")
LABEL_KEY = r"^[A-Za-z0-9][A-Za-z0-9._/-]{0,62}$"
LABEL_VALUE = rf"^[^\x00-\x1f\x7f]{{0,{LONGEST_TEXT}}}$"
LARGEST_CHECKED = 1 << 16  # bytes
LONGEST_HERE = 1 << 18  # bytes of a body that is read in this process
MOST_HELD, MOST_HELD_OF_OWNER = 4, 2  # longer bodies at a time: who sends slowly never holds all places
# Of a body: values weigh some 30 bytes each once they are read, lists and objects 100.
MOST_VALUES, MOST_CONTAINERS = 8_000_000, 2_000_000
ROBOT = "#/$defs/RobotSpec"
# What a robot comes from, and the name of such an object.
ROBOTS = {
    "library": "LibraryRobot",
    "dh": "DHRobot",
    "mjcf": "MJCFRobot",
    "urdf": "URDFRobot",
    "model": "UploadedRobot",
}
# Lists that hold nothing twice, and what else their schema says.
LISTS: dict[str, dict[str, int]] = {
    "indices": {"minItems": 1},
    "task": {"minItems": 1},
    "voxel_statistics": {},
    "map_columns": {},
}

Labels = Annotated[
    dict[Annotated[str, StringConstraints(pattern=LABEL_KEY)], Annotated[str, StringConstraints(pattern=LABEL_VALUE)]],
    Field(max_length=MOST_LABELS, json_schema_extra={"additionalProperties": False}),
]


class SubmissionOptions(BaseModel):
    """What may stand beside a job document."""

    labels: Labels = Field(default={}, examples=[{"study": "wrist-1"}])
    """Free text to find the job by."""
    priority: Annotated[int, Field(ge=-HIGHEST_PRIORITY, le=HIGHEST_PRIORITY), BeforeValidator(integer)] = 0
    """Jobs of larger priority go first; above 0 it needs a key with the scope priority."""
    timeout_s: Annotated[float, Field(gt=0, le=1e7), BeforeValidator(real)] | None = None
    """Longest time that the job may run [s]; null: the server's default."""

    model_config = ConfigDict(use_attribute_docstrings=True, extra="forbid")


@dataclass(frozen=True)
class JobBody:
    """A submission: the job document as sent, what stood beside it, and where in the body the document is."""

    document: Mapping[str, Any]
    options: SubmissionOptions
    prefix: str


def check_size(text: bytes) -> None:
    """Raise HttpProblem 413 for a body of too many values, lists and objects; nothing is read yet."""
    containers = text.count(b"[") + text.count(b"{")
    for what, count, most in (
        ("values", text.count(b",") + containers, MOST_VALUES),
        ("lists and objects", containers, MOST_CONTAINERS),
    ):
        if count > most:
            detail = f"the body may hold {most:,} {what}, not about {count:,}"
            raise HttpProblem(413, detail, "too_many_values", errors=[("#", detail)])


def read_body(text: bytes) -> JobBody:
    """The submission of a JSON text: a job document with options beside its fields, or as ``{"job": document}``.

    Raises HttpProblem 400 for text that is no JSON, DocumentError for wrong options.
    """
    body = _read_text(text)
    if not isinstance(body, dict):
        raise DocumentError([("document", f"must be a JSON object, not {_kind(body)}")])
    options = {name: body.pop(name) for name in SubmissionOptions.model_fields if name in body}
    wrapped = "job" in body
    document = body.pop("job") if wrapped else body
    if wrapped and body:
        unknown = islice(body, MOST_PROBLEMS)
        raise DocumentError([(path_text(name), 'is not a known field beside "job"') for name in unknown])
    if not isinstance(document, dict):
        raise DocumentError([("job", f"must be a job document (object), not {_kind(document)}")])
    try:
        return JobBody(document, SubmissionOptions.model_validate(options), "/job" if wrapped else "")
    except ValidationError as error:
        raise DocumentError(listed(worded(error, SubmissionOptions), options)) from None


def _read_text(text: bytes) -> Any:
    try:
        value = read_json(text)
        if b"\\u" in text:
            json.dumps(value, ensure_ascii=False).encode()  # half of a surrogate pair is no text
    except InputError as error:
        raise HttpProblem(400, error.message, "malformed_json", errors=[(pointer("document"), error.message)]) from None
    except UnicodeEncodeError as error:
        raise HttpProblem(
            400, f"holds {error.object[error.start]!r}, which is no character", "malformed_json"
        ) from None
    except RecursionError:
        raise HttpProblem(400, "is nested too deeply", "malformed_json") from None
    return value


def _kind(value: Any) -> str:
    kinds = {list: "a list", str: "a string", bool: "a boolean", int: "a number", float: "a number"}
    return kinds.get(type(value), "null")


def refused(error: DocumentError, text: bytes, schema: str, prefix: str) -> HttpProblem:
    """The answer to a wrong document: 422 if the body breaks its published schema, 409 if it contradicts itself."""
    return refusal(problem_of_error(error, prefix), 409 if _keeps_to_schema(text, schema) else 422)


def _keeps_to_schema(text: bytes, schema: str) -> bool:
    if len(text) > LARGEST_CHECKED:
        return False
    try:
        return _validator(schema).is_valid(read_json(text))
    except UnicodeEncodeError:  # half of a surrogate pair is no text
        return False


@cache
def _validator(name: str) -> Any:
    from jsonschema_rs import Draft202012Validator  # in Python items of many kinds take a second for each kilobyte

    return Draft202012Validator({"$ref": f"#/components/schemas/{name}", "components": {"schemas": body_schemas()}})


def _check_type(request: Request) -> None:
    """Raise HttpProblem 415 for another media type than JSON."""
    media_type = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if media_type not in JSON_TYPES:
        raise HttpProblem(415, f"the body must be application/json, not {media_type or 'of no type'}")


class Places:
    """Places of long bodies, of which no owner has all; taken and given back on the event loop."""

    def __init__(self, most: int = MOST_HELD, most_of_owner: int = MOST_HELD_OF_OWNER):
        self._most, self._most_of_owner = most, most_of_owner
        self.taken: Counter[str] = Counter()

    def take(self, owner: str) -> bool:
        """Whether there was a place, which is the owner's now."""
        if self.taken.total() >= self._most or self.taken[owner] >= self._most_of_owner:
            return False
        self.taken[owner] += 1
        return True

    def give_back(self, owner: str) -> None:
        """Let others have a place."""
        self.taken -= Counter([owner])


async def job_body(request: Request) -> bytes:
    """A body of JSON, else HttpProblem 415; of long ones few are held at a time: HttpProblem 429 for another."""
    _check_type(request)
    return await held_body(request, request.app.state.parts.long_bodies)


async def held_body(request: Request, places: Places) -> bytes:
    """A body, which has one of the places until the request has ended where it is long. HttpProblem 429 without one."""
    owner = getattr(request.state, "owner", "")  # who asks is looked at first
    pieces, size, has_place = [], 0, False
    async for piece in request.stream():
        size += len(piece)
        if size > LONGEST_HERE and not has_place:
            has_place = places.take(owner)
            if not has_place:
                raise HttpProblem(429, "too many long bodies are being read", "busy", retryable=True)
            at_end(request, partial(places.give_back, owner))
        pieces.append(piece)
    return b"".join(pieces)


def body_schemas() -> dict[str, Any]:
    """Schemas for OpenAPI's components: every part of a job document, ``JobDocument`` and ``JobSubmission``.

    ``Edited`` is what the page shows before there is a job. They are stricter than ``wsrender schema`` where JSON
    Schema can say what a server additionally refuses, and as generators of clients need them: a robot is one of several
    named objects, and no object is a default (``x-default`` has it for those who show forms).
    """
    schema = copy.deepcopy(job_schema())
    parts: dict[str, Any] = schema.pop("$defs")
    _tighten_robot(parts["RobotSpec"])
    analyses = {name: ref.rpartition("/")[2] for name, ref in schema["discriminator"]["mapping"].items()}
    _tighten_scene(parts["Scene"])
    uploads = (("Mesh", "vertices_m", 4), ("ConvexMesh", "vertices_m", 4), ("HeightField", "heights_m", 2))
    for name, values, least in (*uploads, ("PointSet", "points", 1)):
        _tighten_listed(parts[name], values, least)
    options = SubmissionOptions.model_json_schema()["properties"]
    parts["Constraints"]["properties"] |= _added_constraints()
    parts["Constraints"]["additionalProperties"] = False
    parts["Edited"] = Edited.model_json_schema(ref_template="#/$defs/{model}")
    del parts["Edited"]["$defs"]
    for name in ("TargetTable", "ArrayFile"):
        del parts[name]["properties"]["path"]
        _not_null(parts[name], "model")
        parts[name]["required"] = ["model"]
    for part in parts.values():
        _tighten(part)
    for model in analyses.values():
        parts[model]["required"] = ["analysis", *parts[model].get("required", [])]
    submissions = {}
    for name, model in analyses.items():
        flat = copy.deepcopy(parts[model])
        flat["properties"] |= options
        flat.pop("examples", None)  # they stand at the body
        flat["title"] = flat["title"].replace("Job", "Submission")
        submissions[name] = flat["title"]
        parts[flat["title"]] = flat
    parts["JobDocument"] = _one_of(analyses, "A job document: what to analyse.")
    parts["WrappedSubmission"] = {
        "title": "WrappedSubmission",
        "description": "A job document under the key job, with options beside it.",
        "type": "object",
        "additionalProperties": False,
        "properties": {"job": {"$ref": "#/$defs/JobDocument"}, **options},
        "required": ["job"],
    }
    parts["JobSubmission"] = {
        "title": "JobSubmission",
        "description": "A job document, with labels, priority and timeout_s beside its fields if you like.",
        "anyOf": [*(_ref(name) for name in submissions.values()), _ref("WrappedSubmission")],
    }
    _split_robot(parts)
    _move_defaults(parts)
    return json.loads(json.dumps(parts).replace("#/$defs/", "#/components/schemas/"))


def submission_examples() -> dict[str, dict[str, Any]]:
    """Bodies of submissions that run as they are, by name: one of each analysis, and one with options beside it."""
    examples = {name: given for name, job in job_classes().items() if (given := _example(job)) is not None}
    options = {"labels": {"study": "wrist-1"}, "priority": -1, "timeout_s": 60}
    examples["with_options"] = {"job": examples["workspace"], **options}
    return {name: {"summary": name.replace("_", " ").capitalize(), "value": given} for name, given in examples.items()}


def _example(job: type[BaseModel]) -> Any:
    """What the schema of a class of jobs gives as its example; None: another package's may give none."""
    extra = job.model_config.get("json_schema_extra")
    examples = extra.get("examples") if isinstance(extra, dict) else None
    return examples[0] if isinstance(examples, list) and examples else None


def _split_robot(parts: dict[str, Any]) -> None:
    """An object for each source of a robot; ``x-sources`` names, of their union, what each has alone."""
    whole = parts["RobotSpec"]
    del whole["oneOf"]
    for source, name in ROBOTS.items():
        others = ROBOTS.keys() - {source}
        properties = {field: part for field, part in whole["properties"].items() if field not in others}
        parts[name] = {**whole, "title": name, "properties": properties, "required": [source]}
    described = {key: whole[key] for key in ("title", "description")}
    parts["RobotSpec"] = {**described, "anyOf": [_ref(name) for name in ROBOTS.values()], "x-sources": [*ROBOTS]}


def _move_defaults(node: Any) -> None:
    """Let descriptions say the defaults that are objects."""
    if isinstance(node, list):
        for value in node:
            _move_defaults(value)
    elif isinstance(node, dict):
        for value in node.values():
            _move_defaults(value)
        if isinstance(node.get("default"), dict):
            node["x-default"] = default = node.pop("default")
            if default:
                node["description"] = f"{node.get('description', '')} Default: {json.dumps(default)}.".strip()


def _one_of(tags: Mapping[str, str], description: str) -> dict[str, Any]:
    return {"title": "JobDocument", "description": description, "oneOf": [_ref(name) for name in tags.values()]}


def _ref(name: str) -> dict[str, str]:
    return {"$ref": f"#/$defs/{name}"}


def _tighten_robot(part: dict[str, Any]) -> None:
    """Exactly one source; library robots by name; no paths."""
    properties = part["properties"]
    del properties["path"]
    properties["library"] = {"enum": library.names(), "description": properties["library"]["description"]}
    for name in ("mjcf", "urdf", "model"):
        properties[name] = properties[name]["anyOf"][0] | {"description": properties[name]["description"]}
    properties["dh"] = _ref("DHTable")
    part["oneOf"] = [{"required": [source]} for source in ROBOTS]


def _tighten_scene(part: dict[str, Any]) -> None:
    """Exactly one source; no paths."""
    properties = part["properties"]
    del properties["path"]
    for name in ("mjcf", "model"):
        _not_null(part, name)
    part["oneOf"] = [{"required": [source]} for source in ("mjcf", "model")]


def _not_null(part: dict[str, Any], name: str) -> None:
    field = part["properties"][name]
    choices = [choice for choice in field["anyOf"] if choice != {"type": "null"}]
    known = choices[0] if len(choices) == 1 else {"anyOf": choices}
    part["properties"][name] = known | {"description": field["description"]}


def _tighten_listed(part: dict[str, Any], name: str, least: int) -> None:
    """So many numbers in the document at least, or what was uploaded; no paths."""
    del part["properties"]["path"]
    for each in (name, "model"):
        _not_null(part, each)
    values = part["properties"][name]
    values.get("anyOf", [values])[0]["minItems"] = least  # the list; a single item is as it is
    part["oneOf"] = [{"required": [name]}, {"required": ["model"]}]


def _tighten(part: dict[str, Any]) -> None:
    """Robots also by name, index names, lists without repetition."""
    properties = part.get("properties", {})
    for name, schema in properties.items():
        if schema.get("$ref") == ROBOT:
            robots = [_ref("RobotSpec"), {"enum": library.names()}]
            properties[name] = {"anyOf": robots, "description": schema["description"]}
        elif _ref("RobotSpec") in schema.get("anyOf", []):
            schema["anyOf"].append({"enum": library.names()})
        if name == "index_options":
            schema |= {"properties": _index_options(), "additionalProperties": False}
        for choice in [schema, *schema.get("anyOf", [])] if name in LISTS else []:
            if "items" in choice:
                choice |= {"uniqueItems": True} | LISTS[name]
                if name == "indices":
                    choice["items"] = {"enum": _index_names()}
        if name == "indices" and "anyOf" in schema:
            groups = next(choice["enum"] for choice in schema["anyOf"] if "enum" in choice)
            lists = [choice for choice in schema["anyOf"] if "items" in choice]
            schema["anyOf"] = [{"type": "string", "enum": [*groups, *_index_names()]}, *lists]


def _index_names() -> list[str]:
    """Names and aliases of all indices, of their dynamic forms too."""
    return sorted({name for index in catalogue().values() for name in names_of(index)})


def _index_options() -> dict[str, Any]:
    """Schemas of the options of every index that has some, by each of its names."""
    schemas = {}
    for index in catalogue().values():
        options = {option.name: option.schema() for option in index.options}
        schema = {"type": "object", "additionalProperties": False, "properties": options}
        schemas |= {name: schema for name in names_of(index) if options}
    return schemas


def _added_constraints() -> dict[str, Any]:
    """Schemas of the constraints that other packages add: whether they act, or their options."""
    schemas = {}
    for name, constraint in added_constraints().items():
        if on_host((constraint,)):
            continue
        options = {option: {"type": "number", "default": value} for option, value in constraint.options}
        choice = {"type": "object", "additionalProperties": False, "properties": options}
        schemas[name] = {"anyOf": [{"type": "boolean"}, choice]}
    return schemas
