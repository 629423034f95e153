"""What stands around a robot, in one vocabulary: for forces, for pictures, and for where a tip or a platform may be.

Shapes stand in the world, lengths are full lengths. A shape is solid; a half-space is solid behind its plane.
"""

from collections.abc import Iterable, Iterator, Mapping
from typing import Annotated, Any, Literal, get_args

from pydantic import BeforeValidator, Discriminator, Field

from wsrender.documents.arm import Arm
from wsrender.documents.document import Document
from wsrender.documents.problems import tagged
from wsrender.documents.quantities import Name, Sha256, is_none, numbers_of, quoted, real, sequence
from wsrender.documents.robot import XmlText
from wsrender.documents.shapes import (
    Box,
    Capsule,
    ConvexMesh,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    HeightField,
    Mesh,
    Named,
    Placed,
    Sphere,
)
from wsrender.documents.transform import LengthUnit

MOST_SHAPES = 100
SCENES = ("path", "mjcf", "model")


def _configuration(value: Any) -> tuple[float, ...]:
    if not (numbers := numbers_of(value)):
        raise ValueError("must be a list of finite numbers, one for each joint")
    return numbers


def _sides(value: Any) -> tuple[float | None, ...]:
    try:
        sides = tuple(None if side is None else real(side) for side in sequence(value))
    except ValueError:
        sides = ()
    if len(sides) != 3:
        raise ValueError("must be a list of 3 finite numbers or null")
    return sides


Configuration = Annotated[tuple[float, ...], BeforeValidator(_configuration)]
Sides = Annotated[tuple[float | None, float | None, float | None], BeforeValidator(_sides)]


class OtherRobot(Named, Arm):
    """Another robot that stands still: all its shapes that may collide, named robot/shape."""

    shape: Literal["robot"] = "robot"
    """robot."""
    configuration: Configuration
    """Where the joints between its base and tip stand [rad or m]; others at its reference."""


class Scene(Placed):
    """What stands still in an MJCF file: shapes that may collide and that no joint moves, named scene/geom.

    Its place is that of the file's world.
    """

    shape: Literal["scene"] = "scene"
    """scene."""
    mjcf: XmlText | None = None
    """Its text."""
    model: Sha256 | None = None
    """SHA-256 of an MJCF model, or a ZIP with one, uploaded to a server, 64 hexadecimal digits."""
    path: Name | None = None
    """An .xml file, a ZIP or a folder; local runs only."""
    entry: Annotated[Name | None, Field(exclude_if=is_none)] = None
    """Which file of a ZIP or folder is the model; null: the only one that no other includes."""
    length_unit_m: LengthUnit = 1.0
    """Unit of length of the file in metres: 0.001 of millimetres."""

    def __init__(self, path: Any = None, /, **values: Any):
        Document.__init__(self, **values if path is None else {"path": str(path), **values})

    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        yield from super().conflicts()
        given = [name for name in SCENES if getattr(self, name) is not None]
        if len(given) != 1:
            field = given[1] if given else SCENES[0]
            yield field, f"must be given, or another source of the scene: one of {quoted(SCENES)}"
        if self.entry is not None and self.mjcf is not None:
            yield "entry", 'must not be given together with "mjcf": it names a file of a ZIP'


def _shape(value: Any) -> Any:
    """A shape by its tag, which an object with a robot need not have."""
    if isinstance(value, Mapping) and "robot" in value:
        value = {"shape": "robot", **value}
    return _tagged(value)


Shape = HalfSpace | Box | Sphere | Cylinder | Capsule | Ellipsoid | ConvexMesh | Mesh | HeightField
"""One that is a shape itself."""
_AnyItem = Shape | OtherRobot | Scene
SHAPES: dict[str, type[Document]] = {each.model_fields["shape"].default: each for each in get_args(_AnyItem)}
_tagged = tagged("shape", SHAPES)
Item = Annotated[_AnyItem, Discriminator("shape"), BeforeValidator(_shape)]


class Environment(Document):
    """What stands around a robot."""

    items: Annotated[tuple[Item, ...], Field(max_length=MOST_SHAPES)]
    """Shapes, robots and scenes; names are unique."""

    def __init__(self, items: Iterable[Any] | None = None, /, **values: Any):
        Document.__init__(self, **values if items is None else {"items": tuple(items), **values})

    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        first: dict[str, int] = {}
        for k, item in enumerate(self.items):
            if item.name is not None and first.setdefault(item.name, k) != k:
                yield f"items.{k}.name", f'must be another than that of items.{first[item.name]}, "{item.name}"'


class Bounds(Document):
    """A box along the axes that a point does not leave; null: no side there [m]."""

    lower_m: Sides = (None, None, None)
    """Least x, y, z."""
    upper_m: Sides = (None, None, None)
    """Largest x, y, z."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        for axis, low, high in zip("xyz", self.lower_m, self.upper_m, strict=True):
            if low is not None and high is not None and not low < high:
                yield "upper_m", f"must be above lower_m; along {axis} it is {high:g}, not above {low:g}"
