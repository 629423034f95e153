"""The distribution map as named columns: what Parquet, CSV, npz and MATLAB files hold."""

import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

import numpy as np

from wsrender.errors import InputError
from wsrender.export.names import unique_names
from wsrender.volume.distribution_map import DistributionMap

DESCRIPTION = "wsrender"  # name of the description in a file, so no column may be called so
POSITION = ("x", "y", "z")
QUATERNION = ("qw", "qx", "qy", "qz")


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
        """The description stored in a file, from which ``from_json`` restores it."""
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
    def from_json(cls, text: str | bytes, source: str) -> "MapColumns":
        """The description read from a file called ``source``; InputError where it is none."""
        try:
            data = json.loads(text)
            return cls(
                joints=dict(data["joints"]),
                quaternion=tuple(data["quat_wxyz"]),
                indices=dict(data["indices"]),
                joint_names=tuple(data["joint_names"]),
                units=dict(data["units"]),
            )
        except (ValueError, KeyError, TypeError) as error:
            raise InputError(source, f"its description of columns is damaged: {error!r}") from error


def arrays_by_column(samples: DistributionMap, columns: MapColumns) -> dict[str, np.ndarray]:
    """Every column of a map as an array (N,), views where possible. InputError where lengths differ."""
    arrays = dict(zip(POSITION, np.asarray(samples.position).T, strict=True))
    if columns.joints and samples.configuration is not None:
        arrays |= dict(zip(columns.joints.values(), samples.configuration.T, strict=True))
    if columns.quaternion and samples.quat_wxyz is not None:
        arrays |= dict(zip(columns.quaternion, samples.quat_wxyz.T, strict=True))
    arrays |= {column: np.asarray(samples.indices[name]) for name, column in columns.indices.items()}
    for column, array in arrays.items():
        if array.shape != (len(samples),):
            raise InputError(column, f"has shape {array.shape}; the map has {len(samples)} rows")
    return arrays


def map_from_columns(columns: MapColumns, block: Callable[[Iterable[str]], np.ndarray]) -> DistributionMap:
    """The map whose columns ``block`` returns: names of c columns of one dtype → (N, c)."""
    return DistributionMap(
        position=block(POSITION),
        indices={name: block([column])[:, 0] for name, column in columns.indices.items()},
        units=dict(columns.units),
        configuration=block(columns.joints.values()) if columns.joints else None,
        joint_names=columns.joint_names,
        quat_wxyz=block(columns.quaternion) if columns.quaternion else None,
    )
