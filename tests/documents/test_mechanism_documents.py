"""Mechanisms in documents: defaults, and malformed ones with the field and message that each must give."""

import pytest
from pydantic import Field

from wsrender.documents.document import Document
from wsrender.documents.mechanism import Delta, LegsMechanism, Master4DOF, MechanismSpec, SixPUS, StewartGough
from wsrender.errors import DocumentError


class Holder(Document):
    mechanism: MechanismSpec = Field(...)


UPS = {"type": "UPS", "base_m": [0, 0, 0], "platform_m": [0, 0, 0], "length_m": [1, 2]}
PUS = {"type": "PUS", "base_m": [0, 0, 0], "platform_m": [0, 0, 0], "axis": [1, 0, 0], "slide_m": [0, 1], "link_m": 1}
RUS = {
    "type": "RUS", "base_m": [0, 0, 0], "platform_m": [0, 0, 0], "axis": [0, 1, 0], "zero": [1, 0, 0],
    "crank_m": 1, "link_m": 2, "angle_deg": [0, 90],
}  # fmt: skip
DELTA = {**RUS, "type": "delta"}
SERIAL = {"type": "serial", "robot": {"library": "ur5e"}, "actuated": ["shoulder_pan_joint"]}


def legs(*each):
    return {"legs": list(each)}


def without(leg, field):
    return legs({name: value for name, value in leg.items() if name != field})


MALFORMED = [
    (3, "mechanism", "must be an object, or a name of the library of mechanisms, not 3"),
    ({}, "mechanism", 'must have "library" (one of "stewart_gough", "six_pus", "delta", "master_4dof") or "legs"'),
    (
        "hexapod",
        "mechanism",
        'must have as "library" one of "stewart_gough", "six_pus", "delta", "master_4dof", not "hexapod"',
    ),
    ({"library": 6}, "mechanism", "one of"),
    ({"library": "delta", "legs": [UPS]}, "mechanism", "a mechanism has one source"),
    ({"library": "six_pus", "side": 5}, "mechanism.side", "is not a known field; did you mean side_m?"),
    ({"library": "six_pus", "side_m": -5}, "mechanism.side_m", "must be greater than 0, not -5"),
    ({"library": "six_pus", "side_m": "5"}, "mechanism.side_m", "must be a number"),
    ({"library": "six_pus", "link_m": [1, 2]}, "mechanism.link_m", "must be a number above 0, or a list of three"),
    ({"library": "six_pus", "slide_m": [-1, 2]}, "mechanism.slide_m", "must be [shortest, longest], neither negative"),
    ({"library": "six_pus", "slide_m": [2, 1]}, "mechanism.slide_m", "lower below upper"),
    ({"library": "stewart_gough", "length_m": [1, 1]}, "mechanism.length_m", "lower below upper"),
    ({"library": "stewart_gough", "base_points_m": [[0, 0, 0]] * 5}, "mechanism.base_points_m", "a list of 6 points"),
    ({"library": "stewart_gough", "base_angle_deg": 120}, "mechanism.base_angle_deg", "must be less than 120"),
    ({"library": "delta", "crank_m": 0}, "mechanism.crank_m", "must be greater than 0"),
    ({"library": "delta", "crank_m": float("nan")}, "mechanism.crank_m", "must be a finite number"),
    ({"library": "delta", "angle_deg": [90, -30]}, "mechanism.angle_deg", "lower below upper"),
    ({"library": "delta", "minimum_leg_distance_m": 0}, "mechanism.minimum_leg_distance_m", "greater than 0"),
    ({"library": "delta", "region": {"lower_m": [0, 0]}}, "mechanism.region.lower_m", "a list of 3 finite numbers"),
    (
        {"library": "delta", "region": {"lower_m": [0, None, None], "upper_m": [0, None, None]}},
        "mechanism.region.upper_m",
        "must be above lower_m; along x it is 0",
    ),
    (legs(), "mechanism.legs", "must have at least 1 items"),
    (legs(*[UPS] * 13), "mechanism.legs", "must have at most 12 items"),
    (legs(DELTA, DELTA), "mechanism.legs", 'must be 3 where they are "delta", not 2'),
    (legs(DELTA, DELTA, UPS), "mechanism.legs", 'must not mix "delta" with others'),
    (
        legs({**UPS, "type": "UPU"}),
        "mechanism.legs.0.type",
        'must be one of "UPS", "PUS", "RUS", "delta", "serial", not "UPU"',
    ),
    (without(SERIAL, "robot"), "mechanism.legs.0.robot", "is required"),
    (legs({**SERIAL, "robot": {}}), "mechanism.legs.0.robot.library", "is required, or another source"),
    (
        legs({**SERIAL, "robot": {"library": "ur5e", "mjcf": "<mujoco/>"}}),
        "mechanism.legs.0.robot.mjcf",
        "a robot has one source",
    ),
    (legs({**SERIAL, "robot": {"mjcf": ""}}), "mechanism.legs.0.robot.mjcf", "must not be empty"),
    (legs({**SERIAL, "robot": {"mjcf": 5}}), "mechanism.legs.0.robot.mjcf", "must be a string"),
    (legs({**SERIAL, "holds": "angle"}), "mechanism.legs.0.holds", 'must be "position" or "pose"'),
    (
        legs({**SERIAL, "attachment": {"rpy_deg": [0, 0, 9]}}),
        "mechanism.legs.0.attachment",
        "must have no orientation with",
    ),
    (legs({**SERIAL, "attachment": [0, 0, 0]}), "mechanism.legs.0.attachment", "must be an object"),
    (legs({**SERIAL, "actuated": ["a", "a"]}), "mechanism.legs.0.actuated", 'must be different names, not "a", "a"'),
    (legs({**SERIAL, "actuated": "a"}), "mechanism.legs.0.actuated", "must be a list"),
    (legs({**SERIAL, "base_m": [0, 0, 0]}), "mechanism.legs.0.base_m", "is not a known field"),
    (legs({**SERIAL, "tip": 3}), "mechanism.legs.0.tip", "must be a string"),
    (legs(DELTA, DELTA, SERIAL), "mechanism.legs", 'must not mix "delta" with others'),
    (
        {**legs(SERIAL), "minimum_leg_distance_m": 0.1},
        "mechanism.minimum_leg_distance_m",
        'must be null with legs of the type "serial"',
    ),
    (legs({}), "mechanism.legs.0.type", "it is required"),
    (legs(7), "mechanism.legs.0", "must be an object"),
    (without(UPS, "length_m"), "mechanism.legs.0.length_m", "is required"),
    (without(PUS, "axis"), "mechanism.legs.0.axis", "is required"),
    (legs(UPS, {**UPS, "length_m": [-1, 2]}), "mechanism.legs.1.length_m", "neither negative"),
    (legs({**UPS, "link_m": 1}), "mechanism.legs.0.link_m", "is not a known field"),
    (legs({**PUS, "axis": [0, 0, 0]}), "mechanism.legs.0.axis", "not all 0"),
    (legs({**PUS, "branch": "left"}), "mechanism.legs.0.branch", 'must be "plus", "minus" or "either"'),
    (legs({**PUS, "slide_m": [0, 1e9]}), "mechanism.legs.0.slide_m", "within ±1e+06"),
    (legs({**RUS, "zero": [1, 1, 0]}), "mechanism.legs.0.zero", "must be at right angles to axis"),
    (legs({**RUS, "angle_deg": [-200, 200]}), "mechanism.legs.0.angle_deg", "must not span more than 360°, here 400°"),
    ({"library": "delta", "before": [{}]}, "mechanism.before.0.limits_deg", "must be given for a revolute joint"),
    (
        {"library": "delta", "after": [{"type": "prismatic", "limits_deg": [0, 1]}]},
        "mechanism.after.0.limits_m",
        "must be given for a prismatic joint",
    ),
    (
        {"library": "delta", "before": [{"limits_deg": [0, 1]}] * 4},
        "mechanism.before",
        "must have at most 3 items",
    ),
    (
        {"library": "delta", "before": [{"limits_deg": [0, 1], "axis": [0, 0, 0]}]},
        "mechanism.before.0.axis",
        "not all 0",
    ),
    ({"library": "delta", "before": [{"limits_deg": [0, 400]}]}, "mechanism.before.0.limits_deg", "more than 360"),
    ({"library": "delta", "before": [{"limits_deg": [0, 9], "levels": 1}]}, "mechanism.before.0.levels", "at least 2"),
    (
        legs({**UPS, "base_cone": {"axis": [0, 0, 1], "half_angle_deg": 190}}),
        "mechanism.legs.0.base_cone.half_angle_deg",
        "must be at most 180",
    ),
]


@pytest.mark.parametrize(("document", "field", "message"), MALFORMED)
def test_malformed(document, field, message):
    with pytest.raises(DocumentError) as caught:
        Holder(mechanism=document)
    (found, text), *_ = caught.value.problems
    assert found == field
    assert message in text


@pytest.mark.parametrize(
    ("document", "kind"),
    [
        ("six_pus", SixPUS),
        ({"library": "stewart_gough"}, StewartGough),
        ("delta", Delta),
        ("master_4dof", Master4DOF),
        (legs(UPS), LegsMechanism),
        (legs(UPS, SERIAL), LegsMechanism),
    ],
)
def test_kinds(document, kind):
    mechanism = Holder(mechanism=document).mechanism
    assert type(mechanism) is kind
    assert Holder(mechanism=mechanism.model_dump(mode="json")).mechanism == mechanism


def test_one_length_of_link_is_that_of_all():
    mechanism = Holder(mechanism={"library": "six_pus", "link_m": 2.5}).mechanism
    assert isinstance(mechanism, SixPUS) and mechanism.link_m == (2.5, 2.5, 2.5)


def test_the_schema_tells_the_kinds_apart():
    schema = Holder.model_json_schema()
    assert {"StewartGough", "SixPUS", "Delta", "LegsMechanism"} <= schema["$defs"].keys()
