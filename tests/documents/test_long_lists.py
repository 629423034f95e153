"""Long lists of numbers in documents: looked at all at once, and judged as one by one."""

import copy
import json
import math
from numbers import Real

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wsrender.analyses.jobs import canonical_json, parse_job
from wsrender.documents.arm import local_paths, models_in
from wsrender.documents.document import MOST_COLUMNS
from wsrender.documents.problems import MOST_PROBLEMS
from wsrender.documents.quantities import is_numeric, number_rows
from wsrender.documents.reading import DEEPEST_NESTING, check_depth
from wsrender.errors import DocumentError

numbers = st.floats() | st.integers(-(10**400), 10**400) | st.booleans() | st.just("1") | st.none()
rows = st.lists(st.lists(numbers, max_size=4) | st.tuples(st.floats(-1, 1)) | st.just("ab"), max_size=4)


def read_one_by_one(rows):
    """The rows with every number looked at; None where one of them is none."""
    for row in rows:
        if not isinstance(row, list | tuple):
            return None
        for number in row:
            if isinstance(number, bool) or not isinstance(number, Real) or abs(number) > 1.7976931348623157e308:
                return None
            if isinstance(number, float) and not math.isfinite(number):
                return None
    return tuple(tuple(float(number) for number in row) for row in rows)


@given(rows)
def test_rows_are_those_that_hold_finite_numbers_alone(rows):
    expected = read_one_by_one(rows)
    if expected is None:
        with pytest.raises(ValueError):
            number_rows(rows)
    else:
        assert number_rows(rows) == expected


def test_finite_rows_whose_sum_is_not_finite_are_rows():
    assert number_rows([[1e308, 1e308], [10**308]]) == ((1e308, 1e308), (1e308,))


def test_rows_come_from_arrays_and_scalars_of_numpy():
    assert number_rows(np.array([[1, 2], [3, 4]])) == ((1, 2), (3, 4))
    assert number_rows([[np.float32(0.5), np.int8(1)]]) == ((0.5, 1.0),)


@pytest.mark.parametrize("value", [[], [1, None, True, 2.5], [[1.0], []], [[None]]])
def test_numbers_and_rows_of_them_are_numeric(value):
    assert is_numeric(value)


@pytest.mark.parametrize("value", [["1"], [{}], [1, [2]], [[1], {}], [[[1]]], [[1], ["path"]]])
def test_whatever_may_hold_a_field_is_not_numeric(value):
    assert not is_numeric(value)


def test_files_and_models_are_found_beside_numbers():
    document = {"a": [[1, 2]], "b": [[1], {"path": "x"}], "robot": {"library": "scara"}, "c": [[[{"path": "y"}]]]}
    assert [*local_paths(document)] == [("b", 1, "path"), ("c", 0, 0, 0, "path")]
    assert [*models_in(document)] == [(("robot",), {"library": "scara"})]


@pytest.mark.parametrize("leaf", [[], {}, [1.0]])
def test_the_deepest_nesting_is_counted_in_lists_and_objects(leaf):
    for levels, fine in ((DEEPEST_NESTING, True), (DEEPEST_NESTING + 1, False)):
        document = copy.copy(leaf)
        for level in range(levels - 1):
            document = {"a": [1], "b": document} if level % 2 else [1, document]
        if fine:
            check_depth(document)
        else:
            with pytest.raises(DocumentError, match="nested"):
                check_depth(document)


def test_negative_zeros_are_written_as_zeros_wherever_they_are():
    job = {"analysis": "indices_at", "robot": "scara", "configurations": [[-0.0, 1, -0.5, -0.05]]}
    text = canonical_json(parse_job(job))
    assert json.loads(text)["configurations"] == [[0, 1, -0.5, -0.05]] and "-0.0," not in text
    assert text == canonical_json(parse_job(job | {"configurations": [[0, 1, -0.5, -0.05]]}))


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [
        ("configurations", [[]] * 30_000, "rows of one length"),
        ("configurations", [[0.0] * (MOST_COLUMNS + 1)], f"at most {MOST_COLUMNS} numbers, not {MOST_COLUMNS + 1}"),
    ],
)
def test_rows_of_no_width_and_of_any_are_refused(field, value, message):
    with pytest.raises(DocumentError, match=message):
        parse_job({"analysis": "indices_at", "robot": "scara", field: value})


@pytest.mark.parametrize("wrong", ["a", 0, -1, None])
def test_of_wrong_weights_one_problem_is_told(wrong):
    job = {"analysis": "base_placement", "robot": "scara", "points_m": [[0, 0, 0]], "weights": [wrong] * MOST_PROBLEMS}
    with pytest.raises(DocumentError) as told:
        parse_job(job)
    assert [field for field, _ in told.value.problems].count("weights") == 1
    assert not [field for field, _ in told.value.problems if field.startswith("weights.")]
