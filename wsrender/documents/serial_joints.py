"""Serial joints that carry a parallel mechanism, or that its platform carries: hybrid mechanisms."""

import math
from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from wsrender.documents.document import Document
from wsrender.documents.legs import Axis, Interval
from wsrender.documents.quantities import integer
from wsrender.documents.robot import Vector

MOST_JOINTS = 3  # before, and after


class SerialJoint(Document):
    """A joint in series with the parallel mechanism.

    Voxels are tested at so many levels of its range; refined volumes search all its values.
    """

    type: Literal["revolute", "prismatic"] = "revolute"
    """Kind of joint."""
    position_m: Vector = (0.0, 0.0, 0.0)
    """A point of its axis, in the frame before it [m]."""
    axis: Axis = (0.0, 0.0, 1.0)
    """Direction of its axis in the frame before it; any length."""
    limits_deg: Interval | None = None
    """[lower, upper] angle of a revolute joint [°], at most a full turn apart."""
    limits_m: Interval | None = None
    """[lower, upper] position of a prismatic joint along its axis [m]."""
    levels: Annotated[int, Field(ge=2, le=1000), BeforeValidator(integer)] = 25
    """Values from the lower to the upper limit, both included, at which voxels are tested."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        wanted, other = ("limits_deg", "limits_m") if self.type == "revolute" else ("limits_m", "limits_deg")
        if getattr(self, wanted) is None:
            yield wanted, f"must be given for a {self.type} joint"
        if getattr(self, other) is not None:
            yield other, f'must be null for a {self.type} joint: use "{wanted}"'
        if self.limits_deg is not None and self.limits_deg[1] - self.limits_deg[0] > 360:
            yield "limits_deg", "must not span more than 360°"

    @property
    def limits(self) -> tuple[float, float]:
        """Lower and upper limit [rad or m]."""
        if self.type == "revolute":
            assert self.limits_deg is not None
            return math.radians(self.limits_deg[0]), math.radians(self.limits_deg[1])
        assert self.limits_m is not None
        return self.limits_m


SerialJoints = Annotated[tuple[SerialJoint, ...], Field(max_length=MOST_JOINTS)]
