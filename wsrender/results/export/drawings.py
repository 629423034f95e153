"""Boundaries of lines and arcs as drawings: DXF for CAD, SVG for everything else. Coordinates are metres."""

from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np

from wsrender.errors import MissingExtraError
from wsrender.results.export.atomic import new_file
from wsrender.volume.table import Table

METRES = 6  # ezdxf.units.M, the header variable $INSUNITS
_FULL = 2 * np.pi - 1e-9
_COLORS = (7, 1)  # DXF colour numbers of the first loop, which is the outer one, and of the others


def write_dxf(table: Table, path: Path) -> None:
    """A segment table as LINE, ARC and CIRCLE entities: loop 0 on layer ``outer``, the others on ``holes``.

    Raises MissingExtraError without ezdxf.
    """
    try:
        import ezdxf
        from ezdxf._options import options
    except ModuleNotFoundError as error:
        raise MissingExtraError("ezdxf", "engine") from error
    fixed = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True  # equal boundaries give equal files
    try:
        document = ezdxf.new("R2010", units=METRES)  # type: ignore[attr-defined]
        for layer, color in zip(("outer", "holes"), _COLORS, strict=True):
            document.layers.add(layer, color=color)
        space = document.modelspace()
        for row in range(len(table)):
            layer = {"layer": "outer" if table["loop"][row] == 0 else "holes"}
            _add(space, {name: column[row] for name, column in table.columns.items()}, layer)
        for name in sorted(document.entitydb.dxf_types_in_use()):  # a set's order is each process's own
            document.classes.add_class(name)
        with new_file(path) as temporary:
            document.saveas(temporary)
    finally:
        options.write_fixed_meta_data_for_testing = fixed


def _add(space, segment: dict, layer: dict[str, str]) -> None:
    if segment["kind"] == "line":
        space.add_line((segment["x_s"], segment["y_s"]), (segment["x_e"], segment["y_e"]), layer)
        return
    center, radius, sweep = (segment["x_o"], segment["y_o"]), segment["R"], segment["sweep"]
    if abs(sweep) >= _FULL:
        space.add_circle(center, radius, layer)
        return
    angles = [_degrees(segment, end) for end in "se"]
    start, end = angles if sweep > 0 else angles[::-1]  # DXF arcs run counter-clockwise
    space.add_arc(center, radius, start, end, dxfattribs=layer)


def _degrees(segment: dict, end: str) -> float:
    return float(np.degrees(np.arctan2(segment[f"y_{end}"] - segment["y_o"], segment[f"x_{end}"] - segment["x_o"])))


def write_svg(table: Table, path: Path) -> None:
    """A segment table as one SVG path with true arcs, filled by the even-odd rule; y points up, one unit is a metre."""
    points = np.concatenate([_extremes(table, row) for row in range(len(table))])
    low, high = points.min(axis=0), points.max(axis=0)
    width = float((high - low).max()) or 1.0
    margin = 0.03 * width
    box = (low[0] - margin, -high[1] - margin, high[0] - low[0] + 2 * margin, high[1] - low[1] + 2 * margin)
    data = " ".join(_loop_path(table, np.flatnonzero(table["loop"] == k)) for k in np.unique(table["loop"]))
    closed = "Z" in data
    style = f'fill="{"#dbe9f6" if closed else "none"}" fill-rule="evenodd" stroke="#1f3b57"'
    text = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox={quoteattr(" ".join(map(_number, box)))}>\n'
        f'<path transform="scale(1 -1)" {style} stroke-width="{_number(0.004 * width)}" d={quoteattr(data)}/>\n'
        "</svg>\n"
    )
    with new_file(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def _loop_path(table: Table, rows: np.ndarray) -> str:
    first, last = rows.tolist()[0], rows.tolist()[-1]
    parts = [f"M {_number(table['x_s'][first])} {_number(table['y_s'][first])}"]
    parts += [_step(table, row) for row in rows]
    gap = np.hypot(table["x_s"][first] - table["x_e"][last], table["y_s"][first] - table["y_e"][last])
    return " ".join([*parts, "Z"] if gap <= 1e-9 * (1 + abs(table["x_s"][first])) else parts)


def _step(table: Table, row: int) -> str:
    end = f"{_number(table['x_e'][row])} {_number(table['y_e'][row])}"
    if table["kind"][row] == "line":
        return f"L {end}"
    radius, sweep = _number(table["R"][row]), float(table["sweep"][row])
    turn = int(sweep > 0)
    if abs(sweep) < _FULL:
        return f"A {radius} {radius} 0 {int(abs(sweep) > np.pi)} {turn} {end}"
    # An SVG arc that ends where it starts is nothing: a circle takes two.
    x, y = (2 * float(table[f"{axis}_o"][row]) - float(table[f"{axis}_s"][row]) for axis in "xy")
    opposite = f"{_number(x)} {_number(y)}"
    return f"A {radius} {radius} 0 1 {turn} {opposite} A {radius} {radius} 0 1 {turn} {end}"


def _extremes(table: Table, row: int) -> np.ndarray:
    """Ends of a segment, and the corners of an arc's circle: enough for a box around it."""
    ends = np.array([[table[f"x_{end}"][row], table[f"y_{end}"][row]] for end in "se"])
    if table["kind"][row] == "line":
        return ends
    center, radius, sweep = np.array([table["x_o"][row], table["y_o"][row]]), table["R"][row], table["sweep"][row]
    start = np.arctan2(*(ends[0] - center)[::-1])
    axes = np.arange(4) * np.pi / 2
    passed = np.mod((axes - start) * np.sign(sweep), 2 * np.pi) <= abs(sweep)
    return np.concatenate([ends, center + radius * np.stack([np.cos(axes), np.sin(axes)], axis=1)[passed]])


def _number(value: Any) -> str:
    return repr(float(value) + 0.0)
