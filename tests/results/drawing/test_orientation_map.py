"""Pictures of orientations at a point."""

import numpy as np
import pytest

from wsrender.analyses.parallel_workspace.pictures import orientation_map
from wsrender.documents.orientations import EulerRanges, TiltRanges
from wsrender.errors import InputError
from wsrender.mechanisms.orientations import orientation_set
from wsrender.volume.table import Table


def table_of(spec, reached):
    found = orientation_set(spec)
    columns = {name: found.angles[:, k] for k, name in enumerate(found.names)}
    return Table({**columns, "reached": reached(found)})


def test_a_disc_has_the_sectors_that_are_reached():
    table = table_of(TiltRanges(tilt_deg=60, tilts=4, azimuths=6), lambda found: found.angles[:, 1] < 0.5)
    (axes,) = orientation_map(table, title="one").axes
    values = np.asarray(axes.collections[0].get_array()).reshape(4, 6)  # by tilt, then azimuth
    np.testing.assert_array_equal(values, np.array([1, 1, 0, 0])[:, None] * np.ones(6))
    assert axes.get_xlabel() == "azimuth around, tilt outwards"


def test_planes_by_the_last_angle():
    spec = EulerRanges(euler_xyz_deg=((-30, 30), (-20, 20), (0, 80)), per_angle=(3, 5, 9))
    table = table_of(spec, lambda found: found.angles[:, 0] > 0.1)
    shown = [axes for axes in orientation_map(table).axes if axes.get_visible()]
    assert [axes.get_title() for axes in shown] == ["γ = 0°", "γ = 20°", "γ = 30°", "γ = 50°", "γ = 60°", "γ = 80°"]
    values = np.asarray(shown[0].collections[0].get_array()).reshape(5, 3)
    np.testing.assert_array_equal(values, np.ones((5, 1)) * [0, 0, 1])


def test_another_table_is_refused():
    with pytest.raises(InputError, match="does not hold orientations"):
        orientation_map(Table({"a": np.zeros(3)}))
