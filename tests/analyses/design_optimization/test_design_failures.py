"""Designs that fail, that are empty, or that nobody can find in a result: what a search makes of them."""

from functools import reduce

import numpy as np
import pytest

import wsrender as ws
from wsrender.analyses.design_optimization import values as design_values
from wsrender.analyses.jobs import canonical_json, parse_job
from wsrender.errors import NotConvergedError, NumericalError
from wsrender.run import finish, merge, plan, run_shard, steps

VOLUME = [{"value": "exact_volume"}]
AREA = [{"value": "/exact/area_m2"}]


def turn_and_slide(**changes):
    """A planar arm that turns by −45 … 45° and slides by 5 … 8 m: area ½ (8² − 5²) × angle."""
    rows = [
        {"alpha_deg": 90, "theta_deg": 90, "limits_deg": [-45, 45]},
        {"joint": "prismatic", "d": 5.0, "limits": [0, 3]},
    ]
    return {
        "analysis": "planar_boundary",
        "robot": {"dh": {"convention": "standard", "rows": rows}},
        "sampling": {"method": "random", "count": 2000},
        "device": "cpu",
        **changes,
    }


def upper_limit(*bounds):
    return [{"name": "upper", "pointers": "/robot/dh/rows/0/limits_deg/1", "bounds": list(bounds)}]


def swept(design, parameters, objectives, steps=3, **fields):
    return ws.design_optimization(design, parameters, objectives, search={"method": "sweep", "steps": steps}, **fields)


def balls(distance=1.0, length=1.0):
    """Two legs of at most ``length``, their bases so far apart: two balls, which meet below twice that."""
    legs = [
        {"type": "UPS", "base_m": [x, 0, 0], "platform_m": [0, 0, 0], "length_m": [0, length]} for x in (0, distance)
    ]
    return {"analysis": "parallel_workspace", "mechanism": {"legs": legs}, "device": "cpu"}


def distance(*bounds):
    return [{"name": "distance", "pointers": "/mechanism/legs/1/base_m/0", "bounds": list(bounds)}]


def lens(d):
    """Volume common to two unit balls."""
    return np.pi * (4 + d) * (2 - d) ** 2 / 12


def codes(result):
    return [warning["code"] for warning in result.document["warnings"]]


def test_pointers_refer_to_the_document_as_it_was_written():
    found = swept(turn_and_slide(), upper_limit(0, 90), AREA)
    expected = 39 / 2 * np.radians([45, 90, 135])
    assert found.tables["sweep"]["exact_area"] == pytest.approx(expected, rel=1e-9)
    best = found.document["best"]
    assert best["design"]["robot"]["dh"]["rows"][0]["limits_deg"] == [-45, 90]
    again = ws.execute(best["design"])
    assert again.document["exact"]["area_m2"] == pytest.approx(expected[2], rel=1e-9)


def test_a_job_in_words_of_its_own_is_read_back_and_may_name_defaults():
    job = turn_and_slide()
    pointers = ["/robot/dh/rows/0/alpha_deg", "/robot/dh/rows/0/a", "/robot/dh/rows/1/limits/1", "/sampling/seed"]
    document = {
        "analysis": "design_optimization",
        "design": job,
        "parameters": [{"name": f"p{k}", "pointers": p, "bounds": [1, 90]} for k, p in enumerate(pointers)],
        "objectives": AREA,
    }
    parsed = parse_job(document)
    row = {"alpha_deg": 90, "theta_deg": 90, "limits_deg": [-45, 45], "a": 0.0}
    assert parsed.design_document["robot"]["dh"]["rows"][0] == row
    text = canonical_json(parsed)
    assert canonical_json(parse_job(text)) == text
    document["parameters"] = [{"name": "p", "pointers": [pointers[0], "/robot/dh/rows/0/alpha"], "bounds": [1, 90]}]
    with pytest.raises(ws.DocumentError, match=r"rows.0.alpha_deg: must not be given together with .alpha."):
        parse_job(document)
    document["parameters"] = [{"name": "p", "pointers": "/robot/dh/rows/1/alpha_deg", "bounds": [1, 90]}]
    with pytest.raises(ws.DocumentError, match=r"parameters.0.pointers.0: must point to a number.* not None"):
        parse_job(document)


@pytest.mark.parametrize(
    ("error", "code", "reason"),
    [
        (NotConvergedError("the iteration did not settle", []), "not_converged", "the iteration did not settle"),
        (NumericalError("nan in a kernel"), "numerical_fault", "nan in a kernel"),
        (MemoryError("33 GiB"), "resource_limit", r"design: needs more memory than there is \(33 GiB\)"),
    ],
)
def test_a_design_that_fails_is_infeasible_and_the_search_goes_on(monkeypatch, error, code, reason):
    execute = steps.execute

    def failing(job, *args, **execution):
        if getattr(job, "analysis", "") == "planar_boundary" and job.robot.dh.rows[0].limits[1] > 1.5:
            raise error
        return execute(job, *args, **execution)

    monkeypatch.setattr(steps, "execute", failing)
    found = swept(turn_and_slide(), upper_limit(0, 90), AREA)
    assert np.isfinite(found.tables["sweep"]["exact_area"]).tolist() == [True, True, False]
    assert found.document["best"]["parameters"] == {"upper": 45}
    (fault,) = found.document["search"]["faults"]
    assert fault["code"] == code and fault["designs"] == 1 and fault["parameters"] == {"upper": 90}
    assert codes(found) == ["designs_failed"] and found.document["search"]["without_value"] == 1
    with pytest.raises(ws.WsrenderError, match=reason):  # of a search in which no design has a value
        swept(turn_and_slide(), upper_limit(89, 90), AREA)


def test_a_design_without_the_objective_has_no_value_in_one_shard_as_in_several():
    """The axes are parallel in the last one, whose tip reaches an area alone."""
    rows = [{"alpha_deg": 90, "limits_deg": [-180, 180]}, {"a": 0.5, "limits_deg": [-90, 90]}]
    arm = {"dh": {"convention": "standard", "rows": [*rows, {"a": 0.4, "limits_deg": [0, 150]}]}}
    sampling, indices = {"method": "sobol", "count": 1000}, {"indices": ["manipulability"], "task": "linear"}
    whole = plan(
        {
            "analysis": "design_optimization",
            "design": {"analysis": "workspace", "robot": arm, "sampling": sampling, "refined_volume": 0.3, **indices},
            "parameters": [{"name": "twist", "pointers": "/robot/dh/rows/0/alpha_deg", "bounds": [90, 180]}],
            "objectives": [{"value": "/volume_m3/refined/value"}],
            "search": {"method": "sweep", "steps": 3},
        }
    )
    divided = whole.settled_as(whole.division(1, 3))
    partials = [run_shard(divided, shard) for shard in range(3)]
    results = [
        finish(whole, run_shard(whole, 0)),
        finish(divided, reduce(lambda a, b: merge(divided, a, b), partials)),
    ]
    for result in results:
        assert np.isfinite(result.tables["sweep"]["volume_refined_value"]).tolist() == [True, True, False]
        (fault,) = result.document["search"]["faults"]
        assert fault["parameters"] == {"twist": 180} and "points to nothing" in fault["reason"]
    assert results[0].document["search"] == results[1].document["search"]


def test_an_exact_design_that_fails_leaves_the_others_of_its_batch(monkeypatch):
    volumes = design_values.volumes_of

    def failing(regions):
        if any(np.ptp(region.inside_centres) > 1.2 for region in regions):
            raise NumericalError("curves nearly coincide")
        return volumes(regions)

    monkeypatch.setattr(design_values, "volumes_of", failing)
    found = swept(balls(), distance(0.5, 1.5), VOLUME)
    assert found.tables["sweep"]["exact_volume"] == pytest.approx([lens(0.5), lens(1), np.nan], nan_ok=True)
    assert found.document["search"]["faults"][0]["reason"] == "curves nearly coincide"


def test_a_gradient_that_fails_ends_the_refinement_only(monkeypatch):
    def failing(*args):
        raise NumericalError("no gradient")

    monkeypatch.setattr(design_values, "volume_gradient", failing)
    search = {"method": "differential_evolution", "population": 5, "generations": 3}
    found = ws.design_optimization(balls(), distance(0.5, 1.5), VOLUME, search=search)
    assert found.document["search"]["ended"].endswith("SLSQP: stopped by an error (no gradient)")
    assert found.document["best"]["values"]["exact_volume"] > lens(1)


@pytest.mark.parametrize("objective", ["/exact/area", "/exact/dimensions"])
def test_objectives_are_looked_up_before_the_first_design_runs(monkeypatch, objective):
    counts = []
    execute = steps.execute

    def counted(job, *args, **execution):
        if getattr(job, "analysis", "") == "planar_boundary":
            counts.append(job.sampling.count)
        return execute(job, *args, **execution)

    monkeypatch.setattr(steps, "execute", counted)
    with pytest.raises(ws.InputError, match=rf"objectives: {objective} points to nothing: /exact has no"):
        swept(turn_and_slide(), upper_limit(0, 90), [{"value": objective}])
    assert counts == [design_values.FEW_SAMPLES]


def test_the_look_at_a_result_refines_no_volume_that_no_objective_reads(monkeypatch):
    jobs = []
    execute = steps.execute

    def seen(job, *args, **execution):
        jobs.append(job)
        return execute(job, *args, **execution)

    monkeypatch.setattr(steps, "execute", seen)
    rows = [{"a": 0.4, "limits_deg": [-90, 90]}, {"a": 0.3, "limits_deg": [-90, 90]}]
    robot = {"dh": {"convention": "standard", "rows": rows}}
    design = {"analysis": "workspace", "robot": robot, "sampling": {"method": "sobol", "count": 500}, "device": "cpu"}
    lengths = [{"name": "a", "pointers": "/robot/dh/rows/0/a", "bounds": [0.3, 0.5]}]
    swept(design | {"task": ["x", "y"]}, lengths, [{"value": "/bounds_m/upper/0"}], steps=1)
    look, run = jobs[-2:]
    assert (look.sampling.count, run.sampling.count) == (design_values.FEW_SAMPLES, 500)
    assert look.refined_volume is run.refined_volume is None


def test_a_search_looks_for_a_feasible_design_first():
    """Balls 0 … 400 apart meet in a two-hundredth of that: the first five designs are empty."""
    search = {"method": "differential_evolution", "population": 5, "generations": 100, "seed": 2}
    found = ws.design_optimization(balls(), distance(0, 400), VOLUME, search=search)
    volumes = found.tables["evaluations"]["exact_volume"]
    assert (volumes[:5] == 0).all()
    assert found.document["search"]["ended"].startswith("a feasible design after ")
    assert found.document["best"]["values"]["exact_volume"] == pytest.approx(4 / 3 * np.pi, rel=1e-6)
    assert codes(found) == [] and found.document["search"]["designs"] <= 5 * 101 + 20
    low, high = found.document["headline"]["ci95"]
    assert low == high == found.document["headline"]["value"] == found.document["best"]["values"]["exact_volume"]


def test_a_pareto_search_looks_for_a_feasible_design_first():
    pytest.importorskip("pymoo")
    objectives = [*VOLUME, {"value": "exact_inscribed_sphere"}]
    search = {"method": "pareto", "population": 4, "generations": 40, "seed": 2}
    found = ws.design_optimization(balls(), distance(0, 100), objectives, search=search)
    assert found.document["search"]["ended"].startswith("a feasible design after ")
    assert found.document["best"]["values"]["exact_volume"] > 1
    assert found.document["search"]["designs"] <= 160


@pytest.mark.parametrize(
    "search",
    [
        {"method": "sweep", "steps": 4},
        {"method": "differential_evolution", "population": 5, "generations": 3},
    ],
)
def test_a_best_design_that_is_empty_is_a_warning(search):
    found = ws.design_optimization(balls(), distance(3, 4), VOLUME, search=search)
    assert found.document["best"]["values"] == {"exact_volume": 0}
    (warning,) = found.document["warnings"]
    assert (warning["code"], warning["field"]) == ("no_feasible_design", "parameters")
    assert "exact_volume is 0" in warning["message"] and "widen the bounds" in warning["remedy"]
    if search["method"] != "sweep":
        assert found.document["search"]["ended"] == "no feasible design among 20"
