"""The joints of a chain that its limits let move, where they stand when displaced by 0."""

import numpy as np

from wsrender.errors import ModelError
from wsrender.robots.chain import Chain


def reference_frames(chain: Chain) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Which joints move (m,), their frames (m, 4, 4) and the end point (3,) [m], each in the frame before it.

    Joint frames are those at displacement 0, the first one's in the world. Joints whose limits are equal are held
    there. Raises ModelError, naming the joint, where several joints follow one.
    """
    if len(chain.joint_source) != chain.n:
        shared = np.flatnonzero(np.bincount(chain.joint_source) > 1)[0]
        raise ModelError(
            "robot", f"several joints follow {chain.joint_names[shared]!r}; a boundary needs each joint free"
        )
    moving = (chain.upper_limits > chain.lower_limits)[chain.joint_source]
    T, frames = chain.T_world_base, []
    for i, k in enumerate(chain.joint_source):
        T = T @ chain.T_joint[i]
        if moving[i]:
            frames.append(T)
            T = np.eye(4)
        else:
            held_at = chain.joint_scale[i] * chain.lower_limits[k] + chain.joint_offset[i]
            T = T @ _moved(bool(chain.joint_is_revolute[i]), held_at)
    tip = (T @ chain.T_tip @ chain.T_tip_tool)[:3, 3]
    return np.flatnonzero(moving), np.array(frames).reshape(-1, 4, 4), tip


def _moved(revolute: bool, displacement: float) -> np.ndarray:
    T = np.eye(4)
    if revolute:
        c, s = np.cos(displacement), np.sin(displacement)
        T[:2, :2] = [[c, -s], [s, c]]
    else:
        T[2, 3] = displacement
    return T
