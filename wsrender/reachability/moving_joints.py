"""The part of a chain that moves its end point: a spherical wrist that meets there does not."""

from dataclasses import replace

import numpy as np

from wsrender.robots.chain import Chain

ON_AXIS = 1e-12  # distance of a point from an axis that counts as none, relative to the reach


def moving_joints(chain: Chain) -> tuple[Chain, np.ndarray]:
    """The chain without the last hinges whose axes go through the end point, and which coordinates it keeps (m,).

    It has the same positions as the whole chain; its orientations mean nothing. At least one joint stays.
    """
    point = (chain.T_tip @ chain.T_tip_tool)[:3, 3]
    joints = len(chain.T_joint)
    nothing = ON_AXIS * max(chain.reach, 1.0)
    while joints > 1 and chain.joint_is_revolute[joints - 1] and np.hypot(*point[:2]) <= nothing:
        T = chain.T_joint[joints - 1]
        point = T[:3, :3] @ [0.0, 0.0, point[2]] + T[:3, 3]
        joints -= 1
    kept = np.unique(chain.joint_source[:joints])
    T_tip = np.eye(4)
    T_tip[:3, 3] = point
    per_joint = ("joint_is_revolute", "joint_scale", "joint_offset", "T_joint", "mass", "center_of_mass", "inertia")
    return replace(
        chain,
        joint_names=tuple(chain.joint_names[k] for k in kept),
        effort_limits=None,
        joint_source=np.searchsorted(kept, chain.joint_source[:joints]),
        armature=chain.armature[:joints],
        has_inertia=False,
        T_tip=T_tip,
        T_tip_tool=np.eye(4),
        **{name: getattr(chain, name)[:joints] for name in per_joint},
        **{name: getattr(chain, name)[kept] for name in ("lower_limits", "upper_limits", "periodic")},
    ), kept
