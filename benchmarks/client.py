"""Small jobs through `wsrender.Client`, beside the same by plain HTTP, in turns against one server.

    python benchmarks/client.py [--jobs 1000] [--round 10]

A job is submitted, waited for, and its result document fetched; by plain HTTP these are three requests on a kept
connection, with nothing read but state and document. Rounds of so many jobs alternate; no two jobs are equal, so that
none is answered from the cache. Prints the time of a job [ms] of both, and the ratio, which should be at most 1.5; the
same of eight jobs at once, by `Client.batch` and by plain HTTP in eight threads; and of one job again and again, which
is answered from the cache, so that what the client itself costs shows most.
"""

import argparse
import json
import os
import tempfile
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from itertools import count, islice
from pathlib import Path
from typing import Any

import httpx2
import numpy as np
from wsrender_server.local_server import LocalServer

import wsrender as ws

AT_ONCE = 8
GOAL = 1.5
WAIT_S = 60


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--jobs", type=int, default=1000, help="of each way")
    options.add_argument("--round", type=int, default=10, help="jobs of one way before the other has its turn")
    asked = options.parse_args()
    print_report(measured(asked.jobs, asked.round))


def measured(jobs: int, each_round: int) -> dict[str, list[float]]:
    """Times [s] of a job, by way, one number a round."""
    with (
        tempfile.TemporaryDirectory() as data,
        LocalServer(Path(data)) as server,
        ws.Client(server.url) as client,
        httpx2.Client(base_url=server.url, timeout=2 * WAIT_S) as http,
    ):
        documents = small_jobs()
        ways: dict[str, Callable[[list[dict[str, Any]]], None]] = {
            "plain": lambda round: one_by_one(lambda job: plain(http, job), round),
            "client": lambda round: one_by_one(lambda job: through(client, job), round),
            "plain, cached": lambda round: one_by_one(lambda job: plain(http, job), round),
            "client, cached": lambda round: one_by_one(lambda job: through(client, job), round),
            "plain, at once": lambda round: threads(lambda job: plain(http, job), round),
            "client, at once": lambda round: batch(client, round),
        }
        for way in ways.values():  # kernels compiled, connections open
            way(list(islice(documents, AT_ONCE)))
        cached = next(documents)
        through(client, cached)
        times: dict[str, list[float]] = {name: [] for name in ways}
        for _ in range(max(1, jobs // each_round)):
            for name, way in ways.items():
                round = [cached] * each_round if name.endswith("cached") else list(islice(documents, each_round))
                started = time.perf_counter()
                way(round)
                times[name].append((time.perf_counter() - started) / each_round)
    return times


def small_jobs() -> Iterator[dict[str, Any]]:
    """Jobs of one configuration, each another."""
    for number in count():
        yield {
            "analysis": "indices_at",
            "robot": {"library": "scara"},
            "indices": ["manipulability"],
            "configurations": [[1e-6 * number, 0.5, 0.0, 0.0]],
        }


def plain(http: httpx2.Client, job: dict[str, Any]) -> dict[str, Any]:
    """The result document of a job, by three requests, or more where it takes long."""
    answer = http.post("/v1/jobs", json=job).raise_for_status().json()
    path = f"/v1/jobs/{answer['id']}"
    while answer["state"] in ("queued", "running"):
        answer = http.get(path, params={"wait": WAIT_S}).raise_for_status().json()
    return http.get(f"{path}/result").raise_for_status().json()


def through(client: ws.Client, job: dict[str, Any]) -> dict[str, Any]:
    """The same by the client."""
    return client.submit(job).result().document


def one_by_one(run: Callable[[dict[str, Any]], object], round: list[dict[str, Any]]) -> None:
    for job in round:
        run(job)


def threads(run: Callable[[dict[str, Any]], object], round: list[dict[str, Any]]) -> None:
    with ThreadPoolExecutor(AT_ONCE) as pool:
        list(pool.map(run, round))


def batch(client: ws.Client, round: list[dict[str, Any]]) -> None:
    with client.batch(at_once=AT_ONCE) as jobs:
        for job in round:
            jobs.submit(job)


def print_report(times: dict[str, list[float]]) -> None:
    """Print medians of the rounds, and of the ratios within a round, which the machine's other work moves least."""
    ratios = {name: ratio(times, name) for name in times if name.startswith("client")}
    report = {
        "cores": os.cpu_count(),
        "load": round(os.getloadavg()[0], 1),
        "rounds": len(times["plain"]),
        "ms of a job": {name: round(1e3 * float(np.median(values)), 2) for name, values in times.items()},
        "ratios to plain HTTP": {name: round(value, 3) for name, value in ratios.items()},
    }
    print(json.dumps(report, indent=2))
    print(f"client: {ratios['client']:.2f} of plain HTTP, {'within' if ratios['client'] <= GOAL else 'above'} {GOAL}")


def ratio(times: dict[str, list[float]], name: str) -> float:
    """Of a way of the client to plain HTTP of the same kind, median of the rounds."""
    return float(np.median(np.array(times[name]) / np.array(times[name.replace("client", "plain")])))


if __name__ == "__main__":
    main()
