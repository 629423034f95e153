"""A scheduler that is slow to answer is not lost; where one is joined again, what is out runs on."""

import os
import signal
from types import SimpleNamespace

import pytest
from wsrender_server.jobs import engine as engines
from wsrender_server.jobs.faults import EngineSlow, EngineUnavailable
from wsrender_server.jobs.service import JobService
from wsrender_server.jobs.task import Step
from wsrender_server.settings import Settings

from tests.server.jobs.documents import canonical
from tests.server.jobs.waiting import ended, wait_until

LONG = {"robot": "ur5e", "sampling": {"method": "sobol", "count": 2**23}, "voxel_size_m": 0.05, "device": "cpu"}


@pytest.fixture
def service(tmp_path):
    with JobService(Settings(data_dir=tmp_path / "data", shard_samples=2**21)) as service:
        wait_until(lambda: service.worker_ready, what="a worker")
        yield service


@pytest.fixture
def begun(service, monkeypatch):
    """A job whose shards have begun and stand still until ``go_on``, its attempt, and the steps that workers begin."""
    steps, dispatcher = [], service.dispatcher
    kernels = wait_until(dispatcher.engine.kernel_pids, what="the kernel's process")
    report = dispatcher._reported

    def reported(news):
        if "step" in news:
            if news["step"] == "shard" and "shard" not in steps:
                signal_all(signal.SIGSTOP)
            steps.append(news["step"])
        report(news)

    def signal_all(number):
        for pid in kernels.values():
            os.kill(pid, number)

    monkeypatch.setattr(dispatcher, "_reported", reported)
    job = service.store.submit("ann", canonical(refined_volume=None, **LONG)).job.id
    try:
        wait_until(lambda: "shard" in steps, what="a shard")
        (attempt,) = dispatcher._attempts.values()
        yield SimpleNamespace(job=job, attempt=attempt, steps=steps, go_on=lambda: signal_all(signal.SIGCONT))
    finally:
        signal_all(signal.SIGCONT)


def silent(*_, **__):
    raise TimeoutError


def test_a_slow_answer_changes_nothing(service, begun, monkeypatch):
    attempt = begun.attempt
    engine, futures = service.dispatcher.engine, dict(attempt.futures)
    client, asked = engine._client, []
    with monkeypatch.context() as slow:
        slow.setattr(engine, "_known", lambda: (asked.append(1), silent()))
        with pytest.raises(EngineSlow):
            engine.targets()
        wait_until(lambda: len(asked) > 3, what="the dispatcher to ask again")
        assert engine._client is client and engine.connected and service.dispatcher._attempts
    assert service.dispatcher._attempts.get(attempt.record.id) is attempt
    assert all(futures.get(place, future) is future for place, future in attempt.futures.items())
    begun.go_on()
    assert ended(service.store, begun.job).state == "succeeded"
    assert begun.steps.count("shard") == 4 and begun.steps.count("plan") == 1


def test_a_scheduler_that_is_joined_again_goes_on_with_what_is_out(service, begun, monkeypatch):
    attempt = begun.attempt
    engine, names = service.dispatcher.engine, {future.key for future in attempt.futures.values()}
    client, kernels = engine._client, wait_until(engine.kernel_pids, what="the worker's answer")
    with monkeypatch.context() as lost:
        lost.setattr(engines, "LOST_S", 0.0)
        lost.setattr(engine, "_known", silent)
        with pytest.raises(EngineUnavailable) as fault:
            engine.targets()
        assert not isinstance(fault.value, EngineSlow)
        wait_until(lambda: engine._client is not client and engine.connected, what="another connection")
    assert service.dispatcher._attempts.get(attempt.record.id) is attempt and attempt.step == Step.SHARD
    assert {future.key for future in attempt.futures.values()} <= names
    wait_until(lambda: engine.kernel_pids() == kernels, what="the same kernel process")
    begun.go_on()
    assert ended(service.store, begun.job).state == "succeeded"
    assert begun.steps.count("plan") == 1 and begun.steps.count("finish") == 1
    assert service.store.get("ann", begun.job).attempt == 1


def test_a_connection_that_broke_off_is_taken_up_by_the_same_attempt(service, begun):
    client = service.dispatcher.engine._client
    client.sync(client._close, fast=True)
    begun.go_on()
    assert ended(service.store, begun.job).state == "succeeded"
    assert service.dispatcher.engine._client is not client
    assert begun.steps.count("plan") == 1 and begun.steps.count("finish") == 1
    assert service.store.get("ann", begun.job).attempt == 1
