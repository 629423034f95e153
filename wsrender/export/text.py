"""A result document in a few lines of text."""

from collections.abc import Iterator
from typing import Any


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
    return "\n".join(
        [sampling_text(document), *_facts(document), *_index_table(document.get("indices") or {})]
    )


def _facts(document: dict[str, Any]) -> Iterator[str]:
    volume = document.get("volume_m3") or {}
    if "occupied" in volume:
        bounds = [f"{name} {volume[name]:.4g}" for name in ("inner", "outer") if name in volume]
        yield f"  volume      {volume['occupied']:.4g} m³ occupied" + (
            f" ({', '.join(bounds)})" if bounds else ""
        )
    if volume.get("refined"):
        low, high = volume["refined"]["ci95"]
        yield f"  refined     {volume['refined']['value']:.4g} m³ (95 %: {low:.4g} … {high:.4g})"
    bounds = document.get("bounds_m") or {}
    if {"lower", "upper"} <= set(bounds):
        pairs = zip("xyz", bounds["lower"], bounds["upper"], strict=True)
        yield (
            "  bounds      " + ", ".join(f"{axis} {low:.3f} … {high:.3f}" for axis, low, high in pairs) + " m"
        )
    for name, value in (document.get("global") or {}).items():
        if isinstance(value, int | float):
            yield f"  {name.replace('_', ' ')}: {value:.4g}"


def _index_table(indices: dict[str, dict[str, Any]]) -> Iterator[str]:
    if not indices:
        return
    columns = ("minimum", "maximum", "joint_mean", "workspace_mean")
    width = max(map(len, indices))
    yield "  " + " " * width + "".join(f"{name.replace('_', ' '):>16}" for name in columns) + "  unit"
    for name, values in indices.items():
        numbers = "".join(f"{_number(values.get(column)):>16}" for column in columns)
        yield f"  {name:<{width}}{numbers}  {values.get('unit', '')}".rstrip()


def _number(value: float | None) -> str:
    return "–" if value is None else f"{value:.5g}"
