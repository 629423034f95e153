"""Joints that carry the base of a robot, before its own: one body without mass or shapes, on which all else stands."""

import math
from collections.abc import Sequence

import mujoco

from wsrender.documents.robot import MountJoint
from wsrender.errors import InputError

BODY = "base mount"  # the name of the body that the joints move


def add_joints(spec: mujoco.MjSpec, mount: Sequence[MountJoint]) -> None:
    """Adds joints to the body of the mount of a model in metres. Raises InputError for names that its joints have."""
    for k, joint in enumerate(mount):
        if spec.joint(joint.name) is not None:
            raise InputError(f"mount.{k}.name", f"must be another than that of a joint of the model, {joint.name!r}")
        slides, ends = joint.joint == "prismatic", joint.range
        added = spec.body(BODY).add_joint(
            name=joint.name,
            type=mujoco.mjtJoint.mjJNT_SLIDE if slides else mujoco.mjtJoint.mjJNT_HINGE,
            axis=joint.direction,
            pos=joint.position_m,
        )
        # Not what the model's defaults say of its joints:
        added.ref, added.armature, added.actfrclimited = 0.0, 0.0, mujoco.mjtLimited.mjLIMITED_FALSE
        added.limited = mujoco.mjtLimited.mjLIMITED_TRUE if ends else mujoco.mjtLimited.mjLIMITED_FALSE
        if ends:
            degrees = spec.compiler.degree and not slides
            added.range = [math.degrees(end) for end in ends] if degrees else ends
