"""A result document in a few lines of text."""

from collections.abc import Iterator
from typing import Any

from wsrender.indices.units import pretty_unit


def sampling_text(document: dict[str, Any]) -> str:
    """Robot and sampling of a result in one line, such as ``ur5e · 1,000,000 samples (sobol)``."""
    robot, sampling = document.get("robot") or {}, document.get("sampling") or {}
    names = [str(each.get("name")) for each in document.get("robots", ())] or [str(robot.get("name", "robot"))]
    parts = [" + ".join(names)]
    if "samples" in sampling:
        method = f" ({sampling['method']})" if "method" in sampling else ""
        parts.append(f"{sampling['samples']:,} samples{method}")
    return " · ".join(parts)


def summary_text(document: dict[str, Any]) -> str:
    """Volume, bounds, global indices, and the range and means of each local index; several lines."""
    facts = [f"  {name:<24}{value}" for name, value in _facts(document)]
    table = _index_table(document.get("indices") or {})
    return "\n".join([sampling_text(document), *facts, *table, *_difference_table(document)])


def _facts(document: dict[str, Any]) -> Iterator[tuple[str, str]]:
    volume = document.get("volume_m3") or {}
    for name, value in volume.items():
        if isinstance(value, int | float):
            yield f"{name} volume", f"{value:.4g} m³"
    if "shared_ratio" in document:
        yield "shared / any", f"{document['shared_ratio']:.4g}"
    if volume.get("refined"):
        low, high = volume["refined"]["ci95"]
        yield "refined volume", f"{volume['refined']['value']:.4g} m³ (95 %: {low:.4g} … {high:.4g})"
    targets = document.get("targets") or {}
    for name in ("reachable", "unreachable", "undecided"):
        if name in targets:
            yield f"{name} targets", f"{targets[name]:,}"
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


def _difference_table(document: dict[str, Any]) -> Iterator[str]:
    """The values of a comparison, one column for each robot."""
    rows = document.get("comparison") or []
    if not rows:
        return
    names = [str(robot["name"]) for robot in document["robots"]]
    width, columns = max(len(row["quantity"]) for row in rows), [max(12, len(name)) for name in names]
    yield f"  {'':<{width}}" + "".join(f"  {name:>{w}}" for name, w in zip(names, columns, strict=True)) + "  unit"
    for row in rows:
        values = "".join(f"  {_number(value):>{w}}" for value, w in zip(row["values"], columns, strict=True))
        yield f"  {row['quantity']:<{width}}{values}  {pretty_unit(row['unit'])}".rstrip()


def _number(value: float | None) -> str:
    return "–" if value is None else f"{value:.5g}"
