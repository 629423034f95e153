"""The data folder: models, partial results and artifacts, each file named by the hash of what is in it.

::

    models/<sha256>                       uploaded models
    partials/<computation>/<shard>.npz    partial results of unfinished computations
    partials/…/<shard>.checkpoint         what a shard needs to go on where it was stopped
    partials/…/programs/<key>.npz         of collisions, made by the planner for all
    results/<computation>/<sha256>        artifacts, the result document among them
    scratch/                              files being written; emptied at start
"""

import errno
import hashlib
import os
import re
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from wsrender.results.export.atomic import new_file
from wsrender_server.jobs.faults import DiskFull

FULL = (errno.ENOSPC, errno.EDQUOT)


class DataFolder:
    """Paths and writes of the data folder; every file appears complete or not at all.

    Names are hashes and identifiers made by the server: anything else raises ValueError. Writes raise DiskFull
    where the disk is full or holds less than ``reserve_bytes``. ``make`` says whether missing folders are made.
    """

    def __init__(self, root: Path, reserve_bytes: int = 0, make: bool = True):
        self.root = root.absolute()
        self.reserve_bytes = reserve_bytes
        if make:
            self._make()

    def _make(self) -> None:
        for name in ("models", "partials", "results", "scratch"):
            (self.root / name).mkdir(parents=True, exist_ok=True)

    @property
    def models(self) -> Path:
        """Folder of the uploaded models."""
        return self.root / "models"

    def model(self, sha256: str) -> Path:
        """File of an uploaded model."""
        return self.models / _plain(sha256)

    def partials(self, computation: str) -> Path:
        """Folder of a computation's partial results."""
        return self.root / "partials" / _plain(computation)

    def artifact(self, computation: str, sha256: str) -> Path:
        """File of an artifact."""
        return self.root / "results" / _plain(computation) / _plain(sha256)

    def free_bytes(self) -> int:
        """Bytes that may still be written."""
        return shutil.disk_usage(self.root).free

    def check_space(self) -> None:
        """Raise DiskFull where less than the reserve is free."""
        free = self.free_bytes()
        if free < self.reserve_bytes:
            raise DiskFull(
                f"{free / 2**20:.0f} MiB of disk are free, {self.reserve_bytes / 2**20:.0f} MiB are kept in reserve; "
                "nothing was changed, try again later"
            )

    def put_model(self, content: bytes) -> str:
        """Keep a model; its SHA-256."""
        sha256 = hashlib.sha256(content).hexdigest()
        target = self.model(sha256)
        if not target.exists():
            with full_disk():
                self.check_space()
                with new_file(target) as temporary, temporary.open("wb") as file:
                    file.write(content)
                    file.flush()
                    os.fsync(file.fileno())
        return sha256

    def forget_partials(self, computation: str) -> None:
        """Remove a computation's partial results."""
        shutil.rmtree(self.partials(computation), ignore_errors=True)

    def forget(self, computation: str) -> None:
        """Remove everything of a computation."""
        self.forget_partials(computation)
        shutil.rmtree(self.root / "results" / _plain(computation), ignore_errors=True)

    def empty_scratch(self) -> None:
        """Remove what an interrupted process left half-written."""
        for path in (self.root / "scratch").iterdir():
            shutil.rmtree(path, ignore_errors=True) if path.is_dir() else path.unlink(missing_ok=True)


@contextmanager
def full_disk() -> Iterator[None]:
    """Turn the operating system's "no space left" into DiskFull."""
    try:
        yield
    except OSError as error:
        if error.errno in FULL:
            raise DiskFull("the disk is full; nothing was changed, try again later") from error
        raise


def _plain(name: str) -> str:
    if not re.fullmatch(r"[0-9a-f]{1,64}", name):
        raise ValueError(f"{name!r} is no name of a file of the server")
    return name
