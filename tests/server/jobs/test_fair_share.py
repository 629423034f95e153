"""Owners take turns in the queue."""

import random
from collections import Counter

from wsrender_server.jobs.fair_share import FairShare
from wsrender_server.jobs.service import JobService
from wsrender_server.settings import Settings

from tests.server.jobs.documents import canonical
from tests.server.jobs.waiting import ended, wait_until


def served(arrivals, steps):
    """Owners in the order in which they are served: ``arrivals`` before each step, the lowest turn at each."""
    share, queue, order = FairShare(), [], []
    for step in range(steps):
        for number, owner in enumerate(arrivals.get(step, [])):
            queue.append((share.turn(owner), step, number, owner))
        if queue:
            queue.sort()
            turn, *_, owner = queue.pop(0)
            share.begun(turn)
            order.append(owner)
    return order


def test_owners_take_turns_whoever_was_first():
    order = served({0: ["ann"] * 6, 2: ["bob"] * 2, 4: ["eve"]}, 9)
    assert order == ["ann", "ann", "ann", "bob", "ann", "bob", "eve", "ann", "ann"]


def test_nobody_starves_and_nobody_saves_up():
    """A steady stream of others: who waits is served every other time; who was away gets no more than that."""
    order = served({0: ["ann"] * 50} | {step: ["bob"] for step in range(5, 200)}, 100)
    assert Counter(order[10:90])["ann"] == 40
    order = served({step: ["ann"] for step in range(100)} | {100: ["ann"] * 20 + ["bob"] * 20}, 140)
    assert abs(order[100:120].count("bob") - 10) <= 1


def test_shares_are_equal_while_all_have_work():
    """Against any arrivals: over a stretch in which both wait, they differ by one at most."""
    rng = random.Random(1)
    for _ in range(50):
        arrivals = {0: rng.choices(["ann", "bob"], weights=[9, 1], k=200) + ["bob"] * 30}
        first = served(arrivals, 40)
        assert abs(first.count("ann") - first.count("bob")) <= 2


def test_a_job_does_not_wait_for_the_backlog_of_another_owner(tmp_path):
    settings = Settings(data_dir=tmp_path / "data")
    with JobService(settings) as service:
        store = service.store
        documents = [canonical(sampling={"method": "random", "count": 64 + i, "seed": 1}) for i in range(8)]
        backlog = [store.submit("ann", document).job.id for document in documents[:7]]
        wait_until(lambda: store.get("ann", backlog[0]).started_at is not None, what="the start")
        late = store.submit("bob", documents[7]).job.id
        assert ended(store, late, "bob").state == "succeeded"
        assert sum(store.get("ann", job).finished_at is not None for job in backlog) <= 4
