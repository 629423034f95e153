"""Force fields of admitted configurations, against a closed form."""

import numpy as np
import pytest

import wsrender as ws
from tests.reach.guarded_arms import COLUMN, FIRST, RADIUS, ROUND, SECOND, distance_of_column, scara
from wsrender.errors import InputError
from wsrender.run import execute

COUNT, SIZE = 1500, 0.06
COLUMN_AROUND = {"items": [{"shape": "cylinder", "position_m": [*COLUMN, 0], "radius_m": ROUND, "length_m": 2.0}]}
JOB = {
    "analysis": "kinetostatic_field",
    "robot": "scara",
    "field": {"task": ["x", "y"], "form": "normalised"},
    "sampling": {"method": "sobol", "count": COUNT, "seed": 3},
    "voxel_size_m": SIZE,
    "device": "cpu",
}


@pytest.fixture(scope="module")
def beside():
    return execute(JOB | {"environment": COLUMN_AROUND}, robot=scara().robot)


def drawn():
    """The robot, and the job's configurations (N, n)."""
    robot = scara().robot
    q = ws.analyze(
        robot, ws.Sobol(COUNT, seed=3), ["manipulability"], keep_map=True, map_columns=["configuration"],
        precision="float64", voxel_size_m=SIZE, refined_volume=None,
    ).map.configuration  # fmt: skip
    return robot, q


def admitted_by(q):
    """Whether both links, capsules, keep out of the column, in closed form (N,) bool."""
    elbow = FIRST * np.stack([np.cos(q[:, 0]), np.sin(q[:, 0])], axis=1)
    turned = q[:, 0] + q[:, 1]
    tip = elbow + SECOND * np.stack([np.cos(turned), np.sin(turned)], axis=1)
    gap = np.minimum(distance_of_column(np.zeros(2), elbow), distance_of_column(elbow, tip)) - ROUND - RADIUS
    assert np.abs(gap).min() > 1e-6
    return gap > 0


def test_a_voxel_holds_the_mean_of_admitted_configurations(beside):
    robot, q = drawn()
    admitted = admitted_by(q)
    field = ws.force_field(robot, task=["x", "y"], form="normalised")
    cells = np.floor(robot.forward_kinematics(q)[:, :3, 3] / SIZE + 1e-9).astype(int)
    volume, voxels = beside.volume, dict[tuple, list]()
    for cell, force in zip(cells[admitted], field.forces(q[admitted]), strict=True):
        voxels.setdefault(tuple(cell.tolist()), []).append(force)
    assert np.count_nonzero(volume.occupied) == len(voxels) < len(np.unique(cells, axis=0))
    for cell, forces in voxels.items():
        at = tuple(np.subtract(cell, volume.first_voxel))
        assert volume.count[at] == len(forces)
        assert volume.vectors["force"][at] == pytest.approx(np.mean(forces, axis=0), abs=1e-5)
        assert volume.statistics["maximum"]["force"][at] == pytest.approx(
            np.linalg.norm(forces, axis=1).max(), abs=1e-5
        )


def test_what_is_rejected_is_counted(beside):
    _, q = drawn()
    admitted, document = admitted_by(q), beside.document
    assert document["sampling"]["samples"] == COUNT == document["samples"]["drawn"]
    assert document["samples"]["admitted"] == admitted.sum() == beside.volume.count.sum()
    assert document["samples"]["rejected"] == {"environment": (~admitted).sum()}
    first = document["rejections"]["first"]["environment"]
    assert first["sample"] == np.argmin(admitted) and first["configuration"] == pytest.approx(q[first["sample"]])
    pairs = document["rejections"]["pairs"]
    assert pairs["counted"] == COUNT and max(each["samples"] for each in pairs["colliding"]) <= (~admitted).sum()


def test_obstacles_of_the_field_push_and_reject_nothing():
    """The same shapes in both: the force acts where the surroundings admit."""
    field = JOB["field"] | {"obstacles": COLUMN_AROUND}
    pushed = execute(JOB | {"field": field}, robot=scara().robot)
    both = execute(JOB | {"field": field, "environment": COLUMN_AROUND}, robot=scara().robot)
    assert "samples" not in pushed.document and pushed.volume.count.sum() == COUNT
    assert both.document["samples"]["admitted"] == both.volume.count.sum() < COUNT
    assert both.document["kinetostatic_field"]["mean_force_n"] != pushed.document["kinetostatic_field"]["mean_force_n"]


def test_a_field_of_nothing_is_refused():
    nowhere = {"region": {"sphere": {"radius_m": 0.01, "position_m": [9, 9, 9]}}}
    with pytest.raises(InputError, match="admit none of 64 samples") as error:
        execute(JOB | {"sampling": {"method": "sobol", "count": 64}, "constraints": nowhere})
    assert error.value.field == "constraints"
