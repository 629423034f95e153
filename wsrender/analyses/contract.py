"""The contract of analyses: what each of them says of a job, and what is the same for all."""

import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping
from copy import copy
from dataclasses import asdict, dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np
from pydantic import TypeAdapter

from wsrender.analyses.cost import Cost, Costed, check_memory
from wsrender.analyses.execution import Execution
from wsrender.analyses.headline import no_headline
from wsrender.analyses.partial_result import PartialResult, Refinements, plain
from wsrender.analyses.piece import Piece
from wsrender.analyses.provenance import job_entry, provenance, robot_entry
from wsrender.analyses.settled_device import settled_device
from wsrender.collision.asked import noted
from wsrender.documents.format import FORMAT
from wsrender.engine import thread_count
from wsrender.engine.sweep_plan import CHUNK_LEAST
from wsrender.notices import Notice, entries
from wsrender.results.result import Result
from wsrender.robot import Robot
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData

if TYPE_CHECKING:
    import trimesh

Tell = Callable[[int], None]
"""Called with the samples of a shard done so far; of a refinement with the points decided."""
Progress = Callable[[int, int, str], None]
"""Called with what is done, about how much there will be, and what is going on."""


@dataclass(frozen=True)
class Settled:
    """What planning settles once, in plain values: every process that takes part in a job computes with the same.

    ``device``: what "auto" means; ``target``: of its kernels; ``shards``: (first sample, number) of each;
    ``shard_unit``: at whose multiples the samples may be divided into shards, None: not at all; ``iterates``: whether
    nobody knows beforehand how many samples it takes. An analysis that settles more adds fields.
    """

    device: str
    target: str
    shards: tuple[tuple[int, int], ...]
    shard_unit: int | None = None
    iterates: bool = False

    def entry(self) -> dict[str, Any]:
        """As JSON values by field."""
        return TypeAdapter(dict[str, Any]).dump_python(asdict(self), mode="json")

    @classmethod
    def of(cls, entry: Mapping[str, Any]) -> Self:
        """What an `entry` says, tuples and numbers as the fields have them."""
        return TypeAdapter(cls).validate_python(dict(entry))


@dataclass(frozen=True, eq=False)
class Draft:
    """What a result holds of the analysis itself; the contract adds what every result document has.

    ``entries``: of the document; ``headline``: None where it measures no workspace; ``provenance``: what is said beside
    versions, target and seed; ``timing_s``: of parts. The others are those of `Result`.
    """

    entries: dict[str, Any]
    headline: dict[str, Any] | None = None
    notices: Iterable[Notice] = ()
    provenance: dict[str, Any] = field(default_factory=dict)
    timing_s: Mapping[str, float] = field(default_factory=dict)
    map: DistributionMap | None = None
    sample: DistributionMap | None = None
    volume: VolumeData | None = None
    skeleton: np.ndarray | None = None
    meshes: "dict[str, trimesh.Trimesh]" = field(default_factory=dict)
    tables: dict[str, Table] = field(default_factory=dict)
    volumes: dict[str, VolumeData] = field(default_factory=dict)


class Analysis(Costed, ABC):
    """A planned job with its robots, as those who run it see it: the `Plan` of `wsrender.run`.

    An analysis says what is `settled` once, what it costs, how a shard is computed, and what the result is; one that
    can be divided merges partial results too. Whatever follows from job, robots and settled values is a cached
    property: other processes have it without settling anything again.
    """

    settles: ClassVar[type[Settled]] = Settled
    job: Any
    settled: Any  # of the class `settles`
    resumes: ClassVar[bool] = False  # `compute` goes on from the file ``execution.checkpoint``, with the same result
    effort: ClassVar[float] = 1.0  # a sample's time in those of a sweep
    programs: dict[str, Any]  # of collisions, by key: what planning has asked for
    notices: tuple[Notice, ...] = ()  # of the robots, where `wsrender.run.steps` has loaded them

    def __init__(self, job: Any, *robots: Robot, resolved: Mapping[str, Any] | None = None):
        """Plan a job, or take what `resolved` of an earlier plan of it says.

        Raises what `prepare` raises, ResourceError where memory does not suffice, and InputError where the device of
        the earlier plan is not here.
        """
        self.job, self.robots = job, robots
        device = settled_device(self.asked_device, resolved)
        with noted() as self.programs:
            self.settled = self.prepare(*device) if resolved is None else self.settles.of(resolved)
        if resolved is None:
            self.check_memory()

    @abstractmethod
    def prepare(self, device: str, target: str) -> Settled:
        """Check what cannot be computed, and settle what is settled once; nothing has run or been allocated then."""

    def check_memory(self) -> None:
        """Whether what the job takes of memory can be taken; raises ResourceError."""
        check_memory(self.cost)

    @property
    def program_bytes(self) -> float:
        """Of memory for the `programs` of collisions: here, and for every thread of the CPU that labels samples."""
        threads = min(thread_count(), -(-self.samples // CHUNK_LEAST)) if self.device == "cpu" else 0
        return float((1 + threads) * sum(each.nbytes for each in self.programs.values()))

    @property
    @abstractmethod
    def cost(self) -> Cost:
        """Samples, memory, bytes of files and seconds, from plan to result."""

    @abstractmethod
    def compute(self, shard: int, execution: Execution, tell: Tell) -> Any:
        """The partial result of a shard, a `PartialResult` or what has its method ``packed``."""

    def merge(self, a: Any, b: Any) -> Any:
        """The partial result of both, the same bits in any order; an analysis of one shard has nothing to merge."""
        raise ValueError(f"{self.job.analysis} has one shard")

    @property
    def refinements(self) -> int:
        """How many things are asked beside the samples that follow from what is settled."""
        return 0

    def refinement(self, number: int, progress: Progress | None, execution: Execution) -> Any:
        """One of the `refinements`, as plain JSON values; a shard of its own where the job is divided."""
        raise ValueError(f"{self.job.analysis} has no refinements")

    def with_refinements(self, partial: Any, refinements: list[Any]) -> Any:
        """The merged partial result with all of its `refinements`, if there are any."""
        return partial

    def refine(self, partial: Any, progress: Progress | None, execution: Execution) -> Any:
        """The merged partial result with what else was asked, and depends on it; the same object: nothing was."""
        return partial

    @abstractmethod
    def result(self, partial: Any, execution: Execution) -> Draft:
        """What the merged and refined partial result says."""

    def read(self, partial: PartialResult) -> Any:
        """The partial result, of samples or refinements, that was ``packed``; raises what `unpacked` does."""
        return Refinements.of(partial) if Refinements.are(partial) else self.unpacked(partial)

    def unpacked(self, partial: PartialResult) -> Any:
        """The partial result that was ``packed``; raises KeyError, TypeError or ValueError where it is of another."""
        return partial

    def about_robots(self) -> dict[str, Any]:
        """The document's ``robot`` of a job that is an arm itself, or else ``robots``."""
        if () in self.job.arms():
            return {"robot": robot_entry(self.robots[0])}
        robots = [{"name": robot.name, "robot": robot_entry(robot)} for robot in self.robots]
        return {"robots": robots} if robots else {}

    @property
    def asked_device(self) -> str:
        """The device that the job asks for, such as "auto"."""
        return getattr(self.job, "device", "cpu")

    @property
    def robot(self) -> Robot:
        """The robot of a job of one."""
        (robot,) = self.robots
        return robot

    @property
    def device(self) -> str:
        """Where the kernels run."""
        return self.settled.device

    @property
    def target(self) -> str:
        """Target of the kernels."""
        return self.settled.target

    @property
    def shards(self) -> list[tuple[int, int]]:
        """(first sample, number of samples) of every shard."""
        return list(self.settled.shards)

    @property
    def samples(self) -> int:
        """Samples of all shards."""
        return sum(count for _, count in self.shards)

    @property
    def pieces(self) -> list[Piece]:
        """The samples as they may be divided."""
        return [Piece(0, self.samples, self.settled.shard_unit)]

    def divided(self, size: float, most: int) -> list[tuple[int, int]]:
        """Shards that take about as long as ``size`` samples of a sweep, about ``most`` of them at most.

        Those at the end, without samples, are the `refinements`.
        """
        size = max(size / self.effort, self.samples / most, 1)
        shards = [shard for piece in self.pieces for shard in piece.divided(size)]
        return (shards or [(0, 0)]) + [(self.samples, 0)] * self.refinements

    def division(self, size: float, most: int) -> Settled:
        """What is settled, `divided` into shards; they may be the first of several rounds, see `further`."""
        return replace(self.settled, shards=tuple(self.divided(size, most)))

    def further(self, partial: Any, execution: Execution) -> Settled | None:
        """What is settled with one more round of shards, which follow from the merged ones; None: they were all."""
        return None

    def settled_as(self, settled: Any) -> Self:
        """The plan with other shards."""
        plan = copy(self)
        plan.settled = settled
        return plan

    def resolved(self) -> dict[str, Any]:
        """What is settled, as JSON values: with it another process plans the same."""
        return self.settled.entry()

    def over(self, first: int, number: int) -> Self:
        """The plan with one shard, of these samples."""
        return self.settled_as(replace(self.settled, shards=((first, number),)))

    def run_shard(self, shard: int, progress: Tell | None, execution: Execution) -> Any:
        """The partial result of a shard."""
        tell = progress or (lambda done: None)
        own = [number for number, (_, count) in enumerate(self.shards) if count or number == 0]
        if shard < len(own):
            return self.compute(shard, execution, tell)
        number = shard - len(own)
        return Refinements({number: self.refinement(number, lambda done, total, message: tell(done), execution)})

    def merged(self, a: Any, b: Any) -> Any:
        """The partial result of both, of samples, refinements or both; the same bits in any order."""
        a, b = Refinements.beside(a), Refinements.beside(b)
        both = [each.samples for each in (a, b) if each.samples is not None]
        samples = self.merge(*both) if len(both) == 2 else next(iter(both), None)
        entries = {**a.entries, **b.entries}
        return Refinements(entries, samples) if entries else samples

    def refined(self, partial: Any, progress: Progress | None, execution: Execution) -> Any:
        """The merged partial result with what was asked beside the samples; the same object: nothing was."""
        known = Refinements.beside(partial)
        entries = [
            known.entries[k] if k in known.entries else plain(self.refinement(k, progress, execution))
            for k in range(self.refinements)
        ]
        own = self.with_refinements(known.samples, entries) if entries else known.samples
        return self.refine(own, progress, execution)

    def finish(self, partial: Any, seconds: Mapping[str, float], execution: Execution) -> Result:
        """The result: what the analysis has found, and around it what every result document has."""
        started = time.perf_counter()
        job, draft = self.job, self.result(partial, execution)
        document = {
            "format": FORMAT,
            "analysis": job.analysis,
            "job": job_entry(job, *self.robots),
            **self.about_robots(),
            **draft.entries,
            "headline": draft.headline or no_headline(f"the analysis {job.analysis} measures none"),
            "warnings": entries((*self.notices, *draft.notices)),
            "provenance": provenance(job, self.target, **draft.provenance),
            "timing_s": {**seconds, **draft.timing_s, "finish": time.perf_counter() - started},
        }
        data = (draft.map, draft.sample, draft.volume, draft.skeleton, draft.meshes, draft.tables, draft.volumes)
        return Result(document, *data)
