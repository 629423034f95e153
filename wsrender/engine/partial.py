"""Partial results of a sweep: integers that merge associatively, so the order of the parts does not matter."""

from dataclasses import dataclass, field, replace

import numpy as np
from wsrender_kernels.voxels import decode_extreme

NONE = 2**63 - 1  # the number of no sample


@dataclass(frozen=True, eq=False)
class Partial:
    """What a range of samples contributes; positions are relative to the plan's ``origin``.

    ``extremes`` (2 R,): largest value and largest complement, in ordered-integer form, of each of the R outputs: tip
    position (3), K indices and, if any, two singular values; ``totals`` (K,) int64: fixed-point sums. Of the occupied
    voxels, sorted by ``cells`` (V,) int64 (flat index in the lattice block): ``count`` (V,) int64, ``records`` (V, E)
    ordered integers, ``sums`` (V, K) int64. ``rows`` maps the first sample index of a chunk to its outputs (n_rows,
    samples). ``rejected`` (C,): samples by the first of the plan's constraints that they violate; they count in nothing
    else but ``samples``, and stay in the rows. ``earliest`` (C,): the number of the first of them, NONE where there is
    none; of the voxels that hold any, sorted by ``blocked_cells`` (B,), how many: ``blocked`` (B, C) int64. ``cut``
    (X,): of the evaluation's ``cuts``, how many values of admitted samples are cut. ``best`` (V,) int64: the number of
    the sample that has a voxel's largest value of the index at the place ``best_index``, the smallest among equals;
    (0,) and None where that is not kept.
    """

    samples: int
    extremes: np.ndarray
    totals: np.ndarray
    cells: np.ndarray
    count: np.ndarray
    records: np.ndarray
    sums: np.ndarray
    rows: dict[int, np.ndarray]
    rejected: np.ndarray = field(default_factory=lambda: np.zeros(0, np.int64))
    earliest: np.ndarray = field(default_factory=lambda: np.zeros(0, np.int64))
    blocked_cells: np.ndarray = field(default_factory=lambda: np.zeros(0, np.int64))
    blocked: np.ndarray = field(default_factory=lambda: np.zeros((0, 0), np.int64))
    cut: np.ndarray = field(default_factory=lambda: np.zeros(0, np.int64))
    best: np.ndarray = field(default_factory=lambda: np.zeros(0, np.int64))
    best_index: int | None = None

    @property
    def admitted(self) -> int:
        """Samples that no constraint rejects."""
        return self.samples - int(self.rejected.sum())

    @property
    def maximum(self) -> np.ndarray:
        """Largest value of each output, (R,)."""
        return decode_extreme(self.extremes[0::2], minimum=False)

    @property
    def minimum(self) -> np.ndarray:
        """Smallest value of each output, (R,)."""
        return decode_extreme(self.extremes[1::2], minimum=True)


def merge(a: Partial, b: Partial) -> Partial:
    """The partial result of both ranges of samples; associative and commutative, bit for bit."""
    cells, where_a, where_b = union(a.cells, b.cells)
    count = added(len(cells), (where_a, a.count), (where_b, b.count))
    lowest = -np.iinfo(a.records.dtype).max
    records = np.full((len(cells), a.records.shape[1]), lowest, a.records.dtype)
    records[where_a] = a.records
    records[where_b] = np.maximum(records[where_b], b.records)
    sums = added(len(cells), (where_a, a.sums), (where_b, b.sums))
    best = a.best
    if (k := a.best_index) is not None:
        highest, best = np.full(len(cells), lowest, a.records.dtype), np.full(len(cells), NONE)
        highest[where_a], best[where_a] = a.records[:, k], a.best
        best[where_b] = best_of(highest[where_b], best[where_b], b.records[:, k], b.best)
    blocked_cells, blocked_a, blocked_b = union(a.blocked_cells, b.blocked_cells)
    return Partial(
        a.samples + b.samples,
        np.maximum(a.extremes, b.extremes),
        a.totals + b.totals,
        cells,
        count,
        records,
        sums,
        {**a.rows, **b.rows},
        a.rejected + b.rejected,
        np.minimum(a.earliest, b.earliest),
        blocked_cells,
        added(len(blocked_cells), (blocked_a, a.blocked), (blocked_b, b.blocked)),
        a.cut + b.cut,
        best,
        a.best_index,
    )


def best_of(value: np.ndarray, best: np.ndarray, other_value: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Of two numbers (V,) of samples each that which has the larger value (V,), or the smaller one of equals."""
    return np.where(other_value > value, other, np.where(other_value == value, np.minimum(best, other), best))


def added(size: int, *parts: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    """Of so many voxels the sums of values (V,) or (V, K) int64 at places (V,), no two of which are alike."""
    total = np.zeros((size, *parts[0][1].shape[1:]), np.int64)
    for at, values in parts:
        total[at] += values
    return total


def joined(partials: list[Partial], voxels: int) -> Partial:
    """The partial result of a block from those of its slabs of so many voxels each, over the same samples."""
    if len(partials) == 1:
        return partials[0]
    return replace(
        partials[0],
        **{
            name: np.concatenate([getattr(partial, name) + slab * voxels for slab, partial in enumerate(partials)])
            for name in ("cells", "blocked_cells")
        },
        **{
            name: np.concatenate([getattr(p, name) for p in partials])
            for name in ("count", "records", "sums", "blocked", "best")
        },
    )


def union(a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Sorted union of two sorted sets of cells, and where the cells of each stand in it."""
    at = np.searchsorted(a, b)
    known = np.zeros(len(b), bool)
    inside = at < len(a)
    known[inside] = a[at[inside]] == b[inside]
    new = b[~known]
    where_a = np.arange(len(a)) + np.searchsorted(new, a)
    cells = np.empty(len(a) + len(new), np.int64)
    cells[where_a] = a
    where_b = at + np.cumsum(~known) - ~known
    cells[where_b] = b
    return cells, where_a, where_b
