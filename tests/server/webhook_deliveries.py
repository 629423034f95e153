"""Webhooks of jobs whose receiver fails at random, while their server is killed: each state comes at least once.

``PARTS`` and ``violations`` make it a long measurement.
"""

import json
import os
import random
import tempfile
from collections import Counter, defaultdict
from contextlib import closing
from datetime import UTC, datetime
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any
from unittest.mock import patch

import httpx2
from standardwebhooks import Webhook as Verifier
from wsrender_server.jobs.store import open_store
from wsrender_server.local_server import LocalServer
from wsrender_server.settings import Settings

from tests.server.jobs.receiver import Receiver, receiver
from tests.server.jobs.waiting import wait_until

JOBS, KILLS = 334, 5  # each job is queued, runs and succeeds: 1,000 deliveries
FAILURES = (302, 404, 429, 500, 503, None)  # None: the connection ends without an answer
FAILING = 0.4  # of the attempts
PATIENCE_S = 1200.0


def deliveries(jobs: int = JOBS, kills: int = KILLS, seed: int = 0) -> dict[str, Any]:
    """Figures of so many jobs, which come in between kills of the server and of all that it has started."""
    rng = random.Random(seed)
    with tempfile.TemporaryDirectory(prefix="wsrender-webhooks-") as folder, receiver(partial(_answer, rng)) as here:
        data = Path(folder) / "data"
        allowed = {"TARGETS": here.url, "NETWORKS": "127.0.0.1", "RETRY_S": "0.2"}
        variables = {f"WSRENDER_WEBHOOK_{name}": value for name, value in allowed.items()}
        with patch.dict(os.environ, variables), LocalServer(data) as server:
            asked = {"url": here.url, "states": ["queued", "running", "succeeded", "failed"]}
            webhook = _post(server, "webhooks", asked)
            ids: list[str] = []
            for part in range(kills + 1):
                for number in range(part * jobs // (kills + 1), (part + 1) * jobs // (kills + 1)):
                    ids.append(_post(server, "jobs", _small(number))["id"])
                if part < kills:
                    more = len(here.got) + rng.randint(1, 3 * jobs // (kills + 1))  # of those that come in any case
                    wait_until(lambda more=more: len(here.got) >= more, PATIENCE_S, "a part of the deliveries")
                    server.kill_all()
                    server.start()
            wait_until(lambda: _done(server, webhook["id"], ids), PATIENCE_S, "the last delivery")
        with closing(open_store(Settings(data_dir=data))) as store:
            news = {job: store.news("local", job, 0)[1] for job in ids}
    states = {
        (job, event.id, event.data["state"])
        for job, of_job in news.items()
        for event in of_job
        if event.type == "state"
    }
    return _figures(here, states, webhook["secret"])


def _figures(here: Receiver, states: set[tuple[str, int, str]], secret: str) -> dict[str, Any]:
    """What came of the states that the store knows of."""
    ids, accepted, unverified = defaultdict(set), set(), 0
    told: dict[str, dict[int, str]] = defaultdict(dict)
    for headers, body in here.got:
        message, message_id = json.loads(body), headers["webhook-id"]
        job = message["data"]
        state = (job["id"], job["event"], job["state"])
        ids[state].add((message_id, body))
        told[job["id"]][job["event"]] = message["timestamp"]
        accepted |= {state} if message_id in here.accepted else set()
        at = datetime.fromtimestamp(int(headers["webhook-timestamp"]), UTC)
        unverified += Verifier(secret).sign(message_id, at, body.decode()) != headers["webhook-signature"]
    return {
        "states": len(states),
        "attempts": len(here.got),
        "attempts of one message": max(Counter(headers["webhook-id"] for headers, _ in here.got).values()),
        "not delivered": len(states - accepted),
        "of no state": len(set(ids) - states),
        "with several ids": sum(len(each) > 1 for each in ids.values()),
        "out of order by timestamp": sum(_disordered(of_job) for of_job in told.values()),
        "not verified": unverified,
    }


def _disordered(timestamps: dict[int, str]) -> bool:
    """Whether timestamps of a job, by event, are not in its order."""
    in_order = [timestamps[event] for event in sorted(timestamps)]
    return any(later <= earlier for earlier, later in pairwise(in_order))


def violations(figures: dict[str, dict[str, Any]]) -> list[str]:
    """What is not as it is to be."""
    found = []
    for part, each in figures.items():
        found += [f"{part}: {each[name]} {name}" for name in list(each)[3:] if each[name]]
        if each["attempts"] <= each["states"]:
            found.append(f"{part}: no attempt has failed")
    return found


PARTS = {"webhooks_1000": deliveries}
TOO_LONG = frozenset(PARTS)  # to be among those that are chosen at random


def _answer(rng: random.Random) -> int:
    failure = rng.choice(FAILURES) if rng.random() < FAILING else 204
    if failure is None:
        raise ConnectionError("no answer")
    return failure


def _small(number: int) -> dict[str, Any]:
    """A job that no other one is equal to."""
    return {
        "analysis": "indices_at",
        "robot": {"library": "scara"},
        "configurations": [[0.1 + 1e-6 * number, 0.2, 0.05, 0.3]],
        "device": "cpu",
    }


def _post(server: LocalServer, what: str, body: dict[str, Any]) -> dict[str, Any]:
    answer = httpx2.post(f"{server.url}/v1/{what}", json=body, timeout=60)
    assert answer.status_code in (200, 201, 202), answer.text
    return answer.json()


def _done(server: LocalServer, webhook: str, ids: list[str]) -> bool:
    """Whether all jobs have succeeded, and nothing waits to be told."""
    jobs = httpx2.get(f"{server.url}/v1/queue", timeout=60).json()["jobs"]
    waiting = httpx2.get(f"{server.url}/v1/webhooks/{webhook}", timeout=60).json()["waiting"]
    return jobs.get("succeeded", 0) + jobs.get("failed", 0) == len(ids) and waiting == 0
