"""What a kernel asks of every configuration: flat arrays of capsules, tests between them, tables, and hulls.

Tests are certified: two solids are apart where all capsules around them are, and touch where any two within them do.
What neither says is open for this pair, and goes on to the narrow phase.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from wsrender.collision.asked import counted
from wsrender.collision.certificates import CELLS, FREE, Certificates, certificates
from wsrender.collision.covers import LEVELS, Capsules, Cover, covers
from wsrender.collision.crowd import Crowd, crowd, crowded, wide_boxes
from wsrender.collision.distance import Distances, frames_of
from wsrender.collision.grids import DistanceGrid, Lookup, lookup, reach_of, surface_grid
from wsrender.collision.segments import SHORT, axes_distance, box_distance
from wsrender.collision.solids import BASE, Pairs, Solid
from wsrender.collision.supports import center_of, core, vertices_by_direction
from wsrender.robots.chain import Chain
from wsrender.robots.triangles import tree

DRAWN = 4096  # configurations over which the levels of covers are chosen
# Of an open pair in the narrow phase, measured in tests of two capsules.
OPEN_COST = 200.0
NAMED_COST = 10.0  # of a test of one sample by itself, likewise
EPSILON = 5e-6  # of the reach, at least 2 m: what positions in float32 may be off [m]
RARELY = 0.04  # so that in a quarter of all cases or more none of 32 lanes is
ABSENT = -1.0  # a squared distance that nothing falls below
ALIGNED = 1e-9  # of a unit vector's coordinates
KIND = {"sphere": 3, "capsule": 3, "cylinder": 3, "box": 3, "hull": 0, "ellipsoid": 1, "half_space": 2, "surface": 4}


@dataclass(frozen=True, eq=False)
class Program:
    """Arrays of the kernels: float32, int32, uint32 (``table_words``), and float64 what the narrow phase computes with.

    ``joints`` (L, 15): rotation (9) and translation (3) before the motion, scale, offset, 1 where it turns;
    ``sources`` (L,); ``lower``, ``upper`` (n,). ``capsules`` (C, 6): middle and unit axis in the frame of
    ``capsule_frame`` (C,), 0 of the base; ``capsule_axis`` (C,): where this is an axis of the frame, 12 times the
    frame's number plus 0, 3 or 6, else -1. ``pairs`` (T, 3): pair, first test, tests; then
    ``planes`` (U, 3): pair, first test, tests; ``tests`` (t, 2): capsules, or half-space's capsule and capsule;
    ``test_numbers`` (t, 5): half lengths of both axes; squared distances below which they are near and hit (distances,
    of planes), and of their middles above which they are not near, where that is worth a test, else 0.
    ``tables`` (K, 4): pair, two coordinates, first word; ``table_numbers`` (K, 4): lowest value and cells per unit of
    both; ``table_columns`` (K,); ``table_words``.
    ``solid_frame`` (S,), ``solids`` (S, 18): rotation and translation in its joint, radius, disc, kind, half a segment
    within it, about its middle; ``solid_sizes`` (S, 3): half axes of an ellipsoid, else half of what its points span;
    ``vertices`` (V,), ``vertex_range`` (S, cells, 2): see `vertices_by_direction`; ``solid_pairs`` (P, 2);
    ``pair_kinds`` (P,): the same number where both solids are of the same kinds; ``pair_ranks`` (P,): by them;
    ``pair_numbers`` (P, 2): margin, reason. Of surfaces: ``lookups`` (Q, 5): pair, grid, joint from 1, first ball,
    balls; ``balls`` as `Lookup.balls`; ``grid_numbers`` (G, 4): origin and cell; ``grid_shapes`` (G, 4): cells along
    each axis, first word; ``grid_words``; ``nodes`` and ``node_links`` as `Tree.balls` and `Tree.links`, in the base's
    frame, of the rows of ``triangles`` (F, 9); a surface's ``vertex_range`` is first of its nodes, first and end;
    ``solid_capsules`` (S, 7): middle and half axis in its joint and radius of a capsule around a solid that may meet
    one. Of a `Crowd`: ``crowd_numbers`` (4,): origin and cell; ``crowd_shape`` (3,); ``crowd_words``; ``crowd_sets``
    (K, W), ``crowd_first`` (K,) the first bit of each; ``crowd_rows`` (M, 3) of those that move: joint from 1, first
    ball, balls; ``crowd_balls`` (B, 4), ``crowd_ball_rows`` (B,) the row of each; ``crowd_boxes`` (E, 16): axes, middle
    and half sizes of boxes, which a radius makes wide; ``crowd_pairs`` (M * 32 W, 5) of each with each that stands:
    pair or -1, first test and number outside, the same inside, none where those outside say both; its ``tests`` are of
    a box and a capsule. With it the first ``alone`` of ``pairs`` and ``moving`` capsules are enough.
    ``epsilon``: what float32 may be off [m]; ``columns``: cells of a table along its first coordinate; ``never``,
    ``always``: pairs by proof.
    """

    joints: np.ndarray
    sources: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    capsules: np.ndarray
    capsule_frame: np.ndarray
    capsule_axis: np.ndarray
    pairs: np.ndarray
    planes: np.ndarray
    tests: np.ndarray
    test_numbers: np.ndarray
    tables: np.ndarray
    table_numbers: np.ndarray
    table_columns: np.ndarray
    table_words: np.ndarray
    solid_frame: np.ndarray
    solids: np.ndarray
    solid_sizes: np.ndarray
    vertices: np.ndarray
    vertex_range: np.ndarray
    solid_pairs: np.ndarray
    pair_kinds: np.ndarray
    pair_ranks: np.ndarray
    pair_numbers: np.ndarray
    lookups: np.ndarray
    balls: np.ndarray
    grid_numbers: np.ndarray
    grid_shapes: np.ndarray
    grid_words: np.ndarray
    nodes: np.ndarray
    node_links: np.ndarray
    triangles: np.ndarray
    solid_capsules: np.ndarray
    crowd_numbers: np.ndarray
    crowd_shape: np.ndarray
    crowd_words: np.ndarray
    crowd_sets: np.ndarray
    crowd_first: np.ndarray
    crowd_rows: np.ndarray
    crowd_balls: np.ndarray
    crowd_ball_rows: np.ndarray
    crowd_boxes: np.ndarray
    crowd_pairs: np.ndarray
    epsilon: float
    moving: int
    alone: int
    columns: int
    never: np.ndarray
    always: np.ndarray

    @property
    def nbytes(self) -> int:
        """Bytes of all arrays."""
        return sum(value.nbytes for value in vars(self).values() if isinstance(value, np.ndarray))

    @property
    def root(self) -> int:
        """The lowest frame that a solid of any pair is in."""
        return int(self.solid_frame[self.solid_pairs].min(initial=len(self.sources)))


def program(pairs: Pairs, chain: Chain, distances: Distances | None = None) -> Program:
    """The program of pairs of a chain: grids, proofs, tables and covers are made here, which takes seconds."""
    epsilon, made = EPSILON * max(2.0, _extent(pairs, chain)), _Covers(pairs.solids)
    lookups = _lookups(pairs, made, epsilon)
    known = certificates(pairs, chain, distances or Distances(pairs.solids), lookups)
    convex = [pair for pair in known.left if pair not in lookups]
    made.add({int(k) for pair in convex for k in pairs.pairs[pair]})
    chosen = _Chosen(pairs, chain, made.made)
    levels = {pair: chosen.levels(pair) for pair in convex}
    left = {pair: lookups[pair] for pair in known.left if pair in lookups}
    named = {pair: chosen.levels(pair, NAMED_COST) for pair in crowded(pairs, convex)}
    many = crowd(pairs, named, made.made, _links(chain), epsilon) if named else None
    return _packed(pairs, chain, known, made.made, levels, chosen, left, many, named, epsilon)


class _Covers:
    """Covers of solids by number, ``made`` when they are first asked for; those of a form are one."""

    def __init__(self, solids: tuple[Solid, ...]):
        self.solids, self.made = solids, dict[int, Cover]()
        self._alike: dict[tuple[object, ...], Cover] = {}

    def add(self, numbers: Iterable[int]) -> None:
        """Make the covers of solids but half-spaces, where they are not."""
        wanted = [k for k in sorted(numbers) if k not in self.made and self.solids[k].kind != "half_space"]
        forms = {k: self._form(self.solids[k]) for k in wanted}
        new = {form: self.solids[k] for k, form in forms.items() if form not in self._alike}
        self._alike |= zip(new, covers(list(new.values())), strict=True)
        self.made |= {k: self._alike[form] for k, form in forms.items()}

    def of(self, number: int) -> Cover:
        """The cover of a solid."""
        self.add([number])
        return self.made[number]

    @staticmethod
    def _form(solid: Solid) -> tuple[object, ...]:
        return solid.kind, solid.size.tobytes(), solid.points.tobytes()


def _lookups(pairs: Pairs, made: _Covers, epsilon: float) -> dict[int, Lookup]:
    """By pair with a surface, how its other solid is looked up."""
    found: dict[int, Lookup] = {}
    surfaces = [k for k, solid in enumerate(pairs.solids) if solid.kind == "surface"]
    made.add({int(b) for a, b in pairs.pairs if a in surfaces})
    for surface in counted(surfaces):
        own = [(k, int(pairs.pairs[k, 1])) for k in np.flatnonzero(pairs.pairs[:, 0] == surface).tolist()]
        if not own:
            continue
        pad = max(reach_of(made.of(solid), pairs.margin(pair)) for pair, solid in own)
        grid = surface_grid(_in_base(pairs.solids[surface]), pad)
        for pair, number in own:
            solid = pairs.solids[number]
            found[pair] = lookup(grid, solid.joint, solid.T, made.of(number), pairs.margin(pair), epsilon)
    return found


def _in_base(surface: Solid) -> np.ndarray:
    """Corners (F, 3, 3) of a surface's triangles in the base's frame."""
    return surface.corners @ surface.T[:3, :3].T + surface.T[:3, 3]


def _extent(pairs: Pairs, chain: Chain) -> float:
    """Upper bound of the coordinates that points have of any solid but half-spaces, and of these their origins' [m]."""
    sizes = [solid.bounding_radius if np.isfinite(solid.bounding_radius) else 0.0 for solid in pairs.solids]
    own = [np.linalg.norm(solid.T[:3, 3]) + size for solid, size in zip(pairs.solids, sizes, strict=True)]
    return _links(chain) + float(max(own, default=0.0))


def _links(chain: Chain) -> float:
    """Upper bound of how far the origins of joints are from the base's [m]."""
    return float(np.linalg.norm(chain.T_joint[:, :3, 3], axis=1).sum() + chain.largest_slide.sum())


class _Chosen:
    """Levels of covers by what they cost over drawn configurations."""

    def __init__(self, pairs: Pairs, chain: Chain, covers: dict[int, Cover]):
        self.pairs, self.covers = pairs, covers
        drawn = np.random.default_rng(0).random((DRAWN, chain.n))
        self.frames = frames_of(chain, chain.lower_limits + drawn * (chain.upper_limits - chain.lower_limits))
        self._turned: dict[int, np.ndarray] = {}
        self._placed: dict[tuple[int, str, int], tuple[np.ndarray, np.ndarray, np.ndarray]] = {}

    def levels(self, pair: int, alone: float = 0.0) -> tuple[int, int | None]:
        """Levels of the covers outside and inside with the least expected cost; None: none inside.

        ``alone``: what a test costs where it is made of those samples alone in which the solids are near; 0: of all.
        Alone, a box that stands is its own cover.
        """
        a, b = self.pairs.pairs[pair]
        margin = self.pairs.margin(pair)
        kinds, itself = [self.pairs.solids[k].kind for k in (a, b)], alone > 0
        as_one = {"half_space", "box"} if itself else {"half_space"}
        exact = (kinds[0] in as_one or self.covers[a].exact) and (kinds[1] == "half_space" or self.covers[b].exact)
        if exact:
            return 0, 0
        tests, close = self._below(a, b, "outer", 0, margin, None, itself)
        if (not alone and OPEN_COST * close.mean() <= tests) or not close.any():
            return 0, None
        # What is not looked at is beyond all capsules; alone, what the first tests leave is all that there is.
        at = np.flatnonzero(close if alone else self._near(a, b, margin))
        count, share = (len(at), close.mean()) if alone else (DRAWN, 1.0)
        first, open_cost = alone * share or 1.0, OPEN_COST * share
        near, hit = (
            [self._below(a, b, side, level, margin, at, itself) for level in range(len(LEVELS))]
            for side in ("outer", "inner")
        )
        choices = []
        for outer, (tests, close) in enumerate(near):
            second = first * close.sum() / count if alone else 1.0
            choices.append((first * tests + open_cost * close.sum() / count, outer, None))
            choices += [
                (first * tests + second * more + open_cost * (close & ~touching).sum() / count, outer, inner)
                for inner, (more, touching) in enumerate(hit)
            ]
        _, outer, inner = min(choices, key=lambda each: each[0])
        return outer, inner

    def _near(self, a: int, b: int, margin: float) -> np.ndarray:
        """At which (N,) configurations balls around all capsules of two solids are near; of half-spaces at all."""
        if self.pairs.solids[a].kind == "half_space":
            return np.ones(DRAWN, bool)
        (middle_a, radius_a), (middle_b, radius_b) = self._ball(a), self._ball(b)
        between = middle_a - middle_b
        return _dot(between, between) < (radius_a + radius_b + margin) ** 2

    def _ball(self, solid: int) -> tuple[np.ndarray, float]:
        """Middles (3, N) and radius of a ball around a solid's capsules of all levels."""
        levels = [self._capsules(solid, "outer", level) for level in range(len(self.covers[solid].outer))]
        center = levels[0][0][0]
        placed = [each for level in levels for each in zip(*level, strict=True)]
        return center, max(_length(middle - center) + _length(half) + radius for middle, half, radius in placed)

    def _below(
        self, a: int, b: int, side: str, level: int, margin: float, at: np.ndarray | None, itself: bool
    ) -> tuple[int, np.ndarray]:
        """Number of tests, and at which (N,) configurations any of them is below the sum of radii.

        ``at``: at these alone; ``itself``: against a box that stands itself, not its cover.
        """
        below = np.zeros(DRAWN if at is None else len(at), bool)
        middle_b, half_b, radius_b = self._capsules(b, side, level, at)
        if self.pairs.solids[a].kind == "half_space":
            T = self.pairs.solids[a].T
            for k, radius in enumerate(radius_b):
                height = T[:3, 2] @ middle_b[k] - T[:3, 3] @ T[:3, 2]
                below |= height - np.abs(T[:3, 2] @ half_b[k]) < radius + margin
            return len(radius_b), below
        if itself and self.pairs.solids[a].kind == "box":
            T, size = self.pairs.solids[a].T, self.pairs.solids[a].size
            for k, radius in enumerate(radius_b):
                apart = box_distance((middle_b[k].T - T[:3, 3]) @ T[:3, :3], half_b[k].T @ T[:3, :3], size)
                below |= apart < radius + margin
            return len(radius_b), below
        middle_a, half_a, radius_a = self._capsules(a, side, level, at)
        for i, k in np.ndindex(len(radius_a), len(radius_b)):
            # Of the axes only where the balls around both are near, and no test before has answered.
            sum_ = radius_a[i] + radius_b[k] + margin
            reach = sum_ + _length(half_a[i]) + _length(half_b[k])
            between = middle_a[i] - middle_b[k]
            asked = np.flatnonzero((_dot(between, between) < reach**2) & ~below)
            if len(asked):
                axes = (each[:, asked].T for each in (middle_a[i], half_a[i], middle_b[k], half_b[k]))
                below[asked] = axes_distance(*axes) < sum_
        return len(radius_a) * len(radius_b), below

    def mostly_far(self, pair: int, level: int, epsilon: float) -> list[float]:
        """Of each test outside the squared distance of middles above which none touches, 0 where many are nearer."""
        a, b = self.pairs.pairs[pair]
        (middle_a, half_a, radius_a), (middle_b, half_b, radius_b) = (self._capsules(k, "outer", level) for k in (a, b))
        found, everywhere = [], self.pairs.margin(pair) + 2 * epsilon
        for i, k in np.ndindex(len(radius_a), len(radius_b)):
            lengths = _length(half_a[i]) + _length(half_b[k])
            far = radius_a[i] + radius_b[k] + lengths + everywhere
            between = middle_a[i] - middle_b[k]
            near = _dot(between, between) < far**2
            found.append(far**2 if lengths > 0 and near.mean() < RARELY else 0.0)
        return found

    def _capsules(
        self, solid: int, side: str, level: int, at: np.ndarray | None = None
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Middles and half axes (C, 3, N) in the base's frame, radii (C,); of all configurations or those ``at``."""
        level = 0 if self.covers[solid].exact else level
        key = (solid, side, level)
        if key not in self._placed:
            own, frame = self.pairs.solids[solid], self.pairs.solids[solid].joint + 1
            capsules: Capsules = getattr(self.covers[solid], side)[level]
            if frame not in self._turned:
                self._turned[frame] = np.ascontiguousarray(self.frames[:, frame, :3].transpose(2, 1, 0))
            a, b = (end @ own.T[:3, :3].T + own.T[:3, 3] for end in (capsules.a, capsules.b))
            *R, p = self._turned[frame]
            middle, half = (np.tensordot(each, R, axes=1) for each in ((a + b) / 2, (b - a) / 2))
            self._placed[key] = middle + p, half, capsules.radius
        middle, half, radius = self._placed[key]
        return (middle, half, radius) if at is None else (middle[..., at], half[..., at], radius)


def _dot(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Products (N,) of vectors (3, N)."""
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]


def _length(turned: np.ndarray) -> float:
    """Of a vector that is turned, (3, N) with N > 0."""
    return float(np.linalg.norm(turned[:, 0]))


class _Rows:
    """Capsules and tests as they come."""

    def __init__(self, pairs: Pairs, covers: dict[int, Cover]):
        self.solids, self.covers = pairs.solids, covers
        self.numbers: dict[tuple[int, str, int, int], int] = {}
        self.capsules: list[tuple[int, np.ndarray, float, float]] = []  # frame, numbers, half length, radius
        self.tests: list[tuple[int, int]] = []
        self.test_numbers: list[list[float]] = []

    def of(self, solid: int, side: str, level: int) -> list[int]:
        """Numbers of the capsules of a solid's cover."""
        exact = self.covers[solid].exact
        side, level = ("outer", 0) if exact else (side, level)
        capsules: Capsules = getattr(self.covers[solid], side)[level]
        own, found = self.solids[solid], []
        for k, (a, b, radius) in enumerate(zip(capsules.a, capsules.b, capsules.radius, strict=True)):
            key = (solid, side, level, k)
            if key not in self.numbers:
                middle = own.T[:3, :3] @ ((a + b) / 2) + own.T[:3, 3]
                half = own.T[:3, :3] @ ((b - a) / 2)
                half *= -1 if half[np.abs(half).argmax()] < 0 else 1
                self._add(key, own.joint, middle, half, float(radius))
            found.append(self.numbers[key])
        return found

    def plane(self, solid: int) -> int:
        """Number of the row that holds a point of a half-space's border and its normal."""
        key, own = (solid, "plane", 0, 0), self.solids[solid]
        if key not in self.numbers:
            self._add(key, own.joint, own.T[:3, 3], own.T[:3, 2], 0.0)
        return self.numbers[key]

    def _add(self, key: tuple[int, str, int, int], joint: int, middle: np.ndarray, half: np.ndarray, r: float) -> None:
        self.numbers[key] = len(self.capsules)
        length = float(np.linalg.norm(half))
        axis = half / length if length > SHORT else np.array([1.0, 0.0, 0.0])
        self.capsules.append((joint - BASE, np.r_[middle, axis], length if length > SHORT else 0.0, r))


def _packed(
    pairs: Pairs,
    chain: Chain,
    known: Certificates,
    covers: dict[int, Cover],
    levels: dict[int, tuple[int, int | None]],
    chosen: _Chosen,
    lookups: dict[int, Lookup],
    many: Crowd | None,
    named: dict[int, tuple[int, int | None]],
    epsilon: float,
) -> Program:
    rows = _Rows(pairs, covers)
    pair_rows, plane_rows = [], []
    for pair in levels:
        if pairs.solids[pairs.pairs[pair][0]].kind == "half_space":
            plane_rows.append(_plane_tests(rows, pairs, pair, levels[pair], epsilon))
        elif pair not in named:
            pair_rows.append(_capsule_tests(rows, pairs, pair, levels[pair], chosen, epsilon))
    beside: set[int] = set()
    for pair, (outer, inner) in named.items():
        for side, level in (("outer", outer), ("inner", inner)):
            if level is not None:
                beside.update(rows.of(int(pairs.pairs[pair][1]), side, level))
    moving, alone = len(rows.capsules), len(pair_rows)
    crowd_rows = _crowd(many, rows, pairs, named, epsilon)
    pair_rows += [_capsule_tests(rows, pairs, pair, levels[pair], chosen, epsilon) for pair in named]
    tables = [table for table in known.tables if not (table.labels == FREE).all()]
    words, numbers, columns, table_rows = [], [], [], []
    for table in tables:
        ranges = [(chain.lower_limits[k], chain.upper_limits[k]) for k in table.coordinates]
        per_unit = [
            edge / (high - low) if edge > 1 else 0.0
            for edge, (low, high) in zip(table.labels.shape, ranges, strict=True)
        ]
        table_rows.append([table.pair, *table.coordinates, sum(map(len, words))])
        numbers.append([ranges[0][0], per_unit[0], ranges[1][0], per_unit[1]])
        columns.append(table.labels.shape[1])
        words.append(_words(table.labels))
    vertices, vertex_range = vertices_by_direction(pairs.solids)
    kinds = np.array([KIND[solid.kind] for solid in pairs.solids])[pairs.pairs] @ (len(KIND), 1)
    met = {int(pairs.pairs[pair][1]) for pair in lookups}
    placed = [solid.T @ _shift(center_of(solid)) for solid in pairs.solids]  # the narrow phase starts at the origins
    joints = [
        [*T[:3, :3].ravel(), *T[:3, 3], scale, offset, float(turns)]
        for T, scale, offset, turns in zip(
            chain.T_joint, chain.joint_scale, chain.joint_offset, chain.joint_is_revolute, strict=True
        )
    ]
    return Program(
        joints=_d(joints, 15),
        sources=np.array(chain.joint_source, np.int32),
        lower=np.array(chain.lower_limits, np.float32),
        upper=np.array(chain.upper_limits, np.float32),
        **crowd_rows,
        moving=moving,
        alone=alone,
        capsules=_f([numbers for _, numbers, *_ in rows.capsules], 6),
        capsule_frame=np.array([frame for frame, *_ in rows.capsules], np.int32),
        capsule_axis=np.array(
            [
                -1 if number in beside else _axis_of_frame(frame, numbers[3:])
                for number, (frame, numbers, *_) in enumerate(rows.capsules)
            ],
            np.int32,
        ),
        pairs=_i(pair_rows, 3),
        planes=_i(plane_rows, 3),
        tests=_i(rows.tests, 2),
        test_numbers=_f(rows.test_numbers, 5),
        tables=_i(table_rows, 4),
        table_numbers=_f(numbers, 4),
        table_columns=np.array(columns, np.int32),
        table_words=np.concatenate([np.zeros(0, np.uint32), *words]),
        solid_frame=np.array([solid.joint - BASE for solid in pairs.solids], np.int32),
        solids=_d(
            [
                [*T[:3, :3].ravel(), *T[:3, 3], s.radius, s.disc, KIND[s.kind], *core(s)]
                for T, s in zip(placed, pairs.solids, strict=True)
            ],
            18,
        ),
        solid_sizes=_d([s.size if s.kind == "ellipsoid" else np.ptp(s.points, axis=0) / 2 for s in pairs.solids], 3),
        vertices=vertices,
        **_surfaces(pairs.solids, vertex_range, {int(pairs.pairs[pair][0]) for pair in lookups}),
        **_looked_up(lookups),
        solid_capsules=_d([_capsule(s, covers[k] if k in met else None) for k, s in enumerate(pairs.solids)], 7),
        solid_pairs=_i(pairs.pairs, 2),
        pair_kinds=kinds.astype(np.int32),
        pair_ranks=kinds.argsort(kind="stable").argsort().astype(np.int32),
        pair_numbers=_d([[pairs.margin(k), pairs.reason[k]] for k in range(len(pairs.pairs))], 2),
        epsilon=epsilon,
        columns=CELLS,
        never=np.array(known.never, np.int32),
        always=np.array(known.always, np.int32),
    )


def _capsule_tests(
    rows: _Rows, pairs: Pairs, pair: int, levels: tuple[int, int | None], chosen: _Chosen, epsilon: float
) -> list[int]:
    """Tests of a pair, of each the longer capsule first; its row."""
    a, b = (int(k) for k in pairs.pairs[pair])
    first, (outer, inner) = len(rows.tests), levels
    found = _between(rows, pairs, pair, "outer", outer, epsilon)
    for (_, numbers), far in zip(found, chosen.mostly_far(pair, outer, epsilon), strict=True):
        numbers[-1] = far
    if inner is not None and not (rows.covers[a].exact and rows.covers[b].exact):
        found += _between(rows, pairs, pair, "inner", inner, epsilon)
    for (i, k), (length, other, *bounds) in found:
        rows.tests.append((i, k) if length >= other else (k, i))
        rows.test_numbers.append([max(length, other), min(length, other), *bounds])
    return [pair, first, len(found)]


def _between(
    rows: _Rows, pairs: Pairs, pair: int, side: str, level: int, epsilon: float
) -> list[tuple[tuple[int, int], list[float]]]:
    """Tests of the capsules outside or inside of a pair."""
    a, b = (int(k) for k in pairs.pairs[pair])
    exact, found = rows.covers[a].exact and rows.covers[b].exact, []
    for i in rows.of(a, side, level):
        for k in rows.of(b, side, level):
            sum_ = rows.capsules[i][3] + rows.capsules[k][3] + pairs.margin(pair)
            bounds = _bounds(sum_, side, exact, epsilon)
            found.append(((i, k), [rows.capsules[i][2], rows.capsules[k][2], *bounds, 0.0]))
    return found


class _Boxes:
    """Wide boxes in place of what stands, as they come: half sizes of 0 make a capsule or a ball of one."""

    def __init__(self, pairs: Pairs, covers: dict[int, Cover]):
        self.pairs, self.covers = pairs, covers
        self.rows: list[np.ndarray] = []
        self._numbers: dict[tuple[int, str, int], list[tuple[int, float]]] = {}

    def exact(self, solid: int) -> bool:
        """Whether its boxes are the solid."""
        return self.pairs.solids[solid].kind == "box" or self.covers[solid].exact

    def of(self, solid: int, side: str, level: int) -> list[tuple[int, float]]:
        """Numbers and radii of the boxes in place of a solid's cover."""
        key = (solid, "outer", 0) if self.exact(solid) else (solid, side, level)
        if key not in self._numbers:
            found = wide_boxes(self.pairs.solids[solid], getattr(self.covers[solid], key[1])[key[2]])
            self._numbers[key] = [(len(self.rows) + k, radius) for k, (_, radius) in enumerate(found)]
            self.rows += [row for row, _ in found]
        return self._numbers[key]


def _beside(
    rows: _Rows, boxes: _Boxes, pair: int, side: str, level: int, epsilon: float
) -> list[tuple[tuple[int, int], list[float]]]:
    """Tests of wide boxes and the capsules outside or inside of what moves beside them."""
    a, b = (int(k) for k in boxes.pairs.pairs[pair])
    exact, margin, found = boxes.exact(a) and rows.covers[b].exact, boxes.pairs.margin(pair), []
    for box, radius in boxes.of(a, side, level):
        for k in rows.of(b, side, level):
            near, hit = _bounds(radius + rows.capsules[k][3] + margin, side, exact, epsilon)
            found.append(((box, k), [0.0, rows.capsules[k][2], near, hit, 0.0]))
    return found


def _bounds(apart: float, side: str, exact: bool, epsilon: float) -> tuple[float, float]:
    """Squared distances of axes below which a pair is near, and hit."""
    near = (apart + epsilon) ** 2 if side == "outer" else ABSENT
    return near, max(apart - epsilon, 0.0) ** 2 if side == "inner" or exact else ABSENT


def _crowd(
    many: Crowd | None, rows: _Rows, pairs: Pairs, named: dict[int, tuple[int, int | None]], epsilon: float
) -> dict[str, np.ndarray]:
    """The arrays of a crowd; its tests are added to the rows."""
    if many is None:
        no_rows = {f"crowd_{name}": _i([], width) for name, width in (("shape", 3), ("rows", 3), ("pairs", 5))}
        no_balls = {"crowd_balls": _f([], 4), "crowd_boxes": _f([], 16)}
        no_words = {f"crowd_{name}": np.zeros((0, 1), np.uint32) for name in ("words", "sets")}
        no_words |= {f"crowd_{name}": np.zeros(0, np.int32) for name in ("first", "ball_rows")}
        return {**no_rows, **no_words, "crowd_numbers": _f([], 4), **no_balls}
    bits = {solid: bit for bit, solid in enumerate(many.solids)}
    of_pairs = np.full((len(many.balls), 32 * many.sets.shape[1], 5), -1, np.int32)
    places = {solid: row for row, solid in enumerate(many.balls)}
    boxes = _Boxes(pairs, rows.covers)
    for pair, (outer, inner) in named.items():
        a, b = (int(k) for k in pairs.pairs[pair])
        exact, first = boxes.exact(a) and rows.covers[b].exact, len(rows.tests)
        tests = _beside(rows, boxes, pair, "outer", outer, epsilon)
        within = [] if exact or inner is None else _beside(rows, boxes, pair, "inner", inner, epsilon)
        rows.tests += [ends for ends, _ in tests + within]
        rows.test_numbers += [numbers for _, numbers in tests + within]
        of_pairs[places[b], bits[a]] = pair, first, len(tests), first + len(tests), len(within)
    counts = [len(own) for own in many.balls.values()]
    frames = [pairs.solids[solid].joint - BASE for solid in many.balls]
    firsts = np.cumsum([0, *counts])[:-1]
    return {
        "crowd_numbers": _f([*many.grid.origin, many.grid.cell], 4)[0],
        "crowd_shape": np.array(many.grid.words.shape, np.int32),
        "crowd_words": many.grid.words.ravel(),
        "crowd_sets": many.sets,
        "crowd_first": _bits(many.sets).argmax(axis=1).astype(np.int32),
        "crowd_rows": _i(np.column_stack([frames, firsts, counts]), 3),
        "crowd_balls": _f(np.concatenate(list(many.balls.values())), 4),
        "crowd_ball_rows": np.repeat(np.arange(len(counts)), counts).astype(np.int32),
        "crowd_boxes": _f(boxes.rows, 16),
        "crowd_pairs": of_pairs.reshape(-1, 5),
    }


def _bits(sets: np.ndarray) -> np.ndarray:
    """Bits (K, 32 W) of sets (K, W)."""
    return np.unpackbits(sets.view(np.uint8), axis=1, bitorder="little")


def _plane_tests(rows: _Rows, pairs: Pairs, pair: int, levels: tuple[int, int | None], epsilon: float) -> list[int]:
    """Tests of a half-space and a solid; its row."""
    a, b = (int(k) for k in pairs.pairs[pair])
    margin, exact, first, plane = pairs.margin(pair), rows.covers[b].exact, len(rows.tests), rows.plane(a)
    for side, level in (("outer", levels[0]), ("inner", None if exact else levels[1])):
        if level is None:
            continue
        for k in rows.of(b, side, level):
            _, _, length, own_radius = rows.capsules[k]
            radius = own_radius + margin
            near = radius + epsilon if side == "outer" else -np.inf
            hit = radius - epsilon if side == "inner" or exact else -np.inf
            rows.tests.append((plane, k))
            rows.test_numbers.append([0.0, length, near, hit, 0.0])
    return [pair, first, len(rows.tests) - first]


def _axis_of_frame(frame: int, axis: np.ndarray) -> int:
    """Where a kernel has a frame's axis that is ``axis`` (3,), but for what nobody measures; else -1."""
    for k in range(3):
        if np.abs(axis - np.eye(3)[k]).max() < ALIGNED:
            return 12 * frame + 3 * k
    return -1


def _words(labels: np.ndarray) -> np.ndarray:
    """Labels of two bits, sixteen to a word (W,) uint32."""
    flat = labels.ravel().astype(np.uint32)
    flat = np.pad(flat, (0, -len(flat) % 16)).reshape(-1, 16)
    return np.bitwise_or.reduce(flat << (2 * np.arange(16, dtype=np.uint32)), axis=1).astype(np.uint32)


def _surfaces(solids: tuple[Solid, ...], ranges: np.ndarray, met: set[int]) -> dict[str, np.ndarray]:
    """The arrays of surfaces' triangles, of those that are ``met``."""
    nodes, links, triangles = [np.zeros((0, 4))], [np.zeros((0, 3), int)], [np.zeros((0, 3, 3))]
    ranges, node, triangle = ranges.copy(), 0, 0
    for number in sorted(met):
        corners = _in_base(solids[number])
        own = tree(corners)
        nodes.append(own.balls)
        links.append(own.links + np.array([node, triangle, 0]))
        triangles.append(corners[own.order])
        ranges[number, 0] = node, node + len(own.balls)
        node, triangle = node + len(own.balls), triangle + len(corners)
    return {
        "vertex_range": ranges,
        "nodes": _d(np.concatenate(nodes), 4),
        "node_links": _i(np.concatenate(links), 3),
        "triangles": _d(np.concatenate(triangles), 9),
    }


def _looked_up(lookups: dict[int, Lookup]) -> dict[str, np.ndarray]:
    """The arrays of lookups and their grids."""
    grids: list[DistanceGrid] = list({id(each.grid): each.grid for each in lookups.values()}.values())
    rows, first = [], 0
    for pair, each in lookups.items():
        grid = next(k for k, grid in enumerate(grids) if grid is each.grid)
        rows.append([pair, grid, each.joint - BASE, first, len(each.balls)])
        first += len(each.balls)
    words = np.cumsum([0, *(grid.words.size for grid in grids)])
    return {
        "lookups": _i(rows, 5),
        "balls": _f(np.concatenate([np.zeros((0, 5)), *(each.balls for each in lookups.values())]), 5),
        "grid_numbers": _f([[*grid.origin, grid.cell] for grid in grids], 4),
        "grid_shapes": _i([[*grid.words.shape, at] for grid, at in zip(grids, words[:-1], strict=True)], 4),
        "grid_words": np.concatenate([np.zeros(0, np.uint32), *(grid.words.ravel() for grid in grids)]),
    }


def lookups_of(program: Program) -> dict[int, Lookup]:
    """By pair, the lookups of a program."""
    found, grids = {}, []
    numbers, shapes = program.grid_numbers.tolist(), program.grid_shapes.tolist()
    for (*origin, cell), (*shape, first) in zip(numbers, shapes, strict=True):
        words = program.grid_words[first : first + np.prod(shape)].reshape(shape)
        grids.append(DistanceGrid(np.array(origin), cell, 0.0, words))
    for pair, grid, frame, first, count in program.lookups.tolist():
        found[pair] = Lookup(grids[grid], frame + BASE, program.balls[first : first + count].astype(float))
    return found


def _capsule(solid: Solid, own: Cover | None) -> np.ndarray:
    """Middle, half axis and radius of one capsule that holds a solid, in the frame of its joint."""
    if own is None:
        return np.zeros(7)
    a, b = (end[0] @ solid.T[:3, :3].T + solid.T[:3, 3] for end in (own.outer[0].a, own.outer[0].b))
    return np.r_[(a + b) / 2, (b - a) / 2, own.outer[0].radius[0]]


def _shift(by: np.ndarray) -> np.ndarray:
    T = np.eye(4)
    T[:3, 3] = by
    return T


def _f(rows: object, width: int) -> np.ndarray:
    return np.asarray(rows, np.float32).reshape(-1, width)


def _d(rows: object, width: int) -> np.ndarray:
    return np.asarray(rows, np.float64).reshape(-1, width)


def _i(rows: object, width: int) -> np.ndarray:
    return np.asarray(rows, np.int32).reshape(-1, width)
