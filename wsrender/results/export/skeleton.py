"""Stick figures of the arm ↔ NumPy's npy."""

from pathlib import Path

import numpy as np

from wsrender.errors import InputError
from wsrender.results.export.atomic import new_file


def write_skeleton(skeleton: np.ndarray, path: str | Path) -> None:
    """Write world positions [m] of base, joint origins and tip in K configurations, (K, L+2, 3)."""
    with new_file(path) as temporary, temporary.open("wb") as file:
        np.save(file, skeleton, allow_pickle=False)


def read_skeleton(path: str | Path) -> np.ndarray:
    """Read what ``write_skeleton`` wrote; InputError where the file holds another shape or no array."""
    path = Path(path)
    try:
        skeleton = np.load(path, allow_pickle=False)
    except (OSError, ValueError, EOFError) as error:
        raise InputError(path.name, f"cannot be read as an array: {error}") from error
    if not isinstance(skeleton, np.ndarray) or skeleton.ndim != 3 or skeleton.shape[2] != 3:
        raise InputError(path.name, "must hold positions of shape (K, L+2, 3)")
    return skeleton
