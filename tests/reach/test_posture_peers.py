"""All postures of a few poses beside those of EAIK and ssik, where they are installed; more in tests/long.py."""

import pytest

from tests.reach.posture_peers import PARTS, Agreement, violations

POSES = 40


@pytest.mark.parametrize("part", PARTS)
def test_postures_are_those_of_eaik_and_ssik(part):
    assert not violations({part: PARTS[part](count=POSES)})


def test_what_differs_is_told():
    fine = Agreement(100, 98)
    told = {"a": fine, "b": Agreement(100, 98, 1, 2, 3), "c": Agreement(100, 90)}
    assert violations(told) == [
        "b: 1 missing",
        "b: 2 more",
        "b: 3 of other windings",
        "c: 90 of 100 sets compared",
    ]
