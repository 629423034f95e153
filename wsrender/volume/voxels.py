"""What the voxels of a block hold, without those that hold nothing; voxels and their 26 neighbours."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from math import prod

import numpy as np

from wsrender.errors import ResourceError
from wsrender.memory import SHARE, available_bytes
from wsrender.short_repr import short_repr

Values = Mapping[str, np.ndarray]
LAYERS = 32  # of voxels at a time


@dataclass(frozen=True, eq=False)
class Voxels:
    """The V voxels of a block that hold something: a sample, or a value.

    ``shape`` is the block's, (nx, ny, nz); ``cells`` (V,) int64, sorted: their numbers in it, z fastest; ``count`` (V,)
    int64: samples; ``statistics[s][name]`` (V,) and ``vectors[name]`` (V, 3): NaN where unknown. ``best[name]`` (V,)
    uint64: the number of the sample with the voxel's largest value of an index, the smallest among equals.
    """

    shape: tuple[int, int, int]
    cells: np.ndarray
    count: np.ndarray
    statistics: Mapping[str, Values] = field(default_factory=dict)
    vectors: Values = field(default_factory=dict)
    best: Values = field(default_factory=dict)

    __repr__ = short_repr

    @classmethod
    def of_arrays(
        cls, count: np.ndarray, statistics: Mapping[str, Values], vectors: Values, best: Values | None = None
    ) -> "Voxels":
        """From dense arrays (nx, ny, nz), of vectors (nx, ny, nz, 3)."""
        holds = count != 0
        for array in (*(array for by_index in statistics.values() for array in by_index.values()), *vectors.values()):
            known = ~np.isnan(array) if array.dtype.kind == "f" else np.ones(array.shape, bool)
            holds = holds | (known.any(axis=3) if array.ndim == 4 else known)
        nx, ny, nz = count.shape

        def taken(array: np.ndarray) -> np.ndarray:
            return array[holds]

        of_statistics = {s: _mapped(by_index, taken) for s, by_index in statistics.items()}
        others = _mapped(vectors, taken), _mapped(best or {}, taken)
        return cls((nx, ny, nz), np.flatnonzero(holds), count[holds], of_statistics, *others)

    @property
    def at(self) -> np.ndarray:
        """Places of the voxels in the block, (3, V) int64."""
        _nx, ny, nz = (max(size, 1) for size in self.shape)
        return np.stack([self.cells // (ny * nz), self.cells // nz % ny, self.cells % nz])

    def among(self, kept: np.ndarray | slice) -> "Voxels":
        """Some of the voxels: a mask (V,), places in increasing order, or a range of them."""
        return self._changed(self.shape, self.cells[kept], lambda values: values[kept])

    def moved(self, shape: tuple[int, int, int], by: np.ndarray) -> "Voxels":
        """The same in a block of another shape, where they stand ``by`` (3,) voxels farther."""
        (x, y, z), (_nx, ny, nz) = self.at + np.asarray(by)[:, None], shape
        return self._changed(shape, (x * ny + y) * nz + z, lambda values: values)

    @classmethod
    def joined(cls, parts: "Sequence[Voxels]") -> "Voxels":
        """The voxels of all parts of one block, of which no two hold the same."""
        cells = np.concatenate([part.cells for part in parts])
        order = np.argsort(cells, kind="stable")

        def joined(of: Callable[[Voxels], np.ndarray]) -> np.ndarray:
            return np.concatenate([of(part) for part in parts])[order]

        first = parts[0]
        statistics = {
            s: {name: joined(lambda part, s=s, name=name: part.statistics[s][name]) for name in by_index}
            for s, by_index in first.statistics.items()
        }
        vectors = {name: joined(lambda part, name=name: part.vectors[name]) for name in first.vectors}
        best = {name: joined(lambda part, name=name: part.best[name]) for name in first.best}
        return cls(first.shape, cells[order], joined(lambda part: part.count), statistics, vectors, best)

    def dense(self, values: np.ndarray) -> np.ndarray:
        """Values (V,) or (V, 3) of the voxels as an array of the block: NaN, or of whole numbers 0, in the others.

        Raises ResourceError, with the numbers, where the array does not fit in memory.
        """
        needed = prod((*self.shape, *values.shape[1:])) * values.itemsize
        free = available_bytes()
        if needed > SHARE * free:
            raise ResourceError(
                "volume",
                f"{' x '.join(map(str, self.shape))} voxels need {needed / 2**30:.1f} GiB as an array; "
                f"{free / 2**30:.1f} GiB are free: take volume.voxels, which holds those that are not empty, choose "
                "larger voxels, or leave out formats of whole arrays (npz, mat)",
            )
        array = empty_array((prod(self.shape), *values.shape[1:]), values.dtype)
        array[self.cells] = values
        return array.reshape(*self.shape, *values.shape[1:])

    @classmethod
    def at_places(
        cls,
        places: np.ndarray,
        count: np.ndarray,
        statistics: Mapping[str, Values] | None = None,
        vectors: Values | None = None,
    ) -> "tuple[tuple[int, int, int], Voxels]":
        """The voxels at places (V, 3) int64 of the lattice, no two alike, in the least block that holds them.

        And that block's first voxel. ``count`` (V,), ``statistics`` and ``vectors`` are in the order of the places.
        """
        first = places.min(axis=0)
        (x, y, z), (nx, ny, nz) = first.tolist(), (places.max(axis=0) - first + 1).tolist()
        i, j, k = (places - first).T
        cells = (i * ny + j) * nz + k
        kept = cls((nx, ny, nz), cells, count.astype(np.int64), statistics or {}, vectors or {})
        return (x, y, z), kept.among(np.argsort(cells, kind="stable"))

    def plane(self, values: np.ndarray, axis: int, layer: int) -> np.ndarray:
        """One layer of what ``dense`` gives."""
        at = self.at
        here = at[axis] == layer
        across = [k for k in range(3) if k != axis]
        plane = empty_array((*(self.shape[k] for k in across), *values.shape[1:]), values.dtype)
        plane[tuple(at[across][:, here])] = values[here]
        return plane

    def _changed(self, shape: tuple[int, int, int], cells: np.ndarray, of: Callable[[np.ndarray], np.ndarray]):
        statistics = {s: _mapped(by_index, of) for s, by_index in self.statistics.items()}
        return Voxels(shape, cells, of(self.count), statistics, _mapped(self.vectors, of), _mapped(self.best, of))


def empty_array(shape: tuple[int, ...], dtype: np.dtype) -> np.ndarray:
    """What arrays hold of voxels that hold nothing: NaN, or of whole numbers 0."""
    return np.full(shape, np.nan, dtype) if dtype.kind == "f" else np.zeros(shape, dtype)


def _mapped(values: Values, of: Callable[[np.ndarray], np.ndarray]) -> dict[str, np.ndarray]:
    return {name: of(array) for name, array in values.items()}


def inner_and_outer(occupied: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of a set of voxels (nx, ny, nz) bool: those with all 26 neighbours in it, and it with all its neighbours.

    Both have one more layer of voxels on every side, (nx + 2, ny + 2, nz + 2). In a plane, cells (nx, ny) have 8
    neighbours, on a line 2.
    """
    inner = outer = np.pad(occupied, 1)
    for axis in range(occupied.ndim):
        before, after = _shifted(inner, 1, axis), _shifted(inner, -1, axis)
        inner = inner & before & after
        before, after = _shifted(outer, 1, axis), _shifted(outer, -1, axis)
        outer = outer | before | after
    return inner, outer


def neighbours_and_itself(occupied: np.ndarray) -> np.ndarray:
    """Of every voxel of a block, how many of it and its neighbours are in a set of voxels, int8 of the same shape."""
    number = np.pad(occupied, 1).astype(np.int8)
    for axis in range(occupied.ndim):
        number = number + _shifted(number, 1, axis) + _shifted(number, -1, axis)
    return number[(slice(1, -1),) * occupied.ndim]


def inner_and_outer_counts(voxels: Voxels) -> tuple[int, int]:
    """Numbers of the voxels that `inner_and_outer` gives of the occupied ones, counted in parts, of little memory."""
    nx, ny, nz = voxels.shape
    cells = voxels.cells[voxels.count > 0]
    inner = outer = 0
    for start in range(-1, nx + 1, LAYERS):
        stop = min(start + LAYERS, nx + 1)
        low, high = max(start - 1, 0), min(stop + 1, nx)
        first, last = np.searchsorted(cells, [low * ny * nz, high * ny * nz])
        if first == last:
            continue
        occupied = np.zeros((high - low, ny, nz), bool)
        occupied.flat[cells[first:last] - low * ny * nz] = True
        more_inner, more_outer = inner_and_outer(occupied)  # from the layer low - 1 on
        part = slice(start - low + 1, stop - low + 1)
        inner += int(np.count_nonzero(more_inner[part]))
        outer += int(np.count_nonzero(more_outer[part]))
    return inner, outer


def _shifted(voxels: np.ndarray, by: int, axis: int) -> np.ndarray:
    """The set moved by one voxel, what would leave the array lost."""
    moved = np.roll(voxels, by, axis)
    edge = [slice(None)] * voxels.ndim
    edge[axis] = slice(0, 1) if by > 0 else slice(-1, None)
    moved[tuple(edge)] = 0
    return moved
