"""The OpenAPI document: complete, and as strict as the server."""

import json
import re

import pytest
from wsrender_server.job_body import body_schemas, submission_examples

from tests.server.http.idle_server import DOCUMENT
from tests.server.http.openapi_names import FILE, names_of
from wsrender.analyses.jobs import parse_job
from wsrender.errors import DocumentError
from wsrender.robots import library


@pytest.fixture
def document(client):
    return client.get("/openapi.json").json()


def test_every_operation_is_described(document):
    operations = [(p, m, o) for p, methods in document["paths"].items() for m, o in methods.items()]
    names = [operation["operationId"] for _, _, operation in operations]
    assert len(set(names)) == len(names) and {"submit_job", "get_job", "follow_job", "get_slice"} <= set(names)
    for path, method, operation in operations:
        assert operation["summary"] and operation["description"] and operation["tags"], (path, method)
        for status, response in operation["responses"].items():
            if int(status) >= 400:
                schema = response["content"]["application/problem+json"]["schema"]
                assert schema == {"$ref": "#/components/schemas/Problem"}


def test_a_result_keeps_to_its_schema(client, finished, document):
    jsonschema = pytest.importorskip("jsonschema")
    schema = document["paths"]["/v1/jobs/{job_id}/result"]["get"]["responses"]["200"]["content"]["application/json"]
    result = client.get(f"{finished}/result").json()
    named = {"$ref": "#/components/schemas/ResultDocument", "components": document["components"]}
    assert schema == {"schema": {"$ref": "#/components/schemas/ResultDocument"}}
    validator = jsonschema.Draft202012Validator(named)
    assert validator.is_valid(result) and result["headline"]["reason"] == ""
    assert [warning["code"] for warning in result["warnings"]] == ["task_without_motion"]  # a planar arm, rows x, y, z
    assert not validator.is_valid(result | {"warnings": [{"code": "odd"}]})
    assert not validator.is_valid(result | {"headline": {"value": 1.0}})
    assert result["format"] == 2 and not validator.is_valid(result | {"format": 3})


def test_every_reference_is_there(document):
    text = json.dumps(document)
    names = {part.partition('"')[0] for part in text.split('"#/components/schemas/')[1:]}
    assert names <= set(document["components"]["schemas"])


def test_the_published_schema_is_that_of_the_documents():
    jsonschema = pytest.importorskip("jsonschema")
    schema = {"$ref": "#/components/schemas/JobSubmission", "components": {"schemas": body_schemas()}}
    validator = jsonschema.Draft202012Validator(schema)
    dh = {"convention": "modified", "rows": [{"a": 0.1, "limits": [-1, 1]}]}
    robots = ["scara", {"library": "scara"}, {"dh": dh}, {"mjcf": "<mujoco/>"}, {"model": "0" * 64}]
    robots += [{}, {"library": "nope"}, {"library": "scara", "dh": dh}, {"mjcf": ""}, {"model": "x"}]
    rail = {"name": "rail", "axis": "x", "limits": [0, 1]}
    robots += [{"library": "scara", "mount": mount} for mount in ([rail], [rail | {"axis": [0, 1, 1]}], rail, [{}])]
    bodies = [DOCUMENT | {"robot": robot} for robot in robots]
    bodies += [
        DOCUMENT | {"indices": indices}
        for indices in (["yoshikawa"], ["dynamic_isotropy"], "all", [], ["x"], "isotropy", "x")
    ]
    points = ([0.2, 0.1, 0.1], [[0.2, 0.1, 0.1]], [0.2, 0.1], [], [[0.2]], [0.1, [0.1, 0.1, 0.1]], 1.0)
    bodies += [{"analysis": "reachability", "robot": "scara", "points_m": each} for each in points]
    bodies += [DOCUMENT | {"task": task} for task in (["x", "rz"], ["x", "x"], [], "full")]
    bodies += [each["value"] for each in submission_examples().values()]
    rows = ([0, 1], [[0, 1]], [], [[]], [0, [1]], {"model": "0" * 64}, {}, 1)
    bodies += [{"analysis": "indices_at", "robot": "scara", "configurations": each} for each in rows]
    numbers = (1, 0, [1, 2], [1, 2, 3], [1, 2, -3], "1", None)
    bodies += [{"analysis": "five_bar", "base_m": 1, "proximal_m": 1, "distal_m": each} for each in numbers]
    links = {"base_m": 1, "proximal_m": 1, "distal_m": 1}
    pairs = ([0.5, 0.9], [[0.5, 0.9]], [], [0.5], {"model": "0" * 64}, {"model": "x"}, {}, 1)
    bodies += [{"analysis": "five_bar", **links, "points_m": each} for each in pairs]
    bodies += [{"analysis": "planar_boundary", "robot": "scara", "points_m": each} for each in pairs]
    limits = (None, [None, None], [[0, 1], None], [[0, 1]], 1)
    bodies += [{"analysis": "five_bar", **links, "limits_rad": each} for each in limits]
    parallel = {"analysis": "parallel_workspace", "mechanism": "six_pus"}
    bodies += [parallel | {"mechanism": {"library": "six_pus", "link_m": each}} for each in numbers]
    angles = ({"euler_xyz_deg": [[-10, 10]] * 3, "per_angle": each} for each in (2, [2, 2, 2], [2, 2], 0))
    bodies += [parallel | {"kind": "total_orientation", "orientations": each} for each in angles]
    mapped = {"analysis": "master_slave_mapping", "master": {"robot": "scara"}, "slave": {"points": [[0, 0, 0]]}}
    bodies += [mapped | {"scale": each} for each in numbers]
    bodies += [mapped | {"offsets_m": each} for each in ([0, 0, 1], [[0, 0, 1]], [0, 0])]
    bodies += [mapped | {"slave": {"points": each}} for each in ([0, 0, 1], [[0, 0, 1]], [0, 0], [])]
    design = submission_examples()["design_optimization"]["value"]
    for pointers in ("/robot/dh/rows/1/a", ["/robot/dh/rows/1/a"], 5):
        bodies.append(design | {"parameters": [design["parameters"][0] | {"pointers": pointers}]})
    pair = {"analysis": "shared_workspace", "robots": [{"robot": "scara"}, {"robot": "scara"}]}
    bodies += [pair | {"scan": {"robot": robot, "values": [0]}} for robot in (1, "scara", {"library": "scara"})]
    bodies += [pair, pair | {"robots": pair["robots"][:1]}, pair | {"robots": ["scara", "scara"]}]
    for body in bodies:
        try:
            job = parse_job(body.get("job", body))
            robots = {arm.robot.library for arm in job.arms().values()}
            allowed = robots <= {None, *library.names()} and "x" not in getattr(job, "indices", ())
        except DocumentError:
            allowed = False
        assert validator.is_valid(body) == allowed, body


def test_names_stay_those_that_clients_know(document):
    """A change of a line breaks clients that generators made: write the file again where that is meant, and say it in
    CHANGELOG."""
    assert [*names_of(document)] == FILE.read_text().splitlines()


def test_no_object_is_a_default(document):
    def nodes(node):
        if isinstance(node, dict | list):
            yield node
            for each in node.values() if isinstance(node, dict) else node:
                yield from nodes(each)

    objects = [node for node in nodes(document["components"]) if isinstance(node, dict)]
    assert not any(isinstance(node.get("default"), dict) for node in objects)
    kept = {json.dumps(node["x-default"]) for node in objects if "x-default" in node}
    assert '{"locked": {}, "count": 16777216, "seed": 0, "method": "sobol"}' in kept


def test_bodies_that_are_not_json_are_bytes_or_text(document):
    for path, methods in document["paths"].items():
        for operation in methods.values():
            for body in (operation.get("requestBody", {}), *operation["responses"].values()):
                for media_type, content in body.get("content", {}).items():
                    if media_type == "text/event-stream":
                        continue
                    schema = content["schema"]
                    if not media_type.endswith("json"):
                        text = {"type": "string"} | ({} if media_type.startswith("text/") else {"format": "binary"})
                        assert schema == text, (path, media_type)
                    else:
                        assert schema, (path, media_type)


def test_headers_that_clients_set_are_parameters(client, document):
    paths = document["paths"]
    for path, methods in paths.items():
        for method, operation in methods.items():
            named = {each["name"] for each in operation.get("parameters", ()) if each["in"] == "header"}
            assert ("If-None-Match" in named) == ("304" in operation["responses"]), (method, path)
            assert ({"Range", "If-Range"} <= named) == ("206" in operation["responses"]), (method, path)
    assert "206" in paths["/v1/jobs/{job_id}/artifacts/{name}"]["get"]["responses"]
    parameters = {each["name"]: each for each in paths["/v1/jobs"]["post"]["parameters"]}
    assert set(parameters) == {"Idempotency-Key", "wait"}
    schema = parameters["Idempotency-Key"]["schema"]
    for key, accepted in {"a": True, "a b": True, "~" * 255: True, "": False, "a\t": False, "~" * 256: False}.items():
        assert (bool(re.search(schema["pattern"], key)) and len(key) <= schema["maxLength"]) == accepted
        answer = client.post("/v1/jobs", json={}, headers={"Idempotency-Key": key})
        assert ("Idempotency-Key" in answer.text) != accepted
