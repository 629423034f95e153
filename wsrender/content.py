"""Frozen records of arrays that are values: equal, and hashed, by what they hold."""

import hashlib
from dataclasses import fields
from functools import cached_property
from typing import Any

import numpy as np


class Content:
    """A dataclass with arrays, equal to another where every number, name and function is; derive with ``eq=False``."""

    @cached_property
    def content_hash(self) -> str:
        """SHA-256 of every number and name, hexadecimal; functions cannot be hashed."""
        digest = hashlib.sha256()
        for f in fields(self):  # type: ignore[arg-type]
            value = getattr(self, f.name)
            if callable(value):
                continue
            digest.update(f.name.encode())
            if isinstance(value, np.ndarray):
                digest.update(f"{value.dtype.str}{value.shape}".encode() + value.tobytes())
            elif isinstance(value, Content):
                digest.update(value.content_hash.encode())
            else:
                digest.update(repr(value).encode())
        return digest.hexdigest()

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return all(_same(getattr(self, f.name), getattr(other, f.name)) for f in fields(self))  # type: ignore[arg-type]

    def __hash__(self) -> int:
        return hash(self.content_hash)


def _same(a: Any, b: Any) -> bool:
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
        return (a.dtype, a.shape, a.tobytes()) == (b.dtype, b.shape, b.tobytes())
    return a is b or (type(a) is type(b) and a == b)
