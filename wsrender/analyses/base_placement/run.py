"""The analysis ``base_placement``: labels of every placement and target, their map, and the best placement."""

import math
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from wsrender.analyses.base_placement.job import BasePlacementJob
from wsrender.analyses.base_placement.refined import AROUND, CELLS, DEVIATIONS, looked_at, refined
from wsrender.analyses.base_placement.result import PlacementMap, entry_of_pareto, framed, least_value, whole_turn
from wsrender.analyses.base_placement.score import Score
from wsrender.analyses.contract import Analysis, Draft, Settled, Tell
from wsrender.analyses.cost import (
    DECIDED_PER_S,
    DOCUMENT_BYTES,
    LEFT,
    LISTED_BYTES,
    LISTED_MEMORY,
    SEARCHED_BYTES,
    SEARCHED_PER_S,
    STARTS_S,
    WRITTEN_PER_S,
    Asks,
    Cost,
    pictures_cost,
)
from wsrender.analyses.criteria import margins_of, verdicts
from wsrender.analyses.estimate import RATE_CPU_CORE
from wsrender.analyses.execution import Execution
from wsrender.analyses.headline import no_headline
from wsrender.analyses.partial_result import PartialResult, joined_rows, rows_of_shard
from wsrender.documents.constraints import Constraints
from wsrender.documents.placements import ANGLES, IN_DEGREES, TableEdge, mounted, placed
from wsrender.errors import InputError
from wsrender.pipeline.constraints.collision import CollisionConstraint
from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.pipeline.constraints.expression import ExpressionConstraint
from wsrender.pipeline.constraints.host_function import HostConstraint
from wsrender.reach.admissible_search import BLOCKED, turns_matter
from wsrender.reach.evidence import REACHABLE, UNDECIDED, UNREACHABLE
from wsrender.reach.inverse_solver import InverseSolver, closed_form_of, solved_bytes
from wsrender.reach.placements import Decided, PlacedAdmission, Placements, PlacementsOfKinds
from wsrender.reach.target_list import TargetList, covered, targets_of_job
from wsrender.reach.targets import NAMES, Kind, check_tolerance, evidence_of_targets, kinds_of
from wsrender.reach.tolerance import largest_ball
from wsrender.robot import Robot
from wsrender.robot.constraints import constraints_for
from wsrender.robot.gravity import gravity_of
from wsrender.robot.model_robot import transform_of
from wsrender.robots.closed_form import ClosedForm
from wsrender.robots.kinematics import Kinematics
from wsrender.robots.moving_base import MovingBase
from wsrender.volume.table import Table

# Pairs of a placement and a target that are decided together, by closed forms alone of a GPU, whose launches count; by
# others counted with the placements that are alike, so that they tell of their progress. Of bases that a GPU makes all,
# mostly: what closed forms leave open of them is searched at once, and 200 M pairs take a second.
PAIRS, PAIRS_ON_CUDA, PAIRS_MADE, PLACES_MADE = 1 << 20, 1 << 22, 1 << 28, 1 << 22
CLOSED_PER_S, POSTURES_PER_S, BALLS_PER_S, POSES_PER_S = 1.5e7, 4e5, 1.5e6, 1.2e4  # pairs of one core
NEAR_BALLS_PER_S = 6e3  # the same under constraints, where searches in balls say which are out of reach
PLACE_BYTES, PAIR_BYTES = 550, 25  # of a placement, and of a pair, while they are decided
BIT_BYTES, CELL_BYTES = 4, 60  # in files: of up to eight labels of a placement, and of a cell of the map
# Of a placement beside its coordinates in tables, and where placements are ranked; of a cell of the map being made.
ROW_BYTES, RANKED_BYTES, MAP_BYTES = 14, 62, 110
MADE_BYTES = 100  # of a position of bases that the device makes
# Pairs left by closed forms of which some are searched; bytes of what these searches start from, kept for more of them.
LEFT_PAIRS, START_BYTES, SAMPLES_BYTES = 100, 3.4e6, 1e8
BALL_BYTES, LEFT_BYTES = 20, 6e6  # of a pair that is searched along a joint, and of the few that this leaves
DEPTH_BYTES = 16  # of a cell and a range while its distance from those that are worse is found
OF_THE_WORLD = ("region", "orientation", "environment")  # constraints that see where the base stands
LARGEST_TURN = np.pi / 4  # by which tolerances turn the base
SHIFTS, FEW_SHIFTS = 1024, 128  # of the base that are tried at a time; few where inverse kinematics searches
TRIED, TOLERANCE_S = 20_000, 2.0  # placements around the best one, and seconds that they take however few targets
TURNS_ALIKE = 1e-9  # sine, and distance in reaches, of an axis from the base's
DRAWN = 3
PICTURES = ("placements", "robot")
Asked = tuple[tuple[Constraint, ...], tuple[Constraint, ...], tuple[ExpressionConstraint | HostConstraint, ...]]


class BasePlacementAnalysis(Analysis):
    """A planned ``base_placement`` job: its samples are pairs of a placement and a target."""

    job: BasePlacementJob

    @property
    def effort(self) -> float:  # type: ignore[override]
        """A pair's time in samples of a sweep."""
        return RATE_CPU_CORE / self._rate

    def prepare(self, device: str, target: str) -> Settled:
        """Raises InputError for a tolerance below what is computed, and for constraints that cannot be asked."""
        for kind in self._kinds:
            check_tolerance(self.robot.chain, kind.tolerances[0], self.job.precision)
        _, K = (self.constraints, self.score, self.margins), len(self.targets)
        return Settled(device, target, ((0, self.job.over.count * K),), shard_unit=K * self._alike)

    @cached_property
    def targets(self) -> TargetList:
        """The targets, with their weights; raises InputError for a table that cannot be read."""
        chain, (lower, upper) = self.robot.chain, self.job.over.limits
        aside = np.linalg.norm(chain.center)
        found = targets_of_job(
            self.job, lambda position: np.clip(position, lower[:3] - aside, upper[:3] + aside), chain.reach
        )
        return found if self.job.weights is None else replace(found, weight=np.array(self.job.weights))

    @cached_property
    def _kinds(self) -> list[Kind]:
        """Targets by what they ask for, of the robot where it stands."""
        return self._kinds_of(self.targets)

    def _kinds_of(self, targets: TargetList, chain: Kinematics | None = None) -> list[Kind]:
        tolerances = self.job.position_tolerance_m, self.job.angle_tolerance_rad
        return kinds_of(chain or self.standing.chain, targets, tolerances)

    @cached_property
    def margins(self) -> dict[int, Kinematics]:
        """The arm within the limits of each criterion, by number, that asks for a margin; raises InputError."""
        return margins_of(self.job.criteria, self.standing.chain)

    @cached_property
    def base(self) -> MovingBase:
        """Where bases may stand."""
        lower, upper = self.job.over.limits
        T_frame_base = mounted(self.job.mounting) @ self.robot.chain.T_world_base
        return MovingBase(lower * IN_DEGREES, upper * IN_DEGREES, T_frame_base)

    @cached_property
    def standing(self) -> Robot:
        """The robot at the world's origin, turned as its placements are, at the first angles of ranges."""
        tilt = np.array([[0.0, 0.0, 0.0, *self.job.over.limits[0][3:]]])
        return self._robot_at(placed(tilt)[0])

    def _robot_at(self, T_world_frame: np.ndarray) -> Robot:
        """The robot in a frame (4, 4) that is placed."""
        where = transform_of(T_world_frame @ self.base.T_frame_base)
        assert where
        return self.robot.placed(where)

    @cached_property
    def constraints(self) -> Asked:
        """Constraints that see where the base stands, of a chain that begins with its joints, others, and users' own.

        Raises InputError.
        """
        return self._constraints(self.base)

    def _constraints(self, base: MovingBase) -> Asked:
        choice, gravity = self.job.constraints or Constraints.model_construct(), gravity_of(self.job)
        if self.robot.chain.geometry is None and any(getattr(choice, name) for name in OF_THE_WORLD):
            raise InputError("constraints", "are not available for a robot that is defined by a class: its base moves")
        given = {name: getattr(choice, name) for name in choice.model_fields_set}
        world = {name: value for name, value in given.items() if name in OF_THE_WORLD}
        added = choice.model_extra or {}
        own = {name: value for name, value in given.items() if name not in (*OF_THE_WORLD, *added)}
        seen, around = Constraints.model_construct(**world), self.job.environment
        users = constraints_for(self.standing, Constraints.model_construct(**added), gravity=gravity)
        return (
            constraints_for(self.standing, seen, around, gravity=gravity, base=base),
            constraints_for(self.standing, Constraints.model_construct(**own), gravity=gravity),
            tuple(each for each in users if isinstance(each, ExpressionConstraint | HostConstraint)),
        )

    @cached_property
    def score(self) -> Score | None:
        """What tells placements apart that serve as much; raises InputError."""
        return self.scores[0] if self.scores else None

    @cached_property
    def scores(self) -> list[Score]:
        """By each index; raises InputError."""
        return [Score.of(self.job, name, self.standing, self.base) for name in self.job.indices]

    @property
    def _constrained(self) -> bool:
        return any(self.constraints)

    @property
    def names(self) -> tuple[str, ...]:
        """The constraints' names, in the order in which they are asked."""
        return tuple(each.name for part in self.constraints for each in part)

    @cached_property
    def _alike(self) -> int:
        """How many placements that follow one another serve the same: of all yaws where these change nothing, else 1.

        So it is where joint 1 turns freely about the axis that yaw turns the base about, and nothing else sees yaw.
        """
        yaws, chain = self.job.over.shape[-1], self.robot.chain.geometry
        if not self.job.use_symmetry or chain is None or yaws == 1 or not chain.joint_is_revolute[0]:
            return 1
        if any(name in self.job.over.ranges for name in ANGLES[:2]) or np.count_nonzero(chain.joint_source == 0) > 1:
            return 1
        T = self.standing.chain.T_world_base @ chain.T_joint[0]
        along = np.hypot(*T[:2, 2]) < TURNS_ALIKE and np.hypot(*T[:2, 3]) < TURNS_ALIKE * chain.reach
        free = chain.periodic[0] or chain.upper_limits[0] - chain.lower_limits[0] >= 2 * np.pi * (1 - 1e-12)
        blind = self._blind and all(score.survives for score in self.scores)
        return yaws if along and free and chain.joint_source[0] == 0 and blind else 1

    @property
    def _blind(self) -> bool:
        """Whether constraints do not see how the base is turned about the world's z."""
        moved, own, added = self.constraints
        if added:
            return False
        turned = len(self.base.varying) - 1  # the joint that carries the base
        around = [each for each in moved if isinstance(each, CollisionConstraint)]
        carried = any(each.solids[k].joint == turned for each in around for k in each.pairs.ravel())
        upright = not any(gravity_of(self.job)[:2])
        return not carried and all("base_joint" in each.keeps or (each.name == "torque" and upright) for each in own)

    @property
    def _rate(self) -> float:
        """Pairs a second of one core, about."""
        rates = [self._rate_of(kind) for kind in self._kinds]
        seconds = sum(len(kind.at) / rate for kind, rate in zip(self._kinds, rates, strict=True))
        return rates[0] if len(rates) == 1 else len(self.targets) / seconds

    def _rate_of(self, kind: Kind) -> float:
        form = closed_form_of(kind.chain, kind.name)
        closed = isinstance(form, ClosedForm)
        if self._constrained or self.score:
            rate = NEAR_BALLS_PER_S if form and kind.name == "pose" else SEARCHED_PER_S
            rate = POSTURES_PER_S if closed and kind.name == "pose" else rate
            return rate / max(1, len(self.scores))
        if form:
            return CLOSED_PER_S if closed else BALLS_PER_S
        return DECIDED_PER_S if kind.name == "position" else POSES_PER_S

    @property
    def cost(self) -> Cost:
        """Pairs, a bit of each label, and the table of placements."""
        over, K = self.job.over, len(self.targets)
        kept = self._bits_bytes
        columns = 8.0 * (len(over.ranges) + len(self.scores) + (self.job.weights is not None)) + 4
        rows = columns * over.count + self.told_bytes
        drawn, seconds = pictures_cost(*PICTURES, *(["pareto"] if self.job.pareto else []))
        files = DOCUMENT_BYTES + drawn + rows + 7 * LISTED_BYTES * K
        tables = self._tables_bytes + self._kept_for_more
        around = 2 * LEFT_BYTES + self._refined_bytes if self.job.refine else 0.0
        memory = kept + max(kept + self._decided_bytes, tables, around) + 7 * LISTED_MEMORY * K
        tried = (
            over.count * self.job.mounted.mean() / self._alike + (TRIED if self.job.refine else 0) + len(self.margins)
        )
        seconds += TOLERANCE_S if self.job.refine else 0.0
        seconds += tried * K / self._rate + files / WRITTEN_PER_S + STARTS_S * self._searches
        return Cost(over.count * K, memory, files, seconds, Asks("over", "take larger steps"))

    @property
    def _tables_bytes(self) -> float:
        """Of memory while tables are made, and the best placement is found."""
        over, ranked = self.job.over, bool(self.scores) or self.job.weights is not None
        row = 8.0 * len(over.ranges) + (RANKED_BYTES if ranked else ROW_BYTES)
        return row * over.count + MAP_BYTES * self._cells + self._depth_bytes

    @property
    def _kept_for_more(self) -> float:
        """Of memory for what searches of placements start from, as long as others may follow."""
        return SAMPLES_BYTES * self._searches if self._searches else START_BYTES * self._leaves

    @property
    def _leaves(self) -> bool:
        """Whether closed forms, without constraints, leave so many pairs that some are searched."""
        return self.job.over.count / self._alike * len(self.targets) * LEFT >= LEFT_PAIRS

    @property
    def _cells(self) -> int:
        """Of the map: of the first two ranges."""
        return math.prod([len(self.job.over.values(name)) for name in [*self.job.over.ranges][:2]])

    @property
    def _bits_bytes(self) -> float:
        """Of memory for what is known of all placements."""
        return self.job.over.count * (self._bits + 8.0 * len(self.scores))

    @property
    def _bits(self) -> int:
        """Bytes of a placement's labels, of eight targets each."""
        return -(-len(self.targets) // 8) * (3 + len(self.names))

    @property
    def _searches(self) -> bool:
        """Whether targets are expected that closed forms leave to a search for admitted configurations."""
        if not (self._constrained or self.score):
            return False
        closed = [kind.name == "pose" and isinstance(closed_form_of(kind.chain, "pose"), ClosedForm)
                  for kind in self._kinds]  # fmt: skip
        pairs = self.job.over.count * len(self.targets) / self._alike
        return not all(closed) or turns_matter(self.robot.chain, self.names) or pairs * LEFT >= 1

    @property
    def told_bytes(self) -> float:
        """Of files for the labels of all placements, and their map."""
        over = self.job.over
        return BIT_BYTES * self._bits * over.count + CELL_BYTES * self._cells

    @property
    def kept_bytes(self) -> float:
        """Of memory for what is known of all placements, and tables of it, which others see beside theirs."""
        columns = len(self.job.over.ranges) + len(self.scores) + (self.job.weights is not None)
        return self._bits_bytes + self.job.over.count * (8.0 * columns + 4) + CELL_BYTES * self._cells

    @property
    def _together(self) -> int:
        """Placements that are decided together, of those that are alike one."""
        K, alone = len(self.targets), not (self._constrained or self.score)
        if not alone:
            pairs = PAIRS // self._alike
        elif not self.device.startswith("cuda"):
            pairs = PAIRS
        else:
            pairs = min(PAIRS_MADE, K * PLACES_MADE) if self._makes_bases else PAIRS_ON_CUDA
        return max(1, pairs // K)

    @property
    def _decided_bytes(self) -> float:
        """Of memory while placements are decided, as many as are at a time."""
        K, places = len(self.targets), self.job.over.count / self._alike
        together = min(places, self._together)
        if self._makes_bases:
            positions = together * self._alike / math.prod(self.job.over.shape[3:])
            return MADE_BYTES * positions + BIT_BYTES * self._bits * together + 1.5 * START_BYTES * self._leaves
        if self._constrained or self.score:
            solved = SEARCHED_BYTES * self._searches + self.program_bytes
        else:
            solved = max(self._solved_bytes(kind, together) for kind in self._kinds)
        return (PLACE_BYTES + PAIR_BYTES * K) * together + solved

    @property
    def _makes_bases(self) -> bool:
        """Whether the device makes bases, and closed forms leave few pairs."""
        forms = (closed_form_of(kind.chain, kind.name) for kind in self._kinds)
        return self._by_bits and all(isinstance(form, ClosedForm) for form in forms)

    @property
    def _by_bits(self) -> bool:
        """Whether placements may be decided by their bits, without constraints or a score of pairs."""
        return not (self._constrained or self.score or isinstance(self.job.mounting, TableEdge))

    def _solved_bytes(self, kind: Kind, places: float) -> float:
        """Of memory for targets of a kind that a search decides, from so many placements."""
        form, pairs = closed_form_of(kind.chain, kind.name), places * len(kind.at)
        if form:
            return 0.0 if isinstance(form, ClosedForm) else max(BALL_BYTES * pairs, LEFT_BYTES)
        return solved_bytes(pairs, kind.name, kind.chain, self.job.precision)

    @property
    def _refined_bytes(self) -> float:
        """Of memory for starts of tries around a placement."""
        if not self.score:
            return 0.0
        return self._bits_bytes + 3 * 8.0 * AROUND * len(DEVIATIONS) * self.standing.chain.n * len(self.targets)

    @property
    def _depth_bytes(self) -> float:
        """Of memory while the best placement is found that is farthest from those that are worse."""
        frames = framed(self.job.over)
        if self._alike > 1 and whole_turn(self.job.over, "yaw_deg"):  # one yaw says what all do
            frames[-1] = (0, 1, 0)
        cells = math.prod(before + size + after for before, size, after in frames)
        return cells * DEPTH_BYTES * len(self.job.over.ranges)

    def compute(self, shard: int, execution: Execution, tell: Tell) -> PartialResult:
        """Of every placement of the shard bits (B,) uint8, target k that of byte k // 8 and weight 2^(k % 8).

        ``served``, ``undecided``, by constraint ``blocked_<name>``: that it rejected most configurations, and
        ``proven``: that a target is out of reach, or blocked, is. With an index ``score`` (P,), its least value over
        the targets that are served, NaN where none is; ``score_2`` of a second.
        """
        (first, count), K = self.shards[shard], len(self.targets)
        start, end = first // K, (first + count) // K
        each = self._alike * self._together
        search, parts = self._placements(execution.threads), []
        others = [self._placements(execution.threads, score) for score in self.scores[1:]]
        for begin in range(start, end, each):
            numbers = range(begin, min(begin + each, end), self._alike)
            if self._by_bits and search.by_bits:
                rows = [*search.bits(self.job.over, numbers)]
            else:
                rows = self._rows(self._decided(search, np.array(numbers)))
                rows += [least_value(self._decided(other, np.array(numbers)).value) for other in others]
            parts.append(rows if self._alike == 1 else [np.repeat(row, self._alike, axis=0) for row in rows])
            tell((numbers[-1] + self._alike) * K - first)
        arrays = parts[0] if len(parts) == 1 else [np.concatenate(part) for part in zip(*parts, strict=True)]
        names = [*self._names_of_bits, *("score", "score_2")[: len(self.scores)]]
        return rows_of_shard(first, dict(zip(names, arrays, strict=True)))

    def _placements(self, threads: int | None, score: Score | None = None) -> PlacementsOfKinds:
        """What decides all targets from placements of the job, by a score or the first."""
        score = score or self.score
        if (made := self._made.get((threads, score))) is None:
            value = score and replace(score, device=self.device, threads=threads)
            admission = self._admission(self.base, self.constraints, threads)
            made = self._made[threads, score] = self._deciding(self._kinds, self.base, admission, threads, value)
        return made

    @cached_property
    def _made(self) -> dict[tuple[int | None, Score | None], PlacementsOfKinds]:
        """What decides targets, kept with the samples that its searches start from: they are drawn once."""
        return {}

    def solving(self, threads: int | None) -> Placements:
        """What finds configurations of targets that are whole poses, all of the same tolerances."""
        admission = self._admission(self.base, self.constraints, threads)
        admission = admission or PlacedAdmission(self.standing.chain, (), self.device, threads)
        (search,) = self._deciding(self._kinds, self.base, admission, threads).parts
        return search

    def _around(self, T_world_base: np.ndarray, served: np.ndarray, threads: int | None) -> PlacementsOfKinds:
        """What decides ``served`` targets (K,) bool from bases that are moved from one, and turned about its origin.

        Coordinates are those of the origin in the world, and angles by which the base is turned.
        """
        shifts, T = np.full(3, self.standing.chain.reach), T_world_base.copy()
        ends = np.array([*shifts, *([1.5 * LARGEST_TURN] * 3)])
        middle = np.array([*T[:3, 3], 0.0, 0.0, 0.0])
        T[:3, 3] = 0.0
        base = MovingBase(middle - ends, middle + ends, T)
        admission = self._admission(base, self._constraints(base) if self._constrained else ((), (), ()), threads)
        return self._deciding(self._kinds_of(self.targets.part(served)), base, admission, threads)

    def _deciding(
        self,
        kinds: list[Kind],
        base: MovingBase,
        admission: PlacedAdmission | None,
        threads: int | None,
        value: Score | None = None,
    ) -> PlacementsOfKinds:
        parts = [Placements(self._solver(kind, threads), base, kind.T_world_tip, admission, value) for kind in kinds]
        return PlacementsOfKinds(parts, [kind.at for kind in kinds])

    def _solver(self, kind: Kind, threads: int | None) -> InverseSolver:
        job = self.job
        return InverseSolver(
            kind.chain,
            kind=kind.name,
            position_m=kind.tolerances[0],
            angle_rad=kind.tolerances[1],
            length_m=job.characteristic_length_m,
            seed=job.seed,
            precision=job.precision,
            device=self.device,
            threads=threads,
        )

    def _admission(self, base: MovingBase, constraints: Asked, threads: int | None) -> PlacedAdmission | None:
        moved, own, added = constraints
        if not (moved or own or added):
            return None
        chain = self.standing.chain
        on_base = base.carrying(chain.geometry) if chain.geometry else None
        return PlacedAdmission(chain, own, self.device, threads, moved, on_base, added, base)

    def _decided(self, search: PlacementsOfKinds, numbers: np.ndarray) -> Decided:
        coordinates, shape = self.job.over.coordinates(numbers), (len(numbers), len(self.targets))
        there = np.flatnonzero(self.job.stands(*coordinates.T[:2]))
        if len(there) == len(numbers):
            return search.decide(coordinates * IN_DEGREES, placed(coordinates))
        found = Decided.nothing(shape, UNREACHABLE)
        if len(there):
            of = search.decide(coordinates[there] * IN_DEGREES, placed(coordinates[there]))
            for array, part in zip(found.arrays, of.arrays, strict=True):
                array[there] = part
        return found

    @property
    def _names_of_bits(self) -> list[str]:
        return ["served", "undecided", *(f"blocked_{name}" for name in self.names), "proven"]

    def _rows(self, found: Decided) -> list[np.ndarray]:
        blocked = [(found.label == BLOCKED) & (found.reason == k + 1) for k in range(len(self.names))]
        masks = [found.label == REACHABLE, found.label == UNDECIDED, *blocked, found.proven]
        rows = [np.packbits(mask, axis=1, bitorder="little") for mask in masks]
        return [*rows, least_value(found.value)] if self.score else rows

    def merge(self, a: PartialResult, b: PartialResult) -> PartialResult:
        """The placements of both, in their order."""
        return joined_rows(a, b)

    def result(self, partial: PartialResult, execution: Execution) -> Draft:
        """The tables ``placements``, their ``placement_map``, and ``targets`` as the best one serves them."""
        scores = partial["score"] if self.score else None
        second = (self.scores[1], partial["score_2"]) if len(self.scores) == 2 else None
        bits = {name: partial[name] for name in self._names_of_bits}
        found = PlacementMap(self.job, self.targets.weight, bits, self.score, scores, second)
        about = found.entry | {
            "alike": self._alike,
            "evidence": evidence_of_targets(self.robot.chain, self.targets),
        }
        tables = {"placements": found.table} | ({"placement_map": found.map} if self.job.over.ranges else {})
        if (best := found.best) is None:
            nothing = no_headline("no placement serves a target")
            entries = {
                "placements": about,
                "best": None,
                **self._verdicts([found.least_known] * len(self.job.criteria)),
            }
            return Draft(entries, nothing, provenance=self.targets.provenance, tables=tables)
        if self.score and self.job.pareto:
            tables["pareto"] = found.pareto
        search = self._placements(execution.threads)
        cells = self.job.over.coordinates(found.best_cells(CELLS if self.job.refine else 1))
        if self.job.refine:
            there = refined(self.job, self.targets.weight, search, self.standing.chain, cells)
        else:
            there = looked_at(search, cells[0])
        coordinates, of, q = there.place[None], there.found, there.q
        robot = self._robot_at(placed(coordinates)[0])
        entry = {"T_world_base": robot.chain.T_world_base.tolist(), "cell": found.entry_of(best)}
        values = [(self.score, of.value)] if self.score else []
        if second:
            values.append(
                (second[0], looked_at(self._placements(execution.threads, second[0]), there.place).found.value)
            )
        self._made.clear()  # the plans of other robots need memory too
        least = {score.name: float(score.sign * np.nanmin(value)) for score, value in values}
        entry = found.entry_at(coordinates[0], of) | least | entry
        if self.job.refine:
            entry["tolerance"] = self._tolerance(robot.chain.T_world_base, of.label == REACHABLE, execution.threads)
        labels = [_named(of.label)] * len(self.job.criteria)
        for k, chain in self.margins.items():
            labels[k] = self._within(chain, coordinates, labels[k], execution.threads)
        tables["targets"] = self._targets_table(of, q, values, {f"criterion_{k + 1}": labels[k] for k in self.margins})
        reached = q[of.label == REACHABLE][:DRAWN]
        skeleton = robot.skeleton(reached) if len(reached) else None
        entry |= covered(self.job.targets, of.label == REACHABLE, of.label == UNDECIDED)
        entries = {"placements": about, "best": entry, **entry_of_pareto(self.job, tables), **self._verdicts(labels)}
        return Draft(entries, provenance=self.targets.provenance, tables=tables, skeleton=skeleton)

    def _verdicts(self, labels: list[np.ndarray]) -> dict[str, Any]:
        return verdicts(self.job.criteria, self.targets.weight, labels)

    def _within(self, chain: Kinematics, coordinates: np.ndarray, label: np.ndarray, threads: int | None) -> np.ndarray:
        """Labels (K,) from one placement (1, 6) of targets that a chain of narrower limits may reach, others kept."""
        admission = self._admission(self.base, self.constraints, threads)
        asked = np.isin(label, (NAMES[REACHABLE], NAMES[UNDECIDED]))
        kinds = self._kinds_of(self.targets.part(asked), chain) if asked.any() else []
        labels = label.copy()
        if kinds:
            narrowed = None if admission is None else replace(admission, chain=chain)
            search = self._deciding(kinds, self.base, narrowed, threads)
            labels[asked] = _named(search.decide(coordinates * IN_DEGREES, placed(coordinates)).label[0])
        return labels

    def _tolerance(self, T_world_base: np.ndarray, served: np.ndarray, threads: int | None) -> dict[str, Any]:
        """How far the base may stand elsewhere, or turned about any axis, and serve the same (DEFINITIONS 18)."""
        search, middle = self._around(T_world_base, served, threads), np.zeros(6)
        middle[:3] = T_world_base[:3, 3]
        count = SHIFTS if search.closed else FEW_SHIFTS

        def serves(coordinates: np.ndarray) -> np.ndarray:
            found = search.decide(coordinates, placed(coordinates / IN_DEGREES))
            return (found.label == REACHABLE).all(axis=1)

        def shifted(by: np.ndarray) -> np.ndarray:
            return serves(middle + np.hstack([by, np.zeros_like(by)]))

        def turned(by: np.ndarray) -> np.ndarray:
            angles = Rotation.from_rotvec(by).as_euler("xyz")
            return serves(middle + np.hstack([np.zeros_like(by), angles]))

        seed, reach = self.job.seed, float(self.standing.chain.reach)
        entry: dict[str, Any] = {"translation_m": largest_ball(shifted, reach, count, seed)}
        entry["rotation_rad"] = None if "torque" in self.names else largest_ball(turned, LARGEST_TURN, count, seed)
        return entry | {"largest": {"translation_m": reach, "rotation_rad": LARGEST_TURN}}

    def _targets_table(
        self, found: Decided, q: np.ndarray, values: list[tuple[Score, np.ndarray]], labels: dict[str, np.ndarray]
    ) -> Table:
        """A row for each target as the best placement serves it, in the order asked, with more ``labels`` by column.

        ``values`` (K,) of each score.
        """
        job, chain = self.job, self.robot.chain
        columns = self.targets.columns(job.targets is not None)
        columns |= {} if job.weights is None else {"weight": self.targets.weight}
        columns |= {
            "label": _named(found.label),
            "reason": np.array(["", *self.names])[np.where(found.label == BLOCKED, found.reason, 0)],
        }
        columns |= {score.name: score.sign * value for score, value in values}
        columns |= labels | {f"q_{name}": values for name, values in zip(chain.joint_names, q.T, strict=True)}
        kinds = zip(chain.joint_names, chain.revolute, strict=True)
        units = {"position": "m"} | {score.name: score.unit for score in self.scores}
        units |= {f"q_{name}": "rad" if revolute else "m" for name, revolute in kinds}
        return Table(columns, units)


def _named(label: np.ndarray) -> np.ndarray:
    return np.array([NAMES[each] for each in label.tolist()], "<U11")
