"""Poses of tests/long.py, a few of them, and what is beyond its bounds."""

from tests.engine.closed_form_poses import tallies, violations


def test_what_is_called_unreachable_or_lacks_its_posture_is_told():
    fine = tallies("axes 2 and 3 parallel", arms=2, poses=2000)
    assert fine == {"poses": 4000, "unreachable": 0, "missed": 0}
    wrong, lacking = fine | {"unreachable": 1}, fine | {"missed": 1}
    told = violations({"a": fine, "b": wrong, "c": lacking})
    assert [each.split(",")[0] for each in told] == [
        "b: 1 called unreachable",
        "c: 1 without the configuration that made them",
    ]
