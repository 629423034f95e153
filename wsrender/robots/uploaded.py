"""Models that are named by their hash: those that were uploaded to a server, in the folder where it keeps them."""

import hashlib
import os
from pathlib import Path
from typing import TYPE_CHECKING

from wsrender.errors import InputError, ModelError
from wsrender.robots import archives, xml_source
from wsrender.robots.loading import ROOTS, load_archive, load_mjcf, load_urdf

if TYPE_CHECKING:
    from wsrender.robots.loaded_robot import LoadedRobot

MODELS_VARIABLE = "WSRENDER_MODELS"

_FIELD = "robot.model"


def load_uploaded(sha256: str, entry: str | None = None, **options) -> "LoadedRobot":
    """The robot of the file ``sha256`` in the folder WSRENDER_MODELS, text or a ZIP: nothing beside it is opened.

    ``entry``: which file of a ZIP is the model.
    ``options`` as in `wsrender.robots.loading.load`. Raises InputError where this process has no such folder or the
    folder no such file, ModelError for a file that is no model.
    """
    content = uploaded_content(sha256, _FIELD)
    if archives.is_archive(content):
        return load_archive(content, entry=entry, **options)
    refuse_entry(entry)
    root = xml_source.parse(content, _FIELD)
    loaders = {"mujoco": load_mjcf, "robot": load_urdf, "sdf": load_urdf}
    if root.tag not in loaders:
        raise ModelError(_FIELD, f"the root element is <{root.tag}>; {ROOTS}")
    return loaders[root.tag](content, **options)


def refuse_entry(entry: str | None) -> None:
    """Raises InputError where an entry is given of what is no archive."""
    if entry is not None:
        raise InputError("entry", "goes with a ZIP, which the uploaded model is not")


def uploaded_content(sha256: str, field: str) -> bytes:
    """What was uploaded by that name. Raises InputError where nothing was, it is damaged, or this is no server."""
    folder = os.environ.get(MODELS_VARIABLE)
    if folder is None:
        raise InputError(field, "what was uploaded is known to its server only; give a path or a text")
    path = Path(folder) / sha256
    if not path.is_file():
        raise InputError(field, f"{sha256} is not among the uploaded models")
    content = path.read_bytes()
    if hashlib.sha256(content).hexdigest() != sha256:
        raise InputError(field, f"{sha256} is damaged on the server; upload it again")
    return content
