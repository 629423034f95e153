"""Robots: MJCF, URDF or DH table → compiled MuJoCo model → Chain."""

from wsrender.robots.loading import described, load, load_dh, load_library, load_mjcf, load_path, load_urdf, of_mujoco
from wsrender.robots.model_warning import ModelWarning
from wsrender.robots.uploaded import load_uploaded

__all__ = [
    "ModelWarning",
    "described",
    "load",
    "load_dh",
    "load_library",
    "load_mjcf",
    "load_path",
    "load_uploaded",
    "load_urdf",
    "of_mujoco",
]
