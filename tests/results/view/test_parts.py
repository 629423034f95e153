"""Colours of points and of maps: which there are, and which is shown first."""

import numpy as np

from wsrender.analyses.reachability import pictures as of_reachability
from wsrender.analyses.two_arm_placement import pictures as of_two_arms
from wsrender.results.view.blobs import Blobs
from wsrender.results.view.parts import add_maps, add_points, convergence
from wsrender.volume.table import CellGrid, Table


def names(entries):
    return [[channel["name"] for channel in each["channels"]] for each in entries]


def test_what_was_asked_for_leads_and_names_are_no_colours():
    position = np.zeros((4, 3))
    targets = Table(
        {
            "name": np.array(["a", "", "", "b"]),
            "manipulability": np.arange(4.0),
            "position": position,
            "weight": np.ones(4),
            "q_joint1": np.zeros(4),
            "label": np.array(["reachable", "reachable", "blocked", "reachable"]),
        }
    )
    assert names(add_points(Blobs(), None, {"targets": targets}, "float16", [])) == [
        ["label", "weight", "manipulability"]
    ]


def test_labels_have_the_colours_of_the_pictures():
    for marks in (of_reachability._MARKS, of_two_arms._MARKS):
        label = np.array(list(marks))
        (entry,) = add_points(
            Blobs(), None, {"t": Table({"position": np.eye(5, 3), "label": np.resize(label, 5)})}, "float16", []
        )
        (shown,) = entry["channels"]
        for each in shown["categories"]:
            drawn = marks[each["name"].lower()]
            assert each["color"] == drawn.get("mfc", drawn["mec"])
        assert len({each["color"] for each in shown["categories"]}) == len(label)


def test_maps_show_what_is_served_before_how_the_base_is_turned():
    x, y = (each.ravel() for each in np.meshgrid(np.arange(2.0), np.arange(2.0), indexing="ij"))
    columns = {"x_m": x, "y_m": y, "yaw_deg": np.zeros(4), "served": np.arange(4), "weight": np.arange(4.0)}
    placements = Table(columns, grid=CellGrid(("x_m", "y_m"), (0.0, 0.0), (1.0, 1.0), (2, 2)))
    assert names(add_maps(Blobs(), {"map": placements}, None, "float16")) == [["weight", "served", "yaw_deg"]]


def test_curves_of_convergence_say_of_which_robot_they_are():
    """By its place among all, whether or not the sampling of those before converges."""
    grids = [{"samples": 27, "value": 0.1}, {"samples": 64, "value": 0.2}]
    settled = {"name": "b", "convergence": grids, "indices": {"manipulability": {"unit": "m^3"}}}
    sampling = {"by": "mean", "index": "manipulability"}
    document = {
        "robots": [{"name": "a"}, settled, settled | {"name": "c"}],
        "job": {"robots": [{"sampling": {"method": "sobol"}}, {"sampling": sampling}, {"sampling": sampling}]},
    }
    plots = convergence(document)
    assert [(plot["robot"], plot["label"]) for plot in plots] == [(1, "Convergence of b"), (2, "Convergence of c")]
    assert all(plot["sets"] == "samples" and plot["x"]["values"] == [27, 64] for plot in plots)
    (alone,) = convergence(settled | {"job": {"sampling": sampling}})
    assert (alone["robot"], alone["label"]) == (0, "Convergence")
