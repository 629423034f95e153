"""The robots of a job: found by path in documents and in parsed jobs."""

import json

import pytest

from wsrender.analyses.jobs import canonical_json, parse_job
from wsrender.documents.arm import at_path, dotted, models_in
from wsrender.errors import DocumentError


def test_a_job_of_one_robot_is_an_arm():
    job = parse_job({"analysis": "workspace", "robot": "scara", "tip": "tool"})
    assert job.arms() == {(): job}
    document = json.loads(canonical_json(job))
    ((path, robot),) = models_in(document)
    assert (path, robot["library"]) == (("robot",), "scara")


def test_robots_anywhere_in_a_document_are_found():
    document = {"robots": [{"robot": {"library": "a"}}, {"robot": {"path": "b"}}], "master": {"robot": {"dh": {}}}}
    found = dict(models_in(document))
    assert list(found) == [("robots", 0, "robot"), ("robots", 1, "robot"), ("master", "robot")]
    assert all(at_path(document, path) is robot for path, robot in found.items())
    assert [dotted(path, "path") for path in found][1] == "robots.1.robot.path"


def test_files_of_arrays_are_found():
    """Points and configurations, wherever they are; none where a document lists the numbers."""
    upload = {"model": "0" * 64}
    document = {"left": upload, "right": {"points": [[0, 0, 0]], "path": None}, "master": {"robot": {"library": "a"}}}
    document |= {"configurations": {"path": "q.npy"}, "evaluations": {"path": "e.csv"}}
    assert [path for path, _ in models_in(document)] == [("left",), ("master", "robot"), ("configurations",)]
    assert [*models_in({"configurations": [[0, 1]], "locked": {"left": 0.5}})] == []


def test_a_number_of_a_robot_is_no_robot():
    assert list(models_in({"scan": {"robot": 1, "axis": "x"}, "robots": []})) == []


def test_robots_are_few():
    with pytest.raises(DocumentError, match="at most 64"):
        parse_job({"analysis": "shared_workspace", "robots": [{"robot": "scara"}] * 65})
