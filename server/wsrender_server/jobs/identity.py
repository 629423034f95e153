"""What makes two submissions the same computation, and what to say of numbers of another version."""

import hashlib
import json
from functools import cache

from wsrender import __version__
from wsrender.notices import Notice
from wsrender.robots.library import find
from wsrender_server.jobs.documents import CanonicalDocument


class Identity:
    """Keys of computations; equal keys share one computation and its result."""

    def __init__(self, shared_cache: bool = False):
        self.shared_cache = shared_cache

    def key(self, owner: str, document: CanonicalDocument, target: str | None) -> str:
        """SHA-256 of owner, document, model, version and target.

        With a shared cache, jobs of nothing but library robots have the same key for every owner.
        """
        anyone = self.shared_cache and bool(document.libraries) and None not in document.libraries
        models = [_library_hash(name) for name in document.libraries]
        parts = ["" if anyone else owner, document.sha256, models, __version__, target]
        return hashlib.sha256(json.dumps(parts).encode()).hexdigest()


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
