"""The data folder: models, partial results and artifacts, each file named by the hash of what is in it.

::

    models/<sha256>                       uploaded models
    documents/<computation>/<sha256>      long job documents
    partials/<computation>/<shard>.npz    partial results of unfinished computations
    partials/…/<shard>.checkpoint         what a shard needs to go on where it was stopped
    partials/…/programs/<key>.npz         of collisions, made by the planner for all
    results/<computation>/<sha256>        artifacts, the result document among them
    scratch/                              files being written; emptied at start
    store-id                              what the database knows this folder by

The folder is its user's alone: 0700, and by the umask of every process of the server so is all that is in it.
"""

import errno
import hashlib
import math
import os
import re
import shutil
import stat
import time
from collections.abc import Container, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from wsrender.errors import InputError
from wsrender.results.export.atomic import new_file
from wsrender_server.jobs.faults import DiskFull

FULL = (errno.ENOSPC, errno.EDQUOT)
SAID_FULL = re.compile(rf"{os.strerror(errno.ENOSPC)}|Not enough free space|requested and \d+ written")
ABANDONED_S = 3600.0
OF_EVERY_VERSION = ("models", "partials", "results", "scratch")
FOLDERS = (*OF_EVERY_VERSION, "documents")
DATABASE = "wsrender.db"  # where the settings name no other
OTHERS = 0o077  # rights of group and everybody
MOST_REMEMBERED = 100_000  # files


class DataFolder:
    """Paths and writes of the data folder; every file appears complete or not at all.

    Names are hashes and identifiers made by the server: anything else raises ValueError. Writes raise DiskFull
    where the disk is full or holds less than ``reserve_bytes``. ``make`` says whether missing folders are made; then
    InputError is raised where other users may look into the folder, and it cannot be closed to them.
    """

    def __init__(self, root: Path, reserve_bytes: int = 0, make: bool = True):
        self.root = root.absolute()
        self.reserve_bytes = reserve_bytes
        self._read: dict[Path, tuple[int, ...]] = {}  # what files were like when their bytes were those of their names
        if make:
            self._make()

    def _make(self) -> None:
        close_to_others(self.root)
        for name in FOLDERS:
            (self.root / name).mkdir(mode=0o700, exist_ok=True)

    @property
    def models(self) -> Path:
        """Folder of the uploaded models."""
        return self.root / "models"

    def model(self, sha256: str) -> Path:
        """File of an uploaded model."""
        return self.models / _plain(sha256)

    def document(self, computation: str, sha256: str) -> Path:
        """File of a computation's job document, where it is a long one."""
        return self.root / "documents" / _plain(computation) / _plain(sha256)

    def partials(self, computation: str) -> Path:
        """Folder of a computation's partial results."""
        return self.root / "partials" / _plain(computation)

    def artifact(self, computation: str, sha256: str) -> Path:
        """File of an artifact."""
        return self.root / "results" / _plain(computation) / _plain(sha256)

    def is_intact(self, path: Path) -> bool:
        """Whether a file holds the bytes that its name is the hash of; read once, for as long as nobody touches it."""
        try:
            with path.open("rb") as file:
                status = os.fstat(file.fileno())
                alike = (status.st_ino, status.st_size, status.st_mtime_ns, status.st_ctime_ns)
                if self._read.get(path) == alike:
                    return True
                if hashlib.file_digest(file, "sha256").hexdigest() != path.name:
                    return False
        except FileNotFoundError:
            return False
        if len(self._read) >= MOST_REMEMBERED:
            self._read.clear()
        self._read[path] = alike
        return True

    def read_id(self) -> str | None:
        """What the database knows this folder by; None where it has no such file, or is not there."""
        try:
            return (self.root / "store-id").read_text().strip()
        except FileNotFoundError:
            return None

    def write_id(self, identity: str) -> None:
        """Set what the database knows this folder by."""
        with new_file(self.root / "store-id") as temporary:
            temporary.write_text(f"{identity}\n")

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
        if not self.is_intact(target):
            self.write(target, content)
        return sha256

    def put_document(self, computation: str, sha256: str, content: bytes | Path) -> None:
        """Keep a computation's job document, or a file that is one, which moves."""
        target = self.document(computation, sha256)
        target.parent.mkdir(exist_ok=True)
        if isinstance(content, Path):
            content.replace(target)
        else:
            self.write(target, content)

    def mend_document(self, computation: str, sha256: str, source: str) -> None:
        """Give a computation its job document again, from that of another, where it is lost or damaged."""
        target = self.document(computation, sha256)
        if computation != source and not self.is_intact(target):
            self.put_document(computation, sha256, self.document(source, sha256).read_bytes())

    def write(self, target: Path, content: bytes) -> None:
        """Write a file of the folder, safe on the disk when this returns. Raises DiskFull."""
        with full_disk():
            self.check_space()
            write_durably(target, content)

    def forget_document(self, computation: str, but: str | None = None) -> None:
        """Remove a computation's job documents ``but`` the one of that hash."""
        folder = self.root / "documents" / _plain(computation)
        for path in [*folder.iterdir()] if folder.is_dir() else []:
            if path.name != but:
                path.unlink(missing_ok=True)
        with suppress(OSError):  # not there, or not empty
            folder.rmdir()

    def forget_partials(self, computation: str) -> None:
        """Remove a computation's partial results, and what a step that was killed has left half-written."""
        for path in (self.partials(computation), *(self.root / "scratch").glob(f"{_plain(computation)}.*")):
            shutil.rmtree(path, ignore_errors=True)

    def forget(self, computation: str) -> None:
        """Remove everything of a computation."""
        self.forget_results(computation)
        self.forget_document(computation)

    def forget_results(self, computation: str) -> None:
        """Remove a computation's results, the partial ones too: a retry computes them again from its document."""
        self.forget_partials(computation)
        shutil.rmtree(self.root / "results" / _plain(computation), ignore_errors=True)

    def forget_documents_but(self, computations: Container[str]) -> None:
        """Remove documents of computations that never came about; one that comes about now is young."""
        for folder in (self.root / "documents").iterdir():
            if folder.name not in computations and time.time() - folder.stat().st_mtime > ABANDONED_S:
                shutil.rmtree(folder, ignore_errors=True)

    def empty_scratch(self, but: Container[str] = (), before: float = math.inf) -> None:
        """Remove what an interrupted process left half-written ``before`` a time.

        What belongs to the computations ``but`` stays: a worker elsewhere may be at it.
        """
        for path in (self.root / "scratch").iterdir():
            with suppress(FileNotFoundError):
                if path.name.partition(".")[0] in but or path.stat().st_mtime >= before:
                    continue
                shutil.rmtree(path, ignore_errors=True) if path.is_dir() else path.unlink(missing_ok=True)


def keep_private() -> None:
    """What this process and its children write from now on is for their user only."""
    os.umask(OTHERS)


def close_to_others(root: Path) -> None:
    """Make a data folder that only its user may look into; close one that an earlier version left open, with all in it.

    Raises InputError for an open folder that is not the user's own or holds anything else: closing it could take from
    others what is theirs.
    """
    root.mkdir(mode=0o700, parents=True, exist_ok=True)
    status = root.stat()
    if os.name != "posix" or not status.st_mode & OTHERS:
        return
    made_here = (root / DATABASE).exists() or all((root / name).is_dir() for name in OF_EVERY_VERSION)
    made_here = made_here or not any(root.iterdir())
    if status.st_uid != os.geteuid() or status.st_mode & stat.S_ISVTX or not made_here:
        raise InputError(
            "data_dir",
            f"{root} is open to other users (mode {status.st_mode & 0o7777:04o}) and not wsrender's alone: chmod 700 "
            f"{root}, or name a folder within it, which is made",
        )
    for path in (*root.rglob("*"), root):
        if not path.is_symlink():
            path.chmod(path.stat().st_mode & ~OTHERS & 0o7777)


def is_full(error: OSError) -> bool:
    """Whether an error says that a disk is full; HDF5 and NumPy say so in words."""
    return error.errno in FULL or bool(SAID_FULL.search(str(error)))


def write_durably(target: Path, content: bytes) -> None:
    """Write a file that appears complete, and is safe on the disk, or not at all."""
    with new_file(target) as temporary, temporary.open("wb") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())


@contextmanager
def full_disk() -> Iterator[None]:
    """Turn the operating system's "no space left" into DiskFull."""
    try:
        yield
    except OSError as error:
        if is_full(error):
            raise DiskFull("the disk is full; nothing was changed, try again later") from error
        raise


def _plain(name: str) -> str:
    if not re.fullmatch(r"[0-9a-f]{1,64}", name):
        raise ValueError(f"{name!r} is no name of a file of the server")
    return name
