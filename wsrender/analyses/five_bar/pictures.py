"""Conditioning, loci and aspects of a five-bar, one panel for each working mode (after figures 15 and 16 of [CB])."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path
from matplotlib.ticker import MaxNLocator, MultipleLocator

from wsrender.analyses.five_bar.presentation import MODE_VOLUMES
from wsrender.errors import InputError
from wsrender.results.drawing.result_plots import ResultPlots
from wsrender.results.drawing.style import INK, Heading, color_map, new_figure, paper_style, quantity
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData

MATRICES = "abj"
SPACES = ("cartesian", "joint")
"""Names of the volumes in a result."""
_TICKS = (1.0, 1.25, 1.5, 2.0, 3.0, 5.0, 10.0)
_RED, _BLUE = "#c8102e", "#1f4fd8"
_STYLES = {  # of loci: colour, width, dashes, label
    "type_1": (INK, 1.6, "-", "type 1 singularity (boundary)"),
    "joint_limit": (INK, 1.2, (0, (1, 1.2)), "joint limit"),
    "type_2": (_RED, 1.6, "-", "type 2 singularity"),
    "least_kappa_a": (_BLUE, 1.4, (0, (5, 2)), "least κ(A): distal links at right angles"),
    "isotropic_b": (_BLUE, 1.4, (0, (5, 2)), "κ(B) = 1"),
    "isotropic_j": (_BLUE, 0.0, "", "κ(J) = 1"),
}
_ASSEMBLY = {"+": "#a6cee3", "-": "#fdcf8b"}  # of assembly modes
_DRAWN = {"a": ("least_kappa_a",), "b": ("isotropic_b",), "j": ("isotropic_j",)}
_EVERYWHERE = ("type_1", "joint_limit", "type_2")


@paper_style()
def conditioning_maps(
    volumes: Mapping[str, VolumeData],
    tables: Mapping[str, Table],
    matrix: str,
    space: str,
    *,
    title: Heading | str = "",
) -> Figure:
    """κ of A, B or J (``matrix``) over P ("cartesian") or the actuated angles ("joint"), with iso-curves and loci.

    ``volumes`` holds the Cartesian map of each working mode by its signs, ``tables`` those of a five-bar's result. In
    joint space a working mode has a sheet for each assembly mode. Raises InputError for another matrix or space.
    """
    for field, value, allowed in (("matrix", matrix, MATRICES), ("space", space, SPACES)):
        if value not in tuple(allowed):
            raise InputError(field, f"{value!r} is not allowed; {', '.join(allowed)} are")
    modes = list(tables["drawn_postures"]["working_mode"])
    if space == "cartesian":
        figure, drawn = _cartesian_panels(tables, modes, title)
        for mode, axes in zip(modes, drawn, strict=True):
            if mode in volumes:
                _draw_volume(axes, volumes[mode], f"inverse_kappa_{matrix}")
            _draw_curves(axes, tables, matrix, mode, "position")
            _draw_mechanism(axes, tables["drawn_postures"], mode)
    else:
        figure, panels = _joint_panels(tables, modes, title)
        for (mode, assembly), axes in panels.items():
            _draw_sheet(axes, tables["joint_space"], matrix, mode, assembly)
            _draw_curves(axes, tables, matrix, mode, "theta", assembly)
        drawn = list(panels.values())
    _add_bar(figure, drawn, matrix)
    levels = tables["iso_curves"]["level"][tables["iso_curves"]["quantity"] == f"kappa_{matrix}"]
    _add_legend(figure, tables["loci"], (*_EVERYWHERE, *_DRAWN[matrix]), np.unique(levels))
    return figure


@paper_style()
def aspect_maps(tables: Mapping[str, Table], *, title: Heading | str = "") -> Figure:
    """The aspects of each working mode in the colours of their assembly modes, with their areas; loci and mechanism."""
    modes = list(tables["drawn_postures"]["working_mode"])
    figure, panels = _cartesian_panels(tables, modes, title, beside=1.2)
    outlines = tables["aspect_outlines"]
    for mode, axes in zip(modes, panels, strict=True):
        areas = []
        for number in np.unique(outlines["aspect"][outlines["working_mode"] == mode]):
            rows = np.flatnonzero(outlines["aspect"] == number)
            color = _ASSEMBLY[str(outlines["assembly_mode"][rows[0]])]
            axes.add_patch(PathPatch(_path(outlines, rows), facecolor=color, linewidth=0, zorder=2))
            areas.append(Patch(facecolor=color, label=f"{outlines['area'][rows[0]]:.5g} m²"))
        _draw_loci(axes, tables["loci"], mode, _EVERYWHERE, "position")
        _draw_mechanism(axes, tables["drawn_postures"], mode)
        place: dict[str, Any] = {"loc": "upper left", "bbox_to_anchor": (1.0, 1.0)}
        axes.legend(handles=areas[:8], title="areas", fontsize=7, frameon=False, handlelength=1, **place).set_zorder(9)
    present = set(outlines["assembly_mode"].tolist())
    modes_of_assembly = [
        Patch(facecolor=color, label=f"assembly mode {_signs(sign)}")
        for sign, color in _ASSEMBLY.items()
        if sign in present
    ]
    _add_legend(figure, tables["loci"], _EVERYWHERE, np.empty(0), modes_of_assembly)
    return figure


def _path(outlines: Table, rows: np.ndarray) -> Path:
    """Outline and holes as one path."""
    vertices, codes = [], []
    for loop in np.unique(outlines["loop"][rows]):
        line = outlines["position"][rows[outlines["loop"][rows] == loop]]
        vertices.append(np.concatenate([line, line[:1]]))
        codes += [Path.MOVETO, *[Path.LINETO] * (len(line) - 1), Path.CLOSEPOLY]
    return Path(np.concatenate(vertices), codes)


def _cartesian_panels(
    tables: Mapping[str, Table], modes: Sequence[str], heading: Heading | str, beside: float = 0.0
) -> tuple[Figure, list[Axes]]:
    """A panel for each mode with equal scales, large enough for workspace and mechanism, and ``beside`` [in]."""
    chains = tables["drawn_postures"]["chain"].reshape(-1, 2)
    shown = np.concatenate([tables["loci"]["position"], chains[~np.isnan(chains).any(axis=1)], np.zeros((1, 2))])
    lower, upper = shown.min(axis=0), shown.max(axis=0)
    margin = 0.04 * max((upper - lower).max(), 1e-9)
    width, height = upper - lower + 2 * margin
    columns = 2 if len(modes) > 1 else 1
    rows = -(-len(modes) // columns)
    scale = 3.6 / max(width, height)
    figure = new_figure(
        columns * (width * scale + 0.9 + beside) + (0.3 if beside else 1.2),
        rows * (height * scale + 0.7) + 0.7,
        heading,
    )
    panels = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
    for axes in panels.flat[len(modes) :]:
        axes.set_visible(False)
    for mode, axes in zip(modes, panels.flat, strict=False):
        axes.set_aspect("equal")
        axes.set_xlim(lower[0] - margin, upper[0] + margin)
        axes.set_ylim(lower[1] - margin, upper[1] + margin)
        axes.xaxis.set_major_locator(MaxNLocator(6))
        axes.yaxis.set_major_locator(MaxNLocator(6))
        axes.set_xlabel(quantity("x", "m"))
        axes.set_ylabel(quantity("y", "m"))
        axes.tick_params(labelbottom=True, labelleft=True)
        axes.set_title(f"working mode {_signs(mode)}")
    return figure, list(panels.flat[: len(modes)])


def _joint_panels(
    tables: Mapping[str, Table], modes: Sequence[str], heading: Heading | str
) -> tuple[Figure, dict[tuple[str, str], Axes]]:
    """A row of panels for each assembly mode, a column for each working mode."""
    theta = tables["joint_space"]["theta"]
    lower, upper = (theta.min(axis=0), theta.max(axis=0)) if len(theta) else (np.full(2, -np.pi), np.full(2, np.pi))
    cells = np.maximum(tables["joint_space"]["cell"].max(axis=0, initial=0), 1)
    lower, upper = lower - (upper - lower) / cells / 2, upper + (upper - lower) / cells / 2
    figure = new_figure(2.5 * len(modes) + 1.6, 5.9, heading)
    grid = figure.subplots(2, len(modes), squeeze=False, sharex=True, sharey=True)
    panels = {}
    for row, assembly in enumerate("+-"):
        for column, mode in enumerate(modes):
            axes = panels[mode, assembly] = grid[row][column]
            axes.set_xlim(lower[0], upper[0])
            axes.set_ylim(lower[1], upper[1])
            for axis, span in ((axes.xaxis, upper[0] - lower[0]), (axes.yaxis, upper[1] - lower[1])):
                turn = np.pi / 2 if span > 4 else np.pi / 4
                axis.set_major_locator(MultipleLocator(turn) if span > 1.6 else MaxNLocator(4))
                axis.set_major_formatter(lambda value, _: f"{value:.2f}".replace("-", "−"))
            axes.set_title(f"working {_signs(mode)}, assembly {_signs(assembly)}", fontsize=8.5)
            if row == 1:
                axes.set_xlabel("θ1 [rad]")
            if column == 0:
                axes.set_ylabel("θ2 [rad]")
    return figure, panels


def _signs(mode: str) -> str:
    return mode.replace("-", "−")


def _draw_volume(axes: Axes, volume: VolumeData, name: str) -> None:
    values = np.ma.masked_invalid(volume.statistics["value"][name][:, :, 0])
    low = volume.origin_m[:2]
    high = low + np.array(values.shape) * volume.voxel_size_m
    _image(axes, values, (low[0], high[0], low[1], high[1]))


def _draw_sheet(axes: Axes, joint_space: Table, matrix: str, mode: str, assembly: str) -> None:
    cell, theta = joint_space["cell"], joint_space["theta"]
    rows = np.flatnonzero((joint_space["working_mode"] == mode) & (joint_space["assembly_mode"] == assembly))
    if not len(rows):
        axes.text(0.5, 0.5, "no posture", transform=axes.transAxes, ha="center", va="center", color=INK, fontsize=8)
        return
    shape = cell.max(axis=0) + 1
    values = np.full(shape, np.nan)
    values[tuple(cell[rows].T)] = joint_space[f"inverse_kappa_{matrix}"][rows]
    corners = [_edges(theta[:, k], cell[:, k]) for k in (0, 1)]
    _image(axes, np.ma.masked_invalid(values), (*corners[0], *corners[1]))


def _edges(angles: np.ndarray, cells: np.ndarray) -> tuple[float, float]:
    """Where the first cell begins and the last of those that occur ends."""
    first, last = int(np.argmin(cells)), int(np.argmax(cells))
    step = (angles[last] - angles[first]) / max(int(cells[last] - cells[first]), 1)
    return float(angles[first] - step * (cells[first] + 0.5)), float(angles[last] + step / 2)


def _image(axes: Axes, values: np.ndarray, extent: tuple[float, float, float, float]) -> None:
    norm = Normalize(0.0, 1.0)
    axes.imshow(
        values.T,
        origin="lower",
        extent=extent,
        cmap=color_map(),
        norm=norm,
        interpolation="nearest",
        zorder=1,
        aspect=axes.get_aspect(),
    )


def _draw_curves(
    axes: Axes, tables: Mapping[str, Table], matrix: str, mode: str, space: str, assembly: str | None = None
) -> None:
    """Iso-curves and loci of a mode in one of the columns ``position`` and ``theta``."""
    iso = tables["iso_curves"]
    rows = (iso["working_mode"] == mode) & (iso["quantity"] == f"kappa_{matrix}")
    for at in _runs(iso, np.flatnonzero(rows & _on_sheet(iso, assembly)), space):
        axes.plot(*at.T, color="white", lw=0.7, zorder=3)
    _draw_loci(axes, tables["loci"], mode, (*_EVERYWHERE, *_DRAWN[matrix]), space, assembly)


def _draw_loci(
    axes: Axes, loci: Table, mode: str, kinds: Sequence[str], space: str, assembly: str | None = None
) -> None:
    for kind in kinds:
        color, width, dashes, _ = _STYLES[kind]
        rows = (loci["working_mode"] == mode) & (loci["kind"] == kind)
        if kind != "type_2":  # which both sheets have
            rows &= _on_sheet(loci, assembly)
        if kind == "isotropic_j":
            at = loci[space][rows]
            axes.plot(*at.T, ls="", marker="*", ms=9, mfc=color, mec="white", mew=0.6, zorder=5)
            continue
        for at in _runs(loci, np.flatnonzero(rows), space):
            axes.plot(*at.T, color=color, lw=width, ls=dashes, solid_capstyle="round", zorder=4)


def _on_sheet(table: Table, assembly: str | None) -> np.ndarray:
    """Whether a vertex is in an assembly mode, or on the border of both; all are where none is asked for."""
    if assembly is None:
        return np.ones(len(table), bool)
    side = table["assembly"]
    return side >= 0 if assembly == "+" else side <= 0


def _runs(table: Table, rows: np.ndarray, space: str) -> list[np.ndarray]:
    """The vertices of chosen rows as polylines: cut where a curve ends, where rows are left out, where angles wrap."""
    if not len(rows):
        return []
    points, curve = table[space][rows], table["curve"][rows]
    cut = (np.diff(curve) != 0) | (np.diff(rows) != 1)
    if space == "theta":
        cut |= np.abs(np.diff(points, axis=0)).max(axis=1) > np.pi
    return np.split(points, np.flatnonzero(cut) + 1)


def _draw_mechanism(axes: Axes, drawn: Table, mode: str) -> None:
    chain = drawn["chain"][drawn["working_mode"] == mode].reshape(5, 2)
    if np.isnan(chain).any():
        axes.text(0.5, 0.5, "nothing is reached", transform=axes.transAxes, ha="center", va="center", color=INK)
        return
    axes.plot(*chain.T, color="white", lw=4.4, solid_capstyle="round", solid_joinstyle="round", zorder=6)
    axes.plot(*chain.T, color=INK, lw=2.2, solid_capstyle="round", solid_joinstyle="round", zorder=7)
    axes.plot(*chain[1:4].T, ls="", marker="o", ms=5, mfc="white", mec=INK, mew=1.2, zorder=8)
    axes.plot(*chain[[0, 4]].T, ls="", marker="s", ms=6, mfc=INK, mec="white", zorder=8)
    for name, (x, y) in zip("ACPDB", chain, strict=True):
        axes.annotate(
            name,
            (x, y),
            xytext=(-12, 4) if name == "A" else (5, 4),  # B may be near it
            textcoords="offset points",
            fontsize=8,
            color=INK,
            zorder=9,
            bbox={"boxstyle": "round,pad=0.1", "facecolor": "white", "edgecolor": "none", "alpha": 0.7},
        )


def _add_bar(figure: Figure, axes: list[Axes], matrix: str) -> None:
    """Colours are even in 1/κ, which is bounded; the ticks say κ."""
    bar = figure.colorbar(ScalarMappable(Normalize(0.0, 1.0), color_map()), ax=axes, shrink=0.85, aspect=32, pad=0.02)
    bar.set_ticks([0.0, *(1 / kappa for kappa in _TICKS)], labels=["∞", *(f"{kappa:g}" for kappa in _TICKS)])
    bar.set_label(f"Condition number κ({matrix.upper()})")
    bar.outline.set_visible(False)


def _add_legend(
    figure: Figure, loci: Table, kinds: Sequence[str], levels: np.ndarray, first: Sequence[Artist] = ()
) -> None:
    present = set(loci["kind"])
    handles = list(first)
    for kind in (kind for kind in kinds if kind in present):
        color, width, dashes, label = _STYLES[kind]
        if kind == "isotropic_j":
            handles.append(Line2D([], [], ls="", marker="*", ms=9, mfc=color, mec="white", label=label))
        else:
            handles.append(Line2D([], [], color=color, lw=width, ls=dashes, label=label))
    if len(levels):
        label = f"κ = {', '.join(f'{float(level):g}' for level in levels)}"
        handles.append(Line2D([], [], color="#bbbbbb", lw=1.0, label=label))
    figure.legend(handles=handles, loc="outside lower center", ncols=min(len(handles), 4), frameon=False, fontsize=8)


def conditioning(plot: ResultPlots, matrix: str = "j", space: str = "cartesian") -> Figure:
    """κ of a five-bar's Jacobian A, B or J ("a", "b", "j") over P ("cartesian") or θ1 and θ2 ("joint")."""
    volumes = {mode: plot.volumes[name] for mode, name in MODE_VOLUMES.items() if name in plot.volumes}
    return conditioning_maps(volumes, _tables(plot), matrix, space, title=plot.heading("other"))


def aspects(plot: ResultPlots) -> Figure:
    """Singularity-free aspects of a five-bar with their areas, one panel for each working mode."""
    return aspect_maps(_tables(plot), title=plot.heading("other"))


def _tables(plot: ResultPlots) -> Mapping[str, Table]:
    if "aspect_outlines" not in plot.tables:
        raise InputError("tables", "the result is not one of a five-bar")
    return plot.tables
