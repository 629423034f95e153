"""The analysis ``method_comparison``: the four methods of [SNK], their Table 4 and Fig. 10."""

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from wsrender.analyses.cost import DOCUMENT_BYTES, Cost, pictures_cost
from wsrender.analyses.execution import Execution
from wsrender.analyses.headline import headline
from wsrender.analyses.method_comparison.job import MethodComparisonJob
from wsrender.analyses.parallel_workspace.job import ParallelWorkspaceJob
from wsrender.analyses.provenance import job_entry, provenance
from wsrender.analyses.settled_device import settled_device
from wsrender.documents.robot import Transform
from wsrender.errors import InputError
from wsrender.mechanisms.ball_region import BallRegion
from wsrender.mechanisms.exact import ExactWorkspace
from wsrender.mechanisms.mechanism import mechanism_of
from wsrender.mechanisms.solids import solid_workspace
from wsrender.results.result import Result
from wsrender.run.one_shard import OneShard
from wsrender.run.parallel import plan_parallel
from wsrender.run.parallel_exact import region_of
from wsrender.volume.lattice import round_to_digits
from wsrender.volume.table import Table

Arrays = dict[str, np.ndarray]

GRIDS, EXACT, SOLIDS = ("grid", "grid_by_subsystem"), "exact", "solids"
PARTS = (5, 10, 20, 40)  # of the volume's cube root
ICOSAHEDRON_EDGE = 1.0515  # of the radius of the sphere around it
UNITS = {"size": "m", "volume": "m^3"}


@dataclass(eq=False)
class MethodComparisonPlan(OneShard):
    """A resolved ``method_comparison`` job: one shard, its samples the runs of the methods."""

    job: MethodComparisonJob
    region: BallRegion
    sizes: tuple[float, ...]
    device: str
    target: str

    @property
    def shards(self) -> list[tuple[int, int]]:
        """One shard of all runs."""
        return [(0, 1 + len(GRIDS) * len(self.sizes) + len(self.job.ball_subdivisions))]

    @property
    def cost(self) -> Cost:
        """Runs, bytes of the largest ball's meshes, and seconds of them."""
        triangles = (
            20.0
            * 4 ** max(self.job.ball_subdivisions)
            * (len(self.region.inside_radii) + len(self.region.outside_radii))
        )
        drawn, seconds = pictures_cost("other")
        return Cost(self.shards[0][1], 500 * triangles, DOCUMENT_BYTES + drawn, triangles / 2e5 + seconds)

    def resolved(self) -> dict[str, Any]:
        """What is settled once: device, target, sizes of voxels, shards."""
        return super().resolved() | {"sizes": list(self.sizes)}

    def run_shard(self, shard: int, progress: Callable[[int], None] | None, execution: Execution) -> Arrays:
        """Method, edge of its voxels or triangles, volume and seconds of every run."""
        rows = []
        for row in self._runs(execution):
            rows.append(row)
            if progress:
                progress(len(rows))
        return {
            "method": np.array([row[0] for row in rows]),
            "numbers": np.array([row[1:] for row in rows], np.float64),
        }

    def finish(self, partial: Arrays, seconds: dict[str, float], execution: Execution) -> Result:
        """The table of all runs, with errors from the exact volume; their times are in ``timing_s``."""
        method, (size, volume, took) = partial["method"], partial["numbers"].T
        exact = ExactWorkspace.of(self.region)
        with np.errstate(invalid="ignore", divide="ignore"):
            error = np.where(exact.volume_m3 > 0, volume / exact.volume_m3 - 1, np.nan)
        columns = {"method": method, "size": size, "volume": volume, "relative_error": error}
        document = {
            "analysis": "method_comparison",
            "job": job_entry(self.job),
            "mechanism": {"name": mechanism_of(self.job.mechanism).name},
            "volume_m3": {"exact": exact.volume_m3},
            "methods": [
                {
                    "method": str(name),
                    "size_m": None if np.isnan(edge) else edge,
                    "volume_m3": found,
                    "relative_error": None if np.isnan(wrong) else wrong,
                }
                for name, edge, found, wrong in zip(method, size.tolist(), volume.tolist(), error.tolist(), strict=True)
            ],
            "headline": headline("volume", exact.volume_m3, (exact.volume_m3, exact.volume_m3)),
            "provenance": provenance(self.job, self.target),
            "timing_s": {**seconds, **dict(zip(map(_label, method, size), took.tolist(), strict=True))},
        }
        return Result(document, tables={"methods": Table(columns, UNITS)})

    def _runs(self, execution: Execution) -> Iterator[tuple[str, float, float, float]]:
        """(method, edge, volume, seconds); every first run of a kernel is repeated, so that no compilation is timed."""
        for repeated in (False, True):
            started = time.perf_counter()
            exact = ExactWorkspace.of(self.region)
            volume = exact.volume_m3 if len(exact.mesh.faces) else 0.0
            if repeated:
                yield EXACT, np.nan, volume, time.perf_counter() - started
        for method in GRIDS:
            for number, size in enumerate(self.sizes):
                if number == 0:
                    self._counted(method, size, execution)
                started = time.perf_counter()
                volume = self._counted(method, size, execution)
                yield method, size, volume, time.perf_counter() - started
        largest = float(np.max(self.region.inside_radii, initial=0.0))
        for subdivisions in self.job.ball_subdivisions:
            started = time.perf_counter()
            mesh = solid_workspace(self.region, subdivisions)
            volume = float(mesh.volume) if len(mesh.faces) else 0.0
            edge = ICOSAHEDRON_EDGE * largest / 2**subdivisions
            yield SOLIDS, edge, volume, time.perf_counter() - started

    def grid_job(self, method: Any, size: float) -> ParallelWorkspaceJob:
        """The job of one grid method with voxels of a size [m]."""
        return ParallelWorkspaceJob(
            mechanism=self.job.mechanism,
            orientation=self.job.orientation,
            method=method,
            voxel_size_m=size,
            device=self.device,
        )

    def _counted(self, method: Any, size: float, execution: Execution) -> float:
        """Volume of the voxels that a grid method finds [m³]."""
        partial = plan_parallel(self.grid_job(method, size)).run_shard(0, None, execution)
        return len(partial["cells"]) * size**3


def _label(method: str, size: float) -> str:
    """Name of a run's time."""
    return str(method) if np.isnan(size) else f"{method} {size:.3g} m"


def plan_method_comparison(job: MethodComparisonJob, resolved: dict[str, Any] | None = None) -> MethodComparisonPlan:
    """Resolve the job, or take what `MethodComparisonPlan.resolved` of an earlier plan of it says.

    Raises InputError for a mechanism whose workspace other surfaces bound.
    """
    region = region_of(mechanism_of(job.mechanism), (job.orientation or Transform()).matrix()[:3, :3])
    device, target = settled_device(job.device, resolved)
    sizes = tuple(resolved["sizes"]) if resolved else job.voxel_sizes_m
    if sizes is None:
        volume = ExactWorkspace.of(region).volume_m3
        edge = np.cbrt(volume if volume > 0 else float(np.max(region.inside_radii, initial=1.0)) ** 3)
        sizes = tuple(round_to_digits(float(edge) / parts, 2) for parts in PARTS)
    plan = MethodComparisonPlan(job, region, sizes, device, target)
    try:
        plan_parallel(plan.grid_job(GRIDS[0], min(sizes)))
    except InputError as error:
        if error.field not in ("voxel_size_m", "max_poses"):
            raise
        raise type(error)("voxel_sizes_m", f"{min(sizes):g} is too small: {error.message}") from None
    return plan
