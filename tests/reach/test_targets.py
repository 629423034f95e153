"""Reachable or not, against closed-form inverse kinematics and workspaces that are known exactly."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.reference import closed_form_inverse as closed_form
from tests.run.simple_robots import gantry
from wsrender.reach.moving_joints import moving_joints
from wsrender.robots.reachable_box import reachable_box

RECOVERED = 0.995  # share of targets made by forward kinematics, to 1e-4 m
EXACT = 1e-9  # m and rad: nothing lies so near the boundary by chance
UNDECIDED = 0.005


def forward(robot, count, seed=0):
    random = np.random.default_rng(seed)
    q = random.uniform(robot.lower_limits, robot.upper_limits, (count, robot.chain.n))
    return robot.forward_kinematics(q, device="cpu")


def quat_wxyz(T):
    return Rotation.from_matrix(T[:, :3, :3]).as_quat(scalar_first=True)


def in_the_box(robot, count, seed=0):
    low, high = reachable_box(robot.chain, robot.lower_limits, robot.upper_limits)
    return np.random.default_rng(seed).uniform(low, high, (count, 3))


@pytest.mark.parametrize("with_orientation", [False, True], ids=["position", "pose"])
@pytest.mark.parametrize("name", ["ur5e", "franka_panda", "puma560", "spherical"])
def test_recovers_what_forward_kinematics_gave(name, with_orientation):
    robot = ws.load_robot(name, placement=ws.Transform(position_m=(0.3, -0.2, 0.1), rpy_deg=(20, -30, 140)))
    T = forward(robot, 10_000)
    found = ws.reachable(robot, T[:, :3, 3], quat_wxyz(T) if with_orientation else None, device="cpu")
    reached = found.labels == "reachable"
    assert reached.mean() >= RECOVERED
    q = found.configurations
    assert ((q >= robot.lower_limits - 1e-12) & (q <= robot.upper_limits + 1e-12)).all()
    back = robot.forward_kinematics(q, device="cpu")
    distance = np.linalg.norm(back[:, :3, 3] - T[:, :3, 3], axis=1)
    assert (distance[reached] < 1e-4).all()
    assert distance == pytest.approx(found.residual_m, abs=1e-12)
    if with_orientation:
        turned = Rotation.from_matrix(back[:, :3, :3]).inv() * Rotation.from_matrix(T[:, :3, :3])
        assert turned.magnitude() == pytest.approx(found.residual_rad, abs=1e-9)
        assert (found.residual_rad[reached] < 1e-4).all()


ARMS = {
    "puma560": closed_form.puma560_arm,
    "articulated": closed_form.articulated_arm,
    "spherical": closed_form.spherical_arm,
}


@pytest.mark.parametrize("name", ARMS)
def test_positions_agree_with_the_closed_form(name):
    robot = ws.load_robot(name)
    points = in_the_box(robot, 5_000)
    found = ws.reachable(robot, points, position_tolerance_m=EXACT, device="cpu")
    with np.errstate(invalid="ignore"):
        arm = ARMS[name](points)
    limits = robot.lower_limits[:3], robot.upper_limits[:3], robot.chain.revolute[:3]
    check_labels(found, closed_form.within_limits(arm, *limits).any(axis=1))


@pytest.mark.parametrize("name", ["puma560", "ur5e", "spherical"])
def test_poses_agree_with_the_closed_form(name):
    robot = ws.load_robot(name)
    points = in_the_box(robot, 2_000)
    rotations = Rotation.random(len(points), random_state=1).as_matrix()
    T = np.concatenate([rotations, points[:, :, None]], axis=2)
    found = ws.reachable(
        robot, points, quat_wxyz(T), position_tolerance_m=EXACT, angle_tolerance_rad=EXACT, device="cpu"
    )
    with np.errstate(invalid="ignore", divide="ignore"):
        if name == "ur5e":
            solutions = closed_form.ur5e(points, rotations)
        else:
            solutions = closed_form.with_spherical_wrist(name, ARMS[name](points), rotations)
    limits = robot.lower_limits, robot.upper_limits, robot.chain.revolute
    check_labels(found, closed_form.within_limits(solutions, *limits).any(axis=1))


def check_labels(found, truth):
    assert 0.05 < truth.mean() < 0.95
    assert not truth[found.labels == "unreachable"].any()
    assert truth[found.labels == "reachable"].all()
    assert (found.labels == "undecided").mean() <= UNDECIDED


@pytest.mark.parametrize("precision", ["float32", "float64"])
@pytest.mark.parametrize("name", ["ur5e", "puma560"])
def test_nothing_beyond_the_reach_is_reachable(name, precision, device):
    robot = ws.load_robot(name)
    random = np.random.default_rng(3)
    points = random.normal(size=(5_000, 3))
    points *= (robot.chain.reach * random.uniform(1.01, 3, 5_000) / np.linalg.norm(points, axis=1))[:, None]
    points += (robot.chain.T_world_base @ robot.chain.T_joint[0])[:3, 3]
    found = ws.reachable(robot, points, precision=precision, device=device)
    assert (found.labels == "unreachable").all()
    assert (found.reasons == "out of reach").all()


def test_residual_is_the_distance_to_the_workspace():
    robot = gantry()
    low, high = np.array([0.005, -0.395, 0.005]), np.array([0.295, -0.005, 0.195])
    points = np.random.default_rng(0).uniform(low - 0.2, high + 0.2, (2_000, 3))
    found = ws.reachable(robot, points, device="cpu")
    expected = np.linalg.norm(points - np.clip(points, low, high), axis=1)
    assert found.residual_m == pytest.approx(expected, abs=1e-5)
    assert ((found.labels == "reachable") == (expected == 0)).all()
    assert set(found.reasons[expected > 0]) == {"joint limits"}


def test_reasons():
    robot = ws.load_robot("articulated")  # links of 0.2 m; the first joint turns 45 … 135°
    in_front, behind, far = (0.0, 0.3, -0.15), (0.0, -0.3, -0.15), (0.0, 0.5, -0.15)
    found = ws.reachable(robot, [in_front, behind, far], device="cpu")
    assert list(found.labels) == ["reachable", "unreachable", "unreachable"]
    assert list(found.reasons) == ["", "joint limits", "out of reach"]


def test_a_target_as_far_off_as_the_tolerance_is_undecided():
    robot = ws.load_robot("spherical")  # its slide starts at 0.2 m
    middle = robot.forward_kinematics((robot.lower_limits + robot.upper_limits) / 2, device="cpu")[0, :3, 3]
    point = middle / np.linalg.norm(middle) * (0.2 - 1.5e-3)
    found = ws.reachable(robot, point, position_tolerance_m=1e-3, device="cpu")
    assert (found.labels[0], found.reasons[0]) == ("undecided", "too close to the tolerance")


def test_a_label_depends_on_its_target_alone(precision):
    robot = ws.load_robot("puma560")
    points = in_the_box(robot, 3_000)
    options = {"precision": precision, "device": "cpu", "position_tolerance_m": 1e-4}
    whole = ws.reachable(robot, points, **options, threads=1)
    order = np.random.default_rng(0).permutation(len(points))
    part = ws.reachable(robot, points[order][:1_000], **options, threads=2)
    assert (part.configurations == whole.configurations[order][:1_000]).all()
    assert (part.labels == whole.labels[order][:1_000]).all()
    assert (part.reasons == whole.reasons[order][:1_000]).all()


def test_positions_in_float32_on_every_device(device):
    robot = ws.load_robot("puma560")
    T = forward(robot, 20_000)
    found = ws.reachable(robot, T[:, :3, 3], precision="float32", device=device)
    assert (found.labels == "reachable").mean() >= RECOVERED


def test_coupled_joints():
    text = """<mujoco><compiler angle="radian"/><worldbody><body><joint name="a" axis="0 0 1" range="-1 1"/>
      <geom size="0.01" mass="1"/><body pos="0.4 0 0"><joint name="b" axis="0 0 1" range="-3 3"/>
      <geom size="0.01" mass="1"/><site name="tool" pos="0.3 0 0"/></body></body></worldbody>
      <equality><joint joint1="b" joint2="a" polycoef="0.2 2 0 0 0"/></equality></mujoco>"""
    from wsrender.documents.robot import RobotSpec
    from wsrender.robot import robot_of_spec

    robot = robot_of_spec(RobotSpec(mjcf=text))
    assert robot.chain.n == 1
    q = np.linspace(-1, 1, 101)
    points = np.stack(
        [0.4 * np.cos(q) + 0.3 * np.cos(3 * q + 0.2), 0.4 * np.sin(q) + 0.3 * np.sin(3 * q + 0.2), 0 * q], axis=1
    )
    found = ws.reachable(robot, points, device="cpu")
    assert (found.labels == "reachable").all()
    assert found.configurations[:, 0] == pytest.approx(q, abs=1e-3)
    assert (ws.reachable(robot, points + np.array([0, 0, 0.01]), device="cpu").labels != "reachable").all()


@pytest.mark.parametrize("name", ["ur5e", "franka_panda"])
def test_what_float32_calls_reachable_is_so_in_float64(name):
    """Of 3,000 targets rounding once put one or two just beyond the tolerance, and moved all residuals by 1e-7 m."""
    robot = ws.load_robot(name)
    limits = robot.lower_limits, robot.upper_limits
    T = robot.forward_kinematics(np.random.default_rng(0).uniform(*limits, (3000, robot.chain.n)), device="cpu")
    quat = Rotation.from_matrix(T[:, :3, :3]).as_quat(scalar_first=True)
    for orientations in (None, quat):
        accuracy = {"position_tolerance_m": 1e-5, "angle_tolerance_rad": 1e-4, "precision": "float32"}
        found = ws.reachable(robot, T[:, :3, 3], orientations=orientations, device="cpu", **accuracy)
        at = robot.forward_kinematics(found.configurations, device="cpu")
        distance = np.linalg.norm(at[:, :3, 3] - T[:, :3, 3], axis=1)
        assert (np.array(found.labels) == "reachable").all() and distance.max() <= 1e-5 * (1 + 1e-9)
        np.testing.assert_allclose(found.residual_m, distance, atol=1e-12)


@pytest.mark.parametrize("name", ["ur5e", "franka_panda", "puma560", "spherical", "slave_5r"])
def test_joints_that_do_not_move_the_point_are_left_out(name):
    robot = ws.load_robot(name)
    chain, kept = moving_joints(robot.chain)
    expected = {"ur5e": 5, "franka_panda": 6, "puma560": 3, "spherical": 3, "slave_5r": 2}[name]
    assert (chain.n, list(kept)) == (expected, list(range(expected)))
    from wsrender.engine import evaluate_kinematics

    q = np.random.default_rng(0).uniform(robot.lower_limits, robot.upper_limits, (100, robot.chain.n))
    shorter = evaluate_kinematics(chain, q[:, kept], device="cpu").pose[:, :3, 3]
    assert shorter == pytest.approx(robot.forward_kinematics(q, device="cpu")[:, :3, 3], abs=1e-12)


@pytest.mark.parametrize(
    ("points", "options", "field"),
    [
        ([[0.0, 0.1]], {}, "points"),
        ([[0.0, 0.1, np.nan]], {}, "points"),
        ("here", {}, "points"),
        ([[0.0, 0.1, 0.2]], {"orientations": [[1, 0, 0, 0], [1, 0, 0, 0]]}, "orientations"),
        ([[0.0, 0.1, 0.2]], {"orientations": [0, 0, 0, 0]}, "orientations"),
        ([[0.0, 0.1, 0.2]], {"precision": "float32", "position_tolerance_m": 1e-7}, "position_tolerance_m"),
        ([[0.0, 0.1, 0.2]], {"position_tolerance_m": "a"}, "position_tolerance_m"),
        ([[0.0, 0.1, 0.2]], {"angle_tolerance_rad": 0.0}, "angle_tolerance_rad"),
    ],
)
def test_wrong_arguments(points, options, field):
    with pytest.raises(ws.InputError) as error:
        ws.reachable(ws.load_robot("ur5e"), points, **options)
    assert error.value.field == field


def test_no_targets():
    found = ws.reachable(ws.load_robot("puma560"), np.zeros((0, 3)), device="cpu")
    assert found.configurations.shape == (0, 6)
    assert len(found.labels) == 0


def table(folder, text):
    (folder / "t.csv").write_text(text)
    return folder / "t.csv"


def test_free_axes_of_a_table(tmp_path):
    """Poses that are turned about an axis of the tip are out of a narrow wrist's reach, but for their free axis."""
    robot = ws.load_robot("puma560", limits={"joint4": (-1, 1), "joint5": (-1, 1), "joint6": (-0.3, 0.3)})
    T = forward(robot, 60, seed=4)
    spin = Rotation.random(60, random_state=2).as_rotvec()[:, :1]
    for k, axis in enumerate("xyz"):
        turned = Rotation.from_matrix(T[:, :3, :3]) * Rotation.from_rotvec(spin * np.eye(3)[k])
        quat = turned.as_quat(scalar_first=True)
        rows = [",".join(map(repr, [*p.tolist(), *q.tolist()])) for p, q in zip(T[:, :3, 3], quat, strict=True)]
        text = "\n".join(["x_m,y_m,z_m,qw,qx,qy,qz,free_axis", *(f"{row},{axis}" for row in rows)])
        found = ws.reachable(robot, table(tmp_path, text), device="cpu")
        back = robot.forward_kinematics(found.configurations, device="cpu")[:, :3, :3]
        kept = np.einsum("ni,ni->n", back[:, :, k], turned.as_matrix()[:, :, k])
        assert (found.labels == "reachable").all() and (np.arccos(np.clip(kept, -1, 1)) < 1e-4).all()
        assert found.residual_m.max() < 1e-5
        assert (ws.reachable(robot, T[:, :3, 3], quat, device="cpu").labels == "unreachable").mean() > 0.2


def test_rows_of_a_table_keep_their_order_and_their_own_tolerances(tmp_path):
    robot = ws.load_robot("ur5e")
    far = robot.chain.center + np.array([robot.chain.reach + 0.01, 0, 0])
    rows = ["x_m,y_m,z_m,position_tolerance_m,qw,qx,qy,qz"]
    beyond = ",".join(map(repr, far.tolist()))
    reach = ws.reachable(robot, [far], device="cpu").residual_m[0]
    rows += [f"{beyond},,,,,", "0.4,0.2,0.3,,0,1,0,0", f"{beyond},{reach * 1.01},,,,", "0.4,0.2,0.3,,,,,"]
    found = ws.reachable(robot, table(tmp_path, "\n".join(rows)), device="cpu")
    assert found.labels.tolist() == ["unreachable", "reachable", "reachable", "reachable"]
    pose = ws.reachable(robot, [[0.4, 0.2, 0.3]], [[0, 1, 0, 0]], device="cpu")
    assert np.array_equal(found.configurations[1], pose.configurations[0])
    with pytest.raises(ws.InputError, match="must not be given beside a table"):
        ws.reachable(robot, str(tmp_path / "t.csv"), [[1, 0, 0, 0]])


def test_millimetres_of_a_table_are_noticed(tmp_path):
    points = table(tmp_path, "x_m,y_m,z_m\n400,200,300\n300,0,500\n0.1,0,0.2\n")
    with pytest.raises(ws.InputError, match=r"length_unit_m: half of the targets are .* millimetres\? 0.001 converts"):
        ws.reachable("ur5e", points, device="cpu")
    assert ws.reachable("ur5e", ws.TargetTable(points, length_unit_m=0.001), device="cpu").labels[0] == "reachable"
    as_metres = ws.reachable("ur5e", ws.TargetTable(points, length_unit_m=1), device="cpu")
    assert as_metres.labels.tolist() == ["unreachable", "unreachable", "reachable"]


def test_too_many_kinds_of_targets_are_refused(tmp_path):
    rows = ["x_m,y_m,z_m,position_tolerance_m", *(f"0.4,0,0.3,{1e-4 + k * 1e-6}" for k in range(101))]
    with pytest.raises(ws.InputError, match="101 combinations of tolerances and free axes; allowed: 100"):
        ws.reachable("ur5e", table(tmp_path, "\n".join(rows)), device="cpu")


def test_constraints_and_surroundings_are_those_of_a_job(capsys):
    """As of `ws.postures` and `ws.reachability`, whose labels they give; and a bar is asked for in the same way."""
    points = np.random.default_rng(8).uniform([-0.9, -0.9, -0.4], [0.9, 0.9, 0.6], (40, 3))
    asked = {"constraints": {"self_collision": True}, "environment": ws.Environment([ws.HalfSpace(name="floor")])}
    found = ws.reachable("ur5e", points, [0, 1, 0, 0], **asked, progress=True, device="cpu")
    table = ws.reachability("ur5e", points, [0, 1, 0, 0], **asked, device="cpu").tables["targets"]
    assert list(found.labels) == list(table["label"]) and list(found.reasons) == list(table["reason"])
    assert {"reachable", "blocked"} <= set(found.labels) and "environment" in found.reasons
    plain = asked | {"environment": {"items": [{"shape": "half_space", "name": "floor"}]}}
    assert list(ws.reachable("ur5e", points, [0, 1, 0, 0], **plain, device="cpu").labels) == list(found.labels)
    with pytest.raises(ws.InputError, match="environment: must not be given beside a sequence of constraints"):
        ws.reachable("ur5e", points, constraints=[], environment=asked["environment"], device="cpu")
    with pytest.raises(ws.InputError, match=r"constraints\.self_collisions: unknown constraint"):
        ws.reachable("ur5e", points, constraints={"self_collisions": True}, device="cpu")
