"""Load of the job server: submissions at a fixed rate while events are followed and a job computes.

    python benchmarks/server_load.py [--rate 10] [--seconds 60] [--listeners 50]

Open loop: each submission starts when its time has come, whether or not the ones before it were answered, so that a
slow answer is not hidden by fewer questions. Prints the latency of ``POST /v1/jobs`` [ms]; the goal for p99 is 250 ms.
"""

import argparse
import json
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import httpx2
import numpy as np
from wsrender_server.local_server import LocalServer

import wsrender as ws
from wsrender.client import Job

QUICK = {
    "analysis": "workspace",
    "robot": {"library": "ur5e"},
    "indices": ["manipulability"],
    "voxel_size_m": 0.1,
    "refined_volume": None,
}
GOAL_MS = 250.0


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--rate", type=float, default=10.0, help="submissions per second")
    options.add_argument("--seconds", type=float, default=60.0)
    options.add_argument("--listeners", type=int, default=50, help="event streams open meanwhile")
    arguments = options.parse_args()
    with tempfile.TemporaryDirectory() as data, LocalServer(Path(data)) as server, ws.Client(server.url) as client:
        client.submit(job(seed=0)).wait()  # kernels compiled
        background = client.submit({**QUICK, "sampling": {"method": "sobol", "count": 10**10}})
        events = [0] * arguments.listeners
        for number in range(arguments.listeners):
            threading.Thread(target=listen, args=(server.url, background.id, events, number), daemon=True).start()
        wait_for(background, "running")
        latencies, statuses = submit_at(server.url, arguments.rate, arguments.seconds)
        print_report(latencies, statuses, events, arguments)
        background.cancel()


def job(seed: int) -> dict:
    """A small job, each seed another one."""
    return {**QUICK, "sampling": {"method": "random", "count": 1024, "seed": seed}}


def listen(url: str, job_id: str, events: list[int], number: int) -> None:
    """Count the events of a job until the server goes."""
    with ws.Client(url) as client:
        try:
            for _ in client.job(job_id).events():
                events[number] += 1
        except ws.WsrenderError:
            return


def wait_for(background: Job, state: str) -> None:
    """Wait until a job has a state."""
    while background.refresh().state != state:
        time.sleep(0.1)


def submit_at(url: str, rate: float, seconds: float) -> tuple[list[float], list[int]]:
    """Latency [s] from the moment each submission was due, and status of its answer."""
    count = round(rate * seconds)
    limits = httpx2.Limits(max_connections=count)
    with httpx2.Client(base_url=url, timeout=60.0, limits=limits) as http, ThreadPoolExecutor(min(count, 256)) as pool:
        started = time.perf_counter() + 0.1

        def submit(number: int) -> tuple[float, int]:
            due = started + number / rate
            answer = http.post("/v1/jobs", json=job(seed=number + 1))
            return time.perf_counter() - due, answer.status_code

        futures = []
        for number in range(count):
            time.sleep(max(0.0, started + number / rate - time.perf_counter()))
            futures.append(pool.submit(submit, number))
        answers = [future.result() for future in futures]
    return [latency for latency, _ in answers], [status for _, status in answers]


def print_report(latencies: list[float], statuses: list[int], events: list[int], arguments: argparse.Namespace) -> None:
    """Print what was measured."""
    p50, p95, p99 = np.percentile(np.array(latencies) * 1000, [50, 95, 99])
    report = {
        "submissions": len(latencies),
        "rate_per_s": arguments.rate,
        "answers": {str(status): statuses.count(status) for status in sorted(set(statuses))},
        "listeners": len(events),
        "events_per_listener": [min(events, default=0), max(events, default=0)],
        "post_jobs_ms": {"p50": round(p50, 1), "p95": round(p95, 1), "p99": round(p99, 1)},
        "worst_ms": round(max(latencies) * 1000, 1),
    }
    print(json.dumps(report, indent=2))
    print(f"p99 {p99:.0f} ms: {'within' if p99 <= GOAL_MS else 'above'} the goal of {GOAL_MS:.0f} ms")


if __name__ == "__main__":
    main()
