"""What labels of placements and targets say: a row for each placement, their map, and the best of them."""

from functools import cached_property
from typing import Any

import numpy as np
from scipy.ndimage import distance_transform_edt

from wsrender.analyses.base_placement.job import BasePlacementJob
from wsrender.documents.placements import ANGLES, COORDINATES, TURN
from wsrender.volume.table import Grid, Table

UNITS = {name: "deg" if name in ANGLES else "m" for name in COORDINATES}
BLOCK = 1 << 18  # placements whose bits are told apart at a time


class PlacementMap:
    """The placements of a job by number, with the ``bits`` (P, B) uint8 of what is known of each target, by name."""

    def __init__(self, job: BasePlacementJob, bits: dict[str, np.ndarray]):
        self.job, self.over, self.bits = job, job.over, bits
        self.served = np.bitwise_count(bits["served"]).sum(axis=1, dtype=np.int32)

    @cached_property
    def weight(self) -> np.ndarray:
        """Of the targets that each placement serves, (P,)."""
        if self.job.weights is None:
            return self.served.astype(np.float64)
        weights, bits = np.array(self.job.weights), self.bits["served"]
        blocks = (bits[k : k + BLOCK] for k in range(0, len(bits), BLOCK))
        return np.concatenate([_unpacked(block, len(weights)) @ weights for block in blocks])

    @property
    def entry(self) -> dict[str, Any]:
        """How many there are, and how many pairs of a placement and a target have which label and reason."""
        K = len(self.job.points_m)
        totals = {name: int(np.bitwise_count(bits).sum(dtype=np.int64)) for name, bits in self.bits.items()}
        blocked = {name.removeprefix("blocked_"): n for name, n in totals.items() if name.startswith("blocked_")}
        decided = totals["served"] + totals["undecided"] + sum(blocked.values())
        labels = {"served": totals["served"], **({"blocked": sum(blocked.values())} if blocked else {})}
        return {
            "count": self.over.count,
            "targets": K,
            "shape": dict(zip(self.over.ranges, self._sizes, strict=True)),
            "labels": labels | {"unreachable": self.over.count * K - decided, "undecided": totals["undecided"]},
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
        coordinates = self.over.coordinates(np.arange(self.over.count))
        columns = {name: coordinates[:, COORDINATES.index(name)] for name in self.over.ranges}
        columns |= {"served": self.served} | ({"weight": self.weight} if self.job.weights else {})
        columns |= {f"{name}_bits": bits for name, bits in self.bits.items()}
        return Table(columns, {name: UNITS[name] for name in self.over.ranges})

    @property
    def map(self) -> Table:
        """Over the first two ranges, in each cell the best of all placements, and how many are as good as any."""
        axes = list(self.over.ranges)[:2]
        shape = self._sizes[: len(axes)]
        weight = self.weight.reshape(*shape, -1)
        best = np.argmax(weight, axis=-1).ravel()
        each = np.arange(len(best)) * weight.shape[-1] + best
        coordinates = self.over.coordinates(each)
        columns = {name: coordinates[:, COORDINATES.index(name)] for name in self.over.ranges}
        columns |= {"served": self.served[each]} | ({"weight": self.weight[each]} if self.job.weights else {})
        columns["serving_all"] = (self.served.reshape(*shape, -1) == len(self.job.points_m)).sum(axis=-1).ravel()
        steps = [self.over.ranges[name][2] for name in axes]
        origin = [self.over.values(name)[0] - step / 2 for name, step in zip(axes, steps, strict=True)]
        grid = Grid(tuple(axes), tuple(map(float, origin)), tuple(steps), tuple(shape))
        return Table(columns, {name: UNITS[name] for name in self.over.ranges}, grid)

    @property
    def best(self) -> int | None:
        """The placement of the largest weight that is farthest, in steps, from those of less; None: none serves any."""
        if not self.served.any():
            return None
        best = (self.weight == self.weight.max()).reshape(self._sizes or [1])
        around = [(size // 2 + 1, size // 2 + 1) if self._whole_turn(name) else (1, 1)
                  for name, size in zip(self.over.ranges, self._sizes, strict=True)]  # fmt: skip
        for axis, (name, pad) in enumerate(zip(self.over.ranges, around, strict=True)):
            pads = [pad if k == axis else (0, 0) for k in range(best.ndim)]
            best = np.pad(best, pads, mode="wrap") if self._whole_turn(name) else np.pad(best, pads)
        depth = np.ones(best.shape) if best.all() else distance_transform_edt(best)
        inner = tuple(slice(before, size - after) for (before, after), size in zip(around, best.shape, strict=False))
        return int(np.argmax(np.asarray(depth)[inner]))

    def _whole_turn(self, name: str) -> bool:
        """Whether the last value of a coordinate stands beside the first."""
        covered = self.over.shape[COORDINATES.index(name)] * self.over.ranges[name][2]
        return name in ANGLES and abs(covered - TURN) < 1e-6

    def entry_of(self, number: int) -> dict[str, Any]:
        """Coordinates of a placement, and what it serves."""
        coordinates = self.over.coordinates(np.array([number]))[0]
        return {
            "placement": number,
            **dict(zip(COORDINATES, coordinates.tolist(), strict=True)),
            "served": int(self.served[number]),
            "weight": float(self.weight[number]),
        }


def _unpacked(bits: np.ndarray, count: int) -> np.ndarray:
    return np.unpackbits(bits, axis=1, count=count, bitorder="little")
