"""Partial results ↔ npz files without pickles, so that a restart need not compute them again."""

import zipfile
import zlib
from pathlib import Path
from typing import Any

import numpy as np

from wsrender.errors import InputError
from wsrender.results.export.atomic import new_file
from wsrender.run.partial_arrays import Partials, partial_of_arrays, partial_to_arrays


def save_partial(partial: Partials, path: str | Path) -> None:
    """Write a partial result; the file appears complete or not at all."""
    with new_file(path) as temporary, temporary.open("wb") as file:
        np.savez(file, allow_pickle=False, **partial_to_arrays(partial))


def load_partial(path: str | Path, plan: Any) -> Partials:
    """Read what ``save_partial`` wrote of a shard of ``plan``; InputError where the file is missing or damaged."""
    path = Path(path)
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as arrays:
            return partial_of_arrays({name: arrays[name] for name in arrays.files}, plan)
    except (OSError, ValueError, KeyError, TypeError, EOFError, zipfile.BadZipFile, zlib.error) as error:
        raise InputError(path.name, f"cannot be read as a partial result: {error}") from error
