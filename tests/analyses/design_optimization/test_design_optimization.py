import json

import numpy as np
import pytest

import wsrender as ws
from wsrender.analyses.design_optimization import run as design
from wsrender.errors import DocumentError, InputError
from wsrender.run import plan, run_shard

SIX_PUS = {"analysis": "parallel_workspace", "mechanism": {"library": "six_pus"}, "device": "cpu"}
VOLUME = [{"value": "exact_volume"}]


def platform_and_link(links, platforms=(1.0, 3.0)):
    return [
        {"name": "platform", "pointers": "/mechanism/platform_m", "bounds": list(platforms)},
        {"name": "link", "pointers": [f"/mechanism/link_m/{k}" for k in range(3)], "bounds": list(links)},
    ]


def two_links(first, second):
    """A planar arm of full turns about z, its two lengths free."""
    rows = [{"a": first, "limits_deg": [-180, 180]}, {"a": second, "limits_deg": [-180, 180]}]
    return {
        "analysis": "workspace",
        "robot": {"dh": {"convention": "standard", "rows": rows}},
        "sampling": {"method": "grid", "per_joint": 300},
        "indices": ["manipulability"],
        "task": ["x", "y"],
        "voxel_size_m": 0.02,
        "device": "cpu",
    }


LENGTHS = [
    {"name": "first", "pointers": ["/robot/dh/rows/0/a"], "bounds": [0.1, 0.9]},
    {"name": "second", "pointers": ["/robot/dh/rows/1/a"], "bounds": [0.1, 0.9]},
]


def test_the_optimum_of_the_published_six_pus():
    """DEFINITIONS section 9: l = 2, links 2.25 gives 1.317761291; the bound of the links is active."""
    result = ws.design_optimization(SIX_PUS, platform_and_link([2.25, 2.5]), VOLUME)
    best = result.document["best"]
    assert best["values"]["exact_volume"] == pytest.approx(1.317761291, abs=1e-7)
    assert best["parameters"]["link"] == pytest.approx(2.25, abs=1e-6) and "link" in best["at_bounds"]
    assert min(abs(best["parameters"]["platform"] - side) for side in (2, 3)) < 1e-4
    assert best["design"]["mechanism"]["link_m"] == [best["parameters"]["link"]] * 3
    assert result.meshes["best"].is_watertight
    assert result.meshes["best"].volume == pytest.approx(1.317761291, rel=2e-3)
    improvements = result.tables["convergence"]["exact_volume"]
    assert (np.diff(improvements) >= 0).all() and improvements[-1] == best["values"]["exact_volume"]


def test_the_optimum_with_shorter_links_is_that_of_a_fine_grid():
    sweep = ws.design_optimization(
        SIX_PUS, platform_and_link([2.0, 2.5]), VOLUME, search={"method": "sweep", "steps": 41}
    )
    on_grid = sweep.document["best"]["values"]["exact_volume"]
    assert len(sweep.tables["sweep"]) == 41 * 41 and on_grid > 1.770
    found = ws.design_optimization(SIX_PUS, platform_and_link([2.0, 2.5]), VOLUME).document["best"]
    assert found["values"]["exact_volume"] >= on_grid - 1e-9


def test_a_published_sweep_and_its_picture():
    """[SNK]: .4 … 1.26 m³."""
    result = ws.design_optimization(SIX_PUS, platform_and_link([2.3, 4.3]), VOLUME, search={"method": "sweep"})
    volumes = result.tables["sweep"]["exact_volume"]
    assert len(volumes) == 441
    assert volumes.min() == pytest.approx(0.40, abs=5e-3) and volumes.max() == pytest.approx(1.26, abs=5e-3)
    assert result.plot.sweep().axes


def test_a_shell_and_a_constraint_in_closed_form():
    """One UPS leg is a shell: V = 4/3 π (R³ − r³). On R + 2 r ≥ 1.4: r = .2, R = 1 … 1.5, so R = 1.5.

    The smallest on the same: on R = 1.4 − 2 r within bounds, the derivative −2 R² − r² < 0, so r = .2, R = 1.
    """
    legs = [{"type": "UPS", "base_m": [0, 0, 0], "platform_m": [0, 0, 0], "length_m": [0.2, 1.2]}]
    job = {"analysis": "parallel_workspace", "mechanism": {"legs": legs}, "device": "cpu"}
    parameters = [
        {"name": "shortest", "pointers": ["/mechanism/legs/0/length_m/0"], "bounds": [0.1, 0.9]},
        {"name": "longest", "pointers": ["/mechanism/legs/0/length_m/1"], "bounds": [1.0, 1.5]},
    ]
    constraint = [{"coefficients": {"shortest": 2, "longest": 1}, "lower": 1.9}]
    largest = ws.design_optimization(job, parameters, VOLUME, constraints=constraint).document["best"]
    assert largest["parameters"] == pytest.approx({"shortest": 0.2, "longest": 1.5}, abs=1e-6)
    assert largest["values"]["exact_volume"] == pytest.approx(4 / 3 * np.pi * (1.5**3 - 0.2**3), rel=1e-8)
    least = ws.design_optimization(job, parameters, [{"value": "exact_volume", "goal": "minimize"}]).document["best"]
    assert least["parameters"] == pytest.approx({"shortest": 0.9, "longest": 1.0}, abs=1e-5)
    assert least["values"]["exact_volume"] == pytest.approx(4 / 3 * np.pi * (1 - 0.9**3), rel=1e-5)


def test_the_largest_ball_and_cube_of_a_shell_in_closed_form():
    """Between spheres of radii r < R lies a ball of (R − r)/2: largest at r = .2, R = 1.5. Inside R alone: 2R/√3."""
    legs = [{"type": "UPS", "base_m": [0, 0, 0], "platform_m": [0, 0, 0], "length_m": [0.2, 1.2]}]
    job = {"analysis": "parallel_workspace", "mechanism": {"legs": legs}, "device": "cpu"}
    parameters = [
        {"name": "shortest", "pointers": ["/mechanism/legs/0/length_m/0"], "bounds": [0.2, 0.9]},
        {"name": "longest", "pointers": ["/mechanism/legs/0/length_m/1"], "bounds": [1.0, 1.5]},
    ]
    search = {"method": "sweep", "steps": 3}
    found = ws.design_optimization(job, parameters, [{"value": "exact_inscribed_sphere"}], search=search)
    best = found.document["best"]
    assert best["parameters"] == {"shortest": 0.2, "longest": 1.5}
    assert best["values"]["exact_inscribed_sphere"] == pytest.approx(0.65, rel=1e-9)
    ball = found.document["inscribed"]["sphere"]
    assert np.linalg.norm(ball["center_m"]) == pytest.approx(0.85, rel=1e-6)
    assert 0.65 <= ball["at_most_radius_m"] < 0.75
    legs[0]["length_m"] = [0.0, 1.2]
    objectives = [{"value": "exact_inscribed_cube"}, {"value": "exact_volume", "weight": 1e-3}]
    found = ws.design_optimization(job, parameters[1:], objectives, search={"method": "sweep", "steps": [2]})
    assert found.tables["sweep"]["exact_inscribed_cube"] == pytest.approx([2 / np.sqrt(3), 3 / np.sqrt(3)], rel=1e-9)
    assert found.tables["sweep"]["exact_volume"] == pytest.approx(4 / 3 * np.pi * np.array([1, 1.5**3]), rel=1e-8)


def test_inscribed_sizes_in_voxels_say_how_far_they_may_be_off():
    parameters = platform_and_link([2.25, 2.5])
    objectives = [{"value": value} for value in ("inscribed_cube", "exact_inscribed_cube")]
    job = {**SIX_PUS, "voxel_size_m": 0.05}
    found = ws.design_optimization(job, parameters, objectives, search={"method": "sweep", "steps": 2})
    table, entry = found.tables["sweep"], found.document["objectives"][0]
    assert entry["error_m"] == pytest.approx(0.05) and "error_m" not in found.document["objectives"][1]
    assert table["inscribed_cube"] == pytest.approx(table["exact_inscribed_cube"], abs=entry["error_m"])
    with pytest.raises(InputError, match='"inscribed_cube" needs voxels'):
        ws.design_optimization({**SIX_PUS, "method": "exact"}, parameters, objectives[:1], search={"method": "sweep"})


def test_two_links_of_one_length_together_reach_most_when_equal():
    """The ring of a 2R arm has the area π ((a + b)² − (a − b)²) = 4 π a b: π on a + b = 1, at a = b."""
    result = ws.design_optimization(
        two_links(0.3, 0.3),
        LENGTHS,
        [{"value": "/volume_m3/occupied"}],
        constraints=[{"coefficients": {"first": 1, "second": 1}, "upper": 1.0}],
        search={"method": "sweep", "steps": 9},
    )
    best = result.document["best"]
    assert best["parameters"] == pytest.approx({"first": 0.5, "second": 0.5})
    assert best["values"]["volume_occupied"] / 0.02 == pytest.approx(np.pi, rel=0.05)
    assert len(result.tables["sweep"]) == 45  # of 81 designs those that the constraint allows


def test_ties_weights_and_several_values_of_one_run():
    """One length for both links; manipulability grows with it as a², the volume counts against it."""
    tied = [{"name": "length", "pointers": [p["pointers"][0] for p in LENGTHS], "bounds": [0.2, 0.6]}]
    objectives = [
        {"value": "/indices/manipulability/maximum", "weight": 1.0},
        {"value": "inscribed_sphere", "weight": 1.0},
        {"value": "inscribed_cube", "weight": 1.0},
        {"value": "/volume_m3/occupied", "goal": "minimize", "weight": 100.0},
    ]
    result = ws.design_optimization(two_links(0.3, 0.3), tied, objectives, search={"method": "sweep", "steps": [3]})
    table = result.tables["sweep"]
    assert table["indices_manipulability_maximum"] == pytest.approx([0.04, 0.16, 0.36], rel=1e-3)
    assert table["inscribed_cube"] == pytest.approx([0.02] * 3)  # a plane is one voxel thick
    assert result.document["best"]["parameters"]["length"] == pytest.approx(0.2)
    rows = result.document["best"]["design"]["robot"]["dh"]["rows"]
    assert rows[0]["a"] == rows[1]["a"] == pytest.approx(0.2)


def test_a_pareto_search_of_volume_and_manipulability():
    """Volume 4 π a b grows with both lengths, the least a + b has the smallest: both extremes are on the front."""
    objectives = [{"value": "/volume_m3/occupied"}, {"value": "/bounds_m/upper/0", "goal": "minimize"}]
    job = {**two_links(0.3, 0.3), "sampling": {"method": "grid", "per_joint": 60}, "voxel_size_m": 0.05}
    result = ws.design_optimization(
        job, LENGTHS, objectives, search={"method": "pareto", "population": 8, "generations": 4}
    )
    front = result.document["pareto"]
    assert 1 < len(front) <= 32 and len(result.tables["pareto"]) == len(front)
    volumes = sorted(entry["values"]["volume_occupied"] for entry in front)
    reaches = [v for _, v in sorted((e["values"]["volume_occupied"], e["values"]["bounds_upper_0"]) for e in front)]
    assert len(set(volumes)) == len(volumes) and reaches == sorted(reaches)


def test_an_earlier_result_goes_on_without_evaluating_again(tmp_path):
    fields = {"search": {"method": "differential_evolution", "population": 5, "generations": 4}}
    parameters = platform_and_link([2.25, 2.5])
    first = ws.design_optimization(SIX_PUS, parameters, VOLUME, **fields)
    first.save(tmp_path)
    assert (tmp_path / "plots" / "convergence.png").exists()
    again = ws.design_optimization(SIX_PUS, parameters, VOLUME, resume=first, **fields)
    assert again.document["search"]["evaluated"] == 0
    assert again.document["best"] == first.document["best"]
    longer = {"search": {**fields["search"], "generations": 6}}
    on = ws.design_optimization(SIX_PUS, parameters, VOLUME, resume=first, **longer)
    fresh = ws.design_optimization(SIX_PUS, parameters, VOLUME, **longer)
    assert 0 < on.document["search"]["evaluated"] < fresh.document["search"]["evaluated"]
    assert on.document["best"] == fresh.document["best"]


def test_a_file_keeps_every_design_of_a_search_that_was_stopped(tmp_path):
    path = tmp_path / "designs.csv"
    document = {
        "analysis": "design_optimization",
        "design": SIX_PUS,
        "parameters": platform_and_link([2.25, 2.5]),
        "objectives": VOLUME,
        "search": {"method": "sweep", "steps": 20},
        "evaluations": {"path": str(path)},
    }

    class StoppedError(Exception):
        pass

    def stop(done, total, message):
        if message == "samples" and done:
            raise StoppedError

    with pytest.raises(StoppedError):
        ws.execute(document, stop)
    kept = len(path.read_text().splitlines()) - 1
    assert 0 < kept < 400
    result = ws.execute(document)
    assert result.document["search"]["evaluated"] == 400 - kept
    assert len(path.read_text().splitlines()) == 401


@pytest.mark.parametrize("batch", [1, 100])
def test_a_search_that_was_stopped_goes_on_from_its_checkpoint(tmp_path, monkeypatch, batch):
    """To the same partial result, without evaluating a design again; designs without value are tried again."""
    monkeypatch.setattr(design, "BATCH", batch)
    bounds = platform_and_link([0.1, 2.5], platforms=(-1.0, 3.0))  # a platform below 0 is none
    search = {"method": "differential_evolution", "population": 5, "generations": 6, "refine": False}
    document = {"analysis": "design_optimization", "design": SIX_PUS, "parameters": bounds, "objectives": VOLUME}
    planned = plan({**document, "search": search})
    whole = run_shard(planned, 0)

    class KilledError(Exception):
        pass

    def killed(done: int) -> None:
        if done >= 20:
            raise KilledError

    checkpoint = tmp_path / "0.checkpoint"
    with pytest.raises(KilledError):
        run_shard(planned, 0, killed, checkpoint=checkpoint)
    kept = checkpoint.read_text()
    assert kept.count("\n") > 20 and "nan" in kept
    again = run_shard(planned, 0, checkpoint=checkpoint)
    assert again.facts == whole.facts
    assert all(np.array_equal(again[name], whole[name], equal_nan=True) for name in whole.arrays)
    lines = [line for line in checkpoint.read_text().splitlines() if "nan" not in line]
    assert checkpoint.read_text().startswith(kept) and len(set(lines)) == len(lines)


def test_designs_that_are_none_have_no_value():
    """Below 0.2 the shortest leg would be the longest."""
    legs = [{"type": "UPS", "base_m": [0, 0, 0], "platform_m": [0, 0, 0], "length_m": [0.2, 1.2]}]
    job = {"analysis": "parallel_workspace", "mechanism": {"legs": legs}, "device": "cpu"}
    parameter = [{"name": "longest", "pointers": ["/mechanism/legs/0/length_m/1"], "bounds": [0.1, 0.4]}]
    result = ws.design_optimization(job, parameter, VOLUME, search={"method": "sweep", "steps": 4})
    volumes = result.tables["sweep"]["exact_volume"]
    assert np.isnan(volumes[:2]).all() and np.isfinite(volumes[2:]).all()
    assert result.document["search"]["without_value"] == 2
    assert "design.mechanism.legs.0.length_m" in result.document["search"]["first_fault"]
    parameter[0]["bounds"] = [0.1, 0.15]
    with pytest.raises(InputError, match=r"design.mechanism.legs.0.length_m"):
        ws.design_optimization(job, parameter, VOLUME, search={"method": "sweep", "steps": 2})


def test_an_empty_workspace_has_volume_0():
    job = {**SIX_PUS, "mechanism": {"library": "six_pus", "region": {"lower_m": [None, None, 90]}}}
    result = ws.design_optimization(job, platform_and_link([2.25, 2.5]), VOLUME, search={"method": "sweep", "steps": 2})
    assert result.tables["sweep"]["exact_volume"].tolist() == [0, 0, 0, 0]
    assert not result.meshes


def test_results_are_saved_with_their_pictures(tmp_path):
    result = ws.design_optimization(
        SIX_PUS, platform_and_link([2.25, 2.5]), VOLUME, search={"method": "sweep", "steps": 3}
    )
    result.save(tmp_path)
    names = {artifact["name"] for artifact in json.loads((tmp_path / "result.json").read_text())["artifacts"]}
    assert {"evaluations.parquet", "sweep.parquet", "best.ply", "best.glb", "plots/sweep.png"} <= names
    restored = ws.Result.load(tmp_path)
    assert restored.document["best"]["parameters"] == result.document["best"]["parameters"]
    assert "best design" in restored.summary()


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"job": "delta"}, r'^design.mechanism.legs.0: is a delta leg;.* pairs of PUS legs \("exact_volume" is of'),
        ({"job": "hybrid"}, "must have no serial joints"),
        ({"objectives": [{"value": "/volume_m3/none"}]}, 'has no "none"; it has occupied'),
        ({"objectives": [{"value": "/bounds_m"}]}, "is no number in the result document"),
        ({"constraints": [{"coefficients": {"side": 1}, "lower": 9}]}, "leave out every design"),
    ],
)
def test_what_only_a_run_can_tell_is_told(changes, words):
    job = {"analysis": "parallel_workspace", "mechanism": {"library": "six_pus"}, "voxel_size_m": 0.2, "device": "cpu"}
    pointer = "/mechanism/platform_m"
    if changes.get("job") == "delta":
        job["mechanism"], pointer = {"library": "delta"}, "/mechanism/crank_m"
    if changes.get("job") == "hybrid":
        job["mechanism"] = {"library": "six_pus", "before": [{"axis": [0, 0, 1], "limits_deg": [-10, 10]}]}
    parameters = [{"name": "side", "pointers": [pointer], "bounds": [0.2, 0.4]}]
    fields = {"objectives": VOLUME, "search": {"method": "sweep", "steps": 2}, **changes}
    fields.pop("job", None)
    with pytest.raises(InputError, match=words):
        ws.design_optimization(job, parameters, fields.pop("objectives"), **fields)


def test_a_search_without_an_allowed_design_says_so():
    with pytest.raises((ws.NotConvergedError, DocumentError)):
        ws.design_optimization(
            SIX_PUS,
            platform_and_link([2.25, 2.5]),
            VOLUME,
            constraints=[{"coefficients": {"link": 1}, "lower": 3}],
            search={"method": "differential_evolution", "population": 5, "generations": 2},
        )
