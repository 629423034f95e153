"""Bases on rails and torsos: placements from which some value of the mount's joints lets the arm reach a target."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.analyses.base_placement.test_base_placement import DOWN, bases_of, job, labels_of, seen_from, solutions_of
from tests.reference import closed_form_inverse as closed_form
from wsrender.run import execute


@pytest.mark.parametrize(("axis", "along"), [("x", [1.0, 0.0, 0.0]), ([0.6, 0.8, 0.0], [0.6, 0.8, 0.0])])
def test_points_of_two_links_on_a_rail(axis, along):
    """An annulus that slides: how near the base comes to a point, and how far, along a segment."""
    rows = [{"a": 0.4, "limits_deg": [-180, 180]}, {"a": 0.3, "limits_deg": [-180, 180]}]
    table = ws.DHTable(convention="standard", rows=rows).model_dump(mode="json", exclude_none=True)
    robot = {"dh": table, "mount": [{"name": "rail", "axis": axis, "limits": [-0.2, 0.6]}]}
    points = np.random.default_rng(0).uniform([-0.8, -0.8, 0], [0.8, 0.8, 0], (9, 3))
    document = job(robot, points, over={"x_m": [-0.6, 0.6, 0.2], "y_m": [-0.6, 0.6, 0.2], "yaw_deg": [0, 90, 45]})
    bases = bases_of(document)
    from_base = points - bases[:, None, :3, 3]
    turned = bases[:, :3, :3] @ along
    at = np.clip(np.einsum("pkj,pj->pk", from_base, turned), -0.2, 0.6)
    nearest = np.linalg.norm(from_base - at[..., None] * turned[:, None], axis=2)
    ends = [np.linalg.norm(from_base - s * turned[:, None], axis=2) for s in (-0.2, 0.6)]
    served = (nearest < 0.7) & (np.maximum(*ends) > 0.1)
    clear = (np.abs(nearest - 0.7) > 1e-4) & (np.abs(np.maximum(*ends) - 0.1) > 1e-4)
    found = labels_of(execute(document))
    assert ((found == "served") == served)[clear].all() and clear.mean() > 0.99
    assert 0.2 < served.mean() < 0.95
    alone = job({"dh": table}, points, over=document["over"])
    assert ((labels_of(execute(alone)) == "served") < (found == "served")).any()


def test_an_arm_of_six_joints_on_a_rail_is_the_arm_wherever_the_rail_brings_it():
    """All postures in closed form from 81 places of the rail: where one of them serves, the seven joints do."""
    random = np.random.default_rng(3)
    quats = np.concatenate([np.tile(DOWN, (3, 1)), Rotation.random(3, random_state=4).as_quat(scalar_first=True)])
    points, rail = random.uniform([-1.0, -0.6, 0.1], [1.0, 0.6, 0.5], (6, 3)), np.linspace(-0.4, 0.4, 81)
    over = {"x_m": [-0.8, 0.8, 0.4], "y_m": [-0.6, 0.6, 0.6], "yaw_deg": [0, 90, 90]}
    document = job({"library": "ur5e", "mount": [{"name": "rail", "axis": "y", "limits": [-0.4, 0.4]}]}, points, quats)
    document |= {"over": over}
    robot, bases, moved = ws.load_robot("ur5e"), bases_of(document), np.tile(np.eye(4), (len(rail), 1, 1))
    moved[:, 1, 3] = rail
    carried = bases[:, None] @ moved
    positions, rotations = seen_from(carried.reshape(-1, 4, 4), points, quats)
    solutions = solutions_of("ur5e", positions.reshape(-1, 3), rotations.reshape(-1, 3, 3))
    within = closed_form.within_limits(solutions, robot.lower_limits, robot.upper_limits, robot.chain.revolute)
    expected = within.any(axis=1).reshape(len(bases), len(rail), -1).any(axis=1)
    found = labels_of(execute(document)) == "served"
    assert found[expected].all() and 0.3 < expected.mean() < 0.95
    assert (found & ~expected).mean() < 0.02  # between two places of the rail
