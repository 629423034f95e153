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
