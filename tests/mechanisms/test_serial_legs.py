"""Legs that are solved numerically against the same legs in closed form, and indices against finite differences."""

from functools import cache

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.mechanisms import serial_legs
from tests.mechanisms.mechanisms import SPEC, mechanism, poses_of
from wsrender.documents.legs import UPSLeg
from wsrender.mechanisms.inverse_kinematics import inverse_kinematics
from wsrender.mechanisms.jacobians import CONDITION_NUMBERS, jacobians, pose_indices
from wsrender.mechanisms.mechanism import legs_of
from wsrender.mechanisms.membership import count_lattice, fault_at, placed_box, poses_labelled, reachable_box
from wsrender.reach.evidence import REACHABLE, UNDECIDED
from wsrender.run import execute, plan
from wsrender.volume.lattice import block_around

NAMES = ("manipulability", "inverse_condition_number", "isotropy")
JOB = {"analysis": "parallel_workspace", "voxel_size_m": 0.05, "device": "cpu"}
PLATFORM_FROM_ARM = {"left": [-0.15, 0.0, 0.0], "right": [0.15, 0.0, 0.0]}


def either(leg):
    """The document of a leg, its crank on either side."""
    document = leg.model_dump(mode="json")
    return document if isinstance(leg, UPSLeg) else {**document, "type": "RUS", "branch": "either"}


@cache
def pairs(name):
    """A mechanism of the library, with legs in closed form and the same with serial ones."""
    legs = legs_of(SPEC.validate_python(name))
    serial = [serial_legs.ups(leg.model_dump()) if isinstance(leg, UPSLeg) else serial_legs.crank(leg) for leg in legs]
    side = "lower_m" if name == "stewart_gough" else "upper_m"
    region = {side: [None, None, 0.0]}
    return {"legs": [either(leg) for leg in legs], "region": region}, {"legs": serial, "region": region}


@pytest.mark.parametrize(("name", "size"), [("stewart_gough", 0.03), ("delta", 0.06)])
def test_voxels_of_serial_legs_are_those_of_the_closed_form(name, size):
    """At every centre, by both methods, and none undecided."""
    closed, serial = (mechanism(document) for document in pairs(name))
    rotations = Rotation.from_rotvec([[0, 0, 0], [0.1, -0.15, 0.05]]).as_matrix()
    box = placed_box(closed, reachable_box(closed, rotations))
    block = block_around(box.lower, box.upper, size)
    weights = np.array([1, 10], np.int32)
    options = {"weights": weights, "device": "cpu"}
    expected = count_lattice(closed, block, rotations, 0, block.size, **options)
    every, survivors = (
        count_lattice(serial, block, rotations, 0, block.size, by_subsystem=by_subsystem, **options)
        for by_subsystem in (False, True)
    )
    for found in (every, survivors):
        np.testing.assert_array_equal(found.cells, expected.cells)
        np.testing.assert_array_equal(found.reached, expected.reached)
        np.testing.assert_array_equal(found.weights, expected.weights)
        assert found.undecided == 0
    assert 0 < len(expected.cells) < block.size / 2
    assert every.asked == block.size * 2 * len(serial.numeric) > 1.4 * survivors.asked


@pytest.mark.parametrize("name", ["stewart_gough", "delta"])
def test_labels_at_the_boundary(name):
    """A micrometre inside and outside of the boundary of the closed form every pose is decided, and rightly; a tenth of
    that outside some are undecided, within 1e-7 of the reach."""
    closed, serial = (mechanism(document) for document in pairs(name))
    random = np.random.default_rng(4)
    box = reachable_box(closed, np.eye(3)[None])
    points = random.uniform(box.lower, box.upper, (3000, 3))
    reached = inverse_kinematics(closed, poses_of(points)).feasible
    inside, outside = (points[which][:80] for which in (reached, ~reached))
    low, high = np.zeros(80), np.ones(80)
    for _ in range(50):
        middle = (low + high) / 2
        fits = inverse_kinematics(closed, poses_of(inside + middle[:, None] * (outside - inside))).feasible
        low, high = np.where(fits, middle, low), np.where(fits, high, middle)
    for distance in (1e-7, 1e-6):
        step = distance / np.linalg.norm(outside - inside, axis=1)
        for expected, share in ((True, low - step), (False, high + step)):
            poses = poses_of(inside + share[:, None] * (outside - inside))
            labels, _ = poses_labelled(serial, poses, device="cpu")
            decided = labels != UNDECIDED
            np.testing.assert_array_equal(labels[decided] == REACHABLE, expected)
            assert decided.all() or (distance == 1e-7 and not expected)


def test_closed_and_serial_legs_in_one_mechanism():
    """In any order; a fault names the leg by its place in the document."""
    closed, serial = pairs("stewart_gough")
    mixed = mechanism({**closed, "legs": [(serial if k % 2 else closed)["legs"][k] for k in range(6)]})
    whole = mechanism(closed)
    poses = poses_of(np.random.default_rng(1).uniform([-0.3, -0.3, 0.2], [0.3, 0.3, 0.9], (2000, 3)))
    labels, _ = poses_labelled(mixed, poses, device="cpu")
    legs = inverse_kinematics(whole, poses)
    np.testing.assert_array_equal(labels == REACHABLE, legs.feasible)
    assert mixed.numbers == [0, 2, 4] and not fault_at(mixed, poses_of([[0, 0, 0.55]])[0])
    only_second = np.flatnonzero((legs.faults > 0).sum(axis=1) * (legs.faults[:, 1] > 0) == 1)[0]
    assert fault_at(mixed, poses[only_second]).startswith("leg 2 (serial) does not reach its place at the platform")
    assert fault_at(mixed, poses_of([[0, 0, 3.0]])[0]).startswith("leg 1 (UPS)")


@pytest.mark.parametrize("name", ["stewart_gough", "mixed"])
def test_indices_of_serial_legs_are_those_of_the_closed_form(name):
    closed, serial = pairs("stewart_gough")
    if name == "mixed":
        serial = {**closed, "legs": [*closed["legs"][:3], *serial["legs"][3:]]}
    poses = poses_of(
        np.random.default_rng(2).uniform([-0.03, -0.03, 0.52], [0.03, 0.03, 0.58], (30, 3)),
        Rotation.from_rotvec([0.05, -0.1, 0.08]).as_matrix(),
    )
    expected, found = (pose_indices(mechanism(document), poses, NAMES, range(6), 0.3) for document in (closed, serial))
    assert found.keys() == {*NAMES, *CONDITION_NUMBERS}
    for key, values in found.items():
        np.testing.assert_allclose(values, expected[key], rtol=1e-6)


def test_crank_legs_have_the_indices_of_the_closed_form():
    """Six cranks; B depends on the side that the crank stands on, so ranges leave one."""
    angles = np.deg2rad([0, 60, 120, 180, 240, 300])
    legs = [
        {"type": "RUS", "base_m": [np.cos(a), np.sin(a), 0], "axis": [-np.sin(a), np.cos(a), 0],
         "platform_m": [0.4 * np.cos(a + s), 0.4 * np.sin(a + s), 0], "zero": [np.cos(a), np.sin(a), 0],
         "crank_m": 0.4, "link_m": 1.3, "angle_deg": [-120, 60]}
        for a, s in zip(angles, [0.3, -0.3] * 3, strict=True)
    ]  # fmt: skip
    serial = [serial_legs.crank(leg) for leg in SPEC.validate_python({"legs": legs}).legs]
    poses = poses_of(np.random.default_rng(2).uniform([0, -0.07, 1.05], [0.1, 0.03, 1.15], (20, 3)))
    closed = mechanism({"legs": legs})
    assert inverse_kinematics(closed, poses).feasible.all()
    expected, found = (pose_indices(m, poses, NAMES, range(6)) for m in (closed, mechanism({"legs": serial})))
    for key, values in found.items():
        np.testing.assert_allclose(values, expected[key], rtol=1e-6)


def two_arms(actuated=(("joint1", "joint2", "joint3"),) * 2):
    """A platform in the hands of two arms."""
    legs = [
        {"type": "serial",
         "robot": {"library": "puma560", "placement": {"position_m": [x, 0, 0], "rpy_deg": [0, 0, yaw]}},
         "attachment": {"position_m": PLATFORM_FROM_ARM[side], "rpy_deg": [0, 0, yaw]}, "holds": "pose",
         "actuated": list(names)}
        for side, x, yaw, names in zip(("left", "right"), (-0.6, 0.6), (0, 180), actuated, strict=True)
    ]  # fmt: skip
    return {"legs": legs}


def test_rows_of_legs_that_hold_the_pose_are_derivatives():
    """A ẋ = B q̇ with q̇ of the actuated joints by central differences, each leg solved by least squares on MuJoCo's
    forward kinematics."""
    mech, step = mechanism(two_arms()), 1e-5
    poses = poses_of([[0.05, 0.1, 0.5], [-0.02, 0.05, 0.6]], Rotation.from_rotvec([0.1, 0.2, -0.1]).as_matrix())
    assert (poses_labelled(mech, poses, device="cpu")[0] == REACHABLE).all()
    J = jacobians(mech, inverse_kinematics(mech, poses), poses, 0.4)
    assert J.A.shape == J.B.shape == (2, 6, 6)
    for k, pose in enumerate(poses):
        for axis in range(6):
            rates = []
            for sign in (1, -1):
                there = pose.copy()
                if axis < 3:
                    there[axis, 3] += sign * step
                else:
                    there[:3, :3] = Rotation.from_rotvec(sign * step * np.eye(3)[axis - 3]).as_matrix() @ there[:3, :3]
                rates.append([moved(leg, pose, there)[leg.actuated] for leg in mech.numeric])
            rate = (np.concatenate(rates[0]) - np.concatenate(rates[1])) / (2 * step)
            np.testing.assert_allclose(J.B[k] @ rate, J.A[k, :, axis], atol=2e-5)


def moved(leg, pose, there):
    """The leg's configuration at a pose near one that it reaches."""
    target = there @ leg.T_platform_tip

    def residual(q):
        return (leg.robot.forward_kinematics(q, device="cpu")[0] - target)[:3].ravel()

    return least_squares(residual, leg.solve(pose[None]).q[0], xtol=1e-15, ftol=1e-15, gtol=1e-15).x


def test_workspaces_of_two_arms(tmp_path):
    """Orientations at a point, total orientation and indices, through the four steps; legs in the picture."""
    tilts = {"tilt_deg": 20, "tilts": 2, "azimuths": 4}
    at_point = execute({**JOB, "voxel_size_m": None, "mechanism": two_arms(), "kind": "orientation",
                        "position_m": [0, 0.1, 0.55], "orientations": tilts})  # fmt: skip
    mech = mechanism(two_arms())
    rotations = Rotation.from_quat(at_point.tables["orientations"]["quat_wxyz"], scalar_first=True).as_matrix()
    labels = [poses_labelled(mech, poses_of([[0, 0.1, 0.55]], R), device="cpu")[0][0] for R in rotations]
    np.testing.assert_array_equal(at_point.tables["orientations"]["reached"], np.array(labels) == REACHABLE)
    assert at_point.document["sampling"]["undecided"] == labels.count(UNDECIDED)
    region = {"lower_m": [-0.1, 0, 0.4], "upper_m": [0.1, 0.2, 0.6]}
    job = {**JOB, "mechanism": {**two_arms(), "region": region}, "voxel_size_m": 0.1, "indices": ["manipulability"]}
    result = execute(job)
    assert result.volume.count.sum() > 0 and result.skeleton.shape[0] == 2 and "singularities" not in result.document
    assert result.document["mechanism"]["legs"][1]["robot"]["name"] == "puma560"
    result.save(tmp_path)
    total = execute({**job, "kind": "total_orientation", "orientations": tilts, "indices": []}).document["volume_m3"]
    assert total["occupied"] <= result.document["volume_m3"]["occupied"]


def test_a_leg_in_a_file(tmp_path):
    """From Python, with the leg's model in a file and in a design."""
    (tmp_path / "leg.xml").write_text(LEG["robot"]["mjcf"])
    closed, serial = pairs("stewart_gough")
    legs = [{**LEG, "robot": {"path": str(tmp_path / "leg.xml")}}, *serial["legs"][1:]]
    volumes = [
        ws.parallel_workspace({**closed, "legs": each}, voxel_size_m=0.1, refined_volume=None, device="cpu").document[
            "volume_m3"
        ]
        for each in (legs, closed["legs"])
    ]
    assert volumes[0] == volumes[1] and volumes[0]["occupied"] > 0
    best = ws.design_optimization(
        {**JOB, "mechanism": {**closed, "legs": legs}, "voxel_size_m": 0.1},
        [{"name": "x", "pointers": ["/mechanism/legs/0/attachment/position_m/0"], "bounds": [0.1, 0.3]}],
        [{"value": "/volume_m3/occupied"}],
        search={"method": "sweep", "steps": 2},
    )
    assert len(best.tables["evaluations"]) == 2


def test_a_hybrid_with_serial_legs():
    """A turntable below and a tool above: the voxels of the same hybrid with legs in closed form."""
    joints = {
        "before": [{"limits_deg": [0, 90], "levels": 2}],
        "after": [{"type": "prismatic", "limits_m": [0, 0.1], "levels": 2}],
    }
    job = {**JOB, "refined_volume": None}
    volumes = [execute({**job, "mechanism": {**document, **joints}}).volume for document in pairs("stewart_gough")]
    np.testing.assert_array_equal(*(volume.count for volume in volumes))
    assert volumes[0].first_voxel == volumes[1].first_voxel


LEG = pairs("stewart_gough")[1]["legs"][0]


@pytest.mark.parametrize(
    ("leg", "fields", "field", "message"),
    [
        (
            {"actuated": ["elbow"]},
            {},
            "mechanism.legs.0.actuated",
            'joints of the leg, "a", "b", "length", not "elbow"',
        ),
        ({"tip": "hand"}, {}, "mechanism.legs.0", "hand"),
        ({"robot": {"mjcf": "<mujoco>"}}, {}, "mechanism.legs.0", "no element found"),
        ({"robot": {"library": "ur6"}}, {}, "mechanism.legs.0", "ur6"),
        ({"actuated": []}, {"indices": "kinematic"}, "mechanism.legs.0.actuated", "must name the actuated joints"),
        (
            {"actuated": ["a", "length"]},
            {"indices": "kinematic"},
            "mechanism.legs",
            "must hold the platform by 6 constraints for Jacobians and indices, not 7",
        ),
        (
            {"robot": {"library": "ur5e"}, "actuated": ["joint1"]},
            {"indices": "kinematic"},
            "mechanism.legs.0.actuated",
            "5 take all 3 constraints away",
        ),
    ],
)
def test_jobs_that_cannot_be_planned(leg, fields, field, message):
    legs = [{**LEG, **leg}, *pairs("stewart_gough")[0]["legs"][1:]]
    with pytest.raises(ws.InputError) as caught:
        plan({**JOB, "mechanism": {"legs": legs}, **fields})
    assert caught.value.field.startswith(field)
    assert message in str(caught.value)


def test_an_unreachable_home_names_the_leg():
    far = {**LEG, "attachment": {"position_m": [0, 0, 5]}}
    legs = [*pairs("stewart_gough")[0]["legs"][:5], far]
    with pytest.raises(ws.InputError, match=r"leg 6 \(serial\) does not reach"):
        plan({**JOB, "mechanism": {"legs": legs, "home": {"position_m": [0, 0, 0.55]}}})
