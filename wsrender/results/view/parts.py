"""Points, arrows, lines, maps and plots of a view, of what a result holds."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import count
from typing import Any

import numpy as np

from wsrender.documents.placements import COORDINATES
from wsrender.results.presentation import CURVES
from wsrender.results.view.additions import Arrows, curve_plot, lines, quantity, vectors
from wsrender.results.view.blobs import Blobs, Encoding
from wsrender.results.view.manifest import FloorMap, Glyphs, Plot, Skeleton, ViewCurves, ViewPoints
from wsrender.results.view.volumes import channel
from wsrender.results.view.words import said, unit_said
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData

MOST_POINTS = 1_000_000
MOST_ARROWS = 20_000
CLASSES = 40  # of a histogram
ARC_STEP = np.deg2rad(3.0)  # of lines that stand for arcs
FINEST = 65535  # steps of a quantised coordinate
LEADING = ("label", "weight", "served", "share")  # what maps and points are coloured by first
SCALES = "scales"  # of the tables in `CURVES` the one over the scale of a mapping
_BAND = ("_low", "_high")  # endings of the columns that bound another


def add_points(
    blobs: Blobs,
    samples: DistributionMap | None,
    tables: Mapping[str, Table],
    encoding: Encoding,
    omitted: list[str],
) -> list[ViewPoints]:
    """Sampled positions with their indices, and the rows of tables that have a position."""
    found: list[tuple[str, np.ndarray, dict[str, np.ndarray], Mapping[str, str]]] = []
    if samples is not None and len(samples):
        found.append(("samples", np.asarray(samples.position), dict(samples.indices), samples.units))
    for name, table in tables.items():
        position = table.columns.get("position")
        if position is not None and position.ndim == 2 and position.shape[1] == 3 and len(table):
            columns = {key: table.columns[key] for key in _shown(table)}
            found.append((name, position, columns, table.units))
    entries = (_points(blobs, f"points{k}", *each, encoding, omitted) for k, each in enumerate(found))
    return [entry for entry in entries if entry is not None]


def _shown(table: Table) -> list[str]:
    """Columns that are colours of points, those of `LEADING` first: no joint, bit field, name or free text."""
    few = [
        key
        for key, values in table.columns.items()
        if values.ndim == 1
        and key != "name"
        and not key.startswith("q_")
        and (values.dtype.kind in "biuf" or len(np.unique(values)) <= 32)
    ]
    return sorted(
        few, key=lambda key: next((k for k, word in enumerate(LEADING) if key.startswith(word)), len(LEADING))
    )


def _points(
    blobs: Blobs,
    place: str,
    name: str,
    position: np.ndarray,
    columns: Mapping[str, np.ndarray],
    units: Mapping[str, str],
    encoding: Encoding,
    omitted: list[str],
) -> ViewPoints | None:
    kept = np.flatnonzero(np.isfinite(position).all(axis=1))
    if len(kept) > MOST_POINTS:
        omitted.append(f"{len(kept) - MOST_POINTS:,} of {len(kept):,} points of {name}: {MOST_POINTS:,} are shown")
        kept = kept[np.linspace(0, len(kept) - 1, MOST_POINTS).astype(np.int64)]
    if not len(kept):
        return None
    position = position[kept]
    lower, upper = position.min(axis=0), position.max(axis=0)
    step = np.where(upper > lower, (upper - lower) / FINEST, 1.0)
    channels = [
        channel(blobs, f"{place}.channel{k}", "", key, units.get(key), values[kept], encoding)[0]
        for k, (key, values) in enumerate(columns.items())
    ]
    positions = blobs.numbers(
        f"{place}.positions", "uint16", 3 * len(kept), lambda: np.rint((position - lower) / step).ravel()
    )
    box = [tuple(map(float, corner)) for corner in (lower, upper)]
    return {
        "name": name,
        "label": said(name),
        "count": len(kept),
        "lower": (box[0][0], box[0][1], box[0][2]),
        "upper": (box[1][0], box[1][1], box[1][2]),
        "positions": positions,
        "channels": channels,
    }


def vector_fields(volumes: Mapping[str, VolumeData | None]) -> Iterator[Arrows]:
    """The vectors of volumes, from the centres of their voxels; zero and unknown ones are none."""
    for name, volume in volumes.items():
        for vector, values in {} if volume is None else volume.voxels.vectors.items():
            assert volume is not None
            kept = np.isfinite(values).all(axis=1) & (values != 0).any(axis=1)
            centers = (np.array(volume.first_voxel)[:, None] + volume.voxels.at + 0.5).T * volume.voxel_size_m
            shown = vector if name == "volume" else f"{name} {vector}"
            yield Arrows(shown, centers[kept], np.asarray(values)[kept], volume.units.get(vector, "1"))


def add_arrows(blobs: Blobs, arrows: Iterable[Arrows], omitted: list[str]) -> list[Glyphs]:
    """Entries of arrows; of very many an even part, which is said."""
    entries: list[Glyphs] = []
    for k, each in enumerate(each for each in arrows if len(each.origins)):
        rows = np.arange(len(each.origins))
        if len(rows) > MOST_ARROWS:
            omitted.append(f"{len(rows) - MOST_ARROWS:,} of {len(rows):,} arrows of {each.name}")
            rows = np.linspace(0, len(rows) - 1, MOST_ARROWS).astype(np.int64)
        ends = {"origins": each.origins[rows], "vectors": each.vectors[rows]}
        data = {
            end: blobs.numbers(f"arrows{k}.{end}", "float32", values.size, lambda values=values: values.ravel())
            for end, values in ends.items()
        }
        entries.append({"name": each.name, "label": said(each.name), "unit": unit_said(each.unit),
                        "origins": data["origins"], "vectors": data["vectors"]})  # fmt: skip
    return entries


def skeletons(skeleton: np.ndarray | None, legs: int, names: Sequence[str]) -> list[Skeleton]:
    """Lines through joints (K, P, 3): one by configuration, or one for each of ``legs`` or of robots of ``names``."""
    if skeleton is None or not len(skeleton):
        return []
    arms = np.asarray(skeleton, float)
    count = legs if legs > 1 else len(names) if len(names) > 1 else 1
    called = [f"leg {k + 1}" for k in range(count)] if legs > 1 else [*names, "robot"][:count]
    return [
        {"name": name, "points": [vectors(arm) for arm in arms[k::count]], "closed": False}
        for k, name in enumerate(called)
    ]


def arcs_and_lines(name: str, table: Table, frame: np.ndarray) -> ViewCurves:
    """The loops of a table of lines and arcs in the xy plane of a frame (4, 4)."""
    loops = []
    for number in np.unique(table["loop"]):
        rows = np.flatnonzero(table["loop"] == number)
        flat = np.concatenate([_segment({key: column[row] for key, column in table.columns.items()}) for row in rows])
        loops.append(flat @ frame[:3, :2].T + frame[:3, 3])
    ends = np.array([[loop[0], loop[-1]] for loop in loops])
    closed = bool((np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1) <= 1e-9 * (1 + np.abs(ends).max())).all())
    return lines(name, said(name), loops, closed)


def _segment(segment: Mapping[str, Any]) -> np.ndarray:
    """Points (N, 2) from the start to the end of a line or an arc."""
    start, end = (np.array([segment[f"x_{at}"], segment[f"y_{at}"]], float) for at in "se")
    if segment["kind"] == "line":
        return np.stack([start, end])
    center, sweep = np.array([segment["x_o"], segment["y_o"]], float), float(segment["sweep"])
    first = np.arctan2(*(start - center)[::-1])
    angles = first + np.linspace(0.0, sweep, 2 + int(abs(sweep) / ARC_STEP))
    return center + float(segment["R"]) * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def add_maps(blobs: Blobs, tables: Mapping[str, Table], base: np.ndarray | None, encoding: Encoding) -> list[FloorMap]:
    """Tables with cells along two lengths, in the plane of the world in which a base (4, 4) stands."""
    found: list[FloorMap] = []
    for name, table in tables.items():
        grid = table.grid
        if grid is None or len(grid.axes) != 2 or any(axis not in ("x_m", "y_m", "z_m") for axis in grid.axes):
            continue
        first, second = ("xyz".index(axis[0]) for axis in grid.axes)
        T = np.eye(4)
        T[:3, 0], T[:3, 1] = np.eye(3)[first], np.eye(3)[second]
        T[:3, 2] = np.cross(T[:3, 0], T[:3, 1])
        normal = 3 - first - second
        T[normal, 3] = 0.0 if base is None else base[normal, 3]
        names = [key for key in _shown(table) if key not in grid.axes]
        names.sort(key=lambda name: name in COORDINATES)  # what is gained first, then where it stands
        turned = ((name, table.units.get(name), _turned(table.columns[name], grid.shape)) for name in names)
        places = (f"map{len(found)}.channel{k}" for k in count())
        channels = [channel(blobs, next(places), "", *each, encoding)[0] for each in turned]
        found.append(
            {
                "name": name,
                "label": said(name),
                "T_world": T.ravel().tolist(),
                "shape": (int(grid.shape[0]), int(grid.shape[1])),
                "cell_m": (float(grid.step[0]), float(grid.step[1])),
                "origin_m": (float(grid.origin[0]), float(grid.origin[1])),
                "channels": channels,
            }
        )
    return found


def _turned(values: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """Cells of a grid, whose last axis is the fastest, so that its first is."""
    return values.reshape(shape).T.ravel()


def histograms(samples: DistributionMap | None, volume: VolumeData | None) -> list[Plot]:
    """How the indices of samples are distributed."""
    plots: list[Plot] = []
    statistics = {} if volume is None else volume.voxels.statistics
    for name, values in {} if samples is None else samples.indices.items():
        known = np.asarray(values, float)
        known = known[np.isfinite(known)]
        if not known.size:
            continue
        assert samples is not None
        counts, edges = np.histogram(known, CLASSES, _span(known))
        unit = samples.units.get(name)
        plot: Plot = {
            "name": f"histogram of {name}",
            "label": said(name),
            "kind": "histogram",
            "x": quantity(name, unit, (edges[1:] + edges[:-1]) / 2),
            "y": [quantity("samples", None, counts)],
        }
        shown = next(
            (statistic for statistic in ("maximum", "mean", *statistics) if name in statistics.get(statistic, {})), None
        )
        if shown is not None:
            plot["channel"] = {"volume": "volume", "name": f"{shown}:{name}"}
        plots.append(plot)
    return plots


def _span(known: np.ndarray) -> tuple[float, float]:
    """The ends of a histogram; of one value alone around it."""
    low, high = float(known.min()), float(known.max())
    room = max(abs(low) * 1e-6, 1e-12)
    return (low, high) if high - low > room else (low - room, high + room)


def convergence(document: Mapping[str, Any]) -> list[Plot]:
    """What has settled over the samples of growing grids, of each robot whose sampling converges."""
    plots: list[Plot] = []
    job = document.get("job") or {}
    entries, asked = (each.get("robots") or [each] for each in (document, job))
    for number, (entry, own) in enumerate(zip(entries, asked, strict=False)):
        grids = entry.get("convergence")
        if not grids:
            continue
        name, sampling = f" of {entry['name']}" if len(entries) > 1 else "", own.get("sampling")
        value, unit = "Global value", None
        if sampling:  # a result may have come without its job
            value = f"{said(sampling['by'])} of {said(sampling['index']).lower()}"
            unit = entry["indices"].get(sampling["index"], {}).get("unit")
        plots.append(
            {
                "name": f"convergence{name}",
                "label": f"Convergence{name}",
                "kind": "curve",
                "x": quantity("samples", None, np.array([grid["samples"] for grid in grids])),
                "y": [quantity(value, unit, np.array([grid["value"] for grid in grids]))],
                "sets": "samples",
                "robot": number,
            }
        )
    return plots


def curve_plots(tables: Mapping[str, Table]) -> list[Plot]:
    """Tables that are drawn as curves over their first column of numbers."""
    plots = []
    for name in CURVES:
        table = tables.get(name)
        numbers = (
            []
            if table is None
            else [key for key, each in table.columns.items() if each.ndim == 1 and each.dtype.kind in "if"]
        )
        shown = [key for key in numbers[1:] if not key.endswith(_BAND)]
        if table is not None and len(table) and shown:
            plot = curve_plot(name, said(name), table, numbers[0], shown)
            if name == SCALES:
                plot["sets"] = "scale"
            plots.append(plot)
    return plots
