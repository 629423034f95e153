"""Numbers in legends."""

import pytest

from wsrender.results.drawing.style import three_digits


@pytest.mark.parametrize(
    ("value", "text"),
    [(1650.4, "1,650"), (0, "0"), (0.35863, "0.359"), (1e4, "10,000"), (12345678, "12,300,000"), (-2, "−2")],
)
def test_they_have_no_power_of_ten(value, text):
    assert three_digits(value) == text
