"""Thirty calls of the clients; a type checker must report none. They are checked, not run."""

import asyncio
from concurrent.futures import Future
from pathlib import Path

import numpy as np

import wsrender as ws
from wsrender.analyses.jobs import parse_job
from wsrender.client import AsyncJob, Job, RemoteResult

DOCUMENT = {"analysis": "workspace", "robot": {"library": "ur5e"}, "voxel_size_m": 0.05}

with ws.Client("http://lab:8000", token="secret", timeout_s=5.0, patience_s=60) as client:
    names: list[str] = [robot["name"] for robot in client.robots()]
    schemas = {analysis["id"]: analysis["schema"] for analysis in client.analyses()}
    busy: bool = any(worker["busy"] for worker in client.workers())
    sha256: str = client.upload_model(Path("arm.urdf"))
    more: str = client.upload_model(b"<mujoco/>", "robot.model")
    seconds: float | None = client.estimate(DOCUMENT)["seconds"]
    job = client.submit(DOCUMENT, labels={"of": "me"}, priority=1, timeout_s=60, idempotency_key="k1")
    typed: Job = client.submit(parse_job(DOCUMENT))
    arrays = client.submit({"analysis": "indices_at", "robot": "ur5e", "configurations": np.zeros((3, 6))})
    same: Job = client.job(job.id).refresh()
    newest = [each.id for each in client.jobs(state="queued", analysis="workspace", label=("of", "me"), limit=3)]
    done: bool = job.wait(progress=True, timeout=60.0, on_interrupt="cancel").finished
    fraction: float = (job.progress.get("fraction") or 0.0) + 0.5
    created: str = job.record["created_at"][:19]
    problem = job.error["detail"] if job.error else None
    result: RemoteResult = job.result()
    local: ws.Result = job.download("out", progress=True)
    value = result.to_xarray()["count"].sel(z=0.3, method="nearest")
    rows: int = len(result.to_pandas("map"))
    figure = result.plot.slice(z=0.3)
    kinds = {event["type"] for event in job.events(after="3")}
    state: str = job.cancel().state + job.retry().state
    job.delete()
    with client.batch(at_once=8, cancel=True) as batch:
        futures: list[Future[RemoteResult]] = [batch.submit(DOCUMENT, labels={"k": str(k)}) for k in range(3)]
    errors: dict[int, BaseException] = batch.errors
    with client.kinetostatic_stream("phantom_omni", field={"form": "potential"}, stale_after_s=0.3) as stream:
        period: float = stream.opened["period_s"]
        force: np.ndarray = stream.force()
        late: float = stream.exchange(np.zeros(3), scale="fine")["latency_s"]


async def awaited() -> RemoteResult:
    async with ws.AsyncClient("http://lab:8000") as client, client.batch(at_once=2) as batch:
        tasks = [batch.submit(DOCUMENT) for _ in range(3)]
        job: AsyncJob = await client.submit(DOCUMENT, labels={"of": "me"})
        async for each in client.jobs(state="running"):
            await each.cancel()
        async for event in job.events():
            print(event["data"])
        await asyncio.gather(*tasks)
        return await (await job.wait(timeout=3)).result()
