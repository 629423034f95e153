"""Several robots on one lattice: a workspace plan for each, swept one after the other."""

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import count
from typing import Any

import numpy as np

from wsrender.analyses.cost import DOCUMENT_BYTES, Cost, in_turn, pictures_cost, refined_seconds
from wsrender.analyses.execution import Execution
from wsrender.analyses.refined import Progress, Refined
from wsrender.analyses.robot_comparison.job import RobotComparisonJob
from wsrender.analyses.workspace.job import WorkspaceJob
from wsrender.documents.arm import dotted
from wsrender.documents.index_choices import IndexChoices
from wsrender.documents.several_robots import PlacedRobot
from wsrender.errors import InputError
from wsrender.results.result import Result
from wsrender.robot import Robot
from wsrender.run.partial_arrays import partial_of_arrays, partial_to_arrays
from wsrender.run.workspace import WorkspacePlan, plan_workspace

MEASURE = "measure"  # array of a robot's refined measure


@dataclass(eq=False)
class SeveralPlans:
    """Workspace plans of K robots at one voxel size, device and target."""

    names: list[str]
    plans: list[WorkspacePlan]

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

    def resolved(self) -> dict[str, Any]:
        """What is settled once: device, target, the shard, and what each robot's plan says."""
        first = self.plans[0]
        robots = [plan.resolved() for plan in self.plans]
        return {"device": first.device, "target": first.target, "shards": [[0, self.samples]], "robots": robots}

    def run(self, progress: Callable[[int], None] | None, execution: Execution) -> dict[str, np.ndarray]:
        """Sweep every robot; the partial results as arrays, their names led by the robot's number."""
        arrays, done = {}, 0
        for k, plan in enumerate(self.plans):
            partial = plan.run_shard(0, progress_after(done, progress), execution)
            arrays |= {f"{k}_{name}": array for name, array in partial_to_arrays(partial).items()}
            done += plan.shards[0][1]
        return arrays

    def refine(
        self, arrays: dict[str, np.ndarray], progress: Progress | None, execution: Execution
    ) -> dict[str, np.ndarray]:
        """With the refined measure of every robot whose plan asks for it."""
        measures = {f"{k}_{MEASURE}": plan.measured(progress, execution) for k, plan in enumerate(self.plans)}
        return arrays | {name: np.array(json.dumps(entry)) for name, entry in measures.items() if entry}

    def results(self, arrays: dict[str, np.ndarray], execution: Execution) -> list[Result]:
        """The workspace result of every robot."""
        found = []
        for k, plan in enumerate(self.plans):
            own = {name.partition("_")[2]: array for name, array in arrays.items() if name.startswith(f"{k}_")}
            entry = json.loads(str(own.pop(MEASURE))) if MEASURE in own else None
            partial = replace(partial_of_arrays(own, plan), refined=entry and Refined(entry, None))
            found.append(plan.finish(partial, {}, execution))
        return found


def plan_several(job: Any, robots: tuple[Robot, ...], resolved: dict[str, Any] | None) -> SeveralPlans:
    """Workspace plans of a job's robots at its voxel size, or at the one that they share by default."""
    settled = resolved["robots"] if resolved else [None] * len(robots)
    names = robot_names(job.robots, robots)
    jobs = [workspace_job(job, arm) for arm in job.robots]
    plans = [_planned(k, *each) for k, each in enumerate(zip(jobs, robots, settled, strict=True))]
    if resolved is None and job.voxel_size_m is None:
        size = shared_voxel_size(plans)
        jobs = [each.model_copy(update={"voxel_size_m": size}) for each in jobs]
        plans = [_planned(k, *each, None) for k, each in enumerate(zip(jobs, robots, strict=True))]
    return SeveralPlans(names, plans)


def shared_voxel_size(plans: Sequence[WorkspacePlan]) -> float:
    """Edge of the voxels [m] of several robots: the smallest of their own with which no robot's samples leave holes."""
    return max(min(plan.voxel_size_m for plan in plans), *(plan.least_voxel_size_m for plan in plans))


def workspace_job(job: Any, arm: PlacedRobot) -> WorkspaceJob:
    """The workspace job of one robot of a job of several: with its own refined volume where robots are compared."""
    choices = {name: getattr(job, name) for name in (*IndexChoices.model_fields, "voxel_size_m", "max_samples")}
    choices["voxel_statistics"] = ("count", "maximum")  # what robots are compared by
    choices["refined_volume"] = job.refined_volume if isinstance(job, RobotComparisonJob) else None
    own = {"robot": arm.robot, "base": arm.base, "tip": arm.tip, "sampling": arm.sampling}
    return WorkspaceJob(**choices, **own)


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


def _planned(number: int, job: WorkspaceJob, robot: Robot, resolved: dict[str, Any] | None) -> WorkspacePlan:
    try:
        return plan_workspace(job, robot, resolved)
    except InputError as error:
        if error.field == "voxel_size_m":  # the job's, not the robot's
            raise
        raise error.within(dotted(("robots", number))) from None


def progress_after(before: int, progress: Callable[[int], None] | None) -> Callable[[int], None] | None:
    """A progress that adds to what was done before."""
    return None if progress is None else lambda done: progress(before + done)
