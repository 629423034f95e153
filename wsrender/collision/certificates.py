"""What is proven of a pair over all configurations: never, always, or a table of where.

The signed distance changes by no more than its rates times the change of each coordinate (`levers`): a distance at the
middle of a box of configurations decides all of it where it exceeds what the box can change (Lipschitz).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import reduce

import numpy as np

from wsrender.collision.asked import counted
from wsrender.collision.distance import Distances
from wsrender.collision.grids import Lookup
from wsrender.collision.levers import Levers
from wsrender.collision.solids import Pairs
from wsrender.robots.chain import Chain

FREE, HIT, MIXED = 0, 1, 2
CELLS = 1024  # of a table, along each coordinate
FIRST_CELLS = 4
# What a cell's label leaves for float32: angles are off by an ulp or two (4e-6 rad), which moves half a metre by 2e-6.
SLACK_M = 2e-5
TRIED, LOOKED_AT = 64, 4096  # distances after which nobody tries to prove any more
AT_A_TIME = 128  # boxes
BEYOND = 1.01  # of what decides, where distances are cut: how far solids are beyond that takes time to tell


@dataclass(frozen=True, eq=False)
class LabelTable:
    """Labels (K1, K2) int8 of a pair over the ranges of two coordinates, FREE, HIT or MIXED; K2 = 1 of one alone."""

    pair: int
    coordinates: tuple[int, int]
    labels: np.ndarray


@dataclass(frozen=True, eq=False)
class Certificates:
    """Numbers of pairs that never collide by proof; tables of others; pairs that are left; which of both always do."""

    never: tuple[int, ...]
    always: tuple[int, ...]
    tables: tuple[LabelTable, ...]
    left: tuple[int, ...]


def certificates(
    pairs: Pairs, chain: Chain, distances: Distances, lookups: Mapping[int, Lookup] | None = None
) -> Certificates:
    """What is proven of every pair within the chain's limits, which must be finite.

    ``lookups``: of every pair with a surface, whose distances would take too long.
    """
    never, always, tables, left = [], [], [], []
    levers = Levers(chain)
    for number in counted(range(len(pairs.pairs))):
        pair = _Pair(pairs, number, levers, distances, (lookups or {}).get(number))
        # Neighbours are so near that their covers always touch; what stands around is hardly ever.
        most = 0 if pair.round or pair.lookup else 1 if pairs.around[pairs.reason[number]] else 2
        tabled = len(pair.coordinates) <= most
        if tabled:
            labels = pair.table()
            if (labels == FREE).all():
                never.append(number)
                continue
            tables.append(LabelTable(number, pair.two_coordinates, labels))
            if (labels == HIT).all():
                always.append(number)
        elif (proven := pair.proven()) == FREE:
            never.append(number)
        else:
            left.append(number)
            if proven == HIT:
                always.append(number)
    return Certificates(tuple(never), tuple(always), tuple(tables), tuple(left))


class _Pair:
    """A pair's distance as a function of the coordinates between its solids."""

    def __init__(self, pairs: Pairs, number: int, levers: Levers, distances: Distances, lookup: Lookup | None):
        self.a, self.b = (int(k) for k in pairs.pairs[number])
        self.solids, self.margin = pairs.solids, pairs.margin(number)
        self.chain, self.distances, self.lookup = levers.chain, distances, lookup
        own = levers.rates(self.solids[self.a], self.solids[self.b])
        self.coordinates = tuple(own)
        self.rate = np.array(list(own.values()))
        limits = self.chain.lower_limits, self.chain.upper_limits
        self.low, self.high = (limit[list(own)] for limit in limits)

    @property
    def round(self) -> bool:
        """Whether one test of two capsules decides it as well as a table."""
        return self.solids[self.a].is_round and self.solids[self.b].is_round

    @property
    def two_coordinates(self) -> tuple[int, int]:
        """Its coordinates; another beside a single one, over which a table has one cell."""
        first = self.coordinates[0] if self.coordinates else 0
        return first, self.coordinates[1] if len(self.coordinates) > 1 else first

    def distance(self, values: np.ndarray, limit: float) -> np.ndarray:
        """What is left of the distance over the margin (N,) [m], cut at ``limit``, at values (N, c) of the coordinates.

        Of a surface at least that, or 0.
        """
        q = np.tile((self.chain.lower_limits + self.chain.upper_limits) / 2, (len(values), 1))
        q[:, list(self.coordinates)] = values
        # In the frame that carries the first solid, which no joint before it moves; surfaces stand in the base's.
        a, b = self.solids[self.a], self.solids[self.b]
        steps = [self.chain.step(joint, q) for joint in range(a.joint + 1, b.joint + 1)]
        T = reduce(np.matmul, steps) if steps else np.tile(np.eye(4), (len(q), 1, 1))
        if self.lookup:
            return self.lookup.distance(T)
        T_a = np.broadcast_to(a.T, T.shape)
        return self.distances.between(self.a, self.b, T_a, T @ b.T, limit + self.margin) - self.margin

    def label(self, middle: np.ndarray, widths: np.ndarray) -> np.ndarray:
        """Of boxes of configurations around their middles (N, c), of widths (c,): FREE, HIT or MIXED (N,)."""
        change = float(self.rate @ widths) / 2 + SLACK_M
        distance = self.distance(middle, BEYOND * change)
        return np.where(distance > change, FREE, np.where(distance < -change, HIT, MIXED)).astype(np.int8)

    def table(self) -> np.ndarray:
        """Labels (K1, K2) of the cells, by a tree of cells of four."""
        count = len(self.coordinates)
        shape = tuple(CELLS if k < count else 1 for k in range(2))
        labels = np.full(shape, MIXED, np.int8)
        size = CELLS // FIRST_CELLS
        corners = np.stack(np.meshgrid(*(np.arange(0, edge, size) for edge in shape), indexing="ij"), -1).reshape(-1, 2)
        cell = (self.high - self.low) / CELLS
        while len(corners):
            found = self.label(self.low + (corners[:, :count] + size / 2) * cell, size * cell)
            for (i, j), label in zip(corners[found != MIXED].tolist(), found[found != MIXED].tolist(), strict=True):
                labels[i : i + size, j : j + size] = label
            corners = corners[found == MIXED]
            if size == 1:
                break
            size //= 2
            steps = np.stack(np.meshgrid(*((0, size) if k < count else (0,) for k in range(2)), indexing="ij"), -1)
            corners = (corners[:, None] + steps.reshape(1, -1, 2)).reshape(-1, 2)
        return labels

    def proven(self) -> int:
        """FREE or HIT where that is proven of all configurations, by halving boxes of them; else MIXED."""
        drawn = np.random.default_rng(0).random((TRIED, len(self.coordinates)))
        touching = self.distance(self.low + drawn * (self.high - self.low), SLACK_M) < 0
        if touching.any() and not touching.all():
            return MIXED
        sign = -1.0 if touching.all() else 1.0
        low, high, nearest, looked_at = self.low[None], self.high[None], np.zeros(1), 0
        while len(low):
            # The nearest first, where a counterexample would be.
            order = nearest.argsort(kind="stable")
            low, high, nearest = low[order], high[order], nearest[order]
            own_low, own_high = low[:AT_A_TIME], high[:AT_A_TIME]
            if looked_at + len(low) > LOOKED_AT:
                return MIXED
            looked_at += len(own_low)
            middle, change = (own_low + own_high) / 2, (own_high - own_low) / 2 * self.rate
            most = change.sum(axis=1) + SLACK_M
            distance = sign * self.distance(middle, BEYOND * float(most.max()))
            if (distance < 0).any():
                return MIXED
            open_ = distance <= most
            own_low, own_high, middle = own_low[open_], own_high[open_], middle[open_]
            rows, longest = np.arange(len(own_low)), change[open_].argmax(axis=1)
            left_high, right_low = own_high.copy(), own_low.copy()
            left_high[rows, longest] = right_low[rows, longest] = middle[rows, longest]
            low = np.concatenate([own_low, right_low, low[AT_A_TIME:]])
            high = np.concatenate([left_high, own_high, high[AT_A_TIME:]])
            nearest = np.concatenate([distance[open_], distance[open_], nearest[AT_A_TIME:]])
        return FREE if sign > 0 else HIT
