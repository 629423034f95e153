"""Volumes of a robot whose limits, tool and placement change while a person looks: one index, on a block that stays."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from wsrender.documents.sampling import Sobol
from wsrender.engine import Partial, devices_of, sweep, units_of
from wsrender.engine.first_pass import FirstPass
from wsrender.engine.voxel_data import voxels_of
from wsrender.errors import InputError
from wsrender.indices.index_catalogue import resolve
from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.pipeline.evaluation import Evaluation
from wsrender.pipeline.pipeline import Pipeline
from wsrender.pipeline.sampling import plan_sampling
from wsrender.robot.constraints import constraints_of_job
from wsrender.robot.indices import evaluation_of_job
from wsrender.robot.model_robot import Robot
from wsrender.robots.plausibility import need_ranges
from wsrender.short_repr import short_repr
from wsrender.volume.lattice import LatticeBlock, block_of_all
from wsrender.volume.voxels import Voxels

CHUNK = 1 << 15  # samples between two looks at whether a sweep is still wanted
LOOK_S = 0.005
Limits = Mapping[str, tuple[float, float]]


@dataclass(frozen=True, eq=False)
class LiveVolume:
    """The ``voxels`` of a ``block`` that hold a sample of the ``pipeline``; ``unit`` of the index.

    ``best`` (V,) int64: of each the number of the sample with the largest value; None until it is asked for.
    """

    block: LatticeBlock
    voxels: Voxels
    pipeline: Pipeline
    unit: str
    best: np.ndarray | None = None

    __repr__ = short_repr


class LiveVolumes:
    """Volumes of a ``robot`` that is changed again and again, under a job's ``choices`` of indices and constraints.

    ``choices`` are what `evaluation_of_job` and `constraints_of_job` take; their ``held_joints`` are locked. What does
    not change with limits is kept: the constraints with their tables, and the block of the robot's own limits.
    """

    def __init__(self, robot: Robot, choices: Any, *, seed: int = 0, device: str = "cpu", threads: int | None = None):
        self.robot, self.choices, self.seed, self.device, self.threads = robot, choices, seed, device, threads
        self._constraints: tuple[bytes, tuple[Constraint, ...]] | None = None
        self._units: dict[str, str] = {}
        self._whole: tuple[tuple[bytes, float], LatticeBlock] | None = None

    def volume(
        self,
        index: str,
        statistic: str,
        samples: int,
        voxel_size_m: float | None,
        *,
        limits: Limits | None = None,
        tool: np.ndarray | None = None,
        placement: np.ndarray | None = None,
        most_voxels: float = np.inf,
        progress: Callable[[int], None] | None = None,
    ) -> LiveVolume:
        """What a job ``workspace`` of the changed robot finds, bit for bit, on a block that its limits leave alone.

        That is the block of the robot's own limits, larger where the new ones reach beyond. ``voxel_size_m`` [m]; None:
        the job's default. ``progress`` is called a
        few times in a hundredth of a second with the samples done; the sweep ends where it raises. Raises InputError
        for what does not go together, a block of more than ``most_voxels`` among it.
        """
        robot = self.robot.changed(limits=limits, tool=tool, placement=placement)
        need_ranges(robot.chain.held(self.choices.held_joints), "limits")
        choices = self.choices.model_copy(update={"indices": (index,), "index_options": self._options(index)})
        evaluation = evaluation_of_job(choices, robot)
        locked = dict(self.choices.held_joints)
        first = FirstPass(evaluation, locked)
        sampling = plan_sampling(robot.chain, Sobol(samples, seed=self.seed, locked=locked))
        if voxel_size_m is None:
            voxel_size_m = first.voxel_size(sampling)
        own = first.block(voxel_size_m)
        whole = block_of_all([own, *self._whole_block(locked, voxel_size_m, tool, placement)])
        if whole.size > most_voxels:
            least = voxel_size_m * (whole.size / most_voxels) ** (1 / 3)
            message = f"{voxel_size_m:g} gives {whole.size} voxels; at most {most_voxels:g} are allowed: take"
            raise InputError("voxel_size_m", f"{message} {least:.2g} m or more")
        pipeline = Pipeline(
            evaluation,
            sampling,
            self._constraints_of(robot, limits or {}),
            own,
            frozenset({"count", statistic}),
            None,
            first.bounds if statistic == "mean" else None,
            choices.precision,
        )
        found = voxels_of(pipeline, self._swept(pipeline, progress))
        moved = found.moved(whole.shape, np.subtract(own.first_voxel, whole.first_voxel))
        return LiveVolume(whole, moved, pipeline, self._unit(evaluation))

    def with_best(self, volume: LiveVolume, progress: Callable[[int], None] | None = None) -> LiveVolume:
        """The volume with its best samples, by another sweep."""
        pipeline = volume.pipeline
        kept = pipeline.statistics | {"maximum"}
        found = self._swept(replace(pipeline, statistics=kept, best=pipeline.evaluation.indices[0]), progress)
        return replace(volume, best=found.best)

    def _swept(self, pipeline: Pipeline, progress: Callable[[int], None] | None) -> Partial:
        devices = devices_of(self.device)
        how = {"threads": self.threads, "chunk_size": None if devices[0].is_cuda else CHUNK, "look_s": LOOK_S}
        return sweep(pipeline, 0, pipeline.sampling.count, devices, progress=progress, **how)

    def _unit(self, evaluation: Evaluation) -> str:
        """The unit of the one index: limits do not change it."""
        (name,) = evaluation.indices
        if name not in self._units:
            self._units[name] = units_of(evaluation)[name]
        return self._units[name]

    def _options(self, index: str) -> dict[str, Any]:
        """The options of the one index, whichever of its names the choices use."""
        options, has_inertia = self.choices.index_options, self.robot.has_inertia
        (name,) = resolve((index,), has_inertia)
        return {key: each for key, each in options.items() if resolve((key,), has_inertia) == (name,)}

    def _whole_block(
        self, locked: dict[str, float], size: float, tool: np.ndarray | None, placement: np.ndarray | None
    ) -> list[LatticeBlock]:
        """The block of the robot's own limits, wherever it stands and whatever its tool; none of endless ones."""
        chain = self.robot.changed(tool=tool, placement=placement).chain
        if chain.held(locked).endless:
            return []
        key = chain.T_world_base.tobytes() + chain.T_tip_tool.tobytes(), size
        if self._whole is None or self._whole[0] != key:
            self._whole = key, FirstPass(Evaluation(chain), locked).block(size)
        return [self._whole[1]]

    def _constraints_of(self, robot: Robot, limits: Limits) -> tuple[Constraint, ...]:
        """The constraints of a robot; those of the robot's own limits hold within them too."""
        if not (self.choices.constraints or self.choices.environment):
            return ()
        own, names = self.robot.chain, self.robot.joint_names
        within = all(
            own.lower_limits[k] <= low and high <= own.upper_limits[k]
            for k, (low, high) in ((names.index(name), ends) for name, ends in limits.items())
        )
        if not within:
            return constraints_of_job(self.choices, robot)
        key = robot.chain.T_world_base.tobytes() + robot.chain.T_tip_tool.tobytes()
        if self._constraints is None or self._constraints[0] != key:
            placed = self.robot.changed(tool=robot.chain.T_tip_tool, placement=robot.chain.T_world_base)
            self._constraints = key, constraints_of_job(self.choices, placed)
        return self._constraints[1]
