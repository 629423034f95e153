"""Volume data: statistics of the local indices per voxel of the world lattice ([WSR] II.C.2)."""

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property

import numpy as np

from wsrender.errors import InputError
from wsrender.notebook import mime_bundle
from wsrender.short_repr import short_names
from wsrender.volume.voxels import Values, Voxels

KEPT = 1 << 26  # numbers in all arrays of a volume that are kept once they are made

VOXEL_LABELS = "reachability"  # what the volume of voxels by whether their centres are reached is called


class VolumeData:
    """A block of the world lattice, cropped to the occupied voxels.

    Voxel (i, j, k) of the arrays covers [(first_voxel + (i, j, k)) r, … + r) with r = ``voxel_size_m``;
    x runs along the first axis. ``count`` is int64 of shape (nx, ny, nz); ``statistics[s][name]`` holds
    statistic s ("maximum", "minimum", "mean") of index ``name``, float64 or float32, NaN in empty voxels.
    ``vectors[name]`` (nx, ny, nz, 3) holds the mean of a vector in world axes. ``units`` are of both. Where samples are
    kept, ``best[name]`` (nx, ny, nz) uint64 is the number of the one with a voxel's largest value of an index, the
    smallest among equals, 0 in empty voxels: `wsrender.configuration_of` has its configuration.

    ``voxels`` is the same without the empty voxels. A volume made of them (`of_voxels`) makes each array when it is
    asked for, which raises ResourceError, with the numbers, where it does not fit in memory. One made of arrays raises
    InputError, naming the array, where its shape is not that of ``count``. Arrays are read-only: copy one to change it.
    """

    statistics: Mapping[str, Values]
    vectors: Values
    best: Values

    def __init__(
        self,
        voxel_size_m: float,
        first_voxel: tuple[int, int, int],
        count: np.ndarray,
        statistics: Mapping[str, Values] | None = None,
        units: Mapping[str, str] | None = None,
        vectors: Values | None = None,
        best: Values | None = None,
    ):
        self.voxel_size_m, self.first_voxel, self.units = voxel_size_m, first_voxel, dict(units or {})
        nx, ny, nz = count.shape
        self.shape = nx, ny, nz
        self._count: Values = _read_only({"count": count})
        self.statistics = {s: _read_only(by_index) for s, by_index in (statistics or {}).items()}
        self.vectors, self.best = _read_only(vectors or {}), _read_only(best or {})
        for statistic, by_index in self.statistics.items():
            for name, values in by_index.items():
                _check_shape(f"statistics.{statistic}.{name}", values, self.shape)
        for name, values in self.vectors.items():
            _check_shape(f"vectors.{name}", values, (*self.shape, 3))
        for name, values in self.best.items():
            _check_shape(f"best.{name}", values, self.shape)

    def __repr__(self) -> str:
        held = dict.fromkeys(name for by_index in (*self.statistics.values(), self.vectors) for name in by_index)
        of = f" of {short_names(held, self.units)}" if held else ""
        return f"<VolumeData: {self.n_occupied:,} voxels of {self.voxel_size_m:g} m in {self.shape}{of}>"

    _repr_mimebundle_ = mime_bundle

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
        made: dict[tuple[str, str], np.ndarray] = {}
        volume._count = _Arrays("count", voxels, {"count": voxels.count}, made)
        volume.statistics = {
            statistic: _Arrays(f"statistics.{statistic}", voxels, by_index, made)
            for statistic, by_index in voxels.statistics.items()
        }
        volume.vectors = _Arrays("vectors", voxels, voxels.vectors, made)
        volume.best = _Arrays("best", voxels, voxels.best, made)
        return volume

    @cached_property
    def voxels(self) -> Voxels:
        """The voxels that hold something."""
        return Voxels.of_arrays(self.count, self.statistics, self.vectors, self.best)

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


def _read_only(arrays: Values) -> dict[str, np.ndarray]:
    """Views that cannot be written to: `VolumeData.voxels` would not change with the arrays."""
    views = {name: array.view() for name, array in arrays.items()}
    for view in views.values():
        view.flags.writeable = False
    return views


class _Arrays(Mapping[str, np.ndarray]):
    """Dense arrays of a ``kind`` by name, each made when it is asked for.

    ``made`` holds those that a volume keeps, of all kinds.
    """

    def __init__(self, kind: str, voxels: Voxels, values: Values, made: dict[tuple[str, str], np.ndarray]):
        self._kind, self._voxels, self._values, self._made = kind, voxels, values, made

    def __getitem__(self, name: str) -> np.ndarray:
        key = self._kind, name
        if key in self._made:
            return self._made[key]
        array = self._voxels.dense(self._values[name])
        array.flags.writeable = False
        if sum(kept.size for kept in self._made.values()) + array.size <= KEPT:
            self._made[key] = array
        return array

    def __contains__(self, name: object) -> bool:
        return name in self._values  # a Mapping's own would make the array

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)


_MERGED = {
    **dict.fromkeys(("maximum", "number", "product", "fraction"), np.fmax),
    "minimum": np.fmin,
    "samples": np.add,
}


def coarser(volume: VolumeData, factor: int) -> VolumeData:
    """The volume on the lattice whose voxels are ``factor`` times as long; it too is anchored at the origin.

    Each holds the largest maximum, the least minimum and so on of its occupied parts, means and shares weighted by
    their samples; of what has no such rule, as labels, the value of its first part.
    """
    first = np.array(volume.first_voxel)
    start = first // factor
    x, y, z = start.tolist()
    nx, ny, nz = ((first + volume.shape - 1) // factor - start + 1).tolist()
    fine = volume.voxels.among(volume.voxels.count > 0)
    at = (fine.at + first[:, None]) // factor - start[:, None]
    cells, part_of = np.unique(np.ravel_multi_index(tuple(at), (nx, ny, nz)), return_inverse=True)
    order = np.argsort(part_of, kind="stable")
    starts = np.searchsorted(part_of[order], np.arange(len(cells)))

    def reduced(reduce: np.ufunc, values: np.ndarray) -> np.ndarray:
        return reduce.reduceat(values[order], starts) if len(starts) else values[:0]

    count = reduced(np.add, fine.count)

    def merged(statistic: str, values: np.ndarray) -> np.ndarray:
        if statistic in ("mean", "share"):
            return reduced(np.add, values * fine.count) / count
        if statistic in _MERGED:
            return reduced(_MERGED[statistic], values)
        return values[order[starts]] if len(starts) else values[:0]

    statistics = {
        statistic: {name: merged(statistic, values) for name, values in by_index.items()}
        for statistic, by_index in fine.statistics.items()
    }
    # Of each coarse voxel the first by value, and then by number.
    best = {}
    for name, numbers in fine.best.items():
        leading = np.lexsort([numbers, -fine.statistics["maximum"][name], part_of])
        best[name] = numbers[leading[starts]] if len(starts) else numbers[:0]
    voxels = Voxels((nx, ny, nz), cells.astype(np.int64), count, statistics, best=best)
    return VolumeData.of_voxels(volume.voxel_size_m * factor, (x, y, z), voxels, volume.units)


def registered(volumes: Sequence[VolumeData]) -> list[VolumeData]:
    """The same volumes, each on the smallest block that holds all of them.

    Raises InputError for volumes of different voxel sizes.
    """
    if len({volume.voxel_size_m for volume in volumes}) > 1:
        sizes = ", ".join(f"{volume.voxel_size_m:g}" for volume in volumes)
        raise InputError("voxel_size_m", f"must be the same for all volumes, not {sizes}")
    first = np.min([volume.first_voxel for volume in volumes], axis=0)
    end = np.max([np.add(volume.first_voxel, volume.shape) for volume in volumes], axis=0)
    (x, y, z), (nx, ny, nz) = first.tolist(), (end - first).tolist()
    return [
        VolumeData.of_voxels(
            volume.voxel_size_m,
            (x, y, z),
            volume.voxels.moved((nx, ny, nz), np.subtract(volume.first_voxel, first)),
            volume.units,
        )
        for volume in volumes
    ]
