"""Base and tip: frames of a model chosen by the name of a site, body or link."""

from dataclasses import dataclass
from difflib import get_close_matches

import mujoco
import numpy as np

from wsrender.errors import FrameNotFoundError, ModelError

_DEFAULT_SITE = "tool"
_DEFAULT_LINK = "tool0"  # the end of the flange in the ROS-Industrial convention
_FREE = (mujoco.mjtJoint.mjJNT_FREE, mujoco.mjtJoint.mjJNT_BALL)


@dataclass(frozen=True)
class Frame:
    """A site (``site`` is its id) or, where ``site`` is None, a body of the model."""

    name: str
    body: int
    site: int | None = None

    def pose(self, data: mujoco.MjData) -> np.ndarray:
        """(4, 4) transform to world coordinates, after ``mj_kinematics``."""
        index, position, matrix = self.body, data.xpos, data.xmat
        if self.site is not None:
            index, position, matrix = self.site, data.site_xpos, data.site_xmat
        return transform(position[index], matrix[index].reshape(3, 3))


def transform(position: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """(4, 4) transform from a position (3,) and a rotation matrix (3, 3)."""
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = rotation, position
    return T


def choose(model: mujoco.MjModel, base: str | None, tip: str | None) -> tuple[Frame, Frame]:
    """Base and tip frames by name; the world, and the only end of the model, where they are None.

    Raises FrameNotFoundError for names that the model does not have, a base that is no ancestor of the tip,
    and a tip that must be chosen.
    """
    base_frame = Frame("world", 0) if base is None else _find(model, base, "base", range(model.nbody))
    carried = _carried(model, base_frame.body) or list(range(base_frame.body + 1, model.nbody))
    tip_frame = _default_tip(model, carried) if tip is None else _find(model, tip, "tip", carried)
    above = path(model, tip_frame.body)
    if base_frame.body not in above:
        names = [body_name(model, body) for body in above]
        raise FrameNotFoundError("base", f"{base!r} is not an ancestor of the tip {tip_frame.name!r}", names)
    return base_frame, tip_frame


def path(model: mujoco.MjModel, body: int) -> list[int]:
    """Bodies from the world (0) to ``body``, both included."""
    bodies = [body]
    while bodies[-1]:
        bodies.append(int(model.body_parentid[bodies[-1]]))
    return bodies[::-1]


def joints_of(model: mujoco.MjModel, body: int) -> range:
    """Joints by which a body moves against its parent, in order."""
    first = int(model.body_jntadr[body])
    return range(first, first + int(model.body_jntnum[body]))


def body_name(model: mujoco.MjModel, body: int) -> str:
    """Name of a body, or its number where it has none."""
    return model.body(body).name or f"body{body}"


def _carried(model: mujoco.MjModel, base: int) -> list[int]:
    """Bodies that at least one joint separates from the base body."""
    moved = {base: False}
    for body in range(base + 1, model.nbody):  # parents come before children
        if (parent := int(model.body_parentid[body])) in moved:
            moved[body] = moved[parent] or model.body_jntnum[body] > 0
    return [body for body, is_moved in moved.items() if is_moved]


def _find(model: mujoco.MjModel, name: str, field: str, offered) -> Frame:
    site = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, name)
    if site >= 0:
        return Frame(name, int(model.site_bodyid[site]), site)
    body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name)
    if body >= 0:
        return Frame(name, body)
    choices = tip_names(model, offered) if field == "tip" else _names(model, offered)
    close = get_close_matches(name, choices, n=1)
    hint = f"; did you mean {close[0]!r}" if close else ""
    raise FrameNotFoundError(field, f"the model has no site, body or link {name!r}{hint}", choices)


def _names(model: mujoco.MjModel, bodies) -> list[str]:
    """Names of the sites on the bodies, then of the bodies."""
    bodies = list(bodies)
    sites = [model.site(s).name for s in range(model.nsite) if model.site_bodyid[s] in bodies]
    return [name for name in [*sites, *(model.body(body).name for body in bodies)] if name]


def tip_names(model: mujoco.MjModel, bodies) -> list[str]:
    """What can be a tip among the bodies and their sites: the ends of the model first."""
    ends = _ends(model, bodies)
    return [*dict.fromkeys([*_names(model, ends), *_names(model, bodies)])]


def _ends(model: mujoco.MjModel, bodies) -> list[int]:
    """Those of the bodies that carry no other."""
    parents = set(model.body_parentid[1:].tolist())
    return [body for body in bodies if body not in parents]


def _default_tip(model: mujoco.MjModel, carried: list[int]) -> Frame:
    site = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, _DEFAULT_SITE)
    if site >= 0:
        return Frame(_DEFAULT_SITE, int(model.site_bodyid[site]), site)
    leaves = _ends(model, carried)
    leaves = [body for body in leaves if not _floats(model, body)] or leaves
    named = [body for body in leaves if model.body(body).name == _DEFAULT_LINK]
    ends = leaves if len(leaves) == 1 else named
    if len(ends) == 1:
        return Frame(body_name(model, ends[0]), ends[0])
    if not leaves:
        raise ModelError("model", "there is nothing to move: the model has no body")
    places = f"the model ends in {len(leaves)} places; its tip must be named"
    raise FrameNotFoundError("tip", places, tip_names(model, carried))


def _floats(model: mujoco.MjModel, body: int) -> bool:
    joints = [joint for ancestor in path(model, body) for joint in joints_of(model, ancestor)]
    return any(mujoco.mjtJoint(model.jnt_type[joint]) in _FREE for joint in joints)


def inverse_of_rigid(T: np.ndarray) -> np.ndarray:
    """Inverses of frames (N, 4, 4), whose rotations are transposed: a sixth of the time of a general inverse."""
    inverse = np.broadcast_to(np.eye(4), T.shape).copy()
    inverse[:, :3, :3] = np.swapaxes(T[:, :3, :3], 1, 2)
    inverse[:, :3, 3] = -np.einsum("nji,nj->ni", T[:, :3, :3], T[:, :3, 3])
    return inverse
