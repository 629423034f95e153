"""The analysis ``shared_workspace``: what several robots reach together."""

from collections.abc import Iterator
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from wsrender.analyses.contract import Analysis, Draft, Progress, Tell
from wsrender.analyses.cost import DOCUMENT_BYTES, Cost, in_turn, pictures_cost, refined_seconds
from wsrender.analyses.execution import Execution
from wsrender.analyses.headline import headline_of
from wsrender.analyses.partial_result import PartialResult
from wsrender.analyses.refined import by_measure, refined_together
from wsrender.analyses.registry import planned
from wsrender.analyses.several_result import common_entries, notices_of_each, sampling_path, skeletons
from wsrender.analyses.several_robots import SeveralPlans, SeveralSettled, plan_several, progress_after, workspace_job
from wsrender.analyses.shared_workspace.job import SharedWorkspaceJob
from wsrender.analyses.volume_notices import occupied_differs, tolerance_not_met
from wsrender.documents.placement_scan import PlacementScan
from wsrender.multi.shared_volume import NUMBER, PRODUCT, reached_by, shared_volume, volume_by_number
from wsrender.notices import Notice
from wsrender.reach import Event
from wsrender.volume.lattice import block_of_all, check_voxels
from wsrender.volume.measure import TABLE_UNITS
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData

if TYPE_CHECKING:
    import trimesh


VOLUME_BYTES = 9  # of a voxel of each robot's volume: samples, and whether there are any
REACHED = {"any": "jointly reachable", "shared": "shared"}  # of which volume


class SharedWorkspaceAnalysis(Analysis):
    """A planned ``shared_workspace`` job: one shard, in which the robots are swept one after the other."""

    settles = SeveralSettled
    job: SharedWorkspaceJob
    settled: SeveralSettled

    def prepare(self, device: str, target: str) -> SeveralSettled:
        """Raises InputError, MissingInertiaError, ResourceError."""
        several = self.several = plan_several(self.job, self.robots)
        _check_volume(several)
        samples = several.samples + sum(plan.shards[0][1] for plan in self.scanned)
        return several.settled(((0, samples),))

    @cached_property
    def several(self) -> SeveralPlans:
        """The plans of the robots."""
        return plan_several(self.job, self.robots, self.settled)

    @cached_property
    def scanned(self) -> list[Any]:
        """Plans of the moved robot, one for each value of the scan."""
        if self.job.scan is None:
            return []
        arm, robot = self.job.robots[self.job.scan.robot], self.robots[self.job.scan.robot]
        first = self.several.plans[0]
        at = workspace_job(self.job, arm).model_copy(
            update={"voxel_size_m": first.voxel_size_m, "device": first.device}
        )
        return [planned(at, robot.placed(each)) for each in self.job.scan.placements(arm.robot.placement)]

    def about_robots(self) -> dict[str, Any]:
        """Nothing: the result says each robot with its numbers."""
        return {}

    @property
    def cost(self) -> Cost:
        """Samples, bytes and seconds."""
        swept = in_turn(plan.swept_cost for plan in [*self.several.plans, *self.scanned])
        drawn, seconds = pictures_cost("slices", "product", "robot")
        seconds += refined_seconds(self.job.refined_volume) * (1 + len(self.scanned))
        files = DOCUMENT_BYTES + drawn + sum(plan.volume_bytes for plan in self.several.plans) * 1.5
        return Cost(swept.samples, swept.memory_bytes, files, swept.seconds + seconds)

    def compute(self, shard: int, execution: Execution, tell: Tell) -> PartialResult:
        """Partial results of the robots, and the volumes of every step of the scan."""
        partial = self.several.run(execution, tell)
        if self.job.scan is None:
            return partial
        scan = self._scan(self.job.scan, partial, execution, tell)
        return PartialResult({**partial.arrays, "scan": scan}, partial.facts)

    def refine(self, partial: PartialResult, progress: Progress | None, execution: Execution) -> PartialResult:
        """With the refined volumes, if asked."""
        tolerance, scan = self.job.refined_volume, self.job.scan
        if tolerance is None:
            return partial
        robots = zip(self.robots, self.job.robots, strict=True)
        chains = [robot.chain.held(arm.sampling.locked) for robot, arm in robots]
        events = {"any": Event(1, len(chains)), "shared": Event(2, len(chains))}
        how = {"device": self.several.plans[0].device, "progress": progress, "threads": execution.threads}
        together = refined_together(chains, events, tolerance, **how)
        facts = {**partial.facts, "refined": together}
        if scan is None or together["shared"]["value"] is None:
            return PartialResult(partial.arrays, facts)
        rows = []
        for T_world_base in self._scanned_bases():
            chains[scan.robot] = chains[scan.robot].placed(T_world_base)
            volumes = refined_together(chains, events, tolerance, **how)
            rows.append([_with_interval(volumes[name]) for name in events])
        return PartialResult({**partial.arrays, "scan_refined": np.array(rows)}, facts)

    def result(self, partial: PartialResult, execution: Execution) -> Draft:
        """Number of robots by voxel, product of their normalised indices, union and intersection."""
        results = self.several.results(partial, execution)
        volumes = {f"robot_{name}": r.volume for name, r in zip(self.several.names, results, strict=True) if r.volume}
        shared = shared_volume(list(volumes.values()))
        by_number = volume_by_number(shared, len(volumes))
        meshes, surfaces = _meshes(shared)
        any_m3, shared_m3 = float(by_number.sum()), float(by_number[2:].sum())
        found = partial.facts.get("refined")
        shared_measure = found and found["shared"]
        measures = by_measure(shared_measure, found)
        refined = measures["volume_m3"]["refined"]
        known = found if shared_measure and shared_measure["value"] is not None else None
        document = {
            **common_entries(self.several, results),
            **measures,
            "volume_m3": {
                "any": any_m3,
                "shared": shared_m3,
                "exactly": {str(k): float(by_number[k]) for k in range(1, len(by_number))},
                "refined": refined,
            },
            "shared_ratio": _ratio(known) if known else shared_m3 / any_m3,
            "shared_ratio_volume": "refined" if known else "occupied",
            "quality": _quality(shared),
            "surfaces": surfaces,
        }
        scan = self.job.scan
        scanned = partial.arrays.get("scan_refined")
        tables = {"scan": _scan_table(scan, partial["scan"], scanned, shared_measure)} if scan else {}
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

    def _scanned_bases(self) -> list[np.ndarray]:
        """Where the base of the moved robot stands at each value, (4, 4) each."""
        return [plan.robot.chain.T_world_base for plan in self.scanned]

    def _scan(self, scan: PlacementScan, partial: PartialResult, execution: Execution, tell: Tell) -> np.ndarray:
        """Volumes (values, K) [m³] reached by at least 1 … K robots at each value."""
        volumes = [result.volume for result in self.several.results(partial, execution)]
        before, rows = self.several.samples, []
        for plan in self.scanned:
            moved = SeveralPlans([""], [plan])
            (result,) = moved.results(moved.run(execution, progress_after(before, tell)), execution)
            volumes[scan.robot] = result.volume
            by_number = volume_by_number(shared_volume([v for v in volumes if v is not None]), len(volumes))
            rows.append(np.cumsum(by_number[:0:-1])[::-1])
            before += plan.shards[0][1]
        return np.array(rows)


def _check_volume(several: SeveralPlans) -> None:
    """Whether the arrays of what robots share fit in memory, however far apart they stand; raises ResourceError."""
    plans = [plan.sweep for plan in several.plans]
    products = len(plans[0].evaluation.indices) if "maximum" in plans[0].statistics else 0
    blocks = [plan.block for plan in plans if plan.block is not None]
    check_voxels(block_of_all(blocks), len(plans) * VOLUME_BYTES + 4 * (1 + products))


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
    scan: PlacementScan, at_least: np.ndarray, refined: np.ndarray | None, measure: dict[str, Any] | None
) -> Table:
    """By value: volumes of the occupied voxels, and the refined ones with their intervals where they were asked for."""
    names = ("any", "shared")
    units = {f"occupied_{name}": "m^3" for name in names}
    columns = {f"occupied_{name}": at_least[:, k] for k, name in enumerate(names)}
    if refined is not None and measure is not None:
        found = {}
        for k, name in enumerate(names):
            found |= dict(zip((name, f"{name}_low", f"{name}_high"), refined[:, k].T, strict=True))
        units |= dict.fromkeys(found, TABLE_UNITS[measure["unit"]])
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
