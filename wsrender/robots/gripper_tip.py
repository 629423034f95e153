"""A tip that nobody chose and that a gripper moves: the model's only end is then a jaw, not the end of the arm."""

import re

import mujoco

from wsrender.notices import Notice
from wsrender.robots import frames
from wsrender.robots.frames import Frame
from wsrender.robots.limits import Drive, joint_name

_OF_JOINTS = re.compile("grip|jaw|finger|claw|pinch", re.IGNORECASE)
_OF_LINKS = re.compile("^(?!.*fixed).*(jaw|finger|claw|mover)", re.IGNORECASE)


def gripper_notices(model: mujoco.MjModel, tip: Frame, drives: list[Drive]) -> list[Notice]:
    """The notice, if any, that the last joints before the default tip are, by their names, those of a gripper."""
    jaw = []
    for drive in reversed(drives):
        if not _of_gripper(model, drive.joint):
            break
        jaw.insert(0, drive.joint)
    if not jaw or len(jaw) == len(drives) or tip.site is not None:
        return []
    palm = model.body(model.body_parentid[model.jnt_bodyid[jaw[0]]]).name
    names, last = ", ".join(joint_name(model, joint) for joint in jaw), drives[-len(jaw) - 1].joint
    message = f"the tip {tip.name!r}, the only end of the model, is moved by {names} beyond {joint_name(model, last)}"
    remedy = f"tip={palm!r} ends before the gripper" if palm else "name a tip before the gripper"
    return [Notice("gripper_tip", f"{message}, the last joint of the arm", remedy, "tip")]


def _of_gripper(model: mujoco.MjModel, joint: int) -> bool:
    link = frames.body_name(model, int(model.jnt_bodyid[joint]))
    return bool(_OF_JOINTS.search(joint_name(model, joint)) or _OF_LINKS.search(link))
