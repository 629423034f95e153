"""The analysis ``postures``: all configurations of given poses, and what is said of each."""

import math
from dataclasses import replace
from functools import cached_property
from itertools import islice
from typing import Any

import numpy as np

from wsrender.analyses.contract import Analysis, Draft, Settled, Tell
from wsrender.analyses.cost import (
    DOCUMENT_BYTES,
    LISTED_BYTES,
    LISTED_MEMORY,
    WRITTEN_PER_S,
    Asks,
    Cost,
    pictures_cost,
)
from wsrender.analyses.estimate import RATE_CPU_CORE
from wsrender.analyses.execution import Execution
from wsrender.analyses.partial_result import PartialResult
from wsrender.analyses.postures.job import PosturesJob
from wsrender.analyses.provenance import index_choices
from wsrender.documents.target_lists import TargetTable, TargetVolume
from wsrender.engine import evaluate_samples, units_of
from wsrender.errors import InputError
from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.pipeline.evaluation import Evaluation
from wsrender.pipeline.pipeline import Pipeline
from wsrender.pipeline.sampling import plan_sampling
from wsrender.reach.aspects import AspectFinder
from wsrender.reach.inverse_solver import MOST_TRIES
from wsrender.reach.posture_sets import (
    BATCH,
    MOST_OF_FAMILIES,
    REDUNDANT_BATCH,
    Postures,
    PostureSolver,
    kind_of,
    poses_of,
)
from wsrender.reach.self_motions import STEP
from wsrender.reach.target_list import TargetList, checked_targets, listed_targets
from wsrender.robot.constraints import constraints_of_job
from wsrender.robot.indices import evaluation_of_job
from wsrender.robot.links import bodies_in, coarse_faces
from wsrender.robot.rejections import rejected_rows
from wsrender.robots.closed_form import ClosedForm
from wsrender.volume.table import Table

CLOSED_PER_S, TRIES_PER_S = 2e4, 1e5  # postures of closed forms, and tries of searches, of one CPU core
FAMILY_TRIES_PER_S = 2e4  # where two joints or more are spare: most tries come to postures that differ
BRANCHES, OF_POSITIONS = 8, 4  # postures of a pose, and of a position, without limits
SWEPT_S = 0.6  # of a batch of poses, for forms at all values of a joint
POINTS = 250  # of the self-motion of a posture, in steps of STEP
FORMED_POINTS_PER_S, POINTS_PER_S = 5e4, 3.5e3  # with a closed form and without, of one CPU core
GRID_S, GRID_BYTES = 2.0, 7e7  # of the cells that say where a determinant has which sign
WAYS_BYTES = 6e7  # of the ways between two postures that are sampled where no determinant factors
FACTORED_PER_S, SAMPLED_PER_S = 2e3, 10.0  # poses whose aspects are told, by factors of the determinant and by samples
ROW_BYTES = 60  # of a posture in the table beside its configuration and indices
# Of memory: of a try and its target, of a pose; of each joint of a posture while it is made, and which share of tries
# come to one, where no joint is spare, one, or more; of a posture, a configuration that is listed, a point of a curve.
TRY_BYTES, POSE_BYTES = 410, 2000
MADE_BYTES, COME = 410, (0.1, 0.3, 0.55)
FOUND_BYTES, LISTED_ROW_BYTES, POINT_BYTES = 430, 190, 25
DRAWN = 8  # postures in pictures, of the first pose that has any
FACE_BYTES, MESH_BYTES = 42, 3  # of a triangle of their bodies, as ply and glb; of memory for each such byte
OF_POSTURES = ("pose", "number", "winding", "windings", "q", "sigma_min", "family", "doubtful", "residual_m",
               "residual_rad", "rejected", "values", "aspect")  # fmt: skip
OF_CURVES = ("curve_pose", "curve_posture", "point", "closed", "singular", "points", "blocked")
OF_POSES = ("asked", "aspects", "proven", "cuspidal", "complete", "found", "configurations")


def _refuse(field: str, rows: np.ndarray, message: str) -> None:
    raise InputError(field, f"target {int(np.argmax(rows))} {message}")


class PosturesAnalysis(Analysis):
    """A planned ``postures`` job: its samples are the poses."""

    effort = RATE_CPU_CORE * BRANCHES / CLOSED_PER_S
    job: PosturesJob

    def prepare(self, device: str, target: str) -> Settled:
        """Raises InputError for constraints and indices that are not for such a robot."""
        _ = self.constraints, self.evaluation, self.job.aspects and self.finder
        return Settled(device, target, ((0, len(self.targets)),), shard_unit=1)

    @cached_property
    def targets(self) -> TargetList:
        """The poses; raises InputError for a table that cannot be read, and for targets that ask for several things."""
        job, chain, axis = self.job, self.robot.chain, self.job.free_axis or ""
        if job.targets is None:
            quats = None if job.quat_wxyz is None else np.array(job.quat_wxyz)
            listed = listed_targets(np.array(job.position_m), quats)
            return replace(listed, free_axis=np.full(len(listed), axis))
        found = checked_targets(job.targets, lambda position: chain.center, chain.reach)
        if axis and not found.oriented.all():
            _refuse("free_axis", ~found.oriented, "says no orientation, of which it would be an axis")
        if axis and (others := (found.free_axis != "") & (found.free_axis != axis)).any():
            _refuse("free_axis", others, "has another one of its own")
        found = replace(found, free_axis=np.where(found.free_axis == "", axis, found.free_axis))
        for what, asked in (("orientation", found.oriented), ("free axis", found.free_axis)):
            if (others := asked != asked[0]).any():
                _refuse("targets", others, f"and target 0 differ in their {what}; postures are of one kind of pose")
        return found

    @property
    def _quat(self) -> np.ndarray | None:
        """Orientations (N, 4); None where any will do."""
        return self.targets.quat_wxyz if self.targets.oriented.any() else None

    @cached_property
    def constraints(self) -> tuple[Constraint, ...]:
        """What free postures satisfy; raises InputError."""
        return constraints_of_job(self.job, self.robot)

    @cached_property
    def evaluation(self) -> Evaluation:
        """What is computed of every configuration; raises InputError."""
        return evaluation_of_job(self.job, self.robot) if self.job.indices else Evaluation(self.robot.chain)

    @cached_property
    def solver(self) -> PostureSolver:
        """What finds postures."""
        job, free_axis = self.job, str(self.targets.free_axis[0]) or None
        asked, options = kind_of(self._quat, free_axis), {"starts": job.starts, "curve_step": job.curve_step}
        return PostureSolver(self.robot.chain, **asked, **options, seed=job.seed)

    @cached_property
    def finder(self) -> AspectFinder:
        """What tells aspects; raises InputError for an arm whose singular configurations part nothing."""
        form = self.solver.form
        finder = AspectFinder(self.solver.holder, form if isinstance(form, ClosedForm) else None)
        if not finder.square:
            moving, freedoms = len(finder.holder.moving), finder.holder.freedoms
            message = f"must be false: {moving} joints move, and the pose has {freedoms} freedoms"
            raise InputError("aspects", f"{message}; singular configurations part nothing")
        return finder

    @property
    def cost(self) -> Cost:
        """Poses, their postures and the search for those that no closed form knows."""
        job, solver, count, n = self.job, self.solver, len(self.targets), self.robot.chain.n
        listed = 0 if isinstance(job.targets, TargetTable | TargetVolume) else 3 if self._quat is None else 7
        postures = self._expected * count
        rows = postures * min(job.windings, float(np.maximum(self._turns, 1).prod()))
        row = ROW_BYTES + 8 * (n + len(self.evaluation.indices))
        points = POINTS * postures * STEP / job.curve_step if self._spare == 1 else 0.0
        meshes = FACE_BYTES * coarse_faces(self.robot) * min(DRAWN, math.ceil(self._expected))
        drawn, seconds = pictures_cost("postures", "robot")
        files = DOCUMENT_BYTES + drawn + meshes + row * rows + (ROW_BYTES + 8 * n) * points
        files += LISTED_BYTES * listed * count
        batch = REDUNDANT_BATCH if solver.redundant else BATCH
        tries = 0 if solver.form else job.starts
        memory = LISTED_MEMORY * listed * count + self._most_held(min(count, batch), tries, postures, rows, row, points)
        memory += MESH_BYTES * meshes
        tries_per_s = FAMILY_TRIES_PER_S if self._spare > 1 else TRIES_PER_S
        seconds += postures / CLOSED_PER_S + count * tries / tries_per_s + files / WRITTEN_PER_S
        seconds += points / (FORMED_POINTS_PER_S if solver.form else POINTS_PER_S)
        seconds += SWEPT_S * math.ceil(count / batch) if solver.swept else 0.0
        if job.aspects:
            grid, proof = self.finder.gridded, self.finder.proof
            seconds += count / (FACTORED_PER_S if proof else SAMPLED_PER_S) + GRID_S * grid
            memory += GRID_BYTES * grid if proof else WAYS_BYTES
        return Cost(count, memory, files, seconds, Asks("position_m", "take fewer"))

    def _most_held(self, poses: int, tries: int, postures: float, rows: float, row: float, points: float) -> float:
        """Bytes: of a batch of so many poses while its postures are made, or of all while they are listed."""
        made, tries = MADE_BYTES * self.robot.chain.n, min(poses * tries, MOST_TRIES)
        searched = max(TRY_BYTES, made * COME[min(self._spare, 2)]) * tries
        solved = poses * POSE_BYTES + max(searched, made * self._expected * poses * bool(self.solver.form))
        curves = (POINT_BYTES + 16 * self.robot.chain.n) * points
        return max(solved, FOUND_BYTES * postures + (LISTED_ROW_BYTES + row) * rows) + curves

    @property
    def _spare(self) -> int:
        """How many more joints move than the pose has freedoms."""
        return len(self.solver.holder.moving) - self.solver.holder.freedoms

    @cached_property
    def _expected(self) -> float:
        """Postures of a pose: of those without limits the share of the hinges' turns, and of poses within reach."""
        chain = self.robot.chain
        near = float((np.linalg.norm(self.targets.position - chain.center, axis=1) <= chain.reach).mean())
        if self._spare > 1 and not self.solver.form:
            return MOST_OF_FAMILIES * near
        branches = OF_POSITIONS if self.solver.kind == "position" else BRANCHES
        return branches * near * float(np.minimum(self._turns, 1).prod())

    @cached_property
    def _turns(self) -> np.ndarray:
        """How many turns the limits leave each hinge on which postures depend."""
        chain, holder = self.robot.chain, self.solver.holder
        hinges = [k for k in holder.moving if chain.revolute[k] and not self.solver.idle[k]]
        return (chain.upper_limits - chain.lower_limits)[hinges] / (2 * np.pi)

    def compute(self, shard: int, execution: Execution, tell: Tell) -> PartialResult:
        """The shard's postures: arrays OF_POSTURES, a row for each configuration that is listed, and OF_POSES."""
        first, count = self.shards[shard]
        own, quat = slice(first, first + count), self._quat
        T = poses_of(self.targets.position[own], None if quat is None else quat[own])
        self.solver.device, self.solver.threads = self.device, execution.threads
        found = self.solver.solve(T, tell)
        wound = [list(islice(found.wound(k), self.job.windings)) for k in range(len(found))]
        each = [len(rows) for rows in wound]
        q = np.array([row for rows in wound for row in rows]).reshape(-1, self.robot.chain.n)
        per_pose = np.bincount(found.pose, minlength=count)
        number = np.arange(len(found)) - np.repeat(np.cumsum(per_pose) - per_pose, per_pose)
        names = ("windings", "sigma_min", "family", "doubtful", "residual_m", "residual_rad")
        rejected, values = self._evaluated(q, execution)
        pose = np.repeat(found.pose, each)
        aspect, of_pose = self._aspects(q, pose, np.repeat(number, each), count)
        return PartialResult(
            {
                **self._curves(found, number, first, execution),
                "pose": pose + first,
                "aspect": aspect,
                **of_pose,
                "number": np.repeat(number, each),
                "winding": np.concatenate([np.zeros(0, int), *map(np.arange, each)]),
                **{name: np.repeat(getattr(found, name), each) for name in names},
                "q": q,
                "rejected": rejected,
                "values": values,
                "asked": np.arange(first, first + count),
                "complete": found.complete,
                "found": per_pose,
                "configurations": np.bincount(found.pose, found.windings, minlength=count).astype(np.int64),
            }
        )

    def _aspects(
        self, q: np.ndarray, pose: np.ndarray, number: np.ndarray, count: int
    ) -> tuple[np.ndarray, dict[str, np.ndarray]]:
        """Of configurations the aspect's number in its pose (K,); of each pose how many, and whether that is proven.

        A pose shows an arm as cuspidal where two of its postures stand in one aspect.
        """
        aspect = np.full(len(q), -1)
        aspects, proven, cuspidal = np.zeros(count, int), np.zeros(count, bool), np.zeros(count, bool)
        for k in np.unique(pose) if self.job.aspects else ():
            own = np.flatnonzero(pose == k)
            aspect[own], proven[k] = self.finder.numbered(q[own])
            aspects[k] = aspect[own].max() + 1
            of = np.stack([aspect[own], number[own]], axis=1)
            cuspidal[k] = len(np.unique(of, axis=0)) > len(np.unique(aspect[own]))
        return aspect, {"aspects": aspects, "proven": proven, "cuspidal": cuspidal}

    def _curves(self, found: Postures, number: np.ndarray, first: int, execution: Execution) -> dict[str, np.ndarray]:
        """Arrays OF_CURVES: a row for each point of each self-motion."""
        own = [(k, curve) for k, curve in enumerate(found.curves) if curve is not None]
        each = [len(curve) for _, curve in own]
        n = self.robot.chain.n
        points = np.concatenate([np.zeros((0, n)), *(curve.configurations for _, curve in own)])
        at = np.array([k for k, _ in own], int)
        return {
            "curve_pose": np.repeat(found.pose[at] + first, each),
            "curve_posture": np.repeat(number[at], each),
            "point": np.concatenate([np.zeros(0, int), *map(np.arange, each)]),
            "closed": np.repeat(np.array([curve.closed for _, curve in own], bool), each),
            "singular": np.repeat(np.array([curve.singular for _, curve in own], bool), each),
            "points": points,
            "blocked": self._evaluated(points, execution)[0],
        }

    def _evaluated(self, q: np.ndarray, execution: Execution) -> tuple[np.ndarray, np.ndarray]:
        """The number, from 1, of the constraint that rejects ``q`` (K, n), or 0, (K,); and indices (K, I)."""
        rejected, values = np.zeros(len(q), np.int8), np.zeros((len(q), len(self.evaluation.indices)))
        if not len(q) or not (self.constraints or self.evaluation.indices):
            return rejected, values
        plan = plan_sampling(self.robot.chain, q)
        pipeline = Pipeline(
            self.evaluation, plan, self.constraints, kept_rows=frozenset(), precision=self.job.precision
        )
        rows = evaluate_samples(pipeline, self.device, threads=execution.threads)
        rejected = rejected if rows.rejected is None else rows.rejected
        return rejected, np.array(rows.values, np.float64).reshape(-1, len(q)).T

    def merge(self, a: PartialResult, b: PartialResult) -> PartialResult:
        """The postures of both, in the order of their poses."""
        joined = {}
        for names in (OF_POSTURES, OF_CURVES, OF_POSES):
            order = np.argsort(np.concatenate([a[names[0]], b[names[0]]]), kind="stable")
            joined |= {name: np.concatenate([a[name], b[name]])[order] for name in names}
        return PartialResult(joined)

    def result(self, partial: PartialResult, execution: Execution) -> Draft:
        """Tables ``postures``, a row for each configuration that is listed, and ``poses``, in the order asked.

        The mesh ``bodies`` and the skeletons are of the first pose that has a posture.
        """
        first = partial["winding"] == 0
        residuals = (float(partial[name].max(initial=0.0)) for name in ("residual_m", "residual_rad"))
        found: dict[str, Any] = {
            "poses": len(partial["asked"]),
            "reached": int((partial["found"] > 0).sum()),
            "postures": int(partial["found"].sum()),
            "configurations": int(partial["configurations"].sum()),
            "listed": len(first),
            "most_of_a_pose": int(partial["found"].max(initial=0)),
            "self_motions": {
                "count": int((partial["point"] == 0).sum()),
                "closed": int(partial["closed"][partial["point"] == 0].sum()),
            },
            "families": int(partial["family"][first].sum()),
            "doubtful": int(partial["doubtful"][first].sum()),
            "complete": int(partial["complete"].sum()),
            "evidence": self.solver.evidence,
            **dict(zip(("largest_residual_m", "largest_residual_rad"), residuals, strict=True)),
        }
        entries: dict[str, Any] = {"postures": found}
        if self.job.aspects:
            found["aspects"] = {
                "most_of_a_pose": int(partial["aspects"].max(initial=0)),
                "proven": int(partial["proven"].sum()),
                "cuspidal_poses": int(partial["cuspidal"].sum()),
                "evidence": self.finder.evidence,
            }
        if self.constraints:
            found["free"] = int((partial["rejected"][first] == 0).sum())
            entries |= rejected_rows(self.constraints, partial["rejected"], partial["q"].__getitem__)
        if self.job.indices:
            entries |= {"indices": self._extremes(partial), "choices": index_choices(self.job, self.evaluation)}
        shown = np.flatnonzero(first & (partial["pose"] == partial["pose"][:1]))[:DRAWN] if len(first) else []
        bodies = bodies_in(self.robot, partial["q"][shown]) if len(shown) else None
        return Draft(
            entries,
            provenance=self.targets.provenance,
            notices=self.evaluation.notices,
            tables={
                "postures": self._postures(partial),
                **({"self_motions": self._self_motions(partial)} if len(partial["point"]) else {}),
                "poses": self._poses(partial),
            },
            skeleton=self.robot.skeleton(partial["q"][shown]) if len(shown) else None,
            meshes={} if bodies is None else {"bodies": bodies},
        )

    def _extremes(self, partial: PartialResult) -> dict[str, Any]:
        """Of each index over the configurations that are free."""
        units, free = units_of(self.evaluation), partial["values"][partial["rejected"] == 0]
        return {
            name: {
                "maximum": float(values.max()) if len(values) else None,
                "minimum": float(values.min()) if len(values) else None,
                "unit": units[name],
            }
            for name, values in zip(self.evaluation.indices, free.T, strict=True)
        }

    def _postures(self, partial: PartialResult) -> Table:
        names = ("windings", "family", "doubtful", "sigma_min", "residual_m", "residual_rad")
        columns = {"pose": partial["pose"], "posture": partial["number"], "winding": partial["winding"]}
        columns |= {"aspect": partial["aspect"]} if self.job.aspects else {}
        columns |= {name: partial[name] for name in names}
        units = {"residual_m": "m", "residual_rad": "rad"}
        if self.constraints:
            columns["reason"] = self._reasons[partial["rejected"]]
        for name, values in zip(self.evaluation.indices, partial["values"].T, strict=True):
            columns[name], units[name] = values, units_of(self.evaluation)[name]
        joints, of_joints = self._joints(partial["q"])
        return Table(columns | joints, units | of_joints)

    def _self_motions(self, partial: PartialResult) -> Table:
        columns = {"pose": partial["curve_pose"], "posture": partial["curve_posture"], "point": partial["point"]}
        columns |= {name: partial[name] for name in ("closed", "singular")}
        if self.constraints:
            columns["reason"] = self._reasons[partial["blocked"]]
        joints, units = self._joints(partial["points"])
        return Table(columns | joints, units)

    @property
    def _reasons(self) -> np.ndarray:
        return np.array(["", *(each.name for each in self.constraints)])

    def _joints(self, q: np.ndarray) -> tuple[dict[str, np.ndarray], dict[str, str]]:
        """Columns of configurations (K, n), and their units."""
        chain = self.robot.chain
        names = [f"q_{name}" for name in chain.joint_names]
        units = ["rad" if turns else "m" for turns in chain.revolute]
        return dict(zip(names, q.T, strict=True)), dict(zip(names, units, strict=True))

    def _poses(self, partial: PartialResult) -> Table:
        columns = {"name": self.targets.name} if (self.targets.name != "").any() else {}
        columns["position"] = self.targets.position
        if self._quat is not None:
            columns["quat_wxyz"] = self._quat
        columns |= {"postures": partial["found"], "configurations": partial["configurations"]}
        if self.constraints:
            free = (partial["winding"] == 0) & (partial["rejected"] == 0)
            columns["free"] = np.bincount(partial["pose"][free], minlength=len(partial["asked"]))
        if self.job.aspects:
            told = {"aspects": "aspects", "aspects_proven": "proven", "cuspidal": "cuspidal"}
            columns |= {name: partial[array] for name, array in told.items()}
        return Table({**columns, "complete": partial["complete"]}, {"position": "m"})
