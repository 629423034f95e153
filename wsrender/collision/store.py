"""Programs on disk, by the content of robot, surroundings, limits and sources: what takes seconds is done once."""

import hashlib
import os
from collections.abc import Mapping
from dataclasses import fields
from functools import cache
from io import BytesIO
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import mujoco
import numpy as np
import platformdirs
from filelock import FileLock

from wsrender.collision import asked
from wsrender.collision.distance import Distances
from wsrender.collision.program import Program, program
from wsrender.collision.solids import Pairs
from wsrender.robots.chain import Chain

FOLDER = "WSRENDER_CACHE_DIR"  # environment variable
LIMIT_BYTES = 2**30  # of all programs; those not used for longest go first
PACKAGE = Path(__file__).parents[1]
MAKERS = (  # modules by which programs are made
    "collision/*.py",
    "content.py",
    "errors.py",
    "robots/chain.py",
    "robots/joint_space.py",
    "robots/kinematics.py",
    "robots/reachable_box.py",
    "robots/small_matrices.py",
    "robots/triangles.py",
    "short_repr.py",
    "version.py",
)


_LATEST: dict[str, Program] = {}  # of this process
KEPT = 8
_given: Path | None = None


def stored_program(pairs: Pairs, chain: Chain, distances: Distances) -> Program:
    """The program of pairs, from the folder or made and put there; a process that makes the same is waited for."""
    key = _key(pairs, chain)
    if (found := _LATEST.get(key)) is None:
        found = _from_folder(key, pairs, chain, distances)
        for old in list(_LATEST)[: 1 - KEPT]:
            _LATEST.pop(old, None)  # another thread may have
        _LATEST[key] = found
    asked.note(key, found)
    return found


def take_from(folder: Path | None) -> None:
    """Programs that this process needs are looked for in ``folder`` first, where another has `put` them."""
    global _given
    _given = folder


def put(programs: Mapping[str, Program], folder: Path) -> None:
    """Write programs by their keys, for other processes to `take_from`."""
    for key, each in programs.items():
        folder.mkdir(parents=True, exist_ok=True)
        _write(folder / f"{key}.npz", each)


def _from_folder(key: str, pairs: Pairs, chain: Chain, distances: Distances) -> Program:
    if _given and (found := _read(_given / f"{key}.npz")):
        return found
    folder = Path(os.environ.get(FOLDER) or platformdirs.user_cache_path("wsrender", appauthor=False)) / "collision"
    path = folder / f"{key}.npz"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with FileLock(path.with_suffix(".lock")):
            found = _read(path)
            if found is None:
                found = program(pairs, chain, distances)
                _write(path, found)
        _forget(folder, keep=path)
    except OSError:  # a folder that cannot be written, as in a container: made for this process alone
        found = _read(path) or program(pairs, chain, distances)
    return found


def _key(pairs: Pairs, chain: Chain) -> str:
    made = hashlib.sha256(f"{_sources()} {mujoco.__version__} {pairs.digest}".encode())
    names = (
        "T_joint",
        "joint_is_revolute",
        "joint_source",
        "joint_scale",
        "joint_offset",
        "lower_limits",
        "upper_limits",
    )
    for name in names:
        made.update(np.ascontiguousarray(getattr(chain, name), np.float64).tobytes())
    return made.hexdigest()[:32]


@cache
def _sources() -> str:
    """Of all that programs are made by: who changes it finds none that was made before."""
    made = hashlib.sha256()
    for path in sorted(path for pattern in MAKERS for path in PACKAGE.glob(pattern)):
        made.update(hashlib.sha256(path.read_bytes()).digest())
    return made.hexdigest()


def _read(path: Path) -> Program | None:
    """The program of a file, which is used from now on; None where there is none, or it cannot be read."""
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as arrays:
            values: dict[str, Any] = {field.name: arrays[field.name] for field in fields(Program)}
        os.utime(path)
    except (OSError, EOFError, KeyError, TypeError, ValueError, BadZipFile):
        return None
    values |= {name: int(values[name]) for name in ("columns", "moving", "alone")}
    values["epsilon"] = float(values["epsilon"])
    return Program(**values)


def _write(path: Path, found: Program) -> None:
    buffer = BytesIO()
    np.savez(buffer, **{field.name: getattr(found, field.name) for field in fields(Program)})
    partly = path.with_suffix(f".{os.getpid()}")
    partly.write_bytes(buffer.getvalue())
    partly.replace(path)


def _forget(folder: Path, keep: Path) -> None:
    """Remove files until the rest takes no more than the limit."""
    sizes = {path: path.stat() for path in folder.glob("*.npz") if path.exists()}
    total = sum(stat.st_size for stat in sizes.values())
    for path in sorted(sizes, key=lambda each: sizes[each].st_mtime):
        if total <= LIMIT_BYTES:
            break
        if path != keep:
            path.unlink(missing_ok=True)
            total -= sizes[path].st_size
