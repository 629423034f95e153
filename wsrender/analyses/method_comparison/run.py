"""The analysis ``method_comparison``: the four methods of [SNK], their Table 4 and Fig. 10."""

import time
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from wsrender.analyses.contract import Analysis, Draft, Settled, Tell
from wsrender.analyses.cost import DOCUMENT_BYTES, Asks, Cost, pictures_cost
from wsrender.analyses.execution import Execution
from wsrender.analyses.headline import headline
from wsrender.analyses.method_comparison.job import MethodComparisonJob
from wsrender.analyses.partial_result import PartialResult, joined_rows, rows_of_shard
from wsrender.analyses.registry import job_classes, planned
from wsrender.documents.robot import Transform
from wsrender.errors import InputError
from wsrender.mechanisms.ball_region import BallRegion, region_of
from wsrender.mechanisms.exact import ExactWorkspace
from wsrender.mechanisms.mechanism import mechanism_of
from wsrender.mechanisms.solids import solid_workspace
from wsrender.volume.lattice import round_to_digits
from wsrender.volume.table import Table

GRIDS, EXACT, SOLIDS = ("grid", "grid_by_subsystem"), "exact", "solids"
PARTS = (5, 10, 20, 40)  # of the volume's cube root
TRIANGLE_BYTES, TRIANGLES_PER_S, RUNS_S = 500.0, 2e5, 0.1  # of balls; seconds of the exact workspace and the grids
ICOSAHEDRON_EDGE = 1.0515  # of the radius of the sphere around it
UNITS = {"size": "m", "volume": "m^3"}


@dataclass(frozen=True, kw_only=True)
class MethodComparisonSettled(Settled):
    """With the edges of the voxels of the grids [m]."""

    sizes: tuple[float, ...]


class MethodComparisonAnalysis(Analysis):
    """A planned ``method_comparison`` job: its samples are the runs of the methods."""

    effort = 1e8  # seconds
    settles = MethodComparisonSettled
    job: MethodComparisonJob
    settled: MethodComparisonSettled

    def prepare(self, device: str, target: str) -> MethodComparisonSettled:
        """Raises InputError for a mechanism whose workspace other surfaces bound, and voxels that are too small."""
        sizes = self.job.voxel_sizes_m or self._default_sizes()
        try:
            planned(self.grid_job(GRIDS[0], min(sizes), device))
        except InputError as error:
            if error.field not in ("voxel_size_m", "max_poses"):
                raise
            raise type(error)("voxel_sizes_m", f"{min(sizes):g} is too small: {error.message}") from None
        runs = 1 + len(GRIDS) * len(sizes) + len(self.job.ball_subdivisions)
        return MethodComparisonSettled(device, target, ((0, runs),), shard_unit=1, sizes=sizes)

    def _default_sizes(self) -> tuple[float, ...]:
        volume = ExactWorkspace.of(self.region).volume_m3
        edge = np.cbrt(volume if volume > 0 else float(np.max(self.region.inside_radii, initial=1.0)) ** 3)
        return tuple(round_to_digits(float(edge) / parts, 2) for parts in PARTS)

    @cached_property
    def region(self) -> BallRegion:
        """The workspace's; raises InputError where other surfaces bound it."""
        rotation = (self.job.orientation or Transform()).matrix()[:3, :3]
        return region_of(mechanism_of(self.job.mechanism), rotation)

    @property
    def cost(self) -> Cost:
        """Runs, bytes of the largest ball's meshes, and seconds of all of them; grids are counted sooner."""
        balls = len(self.region.inside_radii) + len(self.region.outside_radii)
        triangles = [20.0 * balls * 4**halved for halved in self.job.ball_subdivisions]
        drawn, seconds = pictures_cost("refinements")
        seconds += RUNS_S + sum(triangles) / TRIANGLES_PER_S
        asks = Asks("ball_subdivisions", "take fewer")
        return Cost(self.samples, TRIANGLE_BYTES * max(triangles), DOCUMENT_BYTES + drawn, seconds, asks)

    def compute(self, shard: int, execution: Execution, tell: Tell) -> PartialResult:
        """Method, edge of its voxels or triangles, volume and seconds of every run of the shard.

        The first run of a method that has a kernel is repeated, so that no compilation is timed.
        """
        first, count = self.shards[shard]
        methods, rows = [], []
        for method, size in self._runs[first : first + count]:
            if method not in (*methods, SOLIDS):
                self._volume(method, size, execution)
            started = time.perf_counter()
            volume = self._volume(method, size, execution)
            methods.append(method)
            rows.append([self._edge(method, size), volume, time.perf_counter() - started])
            tell(len(rows))
        return rows_of_shard(first, {"method": np.array(methods), "numbers": np.array(rows, np.float64)})

    def merge(self, a: PartialResult, b: PartialResult) -> PartialResult:
        """The runs of both, in their order."""
        return joined_rows(a, b)

    def result(self, partial: PartialResult, execution: Execution) -> Draft:
        """The table of all runs, with errors from the exact volume; their times are in ``timing_s``."""
        method, (size, volume, took) = partial["method"], partial["numbers"].T
        exact = ExactWorkspace.of(self.region)
        with np.errstate(invalid="ignore", divide="ignore"):
            error = np.where(exact.volume_m3 > 0, volume / exact.volume_m3 - 1, np.nan)
        columns = {"method": method, "size": size, "volume": volume, "relative_error": error}
        document = {
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
        }
        return Draft(
            document,
            headline("volume", exact.volume_m3, (exact.volume_m3, exact.volume_m3)),
            timing_s=dict(zip(map(_label, method, size), took.tolist(), strict=True)),
            tables={"methods": Table(columns, UNITS)},
        )

    @property
    def _runs(self) -> list[tuple[str, float]]:
        """Method and size of every run: edge of its voxels [m], or how often edges are halved."""
        grids = [(method, size) for method in GRIDS for size in self.settled.sizes]
        return [(EXACT, np.nan), *grids, *((SOLIDS, subdivisions) for subdivisions in self.job.ball_subdivisions)]

    def _edge(self, method: str, size: float) -> float:
        """Edge of a run's voxels or triangles [m]."""
        largest = float(np.max(self.region.inside_radii, initial=0.0))
        return ICOSAHEDRON_EDGE * largest / 2**size if method == SOLIDS else size

    def _volume(self, method: str, size: float, execution: Execution) -> float:
        """What a method gives [m³]."""
        if method in GRIDS:
            return self._counted(method, size, execution)
        if method == SOLIDS:
            mesh = solid_workspace(self.region, int(size))
            return float(mesh.volume) if len(mesh.faces) else 0.0
        exact = ExactWorkspace.of(self.region)
        return exact.volume_m3 if len(exact.mesh.faces) else 0.0

    def grid_job(self, method: Any, size: float, device: str) -> Any:
        """The job of one grid method with voxels of a size [m]."""
        return job_classes()["parallel_workspace"](
            mechanism=self.job.mechanism,
            orientation=self.job.orientation,
            method=method,
            voxel_size_m=size,
            refined_volume=None,
            device=device,
        )

    def _counted(self, method: Any, size: float, execution: Execution) -> float:
        """Volume of the voxels that a grid method finds [m³]."""
        partial = planned(self.grid_job(method, size, self.device)).run_shard(0, None, execution)
        return len(partial["cells"]) * size**3


def _label(method: str, size: float) -> str:
    """Name of a run's time."""
    return str(method) if np.isnan(size) else f"{method} {size:.3g} m"
