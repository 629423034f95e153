"""The analysis ``indices_at``: local indices at given configurations."""

from functools import cached_property
from typing import Any

import numpy as np

from wsrender.analyses.contract import Analysis, Draft, Settled, Tell
from wsrender.analyses.cost import (
    DOCUMENT_BYTES,
    LISTED_BYTES,
    LISTED_MEMORY,
    WRITTEN_PER_S,
    Asks,
    Cost,
    pictures_cost,
)
from wsrender.analyses.execution import Execution
from wsrender.analyses.indices_at.job import IndicesAtJob
from wsrender.analyses.partial_result import PartialResult
from wsrender.analyses.provenance import index_choices
from wsrender.engine import (
    Evaluated,
    SweepPlan,
    devices_of,
    evaluate_samples,
    label_bytes,
    thread_count,
    units_of,
)
from wsrender.errors import InputError
from wsrender.geometry.polytopes import LIMIT_N, Polytope, polytopes
from wsrender.pipeline.pipeline import Pipeline
from wsrender.pipeline.sampling import plan_sampling
from wsrender.robot.constraints import constraints_of_job
from wsrender.robot.gravity import gravity_of
from wsrender.robot.indices import evaluation_of_job
from wsrender.robot.model_robot import configuration_rows
from wsrender.robot.rejections import rejected_rows
from wsrender.robots.array_files import Rows, rows_in
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.table import Table

ROWS_PER_S = 4e5  # of one CPU core
REASON_BYTES = 100  # of a row: why it is rejected as text, and what is counted of it
POLYTOPE_BYTES, POLYTOPES_PER_S = 12_000, 50  # two files of a mesh and rows of tables; of one CPU core


class IndicesAtAnalysis(Analysis):
    """A planned ``indices_at`` job: one shard of all rows."""

    job: IndicesAtJob

    def __repr__(self) -> str:
        return f"indices_at: {self.pipeline}"

    def prepare(self, device: str, target: str) -> Settled:
        """Raises InputError for configurations of the wrong length, and for a file of them that cannot be read."""
        _ = self.pipeline
        if message := self.job.too_many(len(self.q)):
            raise InputError("polytopes", message)
        for kind in self.job.polytopes:
            self._polytopes(kind, self.q[:1])
        return Settled(device, target, ((0, len(self.q)),))

    @cached_property
    def rows(self) -> Rows:
        """The rows as given, with their file; raises InputError."""
        return rows_in(self.job.configurations, (self.robot.joint_names,), "configurations")

    @cached_property
    def q(self) -> np.ndarray:
        """The rows (N, n) [rad or m]; raises InputError."""
        return configuration_rows(self.rows.values, len(self.robot.joint_names), "configurations")

    @cached_property
    def pipeline(self) -> Pipeline:
        """The rows, which of them are admitted, and what is computed of them."""
        evaluation = evaluation_of_job(self.job, self.robot)
        return Pipeline(
            evaluation,
            plan_sampling(self.robot.chain, self.q),
            constraints_of_job(self.job, self.robot),
            kept_rows=frozenset() if evaluation.given_kinematics else frozenset({"orientation"}),
            precision=self.job.precision,
        )

    @property
    def cost(self) -> Cost:
        """Rows, their numbers and the pictures."""
        width = 4 if self.job.precision == "float32" else 8
        numbers = float(len(self.q) * (3 + 6 + len(self.pipeline.evaluation.indices)))
        drawn, seconds = pictures_cost("histogram", "scatter")
        files = DOCUMENT_BYTES + drawn + self.q.nbytes + width * numbers + LISTED_BYTES * self.q.size
        memory = self.q.nbytes + (width + 4) * numbers + LISTED_MEMORY * self.q.size + self.program_bytes
        if self.pipeline.constraints:  # the admitted rows once more, and the reason of each of the others
            files += self.q.nbytes + width * numbers + 4 * len(self.q)
            memory += self.q.nbytes + width * numbers + REASON_BYTES * len(self.q)
        memory += label_bytes(SweepPlan(self.pipeline), devices_of(self.device) * thread_count())
        if self.job.polytopes:
            shown, drawing = pictures_cost("surface", "robot")
            made = len(self.job.polytopes) * len(self.q)
            files, seconds = files + shown + POLYTOPE_BYTES * made, seconds + drawing + made / POLYTOPES_PER_S
        seconds += len(self.q) / ROWS_PER_S + files / WRITTEN_PER_S
        return Cost(len(self.q), memory, files, seconds, Asks("configurations", "take fewer"))

    def compute(self, shard: int, execution: Execution, tell: Tell) -> PartialResult:
        """Positions and values of all rows: arrays of `Evaluated` by name."""
        rows = evaluate_samples(self.pipeline, self.device, threads=execution.threads)
        tell(len(self.q))
        return PartialResult({name: value for name, value in vars(rows).items() if value is not None})

    def result(self, partial: PartialResult, execution: Execution) -> Draft:
        """The map, one row per configuration in the order asked, and the extremes of each index.

        With constraints the table ``admission`` says of every row why it is rejected, "" where it is not; values of
        rejected ones are NaN, and count in no extreme. The entry ``rejections`` has the first row of each reason, and
        which pairs of shapes collide how often.
        """
        rows, names = Evaluated(**partial.arrays), self.pipeline.evaluation.indices
        admitted, about, tables = self._admission(rows.rejected)
        units, cuts = units_of(self.pipeline.evaluation), self.pipeline.evaluation.cuts if admitted.any() else {}
        values = dict(zip(names, np.where(admitted, rows.values, np.nan), strict=True))
        entries = {
            "sampling": {"method": "given", "samples": len(self.q)},
            **about,
            "indices": {
                name: {
                    "maximum": float(v[admitted].max()) if admitted.any() else None,
                    "minimum": float(v[admitted].min()) if admitted.any() else None,
                    **({"cut_share": float(np.mean(v[admitted] >= v.dtype.type(cuts[name])))} if name in cuts else {}),
                    "unit": units[name],
                }
                for name, v in values.items()
            },
            "choices": index_choices(self.job, self.pipeline.evaluation),
        }
        found = DistributionMap(rows.position, values, units, self.q, self.robot.joint_names, rows.quat_wxyz)
        sample = found.only(admitted) if tables else None
        origin = {"pipeline": str(self.pipeline), **self.rows.provenance("configurations")}
        notices = self.pipeline.evaluation.notices
        kept = {"notices": notices, "provenance": origin, "map": found, "sample": sample}
        if not self.job.polytopes:
            return Draft(entries, tables=tables, **kept)
        rows = np.flatnonzero(admitted)
        of = {kind: self._polytopes(kind, self.q[rows]) for kind in self.job.polytopes}
        made = [(int(k), each) for found in of.values() for k, each in zip(rows, found, strict=True)]
        meshes = {f"{each.kind}_polytope_{k}": each.mesh() for k, each in made if each.dimension > 1}
        skeleton = self.robot.skeleton(self.q[rows]) if len(rows) else None
        return Draft(entries, tables=tables | tables_of(made), meshes=meshes, skeleton=skeleton, **kept)

    def _polytopes(self, kind: str, q: np.ndarray) -> list[Polytope]:
        """Those of a kind at configurations (N, n); raises InputError for what the robot lacks."""
        limit: Any = self.job.index_options.get("force_radius", {}).get("limit_N", LIMIT_N)
        rows = self.pipeline.evaluation.rows
        return polytopes(self.robot, q, kind, rows, gravity_of(self.job), limit, field="polytopes")

    def _admission(self, rejected: np.ndarray | None) -> tuple[np.ndarray, dict[str, Any], dict[str, Table]]:
        """Which rows are admitted (N,) bool, what the document says of it, and the table of reasons."""
        if rejected is None:
            return np.ones(len(self.q), bool), {}, {}
        reasons = np.array(["", *(each.name for each in self.pipeline.constraints)])
        about = rejected_rows(self.pipeline.constraints, rejected, self.q.__getitem__)
        return rejected == 0, about, {"admission": Table({"reason": reasons[rejected]})}


def tables_of(made: list[tuple[int, Polytope]]) -> dict[str, Table]:
    """Tables of polytopes, each with the row of its configuration: what they are, their vertices, and their facets."""
    rows, each = np.array([k for k, _ in made], np.int64), [polytope for _, polytope in made]
    kinds, units = np.array([p.kind for p in each], "<U12"), np.array([p.unit for p in each], "<U6")

    def table(values: dict[str, list[np.ndarray]], counts: list[int]) -> Table:
        columns = {"configuration": np.repeat(rows, counts), "kind": np.repeat(kinds, counts)}
        columns |= {name: np.concatenate([*parts]) for name, parts in values.items()}
        return Table(columns | {"unit": np.repeat(units, counts)})

    facts = {
        "dimension": np.array([p.dimension for p in each], np.int64),
        "radius": np.array([p.radius for p in each]),
        "volume": np.array([p.volume for p in each]),
        "mesh_m_per_unit": np.array([p.fitting_scale for p in each]),
    }
    none, none4 = np.zeros((0, 3)), np.zeros((0, 4))
    vertices, facets = [none, *(p.vertices for p in each)], [none4, *(p.facets for p in each)]
    return {
        "polytopes": table({name: [value] for name, value in facts.items()}, [1] * len(each)),
        "polytope_vertices": table({"vertex": vertices}, [len(p.vertices) for p in each]),
        "polytope_facets": table(
            {"normal": [f[:, :3] for f in facets], "offset": [f[:, 3] for f in facets]}, [len(p.facets) for p in each]
        ),
    }
