"""How many rejected solutions it takes until a target is blocked, and when the search ends before that."""

from types import SimpleNamespace

import numpy as np
import pytest

from wsrender.engine import Tries
from wsrender.reach.admissible_search import BLOCKED, AdmissibleSearch
from wsrender.reach.evidence import UNDECIDED

AT_FIRST, IN_ALL = 1 + 7 + 1 + 24, 1 + 7 + 1 + 24 + 32 + 96  # tries until the first look for what is clear, and at most


def searched(near_m, solutions):
    """Label and tries of one pose that so many tries reach, all rejected, in an arm of reach 1 m."""
    asked = []

    def tries(starts, position, orientation):
        reached = len(asked) + np.arange(len(starts)) < solutions
        asked.extend(reached)
        none = np.zeros(len(starts))
        return Tries(starts, none, none, reached, ~reached)

    chain = SimpleNamespace(n=1, reach=1.0)
    nothing = SimpleNamespace(
        q=np.zeros((1, 1)),
        label=np.full(1, UNDECIDED),
        distance_m=np.ones(1),
        angle_rad=np.ones(1),
        proven=np.zeros(1, bool),
    )
    solver = SimpleNamespace(
        chain=chain, whole=chain, kind="position", seed=0, closed=None, tries=tries,
        features=lambda position, orientation: position,
        features_at=lambda q: np.tile([near_m, 0.0, 0.0], (len(q), 1)), solve=lambda *_: nothing,
    )  # fmt: skip
    admission = SimpleNamespace(names=("some",), rejected=lambda q, targets: np.ones(len(q), np.int8))
    admission.among = lambda batch: admission
    search = AdmissibleSearch(solver, admission)
    search.__dict__ |= {"samples": (np.zeros((64, 1)), np.zeros((64, 3))), "_further": np.zeros((128, 1))}
    return search.decide(np.zeros((1, 3)), np.zeros((1, 3))).label[0], len(asked)


@pytest.mark.parametrize("near_m", [0.01, 0.5])
def test_eight_rejected_solutions_block_a_target_after_all_starts(near_m):
    assert searched(near_m, 7) == (UNDECIDED, IN_ALL)
    assert searched(near_m, 8) == (BLOCKED, IN_ALL)


def test_24_block_it_at_once_where_nothing_admitted_is_nearer_than_a_tenth_of_the_reach():
    assert searched(0.101, 24) == (BLOCKED, AT_FIRST)
    assert searched(0.101, 23) == searched(0.099, 24) == (BLOCKED, IN_ALL)
