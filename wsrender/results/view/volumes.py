"""Volumes of a result: occupancy and a channel for each statistic of an index, and the same in larger voxels."""

import re
from collections.abc import Iterator, Mapping
from itertools import count
from math import prod
from typing import Any

import numpy as np

from wsrender.results.drawing.okabe_ito import BLUE, GREEN, ORANGE, PURPLE, SKY_BLUE, VERDICTS, VERMILION, YELLOW
from wsrender.results.drawing.whole import are_whole
from wsrender.results.view.blobs import Blobs, Encoding, encoded, fitting, is_exact, limits
from wsrender.results.view.manifest import Category, Channel, Volume
from wsrender.results.view.words import said, unit_said
from wsrender.volume.volume_data import VolumeData, coarser
from wsrender.volume.voxels import Voxels

MOST_VOXELS = 256**3  # of a block that a page draws
FINE = 64**3  # voxels of a block from which on larger ones are shown first
FIRST = (4, 2)  # so many times as long
COLORS = ("#8c8c8c", BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY_BLUE, YELLOW)  # further names begin anew
_SILENT, _COUNTED = ("count", "center", "value"), ("number", "fraction")  # statistics, as labels say them
_NAMES = re.compile(r"-?\d+ [^,]+(, -?\d+ [^,]+)*")


def add_volumes(
    blobs: Blobs, volumes: Mapping[str, VolumeData | None], encoding: Encoding, most_voxels: int = MOST_VOXELS
) -> list[Volume]:
    """Entries of the volumes that hold something; of more than ``most_voxels`` in larger voxels, which is said."""
    held = {name: volume for name, volume in volumes.items() if volume is not None and len(volume.voxels.cells)}
    return [_with_levels(blobs, k, *each, encoding, most_voxels) for k, each in enumerate(held.items())]


def _with_levels(
    blobs: Blobs, number: int, name: str, volume: VolumeData, encoding: Encoding, most_voxels: int
) -> Volume:
    factor = next(n for n in count(1) if prod(_blocks(volume, n)) <= most_voxels)
    shown = volume if factor == 1 else coarser(volume, factor)
    entry = _entry(blobs, f"volume{number}", name, shown, encoding)
    if factor > 1:
        was = " x ".join(map(str, volume.shape))
        entry["reduced"] = (
            f"{was} voxels of {volume.voxel_size_m:g} m are shown in voxels {factor} times as long, of "
            f"{shown.voxel_size_m:g} m; the file has all"
        )
        entry["exact"] = False
    if prod(shown.shape) > FINE:
        levels = ((each, coarser(shown, each)) for each in FIRST)
        entry["coarser"] = [_entry(blobs, f"volume{number}.{n}", name, level, encoding) for n, level in levels]
    return entry


def _blocks(volume: VolumeData, factor: int) -> list[int]:
    """Shape of the block in voxels ``factor`` times as long."""
    ends = zip(volume.first_voxel, volume.shape, strict=True)
    return [(first + size - 1) // factor - first // factor + 1 for first, size in ends]


def _entry(blobs: Blobs, place: str, name: str, volume: VolumeData, encoding: Encoding) -> Volume:
    voxels, size = volume.voxels, prod(volume.shape)
    at = x_fastest(voxels)

    def dense(values: np.ndarray) -> np.ndarray:
        whole = np.full(size, np.nan if values.dtype.kind == "f" else 0, values.dtype)
        whole[at] = values
        return whole

    channels, exact = [], True
    for number, (statistic, index, values) in enumerate(arrays_of(volume)):
        unit = volume.units.get(index)
        shown, kept = channel(
            blobs, f"{place}.channel{number}", statistic, index, unit, values, encoding, size=size, dense=dense
        )
        channels.append(shown)
        exact = exact and kept
    i, j, k = (int(each) for each in volume.first_voxel)
    ones = np.ones(len(voxels.cells), np.uint8)
    entry: Volume = {
        "name": name,
        "label": said(name),
        "shape": volume.shape,
        "first_voxel": (i, j, k),
        "voxel_size_m": float(volume.voxel_size_m),
        "occupancy": blobs.numbers(f"{place}.occupancy", "uint8", size, lambda: dense(ones)),
        "channels": channels,
        "exact": exact,
    }
    for index in volume.best:
        entry["best_sample"] = {"index": index}
    return entry


def arrays_of(volume: VolumeData) -> Iterator[tuple[str, str, np.ndarray]]:
    """(statistic, index, values (V,)) of what voxels hold, maxima first; samples, where they differ, last."""
    statistics = volume.voxels.statistics
    for statistic in sorted(statistics, key=lambda name: name != "maximum"):
        for index, values in statistics[statistic].items():
            yield statistic, index, values
    samples = volume.voxels.count
    if not statistics or samples.min() < samples.max():
        yield "count", "samples", samples


def x_fastest(voxels: Voxels) -> np.ndarray:
    """Places (V,) of voxels in arrays of their block whose first axis is the fastest."""
    nx, ny, _nz = voxels.shape
    x, y, z = voxels.at
    return x + nx * (y + ny * z)


def channel(
    blobs: Blobs,
    place: str,
    statistic: str,
    name: str,
    unit: str | None,
    values: np.ndarray,
    encoding: Encoding,
    *,
    size: int | None = None,
    dense: Any = lambda values: values,
) -> tuple[Channel, bool]:
    """A channel of values (V,), in every encoding, and whether it holds the very numbers; ``dense`` places them.

    Text is held by its place among all that occur.
    """
    categories = None
    if values.dtype.kind not in "biuf":
        names, values = np.unique(values, return_inverse=True)
        categories = {float(k): str(each) for k, each in enumerate(names)}
    elif unit is not None and _NAMES.fullmatch(unit):
        codes = (each.partition(" ") for each in unit.split(", "))
        categories, unit = {float(code): each for code, _, each in codes}, None
    values = np.asarray(values, np.float64)
    low, high = limits(values)
    chosen = fitting(encoding, low, high)
    size = len(values) if size is None else size
    data = blobs.channel(place, chosen, size, lambda each: dense(encoded(values, each, low, high)))
    entry: Channel = {
        "name": name,
        "statistic": statistic,
        "label": said("" if statistic in _SILENT else f"{statistic} of" if statistic in _COUNTED else statistic, name),
        "unit": unit_said(unit),
        "minimum": low,
        "maximum": high,
        "data": data,
    }
    if categories is not None:
        entry["categories"] = _colored(categories)
        return entry, is_exact(values, chosen, low, high)
    if low < 0 < high:
        entry["signed"] = True
    if are_whole(values):
        entry["whole"] = True
    return entry, is_exact(values, chosen, low, high)


def _colored(names: Mapping[float, str]) -> list[Category]:
    """Verdicts in the colours that they have in pictures; other names in those that are left."""
    own = {name: VERDICTS[name] for name in names.values() if name in VERDICTS}
    left = [color for color in COLORS if color not in own.values()]
    others = [name for name in names.values() if name not in own]
    colors = own | {name: left[k % len(left)] for k, name in enumerate(others)}
    return [{"value": value, "name": said(name), "color": colors[name]} for value, name in names.items()]
