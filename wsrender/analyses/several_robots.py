"""Several robots on one lattice: a workspace plan for each."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, count
from typing import TYPE_CHECKING, Any

from wsrender.analyses.composed import Part, PartialParts, part_of
from wsrender.analyses.contract import Settled
from wsrender.analyses.cost import (
    DOCUMENT_BYTES,
    WRITTEN_PER_S,
    Cost,
    in_turn,
    pictures_cost,
)
from wsrender.analyses.execution import Execution
from wsrender.analyses.registry import job_classes, planned
from wsrender.documents.arm import Arm, dotted
from wsrender.documents.constraints import ArmsConstraints, Constrained
from wsrender.documents.options import IndexChoices
from wsrender.documents.several_robots import NamedArm, PlacedRobot
from wsrender.errors import InputError
from wsrender.results.result import Result
from wsrender.robot import Robot

if TYPE_CHECKING:
    from wsrender.robot.arms_collision import ArmsApart


@dataclass(eq=False)
class SeveralPlans:
    """Workspace plans of K robots at one voxel size, device and target."""

    names: list[str]
    plans: list[Any]

    @property
    def samples(self) -> int:
        """Samples of all robots; a converging sampling takes more."""
        return sum(plan.samples for plan in self.plans)

    @property
    def cost(self) -> Cost:
        """Of all robots: they are swept one after the other, and their volumes kept."""
        swept = self.swept_cost
        drawn, seconds = pictures_cost("comparison", "arm")
        refined_memory, refined_time = zip(*(plan.refined_cost for plan in self.plans), strict=True)
        files = DOCUMENT_BYTES * len(self.plans) + drawn + sum(plan.volume_bytes for plan in self.plans)
        seconds += swept.seconds + sum(refined_time) + files / WRITTEN_PER_S
        later = self.kept_bytes + max(refined_memory) + max(plan.program_bytes for plan in self.plans)
        memory = max(swept.memory_bytes, later)
        return Cost(swept.samples, memory, files, seconds, swept.asks)

    @property
    def swept_cost(self) -> Cost:
        """Of the sweeps, beside what is kept of the robots before."""
        swept, last = in_turn(plan.swept_cost for plan in self.plans), self.plans[-1].kept_bytes
        return replace(swept, memory_bytes=swept.memory_bytes + (self.kept_bytes - last) / 2)

    @property
    def most_bytes(self) -> float:
        """More than all of them take of memory: see `WorkspaceAnalysis.most_bytes`."""
        return 2 * sum(plan.most_bytes for plan in self.plans)

    @property
    def kept_bytes(self) -> float:
        """Of all robots' partial results and volumes."""
        return sum(plan.kept_bytes for plan in self.plans)

    def settled(self, samples: int) -> "SeveralSettled":
        """What is settled once, for every robot of a job of so many samples."""
        first, robots = self.plans[0], tuple(plan.resolved() for plan in self.plans)
        return SeveralSettled(first.device, first.target, ((0, samples),), robots=robots)

    @property
    def parts(self) -> list[Part]:
        """The plans as the first parts of a job."""
        return [part_of(plan) for plan in self.plans]

    def results(self, partial: PartialParts, execution: Execution) -> list[Result]:
        """The workspace result of every robot."""
        return [plan.finish(partial.parts[k], {}, execution) for k, plan in enumerate(self.plans)]


@dataclass(frozen=True, kw_only=True)
class SeveralSettled(Settled):
    """With what the plan of each robot has settled."""

    robots: tuple[dict[str, Any], ...]


def plan_several(
    job: Any,
    robots: tuple[Robot, ...],
    settled: SeveralSettled | None = None,
    refined_volume: float | None = None,
) -> SeveralPlans:
    """Workspace plans of a job's robots at its voxel size, or at the one that they share by default.

    ``refined_volume``: tolerance of each robot's own; None: it has none. Raises InputError, MissingInertiaError,
    ResourceError.
    """
    known = settled.robots if settled else [None] * len(robots)
    names = robot_names(job.robots, robots)
    jobs = [workspace_job(job, arm, refined_volume) for arm in job.robots]
    plans = [
        _located(k, planned, own, robot, resolved=resolved)
        for k, (own, robot, resolved) in enumerate(zip(jobs, robots, known, strict=True))
    ]
    if settled is None and job.voxel_size_m is None:
        size = shared_voxel_size(plans)
        plans = [_located(k, plan.with_voxels, size) for k, plan in enumerate(plans)]
    return SeveralPlans(names, plans)


def shared_voxel_size(plans: Sequence[Any]) -> float:
    """Edge of the voxels [m] of several robots: the smallest of their own with which no robot's samples leave holes."""
    return max(min(plan.voxel_size_m for plan in plans), *(plan.least_voxel_size_m for plan in plans))


def workspace_job(job: Any, arm: PlacedRobot, refined_volume: float | None = None) -> Any:
    """The workspace job of one robot of a job of several."""
    shared = (*IndexChoices.model_fields, *Constrained.model_fields, "voxel_size_m", "max_samples")
    choices = {name: getattr(job, name) for name in shared}
    if isinstance(job.constraints, ArmsConstraints):
        choices["constraints"] = job.constraints.of_each
    choices["voxel_statistics"] = ("count", "maximum")  # what robots are compared by
    own = {"robot": arm.robot, "base": arm.base, "tip": arm.tip, "sampling": arm.sampling}
    return job_classes()["workspace"](**choices, **own, refined_volume=refined_volume)


def arms_apart_of(
    choice: Any, arms: Sequence[Arm], robots: Sequence[Robot], names: Sequence[str]
) -> "dict[tuple[int, int], ArmsApart]":
    """What keeps robots apart, by their places, where a job's constraints ask for it. Raises InputError."""
    if choice is None or choice.arms_collision is None:
        return {}
    from wsrender.robot.arms_collision import arms_apart

    return {
        (i, k): arms_apart(
            (robots[i], robots[k]),
            (names[i], names[k]),
            choice.arms_collision,
            one_model=arms[i].robot == arms[k].robot,
        )
        for i, k in combinations(range(len(robots)), 2)
    }


def robot_names(arms: Sequence[NamedArm], robots: tuple[Robot, ...]) -> list[str]:
    """What each robot is called: its name in the job, else its own, with a number where that is taken."""
    taken = {arm.name for arm in arms if arm.name}
    names = []
    for arm, robot in zip(arms, robots, strict=True):
        name = arm.name
        if name is None:
            choices = (robot.name if k == 1 else f"{robot.name}_{k}" for k in count(1))
            name = next(choice for choice in choices if choice not in taken)
            taken.add(name)
        names.append(name)
    return names


def _located(number: int, plans: Callable[..., Any], *arguments: Any, **named: Any) -> Any:
    """What ``plans`` makes of its arguments; its errors say which robot they are of."""
    try:
        return plans(*arguments, **named)
    except InputError as error:
        if error.field == "voxel_size_m":  # the job's, not the robot's
            raise
        raise error.within(dotted(("robots", number))) from None
