"""A robot that is looked at: its indices, inverse kinematics and postures, under its job's constraints."""

import warnings
from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from wsrender.documents.transform import Transform
from wsrender.engine import evaluate_samples, units_of
from wsrender.indices.index_catalogue import resolve
from wsrender.indices.units import pretty_unit
from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.pipeline.evaluation import Evaluation
from wsrender.pipeline.pipeline import Pipeline
from wsrender.pipeline.sampling import plan_sampling
from wsrender.reach.admissible_search import Admissible, AdmissibleSearch
from wsrender.reach.admission import Admission
from wsrender.reach.evidence import REACHABLE, UNREACHABLE
from wsrender.reach.inverse_solver import InverseSolver, Solutions
from wsrender.reach.posture_sets import Postures, PostureSolver
from wsrender.reach.self_motions import SelfMotion
from wsrender.reach.targets import ANGLE_TOLERANCE_RAD, NAMES, POSITION_TOLERANCE_M, admissible_reasons, reasons_of
from wsrender.robot import Robot
from wsrender.robot.constraints import constraints_of_job
from wsrender.robot.indices import evaluation_of_job
from wsrender.robot.model_robot import configuration_rows
from wsrender.robot.rejections import colliding_pairs
from wsrender.robots.model_warning import ModelWarning

MOST_POSTURES = 256  # of one pose that are listed
MOST_STEPS = 128  # of a self-motion that are told
TURN = 2 * np.pi


class LookedAt:
    """Answers about one robot, under a job's ``choices`` of indices, constraints and environment.

    The first answer of a kind compiles kernels and makes tables, which takes seconds; those after it take milliseconds.
    """

    def __init__(self, robot: Robot, choices: Any, *, device: str = "cpu", threads: int | None = None):
        self.robot, self.choices, self.device, self.threads = robot, choices, device, threads

    @cached_property
    def constraints(self) -> tuple[Constraint, ...]:
        """What admitted configurations satisfy; raises InputError."""
        return constraints_of_job(self.choices, self.robot)

    @cached_property
    def admission(self) -> Admission:
        """What the constraints say of configurations."""
        return Admission(self.robot.chain, self.constraints, self.device, self.threads)

    @cached_property
    def evaluation(self) -> Evaluation:
        """All indices that the robot has of the catalogue's own, and those of the job."""
        has_inertia, choices = self.robot.has_inertia, self.choices
        asked = resolve(choices.indices, has_inertia)
        every = resolve("all" if has_inertia else "kinematic", has_inertia)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ModelWarning)  # told when the robot was loaded
            update = {"indices": tuple(dict.fromkeys([*every, *asked])), "precision": "float64"}
            return evaluation_of_job(choices.model_copy(update=update), self.robot)

    @cached_property
    def solver(self) -> InverseSolver:
        """What solves for poses of the tip."""
        return InverseSolver(
            self.robot.chain,
            kind="pose",
            position_m=POSITION_TOLERANCE_M,
            angle_rad=ANGLE_TOLERANCE_RAD,
            device=self.device,
            threads=self.threads,
        )

    @cached_property
    def search(self) -> AdmissibleSearch:
        """What looks for admitted configurations of poses."""
        return AdmissibleSearch(self.solver, self.admission)

    @cached_property
    def posture_solver(self) -> PostureSolver:
        """What finds all postures of poses."""
        return PostureSolver(self.robot.chain, device=self.device, threads=self.threads)

    def indices(self, q: Sequence[float]) -> dict[str, Any]:
        """Of a configuration (n,) [rad or m] all indices, the tip's pose, and what rejects it, "" where nothing does.

        Raises InputError for one of another length.
        """
        row = configuration_rows(q, self.robot.chain.n, "q")
        evaluation, plan = self.evaluation, plan_sampling(self.robot.chain, row)
        pipeline = Pipeline(evaluation, plan, kept_rows=frozenset(), precision="float64")
        found = evaluate_samples(pipeline, self.device, threads=1)
        units = units_of(evaluation)
        T = self.robot.chain.poses(row)[0]
        return {
            "values": [
                {
                    "name": name,
                    "label": name.replace("_", " "),
                    "unit": pretty_unit(units[name]),
                    "value": _number(value),
                }
                for name, (value,) in zip(evaluation.indices, found.values, strict=True)
            ],
            "position_m": T[:3, 3].tolist(),
            "quat_wxyz": Rotation.from_matrix(T[:3, :3]).as_quat(scalar_first=True).tolist(),
            "reason": self._blocked(row),
        }

    def inverse(self, position_m: Any, quat_wxyz: Any, near: Sequence[float]) -> dict[str, Any]:
        """Whether a pose in the world is reached, the reason, and the configuration nearest to ``near`` (n,).

        Of a pose that is not reached ``q`` comes nearest to it, or reaches it and is rejected; ``distance_m`` and
        ``angle_rad`` are what is left there.
        """
        T = Transform(position_m=position_m, quat_wxyz=quat_wxyz).matrix()
        chain = self.robot.chain
        start = np.clip(configuration_rows(near, chain.n, "near"), chain.lower_limits, chain.upper_limits)
        position, R = T[None, :3, 3], T[None, :3, :3]
        tried = self.solver.tries(start, position, R)
        if tried.reached[0] and not self.admission.rejected(tried.q)[0]:
            q, label, reason = tried.q[0], NAMES[REACHABLE], ""
        else:
            found = self.search.decide(position, R) if self.constraints else self.solver.solve(position, R)
            q, label, reason = found.q[0], NAMES[int(found.label[0])], self._reason(found, position, R)
        if label == NAMES[REACHABLE]:
            q = self._nearest(T, start[0], q)
        at = chain.poses(q[None])[0]
        return {
            "label": label,
            "reason": reason,
            "q": q.tolist(),
            "distance_m": float(np.linalg.norm(at[:3, 3] - T[:3, 3])),
            "angle_rad": float(Rotation.from_matrix(T[:3, :3] @ at[:3, :3].T).magnitude()),
        }

    def postures(self, position_m: Any, quat_wxyz: Any) -> dict[str, Any]:
        """All postures of a pose, what is said of each, how many stand for families, and whether these are all.

        One that stands for a self-motion has its ``curve``: configurations (P, n) [rad or m] in their order, of a long
        one not all, whether it is ``closed``, and what blocks each, "" of free ones.
        """
        T = Transform(position_m=position_m, quat_wxyz=quat_wxyz).matrix()
        found = self.posture_solver.solve(T[None], constraints=self.constraints)
        listed = min(len(found), MOST_POSTURES)
        some = f"; the first {listed} of {len(found)} are listed" if listed < len(found) else ""
        complete = "these are all" if found.complete[0] else "there may be others"
        return {
            "postures": [
                {"q": found[k].tolist(), "said": ", ".join(_said(found, k)), "curve": _curve(found.curves[k])}
                for k in range(listed)
            ],
            "families": int(found.family.sum()),
            "reason": f"{complete}: {found.evidence}{some}",
        }

    def _reason(self, found: Admissible | Solutions, position: np.ndarray, R: np.ndarray) -> str:
        if isinstance(found, Solutions):
            reason = str(reasons_of(self.solver, found, position, R)[0])
        else:
            reason = str(admissible_reasons(self.search, found, position, R)[0])
            if reason in self.admission.names:
                return self._blocked(found.q[:1]) or reason
        return f"{reason}, proven" if reason and found.proven[0] and found.label[0] == UNREACHABLE else reason

    def _blocked(self, q: np.ndarray) -> str:
        """What rejects a configuration (1, n), with the shapes that are too near; "" where nothing does."""
        if not (number := int(self.admission.rejected(q)[0])):
            return ""
        name = self.admission.names[number - 1]
        pairs = colliding_pairs(self.constraints, q, np.array([number])).get("pairs", {"colliding": []})
        near = [" and ".join(pair["shapes"]) for pair in pairs["colliding"] if pair["constraint"] == name]
        return f"{name}: {', '.join(near)}" if near else name

    def _nearest(self, T: np.ndarray, near: np.ndarray, q: np.ndarray) -> np.ndarray:
        """Of a configuration and, of an arm with a closed form, all postures of its pose, the nearest admitted one.

        Windings are turned so that each is nearest.
        """
        candidates = self._wound(q[None], near)
        if self.posture_solver.form:
            candidates = np.concatenate(
                [candidates, self._wound(self.posture_solver.solve(T[None]).configurations, near)]
            )
        candidates = candidates[self.admission.rejected(candidates) == 0]
        if not len(candidates):
            return q
        apart = (candidates - near) / self.posture_solver.holder.scale
        periodic = self.robot.chain.periodic
        apart[:, periodic] = np.remainder(apart[:, periodic] + np.pi, TURN) - np.pi
        return candidates[np.argmin((apart**2).sum(axis=1))]

    def _wound(self, q: np.ndarray, near: np.ndarray) -> np.ndarray:
        """Configurations (K, n) with hinges turned by whole turns, within their limits, as near as can be."""
        chain = self.robot.chain
        least, most = np.ceil((chain.lower_limits - q) / TURN), np.floor((chain.upper_limits - q) / TURN)
        turns = np.clip(np.rint((near - q) / TURN), np.minimum(least, 0), np.maximum(most, 0))
        return q + TURN * turns * (chain.revolute & ~chain.periodic)


def _said(found: Postures, k: int) -> Iterator[str]:
    curve = found.curves[k]
    if curve is not None:
        yield f"of a self-motion, {'closed' if curve.closed else 'open'}"
    elif found.family[k]:
        yield "of a family"
    if (windings := int(found.windings[k])) > 1:
        yield f"{windings} configurations by whole turns"
    if found.doubtful[k]:
        yield "nearly singular"
    yield f"blocked by {found.reasons[k]}" if found.reasons[k] else "free"


def _curve(curve: SelfMotion | None) -> dict[str, Any] | None:
    if curve is None:
        return None
    kept = np.unique(np.linspace(0, len(curve) - 1, min(len(curve), MOST_STEPS)).round().astype(int))
    reasons = curve.reasons[kept].tolist() if len(curve.reasons) else [""] * len(kept)
    return {"closed": curve.closed, "configurations": curve.configurations[kept].tolist(), "reasons": reasons}


def _number(value: Any) -> float | None:
    return float(value) if np.isfinite(value) else None
