"""One attempt at a computation, as the dispatcher follows it: steps out, progress in."""

import time
from dataclasses import dataclass, field
from typing import Any

from distributed import Future

from wsrender_server.jobs.files import DataFolder
from wsrender_server.jobs.records import ComputationRecord, Progress
from wsrender_server.jobs.steps import partial_name
from wsrender_server.jobs.task import Step, Task, TaskLimits

MESSAGES = {Step.PLAN: "planning", Step.SHARD: "samples", Step.FINISH: "finishing"}


@dataclass(eq=False)
class Attempt:
    """What is out on the workers for a computation, and how far it is."""

    record: ComputationRecord
    target: str
    resolved: dict[str, Any] | None
    generation: int  # of the scheduler's losses, so that a lost task's name is not used again
    limits: TaskLimits | None = None
    futures: dict[tuple[Step, int], Future] = field(default_factory=dict)
    step: Step = Step.PLAN
    done: dict[int, int] = field(default_factory=dict)  # samples done by shard; of a refinement, points decided
    decided: tuple[int, int] = (0, 0)  # tables of the first step, points of the last, and about how many there will be
    kept: int = 0  # samples that an earlier run of the server had done
    begun: bool = False  # whether a worker has come to it
    turn: int = 0  # of its owner, see `FairShare`
    losses: int = 0
    started: float = 0.0
    seconds: dict[str, float] = field(default_factory=dict)
    failure: dict[str, Any] | None = None  # why it has ended, until the database has taken it
    stopping: bool = False  # whether its tasks were told to end, until the database has taken that
    stale: bool = False  # whether the newest progress has not been recorded yet

    @property
    def token(self) -> str:
        """Name of the attempt on the workers."""
        return f"{self.record.id}-{self.record.attempt}"

    @property
    def shards(self) -> list[list[int]]:
        """(first sample, samples) of every shard."""
        return self.resolved["shards"] if self.resolved else []

    def task(self, step: Step, shard: int = 0) -> Task:
        """A step as the workers take it."""
        return Task(
            step,
            self.record.id,
            self.token,
            self.record.document,
            self.resolved,
            shard,
            self.seconds if step == Step.FINISH else None,
            self.limits,
        )

    def key(self, step: Step, shard: int) -> str:
        """Name of a task in the cluster: the same after a restart of the server, so that it finds what still runs."""
        return f"{step}-{self.token}-{shard}-{self.generation}.{self.losses}"

    def missing(self, files: DataFolder) -> list[int]:
        """Shards whose partial results are not there; those that are count as done."""
        folder = files.partials(self.record.id)
        there = {path.name for path in folder.iterdir()} if folder.is_dir() else set()
        shards = range(len(self.shards))
        self.done.update({i: self.shards[i][1] for i in shards if partial_name(i) in there})
        return [i for i in shards if partial_name(i) not in there]

    def begin_shards(self, files: DataFolder) -> list[int]:
        """Enter the step of the shards; those that are to be computed."""
        self.step, self.started, self.stale, self.decided = Step.SHARD, time.monotonic(), True, (0, 0)
        missing = self.missing(files)
        self.kept = self.samples_done
        # Refinements take long: they begin early, yet not before any sample.
        return sorted(missing, key=lambda i: (i > 0, self.shards[i][1] > 0))

    @property
    def samples_done(self) -> int:
        """Samples of all shards that are done."""
        return sum(done for shard, done in self.done.items() if self.shards[shard][1])

    def reported(self, shard: int, done: int) -> None:
        """A worker has done so many samples of a shard, or decided so many points of a refinement."""
        if shard < len(self.shards):  # planning has none yet
            self.done[shard] = max(done, self.done.get(shard, 0))
        self.stale = True

    def refined(self, done: int, total: int) -> None:
        """The last step has decided so many points, or the first made so many tables, of about so many."""
        self.decided, self.stale = (done, total), True

    def progress(self) -> Progress:
        """How far the attempt is."""
        settled = self.resolved or {}
        total = settled.get("most_samples") or sum(count for _, count in self.shards) or None
        done = self.samples_done
        if settled.get("iterates"):
            total = None
        elapsed = time.monotonic() - self.started
        rate = (done - self.kept) / elapsed if self.step == Step.SHARD and elapsed > 0 and done > self.kept else None
        return Progress(
            fraction=0.0 if not total else 0.99 * min(done / total, 1.0),
            samples_done=done,
            samples_total=total,
            rate_per_s=rate,
            eta_s=None if rate is None or total is None else max(total - done, 0) / rate,
            message=self._message(total is not None and done >= total),
        )

    def _message(self, sampled: bool) -> str:
        """What is going on; once all is ``sampled``, how many points inverse kinematics has decided since."""
        decided, expected = self.decided
        refined = sum(done for shard, done in self.done.items() if not self.shards[shard][1])
        if self.step == Step.PLAN and expected:
            return f"planning: {decided:,} of {expected:,} collision tables"
        if self.step == Step.FINISH and decided:
            return f"finishing: {decided:,} of about {expected:,} points decided by inverse kinematics"
        if self.step == Step.SHARD and sampled and refined:
            return f"refining: {refined:,} points decided by inverse kinematics"
        return MESSAGES[self.step]
