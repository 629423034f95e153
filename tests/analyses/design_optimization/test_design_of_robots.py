"""Designs of serial robots: shared volumes, and parameters of every kind, against closed forms."""

import numpy as np
import pytest

import wsrender as ws

CELL = 0.01
LENGTHS = (0.3, 0.4, 0.2)  # of the gantry's box


def gantry(x=0.0):
    """Three slides that reach the centres of all voxels of a box, its lower corner at x."""
    z, y, along = ([CELL / 2, length - CELL / 2] for length in reversed(LENGTHS))
    rows = [
        {"joint": "prismatic", "limits": z},
        {"joint": "prismatic", "alpha_deg": 90, "theta_deg": 90, "limits": y},
        {"joint": "prismatic", "alpha_deg": 90, "limits": along},
    ]
    robot = {"dh": {"convention": "modified", "rows": rows}, "placement": {"position_m": [x, 0, 0]}}
    return {"robot": robot, "sampling": {"method": "grid", "per_joint": [20, 40, 30]}}


TWO_BOXES = {
    "analysis": "shared_workspace",
    "robots": [gantry(), gantry(0.1)],
    "indices": ["manipulability"],
    "task": "linear",
    "voxel_size_m": CELL,
    "device": "cpu",
}
APART = {"name": "apart", "pointers": ["/robots/1/robot/placement/position_m/0"], "bounds": [0.0, 0.2]}
WIDTH = {"name": "width", "pointers": ["/robots/0/robot/dh/rows/2/limits/1"], "bounds": [0.195, 0.295]}
OWN = {"value": "/robots/0/volume_m3/occupied", "goal": "minimize"}
SHARED, ANY = {"value": "/volume_m3/shared"}, {"value": "/volume_m3/any", "goal": "minimize"}


def boxes(apart, width):
    """Shared volume, and that of any, of boxes from 0 to ``width`` and from ``apart`` to apart + 0.3."""
    side, common = LENGTHS[1] * LENGTHS[2], np.minimum(width, apart + LENGTHS[0]) - apart
    return side * common, side * (width + LENGTHS[0] - common)


def test_the_shared_volume_of_two_boxes_over_a_placement_and_a_limit():
    result = ws.design_optimization(
        TWO_BOXES, [APART, WIDTH], [SHARED, ANY], search={"method": "sweep", "steps": [3, 2]}
    )
    table = result.tables["sweep"]
    shared, together = boxes(table["apart"], table["width"] + CELL / 2)
    np.testing.assert_allclose(table["volume_shared"], shared, rtol=1e-9)
    np.testing.assert_allclose(table["volume_any"], together, rtol=1e-9)
    best = result.document["best"]  # of shared − any: wholly one in the other, and both as large as can be
    assert best["parameters"] == pytest.approx({"apart": 0.0, "width": 0.295})
    placed = best["design"]["robots"][1]["robot"]["placement"]["position_m"]
    assert placed == [0.0, 0.0, 0.0] and best["design"]["robots"][0]["robot"]["dh"]["rows"][2]["limits"][1] == 0.295


@pytest.mark.parametrize(("weight", "width"), [(0.5, 0.295), (2.0, 0.195)])
def test_weights_decide_between_shared_and_own_volume(weight, width):
    """Both grow with the width of the first box, by as much: the larger weight wins."""
    own = {**OWN, "weight": weight}
    result = ws.design_optimization(TWO_BOXES, [WIDTH], [SHARED, own], search={"method": "sweep", "steps": 2})
    assert result.document["best"]["parameters"]["width"] == pytest.approx(width)


def test_all_widths_are_on_the_front_of_shared_and_own_volume():
    search = {"method": "pareto", "population": 4, "generations": 2}
    result = ws.design_optimization(TWO_BOXES, [WIDTH], [SHARED, OWN], search=search)
    shared, own = (result.tables["pareto"][name] for name in ("volume_shared", "robots_0_volume_occupied"))
    side = LENGTHS[1] * LENGTHS[2]
    np.testing.assert_allclose(own - shared, 0.1 * side, rtol=1e-9)
    found = np.unique(np.round(own / side / CELL))
    assert (
        len(found) > 2
        and found.tolist()
        == np.unique(np.round(result.tables["evaluations"]["robots_0_volume_occupied"] / side / CELL)).tolist()
    )


def test_the_lens_of_two_balls_over_their_distance():
    """π (4 r + d)(2 r − d)²/12 of balls of radius r, centres d apart, to the interval of the refined volume."""
    r = 0.3
    rows = [
        {"alpha_deg": -90, "limits_deg": [-180, 180]},
        {"alpha_deg": 90, "limits_deg": [0, 180]},
        {"joint": "prismatic", "limits": [0.0, r]},
    ]
    arm = {"dh": {"convention": "standard", "rows": rows}, "placement": {"position_m": [0, 0, 0]}}
    robots = [{"robot": arm, "sampling": {"method": "sobol", "count": 100_000}} for _ in range(2)]
    job = {**TWO_BOXES, "robots": robots, "voxel_size_m": 0.05, "refined_volume": 0.03}
    objective = {"value": "/volume_m3/refined/shared/value"}
    search = {"method": "sweep", "steps": 2}
    found = ws.design_optimization(job, [{**APART, "bounds": [0.15, 0.3]}], [objective], search=search)
    table = found.tables["sweep"]
    d = table["apart"]
    exact = np.pi * (4 * r + d) * (2 * r - d) ** 2 / 12
    np.testing.assert_allclose(table["volume_refined_shared_value"], exact, rtol=0.04)
    assert found.document["best"]["parameters"]["apart"] == pytest.approx(0.15)
