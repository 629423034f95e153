"""The local index by which placements that serve as much are told apart."""

from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np

from wsrender.analyses.base_placement.job import BasePlacementJob
from wsrender.collision.clearance import Clearance
from wsrender.documents.options import IndexChoices
from wsrender.documents.placements import ANGLES
from wsrender.engine import evaluate_samples, units_of
from wsrender.errors import InputError
from wsrender.indices.entry import BASE_JOINT
from wsrender.indices.index_catalogue import find
from wsrender.pipeline.constraints.expression import ExpressionIndex
from wsrender.pipeline.evaluation import Evaluation
from wsrender.pipeline.pipeline import Pipeline
from wsrender.pipeline.sampling import plan_sampling
from wsrender.robot import Robot
from wsrender.robot.indices import evaluation_of_job
from wsrender.robots.moving_base import MovingBase

SMALLER_IS_BETTER = ("tip_compliance", "position_error")


@dataclass(frozen=True, eq=False)
class Score:
    """Values of an index at configurations, times `sign`: the larger the better."""

    name: str
    evaluation: Evaluation
    clearance: Clearance | None
    base: MovingBase
    device: str = "cpu"
    threads: int | None = None

    @classmethod
    def of(cls, job: BasePlacementJob, name: str, robot: Robot, base: MovingBase) -> "Score":
        """By the index of a name, of a robot that stands where gravity is that of all placements.

        Raises InputError for an index that the robot does not have, or that may see how the base is turned.
        """
        _ = _found(name)
        options = {each: given for each, given in job.index_options.items() if each == name or each not in job.indices}
        given = name in ("clearance", "clearance_lower_bound")
        choices = {each: field.get_default() for each, field in IndexChoices.model_fields.items()}
        choices |= {"indices": (name,), "index_options": options, "precision": "float64"}
        choices |= {"gravity_m_s2": job.gravity_m_s2, "constraints": job.constraints, "environment": None}
        try:
            evaluation = evaluation_of_job(SimpleNamespace(**choices), robot)  # type: ignore[arg-type]
        except InputError as error:
            raise error.at("index") if error.field == "indices" else error from None
        clearance = None
        if given:
            from wsrender.robot.collisions import clearance_of

            clearance = clearance_of(robot, job.constraints, job.environment, base)
        _refuse_turned(job, name, evaluation)
        return cls(name, evaluation, clearance, base)

    @property
    def sign(self) -> float:
        """Of larger values that are better."""
        return -1.0 if self.name in SMALLER_IS_BETTER else 1.0

    @property
    def unit(self) -> str:
        """Of the index."""
        return units_of(self.evaluation)[self.name]

    @property
    def survives(self) -> bool:
        """Whether it does not depend on the first joint's value."""
        return BASE_JOINT in find(self.name).surviving(self.evaluation.dynamic)

    def __call__(self, q: np.ndarray, base_values: np.ndarray) -> np.ndarray:
        """Values (N,) at configurations (N, n) [rad or m] on bases whose joints have values (N, m)."""
        if self.clearance:
            options = self.evaluation.options[self.name]
            least = self.clearance.least if self.name == "clearance" else self.clearance.lower_bound
            return least(np.hstack([base_values, q]), **options)
        chain, of_users = self.evaluation.chain, self.evaluation.of_chain.get(self.name)
        if isinstance(of_users, ExpressionIndex):  # it may see where the base stands
            moved = self.base.poses(base_values) @ np.linalg.inv(chain.T_world_base)
            return self.sign * of_users.values(q, moved @ chain.poses(q), moved)
        plan = plan_sampling(chain, q)
        pipeline = Pipeline(self.evaluation, plan, kept_rows=frozenset())
        return self.sign * evaluate_samples(pipeline, self.device, threads=self.threads).values[0]


def _found(name: str) -> Any:
    try:
        return find(name)
    except InputError as error:
        raise error.at("index") from None


def _refuse_turned(job: BasePlacementJob, index: str, evaluation: Evaluation) -> None:
    if isinstance(evaluation.of_chain.get(index), ExpressionIndex):
        return
    turned = [name for name in ANGLES if name in job.over.ranges]
    options = evaluation.options.get(index, {})
    if turned and options.get("direction"):
        field = f"index_options.{index}.direction"
        raise InputError(field, f"must not be given where over.{turned[0]} is a range: the base turns")
    if "gravity" in find(index).needs and (name := job.turns_gravity):
        raise InputError("index", f"must not be {index} where over.{name} is a range: gravity would turn")
