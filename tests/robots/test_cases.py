"""Models as other programs write them, each with its right values: the folders of tests/robots/cases.

``expected.json`` of a folder: ``tip``, ``base``; ``loads`` (false, or by file a part of the refusal), or ``error``;
``q_names``, ``limits``; configurations ``q`` with ``position_m`` and ``quat_wxyz``; ``volume_m3``.
"""

import json
import warnings
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from wsrender.errors import FrameNotFoundError, ModelError
from wsrender.robots.model_warning import ModelWarning

FOLDER = Path(__file__).parent / "cases"
CASES = [
    pytest.param(folder, file, id=f"{folder.name}/{file.name}")
    for folder in sorted(FOLDER.iterdir())
    for file in sorted(folder.iterdir())
    if file.name != "expected.json"
]
POSITION, ANGLE = 2e-12, 2e-12  # m and rad: the twelve digits of the files


def expected(folder):
    return json.loads((folder / "expected.json").read_text())


def load(folder, file, **options):
    wanted = expected(folder)
    options = {"tip": wanted.get("tip"), "base": wanted.get("base"), **options}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        if file.suffix == ".json":
            del options["tip"]
            return ws.load_robot(ws.DHTable.model_validate_json(file.read_text()), **options)
        return ws.load_robot(file, **options)


def refusal(wanted, file):
    """What the refusal of a file says; None for one that loads."""
    loads = wanted.get("loads", True)
    return loads.get(file.name) if isinstance(loads, dict) else wanted.get("error")


@pytest.mark.parametrize(("folder", "file"), CASES)
def test_a_model_loads_with_its_right_values_or_is_refused(folder, file):
    wanted = expected(folder)
    if (said := refusal(wanted, file)) is not None:
        with pytest.raises((ModelError, FrameNotFoundError), match=said):
            load(folder, file)
        return
    robot = load(folder, file)
    assert list(robot.joint_names) == wanted.get("q_names", list(robot.joint_names))
    if "limits" in wanted:
        np.testing.assert_allclose(np.stack([robot.lower_limits, robot.upper_limits], 1), wanted["limits"], atol=1e-15)
    poses = robot.forward_kinematics(wanted.get("q", np.zeros((0, robot.chain.n))), device="cpu")
    if "position_m" in wanted:
        np.testing.assert_allclose(poses[:, :3, 3], wanted["position_m"], atol=POSITION)
    if "quat_wxyz" in wanted:
        right = Rotation.from_quat(np.roll(wanted["quat_wxyz"], -1, axis=1))
        apart = Rotation.from_matrix(poses[:, :3, :3]) * right.inv()
        assert apart.magnitude().max() <= ANGLE


@pytest.mark.parametrize(
    "folder", [f for f in sorted(FOLDER.iterdir()) if "volume_m3" in expected(f)], ids=lambda f: f.name
)
def test_the_volume_is_right_within_its_interval(folder):
    """By default, as a newcomer asks for it."""
    wanted = expected(folder)["volume_m3"]
    headline = ws.analyze(load(folder, folder / "m.urdf"), ws.Sobol(1 << 14), device="cpu").document["headline"]
    low, high = headline["ci95"]
    assert low <= wanted <= high
    assert high - low <= 0.021 * wanted


def test_the_finger_that_follows_another_moves():
    """z of the pad spans 0 … −0.2 sin 0.8: the leader on the other branch goes through its whole range."""
    folder = FOLDER / "02-sibling-mimic-partly"
    robot = load(folder, folder / "m.urdf")
    result = ws.analyze(robot, ws.Grid(9), refined_volume=None, device="cpu")
    bounds = result.document["bounds_m"]
    np.testing.assert_allclose([bounds["lower"][2], bounds["upper"][2]], [-0.2 * np.sin(0.8), 0.0], atol=1e-7)


def test_two_arms_of_one_file_share_a_workspace():
    folder = FOLDER / "25-dual-arm-one-file"
    wanted = expected(folder)
    with pytest.raises(FrameNotFoundError) as found:
        load(folder, folder / "m.urdf")
    assert all(tip in str(found.value) for tip in wanted["tips"])
    arms = [load(folder, folder / "m.urdf", tip=tip) for tip in wanted["tips"]]
    assert [arm.joint_names[0] for arm in arms] == ["lift", "lift"]
    shared = ws.shared_workspace(arms, sampling=ws.Sobol(1 << 12), voxel_size_m=0.1, refined_volume=None, device="cpu")
    volumes = shared.document["volume_m3"]
    assert 0.0 < volumes["shared"] < volumes["any"]


def test_a_tip_that_does_not_move(tmp_path):
    """Indices that are 0, one voxel and no headline, which says why; every door can save it."""
    folder = FOLDER / "31-point-workspace"
    robot = load(folder, folder / "m.urdf")
    result = ws.analyze(robot, ws.Sobol(1 << 10), device="cpu")
    document = result.document
    assert document["headline"]["value"] is None and document["headline"]["ci95"] is None
    assert document["headline"]["reason"] == "the tip does not move"
    assert all(entry["maximum"] == 0.0 for entry in document["indices"].values())
    assert document["voxel_size_m"] == 0.01 and result.volume is not None and result.volume.n_occupied == 1
    assert "the tip does not move" in result.summary()
    result.save(tmp_path / "out")


@pytest.mark.parametrize("joints", [1, 12, 16])
def test_chains_of_many_joints(joints):
    folder = FOLDER / "32-many-joints"
    robot = load(folder, folder / f"snake{joints}.urdf")
    assert robot.chain.n == joints
    q = np.random.default_rng(2).uniform(robot.lower_limits, robot.upper_limits, (5, joints))
    T, link = np.tile(np.eye(4), (5, 1, 1)), np.eye(4)
    link[0, 3] = 0.1
    for k, angles in enumerate(q.T):  # axes y and z in turn
        turn = np.tile(np.eye(4), (5, 1, 1))
        turn[:, :3, :3] = Rotation.from_rotvec(angles[:, None] * np.eye(3)[1 + k % 2]).as_matrix()
        T = T @ turn @ link
    np.testing.assert_allclose(robot.forward_kinematics(q, device="cpu"), T, atol=1e-14)


def test_four_joints_have_a_manipulability_in_space():
    """The product of the three singular values of J[:3]: not 0 for n < 6."""
    folder = FOLDER / "22-four-dof-manipulability"
    robot, q = load(folder, folder / "m.urdf"), expected(folder)["q"]
    J = robot.jacobian(q, device="cpu")[0, :3]
    (found,) = ws.evaluate_indices(robot, q, ["manipulability"], device="cpu")["manipulability"]
    assert found == pytest.approx(np.prod(np.linalg.svd(J)[1]), rel=1e-12)
    assert found > 1e-3
