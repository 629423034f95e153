"""A few rounds of the soak: kill -9 of processes while six analyses run. All of it: ``python tests/long.py soak``."""

import pytest

from tests.server import soak


@pytest.mark.parametrize(("postgres", "rounds"), [(False, 2), (True, 1)])
def test_nothing_is_lost_and_nothing_is_left(postgres, rounds):
    figures = soak.kills(rounds, postgres, seed=3)
    assert soak.violations({"soak": figures}) == [] and sum(figures["killed"].values()) >= rounds


def test_small_jobs_leave_nothing_behind(monkeypatch):
    figures = soak.small_jobs(jobs=5, minutes=0.1, settled=0.0)
    assert figures["jobs"] == {"succeeded": 5}


@pytest.mark.parametrize("name", soak.ALLOWED)
def test_growth_is_a_violation(name):
    taken = {name: [1.0, 1.0] for name in soak.ALLOWED}
    assert soak.violations({"hour": {"jobs": {"succeeded": 3}, "taken": taken}}) == []
    assert len(soak.violations({"hour": {"taken": taken | {name: [1000.0, 1500.0]}}})) == 1
    assert soak.violations({"hour": {"jobs": {"succeeded": 3, "failed": 1}, "taken": taken}})
