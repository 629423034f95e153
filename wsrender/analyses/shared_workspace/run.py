"""The analysis ``shared_workspace``: what several robots reach together."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from wsrender.analyses.composed import Composed, Part, PartialParts, part_of
from wsrender.analyses.contract import Draft, Progress, Tell
from wsrender.analyses.cost import (
    DOCUMENT_BYTES,
    WRITTEN_PER_S,
    Asks,
    Cost,
    fits,
    in_turn,
    pictures_cost,
    refined_bytes,
    refined_seconds,
)
from wsrender.analyses.execution import Execution
from wsrender.analyses.headline import headline_of, no_headline
from wsrender.analyses.partial_result import PartialResult
from wsrender.analyses.refined import by_measure, divided, refined_together
from wsrender.analyses.registry import planned
from wsrender.analyses.several_result import common_entries, notices_of_each, sampling_path, skeletons
from wsrender.analyses.several_robots import SeveralPlans, SeveralSettled, arms_apart_of, plan_several, workspace_job
from wsrender.analyses.shared_workspace.job import SharedWorkspaceJob
from wsrender.analyses.volume_notices import occupied_differs, tolerance_not_met
from wsrender.documents.several_robots import PlacementScan
from wsrender.errors import InputError
from wsrender.multi import NUMBER, PRODUCT, reached_by, scanned_volumes, shared_volume, volume_by_number
from wsrender.notices import Notice
from wsrender.reach import Inside
from wsrender.robot import Robot
from wsrender.volume.lattice import block_of_all
from wsrender.volume.measure import NOT_ASKED, TABLE_UNITS
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData

if TYPE_CHECKING:
    import trimesh

    from wsrender.robot.arms_collision import ArmsApart

TOGETHER = "what the robots reach together is measured, not what each does: robot_comparison measures that"
# Of a voxel of the block of all: samples, number and products of indices; of each robot samples and indices;
# of what makes them.
SHARED_BYTES, VOLUME_BYTES, MAKING_BYTES = 12, 9, 60
FILLED = 0.7  # of the block that holds what robots may reach, the block of what they do
DENSE_PER_S = 2e8  # bytes of dense arrays that are made
REACHED = {"any": "jointly reachable", "shared": "shared"}  # of which volume


class SharedWorkspaceAnalysis(Composed):
    """A planned ``shared_workspace`` job: samples of every robot, and of the moved one at each value of the scan."""

    settles = SeveralSettled
    job: SharedWorkspaceJob
    settled: SeveralSettled

    def prepare(self, device: str, target: str) -> SeveralSettled:
        """Raises InputError, MissingInertiaError, ResourceError."""
        several = self.several = plan_several(self.job, self.robots)
        _ = self._apart(self.robots)
        return several.settled(several.samples + sum(plan.samples for plan in self.scanned))

    @cached_property
    def several(self) -> SeveralPlans:
        """The plans of the robots."""
        return plan_several(self.job, self.robots, self.settled)

    @cached_property
    def scanned(self) -> list[Any]:
        """Plans of the moved robot, one for each value of the scan: of a volume, only positions matter."""
        if self.job.scan is None:
            return []
        arm, robot = self.job.robots[self.job.scan.robot], self.robots[self.job.scan.robot]
        first = self.several.plans[0]
        alone = {"indices": (), "voxel_statistics": ("count",), "torque_scaling": False, "joint_limit_penalty": None}
        same = {"voxel_size_m": first.voxel_size_m, "device": first.device}
        at = workspace_job(self.job, arm).model_copy(update={**alone, **same})
        return [planned(at, robot.placed(each)) for each in self.job.scan.placements(arm.robot.placement)]

    def about_robots(self) -> dict[str, Any]:
        """Nothing: the result says each robot with its numbers."""
        return {}

    @property
    def parts(self) -> list[Part]:
        """The robots, and the moved one at each value."""
        return [*self.several.parts, *map(occupied_part, self.scanned)]

    @property
    def cost(self) -> Cost:
        """Samples, bytes and seconds."""
        several, tolerance, asked = self.several, self.job.refined_volume, self.job.constraints
        searched = bool(divided(several.plans[0].constraints)[1]) or bool(asked and asked.arms_collision)
        swept = in_turn([several.swept_cost, *(plan.swept_cost for plan in self.scanned)])
        (voxels, products), dense = self._block, self._dense_bytes
        later = several.kept_bytes + max(dense, refined_bytes(tolerance, searched)) + self.program_bytes
        memory = self._bits + max(swept.memory_bytes, later)
        drawn, seconds = pictures_cost("slices", "product", "surface")
        volumes = sum(plan.volume_bytes for plan in several.plans)
        files = DOCUMENT_BYTES + drawn + volumes + FILLED * voxels * (SHARED_BYTES + 4 * products)
        seconds += swept.seconds + refined_seconds(tolerance, searched) * len(several.plans) * (1 + len(self.scanned))
        seconds += dense / DENSE_PER_S + files / WRITTEN_PER_S
        asks = Asks("voxel_size_m", voxel_size_m=several.plans[0].voxel_size_m)
        return Cost(swept.samples, memory, files, seconds, asks)

    def check_memory(self) -> None:
        """Refused is what does not fit; see `WorkspaceAnalysis.check_memory`."""
        if not fits(self.several.most_bytes + self._dense_bytes + self._bits):
            super().check_memory()

    @property
    def _bits(self) -> float:
        """Bytes that say where the robot that the scan moves has been."""
        return sum(plan.pipeline.block.size for plan in self.scanned) / 8

    @property
    def _dense_bytes(self) -> float:
        """Of what is made of the block of all."""
        voxels, products = self._block
        own = VOLUME_BYTES + 4 * products
        return float(voxels * (SHARED_BYTES + 4 * products + own * len(self.several.plans) + MAKING_BYTES))

    @property
    def _block(self) -> tuple[int, int]:
        """Voxels of the block that holds what all robots may reach, and indices of which there are products."""
        pipelines = [plan.pipeline for plan in self.several.plans]
        products = len(pipelines[0].evaluation.indices) if "maximum" in pipelines[0].statistics else 0
        return block_of_all([each.block for each in pipelines if each.block is not None]).size, products

    @property
    def refinements(self) -> int:
        """The refined volumes, if asked: as the robots stand, and at each value of the scan."""
        return 0 if self.job.refined_volume is None else 1 + len(self.scanned)

    def refinement(self, number: int, progress: Progress | None, execution: Execution) -> dict[str, Any]:
        """The refined volumes as the robots stand (0), or at a value of the scan."""
        plans = list(self.several.plans)
        if self.job.scan is not None and number:
            plans[self.job.scan.robot] = self.scanned[number - 1]
        robots = [plan.robot for plan in plans]
        chains = [robot.chain.held(arm.sampling.locked) for robot, arm in zip(robots, self.job.robots, strict=True)]
        tolerance, device = self.job.refined_volume, self.several.plans[0].device
        assert tolerance is not None
        events = {"any": Inside(1, len(chains)), "shared": Inside(2, len(chains))}
        constraints = [plan.pipeline.constraints for plan in plans]
        options = device, progress, execution.threads, constraints, self._apart(robots, number)
        return refined_together(chains, events, tolerance, *options)

    def _apart(self, robots: Sequence[Robot], number: int = 0) -> "dict[tuple[int, int], ArmsApart]":
        """What keeps the robots apart where they stand; tables of collisions are made here.

        Raises InputError; it names the value of the scan where ``number`` is not 0.
        """
        try:
            return arms_apart_of(self.job.constraints, self.job.robots, robots, self.several.names)
        except InputError as error:
            if not number:
                raise
            raise InputError(error.field, f"{error.message} (at scan.values.{number - 1})") from None

    def with_refinements(self, partial: PartialParts, refinements: list[Any]) -> "SharedPartial":
        """With the refined volumes."""
        return SharedPartial(partial.parts, refinements)

    def result(self, partial: PartialParts, execution: Execution) -> Draft:
        """Number of robots by voxel, product of their normalised indices, union and intersection."""
        results = self.several.results(partial, execution)
        volumes = {f"robot_{name}": r.volume for name, r in zip(self.several.names, results, strict=True) if r.volume}
        shared = shared_volume(list(volumes.values()))
        by_number = volume_by_number(shared, len(volumes))
        meshes, surfaces = _meshes(shared)
        any_m3, shared_m3 = float(by_number.sum()), float(by_number[2:].sum())
        found, *at_values = partial.refined if isinstance(partial, SharedPartial) else (None,)
        shared_measure = found and found["shared"]
        measures = by_measure(shared_measure, found)
        refined = measures["volume_m3"]["refined"]
        known = found if found and found["shared"]["value"] is not None else None
        document = {
            **_measured_together(common_entries(self.several, results)),
            **measures,
            "volume_m3": {
                "any": any_m3,
                "shared": shared_m3,
                "exactly": {str(k): float(by_number[k]) for k in range(1, len(by_number))},
                **measures["volume_m3"],
            },
            "shared_ratio": _ratio(known) if known else shared_m3 / any_m3,
            "shared_ratio_volume": "refined" if known else "occupied",
            "quality": _quality(shared),
            "surfaces": surfaces,
        }
        scan = self.job.scan
        tables = {"scan": _scan_table(scan, self._scan(scan, partial), at_values, known)} if scan else {}
        own = _notices({"any": any_m3, "shared": shared_m3}, refined)
        return Draft(
            document,
            headline_of(shared_measure),
            (*notices_of_each(self.several.names, results), *own),
            {"sampling_path": sampling_path(results)},
            volume=shared,
            skeleton=skeletons(results),
            meshes=meshes,
            tables=tables,
            volumes=volumes,
        )

    def _scan(self, scan: PlacementScan, partial: PartialParts) -> np.ndarray:
        """Volumes (values, K) [m³] reached by at least 1 … K robots at each value."""
        robots = enumerate(self.several.plans)
        others = [(plan.pipeline.block, partial.parts[k].sweep.cells) for k, plan in robots if k != scan.robot]
        moved = enumerate(self.scanned, start=len(self.several.plans))
        return scanned_volumes(
            others, [(plan.pipeline.block, occupied_cells(plan, partial.parts[k])) for k, plan in moved]
        )


@dataclass(frozen=True, eq=False)
class SharedPartial(PartialParts):
    """With what is refined as the robots stand, and then at every value of the scan."""

    refined: list[Any]


def occupied_part(plan: Any) -> Part:
    """A sweep's plan of which nothing is kept but where it has been: a bit for each voxel of its block."""
    swept = part_of(plan)

    def compute(first: int, number: int, execution: Execution, tell: Tell) -> PartialResult:
        occupied = np.zeros(plan.pipeline.block.size, bool)
        occupied[swept.compute(first, number, execution, tell).sweep.cells] = True
        return PartialResult({"bits": np.packbits(occupied)})

    def merge(a: PartialResult, b: PartialResult) -> PartialResult:
        return PartialResult({"bits": a["bits"] | b["bits"]})

    return replace(swept, compute=compute, merge=merge, unpacked=lambda partial: partial)


def occupied_cells(plan: Any, partial: PartialResult) -> np.ndarray:
    """Numbers of the voxels, in the block of the plan, where its sweep has been."""
    return np.flatnonzero(np.unpackbits(partial["bits"], count=plan.pipeline.block.size))


def _measured_together(common: dict[str, Any]) -> dict[str, Any]:
    """The entries, in which every robot says why nothing of it alone is measured."""
    robots = [robot | {"headline": no_headline(TOGETHER)} for robot in common["robots"]]
    for robot in robots:
        if robot["global"]["structural_length_reason"] == NOT_ASKED:
            robot["global"] = robot["global"] | {"structural_length_reason": TOGETHER}
    return common | {"robots": robots}


def _meshes(shared: VolumeData) -> "tuple[dict[str, trimesh.Trimesh], dict[str, Any]]":
    """Surfaces of the union and, where there is one, of the intersection, with their entries."""
    from wsrender.geometry.surfaces import occupied_surface, surface_entry

    meshes = {"union": occupied_surface(shared)}
    both = reached_by(shared, 2)
    if both.n_occupied:
        meshes["intersection"] = occupied_surface(both)
    return meshes, {name: surface_entry(name, mesh) for name, mesh in meshes.items()}


def _quality(shared: VolumeData) -> dict[str, Any]:
    """Largest and mean product of each index over the shared voxels; None where there are none."""
    entries = {}
    for name, product in shared.statistics[PRODUCT].items():
        values = product[np.nan_to_num(shared.statistics[NUMBER]["robots"]) > 1].astype(np.float64)
        there = len(values) > 0
        entries[name] = {
            "maximum": float(values.max()) if there else None,
            "mean": float(values.mean()) if there else None,
        }
    return entries


def _with_interval(measure: dict[str, Any]) -> list[float]:
    """Value and interval; not a number where there is none, as of arms that the scan moves into different planes."""
    return [np.nan] * 3 if measure["value"] is None else [measure["value"], *measure["ci95"]]


def _scan_table(
    scan: PlacementScan, at_least: np.ndarray, at_values: list[dict[str, Any]], refined: dict[str, Any] | None
) -> Table:
    """By value: volumes of the occupied voxels, and the refined ones with their intervals where there are any."""
    units = {f"occupied_{name}": "m^3" for name in REACHED}
    columns = {f"occupied_{name}": at_least[:, k] for k, name in enumerate(REACHED)}
    if refined is not None:
        found = {}
        for name in REACHED:
            values = np.array([_with_interval(each[name]) for each in at_values])
            found |= dict(zip((name, f"{name}_low", f"{name}_high"), values.T, strict=True))
        units |= dict.fromkeys(found, TABLE_UNITS[refined["shared"]["unit"]])
        columns = found | columns
    return Table({scan.axis: np.array(scan.values), **columns}, {scan.axis: scan.unit, **units})


def _ratio(refined: dict[str, Any]) -> float:
    """Shared over any; 0 where nothing is reached."""
    return refined["shared"]["value"] / refined["any"]["value"] if refined["any"]["value"] else 0.0


def _notices(occupied: dict[str, float], refined: dict[str, Any] | None) -> Iterator[Notice]:
    """Where the occupied voxels are far from the volumes."""
    for name, volume in occupied.items():
        yield from occupied_differs(volume, refined[name]["value"] if refined else None, REACHED[name])
    yield from tolerance_not_met(refined and refined["shared"])
