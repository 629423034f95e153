"""The job of the body-elemental algorithm."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from wsrender.documents.arm import Arm, ArmPath
from wsrender.documents.constraints import ArmsConstraints, Constrained
from wsrender.documents.format import JobDocument, example
from wsrender.documents.options import Device
from wsrender.documents.point_sets import PointSet, is_point_set
from wsrender.documents.quantities import Count, RelativeTolerance, Seed, integer, sequence
from wsrender.documents.sampling import Random
from wsrender.documents.several_robots import PlacedRobot


def _source(value: Any) -> Any:
    if isinstance(value, Arm | PointSet):
        return value
    return (PointSet if is_point_set(value) else Arm).model_validate(value)


def _cells(value: Any) -> tuple[int, ...]:
    cells = tuple(integer(count) for count in sequence(value))
    if len(cells) != 3 or not 1 <= min(cells) <= max(cells) <= 1000:
        raise ValueError("must be a list of 3 whole numbers, 1 … 1000")
    return cells


ArmOrPoints = Annotated[Arm | PointSet, BeforeValidator(_source)]
Cells = Annotated[tuple[int, int, int], BeforeValidator(_cells)]


class CollaborativeVolumeJob(Constrained, JobDocument):
    """Volume that two arms reach together, by the body-elemental algorithm, and its true value beside it."""

    model_config = example(
        analysis="collaborative_volume",
        left={"robot": {"library": "gao_6r"}},
        right={"robot": {"library": "gao_6r", "placement": {"rpy_deg": [0, 0, 180]}}},
        samples=4000,
        seeds=2,
        cells=[8, 8, 8],
        refined_volume=0.1,
    )

    analysis: Literal["collaborative_volume"] = "collaborative_volume"
    """Name of the analysis."""
    left: ArmOrPoints
    """The arm whose smallest x begins the box: {"robot": …, "base": …, "tip": …} or {"points": [[x, y, z], …]}."""
    right: ArmOrPoints
    """The arm whose largest x ends the box."""
    samples: Annotated[int, Field(ge=1, le=20_000_000), BeforeValidator(integer)] = 200_000
    """Random configurations of each robot."""
    seeds: Annotated[int, Field(ge=1, le=1000), BeforeValidator(integer)] = 10
    """Runs, with the seeds seed, seed + 1, …; points give the same in each, so that one is enough for two sets."""
    seed: Seed = 0
    """Seed of the first run."""
    cells: Cells = (20, 20, 20)
    """Cells of the box along x, y, z."""
    refinements: Annotated[int, Field(ge=0, le=50), BeforeValidator(integer)] = 3
    """Refinements of the boundary cells, d: gives V₀ … V_d."""
    neighbours: Annotated[Literal[4, 6], BeforeValidator(integer)] = 4
    """Neighbours that make a boundary cell: 4 in its layer of constant z, or 6."""
    constraints: ArmsConstraints | None = None  # pyright: ignore[reportIncompatibleVariableOverride]
    """Which configurations of both robots are admitted, and which of the true volume's they may be in together; null:
    all."""
    refined_volume: RelativeTolerance | None = None
    """Relative tolerance of the true volume that both robots reach [1], by inverse kinematics: 0.01 if it is not given
    for two robots; under constraints of what is free. null: none."""
    max_samples: Count = 10_000_000_000
    """Largest number of configurations of all runs together."""
    device: Device = "auto"
    """Where the kernels run: "auto" (a GPU if there is one), "cpu", "cuda" or "cuda:N"."""

    @model_validator(mode="before")
    @classmethod
    def _refined_for_two_robots(cls, data: Any) -> Any:
        if not isinstance(data, Mapping) or "refined_volume" in data:
            return data
        robots = all(name in data and not is_point_set(data[name]) for name in ("left", "right"))
        return {**data, "refined_volume": 0.01} if robots else data

    def arms(self) -> dict[ArmPath, Arm]:
        """The robots among left and right, by path."""
        sources = {("left",): self.left, ("right",): self.right}
        return {path: source for path, source in sources.items() if isinstance(source, Arm)}

    def sweeps(self) -> list[Any]:
        """The robots, with the configurations of all runs."""
        sampling = Random(self.samples * self.seeds)
        arms = self.arms().values()
        return [PlacedRobot(robot=arm.robot, base=arm.base, tip=arm.tip, sampling=sampling) for arm in arms]

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if self.refined_volume is not None and len(self.arms()) < 2:
            yield "refined_volume", "must be null: points are no robots, whose inverse kinematics decides"
        if len(self.arms()) < 2:
            for name in ("constraints", "environment"):
                if getattr(self, name) is not None:
                    yield name, "must be null: points have no configurations that are admitted or not"
        if (total := self.samples * self.seeds * len(self.arms())) > self.max_samples:
            yield "samples", f"makes {total:.4g} configurations, above max_samples = {self.max_samples:.4g}"
