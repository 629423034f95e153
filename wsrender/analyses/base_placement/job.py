"""The job ``base_placement``: where the base of a robot stands best for given targets."""

from collections.abc import Iterator
from typing import Annotated, Any, ClassVar, Literal, Self

import numpy as np
from pydantic import BeforeValidator, Field, StrictBool

from wsrender.documents.arm import Arm, ArmPath, robot_named
from wsrender.documents.constraints import Constrained
from wsrender.documents.format import JobDocument, example
from wsrender.documents.options import IndexOptions
from wsrender.documents.placements import ANGLES, AnyMounting, PlacementSpace, TableEdge
from wsrender.documents.quantities import Name, is_empty, is_none, number_rows, sequence
from wsrender.documents.robot import RobotSpec
from wsrender.documents.several_robots import MOST_ROBOTS, NamedArm, same_names
from wsrender.documents.target_lists import Criteria, ListedTargets

MOST_PLACEMENTS = 50_000_000


def _index(value: Any) -> Any:
    if value is None or (isinstance(value, str) and value):
        return value
    names = sequence(value) if isinstance(value, list | tuple | np.ndarray) else []
    if len(names) != 2 or not all(isinstance(name, str) and name for name in names):
        raise ValueError("must be the name of an index, or a list of two")
    return tuple(names)


def _weights(value: Any) -> tuple[float, ...] | None:
    if value is None:
        return None
    (weights,) = number_rows([value])  # the first that is none is told, since there may be millions
    if any(weight <= 0 for weight in weights):
        raise ValueError("must hold numbers greater than 0")
    return weights


Weights = Annotated[tuple[Annotated[float, Field(gt=0)], ...], Field(min_length=1)]


class BasePlacementJob(ListedTargets, Constrained, Arm, JobDocument):
    """Where the base of a robot stands best: which targets it serves from every placement of a space.

    A target is served from a placement where the robot reaches it, under constraints with a configuration that they
    admit. The best placement serves targets of the largest weight; of several it is the one whose least ``index`` over
    the targets is best, or without one that which stands farthest, in steps, from those that serve less. Targets,
    constraints and environment stand in the world. Of several ``robots`` each is placed by itself, and the result says
    which does best where.
    """

    model_config = example(
        analysis="base_placement",
        robot={"library": "scara"},
        points_m=[[0.3, -0.1, 0.0], [0.4, 0.0, 0.0], [0.3, 0.1, 0.0]],
        over={"x_m": [-0.6, 1.2, 0.1], "y_m": [-0.6, 0.6, 0.1], "yaw_deg": [0, 360, 45]},
    )

    long_fields: ClassVar[tuple[str, ...]] = (*ListedTargets.long_fields, "weights")

    analysis: Literal["base_placement"] = "base_placement"
    """Name of the analysis."""
    robot: Annotated[RobotSpec | None, BeforeValidator(robot_named), Field(exclude_if=is_none)] = None  # type: ignore[assignment]
    """The robot and how it stands in the frame that is placed; a string is the name of a library robot; null: robots
    are given."""
    robots: Annotated[
        tuple[NamedArm, ...] | None,
        Field(min_length=2, max_length=MOST_ROBOTS, exclude_if=is_none),
        BeforeValidator(lambda value: None if value is None else sequence(value)),
    ] = None
    """Instead of robot, base and tip: several arms, of which each is placed by itself."""
    weights: Annotated[Weights | None, BeforeValidator(_weights)] = None
    """What each of points_m counts; null: 1 each."""
    over: PlacementSpace
    """Where the base may stand. ``robot.placement`` is how it stands in the frame that is placed."""
    mounting: AnyMounting = "floor"
    """How the base is mounted in the frame that is placed, before ``robot.placement``: its z is that frame's z on the
    floor, its x on a wall, its -z under a ceiling; on the edge of a table as on the floor, and only near that edge."""
    index: Annotated[Name | tuple[Name, Name] | None, BeforeValidator(_index)] = None
    """Local index, as ``indices_at`` has them, whose least value over the targets that are served, each at its best
    posture, tells placements apart that serve as much; null: none. Of two, the objectives of ``pareto``, the first
    does."""
    index_options: IndexOptions = Field(default={})
    """Options of the index, if it has any: {index: {option: value}}."""
    pareto: StrictBool = Field(default=False, exclude_if=is_empty)
    """Whether the Pareto set of two objectives is found, the weight served and the least ``index``: the placements
    that no other beats in one of them without being worse in the other. Of two indices these are the objectives, each
    at its own best postures, among the placements that serve the largest weight."""
    refine: StrictBool = True
    """Whether the best placement is refined between the cells, and its tolerance found."""
    use_symmetry: StrictBool = True
    """Whether targets are decided for one yaw alone where others change nothing but the first joint's value."""
    criteria: Criteria = ()
    """What the targets must fulfil from the best placement for the result to pass."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        yield from super().conflicts()
        if (self.robot is None) == (self.robots is None):
            yield "robot", 'must be given, or else "robots": one of the two'
        for name in ("base", "tip") if self.robots else ():
            if getattr(self, name) is not None:
                yield name, 'must not be given beside "robots", of which each has its own'
        yield from same_names(self.robots or ())
        if self.weights is not None and self.points_m is None:
            yield "weights", 'must not be given without "points_m": targets say their own weights'
        elif self.weights is not None and self.points_m and len(self.weights) != len(self.points_m):
            yield "weights", f"must have as many numbers as points_m has rows, {len(self.points_m)}"
        if self.index_options and self.index is None:
            yield "index_options", 'must not be given without "index"'
        if self.pareto and self.index is None:
            yield "pareto", 'must not be true without "index", the objective beside the weight served'
        if len(self.indices) == 2 and not self.pareto:
            yield "index", 'must be one name without "pareto", whose objectives two are'
        elif len(set(self.indices)) < len(self.indices):
            yield "index", f"must be two different names, not {self.indices[0]} twice"
        if self.over.count > MOST_PLACEMENTS:
            shape = " × ".join(str(size) for size in self.over.shape if size > 1)
            yield "over", f"must have at most {MOST_PLACEMENTS:,} placements, not {shape} = {self.over.count:,}"
        elif isinstance(self.mounting, TableEdge) and not self.mounted.any():
            yield "over", "must have a placement within mounting.clamp_m of the table's edge, and none has"
        tilted = [name for name in ANGLES[:2] if getattr(self.over, name) != 0]
        if tilted and self.mounting != "floor":
            yield "mounting", f'must be "floor" where over.{tilted[0]} tilts the base'
        if self.constraints and self.constraints.torque and (name := self.turns_gravity):
            yield "constraints.torque", f"must not be given where over.{name} is a range: gravity would turn"

    def arms(self) -> dict[ArmPath, Arm]:
        """Every arm by its path."""
        return {("robots", k): arm for k, arm in enumerate(self.robots)} if self.robots else super().arms()

    @property
    def alone(self) -> list[Self]:
        """The jobs of its robots, each by itself."""
        own = [{name: getattr(arm, name) for name in Arm.model_fields} for arm in self.robots or ()]
        return [self.model_copy(update={"robots": None} | each) for each in own]

    @property
    def indices(self) -> tuple[str, ...]:
        """The names of its indices."""
        return (self.index,) if isinstance(self.index, str) else self.index or ()

    @property
    def mounted(self) -> np.ndarray:
        """Whether a base may stand at each x and y of the space, bool (X, Y)."""
        return self.stands(self.over.values("x_m")[:, None], self.over.values("y_m"))

    def stands(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Whether a base may stand at x and y [m] that fit together, bool."""
        if isinstance(self.mounting, TableEdge):
            return self.mounting.holds(*np.broadcast_arrays(x, y))
        return np.ones(np.broadcast_shapes(x.shape, y.shape), bool)

    @property
    def turns_gravity(self) -> str | None:
        """The first range, if there is one, along which gravity turns in the base's frame."""
        sideways = self.gravity_m_s2 is not None and any(self.gravity_m_s2[:2])
        return next((name for name in ANGLES[: 3 if sideways else 2] if name in self.over.ranges), None)
