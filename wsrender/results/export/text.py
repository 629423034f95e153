"""A result document in a few lines of text."""

from collections.abc import Iterator, Mapping
from typing import Any

from wsrender.indices.units import pretty_unit
from wsrender.results.export.headline import head_lines
from wsrender.results.presentation import presentation_of
from wsrender.volume.measure import UNITS

MOST_PAIRS = 3  # told of those that collide
_METHODS = {
    "boundary": "near the joint limits",
    "given": "as given",
    "grid_by_subsystem": "grid, by subsystem",
    "lattices": "on lattices of positions and of joint angles",
}


def sampling_text(document: dict[str, Any]) -> str:
    """Robot and sampling of a result in one line, such as ``ur5e · 1,000,000 samples (sobol)``."""
    robot = document.get("robot") or document.get("mechanism") or {}
    sampling = document.get("sampling") or {}
    names = [str(each.get("name")) for each in document.get("robots", ())] or [str(robot.get("name", "robot"))]
    parts = [" + ".join(names)]
    if "samples" in sampling:
        method = f" ({method_text(sampling['method'])})" if "method" in sampling else ""
        parts.append(f"{sampling['samples']:,} sample{'' if sampling['samples'] == 1 else 's'}{method}")
    if constraints := dict.fromkeys(name for _, samples in _admissions(document) for name in samples["rejected"]):
        parts.append(f"admitted by {', '.join(constraints).replace('_', ' ')}")
    return " · ".join([*parts, *presentation_of(document).title(document)])


def method_text(method: Any) -> str:
    """How samples are spread, in words: names of methods are those of fields."""
    return _METHODS.get(str(method), str(method).replace("_", " "))


def summary_text(document: dict[str, Any]) -> str:
    """Headline, warnings, admitted samples, volumes, bounds, global and local indices, as several lines."""
    head = [f"  {line}" for line in head_lines(document)]
    facts = [f"  {name:<24}{value}" for name, value in summary_facts(document)]
    table = _index_table(document.get("indices") or {}, "admitted samples" if document.get("samples") else "samples")
    return "\n".join([sampling_text(document), *head, *facts, *table, *_difference_table(document)])


def _admissions(document: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """What constraints admit, by name: of all samples, or of those of each side of a job."""
    if samples := document.get("samples"):
        yield "admitted samples", samples
    for side, samples in document.get("admission", {}).items():
        yield f"admitted of {side}", samples


def summary_facts(document: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """What a summary says beside the headline and the indices: (name, text)."""
    headline = document.get("headline") or {}
    for name, samples in _admissions(document):
        reasons = ", ".join(f"{reason} {number:,}" for reason, number in samples["rejected"].items())
        yield name, f"{samples['admitted']:,} of {samples['drawn']:,}; rejected by {reasons}"
    yield from _rejections(document.get("rejections") or {})
    presentation = presentation_of(document)
    if presentation.measures(document) or not headline:  # else the facts have said it
        flat = document.get("flat")
        yield from _flat(flat, headline) if flat else _measured(document, headline)
        yield from presentation.facts(document)
    bounds = document.get("bounds_m") or {}
    if {"lower", "upper"} <= set(bounds):
        for axis, low, high in zip("xyz", bounds["lower"], bounds["upper"], strict=True):
            yield axis, f"{low:.3f} … {high:.3f} m"
    for name, value in (document.get("global") or {}).items():
        if isinstance(value, int | float):
            yield name.replace("_", " "), f"{value:.4g}"


def _rejections(rejections: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """The pairs that collide most often, and what is lost beside a loss at random."""
    if found := rejections.get("pairs"):
        most = [
            f"{' – '.join(pair['shapes'])} {pair['samples'] / found['counted']:.2%}"
            for pair in found["colliding"][:MOST_PAIRS]
        ]
        more = len(found["colliding"]) - len(most)
        told = "; ".join(most) + (f"; {more} more" if more else "") or "none"
        yield "colliding pairs", f"{told} (of {found['counted']:,} samples)"
    if lost := rejections.get("volume_m3"):
        random, (low, high) = lost["lost_at_random"]["value"], lost["lost_at_random"]["ci95"]
        beside = f"with as many samples dropped at random {random:.4g} m³ (95 %: {low:.4g} … {high:.4g})"
        yield "voxels lost", f"{lost['lost']:.4g} m³ of {lost['drawn']:.4g}; {beside}"


def _flat(flat: dict[str, Any], headline: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Area or length of what a platform reaches that stays in a plane or on a line."""
    measured = {name: flat[name] for name in ("occupied", "refined")}
    yield from _measures(measured, flat["quantity"], headline)


def _measured(document: dict[str, Any], headline: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """What is known of the volume, area or length; voxels beside an area or a length make none, and are counted."""
    quantity = headline.get("quantity", "volume")
    yield from _measures(document.get(f"{quantity}_{UNITS[quantity]}") or {}, quantity, headline)
    occupied, size = (document.get("volume_m3") or {}).get("occupied"), document.get("voxel_size_m")
    if quantity != "volume" and occupied and size:
        yield "occupied voxels", f"{round(occupied / size**3):,} of {size:g} m"


def _measures(
    values: Mapping[str, Any], quantity: str, headline: Mapping[str, Any], prefix: str = ""
) -> Iterator[tuple[str, str]]:
    """Numbers, and values with their interval, at any depth; not the headline once more."""
    unit, said = pretty_unit(UNITS[quantity]), (headline.get("value"), headline.get("ci95"))
    for name, value in values.items():
        words = prefix + name.replace("_", " ")
        if isinstance(value, int | float):
            if (value, [value, value]) != said:
                yield f"{words} {quantity}", f"{value:.4g} {unit}"
        elif isinstance(value, dict) and "ci95" in value:
            low, high = value["ci95"]
            if (value["value"], [low, high]) != said:
                by = ", ".join(f"{name} {each['value']:.4g}" for name, each in value.get("by", {}).items())
                text = f"{value['value']:.4g} {unit} (95 %: {low:.4g} … {high:.4g})"
                yield f"{words} {quantity}", f"{text}; by {by}" if by else text
        elif isinstance(value, dict):
            yield from _measures(value, quantity, headline, f"{words} ")


def _index_table(indices: dict[str, dict[str, Any]], samples: str = "samples") -> Iterator[str]:
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
        yield f"  means are of value / maximum: over the {samples}, and over the occupied voxels"


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
