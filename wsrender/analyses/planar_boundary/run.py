"""The analysis ``planar_boundary``: the exact boundary of a planar arm, and the Monte Carlo one beside it."""

from collections.abc import Iterator
from functools import cached_property
from typing import Any

import numpy as np

from wsrender.analyses.contract import Analysis, Draft, Settled, Tell
from wsrender.analyses.cost import DOCUMENT_BYTES, Asks, Cost, pictures_cost
from wsrender.analyses.execution import Execution
from wsrender.analyses.headline import headline, no_headline
from wsrender.analyses.partial_result import PartialResult
from wsrender.analyses.partial_tables import tables_of, with_tables
from wsrender.analyses.planar_boundary.job import PlanarBoundaryJob
from wsrender.documents.point_sets import PLANE_HEADERS
from wsrender.engine import sampled_positions
from wsrender.errors import NumericalError
from wsrender.geometry.planar.agreement import disagreements, signed_area
from wsrender.geometry.planar.exact_boundary import ExactBoundary
from wsrender.geometry.planar.inverse_solutions import NumberRegions
from wsrender.geometry.planar.monte_carlo import MonteCarloBoundary, monte_carlo_boundary
from wsrender.geometry.planar.planar_chain import PlanarChain, planar_chain
from wsrender.geometry.planar.segments import segment_entry, segment_table
from wsrender.notices import Notice
from wsrender.pipeline.pipeline import tip_pipeline
from wsrender.pipeline.sampling import plan_sampling
from wsrender.robot import model_chain
from wsrender.robots.array_files import Rows, rows_in
from wsrender.volume.table import Table

POSITIONS_PER_S = 2e6  # of one CPU core
SWEEP_S = 0.1  # of a six-joint arm
SAMPLE_BYTES = 70.0  # its position, in space and in the plane, and its cell
SEGMENTS_BYTES = 6e4  # of both boundaries' segments, as tables, drawings and in the document
DRAWN = 20_000  # samples kept for the picture
SAMPLING = '{"method": "boundary", "count": 400000, "locked": {}}'
HOLDING = f'"sampling": {SAMPLING}, in Python sampling=ws.BoundaryBiased(400_000, locked={{}})'


class PlanarBoundaryAnalysis(Analysis):
    """A planned ``planar_boundary`` job: one shard of all samples."""

    job: PlanarBoundaryJob

    def prepare(self, device: str, target: str) -> Settled:
        """Raises ModelError, naming the joint, for an arm that is not planar; InputError for one without a model."""
        samples = plan_sampling(model_chain(self.robot), self.job.sampling).count
        _ = self.chain, self.asked
        return Settled(device, target, ((0, samples),))

    @cached_property
    def chain(self) -> PlanarChain:
        """The arm in its plane."""
        return planar_chain(model_chain(self.robot).held(self.job.sampling.locked), HOLDING)

    @cached_property
    def asked(self) -> Rows:
        """The points (N, 2) [m] that are asked, with their file; raises InputError."""
        return rows_in(self.job.points_m, PLANE_HEADERS, "points_m")

    @property
    def cost(self) -> Cost:
        """Samples, bytes of their positions, seconds."""
        count = float(self.shards[0][1])
        drawn, seconds = pictures_cost("posture")
        files = DOCUMENT_BYTES + SEGMENTS_BYTES + drawn + 16.0 * min(count, DRAWN)
        seconds += SWEEP_S + count / POSITIONS_PER_S
        return Cost(count, SAMPLE_BYTES * count, files, seconds, Asks("sampling", "take fewer samples"))

    def compute(self, shard: int, execution: Execution, tell: Tell) -> PartialResult:
        """Both boundaries, the samples of the picture, and the answers about points."""
        job = self.job
        exact = ExactBoundary(self.chain)
        how = {"threads": execution.threads, "progress": tell}
        positions = sampled_positions(tip_pipeline(self.robot.chain, job.sampling), self.device, **how)
        points = self.chain.plane.coordinates(positions)
        estimated = monte_carlo_boundary(self.chain, points, job.cells, job.line_tolerance_m2, job.arc_tolerance_m4)
        about = {"exact": _exact_entry(exact), "monte_carlo": _estimated_entry(estimated, exact)}
        rows = np.unique(np.linspace(0, len(points) - 1, min(len(points), DRAWN)).astype(np.int64))
        tables = {
            "boundary": segment_table(exact.segments),
            "monte_carlo": _estimated_table(estimated, about["monte_carlo"]["converged"]),
            "samples": Table({"position": points[rows]}, {"position": "m"}),
        }
        if len(self.asked.values):
            tables["points"] = _point_table(exact, self.asked.values)
        return with_tables(PartialResult({}, {"about": about}), tables)

    def result(self, partial: PartialResult, execution: Execution) -> Draft:
        """Tables ``boundary`` and ``monte_carlo``, one row per segment, ``points`` and ``samples``; areas and loops."""
        job, plane = self.job, self.chain.plane
        about = partial.facts["about"]
        document = {
            "plane": {
                "origin_m": plane.origin.tolist(),
                "x_axis": plane.axes[0].tolist(),
                "y_axis": plane.axes[1].tolist(),
                "normal": plane.normal.tolist(),
            },
            "sampling": {"method": job.sampling.method, "samples": self.shards[0][1]},
            **about,
        }
        tables = {name: table for name, table in tables_of(partial).items() if len(table)}
        origin = self.asked.provenance("points_m")
        return Draft(document, _headline(about["exact"]), _notices(about["monte_carlo"]), origin, tables=tables)


def _headline(exact: dict[str, Any]) -> dict[str, Any]:
    """The exact area, or the length of a curve."""
    if exact["dimension"] == 0:
        return no_headline("the arm reaches one point", "area")
    quantity, value = ("area", exact["area_m2"]) if exact["dimension"] == 2 else ("length", exact["perimeter_m"])
    return headline(quantity, value, (value, value))


def _notices(estimated: dict[str, Any]) -> Iterator[Notice]:
    if because := estimated["not_converged_because"]:
        yield Notice(
            "monte_carlo_not_converged",
            f"the Monte Carlo boundary has not converged: {'; '.join(because)}",
            'take the exact boundary; samples of the method "boundary", more of them, or fewer cells bring this one '
            "nearer",
            "sampling",
        )


def _exact_entry(exact: ExactBoundary) -> dict[str, Any]:
    """Area, perimeter, loops with their segments, vertices; regions by number of inverse solutions or self-motions."""
    holes = [loop.hole for loop in exact.loops] or [False] * len(exact.segments)
    return {
        "dimension": exact.dimension,
        "area_m2": float(exact.area),
        "perimeter_m": exact.perimeter,
        "vertices_m": exact.vertices.tolist(),
        **_numbers_entry(exact),
        "loops": [
            {"hole": hole, "segments": [segment_entry(segment) for segment in loop]}
            for hole, loop in zip(holes, exact.segments, strict=True)
        ],
    }


def _numbers_entry(exact: ExactBoundary) -> dict[str, Any]:
    """Regions by number of postures or self-motions; where curves nearly coincide the boundary stands without them."""
    try:
        solutions, motions = exact.inverse_solution_regions, exact.self_motion_regions
    except NumericalError as error:
        return {"inverse_solutions": None, "self_motions": None, "regions_not_told_apart": str(error)}
    return {
        "inverse_solutions": _regions_entry("solutions", solutions),
        "self_motions": _regions_entry("components", motions),
    }


def _regions_entry(number: str, regions: list[NumberRegions] | None) -> list[dict[str, Any]] | None:
    if regions is None:
        return None
    return [{number: each.number, "area_m2": each.area_m2, "regions": each.regions} for each in regions]


def _estimated_entry(estimated: MonteCarloBoundary, exact: ExactBoundary) -> dict[str, Any]:
    """Cells and tolerances, how far inside the exact boundary they lie, whether it has converged, loops of segments."""
    width, loops, differs = estimated.cell_width_m, estimated.loops, [*disagreements(estimated, exact)]
    centroids = np.concatenate([*loops, np.empty((0, 2))])
    inward = float(exact.nearest(centroids).distance.mean()) if len(centroids) else None
    return {
        "cell_width_m": width,
        "boundary_cells": len(centroids),
        "line_tolerance_m2": estimated.tolerances.line_m2,
        "arc_tolerance_m4": estimated.tolerances.arc_m4,
        "area_m2": float(sum(map(signed_area, loops))),
        "mean_distance_to_exact_m": inward,
        "mean_distance_to_exact_cells": inward / width if inward is not None else None,
        "critical_points_m": estimated.critical.tolist(),
        "converged": not differs and exact.dimension == 2,
        "not_converged_because": differs,
        "loops": [{"segments": [segment_entry(segment) for segment in loop]} for loop in estimated.segments],
    }


def _estimated_table(estimated: MonteCarloBoundary, converged: bool) -> Table:
    """One row per segment; the column ``converged``, the same in all, is for those who draw them."""
    table = segment_table(estimated.segments)
    return Table(table.columns | {"converged": np.full(len(table), converged)}, table.units)


def _point_table(exact: ExactBoundary, points: np.ndarray) -> Table:
    nearest = exact.nearest(points)
    columns = {
        "point": points,
        "inside": nearest.inside,
        "distance": nearest.distance,
        "nearest": nearest.point,
        "segment": nearest.segment,
    }
    if exact.has_inverse_solutions:
        columns["inverse_solutions"] = exact.inverse_solutions(points)
    if exact.has_self_motions:
        columns["self_motions"] = exact.self_motions(points)
    return Table(columns, dict.fromkeys(("point", "distance", "nearest"), "m"))
