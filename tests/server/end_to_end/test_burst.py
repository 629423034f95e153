"""Many submissions at once: each is accepted or refused, none lost, none doubled."""

from concurrent.futures import ThreadPoolExecutor

import pytest
from wsrender_server.local_server import LocalServer

import wsrender as ws
from tests.server.end_to_end.acceptance import PATIENCE_S, QUICK

BURST = 200
ALLOWED = 150


@pytest.fixture
def server(tmp_path, monkeypatch):
    monkeypatch.setenv("WSRENDER_MAX_QUEUED_PER_OWNER", str(ALLOWED))
    with LocalServer(tmp_path / "data") as server:
        yield server


def test_burst(server):
    """Five computations, each asked for forty times: 200 jobs, of which the queue takes 150."""
    with ws.Client(server.url, timeout_s=120) as client:

        def submit(number):
            document = {**QUICK, "sampling": {"method": "random", "count": 2048, "seed": number % 5}}
            try:
                return client.submit(document, labels={"number": str(number)}).id
            except ws.QuotaError as error:
                assert error.retry_after_s is not None
                return None

        with ThreadPoolExecutor(BURST) as pool:
            answers = list(pool.map(submit, range(BURST)))
        accepted = {id for id in answers if id is not None}
        assert len(accepted) == sum(answer is not None for answer in answers) >= ALLOWED
        jobs = {job.id: job for job in client.jobs()}
        labels = {id: job.record["labels"]["number"] for id, job in jobs.items()}
        assert labels == {id: str(number) for number, id in enumerate(answers) if id is not None}
        assert {job.wait(timeout=PATIENCE_S).state for job in jobs.values()} == {"succeeded"}
