"""What a result says of its origin is what the plan settled, in every analysis."""

from dataclasses import replace

import pytest

from tests.run.small_jobs import SAMPLING, SCARAS, SMALL_JOBS
from wsrender.analyses import provenance
from wsrender.run import execute, finish, plan, run_shard

TARGET = "cpu:a machine of its own"
# Workspaces of float32 are settled in float64 here, the others the other way round, so that no default passes.
PRECISIONS = {
    "workspace": "float64",
    "shared_workspace": "float64",
    "robot_comparison": "float64",
    "indices_at": "float32",
    "reachability": "float32",
    "capability": "float32",
    "base_placement": "float32",
    "inverse_reachability": "float32",
    "two_arm_placement": "float32",
    "parallel_workspace": "float32",
    "design_optimization": "float32",
}
SEEDS = {
    "workspace": 0,
    "reachability": 3,
    "base_placement": 3,
    "inverse_reachability": 6,
    "two_arm_placement": 11,
    "postures": 9,
    "capability": 4,
    "collaborative_volume": 5,
    "parallel_workspace": 6,
    "planar_boundary": 7,
    "kinetostatic_field": 8,
}
PATHS = {"workspace", "shared_workspace", "robot_comparison"}


def targeted(planned):
    """The plan, made for another target."""
    for each in [planned, *(planned.several.plans if hasattr(planned, "several") else [])]:
        each.settled = replace(each.settled, target=TARGET)
    return planned


def paths_of(resolved):
    return [each["sampling_path"] for each in resolved.get("robots", [resolved])]


@pytest.mark.parametrize("analysis", SMALL_JOBS)
def test_provenance_is_what_the_plan_settled(analysis):
    planned = targeted(plan(SMALL_JOBS[analysis]))
    found = finish(planned, run_shard(planned, 0)).document["provenance"]
    assert found["target"] == planned.target == TARGET
    assert found["precision"] == PRECISIONS.get(analysis, "float64")
    assert {"seed": found.get("seed")} == {"seed": SEEDS.get(analysis)}
    assert ("sampling_path" in found) == (analysis in PATHS)
    if analysis in PATHS:
        assert {found["sampling_path"]} == {*paths_of(planned.resolved())} == {"collapsed"}


@pytest.mark.parametrize("analysis", ["shared_workspace", "robot_comparison"])
def test_robots_that_are_sampled_in_different_ways_say_each(analysis):
    robots = [SCARAS[0], {**SCARAS[1], "sampling": SAMPLING}]
    document = {**SMALL_JOBS[analysis], "robots": robots, "refined_volume": None}
    document.pop("scan", None)
    planned = plan(document)
    assert paths_of(planned.resolved()) == ["collapsed", "direct"]
    assert finish(planned, run_shard(planned, 0)).document["provenance"]["sampling_path"] == "collapsed, direct"


def test_the_seed_of_a_workspace_is_that_of_its_sampling():
    document = {**SMALL_JOBS["workspace"], "sampling": {**SAMPLING, "seed": 11}, "refined_volume": None}
    assert execute(document).document["provenance"]["seed"] == 11


def test_exact_designs_are_float64_and_have_the_seed_of_their_search():
    document = {
        "analysis": "design_optimization",
        "design": {"analysis": "parallel_workspace", "mechanism": "six_pus", "precision": "float32", "device": "cpu"},
        "parameters": [{"name": "link", "pointers": ["/mechanism/link_m"], "bounds": [2.3, 2.5]}],
        "objectives": [{"value": "exact_volume"}],
        "search": {"method": "differential_evolution", "population": 5, "generations": 1, "seed": 12, "refine": False},
    }
    found = execute(document).document["provenance"]
    assert (found["precision"], found["seed"]) == ("float64", 12)


def test_versions_are_looked_up_once(monkeypatch):
    looked_up = []

    def version(package):
        looked_up.append(package)
        return "1.0"

    monkeypatch.setattr(provenance, "version", version)
    provenance._version.cache_clear()
    try:
        for _ in range(3):
            found = execute(SMALL_JOBS["indices_at"]).document["provenance"]
            assert {found[name] for name in ("warp-lang", "mujoco", "numpy")} == {"1.0"}
        assert sorted(looked_up) == ["mujoco", "numpy", "warp-lang"]
    finally:
        provenance._version.cache_clear()
