"""What makes two submissions the same computation, and what to say of numbers of another version."""

import hashlib
import json
from collections.abc import Mapping
from functools import cache
from typing import Any

from wsrender import __version__
from wsrender.documents.arm import dotted, local_paths, models_in
from wsrender.errors import InputError
from wsrender.notices import Notice
from wsrender.robots.library import find


class Identity:
    """Keys of computations; equal keys share one computation and its result."""

    def __init__(self, shared_cache: bool = False):
        self.shared_cache = shared_cache

    def key(self, owner: str, document: Mapping[str, Any], target: str | None) -> str:
        """SHA-256 of owner, document, model, version and target.

        With a shared cache, jobs of nothing but library robots have the same key for every owner. Raises InputError
        for a robot or points given by a path: the server reads no files for its users.
        """
        for path in local_paths(document):
            raise InputError(dotted(path), "is for local runs; send the points, or upload the model")
        libraries = [robot.get("library") for _, robot in models_in(document)]
        anyone = self.shared_cache and bool(libraries) and None not in libraries
        parts = ["" if anyone else owner, document, [_library_hash(name) for name in libraries], __version__, target]
        return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()


def device_of(document: Mapping[str, Any]) -> str:
    """What a document asks to be computed on; any device where its analysis has no such choice."""
    return document.get("device", "auto")


@cache
def _library_hash(name: str | None) -> str | None:
    return None if name is None else hashlib.sha256(find(name).read_bytes()).hexdigest()


def notices_of(version: str) -> list[Notice]:
    """What an owner should know of a result that a version has computed: nothing where it is this one."""
    if version == __version__:
        return []
    return [
        Notice(
            "other_version",
            f"computed by wsrender {version}; this server runs {__version__}, whose numbers may differ",
            "submit the job again for numbers of this version",
        )
    ]
