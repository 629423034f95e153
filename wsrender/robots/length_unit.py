"""Models whose lengths are not metres: scaled before they are compiled."""

import math
from collections.abc import Sequence

import mujoco
import numpy as np


def to_metres(spec: mujoco.MjSpec, unit_m: float) -> None:
    """Scales a model whose unit of length is ``unit_m`` [m], in place.

    Positions, sizes, meshes, slides and centres of mass are multiplied by it, inertias [kg unit²] by its square;
    masses [kg], densities [kg/m³], angles, forces and torques stay.
    """
    if unit_m == 1.0:
        return
    for joint in spec.joints:
        _scale_joint(joint, unit_m)
    for body in spec.bodies:
        body.pos, body.ipos = body.pos * unit_m, body.ipos * unit_m
        body.inertia, body.fullinertia = body.inertia * unit_m**2, body.fullinertia * unit_m**2
    for frame in spec.frames:
        frame.pos = frame.pos * unit_m
    for item in (*spec.geoms, *spec.sites):
        item.pos, item.size, item.fromto = item.pos * unit_m, item.size * unit_m, item.fromto * unit_m
    for mesh in spec.meshes:
        mesh.scale = mesh.scale * unit_m  # vertices are shifted by refpos, and then scaled
    for hfield in spec.hfields:
        hfield.size = hfield.size * unit_m
    for equality in spec.equalities:
        if equality.type == mujoco.mjtEq.mjEQ_JOINT:
            _scale_coupling(spec, equality, unit_m)


def in_metres(model: mujoco.MjModel, velocities: Sequence[float], unit_m: float) -> tuple[float, ...]:
    """Velocities of all joints of a model, of slides in its unit of length per second: in rad/s or m/s."""
    slides = model.jnt_type == mujoco.mjtJoint.mjJNT_SLIDE
    return tuple(np.where(slides, unit_m, 1.0) * velocities) if len(velocities) else ()


def _scale_joint(joint: mujoco.MjsJoint, unit_m: float) -> None:
    joint.pos = joint.pos * unit_m
    if joint.type == mujoco.mjtJoint.mjJNT_SLIDE:
        joint.range, joint.ref, joint.springref = joint.range * unit_m, joint.ref * unit_m, joint.springref * unit_m
    else:
        joint.armature = joint.armature * unit_m**2


def _scale_coupling(spec: mujoco.MjSpec, equality: mujoco.MjsEquality, unit_m: float) -> None:
    """The polynomial y(x) of a joint that follows another, where y or x are lengths."""
    y, x = (unit_m if _slides(spec, name) else 1.0 for name in (equality.name1, equality.name2))
    data = np.array(equality.data)
    data[:5] *= [y / math.pow(x, power) for power in range(5)]
    equality.data = data


def _slides(spec: mujoco.MjSpec, name: str) -> bool:
    joint = spec.joint(name) if name else None
    return joint is not None and joint.type == mujoco.mjtJoint.mjJNT_SLIDE
