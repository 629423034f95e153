"""The job ``base_placement``: where the base of a robot stands best for given targets."""

from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal

from pydantic import Field, StrictBool

from wsrender.documents.arm import Arm
from wsrender.documents.constraints import Constrained
from wsrender.documents.format import JobDocument
from wsrender.documents.options import IndexOptions
from wsrender.documents.placements import ANGLES, Mounting, PlacementSpace
from wsrender.documents.quantities import Name, PositiveNumber
from wsrender.documents.target_lists import ListedTargets

MOST_PLACEMENTS = 50_000_000


class BasePlacementJob(ListedTargets, Constrained, Arm, JobDocument):
    """Where the base of a robot stands best: which targets it serves from every placement of a space.

    A target is served from a placement where the robot reaches it, under constraints with a configuration that they
    admit. The best placement serves targets of the largest weight; of several it is the one whose least ``index`` over
    the targets is best, or without one that which stands farthest, in steps, from those that serve less. Targets,
    constraints and environment stand in the world.
    """

    long_fields: ClassVar[tuple[str, ...]] = (*ListedTargets.long_fields, "weights")

    analysis: Literal["base_placement"] = "base_placement"
    """Name of the analysis."""
    weights: Annotated[tuple[PositiveNumber, ...], Field(min_length=1)] | None = None
    """What each of points_m counts; null: 1 each."""
    over: PlacementSpace
    """Where the base may stand. ``robot.placement`` is how it stands in the frame that is placed."""
    mounting: Mounting = "floor"
    """How the base is mounted in the frame that is placed, before ``robot.placement``: its z is that frame's z on the
    floor, its x on a wall, its -z under a ceiling."""
    index: Name | None = None
    """Local index, as ``indices_at`` has them, whose least value over the targets that are served, each at its best
    posture, tells placements apart that serve as much; null: none."""
    index_options: IndexOptions = Field(default={})
    """Options of the index, if it has any: {index: {option: value}}."""
    refine: StrictBool = True
    """Whether the best placement is refined between the cells, and its tolerance found."""
    use_symmetry: StrictBool = True
    """Whether targets are decided for one yaw alone where others change nothing but the first joint's value."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        yield from super().conflicts()
        if self.weights is not None and self.points_m is None:
            yield "weights", 'must not be given without "points_m": targets say their own weights'
        elif self.weights is not None and self.points_m and len(self.weights) != len(self.points_m):
            yield "weights", f"must have as many numbers as points_m has rows, {len(self.points_m)}"
        if self.index_options and self.index is None:
            yield "index_options", 'must not be given without "index"'
        if self.over.count > MOST_PLACEMENTS:
            shape = " × ".join(str(size) for size in self.over.shape if size > 1)
            yield "over", f"must have at most {MOST_PLACEMENTS:,} placements, not {shape} = {self.over.count:,}"
        tilted = [name for name in ANGLES[:2] if getattr(self.over, name) != 0]
        if tilted and self.mounting != "floor":
            yield "mounting", f'must be "floor" where over.{tilted[0]} tilts the base'
        if self.constraints and self.constraints.torque and (name := self.turns_gravity):
            yield "constraints.torque", f"must not be given where over.{name} is a range: gravity would turn"

    @property
    def turns_gravity(self) -> str | None:
        """The first range, if there is one, along which gravity turns in the base's frame."""
        sideways = self.gravity_m_s2 is not None and any(self.gravity_m_s2[:2])
        return next((name for name in ANGLES[: 3 if sideways else 2] if name in self.over.ranges), None)
