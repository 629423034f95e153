"""A worker of an existing cluster keeps trying to join it."""

import threading

import pytest
from wsrender_server.jobs import worker
from wsrender_server.settings import Settings


@pytest.fixture
def settings(tmp_path):
    files = {f"tls_{name}_file": tmp_path / name for name in ("ca", "cert", "key")}
    return Settings(data_dir=tmp_path, scheduler="tls://127.0.0.1:1", **files)


@pytest.mark.parametrize("fault", [OSError("refused"), TimeoutError("slow"), RuntimeError("Nanny failed to start.")])
def test_what_keeps_a_worker_from_joining_is_said_and_tried_again(settings, monkeypatch, caplog, fault):
    stop, attempts = threading.Event(), []

    class Nanny:
        def __init__(self, scheduler, **options):
            attempts.append(scheduler)

        async def __aenter__(self):
            if len(attempts) < 3:
                raise fault
            return self

        async def __aexit__(self, *_):
            pass

        async def finished(self):
            pass

    monkeypatch.setattr(worker, "Nanny", Nanny)
    monkeypatch.setattr(worker, "security", lambda settings: None)
    monkeypatch.setattr(worker, "RECONNECT_S", 0.01)
    worker.serve_scheduler(settings, stop.set, stop)
    assert attempts == ["tls://127.0.0.1:1"] * 3
    assert [str(fault) in record.getMessage() for record in caplog.records] == [True, True]
