"""Points in a document: numbers only."""

import math

import numpy as np
import pytest

from wsrender.documents.point_sets import PointSet
from wsrender.errors import DocumentError


@pytest.mark.parametrize(
    "points", [[[0, 0, False]], [["0", "0", "0"]], [[0, 0]], [], [[0, 0, math.nan]], "abc", 3, [1, 2, 3, 4]], ids=str
)
def test_what_is_no_list_of_points_is_refused(points):
    with pytest.raises(DocumentError, match=r"list of points \[x, y, z\], finite numbers"):
        PointSet(points=points)


@pytest.mark.parametrize(
    "fields", [{}, {"points": [[0, 0, 0]], "model": "0" * 64}, {"path": "a.npy", "model": "0" * 64}]
)
def test_points_are_given_once(fields):
    with pytest.raises(DocumentError, match='points: must be given, or else "path" or "model": one of them'):
        PointSet(**fields)


def test_points_from_arrays_and_lists_are_equal():
    rows = [[1, 2, 3.5], [0, -1, 1e-3]]
    assert PointSet(points=rows).points == PointSet(points=np.array(rows)).points == tuple(map(tuple, rows))
