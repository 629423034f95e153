"""Which robots a job can be run with: their joints have ranges, and their lengths are those of arms."""

from typing import Any

import numpy as np

from wsrender.documents.arm import Arm, ArmPath, dotted
from wsrender.errors import ResourceError
from wsrender.robot import Robot
from wsrender.robots.plausibility import LENGTH, need_ranges, too_long
from wsrender.robots.reachable_box import reachable_box

VOXEL_M, BYTES = 0.02, 8  # a usual voxel [m], and the least that one takes


def usable(robot: Robot, arm: Arm, path: ArmPath, job: Any) -> Robot:
    """The robot, its joints without limits held where its arm of the job says so.

    Raises InputError where another joint has no limits and the job needs a range, ResourceError where lengths were
    probably millimetres and nobody has confirmed them; nothing has been allocated then.
    """
    held = {name: value for name, value in arm.held_joints.items() if name in robot.chain.endless}
    robot = robot.held(held) if held else robot
    if arm.needs_ranges:
        need_ranges(robot.chain, dotted(path, "robot", "limits"))
    chain = robot.chain.geometry
    if chain and any(notice.code == LENGTH for notice in robot.notices) and (long := too_long(chain)):
        raise ResourceError(dotted(path, "robot", "length_unit_m"), _too_large(robot, job, long))
    return robot


def _too_large(robot: Robot, job: Any, long: str) -> str:
    voxel = getattr(job, "voxel_size_m", None) or VOXEL_M
    low, high = reachable_box(robot.chain, robot.lower_limits, robot.upper_limits)
    voxels = float(np.prod(np.maximum((high - low) / voxel, 1.0)))
    span = " × ".join(f"{edge:.3g}" for edge in high - low)
    return (
        f"{long}: were lengths written in millimetres? The workspace would span {span} m, {voxels:.2g} voxels of "
        f"{voxel:g} m, {voxels * BYTES / 2**30:.2g} GiB at least. 0.001 converts millimetres, 1 confirms metres; "
        "limits give a slide its range"
    )
