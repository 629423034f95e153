"""Bulk data of a view: arrays and files by name, made when they are asked for."""

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Literal

import numpy as np

from wsrender.results.view.manifest import Data, Type

Encoding = Literal["uint8", "float16", "float32"]
ENCODINGS: tuple[Encoding, ...] = ("uint8", "float16", "float32")
STEPS = 254  # between the least and the largest value of a channel in bytes: 1 … 255, 0 is none
_LARGEST, _NORMAL, _ROUNDING = 65504.0, 2.0**-14, 2.0**-11  # of half precision


class Blobs(Mapping[str, bytes]):
    """Bytes by name, each made anew when it is asked for."""

    def __init__(self):
        self._makers: dict[str, Callable[[], bytes]] = {}

    def numbers(self, name: str, type: Type, length: int, make: Callable[[], np.ndarray]) -> Data:
        """Tell of an array of ``length`` numbers, which ``make`` gives as ``type``."""
        dtype = np.dtype(type).newbyteorder("<")
        self._makers[name] = lambda: np.ascontiguousarray(make(), dtype).tobytes()
        return {"blob": name, "type": type, "length": length, "compression": None}

    def channel(self, name: str, chosen: Encoding, length: int, make: Callable[[Encoding], np.ndarray]) -> Data:
        """Tell of a channel in every encoding; the entry is of the one that is ``chosen``."""
        entries = {
            each: self.numbers(f"{name}.{each}", each, length, lambda each=each: make(each)) for each in ENCODINGS
        }
        return entries[chosen]

    def file(self, name: str, content: bytes) -> Data:
        """Keep a GLB file; its blob is called ``name`` with that ending."""
        self._makers[f"{name}.glb"] = lambda: content
        return {"blob": f"{name}.glb", "type": "glb", "length": len(content), "compression": None}

    def __getitem__(self, name: str) -> bytes:
        return self._makers[name]()

    def __iter__(self) -> Iterator[str]:
        return iter(self._makers)

    def __len__(self) -> int:
        return len(self._makers)


def limits(values: np.ndarray) -> tuple[float, float]:
    """The least and the largest finite value; 0 and 0 where there is none."""
    known = values[np.isfinite(values)]
    return (float(known.min()), float(known.max())) if known.size else (0.0, 0.0)


def fitting(encoding: Encoding, low: float, high: float) -> Encoding:
    """The encoding itself, or single precision where half precision would not tell values from ``low`` to ``high``.

    Halves have 11 bits: values must be none too large or too small for them, nor near each other and far from 0, so
    that rounding moves none by more than a step of 256 colours.
    """
    size = max(abs(low), abs(high))
    told = (
        size <= _LARGEST and (size >= _NORMAL or size == 0) and (high == low or size * _ROUNDING <= (high - low) / 256)
    )
    return "float32" if encoding == "float16" and not told else encoding


def encoded(values: np.ndarray, encoding: Encoding, low: float, high: float) -> np.ndarray:
    """Numbers as a channel holds them; what is not finite is NaN, in bytes 0."""
    known = np.isfinite(values)
    if encoding != "uint8":
        most = float(np.finfo(encoding).max)
        return np.where(known, values, np.nan).clip(-most, most).astype(encoding)
    scale = STEPS / (high - low) if high > low and math.isfinite(STEPS / (high - low)) else 0.0
    steps = np.where(known, np.rint((np.where(known, values, low) - low) * scale), -1.0)
    return (1 + steps.clip(-1, STEPS)).astype(np.uint8)


def is_exact(values: np.ndarray, encoding: Encoding, low: float, high: float) -> bool:
    """Whether a channel holds the very numbers."""
    return encoding != "uint8" and np.array_equal(encoded(values, encoding, low, high), values, equal_nan=True)
