"""The analysis ``robot_comparison``: several robots side by side, and a table of their differences."""

from collections.abc import Iterator
from functools import cached_property
from typing import Any

import numpy as np

from wsrender.analyses.composed import Composed, Part, PartialParts
from wsrender.analyses.contract import Draft, Progress
from wsrender.analyses.cost import Cost, fits
from wsrender.analyses.execution import Execution
from wsrender.analyses.headline import no_headline
from wsrender.analyses.robot_comparison.job import RobotComparisonJob
from wsrender.analyses.several_result import common_entries, notices_of_each, sampling_path, skeletons
from wsrender.analyses.several_robots import SeveralPlans, SeveralSettled, plan_several
from wsrender.volume.measure import TABLE_UNITS
from wsrender.volume.table import Table


class RobotComparisonAnalysis(Composed):
    """A planned ``robot_comparison`` job: the samples of every robot, and its refined measure."""

    settles = SeveralSettled
    job: RobotComparisonJob
    settled: SeveralSettled

    def prepare(self, device: str, target: str) -> SeveralSettled:
        """Raises InputError, MissingInertiaError, ResourceError."""
        self.several = plan_several(self.job, self.robots, None, self.job.refined_volume)
        return self.several.settled(self.several.samples)

    def check_memory(self) -> None:
        """Refused is what does not fit; see `WorkspaceAnalysis.check_memory`."""
        if not fits(self.several.most_bytes):
            super().check_memory()

    @cached_property
    def several(self) -> SeveralPlans:
        """The plans of the robots."""
        return plan_several(self.job, self.robots, self.settled, self.job.refined_volume)

    def about_robots(self) -> dict[str, Any]:
        """Nothing: the result says each robot with its numbers."""
        return {}

    @property
    def cost(self) -> Cost:
        """Samples, bytes and seconds."""
        return self.several.cost

    @property
    def parts(self) -> list[Part]:
        """The robots."""
        return self.several.parts

    @property
    def refinements(self) -> int:
        """The refined measure of every robot, if asked."""
        return sum(plan.refinements for plan in self.several.plans)

    def refinement(self, number: int, progress: Progress | None, execution: Execution) -> Any:
        """The refined measure of one robot."""
        return self.several.plans[number].refinement(0, progress, execution)

    def with_refinements(self, partial: PartialParts, refinements: list[Any]) -> PartialParts:
        """With the refined measure of every robot."""
        each = zip(self.several.plans, refinements, strict=True)
        return PartialParts({k: plan.with_refinements(partial.parts[k], [own]) for k, (plan, own) in enumerate(each)})

    def result(self, partial: PartialParts, execution: Execution) -> Draft:
        """Every robot's volume, and the table of values and differences from the first robot."""
        results = self.several.results(partial, execution)
        names = self.several.names
        common = common_entries(self.several, results)
        rows = _rows(common["robots"])
        volumes = {f"robot_{name}": r.volume for name, r in zip(names, results, strict=True) if r.volume is not None}
        tables = {"comparison": _table(names, rows)}
        return Draft(
            {**common, "comparison": rows},
            no_headline("a comparison has a headline for each robot: robots[].headline"),
            notices_of_each(names, results),
            {"sampling_path": sampling_path(results)},
            skeleton=skeletons(results),
            tables=tables,
            volumes=volumes,
        )


def _rows(robots: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Quantity, unit, value of each robot, and difference of each from the first (None where it has none)."""
    facts = [dict(_facts(robot)) for robot in robots]
    rows = []
    for quantity, unit in dict.fromkeys(key for fact in facts for key in fact):
        values = [fact.get((quantity, unit)) for fact in facts]
        differences = [None if v is None or values[0] is None else v - values[0] for v in values]
        rows.append({"quantity": quantity, "unit": unit, "values": values, "differences": differences})
    return rows


def _facts(robot: dict[str, Any]) -> Iterator[tuple[tuple[str, str], float]]:
    if (found := robot["headline"])["value"] is not None:
        yield (f"{found['quantity']}.refined", TABLE_UNITS[found["unit"]]), found["value"]
    for name, value in robot["volume_m3"].items():
        if isinstance(value, float):
            yield (f"volume.{name}", "m^3"), value
    for axis, low, high in zip("xyz", robot["bounds_m"]["lower"], robot["bounds_m"]["upper"], strict=True):
        yield (f"extent.{axis}", "m"), high - low
    for name, value in robot["global"].items():
        if isinstance(value, float):
            yield (name, "1"), value
    for index, entry in robot["indices"].items():
        for name in ("maximum", "minimum", "joint_mean", "workspace_mean"):
            if isinstance(entry[name], float):
                yield (f"{index}.{name}", entry["unit"] if name in ("maximum", "minimum") else "1"), entry[name]


def _table(names: list[str], rows: list[dict[str, Any]]) -> Table:
    """The rows as columns: quantity, unit, value of each robot, difference of the others from the first."""
    columns = {key: np.array([row[key] for row in rows]) for key in ("quantity", "unit")}
    for prefix, key, first in (("", "values", 0), ("difference_", "differences", 1)):
        for k, name in list(enumerate(names))[first:]:
            columns[prefix + name] = np.array([row[key][k] for row in rows], np.float64)
    return Table(columns)
