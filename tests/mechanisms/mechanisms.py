"""Mechanisms that tests share, from documents."""

import numpy as np
from pydantic import TypeAdapter

from wsrender.documents.mechanism import MechanismSpec
from wsrender.mechanisms.mechanism import Mechanism, mechanism_of

SPEC = TypeAdapter(MechanismSpec)


def mechanism(document) -> Mechanism:
    return mechanism_of(SPEC.validate_python(document))


def on_circle(radius: float, degrees, height: float = 0.0) -> list[list[float]]:
    angle = np.deg2rad(degrees)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), np.full(len(angle), height)], axis=1).tolist()


def ups(base, platform, length_m, **more) -> dict:
    """The document of UPS legs with equal limits."""
    legs = [
        {"type": "UPS", "base_m": b, "platform_m": p, "length_m": length_m} for b, p in zip(base, platform, strict=True)
    ]
    return {"legs": legs, **more}


def known_ups() -> dict:
    """The 6-UPS of DEFINITIONS section 9: b_k = (cos 60k°, sin 60k°, 0), p_k = .5 b_k, r in [.2, 1.5]."""
    azimuths = 60.0 * np.arange(6)
    return ups(on_circle(1.0, azimuths), on_circle(0.5, azimuths), [0.2, 1.5])


def poses_of(positions, rotation=None) -> np.ndarray:
    """Platform poses (N, 4, 4) at one orientation."""
    poses = np.broadcast_to(np.eye(4), (len(positions), 4, 4)).copy()
    poses[:, :3, 3] = positions
    poses[:, :3, :3] = np.eye(3) if rotation is None else rotation
    return poses


def random_rotations(random: np.random.Generator, count: int) -> np.ndarray:
    """Uniform on SO(3), from uniform unit quaternions, (count, 3, 3)."""
    w, x, y, z = (q := random.normal(size=(4, count))) / np.linalg.norm(q, axis=0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)
