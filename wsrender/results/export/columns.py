"""Distribution maps and tables as named columns: what Parquet, CSV, npz and MATLAB files hold."""

import json
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from wsrender.errors import InputError
from wsrender.results.export.names import unique_names
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.table import CellGrid, Table

DESCRIPTION = "wsrender"  # name of the description in a file, so no column may be called so
POSITION = ("x", "y", "z")
QUATERNION = ("qw", "qx", "qy", "qz")

Block = Callable[[Iterable[str]], np.ndarray]
"""What reads columns of one dtype from a file: c names → (N, c)."""


@dataclass(frozen=True)
class MapColumns:
    """Column names of a distribution map: three positions, joints, quaternion w x y z, indices.

    ``joints`` and ``indices`` map the names of joints and indices to their columns; ``joints`` and
    ``quaternion`` are empty where the map does not keep them. ``units`` are those of the map.
    """

    joints: dict[str, str]
    quaternion: tuple[str, ...]
    indices: dict[str, str]
    joint_names: tuple[str, ...] = ()
    units: dict[str, str] = field(default_factory=dict)

    @classmethod
    def of(cls, samples: DistributionMap) -> "MapColumns":
        """Columns of a map."""
        quaternion = QUATERNION if samples.quat_wxyz is not None else ()
        taken = {DESCRIPTION, *POSITION, *quaternion}
        kept_joints = samples.joint_names if samples.configuration is not None else ()
        return cls(
            joints=unique_names(kept_joints, "joint", taken),
            quaternion=quaternion,
            indices=unique_names(samples.indices, "index", taken),
            joint_names=tuple(samples.joint_names),
            units=dict(samples.units),
        )

    def names(self) -> list[str]:
        """All column names, in the order of the file."""
        return [*POSITION, *self.joints.values(), *self.quaternion, *self.indices.values()]

    def column_units(self) -> dict[str, str]:
        """Unit of every column; ``"1"`` where it has none."""
        units = dict.fromkeys(POSITION, "m") | dict.fromkeys(self.quaternion, "1")
        units |= {column: self.units.get(name, "rad or m") for name, column in self.joints.items()}
        return units | {column: self.units.get(name, "1") for name, column in self.indices.items()}

    def to_json(self) -> str:
        """The description stored in a file, from which ``described`` restores it."""
        return json.dumps(
            {
                "frame": "world",
                "position": list(POSITION),
                "joints": self.joints,
                "quat_wxyz": list(self.quaternion),
                "indices": self.indices,
                "joint_names": list(self.joint_names),
                "units": self.units,
                "column_units": self.column_units(),
            }
        )

    @classmethod
    def described(cls, data: dict[str, Any]) -> "MapColumns":
        """The columns that a description says; KeyError, TypeError or ValueError where it is none."""
        return cls(
            joints=dict(data["joints"]),
            quaternion=tuple(data["quat_wxyz"]),
            indices=dict(data["indices"]),
            joint_names=tuple(data["joint_names"]),
            units=dict(data["units"]),
        )

    def arrays(self, samples: DistributionMap) -> dict[str, np.ndarray]:
        """Every column of a map as an array (N,), views where possible."""
        arrays = dict(zip(POSITION, np.asarray(samples.position).T, strict=True))
        if self.joints and samples.configuration is not None:
            arrays |= dict(zip(self.joints.values(), samples.configuration.T, strict=True))
        if self.quaternion and samples.quat_wxyz is not None:
            arrays |= dict(zip(self.quaternion, samples.quat_wxyz.T, strict=True))
        return arrays | {column: np.asarray(samples.indices[name]) for name, column in self.indices.items()}

    def restored(self, block: Block) -> DistributionMap:
        """The map whose columns ``block`` reads."""
        return DistributionMap(
            position=block(POSITION),
            indices={name: block([column])[:, 0] for name, column in self.indices.items()},
            units=dict(self.units),
            configuration=block(self.joints.values()) if self.joints else None,
            joint_names=self.joint_names,
            quat_wxyz=block(self.quaternion) if self.quaternion else None,
        )


@dataclass(frozen=True)
class TableColumns:
    """Column names of a table: one in the file for a column (N,), ``<name>_0`` … for the k of one (N, k)."""

    columns: dict[str, tuple[str, ...]]
    wide: tuple[str, ...] = ()
    units: dict[str, str] = field(default_factory=dict)
    grid: CellGrid | None = None

    @classmethod
    def of(cls, table: Table) -> "TableColumns":
        """Columns of a table."""
        taken = {DESCRIPTION}
        wide = tuple(name for name, column in table.columns.items() if column.ndim == 2)
        columns = {}
        for name, column in table.columns.items():
            wanted = [f"{name}_{k}" for k in range(column.shape[1])] if name in wide else [name]
            columns[name] = tuple(unique_names(wanted, "column", taken).values())
        return cls(columns, wide, dict(table.units), table.grid)

    def names(self) -> list[str]:
        """All column names, in the order of the file."""
        return [name for names in self.columns.values() for name in names]

    def column_units(self) -> dict[str, str]:
        """Unit of every column; ``"1"`` where it has none."""
        return {part: self.units.get(name, "1") for name, names in self.columns.items() for part in names}

    def to_json(self) -> str:
        """The description stored in a file, from which ``described`` restores it."""
        grid = {"grid": asdict(self.grid)} if self.grid else {}
        return json.dumps({"table": self.columns, "wide": self.wide, "units": self.units, **grid})

    @classmethod
    def described(cls, data: dict[str, Any]) -> "TableColumns":
        """The columns that a description says; KeyError, TypeError or ValueError where it is none."""
        columns = {name: tuple(parts) for name, parts in data["table"].items()}
        if grid := data.get("grid"):
            axes, origin, step, shape = (tuple(grid[name]) for name in ("axes", "origin", "step", "shape"))
            grid = CellGrid(axes, origin, step, shape, grid["frame"])
        return cls(columns, tuple(data["wide"]), dict(data["units"]), grid)

    def arrays(self, table: Table) -> dict[str, np.ndarray]:
        """Every column of the file as an array (N,)."""
        arrays = {}
        for name, parts in self.columns.items():
            arrays |= dict(zip(parts, table[name].T if name in self.wide else [table[name]], strict=True))
        return arrays

    def restored(self, block: Block) -> Table:
        """The table whose columns ``block`` reads."""
        columns = {}
        for name, parts in self.columns.items():
            values = block(parts) if parts else np.empty((0, 0))
            values = values.astype(str) if values.dtype == object else values  # Parquet's text
            columns[name] = values if name in self.wide else values[:, 0]
        return Table(columns, dict(self.units), self.grid)


def columns_of(data: DistributionMap | Table) -> MapColumns | TableColumns:
    """Columns of a map or a table."""
    return TableColumns.of(data) if isinstance(data, Table) else MapColumns.of(data)


def columns_from_json(text: str | bytes, source: str) -> MapColumns | TableColumns:
    """The description read from a file called ``source``; InputError where it is none."""
    try:
        data = json.loads(text)
        return TableColumns.described(data) if "table" in data else MapColumns.described(data)
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise InputError(source, f"its description of columns is damaged: {error!r}") from error


def arrays_by_column(data: DistributionMap | Table, columns: Any) -> dict[str, np.ndarray]:
    """Every column of the file as an array (N,), views where possible. InputError where lengths differ."""
    arrays = columns.arrays(data)
    for column, array in arrays.items():
        if array.shape != (len(data),):
            raise InputError(column, f"has shape {array.shape}; the map has {len(data)} rows")
    return arrays
