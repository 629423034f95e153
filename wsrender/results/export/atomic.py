"""Files and folders that appear complete or not at all."""

import shutil
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from wsrender.errors import InputError


@contextmanager
def new_file(path: str | Path) -> Iterator[Path]:
    """A temporary path beside ``path``, renamed to it when the block ends without an exception.

    Raises InputError where the folder of ``path`` does not exist or ``path`` is a folder.
    """
    path = Path(path)
    if not path.parent.is_dir():
        raise InputError("path", f"the folder {path.parent} does not exist")
    if path.is_dir():
        raise InputError("path", f"{path} is a folder, not a file")
    # The extension stays last: some libraries append theirs otherwise.
    temporary = path.with_name(f".{uuid.uuid4().hex}{path.suffix}")
    try:
        yield temporary
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


@contextmanager
def staging_folder(target: str | Path) -> Iterator[Path]:
    """A new hidden folder beside ``target``, on the same file system, removed when the block ends.

    Raises InputError where ``target`` is a file.
    """
    target = Path(target).absolute()
    if target.exists() and not target.is_dir():
        raise InputError("path", f"{target} is a file, not a folder")
    target.parent.mkdir(parents=True, exist_ok=True)
    staging = target.with_name(f".{uuid.uuid4().hex}.partial")
    staging.mkdir()
    try:
        yield staging
    finally:
        shutil.rmtree(staging, ignore_errors=True)
