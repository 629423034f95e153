"""Proofs that poses are out of reach against a search, few of those of tests/long.py, and what is beyond its bounds."""

import pytest

from tests.reach.refutations import ARMS, Refutations, refutations, violations


@pytest.mark.parametrize("arm", ["gao_6r", "three parallel axes", "general arm", "kuka_iiwa14"])
def test_a_search_refutes_no_proof(arm):
    assert arm in ARMS and not violations({arm: refutations(arm, 2000)})


def test_what_is_beyond_its_bounds_is_told():
    told = {"a": Refutations(100, 50, 0), "b": Refutations(100, 50, 1), "c": Refutations(100, 4, 0)}
    assert violations(told) == ["b: 1 proofs refuted", "c: few proofs"]
