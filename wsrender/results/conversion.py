"""Results as objects of other libraries: pandas, xarray, PyVista and trimesh, with their names, units and frames."""

from collections.abc import Mapping, Sequence
from importlib import import_module
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from wsrender.errors import InputError, MissingExtraError
from wsrender.results.export.cells import cell_arrays, cell_names, cell_units, vector_names
from wsrender.results.export.columns import arrays_by_column, columns_of
from wsrender.results.export.headline import headline_lines
from wsrender.results.export.text import sampling_text
from wsrender.results.view.words import said
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData

if TYPE_CHECKING:
    import pandas
    import pyvista
    import trimesh
    import xarray

AXES = ("x", "y", "z")
VECTOR = "component"  # the axis of a vector's parts
TAKEN = ("count", *AXES, VECTOR)  # names that no index's array has


def data_frame(data: DistributionMap | Table, document: Mapping[str, Any]) -> "pandas.DataFrame":
    """The columns as in the Parquet files; ``attrs["units"]`` has the unit of each, "1" where it has none."""
    pandas, columns = required("pandas", "data"), columns_of(data)
    frame = pandas.DataFrame(arrays_by_column(data, columns))
    place = "world" if isinstance(data, DistributionMap) else data.grid.frame if data.grid else None
    frame.attrs = _about(document, place) | {"units": columns.column_units()}
    return frame


def dataset(data: VolumeData | Table, document: Mapping[str, Any]) -> "xarray.Dataset":
    """A volume, or a table of cells, as labelled arrays; each, and each axis, has ``units`` and a ``long_name``."""
    return _dataset_of_cells(data, document) if isinstance(data, Table) else _dataset_of_voxels(data, document)


def _dataset_of_voxels(volume: VolumeData, document: Mapping[str, Any]) -> "xarray.Dataset":
    taken = {*TAKEN}
    names, vectors = cell_names(volume, taken), vector_names(volume, taken)
    units = cell_units(volume, names, vectors)
    words = {name: key for key, name in names.items()} | {name: (key,) for key, name in vectors.items()}
    arrays = {
        name: VoxelArray(values, units[name], words.get(name, ("samples",)))
        for name, values in cell_arrays(volume, names, vectors)
    }
    return voxel_dataset(arrays, [volume.centers(k) for k in range(3)], float(volume.voxel_size_m), document)


class VoxelArray(NamedTuple):
    """Values of voxels, (nx, ny, nz) or (nx, ny, nz, 3) along the axes of the world; their unit, and words for them."""

    values: Any
    unit: str
    words: tuple[str, ...]


def voxel_dataset(
    arrays: Mapping[str, VoxelArray], centers: Sequence[np.ndarray], voxel_size_m: float, document: Mapping[str, Any]
) -> "xarray.Dataset":
    """Arrays over the centres of the voxels x, y, z [m]; values may be what xarray reads later."""
    xarray, variables = required("xarray", "data"), {}
    for name, (values, unit, words) in arrays.items():
        axes = (*AXES, VECTOR) if values.ndim == 4 else AXES
        variables[name] = (axes, values, {"units": unit, "long_name": said(*words)})
    coordinates: dict[str, Any] = {name: _axis(name, along, "m") for name, along in zip(AXES, centers, strict=True)}
    if any(values.ndim == 4 for values, _, _ in arrays.values()):
        coordinates[VECTOR] = (VECTOR, list(AXES), {"long_name": "Component along the axes of the world"})
    return xarray.Dataset(variables, coordinates, _about(document, "world") | {"voxel_size_m": voxel_size_m})


def _dataset_of_cells(table: Table, document: Mapping[str, Any]) -> "xarray.Dataset":
    """A table whose rows are cells, as arrays over the centres of these; columns of k numbers have one axis more."""
    library, grid = required("xarray", "data"), table.grid
    assert grid is not None
    arrays, coordinates = {}, {}
    for name, origin, step, size in zip(grid.axes, grid.origin, grid.step, grid.shape, strict=True):
        centers = origin + (np.arange(size) + 0.5) * step
        coordinates[name] = _axis(name, centers, table.units.get(name, "1"))
    for name, values in table.columns.items():
        if name not in grid.axes:
            axes = grid.axes if values.ndim == 1 else (*grid.axes, f"{name}_{VECTOR}")
            about = {"units": table.units.get(name, "1"), "long_name": said(name)}
            arrays[name] = (axes, values.reshape(*grid.shape, *values.shape[1:]), about)
    return library.Dataset(arrays, coordinates, _about(document, grid.frame))


def image_data(volume: VolumeData, document: Mapping[str, Any]) -> "pyvista.ImageData":
    """The voxels as the cells of an image [m, world frame]; ``user_dict["units"]`` has the unit of each array."""
    library, taken = required("pyvista", "render"), {"count"}
    names, vectors = cell_names(volume, taken), vector_names(volume, taken)
    image = library.ImageData(
        dimensions=np.add(volume.shape, 1), spacing=(volume.voxel_size_m,) * 3, origin=volume.origin_m
    )
    for name, values in cell_arrays(volume, names, vectors):
        image.cell_data[name] = values.reshape(-1, *values.shape[3:], order="F")
    image.user_dict = _about(document, "world") | {"units": cell_units(volume, names, vectors)}
    return image


def poly_data(mesh: "trimesh.Trimesh", document: Mapping[str, Any]) -> "pyvista.PolyData":
    """A mesh [m, world frame]."""
    surface = required("pyvista", "render").PolyData.from_regular_faces(np.asarray(mesh.vertices), mesh.faces)
    surface.user_dict = _about(document, "world") | {"units": {"points": "m"}}
    return surface


def one_of(kind: str, held: Mapping[str, Any], name: str | None) -> Any:
    """What is held under a name, by default the first. Raises InputError where there is none."""
    if name is None and held:
        return next(iter(held.values()))
    if name is None or name not in held:
        missing = kind if name is None else f"{kind} {name}"
        raise InputError("name", f"the result has no {missing}; it holds {', '.join(held) or 'none'}")
    return held[name]


def _axis(name: str, centers: np.ndarray, unit: str) -> tuple[str, np.ndarray, dict[str, str]]:
    return name, centers, {"units": unit, "long_name": said(name)}


def _about(document: Mapping[str, Any], frame: str | None) -> dict[str, Any]:
    """What goes with the data: of which robot and samples, what came out, in which frame."""
    about = {"title": sampling_text(dict(document)), "analysis": str(document.get("analysis", ""))}
    if lines := headline_lines(document):
        about["headline"] = "; ".join(lines)
    return about | ({"frame": frame} if frame else {})


def required(name: str, extra: str) -> Any:
    """A module of another package. Raises MissingExtraError, naming the extra, where it is not installed."""
    try:
        return import_module(name)
    except ModuleNotFoundError as error:
        if (error.name or name).partition(".")[0] == "wsrender":
            raise
        raise MissingExtraError(name, extra) from error
