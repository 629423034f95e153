"""Constraints on configurations in a job document: each by its name."""

import math
from collections.abc import Iterator, Mapping
from typing import Annotated, Any

from pydantic import BeforeValidator, ConfigDict, StrictBool

from wsrender.documents.document import Document
from wsrender.documents.quantities import Number, PositiveNumber, real
from wsrender.documents.robot import Vector


class Box(Document):
    """A box along the world's axes."""

    lower_m: Vector
    """Its lower corner [m]."""
    upper_m: Vector
    """Its upper corner [m]."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if not all(low < high for low, high in zip(self.lower_m, self.upper_m, strict=True)):
            yield "upper_m", f"must be above lower_m, {list(self.lower_m)}, in x, y and z"


class Sphere(Document):
    """A ball."""

    center_m: Vector = (0.0, 0.0, 0.0)
    """Its centre in the world [m]."""
    radius_m: PositiveNumber
    """Its radius [m]."""


class HalfSpace(Document):
    """All on one side of a plane."""

    point_m: Vector = (0.0, 0.0, 0.0)
    """A point of the plane, in the world [m]."""
    normal: Vector = (0.0, 0.0, 1.0)
    """The plane's normal, pointing into what is allowed; any length but zero."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if not 1e-6 < math.hypot(*self.normal) < 1e6:
            yield "normal", f"must not have length {math.hypot(*self.normal):g}: it says no direction"


class RegionChoice(Document):
    """Where the tip may be: in all of the shapes that are given."""

    box: Box | None = None
    """A box along the world's axes; null: none."""
    sphere: Sphere | None = None
    """A ball; null: none."""
    half_space: HalfSpace | None = None
    """One side of a plane; null: none."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if self.box is None and self.sphere is None and self.half_space is None:
            yield "box", "must be given, or a sphere or a half_space"


def _options(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(name): real(option) for name, option in value.items()}
    if isinstance(value, bool):
        return value
    raise ValueError("must be true, false or numbers by option")


Options = Annotated[StrictBool | dict[str, Number], BeforeValidator(_options)]
"""Of a constraint that another package or the user adds: whether it acts, or its options."""


class Constraints(Document):
    """Which configurations are admitted: those that all constraints admit.

    Further names are those of constraints that were added with `register_constraint`: true, or their options.
    """

    model_config = ConfigDict(extra="allow")
    __pydantic_extra__: dict[str, Options]  # type: ignore[assignment]

    region: RegionChoice | None = None
    """Where the tip may be; null: anywhere."""

    @property
    def added(self) -> dict[str, dict[str, float]]:
        """Options of the added constraints that act, by name."""
        acting = {name: each for name, each in (self.__pydantic_extra__ or {}).items() if each is not False}
        return {name: options if isinstance(options, dict) else {} for name, options in acting.items()}


class Constrained(Document):
    """The field of every arm whose configurations may be constrained."""

    constraints: Constraints | None = None
    """Which configurations are admitted; null: all."""
