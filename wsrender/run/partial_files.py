"""Partial results ↔ npz files without pickles, so that a restart need not compute them again."""

import json
import zipfile
import zlib
from pathlib import Path
from typing import Any

import numpy as np

from wsrender.analyses.partial_result import PartialResult
from wsrender.errors import InputError
from wsrender.results.export.atomic import new_file

FACTS = "facts.json"  # beside the arrays in the archive


def save_partial(partial: Any, path: str | Path) -> None:
    """Write a partial result; the file appears complete or not at all."""
    parts = partial.packed()
    with new_file(path) as temporary, temporary.open("w+b") as file:
        np.savez(file, allow_pickle=False, **parts.arrays)
        with zipfile.ZipFile(file, "a") as archive:
            archive.writestr(FACTS, json.dumps(parts.facts))


def load_partial(path: str | Path, plan: Any) -> Any:
    """Read what ``save_partial`` wrote of a shard of ``plan``; InputError where the file is missing or damaged."""
    path = Path(path)
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as archive:
            facts = json.loads(archive[FACTS])
            arrays = {name: archive[name] for name in archive.files if name != FACTS}
        return plan.read(PartialResult(arrays, facts))
    except (OSError, ValueError, KeyError, TypeError, EOFError, zipfile.BadZipFile, zlib.error) as error:
        raise InputError(path.name, f"cannot be read as a partial result: {error}") from error
