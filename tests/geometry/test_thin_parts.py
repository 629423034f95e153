"""Parts and gaps between the planes of a lattice, and planes through them."""

import numpy as np
import pytest

from tests.geometry.spatial_arms import arm_of, robot, sliding, turning
from wsrender.geometry.spatial.cells import CellLattice
from wsrender.geometry.spatial.critical_sets import critical_sets
from wsrender.geometry.spatial.inverse import ThreeJointInverse
from wsrender.geometry.spatial.thin_parts import ThinParts, thin_parts

WIDTH = 0.1
BASE = 0.06 * np.radians(120) * (np.cos(np.radians(20)) - np.cos(np.radians(150)))


def parts_of_a_plate(height, planes):
    """A SCARA arm reaches a plate between 0.2 m and 0.2 m + ``height`` below; lattice planes of z at ``planes``."""
    rows = [turning(-60, 60, a=0.3), turning(20, 150, a=0.2, alpha_deg=180), sliding(0.2, 0.2 + height)]
    arm = arm_of(robot(rows, "plate", "standard"))
    across = np.arange(-0.71, 0.75, WIDTH)
    axes = (across, across, np.array(planes))
    lattice = CellLattice(axes, WIDTH, np.zeros([len(axis) for axis in axes], bool))
    tested = []
    found = thin_parts(critical_sets(arm), ThreeJointInverse(arm), lattice, tested.append)
    assert sum(tested) > 1000
    return found


def test_a_plate_between_two_planes_is_found_with_its_volume():
    found = parts_of_a_plate(0.053, [-0.36, -0.26, -0.16])
    flat = found.axis == 2
    assert found.volume[flat].sum() == pytest.approx(0.05 * BASE, rel=0.02)  # 8 of 16 steps of a cell
    assert found.low[flat].min() >= -0.253 + 0.004 and found.high[flat].max() <= -0.2 - 0.004
    x, y, z = found.planes(WIDTH, found.volume[~flat].sum() + 1e-9, 4)
    assert len(x) == len(y) == 0 and len(z) == 1 and -0.245 < z[0] < -0.205


@pytest.mark.parametrize(
    ("height", "planes"),
    [(0.053, [-0.33, -0.23, -0.13]), (0.12, [-0.36, -0.16]), (0.006, [-0.36, -0.26, -0.16])],
    ids=["a plane goes through", "thicker than a cell", "thinner than a sixteenth"],
)
def test_other_plates_are_not_thin_parts(height, planes):
    assert not (parts_of_a_plate(height, planes).axis == 2).any()


def test_planes_go_first_through_most_volume_and_stop_where_little_is_left():
    parts = ThinParts(
        np.array([0, 0, 0, 2]),
        np.array([0.0, 0.04, 0.5, 0.2]),
        np.array([0.06, 0.09, 0.53, 0.25]),
        np.array([2.0, 2.0, 1.0, 3.0]),
    )
    x, y, z = parts.planes(WIDTH, 0.0, 9)
    assert len(y) == 0 and len(z) == 1 and len(x) == 2
    assert 0.04 < x[0] < 0.06 and 0.5 < x[1] < 0.53 and 0.2 < z[0] < 0.25
    assert [len(axis) for axis in parts.planes(WIDTH, 1.5, 9)] == [1, 0, 1]
    assert [len(axis) for axis in parts.planes(WIDTH, 0.0, 1)] == [1, 0, 0]
    assert [len(axis) for axis in parts.planes(WIDTH, 8.0, 9)] == [0, 0, 0]
