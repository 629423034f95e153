"""Designs of jobs under constraints: objectives of admitted configurations, and designs that admit none."""

import numpy as np
import pytest

import wsrender as ws
from tests.reach.guarded_arms import LINK, RADIUS
from wsrender.errors import InputError

HINGE = 'type="hinge" axis="0 -1 0" range="-180 180"'
CAPSULE = f'<geom type="capsule" size="{RADIUS}" fromto="0 0 0 {LINK} 0 0"/>'
ARM = f"""<mujoco><worldbody><body><joint {HINGE}/>{CAPSULE}<body pos="{LINK} 0 0"><joint {HINGE}/>{CAPSULE}
<site name="tool" pos="{LINK} 0 0"/></body></body></worldbody></mujoco>"""
DESIGN = {
    "analysis": "workspace",
    "robot": {"mjcf": ARM},
    "environment": {"items": [{"shape": "half_space", "point_m": [0, 0, -0.3]}]},
    "sampling": {"method": "sobol", "count": 4096},
    "refined_volume": 0.1,
    "device": "cpu",
}
FLOOR = [{"name": "floor", "pointers": "/environment/items/0/point_m/2", "bounds": [-0.61, 0.19]}]


def swept(values, bounds=(-0.61, 0.19), steps=3):
    floor, objectives = [FLOOR[0] | {"bounds": list(bounds)}], [{"value": value} for value in values]
    return ws.design_optimization(DESIGN, floor, objectives, search={"method": "sweep", "steps": steps})


def segment(floor):
    """Area of a disc of the reach below a floor, on which the tip's capsule lies."""
    R, h = 2 * LINK, -(floor + RADIUS)
    return R**2 * np.arccos(h / R) - h * np.sqrt(R**2 - h**2)


def admitted_share(floor):
    """Of all configurations those with elbow and tip above the floor, by the midpoint rule."""
    angle = 2 * np.pi * (np.arange(1000) + 0.5) / 1000
    elbow = LINK * np.sin(angle)[:, None]
    tip = elbow + LINK * np.sin(angle[:, None] + angle)
    return ((elbow >= floor + RADIUS) & (tip >= floor + RADIUS)).mean()


def test_each_design_has_its_own_surroundings():
    """Floors at -.61, -.21 and .19 m: equal links reach all above it, and the last holds the first link's joint."""
    found = swept(["/headline/value", "/samples/admitted"])
    table = found.tables["evaluations"]
    expected = np.pi * (2 * LINK) ** 2 - segment(np.array([-0.61, -0.21]))
    np.testing.assert_allclose(table["headline_value"][:2], expected, rtol=0.05)
    np.testing.assert_allclose(
        table["samples_admitted"][:2] / 4096, list(map(admitted_share, (-0.61, -0.21))), rtol=5e-3
    )
    assert np.isnan(table["headline_value"][2]) and found.document["best"]["parameters"] == {"floor": -0.61}
    (fault,) = found.document["search"]["faults"]
    assert fault["designs"] == 1 and fault["parameters"] == {"floor": pytest.approx(0.19)}
    assert fault["reason"].startswith("design.constraints.environment: would admit nothing: half_space 1 and")


@pytest.mark.parametrize("part", ["free", "blocked", "undecided"])
def test_parts_of_the_volume_can_be_asked_for(part):
    found = swept([f"/area_m2/{part}/value"], (-0.21, -0.1), 1).tables["evaluations"][f"area_{part}_value"]
    below = segment(-0.155)
    exact = {"free": np.pi * (2 * LINK) ** 2 - below, "blocked": below, "undecided": 0.0}
    np.testing.assert_allclose(found, exact[part], atol=0.05 * np.pi * (2 * LINK) ** 2)


def test_where_every_design_is_refused_the_first_says_why():
    with pytest.raises(InputError, match=r"design\.constraints\.environment: would admit nothing"):
        swept(["/headline/value"], (0.19, 0.29), 2)
