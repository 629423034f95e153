"""Units of indices against what the values do when lengths, masses and times are counted in other units."""

import re
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.text import Text

import wsrender as ws
from tests.reference import local_indices, mujoco_kinematics
from tests.run.simple_robots import PLANAR, planar_arm
from wsrender.analyses.parallel_workspace.job import ParallelWorkspaceJob
from wsrender.engine import units_of
from wsrender.indices.index_catalogue import find, unit
from wsrender.indices.units import pretty_unit, task_matrix
from wsrender.mechanisms.hybrid import variants
from wsrender.robot.indices import evaluation_of

SAMPLES = 6
SCALES = {"m": 2.0, "kg": 3.0, "s": 5.0}
EXPONENT = 1e-6  # error of an exponent from float64 values
GENERIC = 1e-5  # and least spread of those of a value that mixes units
TASKS = ["linear", "angular", "full", ("x", "y"), ("z",), ("x", "y", "rz")]
UP, ALONG = (0, 0, 1), (1, 0, 0)


@dataclass(frozen=True)
class Arm:
    """Joint axes, link offsets [m] and masses of an arm, and how many of its units make one of ours."""

    kinds: str  # of R and P
    axes: np.ndarray
    links: np.ndarray
    m: float = 1.0
    kg: float = 1.0
    s: float = 1.0

    def mjcf(self):
        opened, actuators = "", ""
        for k, (kind, axis, link) in enumerate(zip(self.kinds, self.axes, self.links, strict=True)):
            joint, limits = (
                ("hinge", np.array([-2.5, 2.5])) if kind == "R" else ("slide", np.array([-0.3, 0.7]) * self.m)
            )
            inertia = (2 + k) * self.kg * self.m**2
            opened += (
                f'<body pos="{text(link * self.m)}"><joint name="j{k}" type="{joint}" axis="{text(axis)}" '
                f'range="{text(limits)}"/><inertial pos="{text(link[::-1] * self.m)}" mass="{(1 + k) * self.kg}" '
                f'diaginertia="{inertia} {inertia} {inertia}"/>'
            )
            effort = (5 + k) * self.kg * self.m**2 / self.s**2 / (self.m if kind == "P" else 1)
            actuators += f'<motor joint="j{k}" ctrlrange="{-effort} {effort}"/>'
        tip = f'<site name="tool" pos="{text(self.links[-1] * self.m)}"/>'
        return (
            '<mujoco><compiler angle="radian"/><worldbody>'
            f"{opened}{tip}{'</body>' * len(self.kinds)}</worldbody><actuator>{actuators}</actuator></mujoco>"
        )

    def robot(self):
        return ws.load_robot(self.mjcf(), base="world", tip="tool")

    def jacobians(self, robot, q):
        """J (N, 6, n) and M (N, n, n) by MuJoCo at configurations of our units."""
        q = q * np.where(np.array([*self.kinds]) == "P", self.m, 1.0)
        names = robot.joint_names
        states = [mujoco_kinematics.at(robot.model, dict(zip(names, row, strict=True))) for row in q]
        J = [mujoco_kinematics.jacobian(robot.model, data, "tool", names) for data in states]
        return np.array(J), np.array([mujoco_kinematics.inertia_matrix(robot.model, d, names) for d in states])


def text(values):
    return " ".join(f"{value:.17g}" for value in values)


def values(arm, robot, q, task, convention, torque_scaling):
    """The twelve indices by NumPy, (N,) each; the length that divides linear rows is one of the arm's own metres."""
    J, M = arm.jacobians(robot, q)
    A = local_indices.task_matrix(J, task, arm.m)
    if convention == "wsrender_code":
        kinematic, dynamic = local_indices.wsrender_code(J), local_indices.wsrender_code(J, M)
    elif convention == "table_1":
        kinematic, dynamic = local_indices.table_1(A), local_indices.table_1_dynamic(A, M)
    else:
        B = np.linalg.solve(M, A.transpose(0, 2, 1)).transpose(0, 2, 1)
        if torque_scaling:
            B = B * robot.chain.effort_limits
        kinematic, dynamic = local_indices.standard(A), local_indices.standard(B)
    return kinematic | {f"dynamic_{name}": value for name, value in dynamic.items()}


def exponents(unit):
    """{"m": …, "kg": …, "s": …} of a unit's text."""
    above, _, below = re.sub(r"\((\d+)/(\d+)\)", r"\1:\2", unit).partition("/")
    found = dict.fromkeys(SCALES, Fraction(0))
    for part, sign in ((above, 1), (below, -1)):
        for factor in re.findall(r"(kg|m|s)(?:\^([0-9:]+))?", part):
            found[factor[0]] += sign * Fraction(factor[1].replace(":", "/") or 1)
    return found


def assert_dimensions(arm, task="linear", convention="standard", torque_scaling=False, indices="all"):
    robot = arm.robot()
    q = np.random.default_rng(1).uniform(-0.25, 0.65, (SAMPLES, robot.chain.n))
    evaluation = evaluation_of(
        robot, indices=indices, task=task, convention=convention, joint_limit_penalty=None, characteristic_length_m=1.0,
        torque_scaling=torque_scaling, index_options={}, inertia="kernel", precision="float64",
    )  # fmt: skip
    units = units_of(evaluation)
    ours = values(arm, robot, q, task, convention, torque_scaling)
    slopes = {}
    for of, scale in SCALES.items():
        scaled = replace(arm, **{of: scale})
        theirs = values(scaled, scaled.robot(), q, task, convention, torque_scaling)
        with np.errstate(divide="ignore", invalid="ignore"):
            slopes[of] = {name: np.log(theirs[name] / ours[name]) / np.log(scale) for name in ours}
    told = 0
    for name, text in units.items():
        found = {of: slopes[of][name] for of in SCALES}
        if not all(np.isfinite(value).all() for value in found.values()):
            continue  # singular everywhere: 0 in any unit
        told += 1
        if text.startswith("mixed ("):
            assert np.ptp(found["m"]) > GENERIC, (name, text, found)
        else:
            for of, expected in exponents(text).items():
                assert found[of] == pytest.approx(np.full(SAMPLES, float(expected)), abs=EXPONENT), (name, text, of)
    return units, told


def random_arm(kinds, seed=0):
    rng = np.random.default_rng(seed)
    axes, links = rng.normal(size=(len(kinds), 3)), rng.uniform(0.2, 0.6, (len(kinds), 3))
    return Arm(kinds, axes / np.linalg.norm(axes, axis=1, keepdims=True), links)


@pytest.mark.parametrize("task", TASKS)
@pytest.mark.parametrize("kinds", ["RRR", "PPP", "RPP", "RRP", "RRRR", "RPRR", "RRRRRR", "PPPRRR"])
def test_units_are_what_the_values_scale_by(kinds, task):
    _, told = assert_dimensions(random_arm(kinds), task)
    assert told or len(kinds) < 6 or task == "angular"


@settings(max_examples=15, deadline=None, derandomize=True)
@given(kinds=st.text("RP", min_size=3, max_size=5), task=st.sampled_from(TASKS), seed=st.integers(0, 99))
def test_units_of_any_arm(kinds, task, seed):
    assert_dimensions(random_arm(kinds, seed), task)


@pytest.mark.parametrize("kinds", ["RRR", "PPP", "RPP", "RRRRRR"])
def test_units_of_efforts_that_scale(kinds):
    units, _ = assert_dimensions(random_arm(kinds), torque_scaling=True)
    assert units["dynamic_minimum_singular_value"] == "m/s^2"  # of columns that turn and that slide alike


@pytest.mark.parametrize("convention", ["table_1", "wsrender_code"])
@pytest.mark.parametrize("kinds", ["RRR", "RPP", "RRRRRR", "PPPRRR"])
def test_units_of_other_conventions(kinds, convention):
    assert_dimensions(random_arm(kinds), "linear", convention)


def test_a_joint_that_moves_nothing_in_the_task_mixes_nothing():
    """A SCARA: its slide is vertical, its last joint turns about the tip."""
    axes, links = np.array([UP, UP, UP, UP], float), np.array([UP, ALONG, ALONG, (0, 0, 0)], float)
    scara = Arm("RRPR", axes, links)
    across, _ = assert_dimensions(scara, ("x", "y"), indices="kinematic")
    whole, _ = assert_dimensions(scara, "linear", indices=["manipulability"])
    assert across["manipulability"] == "m^2" and across["inverse_condition_number"] == "1"
    assert whole["manipulability"] == "m^2"  # square metres of the plane, times 1


@pytest.mark.parametrize(
    ("robot", "expected"),
    [("ur5e", "m^3"), ("spherical", "m^2"), ("cylindrical", "m"), ("cartesian", "1")],
)
def test_manipulability_of_the_library(robot, expected):
    document = ws.execute(
        {
            "analysis": "indices_at",
            "robot": robot,
            "configurations": [ws.load_robot(robot).chain.within(0.4).tolist()],
            "device": "cpu",
        }
    ).document
    assert document["indices"]["manipulability"]["unit"] == expected


def test_mixed_units_are_told_in_document_table_picture_and_files(tmp_path):
    result = ws.analyze(
        "cylindrical", ws.Sobol(2000), ["minimum_singular_value"], voxel_size_m=0.1, refined_volume=None, keep_map=True,
        device="cpu",
    )  # fmt: skip
    assert result.document["indices"]["minimum_singular_value"]["unit"] == "mixed (m, 1)"
    assert result.map.units == result.volume.units == {"minimum_singular_value": "mixed (m, 1)"}
    assert "mixed (m, 1)" in result.summary()
    drawn = result.plot.slice(z=-0.1, index="minimum_singular_value").findobj(Text)
    assert any("minimum singular value [mixed (m, 1)]" in text.get_text() for text in drawn)
    result.save(tmp_path / "out")
    assert all(
        artifact["units"]["minimum_singular_value"] == "mixed (m, 1)"
        for artifact in result.document["artifacts"]
        if "minimum_singular_value" in artifact["units"]
    )
    assert ws.Result.load(tmp_path / "out").volume.units == result.volume.units


def test_columns_of_a_mechanism_are_those_of_its_actuators():
    def units(mechanism, task):
        (only,) = variants(ParallelWorkspaceJob(mechanism=mechanism).mechanism)
        return {name: unit(name, task_matrix(task, only.revolute)) for name in ("manipulability", "isotropy")}

    assert units("stewart_gough", range(6)) == {"manipulability": "1/m^6", "isotropy": "1"}
    assert units("delta", range(3)) == {"manipulability": "m^3", "isotropy": "1"}


def test_a_unit_of_the_user_may_follow_from_the_task():
    spread = ws.Index("spread", "Δσ", lambda s, m, n: s[0] - s[-1], "test", unit=lambda A: A.value)
    matrix = task_matrix((0, 1, 2), (True, True, False))
    assert str(spread.unit(task_matrix((0, 1, 2), (True, True, True)))) == "m"
    with pytest.raises(Exception, match=r"mixed \(m, 1\)"):
        spread.unit(matrix)
    assert unit("manipulability", matrix) == "m^2" and callable(find("manipulability").unit)


@pytest.mark.parametrize(
    ("text", "pretty"),
    [
        ("m^3", "m³"),
        ("1/(kg^3 m^15)", "1/(kg³ m¹⁵)"),
        ("m^(2/3)", "m^(2/3)"),
        ("mixed (m^2, 1)", "mixed (m², 1)"),
        ("m3", "m³"),
        ("deg/s", "°/s"),
        ("m/s^2", "m/s²"),
    ],
)
def test_units_for_people(text, pretty):
    assert pretty_unit(text) == pretty


def test_a_planar_arm_keeps_square_metres():
    document = ws.analyze(planar_arm(), ws.Grid(20), **PLANAR, refined_volume=None).document
    assert document["indices"]["manipulability"]["unit"] == "m^2"
