"""Load of the job server while a job computes, with an empty FastAPI application's figures of the same run beside.

    python benchmarks/server_load.py [--submissions 200] [--listeners 200] [--queued 10000] [--seconds 20]

Measures, in this order: requests on a kept connection; the force stream beside a bare echo; submissions all at once,
five times beside as many requests to the empty application (the best of the five; and p99 of each); event streams; a
page of the list of jobs while many are queued; a job document of 15 MiB, with `/healthz` asked meanwhile and the memory
that is kept after it, of the server and its own children; kernels are those of workers. Prints all [ms] and [MiB] with
the goals, which are for an idle machine.
"""

import argparse
import asyncio
import json
import multiprocessing
import os
import socket
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from operator import itemgetter
from pathlib import Path
from urllib.parse import urlsplit

import httpx2
import numpy as np
import psutil
from kinetostatic_stream import computing, echo_server, measured, trajectory
from websockets.sync.client import connect
from wsrender_server.local_server import LocalServer

import wsrender as ws

QUICK = {
    "analysis": "workspace",
    "robot": {"library": "ur5e"},
    "indices": ["manipulability"],
    "voxel_size_m": 0.1,
    "refined_volume": None,
}
ROW = "[0.1,0.25]"
TURNS = 5
LONG_BYTES = 15 * 2**20
JSON = {"Content-Type": "application/json"}
GOALS = {
    "submissions_ms.p99": 250.0,
    "get_job_ms.p50": 2.0,
    "page_of_queued_ms.p50": 50.0,
    "long_document.accepted_s": 3.0,
    "long_document.healthz_ms.p99": 50.0,
    "long_document.kept_MiB": 100.0,
}


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--submissions", type=int, default=200, help="at once")
    options.add_argument("--listeners", type=int, default=200, help="event streams")
    options.add_argument("--queued", type=int, default=10_000, help="jobs that wait while a page is asked for")
    options.add_argument("--requests", type=int, default=500, help="on a kept connection")
    options.add_argument("--seconds", type=float, default=20.0, help="of the force stream")
    asked = options.parse_args()
    os.environ["WSRENDER_MAX_QUEUED_PER_OWNER"] = str(asked.queued + TURNS * asked.submissions + 100)
    with (
        tempfile.TemporaryDirectory() as data,
        LocalServer(Path(data)) as server,
        ws.Client(server.url) as client,
        empty_server() as empty,
    ):
        client.submit(job(seed=0)).wait()  # kernels compiled
        background = computing(client)
        report = {"cores": os.cpu_count(), "load": os.getloadavg()[0]}
        with httpx2.Client(base_url=server.url, timeout=60) as http, httpx2.Client(base_url=empty, timeout=60) as bare:
            path = f"/v1/jobs/{background.id}"
            report["get_job_ms"] = timed(lambda: http.get(path), asked.requests)
            report["empty_get_ms"] = timed(lambda: bare.get("/"), asked.requests)
            report |= force_stream(client, asked.seconds)
            report |= submissions(server.url, empty, asked.submissions)
            report["listeners"] = listened(server.url, background.id, asked.listeners)
            queue(http, asked.queued)
            report["page_of_queued_ms"] = timed(lambda: http.get("/v1/jobs", params={"limit": 100}), 50)
            report["long_document"] = long_document(server)
        background.cancel()
    print_report(report)


def job(seed: int) -> dict:
    """A small job, each seed another one."""
    return {**QUICK, "sampling": {"method": "random", "count": 1024, "seed": seed}}


@contextmanager
def empty_server() -> Iterator[str]:
    """A FastAPI application that does nothing, under the same server, in a process of its own; its URL."""
    listener = socket.create_server(("127.0.0.1", 0))
    process = multiprocessing.get_context("fork").Process(target=serve_nothing, args=(listener,), daemon=True)
    process.start()
    try:
        yield f"http://127.0.0.1:{listener.getsockname()[1]}"
    finally:
        process.terminate()


def serve_nothing(listener: socket.socket) -> None:
    import uvicorn
    from fastapi import FastAPI

    app = FastAPI()
    app.get("/")(nothing)
    app.post("/")(nothing)
    uvicorn.Server(uvicorn.Config(app, log_config=None, access_log=False)).run(
        sockets=[socket.socket(fileno=listener.detach(), proto=socket.IPPROTO_TCP)]
    )


async def nothing() -> dict:
    return {}


def percentiles(seconds: list[float]) -> dict[str, float]:
    """Of times [s], in milliseconds."""
    found = np.percentile(np.array(seconds) * 1e3, [50, 95, 99, 100])
    return {name: round(float(x), 2) for name, x in zip(("p50", "p95", "p99", "max"), found, strict=True)}


def timed(request: Callable[[], httpx2.Response], count: int) -> dict[str, float]:
    """Latencies of a request, one after the other."""
    seconds = []
    for _ in range(count):
        started = time.perf_counter()
        request().raise_for_status()
        seconds.append(time.perf_counter() - started)
    return percentiles(seconds)


def submissions(url: str, empty: str, count: int) -> dict[str, dict]:
    """Latencies of so many submissions at once, and of requests to the empty application, in turn."""
    times: dict[str, list[dict[str, float]]] = {"submissions_ms": [], "empty_submissions_ms": []}
    for turn in range(TURNS):
        bodies = [json.dumps(job(seed=turn * count + number + 1)).encode() for number in range(count)]
        times["submissions_ms"].append(at_once(url, "/v1/jobs", bodies))
        time.sleep(1)
        times["empty_submissions_ms"].append(at_once(empty, "/", bodies))
    return {
        name: min(found, key=itemgetter("p99")) | {"p99 of each turn": [each["p99"] for each in found]}
        for name, found in times.items()
    }


def at_once(url: str, path: str, bodies: list[bytes]) -> dict[str, float]:
    """Latencies of requests that begin at the same moment, each on a connection of its own, which it opens.

    They are written and read by one thread, as they are: a thread and a client for each took the time of a core,
    more than an empty application needs to answer them.
    """
    where = urlsplit(url)

    async def post(body: bytes) -> float:
        head = f"POST {path} HTTP/1.1\r\nHost: {where.netloc}\r\nContent-Type: application/json\r\n"
        started = time.perf_counter()
        reader, writer = await asyncio.open_connection(where.hostname, where.port)
        writer.write(f"{head}Content-Length: {len(body)}\r\n\r\n".encode() + body)
        answer = await reader.readuntil(b"\r\n\r\n")
        seconds = time.perf_counter() - started
        writer.close()
        if answer.split(b" ")[1] not in (b"200", b"202"):
            raise RuntimeError(answer.decode())
        return seconds

    async def post_all() -> list[float]:
        return await asyncio.gather(*map(post, bodies))

    return percentiles(asyncio.run(post_all()))


def force_stream(client: ws.Client, seconds: float) -> dict[str, dict[str, float]]:
    """Round trips of the stream of forces, less the wait for its tick, and of a bare echo."""
    robot = "phantom_omni"
    with (
        echo_server() as url,
        connect(url, compression=None) as echo,
        client.kinetostatic_stream(robot, stale_after_s=1.0) as stream,
    ):
        times = measured(stream, echo, trajectory(robot), seconds)
    stream_ms = times["stream"] - times["wait"]
    return {"force_stream_ms": percentiles(stream_ms / 1e3), "echo_ms": percentiles(times["echo"] / 1e3)}


def listened(url: str, job_id: str, count: int) -> dict[str, int]:
    """How many of so many event streams open at once have told something within half a minute."""
    heard = [0] * count

    def listen(number: int) -> None:
        ends = time.monotonic() + 30
        with ws.Client(url) as client:
            for _ in client.job(job_id).events():
                heard[number] += 1
                if heard[number] == 3 or time.monotonic() > ends:
                    return

    with ThreadPoolExecutor(count) as pool:
        list(pool.map(listen, range(count)))
    return {"streams": count, "that heard": sum(map(bool, heard))}


def queue(http: httpx2.Client, count: int) -> None:
    """Queue so many jobs."""
    for number in range(count):
        http.post("/v1/jobs", json=job(seed=10**6 + number)).raise_for_status()


def long_document(server: LocalServer) -> dict:
    """How long a job of 15 MiB takes to be accepted, what `/healthz` does meanwhile, and the memory kept."""
    rows = ",".join([ROW] * ((LONG_BYTES - 100) // (len(ROW) + 1)))
    text = '{"analysis":"indices_at","robot":{"library":"scara"},"configurations":[' + rows + "]}"
    before, seconds, end = memory(server), [], threading.Event()

    def watch() -> None:
        with httpx2.Client(base_url=server.url, timeout=60.0) as http:
            while not end.wait(0.01):
                started = time.perf_counter()
                http.get("/healthz").raise_for_status()
                seconds.append(time.perf_counter() - started)

    watching = threading.Thread(target=watch)
    watching.start()
    try:
        started = time.perf_counter()
        httpx2.post(server.url + "/v1/jobs", content=text, headers=JSON, timeout=600.0).raise_for_status()
        accepted = time.perf_counter() - started
    finally:
        end.set()
        watching.join()
    time.sleep(5)
    kept = max(memory(server) - before, 0) / 2**20
    return {"accepted_s": round(accepted, 2), "healthz_ms": percentiles(seconds), "kept_MiB": round(kept, 1)}


def memory(server: LocalServer) -> int:
    """Resident memory of the server and of its own children [bytes]; kernels run in those of a worker."""
    process = psutil.Process(server.process.pid)
    return sum(each.memory_info().rss for each in (process, *process.children()))


def print_report(report: dict) -> None:
    """Print what was measured, and how it stands to the goals."""
    print(json.dumps(report, indent=2))
    for name, goal in GOALS.items():
        value = report
        for part in name.split("."):
            value = value[part]
        print(f"{name}: {value:g}, {'within' if value <= goal else 'above'} the goal of {goal:g}")


if __name__ == "__main__":
    main()
