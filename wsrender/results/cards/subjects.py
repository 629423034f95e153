"""The cards of robots, results, volumes, tables, maps, boundaries, postures, targets and polytopes."""

from collections.abc import Iterator, Mapping
from functools import partial, singledispatch
from typing import Any

import numpy as np

from wsrender.geometry.planar.exact_boundary import ExactBoundary
from wsrender.geometry.polytopes import Polytope
from wsrender.indices.units import pretty_unit
from wsrender.reach.posture_sets import Postures
from wsrender.reach.targets import Reachability
from wsrender.results import drawing
from wsrender.results.cards.card_html import Card
from wsrender.results.export.columns import columns_of
from wsrender.results.export.headline import headline_lines, warning_lines
from wsrender.results.export.text import method_text, sampling_text, summary_facts
from wsrender.results.presentation import Picture, presentation_of
from wsrender.results.report import ShownPicture
from wsrender.results.report.entries import records_html, table_html
from wsrender.robot import Robot
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData

MOST_PICTURES = 2
ROWS = 8  # of a table
DOTS = 80  # an inch: pictures stay in the notebook's file
_FIRST = ("slices", "robot", "scatter")  # of the pictures that any result may have, the most telling
_INDEX_COLUMNS = ("unit", "minimum", "maximum", "joint_mean", "workspace_mean")


def card_of(what: Any) -> Card:
    """The card of a robot, result, volume, table, map or boundary, of postures, targets or a polytope."""
    return _result(what) if hasattr(what, "document") else _of_data(what)


@singledispatch
def _of_data(what: Any) -> Card:
    raise TypeError(f"there is no card of {type(what).__name__}")


def _result(result: Any) -> Card:
    """That of a `Result`, whose module is of a layer above."""
    document, plot = result.document, result.plot
    indices = [
        {"index": name} | {column: values[column] for column in _INDEX_COLUMNS if values.get(column) is not None}
        for name, values in (document.get("indices") or {}).items()
    ]
    return Card(
        f"{sampling_text(dict(document))} · {method_text(document.get('analysis', 'result'))}",
        headline_lines(document),
        warning_lines(document),
        dict(summary_facts(dict(document))),
        [records_html(indices)] if indices else [],
        pictures=[partial(_drawn, row, plot) for row in _telling(document, plot)],
    )


def _telling(document: Mapping[str, Any], plot: Any) -> list[Picture]:
    """The pictures of a result's card: those of its analysis first."""
    rows = {row.name: row for row in plot.pictures}
    own = [row.name for row in presentation_of(document).pictures if row.name in rows]
    general = [name for name in _FIRST if name in rows]
    return [rows[name] for name in [*own, *general, *rows][:MOST_PICTURES]] if rows else []


def _drawn(row: Picture, plot: Any) -> ShownPicture:
    return ShownPicture(row.name, drawing.png(row.drawn(plot), DOTS), row.caption)


@_of_data.register
def _robot(robot: Robot) -> Card:
    joints = [
        {"joint": name, "kind": "revolute" if turns else "prismatic", "unit": "rad" if turns else "m"}
        | {"lower": _end(low), "upper": _end(high)}
        for name, turns, low, high in zip(
            robot.joint_names, robot.chain.revolute, robot.lower_limits, robot.upper_limits, strict=True
        )
    ]
    facts = {"base → tip": f"{robot.base_frame} → {robot.tip_frame}"}
    if not robot.definition:
        facts["closed form"] = robot.closed_form or "none"
    facts["inertias"] = "yes" if robot.has_inertia else "none: no dynamic indices"
    warnings = [str(notice) for notice in robot.notices]
    pictures = [] if robot.definition else [partial(_standing, robot)]
    return Card(f"{robot.name} · {len(joints)} joints", (), warnings, facts, [records_html(joints)], pictures=pictures)


def _end(limit: float) -> Any:
    return float(limit) if np.isfinite(limit) else "none"


def _standing(robot: Robot) -> ShownPicture:
    from wsrender.results.view.robots import shown_alone
    from wsrender.results.view.shown_bodies import bodies_at

    arm = shown_alone(robot)
    figure = drawing.robot(robot.skeleton(arm.home), bodies=[bodies_at(arm, arm.home)])
    return ShownPicture("robot", drawing.png(figure, DOTS), "The arm in one of its postures")


@_of_data.register
def _volume(volume: VolumeData) -> Card:
    voxels, size = volume.n_occupied, volume.voxel_size_m
    facts = {"voxels": f"{voxels:,} of {size:g} m, together {voxels * size**3:.4g} m³"}
    for axis, (name, low) in enumerate(zip("xyz", volume.origin_m, strict=True)):
        facts[name] = f"{low:.4g} … {low + volume.shape[axis] * size:.4g} m"
    ranges = [
        {"statistic": statistic, "of": name, "unit": volume.units.get(name, "1")} | _range(values)
        for statistic, by_index in volume.voxels.statistics.items()
        for name, values in by_index.items()
    ]
    pictures = [partial(_planes, volume)] if voxels else []
    return Card("Volume", (), (), facts, [records_html(ranges)] if ranges else [], pictures=pictures)


def _range(values: np.ndarray) -> dict[str, Any]:
    known = values[~np.isnan(values)] if values.dtype.kind == "f" else values
    return {"least": known.min().item(), "largest": known.max().item()} if len(known) else {}


def _planes(volume: VolumeData) -> ShownPicture:
    return ShownPicture("slices", drawing.png(drawing.slices(volume), DOTS), "Voxels in planes")


@_of_data.register
def _table(table: Table) -> Card:
    return Card(f"Table of {len(table):,} rows", tables=[table_html(table, ROWS)])


@_of_data.register
def _map(samples: DistributionMap) -> Card:
    columns: Any = columns_of(samples)
    rows = Table({name: values[:ROWS] for name, values in columns.arrays(samples).items()}, columns.column_units())
    title = f"Distribution map of {len(samples):,} samples; the first {len(rows)}, in the world frame"
    pictures = [partial(_cloud, samples)] if len(samples) else []
    return Card(title, tables=[table_html(rows, ROWS)], pictures=pictures)


def _cloud(samples: DistributionMap) -> ShownPicture:
    return ShownPicture("scatter", drawing.png(drawing.scatter(samples), DOTS), "Samples")


@_of_data.register
def _boundary(boundary: ExactBoundary) -> Card:
    facts = dict(_measures(boundary))
    return Card("Exact boundary of a planar arm", (), (), facts, pictures=[partial(_outline, boundary)])


def _measures(boundary: ExactBoundary) -> Iterator[tuple[str, str]]:
    if boundary.dimension == 2:
        yield "area", f"{boundary.area:.6g} m² (exact)"
        yield "perimeter", f"{boundary.perimeter:.6g} m"
        yield "loops", f"{len(boundary.loops)}"
    yield "segments", f"{sum(map(len, boundary.segments)):,} lines and arcs"


def _outline(boundary: ExactBoundary) -> ShownPicture:
    from wsrender.results.drawing.outline import outline

    figure = outline(boundary.segments, filled=boundary.dimension == 2)
    return ShownPicture("boundary", drawing.png(figure, DOTS), "The boundary, in the plane of the arm")


@_of_data.register
def _postures(found: Postures) -> Card:
    poses = len(found.complete)
    facts = {"configurations": f"{found.count:,}, whole turns of hinges counted apart"}
    if found.family.any():
        facts["families"] = f"{found.family.sum():,}: the arm can move while the tip stays"
    if (blocked := found.reasons != "").any():
        facts["blocked"] = _counted(found.reasons[blocked])
    if poses:
        facts["complete"] = f"at {found.complete.sum():,} of {poses:,} {_plural('pose', poses)}: {found.evidence}"
    columns = {"pose": found.pose, **_joints(found.configurations), "sigma_min": found.sigma_min}
    columns |= {"windings": found.windings} | ({"reason": found.reasons} if blocked.any() else {})
    title = f"{len(found):,} {_plural('posture', len(found))} of {poses:,} {_plural('pose', poses)}"
    return Card(title, (), (), facts, [table_html(Table(columns), ROWS)] if len(found) else [])


@_of_data.register
def _reachability(found: Reachability) -> Card:
    count = len(found.labels)
    facts = {"labels": _counted(found.labels)} if count else {}
    if (told := found.reasons[found.reasons != ""]).size:
        facts |= {"reasons": _counted(told), "proven": f"{found.proven.sum():,}, that they are not reached"}
    columns = {"label": found.labels, "reason": found.reasons, **_joints(found.configurations)}
    columns |= {"distance": found.residual_m, "angle": found.residual_rad}  # that are left
    units = {"distance": "m", "angle": "rad"}
    table = table_html(Table(columns, units), ROWS)
    return Card(f"{count:,} {_plural('target', count)}", (), (), facts, [table] if count else [])


def _joints(configurations: np.ndarray) -> dict[str, np.ndarray]:
    """A column for each joint, whose names and units are not known."""
    return {f"q{k + 1}": column for k, column in enumerate(configurations.T)}


def _counted(names: np.ndarray) -> str:
    """``12 reachable, 3 blocked``, the most frequent first."""
    found = zip(*np.unique(names.astype(str), return_counts=True), strict=True)
    return ", ".join(f"{number:,} {name}" for name, number in sorted(found, key=lambda each: -each[1]))


def _plural(word: str, count: int) -> str:
    return word if count == 1 else f"{word}s"


@_of_data.register
def _polytope(found: Polytope) -> Card:
    unit, (x, y, z) = pretty_unit(found.unit), found.position.tolist()
    facts = {"radius": f"{found.radius:.4g} {unit}: in every direction that the task asks for"}
    facts |= {"dimension": f"{found.dimension}, {len(found.vertices):,} vertices, {len(found.facets):,} facets"}
    facts |= {"tip": f"({x:.4g}, {y:.4g}, {z:.4g}) m"}
    if len(found.vertices):
        low, high = found.vertices.min(axis=0), found.vertices.max(axis=0)
        facts |= {axis: f"{low[k]:.4g} … {high[k]:.4g} {unit}" for k, axis in enumerate("xyz")}
    else:
        facts["vertices"] = "none: nothing is allowed, not even 0"
    pictures = [partial(_shaped, found)] if found.dimension >= 2 else []
    return Card(f"Polytope of {found.kind} in world axes", (), (), facts, pictures=pictures)


def _shaped(found: Polytope) -> ShownPicture:
    from wsrender.results.drawing.polytope import polytope

    return ShownPicture(
        "polytope", drawing.png(polytope(found), DOTS), f"What is allowed, in {pretty_unit(found.unit)}"
    )
