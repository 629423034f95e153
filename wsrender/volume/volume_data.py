"""Volume data: statistics of the local indices per voxel of the world lattice ([WSR] II.C.2)."""

from collections.abc import Iterator, Mapping
from functools import cached_property
from math import prod

import numpy as np

from wsrender.errors import InputError, ResourceError
from wsrender.memory import SHARE, available_bytes
from wsrender.volume.voxels import Values, Voxels

KEPT = 1 << 26  # voxels of a block up to which its arrays are kept once they are made


class VolumeData:
    """A block of the world lattice, cropped to the occupied voxels.

    Voxel (i, j, k) of the arrays covers [(first_voxel + (i, j, k)) r, … + r) with r = ``voxel_size_m``;
    x runs along the first axis. ``count`` is int64 of shape (nx, ny, nz); ``statistics[s][name]`` holds
    statistic s ("maximum", "minimum", "mean") of index ``name``, float64 or float32, NaN in empty voxels.
    ``vectors[name]`` (nx, ny, nz, 3) holds the mean of a vector in world axes. ``units`` are of both.

    ``voxels`` is the same without the empty voxels. A volume made of them (`of_voxels`) makes each array when it is
    asked for, which raises ResourceError, with the numbers, where it does not fit in memory. One made of arrays raises
    InputError, naming the array, where its shape is not that of ``count``.
    """

    statistics: Mapping[str, Values]
    vectors: Values

    def __init__(
        self,
        voxel_size_m: float,
        first_voxel: tuple[int, int, int],
        count: np.ndarray,
        statistics: Mapping[str, Values] | None = None,
        units: Mapping[str, str] | None = None,
        vectors: Values | None = None,
    ):
        self.voxel_size_m, self.first_voxel, self.units = voxel_size_m, first_voxel, dict(units or {})
        nx, ny, nz = count.shape
        self.shape = nx, ny, nz
        self._count: Values = {"count": count}
        self.statistics, self.vectors = dict(statistics or {}), dict(vectors or {})
        for statistic, by_index in self.statistics.items():
            for name, values in by_index.items():
                _check_shape(f"statistics.{statistic}.{name}", values, self.shape)
        for name, values in self.vectors.items():
            _check_shape(f"vectors.{name}", values, (*self.shape, 3))

    @classmethod
    def of_voxels(
        cls,
        voxel_size_m: float,
        first_voxel: tuple[int, int, int],
        voxels: Voxels,
        units: Mapping[str, str] | None = None,
    ) -> "VolumeData":
        """The volume of voxels in a block that starts at ``first_voxel``."""
        volume = cls.__new__(cls)
        volume.voxel_size_m, volume.first_voxel, volume.units = voxel_size_m, first_voxel, dict(units or {})
        volume.shape, volume.voxels = voxels.shape, voxels
        volume._count = _Arrays(voxels, {"count": voxels.count})
        volume.statistics = {s: _Arrays(voxels, by_index) for s, by_index in voxels.statistics.items()}
        volume.vectors = _Arrays(voxels, voxels.vectors)
        return volume

    @cached_property
    def voxels(self) -> Voxels:
        """The voxels that hold something."""
        return Voxels.of_arrays(self.count, self.statistics, self.vectors)

    @property
    def count(self) -> np.ndarray:
        """Samples per voxel, (nx, ny, nz) int64."""
        return self._count["count"]

    @property
    def occupied(self) -> np.ndarray:
        """Whether a sample fell in the voxel, (nx, ny, nz) bool."""
        return self.voxels.dense(self.voxels.count > 0)

    @property
    def n_occupied(self) -> int:
        """Number of occupied voxels."""
        return int(np.count_nonzero(self.voxels.count))

    @property
    def origin_m(self) -> np.ndarray:
        """Lower corner of the first voxel in the world frame [m], (3,)."""
        return np.array(self.first_voxel) * self.voxel_size_m

    def centers(self, axis: int) -> np.ndarray:
        """Centre coordinates of the voxels along an axis (0, 1, 2) [m]."""
        return (self.first_voxel[axis] + np.arange(self.shape[axis]) + 0.5) * self.voxel_size_m


def _check_shape(field: str, values: np.ndarray, shape: tuple[int, ...]) -> None:
    if values.shape != shape:
        raise InputError(field, f"has shape {values.shape}; the volume has {shape}")


class _Arrays(Mapping[str, np.ndarray]):
    """Dense arrays of voxels by name, each made when it is asked for."""

    def __init__(self, voxels: Voxels, values: Values):
        self._voxels, self._values, self._made = voxels, values, {}

    def __getitem__(self, name: str) -> np.ndarray:
        if name in self._made:
            return self._made[name]
        values = self._values[name]
        size = prod(self._voxels.shape)
        needed, free = size * values[:1].nbytes if len(values) else 0, available_bytes()
        if needed > SHARE * free:
            raise ResourceError(
                "volume",
                f"{' x '.join(map(str, self._voxels.shape))} voxels need {needed / 2**30:.1f} GiB as an array; "
                f"{free / 2**30:.1f} GiB are free: take volume.voxels, which holds those that are not empty",
            )
        array = self._voxels.dense(values)
        if size <= KEPT:
            self._made[name] = array
        return array

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)
