"""What labels of placements and targets say: a row for each placement, their map, and the best of them."""

import math
from functools import cached_property
from typing import Any

import numpy as np
from scipy.ndimage import distance_transform_edt, maximum_filter1d

from wsrender.analyses.base_placement.job import BasePlacementJob
from wsrender.analyses.base_placement.score import Score
from wsrender.analyses.placed_bases import UNITS, grid_of
from wsrender.documents.placements import ANGLES, COORDINATES, TURN, PlacementSpace, TableEdge
from wsrender.reach.evidence import REACHABLE
from wsrender.reach.placements import Decided
from wsrender.volume.table import Table

DIGITS = 9
_COUNTED = ("served", "weight")
BLOCK = 1 << 20  # pairs of a placement and a target whose bits are told apart at a time


class PlacementMap:
    """The placements of a job by number, with the ``bits`` (P, B) uint8 of what is known of each target, by name.

    ``weights`` (K,): what targets count; ``score``: the index by which those are told apart that serve as much, of
    values ``scores`` (P,); None: none. ``second``: another index, and its scores (P,), which the Pareto set is of too.
    """

    def __init__(
        self,
        job: BasePlacementJob,
        weights: np.ndarray,
        bits: dict[str, np.ndarray],
        score: Score | None,
        scores: np.ndarray | None,
        second: tuple[Score, np.ndarray] | None = None,
    ):
        self.over, self.weights, self.bits, self.score, self.scores = job.over, weights, bits, score, scores
        self.second = second
        self.weighted = job.weights is not None or bool((weights != 1).any())
        self.edge = job.mounted if isinstance(job.mounting, TableEdge) else None  # where it holds bases, (X, Y)
        by_byte = np.ascontiguousarray(bits["served"].T)  # sums of long rows are faster
        self.served = np.bitwise_count(by_byte).sum(axis=0, dtype=np.int32)

    @cached_property
    def weight(self) -> np.ndarray:
        """Of the targets that each placement serves, (P,)."""
        if not self.weighted:
            return self.served.astype(np.float64)
        weights, bits = self.weights, self.bits["served"]
        each = max(1, BLOCK // len(weights))
        blocks = (bits[k : k + each] for k in range(0, len(bits), each))
        return np.concatenate([_unpacked(block, len(weights)) @ weights for block in blocks])

    @property
    def least_known(self) -> np.ndarray:
        """Labels (K,) from the placement whose undecided targets weigh the most, where none serves any."""
        undecided = [_unpacked(row[None], len(self.weights))[0] for row in np.unique(self.bits["undecided"], axis=0)]
        return np.where(max(undecided, key=lambda row: row @ self.weights), "undecided", "unreachable")

    @property
    def entry(self) -> dict[str, Any]:
        """How many there are, and how many pairs of a placement and a target have which label and reason."""
        K = len(self.weights)
        totals = {name: int(np.bitwise_count(bits).sum(dtype=np.int64)) for name, bits in self.bits.items()}
        blocked = {name.removeprefix("blocked_"): n for name, n in totals.items() if name.startswith("blocked_")}
        decided = totals["served"] + totals["undecided"] + sum(blocked.values())
        labels = {"served": totals["served"], **({"blocked": sum(blocked.values())} if blocked else {})}
        standing = self.over.count if self.edge is None else int(self.edge.sum()) * math.prod(self.over.shape[2:])
        return {
            "count": self.over.count,
            **({} if self.edge is None else {"on_the_edge": standing}),
            "targets": K,
            "shape": dict(zip(self.over.ranges, self._sizes, strict=True)),
            "labels": labels | {"unreachable": standing * K - decided, "undecided": totals["undecided"]},
            "proven": totals["proven"],
            "reasons": {name: n for name, n in blocked.items() if n},
            "most_served": int(self.served.max()),
            "serving_all": int((self.served == K).sum()),
        }

    @property
    def _sizes(self) -> list[int]:
        return [self.over.shape[COORDINATES.index(name)] for name in self.over.ranges]

    @property
    def table(self) -> Table:
        """A row for each placement, yaw first, x last."""
        columns = {name: self.over.column(name) for name in self.over.ranges} | self._values(slice(None))
        columns |= {f"{name}_bits": bits for name, bits in self.bits.items()}
        if self.edge is not None:
            columns["on_the_edge"] = np.repeat(self.edge.ravel(), math.prod(self.over.shape[2:])).astype(np.uint8)
        return Table(columns, self._units)

    def _columns(self, numbers: np.ndarray) -> dict[str, np.ndarray]:
        """Where placements stand, and what they serve, by number."""
        coordinates = self.over.coordinates(numbers)
        columns = {name: coordinates[:, COORDINATES.index(name)] for name in self.over.ranges}
        return columns | self._values(numbers)

    @property
    def pareto(self) -> Table:
        """A row for each placement of the Pareto set of the weight served and the score, the largest weight first.

        Of two indices that of both scores, among those that serve the largest weight, the best of the first first.
        """
        assert self.scores is not None
        if self.second:
            most = np.flatnonzero((weight := told_apart(self.weight)) == weight.max())
            numbers = most[pareto_set(self.scores[most], self.second[1][most])]
        else:
            numbers = pareto_set(self.weight, self.scores)
        return Table({"placement": numbers} | self._columns(numbers), self._units)

    def _values(self, numbers: Any) -> dict[str, np.ndarray]:
        """What placements serve, by number."""
        found = {"served": self.served[numbers]} | ({"weight": self.weight[numbers]} if self.weighted else {})
        for score, scores in self._scored:
            found[score.name] = score.sign * scores[numbers]
        return found

    @property
    def _scored(self) -> list[tuple[Score, np.ndarray]]:
        first = [(self.score, self.scores)] if self.score and self.scores is not None else []
        return first + ([self.second] if self.second else [])

    @property
    def _units(self) -> dict[str, str]:
        return {name: UNITS[name] for name in self.over.ranges} | {score.name: score.unit for score, _ in self._scored}

    @property
    def map(self) -> Table:
        """Over the first two ranges, in each cell the best of all placements, and how many are as good as any."""
        axes = list(self.over.ranges)[:2]
        shape = self._sizes[: len(axes)]
        order = self._order.reshape(*shape, -1)
        best = np.argmax(order, axis=-1).ravel()
        each = np.arange(len(best)) * order.shape[-1] + best
        columns = self._columns(each)
        columns["serving_all"] = (self.served.reshape(*shape, -1) == len(self.weights)).sum(axis=-1).ravel()
        return Table(columns, self._units, grid_of(self.over, axes))

    @cached_property
    def _order(self) -> np.ndarray:
        """Ranks of the placements (P,): by weight, then by the score; equal ones have one rank."""
        weight = told_apart(self.weight) if self.weighted else self.weight
        if self.scores is None:
            return weight
        rank = np.zeros(len(weight), np.int64)
        for values in (told_apart(self.scores), weight):
            rank = rank + np.unique(values, return_inverse=True)[1] * (rank.max() + 1)
        return rank

    @cached_property
    def best(self) -> int | None:
        """The best placement that is farthest, in steps, from those that are not; None: none serves any."""
        if not self.served.any():
            return None
        best = (self._order == self._order.max()).reshape(self._sizes or [1])
        frames, wraps = framed(self.over), [whole_turn(self.over, name) for name in self.over.ranges]
        for axis, wrap in enumerate(wraps):
            first = best.take([0], axis)
            if wrap and (best == first).all():  # what is alike all around is as deep in every direction
                best, frames[axis] = first, (0, 1, 0)
        sizes = best.shape
        for axis, (wrap, (before, _, after)) in enumerate(zip(wraps, frames, strict=True)):
            pads = [(before, after) if k == axis else (0, 0) for k in range(best.ndim)]
            best = np.pad(best, pads, mode="wrap") if wrap else np.pad(best, pads)
        depth = np.ones(best.shape) if best.all() else _depth(best)
        inner = tuple(slice(before, before + size) for before, size, _ in frames)
        deepest = np.unravel_index(np.argmax(depth[inner]), sizes)
        return int(np.ravel_multi_index(deepest, self._sizes or [1]))

    def best_cells(self, count: int) -> np.ndarray:
        """Numbers (B,) of the `best` placement, which there must be, and of others than which none beside is better."""
        if count == 1:
            return np.array([self.best])
        order = self._order.reshape(self._sizes or [1])
        highest = order
        for axis, name in enumerate(self.over.ranges):
            mode = "wrap" if whole_turn(self.over, name) else "nearest"
            highest = maximum_filter1d(highest, 3, axis, mode=mode)
        peaks = np.flatnonzero(order == highest)
        most = peaks[order.ravel()[peaks] == order.max()]
        peaks = most if len(most) > count else peaks
        peaks = peaks[np.argsort(-order.ravel()[peaks], kind="stable")]
        return np.array([self.best, *peaks[peaks != self.best]][:count])

    def entry_at(self, coordinates: np.ndarray, found: Decided) -> dict[str, Any]:
        """Coordinates (6,) [m and °] of any placement, and what it serves."""
        served = found.label == REACHABLE
        entry = dict(zip(COORDINATES, coordinates.tolist(), strict=True)) | {"served": int(served.sum())}
        entry["weight"] = float(self.weights[served].sum())
        return entry

    def entry_of(self, number: int) -> dict[str, Any]:
        """Coordinates of a placement, and what it serves."""
        coordinates = self.over.coordinates(np.array([number]))[0]
        return {
            "placement": number,
            **dict(zip(COORDINATES, coordinates.tolist(), strict=True)),
            "served": int(self.served[number]),
            "weight": float(self.weight[number]),
            **{name: float(value[0]) for name, value in self._values([number]).items() if name not in _COUNTED},
        }


def framed(over: PlacementSpace) -> list[tuple[int, int, int]]:
    """Of each range (before, size, after): how many values stand there while depths are found, and beside them.

    Beside those of a whole turn stand these themselves, a half at either end; beside others nothing, which is worse.
    """
    sizes = {name: over.shape[COORDINATES.index(name)] for name in over.ranges}
    beside = {name: size // 2 + 1 if whole_turn(over, name) else 1 for name, size in sizes.items()}
    return [(beside[name], size, beside[name]) for name, size in sizes.items()]


def _depth(best: np.ndarray) -> np.ndarray:
    """How far cells are from those that are not ``best``, of which only those beside the best are looked at."""
    ends = [np.flatnonzero(best.any(axis=tuple(k for k in range(best.ndim) if k != axis))) for axis in range(best.ndim)]
    box = tuple(slice(max(0, at[0] - 1), at[-1] + 2) for at in ends)
    depth = np.zeros(best.shape)
    depth[box] = distance_transform_edt(best[box])
    return depth


def whole_turn(over: PlacementSpace, name: str) -> bool:
    """Whether the last value of a coordinate stands beside the first."""
    covered = over.shape[COORDINATES.index(name)] * over.ranges[name][2]
    return name in ANGLES and abs(covered - TURN) < 1e-6


def told_apart(scores: np.ndarray) -> np.ndarray:
    """Scores (N,) that only differ where more than rounding does, relative to the largest; NaN is the least."""
    size = np.abs(scores[np.isfinite(scores)]).max(initial=0.0) or 1.0
    return np.nan_to_num(np.round(scores / size, DIGITS), nan=-np.inf)


def pareto_set(weight: np.ndarray, scores: np.ndarray) -> np.ndarray:
    """Numbers of the places that no other beats in one of two objectives (N,) without being worse in the other.

    The larger the better; what only rounding tells apart is equal, and NaN the least score. By weight, the largest
    first, then by number.
    """
    levels, level = np.unique(told_apart(weight), return_inverse=True)
    scores, best = told_apart(scores), np.full(len(levels), -np.inf)
    np.maximum.at(best, level, scores)
    above = np.append(np.maximum.accumulate(best[:0:-1])[::-1], np.nan)  # the best of those of more weight
    numbers = np.flatnonzero((scores == best[level]) & ~(best <= above)[level])
    return numbers[np.argsort(-level[numbers], kind="stable")]


def entry_of_pareto(job: BasePlacementJob, tables: dict[str, Table]) -> dict[str, Any]:
    """How many placements are in the Pareto set, and of how many pairs of values; nothing where none was asked for."""
    if "pareto" not in tables:
        return {}
    cells = tables["pareto"]
    objectives = objectives_of(job, cells)
    values = np.unique(told_apart(cells[objectives[0]]))  # to each belongs one of the other
    return {"pareto": {"objectives": objectives, "placements": len(cells), "values": len(values)}}


def objectives_of(job: BasePlacementJob, cells: Table) -> list[str]:
    """The two columns of placements that the Pareto set is of: how much is served and the index, or two indices."""
    return ["weight" if "weight" in cells.columns else "served", *job.indices][-2:]


def _unpacked(bits: np.ndarray, count: int) -> np.ndarray:
    return np.unpackbits(bits, axis=1, count=count, bitorder="little")


def least_value(value: np.ndarray) -> np.ndarray:
    """Of every placement the least value (P,) over the targets (P, K) that it serves; NaN where it serves none."""
    least = np.nan_to_num(value, nan=np.inf).min(axis=1)
    return np.where(np.isfinite(least), least, np.nan)
