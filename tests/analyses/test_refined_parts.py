"""Parts of a refined measure under constraints."""

from wsrender.analyses import refined as entries
from wsrender.reach.measure_refinement import RefinedMeasure


def measure(value, undecided, undecided_ci95):
    ci95 = (value - 0.1, value + 0.1)
    return RefinedMeasure("area", value, ci95, "m2", "", True, undecided, 9, 1e-8, (), undecided_ci95)


def test_parts_are_free_blocked_by_reason_and_undecided(monkeypatch):
    found = {"free": measure(3.0, 0.2, (0.1, 0.4)), "blocked": measure(2.0, 0.5, (0.3, 0.6))}
    found["environment"] = measure(1.0, 0.7, (0.5, 0.8))
    monkeypatch.setattr(entries, "free_measures", lambda *_, **__: {"free": found})
    measured = entries.refined(None, 0.01, 0, "cpu", None, None, (object(),))
    area = entries.by_measure(measured, measured)["area_m2"]
    assert area["refined"]["value"] == 3.0 and "parts" not in area["refined"]
    assert area["free"] == {"value": 3.0, "ci95": [2.9, 3.1]}
    assert area["blocked"]["value"] == 2.0 and area["blocked"]["by"]["environment"]["ci95"] == [0.9, 1.1]
    assert area["undecided"] == {"value": 0.2, "ci95": [0.1, 0.4]}
