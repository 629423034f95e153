"""The part of a chain that moves its end point: a spherical wrist that meets there does not."""

from dataclasses import replace

import numpy as np

from wsrender.robots.chain import Chain

ON_AXIS = 1e-12  # distance of a point from an axis that counts as none, relative to the reach


def moving_joints(chain: Chain, axis: bool = False) -> tuple[Chain, np.ndarray]:
    """The chain without the last hinges whose axes go through the end point, and which coordinates it keeps (m,).

    With ``axis``: without those that leave the direction of the tip's z alone too. What is left has the same positions
    (and directions of z) as the whole chain; its orientations mean nothing more. At least one joint stays.
    """
    T = chain.T_tip @ chain.T_tip_tool
    joints = len(chain.T_joint)
    nothing = ON_AXIS * max(chain.reach, 1.0)
    while joints > 1 and chain.joint_is_revolute[joints - 1] and np.hypot(*T[:2, 3]) <= nothing:
        if axis and np.hypot(*T[:2, 2]) > ON_AXIS:
            break
        T[:2, 3] = 0.0
        T = chain.T_joint[joints - 1] @ T
        joints -= 1
    kept = np.unique(chain.joint_source[:joints])
    per_joint = ("joint_is_revolute", "joint_scale", "joint_offset", "T_joint", "mass", "center_of_mass", "inertia")
    return replace(
        chain,
        joint_names=tuple(chain.joint_names[k] for k in kept),
        joint_source=np.searchsorted(kept, chain.joint_source[:joints]),
        armature=chain.armature[:joints],
        has_inertia=False,
        with_branches=None,
        leader_is_revolute=chain.revolute[kept],
        T_tip=T,
        T_tip_tool=np.eye(4),
        **{name: getattr(chain, name)[:joints] for name in per_joint},
        **{
            name: getattr(chain, name)[kept] for name in ("lower_limits", "upper_limits", "periodic", "velocity_limits")
        },
        efforts=chain.efforts[:, kept],
    ), kept
