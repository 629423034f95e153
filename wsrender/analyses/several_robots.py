"""Several robots on one lattice: a workspace plan for each, swept one after the other."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import count
from typing import Any

from wsrender.analyses.contract import Progress, Settled, Tell
from wsrender.analyses.cost import DOCUMENT_BYTES, Cost, in_turn, pictures_cost, refined_seconds
from wsrender.analyses.execution import Execution
from wsrender.analyses.partial_result import PartialResult
from wsrender.analyses.refined import MEASURE
from wsrender.analyses.registry import job_classes, planned
from wsrender.documents.arm import dotted
from wsrender.documents.index_choices import IndexChoices
from wsrender.documents.several_robots import PlacedRobot
from wsrender.errors import InputError
from wsrender.results.result import Result
from wsrender.robot import Robot

ROBOTS = "robots"  # fact that holds those of every robot


@dataclass(eq=False)
class SeveralPlans:
    """Workspace plans of K robots at one voxel size, device and target."""

    names: list[str]
    plans: list[Any]

    @property
    def samples(self) -> int:
        """Samples of all robots; a converging sampling takes more."""
        return sum(plan.shards[0][1] for plan in self.plans)

    @property
    def cost(self) -> Cost:
        """Of all robots: they are swept one after the other, and their volumes kept."""
        swept = in_turn(plan.swept_cost for plan in self.plans)
        drawn, seconds = pictures_cost("comparison", "arm")
        seconds += sum(refined_seconds(plan.job.refined_volume) for plan in self.plans)
        files = DOCUMENT_BYTES * len(self.plans) + drawn + sum(plan.volume_bytes for plan in self.plans)
        return Cost(swept.samples, swept.memory_bytes, files, swept.seconds + seconds)

    def settled(self, shards: tuple[tuple[int, int], ...]) -> "SeveralSettled":
        """What is settled once, for every robot."""
        first = self.plans[0]
        return SeveralSettled(first.device, first.target, shards, robots=tuple(plan.resolved() for plan in self.plans))

    def run(self, execution: Execution, tell: Tell) -> PartialResult:
        """Sweep every robot; arrays are led by the robot's number, facts are in a list."""
        arrays, facts, done = {}, [], 0
        for k, plan in enumerate(self.plans):
            partial = plan.compute(0, execution, progress_after(done, tell)).packed()
            arrays |= {f"{k}_{name}": array for name, array in partial.arrays.items()}
            facts.append(partial.facts)
            done += plan.shards[0][1]
        return PartialResult(arrays, {ROBOTS: facts})

    def refine(self, partial: PartialResult, progress: Progress | None, execution: Execution) -> PartialResult:
        """With the refined measure of every robot whose plan asks for it."""
        measures = [plan.measured(progress, execution) for plan in self.plans]
        known = [facts | {MEASURE: entry} for facts, entry in zip(partial.facts[ROBOTS], measures, strict=True)]
        return PartialResult(partial.arrays, {**partial.facts, ROBOTS: known})

    def results(self, partial: PartialResult, execution: Execution) -> list[Result]:
        """The workspace result of every robot."""
        found = []
        for k, (plan, facts) in enumerate(zip(self.plans, partial.facts[ROBOTS], strict=True)):
            lead = f"{k}_"
            own = {name.removeprefix(lead): a for name, a in partial.arrays.items() if name.startswith(lead)}
            found.append(plan.finish(plan.unpacked(PartialResult(own, facts)), {}, execution))
        return found


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
    plans = [_planned(k, *each) for k, each in enumerate(zip(jobs, robots, known, strict=True))]
    if settled is None and job.voxel_size_m is None:
        size = shared_voxel_size(plans)
        jobs = [each.model_copy(update={"voxel_size_m": size}) for each in jobs]
        plans = [_planned(k, *each, None) for k, each in enumerate(zip(jobs, robots, strict=True))]
    return SeveralPlans(names, plans)


def shared_voxel_size(plans: Sequence[Any]) -> float:
    """Edge of the voxels [m] of several robots: the smallest of their own with which no robot's samples leave holes."""
    return max(min(plan.voxel_size_m for plan in plans), *(plan.least_voxel_size_m for plan in plans))


def workspace_job(job: Any, arm: PlacedRobot, refined_volume: float | None = None) -> Any:
    """The workspace job of one robot of a job of several."""
    choices = {name: getattr(job, name) for name in (*IndexChoices.model_fields, "voxel_size_m", "max_samples")}
    choices["voxel_statistics"] = ("count", "maximum")  # what robots are compared by
    own = {"robot": arm.robot, "base": arm.base, "tip": arm.tip, "sampling": arm.sampling}
    return job_classes()["workspace"](**choices, **own, refined_volume=refined_volume)


def robot_names(arms: tuple[PlacedRobot, ...], robots: tuple[Robot, ...]) -> list[str]:
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


def _planned(number: int, job: Any, robot: Robot, resolved: dict[str, Any] | None) -> Any:
    try:
        return planned(job, robot, resolved=resolved)
    except InputError as error:
        if error.field == "voxel_size_m":  # the job's, not the robot's
            raise
        raise error.within(dotted(("robots", number))) from None


def progress_after(before: int, tell: Tell) -> Tell:
    """A progress that adds to what was done before."""
    return lambda done: tell(before + done)
