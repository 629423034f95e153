"""The result of an analysis: a document, the data behind it, its files and pictures."""

import warnings
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from wsrender.documents.format import FORMAT
from wsrender.errors import InputError, MissingExtraError, RenderError, RenderWarning
from wsrender.keywords import keywords
from wsrender.notebook import mime_bundle
from wsrender.results import conversion, drawing, render
from wsrender.results.export.artifacts import (
    DOCUMENT,
    NAMED_PARTS,
    PARTS,
    Artifact,
    named_files,
    part_file,
    publish,
    read_document,
    verified_artifacts,
    write_artifacts,
    write_document,
)
from wsrender.results.export.atomic import new_file, staging_folder
from wsrender.results.export.cells import cell_names, cell_units, vector_names
from wsrender.results.export.columns import columns_of
from wsrender.results.export.formats import by_ending, check_asked, kept, written
from wsrender.results.export.result_format import current_document
from wsrender.results.export.text import sampling_text, summary_text
from wsrender.results.presentation import presentation_of
from wsrender.results.report import ShownPicture, report_page
from wsrender.results.report.entries import label
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData

if TYPE_CHECKING:
    import pandas
    import pyvista
    import trimesh
    import xarray
    from matplotlib.figure import Figure

    from wsrender.results.drawing.faces import Faces
    from wsrender.results.drawing.result_plots import ResultPlots

REPORT_VIEWS = ("boundary", "isosurface")
VIEW_CAPTIONS = {"boundary": "Boundary of the workspace", "isosurface": "Voxels of at least 0.9 of the maximum"}


@keywords
@dataclass(eq=False)
class Result:
    """What an analysis returns, locally and from a server alike.

    ``document`` is the result document, a plain dict. ``map`` has one row per sample where it was kept
    (for ``indices_at``: one per configuration, in the order asked); ``sample`` is the fixed subsample that
    pictures use. ``skeleton`` (K, L+2, 3) holds world positions [m] of base, joint origins and tip at K
    representative configurations. ``meshes`` [m, world frame], ``tables`` and ``volumes`` hold what else the analysis
    gives, by name: a result without meshes is saved with the ``surface`` of its voxels.
    """

    document: dict[str, Any]
    map: DistributionMap | None = None
    sample: DistributionMap | None = None
    volume: VolumeData | None = None
    skeleton: np.ndarray | None = None
    meshes: "dict[str, trimesh.Trimesh]" = field(default_factory=dict)
    tables: dict[str, Table] = field(default_factory=dict)
    volumes: dict[str, VolumeData] = field(default_factory=dict)

    def __repr__(self) -> str:
        return f"<Result {self.document.get('analysis')}: {sampling_text(self.document)}>"

    @property
    def global_indices(self) -> dict[str, Any]:
        """Global indices: those of the robot, and ``joint_mean`` and ``workspace_mean`` by index."""
        means = {
            mean: {name: values[mean] for name, values in self.document.get("indices", {}).items() if mean in values}
            for mean in ("joint_mean", "workspace_mean")
        }
        return {**self.document.get("global", {}), **means}

    @property
    def plot(self) -> "ResultPlots":
        """Pictures as matplotlib Figures, such as ``plot.slice(z=0.3)`` or ``plot.scatter(index)``."""
        title, arms = sampling_text(self.document), len(self.document.get("robots") or ()) or self._legs
        held = (*self._drawable(), self.tables, self.volumes, self.meshes)
        return drawing.ResultPlots(self.document, title, *held, arms, self._bodies)

    def _bodies(self) -> "list[Faces | None]":
        """What is seen of the robot in each row of the skeleton."""
        from wsrender.results.view.shown_bodies import bodies_shown

        samples, _, skeleton = self._drawable()
        return [] if skeleton is None else bodies_shown(self.document, self.tables, samples, skeleton)

    @property
    def _warnings(self) -> list[dict[str, Any]]:
        """Those of the document; a result of an earlier version has none."""
        return self.document.get("warnings") or []

    @property
    def _legs(self) -> int:
        """How many skeletons make one figure: the legs of a mechanism, or one arm."""
        return len((self.document.get("mechanism") or {}).get("legs") or [None])

    def render(
        self,
        view: str = "boundary",
        path: "str | Path | None" = None,
        *,
        others: "Iterable[Result]" = (),
        robot: Any = None,
        configuration: Any = None,
        title: str | None = None,
        **options: Any,
    ) -> "Figure":
        """A 3-D picture of the workspace with its arm, as a matplotlib Figure.

        It is written to ``path`` if given, in the format of its ending.
        ``view``: boundary, solid, scatter, volume, slice or isosurface; ``others``: results drawn in the same box.
        ``robot``, one of the result, adds the bodies of its links, if its model has any, at ``configuration`` [rad or
        m]; given by name or file it stands as in the result.
        ``options``: index, statistic, threshold (of the iso-surface, share of the maximum), alpha, at (x, y, z of the
        slices [m]), environment (an `Environment`, or a list of its shapes and of ``wsrender.results.render`` Floor,
        Table, Box), azimuth_deg and elevation_deg of the eye. Needs the extra ``render``. Raises InputError,
        MissingExtraError; RenderError where VTK cannot draw.
        """
        results = [self, *others]
        subjects = [each for name, result in named_results(results).items() for each in result._subjects(name)]
        if robot is not None:
            k, own = render.own_robot(robot, self._robot_entries())
            k = min(k, len(self._subjects("")) - 1)  # several arms may share one volume
            subjects[k] = subjects[k].with_robot(own, configuration, self.document.get("sampling") or {})
        names = " + ".join(subject.name for subject in subjects)
        title = title or (sampling_text(self.document) if len(results) == 1 else names)
        warned = [warning for result in results for warning in result._warnings]
        shared = self.meshes.get("intersection") if len(results) == 1 and len(subjects) > 1 else None
        figure = render.picture(
            subjects, view, title=drawing.heading(title, warned, "volume"), shared=shared, **options
        )
        if path is not None:
            by_ending("picture", path).write(figure, path)
        return figure

    def view(self, port: int = 0, block: bool | None = None) -> Any:
        """Show the result in the viewer: in a notebook as a widget, else in a tab of the browser (a `LocalView`).

        ``block``: return when the program is told to stop (Ctrl-C); by default in a script, not at a prompt. Raises
        InputError for a port in use, MissingExtraError in a notebook without the extra ``notebook``.
        """
        from wsrender.window import show

        return show(self, port, block)

    _repr_mimebundle_ = mime_bundle

    def _robot_entries(self) -> list[dict[str, Any]]:
        """What the document says of each robot that a picture shows. Raises InputError for a mechanism."""
        if mechanism := self.document.get("mechanism"):
            raise InputError("robot", f"the result is of the mechanism {mechanism.get('name')}, of no single arm")
        robots = [each.get("robot", each) for each in self.document.get("robots") or ()]
        return robots or [self.document.get("robot") or {}]

    def _subjects(self, name: str) -> "list[render.Subject]":
        """What a 3-D picture shows of the result: its robot, or each of several with its own volume."""
        robots = {key.removeprefix("robot_"): data for key, data in self.volumes.items() if key.startswith("robot_")}
        if not robots:
            mesh = self.meshes.get("workspace") if self.volume is None else None
            faces = None if mesh is None else drawing.faces_of(mesh, self.tables.get("surfaces"))
            return [render.Subject(name, *self._drawable(), faces=faces, legs=self._legs)]
        arms = [None] * len(robots) if self.skeleton is None else [arm[None] for arm in self.skeleton]
        return [
            render.Subject(key, volume=volume, skeleton=arm)
            for (key, volume), arm in zip(robots.items(), arms, strict=True)
        ]

    def _drawable(self) -> tuple[DistributionMap | None, VolumeData | None, np.ndarray | None]:
        samples = self.sample if self.sample is not None else self.map
        return samples if samples is not None and len(samples) else None, self.volume, self.skeleton

    def report(self, path: str | Path, views: Iterable[str] = REPORT_VIEWS) -> None:
        """Write one HTML page with the viewer, pictures, tables, provenance and the job document; it needs no network.

        The viewer adds at most 2 MB: channels in half precision, and those that do not fit are named.

        ``views`` are the 3-D pictures, of those of ``render``; without the extra ``render`` or OpenGL they are left
        out, with a RenderWarning and a note in the page. Raises InputError for an unknown view.
        """
        plot = self.plot
        pictures = [ShownPicture(row.name, drawing.png(row.drawn(plot)), row.caption) for row in plot.pictures]
        notes = []
        has_volume = any(each.volume is not None and each.volume.n_occupied for each in self._subjects(""))
        for view in views if has_volume else ():
            try:
                pictures.append(ShownPicture(view, drawing.png(self.render(view)), VIEW_CAPTIONS.get(view, "")))
            except (MissingExtraError, RenderError) as error:
                notes.append(f"3-D pictures are left out: {error}")
                warnings.warn(notes[-1], RenderWarning, stacklevel=2)
                break
        from wsrender.results.view import view_of

        title = f"{sampling_text(self.document)} · {label(str(self.document.get('analysis', 'result')))}"
        page = report_page(title, self.document, pictures, self.tables, notes, view_of(self))
        with new_file(path) as temporary:
            temporary.write_text(page, encoding="utf-8")

    def summary(self) -> str:
        """The main numbers as a few lines of text."""
        return summary_text(self.document)

    def to_pandas(self, name: str | None = None) -> "pandas.DataFrame":
        """A table, or the map, as a DataFrame, with units in its ``attrs["units"]``.

        ``name``: of a table, "map" or "sample"; by default the map, else the first table, else the sample. Raises
        InputError for one that the result does not hold, MissingExtraError without the extra ``data``.
        """
        held = {"map": self.map, **self.tables, "sample": self.sample}
        found = conversion.one_of("table", {key: data for key, data in held.items() if data is not None}, name)
        return conversion.data_frame(found, self.document)

    def to_xarray(self, name: str | None = None) -> "xarray.Dataset":
        """The voxels, or a table that is a map of cells, as a Dataset with labelled axes and units in their ``attrs``.

        ``name``: of a further volume or of such a table; by default the volume, else the first. Empty voxels are NaN,
        of whole numbers 0. Raises InputError for one that the result does not hold, MissingExtraError without the
        extra ``data``.
        """
        maps = {key: table for key, table in self.tables.items() if table.grid}
        found = conversion.one_of("volume or map", {**self._all_volumes, **maps}, name)
        return conversion.dataset(found, self.document)

    def to_pyvista(self, name: str | None = None) -> "pyvista.DataSet":
        """The voxels as an ImageData, a mesh as a PolyData [m, world frame]; units in its ``user_dict["units"]``.

        ``name``: of a further volume or of a mesh; by default the volume, else the first of them. Raises InputError for
        one that the result does not hold, MissingExtraError without the extra ``render``.
        """
        found = conversion.one_of("volume or mesh", {**self._all_volumes, **self._all_meshes}, name)
        made: Any = conversion.image_data if isinstance(found, VolumeData) else conversion.poly_data
        return made(found, self.document)

    def to_trimesh(self, name: str | None = None) -> "trimesh.Trimesh":
        """A mesh [m, world frame], by default the first; of a result without meshes the ``surface`` of its voxels.

        Raises InputError for one that the result does not hold.
        """
        mesh = conversion.one_of("mesh", self._all_meshes, name).copy()
        mesh.units = "m"
        return mesh

    @property
    def _all_volumes(self) -> dict[str, VolumeData]:
        volumes = {"volume": self.volume, **self.volumes}
        return {key: volume for key, volume in volumes.items() if volume is not None}

    @property
    def _all_meshes(self) -> "dict[str, trimesh.Trimesh]":
        return _meshes(self)

    def save(self, folder: str | Path, formats: Iterable[str] = ()) -> None:
        """Write document, data, meshes and pictures to a folder, and list them in ``document["artifacts"]``.

        Always written, as far as the result holds the data: ``result.json``, ``map.parquet``,
        ``sample.parquet``, ``volume.vtkhdf``, ``skeleton.npy``, ``<name>.parquet`` of each table, ``<name>.vtkhdf``
        of each further volume, ``<name>.ply`` and ``<name>.glb`` (+Y up, as glTF has it) of each mesh, and
        ``plots/*.png`` with ``plots/histogram.csv``. ``formats`` adds others by their suffixes: those of the table
        in ``wsrender.results.export.formats`` and of ``register_format``. A result that was in the folder before is
        replaced, other files stay; if writing fails nothing changes.

        Raises InputError for an unknown format or a folder that is a file.
        """
        formats = check_asked(formats)
        with staging_folder(folder) as staging:
            records = write_artifacts(_artifacts(self, formats), staging)
            document = write_document({"format": FORMAT, **self.document, "artifacts": records}, staging / DOCUMENT)
            publish(staging, Path(folder).absolute())
        self.document = document

    @classmethod
    def load(cls, folder: str | Path) -> "Result":
        """Restore what ``save`` wrote, this version's or an earlier one's.

        Raises InputError, naming the file, where one that the document lists is missing or has changed; and for a
        ``format`` of the document that this version does not know.
        """
        folder = Path(folder)
        document = current_document(read_document(folder))
        return cls.of_files(document, verified_artifacts(document, folder))

    @classmethod
    def of_files(cls, document: dict[str, Any], files: Mapping[str, Path]) -> "Result":
        """The result of a document in today's form, as far as its ``files`` by name are there."""
        parts: dict[str, Any] = {part: _restored(kind, files.get(part_file(part))) for part, kind in PARTS.items()}
        for part, kind in NAMED_PARTS.items():
            parts[part] = {name: _restored(kind, files[file]) for name, file in named_files(part, files).items()}
        return cls(document, **parts)


def files_of_parts(words: Iterable[str], names: Collection[str]) -> list[str]:
    """Of the files ``names`` of a result those that hold parts in the words of `Picture`."""
    found: dict[str, None] = {}
    for word in words:
        choices = (_files_of_part(each, names) for each in word.split("|"))
        found |= dict.fromkeys(next(filter(None, choices), []))
    return list(found)


def _files_of_part(word: str, names: Collection[str]) -> list[str]:
    """Samples are the whole map only where there is no sample of it."""
    part, _, name = word.partition(".")
    if part in NAMED_PARTS:
        return [file for key, file in named_files(part, names).items() if name in ("", key)]
    files = [part_file(each) for each in (("sample", "map") if part == "samples" else (part,))]
    return [file for file in files if file in names][:1]


def named_results(results: Iterable[Result]) -> dict[str, Result]:
    """Results by the names of their robots, numbered where several have the same."""
    results = list(results)
    about = [result.document.get("robot") or result.document.get("mechanism") or {} for result in results]
    names = [str(each.get("name", "robot")) for each in about]
    return {
        f"{name} {names[: k + 1].count(name)}" if names.count(name) > 1 else name: result
        for k, (name, result) in enumerate(zip(names, results, strict=True))
    }


def _restored(kind: str, path: Path | None) -> Any:
    """What the file of a part holds, None where there is none."""
    return None if path is None else kept(kind).read(path)


def _meshes(result: Result) -> "dict[str, trimesh.Trimesh]":
    """The result's meshes; where it has none, the surface of its occupied voxels."""
    if result.meshes or result.volume is None or not result.volume.n_occupied:
        return result.meshes
    from wsrender.geometry.surfaces import occupied_surface

    return {"surface": occupied_surface(result.volume)}


def _artifacts(result: Result, formats: tuple[str, ...]) -> Iterator[Artifact]:
    """Every file of a result but its document; pictures are made when their turn comes."""
    for name, data in {"map": result.map, "sample": result.sample, **result.tables}.items():
        if data is not None:
            yield from _table_files(name, data, formats)
    for name in presentation_of(result.document).drawings:
        if (lines := result.tables.get(name)) is not None:
            yield from _files("drawing", name, lines, formats, (len(lines),), {"coordinates": "m"}, "plane")
    for name, volume in {"volume": result.volume, **result.volumes}.items():
        if volume is not None:
            yield from _volume_files(name, volume, formats)
    for name, mesh in _meshes(result).items():
        yield from _files("mesh", name, mesh, formats, mesh.vertices.shape, {"vertices": "m"})
    if result.skeleton is not None:
        skeleton = np.asarray(result.skeleton)
        yield from _files("skeleton", "skeleton", skeleton, formats, skeleton.shape, {"skeleton": "m"})
    yield from _picture_files(result, formats)


def _files(
    kind: str,
    name: str,
    data: Any,
    formats: tuple[str, ...],
    shape: tuple[int, ...] | None = None,
    units: dict[str, str] | None = None,
    frame: str | None = "world",
) -> Iterator[Artifact]:
    """The files of one thing: in the formats of its kind that are always written, and in those asked for."""
    for row in written(kind, formats):
        yield Artifact(row.file(name), partial(row.write, data), shape, units or {}, row.frame or frame)


def _table_files(name: str, data: DistributionMap | Table, formats: tuple[str, ...]) -> Iterator[Artifact]:
    units = columns_of(data).column_units()
    frame = "world" if isinstance(data, DistributionMap) else None
    if isinstance(data, Table) and data.grid:
        frame, formats = data.grid.frame, tuple({*formats, "npz"})
    yield from _files("table", name, data, formats, (len(data), len(units)), units, frame)
    if isinstance(data, Table) and data.grid and len(data.grid.axes) <= 3:
        # In a folder: it is no part that a result is loaded from.
        yield Artifact(f"maps/{name}.vtkhdf", partial(_write_cells, data), data.grid.shape, units, frame)


def _write_cells(data: Table, path: Path) -> None:
    from wsrender.results.export.vtkhdf import write_cells_vtkhdf

    write_cells_vtkhdf(data, path)


def _volume_files(name: str, volume: VolumeData, formats: tuple[str, ...]) -> Iterator[Artifact]:
    taken = {"count"}
    units = cell_units(volume, cell_names(volume, taken), vector_names(volume, taken))
    return _files("volume", name, volume, formats, volume.shape, units)


def _picture_files(result: Result, formats: tuple[str, ...]) -> Iterator[Artifact]:
    """Each picture that the result has data for, and the numbers of the histogram."""
    plot = result.plot
    if plot.samples is not None and plot.samples.indices:
        write = partial(drawing.write_histogram_csv, plot.samples)
        yield Artifact("plots/histogram.csv", write, frame=None)
    for row in plot.pictures:
        figure = row.drawn(plot)
        yield from _files("picture", f"plots/{row.name}", figure, formats)
        figure.clear()  # figures are circles of references: their images would stay until a collector comes for them
