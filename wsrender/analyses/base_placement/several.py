"""Several arms of a ``base_placement`` job, each placed by itself, and which of them does best where."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from wsrender.analyses.base_placement.job import BasePlacementJob
from wsrender.analyses.base_placement.result import entry_of_pareto, objectives_of, pareto_set, told_apart
from wsrender.analyses.base_placement.run import PICTURES, BasePlacementAnalysis
from wsrender.analyses.composed import Composed, Part, PartialParts, part_of
from wsrender.analyses.contract import Analysis, Draft
from wsrender.analyses.cost import Cost, in_turn, pictures_cost
from wsrender.analyses.criteria import VERDICTS
from wsrender.analyses.execution import Execution
from wsrender.analyses.headline import no_headline
from wsrender.analyses.placed_bases import UNITS
from wsrender.analyses.several_result import notices_of_each, skeletons
from wsrender.analyses.several_robots import SeveralSettled, robot_names
from wsrender.errors import InputError
from wsrender.results.result import Result
from wsrender.robot import Robot
from wsrender.volume.table import Table

OF_EACH = ("robot", "placements", "best", "criteria", "verdict")


class SeveralPlacements(Composed):
    """A planned ``base_placement`` job of several robots: the pairs of each, end to end."""

    settles = SeveralSettled
    job: BasePlacementJob
    settled: SeveralSettled

    def prepare(self, device: str, target: str) -> SeveralSettled:
        """Raises what `BasePlacementAnalysis.prepare` raises, of the robot that it is of."""
        self.plans = self._planned([None] * len(self.robots))
        samples = sum(plan.samples for plan in self.plans)
        return SeveralSettled(device, target, ((0, samples),), robots=tuple(plan.resolved() for plan in self.plans))

    @cached_property
    def plans(self) -> list[BasePlacementAnalysis]:
        """The plan of each robot."""
        return self._planned(self.settled.robots)

    def _planned(self, known: Sequence[dict[str, Any] | None]) -> list[BasePlacementAnalysis]:
        plans = []
        for k, (job, robot, resolved) in enumerate(zip(self.job.alone, self.robots, known, strict=True)):
            try:
                plans.append(BasePlacementAnalysis(job, robot, resolved=resolved))
            except InputError as error:
                if error.field.startswith("robot"):
                    raise error.within(f"robots.{k}") from None
                error.message += f" (of robots.{k})"
                raise error.at(error.field) from None
        return plans

    @property
    def effort(self) -> float:  # type: ignore[override]
        """A pair's time in samples of a sweep."""
        return sum(plan.samples * plan.effort for plan in self.plans) / sum(plan.samples for plan in self.plans)

    @property
    def names(self) -> list[str]:
        """What each robot is called."""
        return robot_names(self.job.robots or (), self.robots)

    def about_robots(self) -> dict[str, Any]:
        """Nothing: the result says each robot with its placements."""
        return {}

    @property
    def parts(self) -> list[Part]:
        """The robots."""
        return [part_of(plan) for plan in self.plans]

    @property
    def cost(self) -> Cost:
        """Of the robots one after the other, with what is kept of the others."""
        cost, kept = in_turn(plan.cost for plan in self.plans), [plan.kept_bytes for plan in self.plans]
        (each, _), (drawn, _) = pictures_cost(*PICTURES), pictures_cost("arms_map", "arm")
        if self.job.pareto:
            drawn -= pictures_cost("pareto")[0] * (len(kept) - 1)
        files = cost.file_bytes + drawn - each * len(kept)
        return replace(cost, memory_bytes=cost.memory_bytes + sum(kept) - max(kept), file_bytes=files)

    def result(self, partial: PartialParts, execution: Execution) -> Draft:
        """What each robot serves by itself, and where which of them does best."""
        results = [plan.finish(partial.parts[k], {}, execution) for k, plan in enumerate(self.plans)]
        robots = [
            {"name": name, **{key: result.document[key] for key in OF_EACH if key in result.document}}
            for name, result in zip(self.names, results, strict=True)
        ]
        entries: dict[str, Any] = {"robots": robots}
        tables = self._tables(results)
        if "arms_map" in tables:
            entries["arms"] = self._counts(tables["arms_map"])
        tables["arms"] = self._compared(robots)
        tables |= self._pareto(results)
        entries |= entry_of_pareto(self.job, tables)
        best = next((k for k, wins in enumerate(self._winning(*self._of_best(robots))) if wins[0]), None)
        if self.job.criteria:  # one arm that passes is enough
            entries["verdict"] = max((robot["verdict"] for robot in robots), key=VERDICTS.index)
        entries["best"] = None if best is None else {"robot": self.names[best]} | robots[best]["best"]
        return Draft(
            entries,
            no_headline("of several robots each has its best placement: robots[].best"),
            notices_of_each(self.names, results),
            self.plans[0].targets.provenance,
            tables=tables,
            skeleton=skeletons(results, 0) if all(result.skeleton is not None for result in results) else None,
        )

    def _tables(self, results: list[Result]) -> dict[str, Table]:
        """Those of each robot, led by what they are, and its maps side by side with where it does best."""
        tables = {
            f"{table}_{name}": result.tables[table]
            for name, result in zip(self.names, results, strict=True)
            for table in ("placements", "targets")
            if table in result.tables
        }
        maps = [result.tables["placement_map"] for result in results if "placement_map" in result.tables]
        if not maps:
            return tables
        grid = maps[0].grid
        assert grid
        columns = {name: maps[0][name] for name in grid.axes}
        units = {name: UNITS[name] for name in grid.axes}
        values = [self._of_map(cells) for cells in maps]
        weights, scores = (np.array(each) for each in zip(*values, strict=True))
        for name, cells, wins in zip(self.names, maps, self._winning(weights, scores), strict=True):
            own = {column: cells[column] for column in cells.columns if column not in grid.axes} | {"wins": wins}
            columns |= {f"{column}_{name}": value for column, value in own.items()}
            units |= {f"{column}_{name}": unit for column, unit in cells.units.items() if column in own}
        return tables | {"arms_map": Table(columns, units, grid)}

    def _pareto(self, results: list[Result]) -> dict[str, Table]:
        """Of the Pareto sets of the robots what none of the others beats, each row with its robot."""
        found, scores = zip(self.names, results, strict=True), self.plans[0].scores
        sets = {name: result.tables["pareto"] for name, result in found if "pareto" in result.tables}
        if not sets:
            return {}
        first = next(iter(sets.values()))
        columns = {"robot": np.repeat(list(sets), [len(cells) for cells in sets.values()])}
        columns |= {name: np.concatenate([cells[name] for cells in sets.values()]) for name in first.columns}
        if len(scores) == 2:  # of what serves the most of all
            weight = columns["weight" if "weight" in columns else "served"]
            columns = {name: column[told_apart(weight) == told_apart(weight).max()] for name, column in columns.items()}
        names = objectives_of(self.job, first)
        signs = {score.name: score.sign for score in scores}
        numbers = pareto_set(*(signs.get(name, 1.0) * columns[name] for name in names))
        return {"pareto": Table({name: column[numbers] for name, column in columns.items()}, first.units)}

    def _of_map(self, cells: Table) -> tuple[np.ndarray, np.ndarray]:
        """Weight and score of every cell."""
        weight = cells["weight" if "weight" in cells.columns else "served"].astype(float)
        score = self.plans[0].score
        return weight, np.zeros(len(weight)) if score is None else score.sign * cells[score.name]

    def _winning(self, weights: np.ndarray, scores: np.ndarray) -> np.ndarray:
        """Of robots and places (A, N), served weights and scores, where no other does better: (A, N) bool."""
        weights = told_apart(weights)
        most = (weights == weights.max(axis=0)) & (weights > 0)
        scores = np.where(most, told_apart(scores), -np.inf)
        return most & (scores == scores.max(axis=0))

    def _of_best(self, robots: list[dict[str, Any]]) -> tuple[np.ndarray, np.ndarray]:
        """Weights and scores (A, 1) of the best placement of each."""
        score, best = self.plans[0].score, [robot["best"] or {} for robot in robots]
        values = [score.sign * each.get(score.name, np.nan) if score else 0.0 for each in best]
        return np.array([[each.get("weight", 0.0)] for each in best]), np.array(values)[:, None]

    def _counts(self, cells: Table) -> dict[str, Any]:
        """Of how many cells each robot does best alone, several do equally, and none serves a target."""
        wins = np.array([cells[f"wins_{name}"] for name in self.names])
        several = wins.sum(axis=0)
        alone = {name: int((own & (several == 1)).sum()) for name, own in zip(self.names, wins, strict=True)}
        return {
            "cells": len(cells),
            "alone": alone,
            "equal": int((several > 1).sum()),
            "none": int((several == 0).sum()),
        }

    def _compared(self, robots: list[dict[str, Any]]) -> Table:
        """A row for each robot: what it serves from its best placement, where that is, and how far it may be off."""
        scores = self.plans[0].scores
        best = [robot["best"] or {"served": 0, "weight": 0.0} for robot in robots]
        names = ["served", "weight", *(score.name for score in scores), *UNITS]
        columns = {"robot": np.array(self.names)}
        columns |= {name: np.array([each.get(name, np.nan) for each in best]) for name in names}
        columns["serving_all"] = np.array([robot["placements"]["serving_all"] for robot in robots])
        units = UNITS | {score.name: score.unit for score in scores}
        if self.job.refine:
            for name, unit in (("translation_m", "m"), ("rotation_rad", "rad")):
                values = [each.get("tolerance", {}).get(name) for each in best]
                columns[name], units = np.array(values, float), units | {name: unit}
        return Table(columns, units)


def alone_or_several(job: BasePlacementJob, *robots: Robot, resolved: dict[str, Any] | None = None) -> Analysis:
    """The plan of a job of one robot, or of several."""
    return (SeveralPlacements if job.robots else BasePlacementAnalysis)(job, *robots, resolved=resolved)
