"""Units of the parameters of a design: those of the fields in which they stand."""

import pytest

import wsrender as ws
from wsrender.analyses.design_optimization.result import unit_of


@pytest.mark.parametrize(
    ("pointers", "unit"),
    [
        (["/mechanism/platform_m"], "m"),
        (["/robot/dh/rows/1/a", "/robot/dh/rows/2/d"], "m"),
        (["/robot/dh/rows/0/limits_deg/1"], "deg"),
        (["/robot/dh/rows/0/alpha"], "rad"),
        (["/mechanism/platform_m", "/robot/dh/rows/0/alpha"], ""),
        (["/robot/dh/rows/0/limits/1"], ""),  # of a slide, or of a hinge
        (["/scale/0"], ""),
    ],
)
def test_a_parameter_has_the_unit_of_its_fields(pointers, unit):
    assert unit_of(pointers) == unit


def test_axes_of_a_sweep_have_units():
    parameters = [
        {"name": "platform", "pointers": ["/mechanism/platform_m"], "bounds": [1.5, 2.5]},
        {"name": "link", "pointers": ["/mechanism/link_m"], "bounds": [2.25, 2.5]},
    ]
    design = {"analysis": "parallel_workspace", "mechanism": "six_pus"}
    sweep = {"method": "sweep", "steps": 2}
    result = ws.design_optimization(design, parameters, [{"value": "exact_volume"}], search=sweep)
    plane = result.plot.sweep().axes[1]
    assert (plane.get_xlabel(), plane.get_ylabel()) == ("Platform [m]", "Link [m]")
    assert result.tables["evaluations"].units == {"platform": "m", "link": "m", "exact_volume": "m^3"}
