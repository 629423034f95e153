"""Numbers out of the files of results, made in the side process: planes, voxels, rows of tables, histograms."""

import csv
import io
import json
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from wsrender.errors import InputError, ResourceError

if TYPE_CHECKING:
    import pyarrow

AXES = "xyz"
MOST_VALUES = 1_000_000  # of an answer as text, some 20 bytes each

TextFormat = Literal["json", "csv"]


def slice_content(
    volume_file: str, axis: str, at: float | None, index: str | None, statistic: str | None, format: str
) -> tuple[bytes, dict[str, str]]:
    """A plane of `slice_values` as npy, raw (float32, little-endian), json or csv, and headers that say where it is.

    As CSV the occupied voxels are rows of their centre x, y, z [m] and value. Raises InputError, and ResourceError for
    a plane that is too large for text.
    """
    plane = slice_values(volume_file, axis, at, index, statistic)
    values, empty = plane.pop("values"), plane.pop("empty")
    headers = {
        "X-Shape": ",".join(map(str, values.shape)),
        "X-Origin-M": ",".join(map(repr, plane["origin_m"])),
        "X-Voxel-Size-M": repr(plane["voxel_size_m"]),
        "X-At-M": repr(plane["at_m"]),
        "X-Array": plane["name"],
    }
    if format in ("npy", "raw"):
        with_gaps = np.where(empty, np.float32("nan"), values).astype("<f4")
        return with_gaps.tobytes() if format == "raw" else _npy(with_gaps), headers
    if values.size > MOST_VALUES:
        text = f"the plane has {values.size} voxels, as text {MOST_VALUES} at most; take it as npy or raw"
        raise ResourceError("format", text)
    if format == "json":
        rows = [
            [None if gap else value for gap, value in zip(*row, strict=True)]
            for row in zip(empty.tolist(), map(_plain, values), strict=True)
        ]
        return _json(plane | {"shape": list(values.shape), "values": rows}), headers
    normal, cells = AXES.index(axis), np.nonzero(~empty)
    centers = {AXES[normal]: np.full(len(cells[0]), plane["at_m"])}
    for name, origin, cell in zip(plane["axes"], plane["origin_m"], cells, strict=True):
        centers[name] = origin + (cell + 0.5) * plane["voxel_size_m"]
    return _csv({**{name: centers[name] for name in AXES}, plane["name"]: values[cells]}), headers


def slice_values(
    volume_file: str, axis: str, at: float | None, index: str | None, statistic: str | None
) -> dict[str, Any]:
    """The plane of voxels at a coordinate ``at`` [m] along an axis; by default the one with most occupied voxels.

    Returns ``values`` (a, b) over the two other ``axes`` in the order x, y, z, of the file's type, and ``empty``
    (a, b), where no sample is; ``origin_m``, the lower corner of its first voxel (2,); ``voxel_size_m``; ``axis`` and
    ``at_m``, the centre of the plane; ``name`` and ``unit`` of the array. Raises InputError for a plane outside the
    volume and an index or statistic that it does not hold.
    """
    import h5py

    normal = AXES.index(axis)
    with h5py.File(volume_file, "r") as file:
        root: Any = file["VTKHDF"]
        name = _array_name(root["CellData"], index, statistic)
        size, first = float(root.attrs["Spacing"][0]), np.asarray(root.attrs["first_voxel"])
        layer = _layer(root["CellData"]["count"], normal, at, size, int(first[normal]))
        where: list[Any] = [slice(None)] * 3
        where[2 - normal] = layer  # files hold z, y, x
        counts = np.asarray(root["CellData"]["count"][tuple(where)]).T
        values = np.asarray(root["CellData"][name][tuple(where)]).T
        unit = str(root["CellData"][name].attrs["unit"])
    across = [k for k in range(3) if k != normal]
    return {
        "name": name,
        "unit": unit,
        "axis": axis,
        "at_m": float((first[normal] + layer + 0.5) * size),
        "axes": [AXES[k] for k in across],
        "origin_m": [float(first[k] * size) for k in across],
        "voxel_size_m": size,
        "values": np.ascontiguousarray(values),
        "empty": counts == 0,
    }


def voxel_values(volume_file: str, at: tuple[float, float, float]) -> dict[str, Any]:
    """What the voxel that holds the point ``at`` (3,) [m] holds: ``cell``, ``center_m``, ``count`` and ``values``.

    Raises InputError for a point outside the volume.
    """
    import h5py

    with h5py.File(volume_file, "r") as file:
        root: Any = file["VTKHDF"]
        size, first = float(root.attrs["Spacing"][0]), np.asarray(root.attrs["first_voxel"])
        cell = np.floor(np.array(at) / size + 1e-9).astype(np.int64) - first
        cells = root["CellData"]
        if (cell < 0).any() or (cell >= cells["count"].shape[::-1]).any():
            low, high = first * size, (first + cells["count"].shape[::-1]) * size
            box = ", ".join(f"{a:g} … {b:g}" for a, b in zip(low, high, strict=True))
            raise InputError("x", f"the point {', '.join(f'{each:g}' for each in at)} is outside the volume, {box} m")
        x, y, z = cell.tolist()
        values = []
        for data in cells.values():
            told = [("statistic", "index", "")] if "statistic" in data.attrs else []
            told = [("vector", "vector", axis) for axis in AXES] if "vector" in data.attrs else told
            for (statistic, name, axis), number in zip(told, np.atleast_1d(data[z, y, x]).tolist(), strict=False):
                unit = str(data.attrs["unit"])
                known = {"name": str(data.attrs[name]), "statistic": axis or str(data.attrs[statistic]), "unit": unit}
                values.append({**known, "value": number if math.isfinite(number) else None})
        count = int(cells["count"][z, y, x])
    center = (first + cell + 0.5) * size
    return {"cell": (x, y, z), "center_m": tuple(center.tolist()), "count": count, "values": values}


def table_content(
    table_file: str, name: str, columns: str | None, offset: int, limit: int | None, format: TextFormat
) -> bytes:
    """Rows of a map or table from ``offset`` on, of the ``columns`` that a line of CSV names, all by default.

    Numbers that are not finite are null. Raises InputError for a column that there is not, ResourceError, naming the
    limit, where that is too much for text.
    """
    from wsrender.results.export.parquet import read_rows, rows_in

    total, held = rows_in(table_file)
    names = list(held) if columns is None else _listed(columns, held)
    count = min(total - min(offset, total), total if limit is None else limit)
    if count * len(names) > MOST_VALUES:
        most = MOST_VALUES // len(names)
        raise ResourceError("limit", f"must be at most {most} with {len(names)} columns, of {total} rows: ask for them "
                            "part by part, with offset, or for fewer columns, or take the whole file")  # fmt: skip
    rows = read_rows(table_file, names, offset, offset + count)
    if format == "csv":
        return _csv(rows)
    parts = [{"name": each, "unit": held[each], "values": _plain(rows[each].to_numpy())} for each in names]
    return _json({"name": name, "rows": total, "offset": offset, "columns": parts})


def histogram_content(
    table_file: str, index: str | None, bins: int | None, lower: float | None, upper: float | None, format: TextFormat
) -> bytes:
    """How the finite values of an index are spread over the samples in a file, as `histogram_data` has it.

    Raises InputError for an index that the samples do not have, and for limits between which nothing can be.
    """
    from wsrender.results.drawing.distribution import finite, histogram_data, write_histograms
    from wsrender.results.export.parquet import index_values

    name, unit, values = index_values(table_file, index)
    if not len(values := finite(values)):
        raise InputError("index", f"no sample was kept that has a finite value of {name}")
    edges, share = histogram_data(values, bins, lower, upper)
    if format == "csv":
        file = io.StringIO(newline="")
        write_histograms(file, [(name, unit, edges, share)])
        return file.getvalue().encode()
    return _json(
        {
            "index": name,
            "unit": unit,
            "samples": len(values),
            "mean": float(values.mean(dtype=np.float64)),
            "below": float(np.mean(values < edges[0])),
            "above": float(np.mean(values > edges[-1])),
            "edges": edges.tolist(),
            "share": share.tolist(),
        }
    )


def _listed(columns: str, held: Mapping[str, str]) -> list[str]:
    """The names in a line of CSV, each of them held. Raises InputError."""
    try:
        names = list(dict.fromkeys(next(csv.reader([columns], strict=True), [])))
    except csv.Error as error:
        raise InputError("columns", f"must be names with commas between them: {error}") from None
    for name in names or [""]:
        if name not in held:
            raise InputError("columns", f"there is no column {name[:256]!r}; there are {', '.join(held)}")
    return names


def _plain(values: np.ndarray) -> list[Any]:
    """Values (N,) as JSON has them, null where they are not finite."""
    if values.dtype.kind != "f":
        return values.tolist()
    return [value if math.isfinite(value) else None for value in values.tolist()]


def _json(document: dict[str, Any]) -> bytes:
    return json.dumps(document, ensure_ascii=False, allow_nan=False).encode()


def _csv(columns: "Mapping[str, np.ndarray] | pyarrow.Table") -> bytes:
    import pyarrow
    import pyarrow.csv

    table = pyarrow.table(dict(columns)) if isinstance(columns, Mapping) else columns
    file = io.BytesIO()
    pyarrow.csv.write_csv(table, file)
    return file.getvalue()


def _npy(values: np.ndarray) -> bytes:
    file = io.BytesIO()
    np.lib.format.write_array(file, values, allow_pickle=False)
    return file.getvalue()


def _array_name(cells: Any, index: str | None, statistic: str | None) -> str:
    if statistic == "count":
        return "count"
    arrays = {
        (str(data.attrs["statistic"]), str(data.attrs["index"])): name
        for name, data in cells.items()
        if "statistic" in data.attrs
    }
    if not arrays and index is None and statistic is None:
        return "count"
    order = sorted(arrays, key=lambda key: key[0] != "maximum")  # the maximum first, then as in the file
    for found in order:
        if statistic in (None, found[0]) and index in (None, found[1]):
            return arrays[found]
    held = ", ".join(["count", *(f"{statistic} of {name}" for statistic, name in arrays)])
    raise InputError("index", f"the volume has no {statistic or 'statistic'} of {index or 'an index'}; it holds {held}")


def _layer(counts: Any, normal: int, at: float | None, size: float, first: int) -> int:
    layers = counts.shape[2 - normal]
    if at is None:
        across = tuple(k for k in range(3) if k != 2 - normal)
        return int(np.count_nonzero(counts[...], axis=across).argmax())
    cells = at / size - first
    if not -1e-9 <= cells <= layers + 1e-9:
        low, high = first * size, (first + layers) * size
        raise InputError("at", f"the plane {AXES[normal]} = {at:g} m misses the workspace, {low:g} … {high:g} m")
    return min(max(int(np.floor(cells + 1e-9)), 0), layers - 1)
