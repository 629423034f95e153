"""The analysis ``base_placement``: labels of every placement and target, their map, and the best placement."""

from functools import cached_property

import numpy as np

from wsrender.analyses.base_placement.job import BasePlacementJob
from wsrender.analyses.base_placement.result import PlacementMap
from wsrender.analyses.contract import Analysis, Draft, Settled, Tell
from wsrender.analyses.cost import (
    DECIDED_PER_S,
    DOCUMENT_BYTES,
    LISTED_BYTES,
    LISTED_MEMORY,
    SEARCHED_BYTES,
    SEARCHED_PER_S,
    WRITTEN_PER_S,
    Asks,
    Cost,
    pictures_cost,
)
from wsrender.analyses.estimate import RATE_CPU_CORE
from wsrender.analyses.execution import Execution
from wsrender.analyses.headline import no_headline
from wsrender.analyses.partial_result import PartialResult, joined_rows, rows_of_shard
from wsrender.documents.constraints import Constraints
from wsrender.documents.placements import ANGLES, mounted, placed
from wsrender.errors import InputError
from wsrender.pipeline.constraints.collision import CollisionConstraint
from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.reach.admissible_search import BLOCKED
from wsrender.reach.evidence import REACHABLE, UNDECIDED
from wsrender.reach.inverse_solver import InverseSolver, closed_form_of
from wsrender.reach.placements import PlacedAdmission, Placements
from wsrender.reach.targets import NAMES, check_tolerance, evidence_of, rotations
from wsrender.robot import Robot
from wsrender.robot.constraints import constraints_for
from wsrender.robot.gravity import gravity_of
from wsrender.robot.model_robot import transform_of
from wsrender.robots.closed_form import ClosedForm
from wsrender.robots.moving_base import MovingBase
from wsrender.volume.table import Table

PAIRS = 1 << 20  # of placements and targets that are decided together
CLOSED_PER_S, POSTURES_PER_S, BALLS_PER_S, POSES_PER_S = 1.5e7, 4e5, 3e5, 1.2e4  # pairs of one core
PAIR_BYTES = 40  # while they are decided
OF_THE_WORLD = ("region", "orientation", "environment")  # constraints that see where the base stands
IN_DEGREES = np.array([1.0] * 3 + [np.pi / 180] * 3)
TURNS_ALIKE = 1e-9  # sine, and distance in reaches, of an axis from the base's
DRAWN = 3


class BasePlacementAnalysis(Analysis):
    """A planned ``base_placement`` job: its samples are pairs of a placement and a target."""

    job: BasePlacementJob

    @property
    def effort(self) -> float:  # type: ignore[override]
        """A pair's time in samples of a sweep."""
        return RATE_CPU_CORE / self._rate

    def prepare(self, device: str, target: str) -> Settled:
        """Raises InputError for a tolerance below what is computed, and for constraints that cannot be asked."""
        check_tolerance(self.robot.chain, self.job.position_tolerance_m, self.job.precision)
        _ = self.constraints
        return Settled(
            device, target, ((0, self.job.over.count * self._targets),), shard_unit=self._targets * self._alike
        )

    @property
    def _targets(self) -> int:
        return len(self.job.points_m)

    @cached_property
    def base(self) -> MovingBase:
        """Where bases may stand."""
        lower, upper = self.job.over.limits
        T_frame_base = mounted(self.job.mounting) @ self.robot.chain.T_world_base
        return MovingBase(lower * IN_DEGREES, upper * IN_DEGREES, T_frame_base)

    @cached_property
    def standing(self) -> Robot:
        """The robot where roll and pitch are those of its placements, at the world's origin."""
        tilt = np.array([[0.0, 0.0, 0.0, *self.job.over.limits[0][3:5], 0.0]])
        return self._robot_at(placed(tilt)[0])

    def _robot_at(self, T_world_frame: np.ndarray) -> Robot:
        """The robot in a frame (4, 4) that is placed."""
        where = transform_of(T_world_frame @ self.base.T_frame_base)
        assert where
        return self.robot.placed(where)

    @cached_property
    def constraints(self) -> tuple[tuple[Constraint, ...], tuple[Constraint, ...]]:
        """Constraints that see where the base stands, of a chain that begins with its joints, and the others.

        Raises InputError.
        """
        choice, gravity = self.job.constraints or Constraints.model_construct(), gravity_of(self.job)
        if choice.added:
            name = next(iter(choice.added))
            raise InputError(f"constraints.{name}", "is not available here: it may depend on where the base stands")
        if self.robot.chain.geometry is None and any(getattr(choice, name) for name in OF_THE_WORLD):
            raise InputError("constraints", "are not available for a robot that is defined by a class: its base moves")
        given = {name: getattr(choice, name) for name in choice.model_fields_set}
        world = {name: value for name, value in given.items() if name in OF_THE_WORLD}
        own = {name: value for name, value in given.items() if name not in OF_THE_WORLD}
        around = (Constraints.model_construct(**world), self.job.environment)
        return (
            constraints_for(self.standing, *around, gravity=gravity, base=self.base),
            constraints_for(self.standing, Constraints.model_construct(**own), gravity=gravity),
        )

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
        return yaws if along and free and chain.joint_source[0] == 0 and self._blind else 1

    @property
    def _blind(self) -> bool:
        """Whether constraints do not see how the base is turned about the world's z."""
        moved, own = self.constraints
        turned = len(self.base.varying) - 1  # the joint that carries the base
        around = [each for each in moved if isinstance(each, CollisionConstraint)]
        carried = any(each.solids[k].joint == turned for each in around for k in each.pairs.ravel())
        upright = not any(gravity_of(self.job)[:2])
        return not carried and all("base_joint" in each.keeps or (each.name == "torque" and upright) for each in own)

    @property
    def _rate(self) -> float:
        """Pairs a second of one core, about."""
        form = closed_form_of(self.robot.chain, self._kind)
        closed = isinstance(form, ClosedForm)
        if self._constrained:
            return POSTURES_PER_S if closed and self._kind == "pose" else SEARCHED_PER_S
        if form:
            return CLOSED_PER_S if closed else BALLS_PER_S
        return DECIDED_PER_S if self._kind == "position" else POSES_PER_S

    @property
    def _kind(self) -> str:
        return "position" if self.job.quats_wxyz is None else "pose"

    @property
    def cost(self) -> Cost:
        """Pairs, a bit of each label, and the table of placements."""
        over, K = self.job.over, self._targets
        bits = -(-K // 8) * (2 + len(self.names))
        rows = over.count * (8.0 * len(over.ranges) + 12 + bits)
        drawn, seconds = pictures_cost("placements", "robot")
        files = DOCUMENT_BYTES + drawn + rows + 7 * LISTED_BYTES * K
        memory = 2 * rows + 8.0 * over.count + PAIR_BYTES * min(PAIRS, over.count * K) + 7 * LISTED_MEMORY * K
        memory += SEARCHED_BYTES if self._constrained else 0
        seconds += over.count * K / self._alike / self._rate + files / WRITTEN_PER_S
        return Cost(over.count * K, memory, files, seconds, Asks("over", "take larger steps"))

    def compute(self, shard: int, execution: Execution, tell: Tell) -> PartialResult:
        """Of every placement of the shard bits (B,) uint8, target k that of byte k // 8 and weight 2^(k % 8).

        ``served``, ``undecided``, and by constraint ``blocked_<name>``: that it rejected most configurations.
        """
        (first, count), K = self.shards[shard], self._targets
        start, end = first // K, (first + count) // K
        each = self._alike * max(1, PAIRS // (K * self._alike))
        search, parts = self._placements(execution.threads), []
        for begin in range(start, end, each):
            numbers = np.arange(begin, min(begin + each, end))
            label, reason = self._decided(search, numbers[:: self._alike])
            parts.append([np.repeat(bits, self._alike, axis=0) for bits in self._bits(label, reason)])
            tell((int(numbers[-1]) + 1) * K - first)
        arrays = [np.concatenate(part) for part in zip(*parts, strict=True)]
        return rows_of_shard(first, dict(zip(self._names_of_bits, arrays, strict=True)))

    def _placements(self, threads: int | None) -> Placements:
        job, chain = self.job, self.standing.chain
        solver = InverseSolver(
            chain,
            kind=self._kind,
            position_m=job.position_tolerance_m,
            angle_rad=job.angle_tolerance_rad,
            length_m=job.characteristic_length_m,
            seed=job.seed,
            precision=job.precision,
            device=self.device,
            threads=threads,
        )
        T = np.tile(np.eye(4), (self._targets, 1, 1))
        T[:, :3, 3] = job.points_m
        if job.quats_wxyz is not None:
            T[:, :3, :3] = rotations(job.quats_wxyz, len(T))
        return Placements(solver, self.base, T, self._admission(threads))

    def _admission(self, threads: int | None) -> PlacedAdmission | None:
        if not self._constrained:
            return None
        moved, own = self.constraints
        chain = self.standing.chain
        on_base = self.base.carrying(chain.geometry) if chain.geometry else None
        return PlacedAdmission(chain, own, self.device, threads, moved, on_base)

    def _decided(self, search: Placements, numbers: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        coordinates = self.job.over.coordinates(numbers)
        return search.decide(coordinates * IN_DEGREES, placed(coordinates))

    @property
    def _names_of_bits(self) -> list[str]:
        return ["served", "undecided", *(f"blocked_{name}" for name in self.names)]

    def _bits(self, label: np.ndarray, reason: np.ndarray) -> list[np.ndarray]:
        blocked = [(label == BLOCKED) & (reason == k + 1) for k in range(len(self.names))]
        masks = [label == REACHABLE, label == UNDECIDED, *blocked]
        return [np.packbits(mask, axis=1, bitorder="little") for mask in masks]

    def merge(self, a: PartialResult, b: PartialResult) -> PartialResult:
        """The placements of both, in their order."""
        return joined_rows(a, b)

    def result(self, partial: PartialResult, execution: Execution) -> Draft:
        """The tables ``placements``, their ``placement_map``, and ``targets`` as the best one serves them."""
        found = PlacementMap(self.job, {name: partial[name] for name in self._names_of_bits})
        about = found.entry | {
            "alike": self._alike,
            "evidence": evidence_of(self.robot.chain, self._kind),
        }
        tables = {"placements": found.table} | ({"placement_map": found.map} if self.job.over.ranges else {})
        if (best := found.best) is None:
            nothing = no_headline("no placement serves a target")
            return Draft({"placements": about, "best": None}, nothing, tables=tables)
        coordinates = self.job.over.coordinates(np.array([best]))
        label, reason, q = self._placements(execution.threads).configurations(
            coordinates * IN_DEGREES, placed(coordinates)
        )
        robot = self._robot_at(placed(coordinates)[0])
        entry = found.entry_of(best) | {"T_world_base": robot.chain.T_world_base.tolist()}
        tables["targets"] = self._targets_table(label, reason, q)
        reached = q[label == REACHABLE][:DRAWN]
        skeleton = robot.skeleton(reached) if len(reached) else None
        return Draft({"placements": about, "best": entry}, tables=tables, skeleton=skeleton)

    def _targets_table(self, label: np.ndarray, reason: np.ndarray, q: np.ndarray) -> Table:
        """A row for each target as the best placement serves it, in the order asked."""
        job, chain = self.job, self.robot.chain
        columns = {"position": np.array(job.points_m)}
        columns |= {} if job.quats_wxyz is None else {"quat_wxyz": np.array(job.quats_wxyz)}
        columns |= {} if job.weights is None else {"weight": np.array(job.weights)}
        columns |= {
            "label": np.array([NAMES[each] for each in label.tolist()], "<U11"),
            "reason": np.array(["", *self.names])[np.where(label == BLOCKED, reason, 0)],
        }
        columns |= {f"q_{name}": values for name, values in zip(chain.joint_names, q.T, strict=True)}
        kinds = zip(chain.joint_names, chain.revolute, strict=True)
        units = {"position": "m"} | {f"q_{name}": "rad" if revolute else "m" for name, revolute in kinds}
        return Table(columns, units)
