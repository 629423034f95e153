"""Files of results that are gone or damaged: said, never served, and computed again."""

import os

import pytest
from wsrender_server.jobs.faults import InvalidTransition
from wsrender_server.jobs.records import ComputationState, JobState

from tests.server.jobs.test_store import RESULT, complete, running, states


def gone(path):
    path.unlink()


def flipped(path):
    """One bit is another one; size and time of the change are as before."""
    before = path.stat()
    path.write_bytes(bytes([path.read_bytes()[0] ^ 1]) + path.read_bytes()[1:])
    os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns))


def cut(path):
    path.write_bytes(path.read_bytes()[:-1])


DAMAGES = pytest.mark.parametrize("damage", [gone, flipped, cut])


@DAMAGES
@pytest.mark.parametrize("read_before", [False, True])
def test_a_hit_without_its_files_is_computed_again(store, document, damage, read_before):
    first, computation = running(store, document)
    path = complete(store, computation)
    if read_before:
        assert store.submit("ann", document).cached and store.result_document("ann", first)
    damage(path)
    again = store.submit("ann", document)
    assert not again.cached and states(store, "ann", first, again.job.id) == [JobState.EXPIRED, JobState.QUEUED]
    record = store.get("ann", first)
    assert record.error["code"] == "result_expired" and "result.json" in record.error["message"]
    assert record.finished_at is not None and store.artifacts("ann", first) == [] and not path.exists()
    assert store.unfinished()[computation] == (ComputationState.WAITING, 2)
    store.begin(computation, 2)
    assert complete(store, computation).read_bytes() == RESULT
    assert states(store, "ann", first, again.job.id) == [JobState.EXPIRED, JobState.SUCCEEDED]
    assert store.retry("ann", first).state == JobState.SUCCEEDED  # the result is there again
    assert store.result_document("ann", first) == {"analysis": "workspace"}


@DAMAGES
def test_a_damaged_file_is_not_read(store, document, damage):
    job, computation = running(store, document)
    path = complete(store, computation)
    assert store.artifact_path("ann", job, "result.json") == path
    damage(path)
    assert store.artifact_path("ann", job, "result.json") is None and store.result_document("ann", job) is None
    assert states(store, "ann", job) == [JobState.EXPIRED]
    assert [event.data["state"] for event in store.news("ann", job, 0)[1]][-1] == "expired"
    with pytest.raises(InvalidTransition):
        store.cancel("ann", job)
    assert store.retry("ann", job).state == JobState.QUEUED and store.get("ann", job).attempt == 2
    store.begin(computation, 2)
    complete(store, computation)
    assert store.delete("ann", job).state == JobState.SUCCEEDED


def test_a_retried_job_meets_no_damaged_result(store, document):
    first, computation = running(store, document)
    store.fail(computation, 1, {"code": "x", "message": "y", "retryable": True})
    second = store.submit("ann", document).job.id
    store.begin(computation, 2)
    complete(store, computation).unlink()
    assert states(store, "ann", first, second) == [JobState.FAILED, JobState.SUCCEEDED]
    assert store.retry("ann", first).state == JobState.QUEUED
    assert states(store, "ann", second) == [JobState.EXPIRED]


def test_an_expired_job_is_deleted_with_its_computation(store, document):
    job, computation = running(store, document)
    complete(store, computation)
    assert store.expire(computation, 1, "it was there for long") and not store.expire(computation, 1, "again")
    assert store.delete("ann", job).state == JobState.EXPIRED and store.computation(computation) is None


def test_what_is_computed_again_is_not_expired_by_those_who_read_before(store, document):
    job, computation = running(store, document)
    complete(store, computation)
    store.expire(computation, 1, "it was there for long")
    store.retry("ann", job)
    store.begin(computation, 2)
    path = complete(store, computation)
    assert not store.expire(computation, 1, "late") and store.forget_files(computation) and path.exists()


@DAMAGES
def test_a_damaged_model_is_not_given_and_can_be_sent_again(store, damage):
    sha256 = store.put_model("ann", b"<mujoco/>")
    assert store.model_path("ann", sha256).read_bytes() == b"<mujoco/>"
    damage(store.files.model(sha256))
    assert store.model_path("ann", sha256) is None
    store.put_model("ann", b"<mujoco/>")
    assert store.model_path("ann", sha256).read_bytes() == b"<mujoco/>"
