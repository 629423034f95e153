"""Frames of an SDF: every pose is said in some other frame, and is wanted in the model's (SDFormat 1.11, "Pose")."""

from dataclasses import dataclass, field
from xml.etree.ElementTree import Element

import numpy as np
from scipy.spatial.transform import Rotation

from wsrender.errors import ModelError
from wsrender.robots.xml_source import numbers

WORLD = "world"
MODEL = "__model__"
MOST_STEPS = 1_000  # from a frame to the world


def pose_of(parent: Element, name: str, model_field: str, where: str) -> np.ndarray:
    """The transform (4, 4) that the element ``name`` of ``parent`` says: x y z [m], roll, pitch, yaw about fixed axes.

    In degrees, or as a quaternion x y z w, where it says so; the identity where there is none.
    """
    T = np.eye(4)
    element = parent.find(name)
    text = "" if element is None else (element.text or "").strip()
    if element is None or not text:
        return T
    quaternion = element.get("rotation_format", "euler_rpy") == "quat_xyzw"
    values = numbers(text, 7 if quaternion else 6, model_field, f"{where}: {name}")
    T[:3, 3] = values[:3]
    if quaternion:
        if not 1e-3 < np.linalg.norm(values[3:]) < 1e3:
            raise ModelError(model_field, f"{where}: {name} has the quaternion {values[3:]}, which says no rotation")
        T[:3, :3] = Rotation.from_quat(values[3:]).as_matrix()
    else:
        degrees = element.get("degrees", "false").strip().lower() in ("true", "1")
        T[:3, :3] = Rotation.from_euler("xyz", values[3:], degrees=degrees).as_matrix()
    return T


def relative_to(parent: Element, name: str = "pose") -> str:
    """The frame that a pose names; empty where it names none. Versions before 1.7 call the attribute ``frame``."""
    element = parent.find(name)
    return "" if element is None else (element.get("relative_to") or element.get("frame") or "").strip()


@dataclass
class Frames:
    """Frames by their full names, ``model::link``, each with the frame that it is said in and its pose (4, 4) there."""

    model_field: str
    said: dict[str, tuple[str, np.ndarray]] = field(default_factory=dict)
    _known: dict[str, np.ndarray] = field(default_factory=lambda: {WORLD: np.eye(4)})

    def add(self, name: str, reference: str, T: np.ndarray) -> None:
        """Say where a frame is. Raises ModelError for a name that is there already."""
        if name in self.said or name == WORLD:
            raise ModelError(
                self.model_field, f"two models, links, joints or frames are named {name!r}; names must be unique"
            )
        self.said[name] = (reference, T)

    def pose(self, name: str) -> np.ndarray:
        """Pose of a frame in the world while all joints are at zero. Raises ModelError for none, and for a circle."""
        path = []
        at = name
        while at not in self._known:
            if at not in self.said:
                raise ModelError(self.model_field, f"there is no link, joint or frame {at!r}, which a pose names")
            if len(path) == MOST_STEPS:
                raise ModelError(self.model_field, f"the pose of {name!r} is said by its own, or over too many frames")
            path.append(at)
            at = self.said[at][0]
        for each in reversed(path):
            reference, T = self.said[each]
            self._known[each] = self._known[reference] @ T
        return self._known[name]
