"""A server without workers, and a result that was computed once for all its jobs."""

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient
from wsrender_server.app import create_app
from wsrender_server.jobs.store import open_store
from wsrender_server.settings import Settings

import wsrender
from tests.server.http.idle_server import DOCUMENT, HOST, IdleJobs


@pytest.fixture(scope="session")
def result_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The result of DOCUMENT, computed here."""
    from wsrender.run import execute

    folder = tmp_path_factory.mktemp("result") / "out"
    execute(json.dumps(DOCUMENT)).save(folder)
    return folder


@pytest.fixture(scope="session")
def result(result_folder: Path) -> wsrender.Result:
    return wsrender.Result.load(result_folder)


@pytest.fixture
def settings(tmp_path: Path) -> Settings:
    limits = {"max_queued_per_owner": 5, "max_body_bytes": 1 << 20, "max_upload_bytes": 3 << 20}
    return Settings(data_dir=tmp_path / "data", min_free_disk_bytes=0, **limits)


@pytest.fixture
def jobs(settings: Settings) -> Iterator[IdleJobs]:
    jobs = IdleJobs(open_store(settings))
    yield jobs
    jobs.store.close()


@pytest.fixture
def client(settings: Settings, jobs: IdleJobs) -> Iterator[TestClient]:
    with TestClient(create_app(settings, jobs), base_url=HOST) as client:
        yield client


@pytest.fixture
def submit(client: TestClient) -> Callable[..., dict[str, Any]]:
    """Submits DOCUMENT with other fields; the job."""

    def submitted(**fields: Any) -> dict[str, Any]:
        response = client.post("/v1/jobs", json=DOCUMENT | fields)
        assert response.status_code in (200, 202), response.text
        return response.json()

    return submitted


@pytest.fixture
def finished(submit: Callable[..., dict[str, Any]], jobs: IdleJobs, result_folder: Path) -> str:
    """Path of a job that succeeded."""
    job = submit()
    jobs.complete(job["id"], result_folder)
    return f"/v1/jobs/{job['id']}"
