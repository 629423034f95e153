"""How many postures reach points in given orientations."""

from collections.abc import Callable

import numpy as np

from wsrender.engine import closed_postures
from wsrender.errors import InputError
from wsrender.reach.admission import Admission
from wsrender.robots.closed_form import ClosedForm
from wsrender.robots.kinematics import Kinematics

BATCH = 1 << 14  # poses whose postures are held at a time


def turned_frames(directions: np.ndarray, rolls: int) -> np.ndarray:
    """Rotations (D * rolls, 3, 3) whose z are along unit vectors (D, 3), turned evenly about them."""
    other = np.where(np.abs(directions[:, :1]) < 0.7, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    x = np.cross(other, directions)
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    y = np.cross(directions, x)
    angle = (np.arange(rolls) + 0.5) * 2 * np.pi / rolls
    turned = np.cos(angle)[:, None] * x[:, None] + np.sin(angle)[:, None] * y[:, None]
    z = np.broadcast_to(directions[:, None], turned.shape)
    return np.stack([turned, np.cross(z, turned), z], axis=3).reshape(-1, 3, 3)


def closed_form_for_counts(chain: Kinematics) -> ClosedForm:
    """The closed form of a chain's poses; raises InputError where it has none, naming the field ``rolls``."""
    form = ClosedForm.of(chain)
    if form is None:
        raise InputError("rolls", f"must be null: {chain.name} has no closed form that knows all postures of a pose")
    return form


def posture_counts(
    chain: Kinematics,
    points: np.ndarray,
    rotations: np.ndarray,
    admission: Admission | None = None,
    *,
    device: str = "cpu",
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
) -> np.ndarray:
    """Postures within the limits at points (V, 3) [m] in R rotations (R, 3, 3), turns of hinges apart, (V, R) int32.

    With an ``admission`` those alone that it admits. Raises InputError for a chain without a closed form.
    """
    form = closed_form_for_counts(chain)
    counts, each = np.zeros((len(points), len(rotations)), np.int32), max(1, BATCH // len(rotations))
    for first in range(0, len(points), each):
        batch = slice(first, first + each)
        T = np.tile(np.eye(4), (len(points[batch]), len(rotations), 1, 1))
        T[..., :3, :3], T[..., :3, 3] = rotations, points[batch, None]
        found = closed_postures(form, T.reshape(-1, 4, 4), keep=True, device=device, threads=threads)
        assert found.rows is not None
        there = found.rows[..., 12] >= -found.margin
        if admission:
            pose, branch = np.nonzero(there)
            there[pose, branch] = admission.rejected(form.configurations(found.rows[pose, branch, :12])) == 0
        counts[batch] = there.sum(axis=1).reshape(-1, len(rotations))
        if progress:
            progress(min(first + each, len(points)))
    return counts
