"""A sample of the models that others publish: each loads, or is refused for a reason of the table."""

import re

import numpy as np
import pytest

import wsrender as ws
from tests.robots import model_packages
from wsrender.robots.model_warning import ModelWarning

EVERY = 23  # the sample has about sixty of 1,342 files

if not (FILES := model_packages.files()):
    pytest.skip('no model packages are installed: pip install ".[test-models]"', allow_module_level=True)


def test_a_sample_loads_or_is_refused_for_a_stated_reason():
    found = model_packages.counted(slice(None, None, EVERY))
    assert model_packages.violations({"sample": found}) == []
    assert sum(found.values()) == -(-len(FILES) // EVERY)
    assert found["loaded"] > 0


def test_a_reason_that_is_not_in_the_table_is_told():
    unknown = model_packages.Outcome(FILES[0], "something else")
    assert unknown.reason is None
    assert model_packages.violations({"a part": {"loaded": 2, f"{model_packages.UNSTATED} file: said": 1}}) != []


def test_robots_stand_where_a_walk_of_their_own_says(monkeypatch):
    """And one that does not is told."""
    file = next((file for file in FILES if file.name == "z1.urdf"), None)
    if file is None:
        pytest.skip("example-robot-data is not installed")
    found = model_packages.outcome(file)
    assert (found.message, model_packages.fault(found)) == ("", "")
    monkeypatch.setattr(model_packages.urdf_walk, "pose", lambda *_: np.eye(4))
    assert model_packages.fault(found).startswith("its tip is off by ")


# Files that show one fault of a kind each: what is said of them, and None where they load.
STATED = {
    "so100.urdf": None,
    "z1.urdf": None,
    "tiago_dual.urdf": None,
    "spherical_joint_limit.urdf": "has type 'spherical'",
    "biped2d_pybullet.urdf": "its lower limit 1 is above its upper limit -1",
    "bike.urdf": "origin xyz is '0.07,'; a finite number is needed",
    "robot_touch_sensors_92.xml": "there is nothing to move",
}


@pytest.mark.parametrize("name", STATED)
def test_files_that_show_a_fault(name):
    file = next((file for file in FILES if file.name == name), None)
    if file is None:
        pytest.skip("its package is not installed")
    message = model_packages.outcome(file).message
    assert message == "" if STATED[name] is None else re.search(STATED[name], message)


@pytest.mark.parametrize(
    ("name", "tip", "moved"),
    [
        ("so100.urdf", "gripper", "gripper beyond wrist_roll"),
        ("z1.urdf", "gripperStator", "jointGripper beyond joint6"),
    ],
)
def test_a_jaw_taken_for_the_tip_is_noticed(name, tip, moved):
    file = next((file for file in FILES if file.name == name), None)
    if file is None:
        pytest.skip("example-robot-data is not installed")
    with pytest.warns(ModelWarning):
        robot = ws.load_robot(file)
        chosen = ws.load_robot(file, tip=tip)
    told = [notice for notice in robot.notices if notice.code == "gripper_tip"]
    assert [(notice.field, notice.remedy) for notice in told] == [("tip", f"tip={tip!r} ends before the gripper")]
    assert f"is moved by {moved}, the last joint of the arm" in told[0].message
    assert all(notice.code != "gripper_tip" for notice in chosen.notices)
    assert chosen.joint_names == robot.joint_names[:-1]
