"""Self-motions of tests/long.py, of few poses and values, and what is beyond its bounds."""

from tests.reach.self_motion_sweeps import Sweep, sweep, violations


def test_a_dense_sweep_finds_no_posture_beside_the_curves():
    found = sweep("random arm", 2, 256)
    assert found.swept > 100 and found.curves > 2 and not violations({"random arm": found})


def test_what_is_beyond_its_bounds_is_told():
    told = {"a": Sweep(1, 4, 1e-9, 100, 0), "b": Sweep(1, 4, 1e-7, 100, 2)}
    assert violations(told) == ["b: 2 postures on no curve", "b: points 1e-07 off the pose"]
