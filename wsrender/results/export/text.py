"""A result document in a few lines of text."""

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any

from wsrender.indices.units import pretty_unit
from wsrender.results.export.headline import head_lines
from wsrender.volume.measure import TABLE_UNITS, UNITS

METHOD_LETTERS = {"grid": "A", "grid_by_subsystem": "B", "exact": "C", "solids": "D"}


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
        parts.append(f"{sampling['samples']:,} samples{method}")
    if found := document.get("capability"):
        parts.append(f"{found['directions']} directions of approach by the tip's {found['approach_axis']} axis")
    return " · ".join(parts)


def method_text(method: Any) -> str:
    """How samples are spread, in words: names of methods are those of fields."""
    return _METHODS.get(str(method), str(method).replace("_", " "))


def summary_text(document: dict[str, Any]) -> str:
    """Headline, warnings, admitted samples, volumes, bounds, global and local indices, as several lines."""
    head = [f"  {line}" for line in head_lines(document)]
    facts = [f"  {name:<24}{value}" for name, value in _facts(document)]
    table = _index_table(document.get("indices") or {})
    return "\n".join([sampling_text(document), *head, *facts, *table, *_difference_table(document)])


def _facts(document: dict[str, Any]) -> Iterator[tuple[str, str]]:
    headline = document.get("headline") or {}
    if samples := document.get("samples"):
        reasons = ", ".join(f"{name} {number:,}" for name, number in samples["rejected"].items())
        yield "admitted samples", f"{samples['admitted']:,} of {samples['drawn']:,}; rejected by {reasons}"
    if flat := document.get("flat"):
        yield from _flat(flat, headline)
    else:
        yield from _measured(document, headline)
    if "shared_ratio" in document:
        yield "shared / any", f"{document['shared_ratio']:.4g}"
    mapping = document.get("mapping") or {}
    if "succeeded" in mapping:
        scale, offset = (", ".join(f"{number:.4g}" for number in mapping[name]) for name in ("scale", "offset_m"))
        outside = "all points inside" if mapping["succeeded"] else f"{mapping['failing_points']:,} points outside"
        yield "mapping", f"{outside}; scale {scale}; offset {offset} m; efficiency {mapping['efficiency']:.4g}"
        search = document.get("search") or {"found": True}
        if not search["found"]:
            at = search.get("at_scale", search.get("at_factor"))  # a factor on the job's scale before version 0.2
            most = f"{100 * search['most_inside']:.3g} % are inside at {at:.3g}"
            yield "search", f"no scale fits; at most {most}. The mapping is the job's own"
    if found := document.get("orientation_workspace"):
        share = f"{100 * found['share']:.3g} % of their measure"  # a solid angle or a volume of rotations
        yield "orientations reached", f"{found['reached']:,} of {found['orientations']:,}, {share}"
    yield from _planar(document)
    yield from _patches(document)
    targets = document.get("targets") or {}
    for name in ("reachable", "unreachable", "undecided"):
        if name in targets:
            yield f"{name} targets", f"{targets[name]:,}"
    if capability := document.get("capability"):
        yield "reachability index", f"{capability['mean_index']:.4g} on average"
        yield "dexterous volume", f"{capability['dexterous_volume_m3']:.4g} m³"
    if found := document.get("kinetostatic_field"):
        length, passivity = found["characteristic_length"], found["passivity"]
        yield "characteristic length", f"{length['length_m']:.4g} m ({length['method']})"
        yield "force", f"{found['mean_force_n']:.4g} N on average, {found['largest_force_n']:.4g} N at most"
        share, bound = passivity["share_of_postures_within_bound"], passivity["stiffness_bound_n_per_m"]
        yield "passive stiffness", f"{100 * share:.3g} % of postures are below {bound:.4g} N/m"
        bound = passivity.get("loop_work_bound_j")  # since version 0.2
        yield (
            "work of closed paths",
            f"{passivity['largest_loop_work_j']:.3g} J at most" + ("" if bound is None else f", bound {bound:.3g} J"),
        )
    for found in document.get("workspaces", ()):
        mode = found["working_mode"]
        own = [each for each in document["aspects"] if each["working_mode"] == mode]
        yield f"working mode {mode}", f"{found['area_m2']:.8g} m², {len(own)} aspects without type 2 singularities"
    if document.get("analysis") == "method_comparison":
        yield from _methods(document)
    if document.get("analysis") == "design_optimization":
        yield from _design(document)
    bounds = document.get("bounds_m") or {}
    if {"lower", "upper"} <= set(bounds):
        for axis, low, high in zip("xyz", bounds["lower"], bounds["upper"], strict=True):
            yield axis, f"{low:.3f} … {high:.3f} m"
    for name, value in (document.get("global") or {}).items():
        if isinstance(value, int | float):
            yield name.replace("_", " "), f"{value:.4g}"


def method_rows(document: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The runs of a comparison of methods with their times: Table 4 of [SNK], whose letters the methods get.

    Times are in ``timing_s`` alone, because equal jobs give equal files.
    """
    rows = []
    for run in document["methods"]:
        name = run["method"] if run["size_m"] is None else f"{run['method']} {run['size_m']:.3g} m"
        method = f"{METHOD_LETTERS[run['method']]} {run['method'].replace('_', ' ')}"
        rows.append({**run, "method": method, "time_s": document["timing_s"][name]})
    return rows


def _methods(document: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """Volume, error and time of every run."""
    for run in method_rows(document):
        size = "" if run["size_m"] is None else f" {run['size_m']:.3g} m"
        wrong = "" if run["relative_error"] is None else f", error {100 * run['relative_error']:+.3g} %"
        yield (
            f"{run['method'].replace('grid by', 'by')}{size}",
            f"{run['volume_m3']:.6g} m³{wrong}, {run['time_s']:.3g} s",
        )


def _design(document: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """The best design and what the search took."""
    search, best = document["search"], document["best"]
    yield "designs", f"{search['designs']:,}, {search['evaluated']:,} evaluated; {search['ended']}"
    if best is None:
        yield "best design", "none has a value"
        return
    yield "best design", ", ".join(f"{name} {value:.6g}" for name, value in best["parameters"].items())
    units = {objective["name"]: objective["unit"] or "1" for objective in document["objectives"]}
    values = (f"{name} {value:.6g} {pretty_unit(units[name])}" for name, value in best["values"].items())
    yield "its values", ", ".join(value.removesuffix(" 1") for value in values)
    if best["at_bounds"]:
        yield "at a bound", ", ".join(best["at_bounds"])
    if "pareto" in document:
        yield "beaten by none", f"{len(document['pareto'])} designs"


def _planar(document: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """Area, perimeter and number of segments of a planar boundary, and the area by Monte Carlo."""
    exact, estimated = document.get("exact") or {}, document.get("monte_carlo") or {}
    if "perimeter_m" in exact:
        unsure = "" if estimated.get("converged", True) else ", not converged"
        yield "area", f"{exact['area_m2']:.9g} m² (Monte Carlo: {estimated['area_m2']:.4g} m²{unsure})"
        yield "perimeter", f"{exact['perimeter_m']:.9g} m"
        kinds = [segment["kind"] for loop in exact["loops"] for segment in loop["segments"]]
        holes = sum(loop["hole"] for loop in exact["loops"])
        yield "boundary", f"{kinds.count('arc')} arcs, {kinds.count('line')} lines; {holes} holes"


def _patches(document: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """How many patches of which kind, edges and corners the boundary of a spatial arm has, and its volume."""
    if document.get("analysis") == "boundary_patches":
        if "integrated" in document["volume_m3"]:
            yield "volume", f"{document['volume_m3']['integrated']:.10g} m³"
        counts = Counter(patch["kind"].replace("_", " ") for patch in document["patches"])
        kinds = ", ".join(f"{count} {kind}" for kind, count in counts.items())
        yield "patches", f"{kinds}; {len(document['edges'])} edges, {len(document['corners'])} corners"


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
    unit, said = pretty_unit(TABLE_UNITS[UNITS[quantity]]), (headline.get("value"), headline.get("ci95"))
    for name, value in values.items():
        words = prefix + name.replace("_", " ")
        if isinstance(value, int | float):
            if (value, [value, value]) != said:
                yield f"{words} {quantity}", f"{value:.4g} {unit}"
        elif isinstance(value, dict) and "ci95" in value:
            low, high = value["ci95"]
            if (value["value"], [low, high]) != said:
                yield f"{words} {quantity}", f"{value['value']:.4g} {unit} (95 %: {low:.4g} … {high:.4g})"
        elif isinstance(value, dict):
            yield from _measures(value, quantity, headline, f"{words} ")


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
