"""A result document in a few lines of text."""

from collections.abc import Iterator
from typing import Any

from wsrender.indices.units import pretty_unit


def sampling_text(document: dict[str, Any]) -> str:
    """Robot and sampling of a result in one line, such as ``ur5e · 1,000,000 samples (sobol)``."""
    robot, sampling = document.get("robot") or {}, document.get("sampling") or {}
    parts = [str(robot.get("name", "robot"))]
    if "samples" in sampling:
        method = f" ({sampling['method']})" if "method" in sampling else ""
        parts.append(f"{sampling['samples']:,} samples{method}")
    return " · ".join(parts)


def summary_text(document: dict[str, Any]) -> str:
    """Volume, bounds, global indices, and the range and means of each local index; several lines."""
    facts = [f"  {name:<24}{value}" for name, value in _facts(document)]
    table = _index_table(document.get("indices") or {})
    return "\n".join([sampling_text(document), *facts, *table])


def _facts(document: dict[str, Any]) -> Iterator[tuple[str, str]]:
    volume = document.get("volume_m3") or {}
    for name in ("occupied", "inner", "outer"):
        if name in volume:
            yield f"{name} volume", f"{volume[name]:.4g} m³"
    if volume.get("refined"):
        low, high = volume["refined"]["ci95"]
        yield "refined volume", f"{volume['refined']['value']:.4g} m³ (95 %: {low:.4g} … {high:.4g})"
    bounds = document.get("bounds_m") or {}
    if {"lower", "upper"} <= set(bounds):
        for axis, low, high in zip("xyz", bounds["lower"], bounds["upper"], strict=True):
            yield axis, f"{low:.3f} … {high:.3f} m"
    for name, value in (document.get("global") or {}).items():
        if isinstance(value, int | float):
            yield name.replace("_", " "), f"{value:.4g}"


def _index_table(indices: dict[str, dict[str, Any]]) -> Iterator[str]:
    if not indices:
        return
    extremes, means = ("minimum", "maximum"), ("joint_mean", "workspace_mean")
    width = max(map(len, indices))
    units = {name: pretty_unit(values.get("unit", "")) for name, values in indices.items()}
    unit_width = max(4, *map(len, units.values()))
    low_high = "".join(f"{name:>14}" for name in extremes)
    relative = "".join(f"{name.replace('_', ' '):>17}" for name in means)
    yield f"  {'':<{width}}{low_high}  {'unit':<{unit_width}}{relative}"
    for name, values in indices.items():
        low_high = "".join(f"{_number(values.get(column)):>14}" for column in extremes)
        relative = "".join(f"{_number(values.get(column)):>17}" for column in means)
        yield f"  {name:<{width}}{low_high}  {units[name]:<{unit_width}}{relative}".rstrip()
    if any(values.get("joint_mean") is not None for values in indices.values()):
        yield "  means are of value / maximum: over the samples, and over the occupied voxels"


def _number(value: float | None) -> str:
    return "–" if value is None else f"{value:.5g}"
