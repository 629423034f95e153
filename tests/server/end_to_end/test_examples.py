"""Every example of /openapi.json, sent to a live server: jobs succeed, and what is answered keeps to its schema."""

import httpx2
import pytest
from jsonschema import Draft202012Validator
from wsrender_server.local_server import LocalServer

from tests.server.end_to_end.acceptance import PATIENCE_S
from tests.server.openapi_examples import bodies, examples_of, schema_examples
from wsrender.analyses.registry import job_classes, result_classes

WAIT_S = 60
SECRET = "an-examples-secret-of-forty-characters-xx"
ENDED = ("succeeded", "failed", "canceled", "timed_out", "expired")


@pytest.fixture(scope="module")
def http(tmp_path_factory):
    """With a key that may do everything, and a server that sends webhooks where the examples say."""
    keys = tmp_path_factory.mktemp("keys") / "keys"
    keys.write_text(f"{SECRET} tester submit,admin\n")
    keys.chmod(0o600)
    with pytest.MonkeyPatch.context() as environment:
        environment.setenv("WSRENDER_WEBHOOK_TARGETS", "https://hooks.example.org")
        with (
            LocalServer(tmp_path_factory.mktemp("data"), ["--api-key-file", str(keys)]) as server,
            httpx2.Client(
                base_url=server.url, timeout=PATIENCE_S, headers={"Authorization": f"Bearer {SECRET}"}
            ) as http,
        ):
            yield http


@pytest.fixture(scope="module")
def document(http):
    return http.get("/openapi.json").json()


@pytest.fixture(scope="module")
def submissions(document):
    """The examples of jobs by name."""
    return examples_of(document["paths"]["/v1/jobs"]["post"]["requestBody"]["content"]["application/json"])


@pytest.fixture(scope="module")
def jobs(http, document, submissions):
    """What the server says of the examples of jobs by name, when they have ended."""
    sent = {}
    for name, body in submissions.items():
        answer = http.post("/v1/jobs", json=body)
        assert answer.status_code == 202, (name, answer.text)
        keeps_to_its_schema(document, document["paths"]["/v1/jobs"]["post"], answer)
        sent[name] = answer.json()
    for name, job in sent.items():
        while sent[name]["state"] not in ENDED:
            sent[name] = http.get(f"/v1/jobs/{job['id']}", params={"wait": WAIT_S}).json()
    return sent


def keeps_to_its_schema(document, operation, answer):
    """Whether an answer is declared, and of the form that is declared of it."""
    declared = operation["responses"][str(answer.status_code)].get("content", {})
    media_type = answer.headers.get("content-type", "").partition(";")[0]
    assert media_type in declared or "*/*" in declared, (operation["operationId"], media_type)
    if media_type == "application/json":
        schema = {**declared[media_type]["schema"], "components": document["components"]}
        errors = [error.message for error in Draft202012Validator(schema).iter_errors(answer.json())]
        assert not errors, (operation["operationId"], errors[:3])


def test_no_body_lacks_an_example(document, submissions):
    without = [(method, path, kind) for method, path, _, kind, content in bodies(document) if not examples_of(content)]
    assert not without
    assert set(job_classes()) < set(submissions)
    assert all(body["analysis"] == name for name, body in submissions.items() if name in job_classes())


def test_examples_keep_to_the_schemas_that_they_stand_at(document):
    named = [
        (f"{method} {path} {name}", example, content["schema"])
        for method, path, _, _, content in bodies(document)
        for name, example in examples_of(content).items()
    ]
    named += [(f"{name}.{field}", example, part) for name, field, example, part in schema_examples(document)]
    for path, methods in document["paths"].items():
        for method, operation in methods.items():
            named += [
                (f"{method} {path} {status}", content["example"], content["schema"])
                for status, answer in operation["responses"].items()
                for content in answer.get("content", {}).values()
                if "example" in content
            ]
    assert len(named) > 60
    for place, example, schema in named:
        validator = Draft202012Validator({**schema, "components": document["components"]})
        assert not [error.message for error in validator.iter_errors(example)], place


def test_every_job_succeeds(jobs):
    assert {name: job["error"] for name, job in jobs.items() if job["state"] != "succeeded"} == {}


def test_every_result_keeps_to_its_schema(http, document, jobs):
    for job in jobs.values():
        answer = http.get(f"/v1/jobs/{job['id']}/result")
        keeps_to_its_schema(document, document["paths"]["/v1/jobs/{job_id}/result"]["get"], answer)
        own = {"$ref": f"#/components/schemas/{result_classes()[job['analysis']].__name__}"}
        assert Draft202012Validator({**own, "components": document["components"]}).is_valid(answer.json())


def test_every_other_body_is_accepted(http, document, jobs):
    tried = 0
    for method, path, operation, media_type, content in bodies(document):
        for name, example in examples_of(content).items():
            if operation["operationId"] == "submit_job":
                continue
            body = {"json": example} if media_type == "application/json" else {"content": example.encode()}
            headers = {} if media_type == "application/json" else {"Content-Type": media_type}
            answer = http.request(method, path, headers=headers, **body)
            assert answer.is_success, (path, name, answer.text[:500])
            keeps_to_its_schema(document, operation, answer)
            tried += 1
    assert tried > len(jobs)


def test_every_example_of_parameters_finds_something(http, document, jobs):
    """In a result of one of the examples, where it stands beside the id of a job."""
    ids = [{"job_id": job["id"]} for job in jobs.values()]
    tried = 0
    for path, methods in document["paths"].items():
        operation = methods.get("get", {})
        needed = [each for each in operation.get("parameters", ()) if each.get("required")]
        given = {each["name"]: (each["schema"].get("examples") or [None])[0] for each in needed}
        given.pop("job_id", None)
        if not given or None in given.values():
            continue
        answers = []
        for own in ids if "{job_id}" in path else [{}]:
            query = {each["name"]: given[each["name"]] for each in needed if each["in"] == "query"}
            answers.append(http.get(path.format(**given, **own), params=query))
            if answers[-1].is_success:
                break
        assert answers[-1].is_success, (path, given, answers[-1].text[:500])
        keeps_to_its_schema(document, operation, answers[-1])
        tried += 1
    assert tried >= 7
