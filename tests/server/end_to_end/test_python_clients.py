"""A walk with asyncio's client against a live server; jobs that another session goes on with; bytes of a plane."""

import asyncio
import os
import subprocess
import sys

import numpy as np
import pytest

import wsrender as ws
from tests.server.end_to_end.acceptance import LONG, PATIENCE_S, QUICK, assert_same_files, assert_same_result

SUBMIT = """
import os, signal, sys
import wsrender as ws
client = ws.Client(sys.argv[1])
print(client.submit({document!r}, labels={{"session": "one"}}).id, flush=True)
os.kill(os.getpid(), signal.SIGKILL)
"""


def test_a_walk_with_asyncio(server, quick_local, tmp_path):
    local, folder = quick_local

    async def walk():
        async with ws.AsyncClient(server.url) as client:
            assert {robot["name"] for robot in await client.robots()} >= {"ur5e", "scara"}
            assert "workspace" in [analysis["id"] for analysis in await client.analyses()]
            estimate = await client.estimate(QUICK)
            assert estimate["valid"] and estimate["samples"] == QUICK["sampling"]["count"]
            job = await client.submit(QUICK, labels={"walk": "async"})
            assert (await job.wait(progress=True, timeout=PATIENCE_S)).state == "succeeded"
            events = [event async for event in job.events()]
            assert (events[-1]["type"], events[-1]["data"]["state"]) == ("state", "succeeded")
            assert [each.id async for each in client.jobs(label=("walk", "async"))] == [job.id]
            result = await job.download(tmp_path / "out", progress=True)
            assert_same_result(result, local)
            assert result.volume is not None  # of the files that were saved
            long = await client.submit(LONG)
            assert (await long.cancel()).state in ("canceling", "canceled")
            assert (await long.wait(timeout=PATIENCE_S)).state == "canceled"
            with pytest.raises(ws.JobFailedError, match="canceled"):
                await long.result()
            await long.delete()
            with pytest.raises(ws.NotFoundError):
                await client.job(long.id)

    asyncio.run(walk())
    assert_same_files(tmp_path / "out", folder)


def test_many_at_once_with_asyncio(server):
    async def together():
        async with ws.AsyncClient(server.url) as client:
            jobs = [{"analysis": "indices_at", "robot": "ur5e", "configurations": [[0.1 * k] * 6]} for k in range(6)]
            jobs[4] = {**jobs[4], "robot": "no_such_robot"}
            with pytest.raises(ExceptionGroup, match="1 of 6 jobs") as raised:
                async with client.batch(at_once=3) as batch:
                    tasks = [batch.submit(job) for job in jobs]
            (error,) = raised.value.exceptions
            assert isinstance(error, ws.DocumentError) and error.__notes__ == ["job 4 of the batch"]
            assert batch.errors == {4: error}
            for k, task in enumerate(tasks):
                assert k == 4 or task.result().document["job"]["configurations"] == jobs[k]["configurations"]

    asyncio.run(together())


def test_another_session_goes_on_with_a_job_by_its_id(server, client, quick_local):
    document = {**QUICK, "sampling": {"method": "sobol", "count": 8192}}
    code = SUBMIT.format(document=document)
    first = subprocess.run(
        [sys.executable, "-c", code, server.url], capture_output=True, text=True, check=False, env=os.environ
    )
    job = client.job(first.stdout.strip())
    assert first.returncode < 0 and job.record["labels"] == {"session": "one"}
    result = job.result()
    assert result.document["sampling"]["samples"] == 8192
    assert client.job(job.id).result().document == result.document


def test_a_plane_of_voxels_is_not_the_whole_file(client):
    pytest.importorskip("xarray")
    many = {"method": "sobol", "count": 1 << 18}
    fine = {**QUICK, "sampling": many, "voxel_size_m": 0.02, "indices": ["manipulability", "isotropy"]}
    result = client.submit(fine).wait(timeout=PATIENCE_S).result()
    files = result.files
    files_read = []
    opened = files.opened
    files.opened = lambda name: files_read.append(opened(name)) or files_read[-1]
    with result.to_xarray() as voxels:
        plane = voxels["maximum_manipulability"].sel(z=0.3, method="nearest").load()
    (file,) = files_read
    assert 0 < file.bytes_read < files.records["volume.vtkhdf"]["bytes"] / 3
    expected = super(type(result), result).to_xarray()["maximum_manipulability"].sel(z=0.3, method="nearest")
    np.testing.assert_array_equal(plane, expected)
