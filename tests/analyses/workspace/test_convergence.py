"""Algorithm 1 of WSRender: finer grids until a global index settles."""

from itertools import pairwise

import pytest

import wsrender as ws
from tests.run.simple_robots import PLANAR, planar_arm

OPTIONS = {**PLANAR, "voxel_size_m": 0.03}


def converged(**fields):
    return ws.analyze(planar_arm(), ws.Converge("manipulability", **fields), **OPTIONS).document


@pytest.mark.parametrize(("by", "tolerance"), [("joint_mean", 1e-3), ("workspace_mean", 5e-3)])
def test_sequence_of_global_values(by, tolerance):
    document = converged(tolerance=tolerance, by=by)
    sequence = document["convergence"]
    assert [step["per_joint"] for step in sequence] == [15 + 5 * i for i in range(len(sequence))]
    assert [step["samples"] for step in sequence] == [step["per_joint"] ** 2 for step in sequence]
    for step in (sequence[0], sequence[-1]):
        grid = ws.analyze(planar_arm(), ws.Grid(step["per_joint"]), **OPTIONS).document
        assert step["value"] == grid["indices"]["manipulability"][by]
    changes = [abs(b["value"] - a["value"]) for a, b in pairwise(sequence)]
    assert len(changes) > 1
    assert changes[-1] <= tolerance
    assert all(change > tolerance for change in changes[:-1])
    # The result is that of the last grid.
    assert document["sampling"]["samples"] == sequence[-1]["samples"]
    assert document["indices"]["manipulability"][by] == sequence[-1]["value"]
    assert document["voxel_size_m"] == 0.03


@pytest.mark.parametrize("limits", [{"max_samples": 700}, {}], ids=["its own limit", "the job's"])
def test_not_converged(limits):
    fields = {} if limits else {"max_samples": 700}
    with pytest.raises(ws.NotConvergedError, match=r"30 per joint, has 900 samples, above max_samples = 700") as error:
        ws.analyze(planar_arm(), ws.Converge("manipulability", tolerance=1e-12, **limits), **OPTIONS, **fields)
    assert [step["per_joint"] for step in error.value.sequence] == [15, 20, 25]
    assert "joint_mean so far" in str(error.value)


def test_even_the_first_grid_may_be_too_large():
    with pytest.raises(ws.NotConvergedError, match=r"15 per joint, has 225 samples, .* so far: none"):
        converged(max_samples=100)


def test_the_index_must_be_among_those_of_the_job():
    with pytest.raises(ws.InputError, match=r"sampling.index: 'isotropy' is not among the job's indices"):
        ws.analyze(planar_arm(), ws.Converge("isotropy"), **OPTIONS)
    with pytest.raises(ws.InputError, match="unknown index 'manipulation'"):
        ws.analyze(planar_arm(), ws.Converge("manipulation"), **OPTIONS)


def test_an_alias_is_found():
    robot, sampling = planar_arm(), ws.Converge("yoshikawa", tolerance=1.0)
    assert len(ws.analyze(robot, sampling, **OPTIONS).document["convergence"]) == 2
