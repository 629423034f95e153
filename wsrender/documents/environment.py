"""What stands around a robot, in one vocabulary: for forces, for pictures, and for where a tip or a platform may be.

Shapes stand in the world, lengths are full lengths. A shape is solid; a half-space is solid behind its plane.
"""

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Annotated, Any, ClassVar, Literal, get_args

from pydantic import BeforeValidator, Discriminator, Field, ValidationError, model_validator

from wsrender.documents.arm import Arm
from wsrender.documents.document import Document
from wsrender.documents.problems import located, tagged
from wsrender.documents.quantities import Name, PositiveNumber, numbers_of, points_of, quoted, real, sequence
from wsrender.documents.robot import LengthUnit, ModelHash, Transform, Vector, XmlText

MOST_SHAPES = 100
MOST_VERTICES = 10_000
MESH_FILES = (".obj", ".ply", ".stl")
SCENES = ("path", "mjcf", "model")


def _points(value: Any) -> tuple[tuple[float, ...], ...] | None:
    if value is None:
        return None
    points = points_of(value)
    if not 4 <= len(points) <= MOST_VERTICES:
        raise ValueError(f"must be a list of 4 … {MOST_VERTICES} points [x, y, z], finite numbers")
    return points


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


Edges = Annotated[tuple[PositiveNumber, PositiveNumber, PositiveNumber], BeforeValidator(sequence)]
Points = Annotated[tuple[tuple[float, float, float], ...] | None, BeforeValidator(_points)]
Configuration = Annotated[tuple[float, ...], BeforeValidator(_configuration)]
Sides = Annotated[tuple[float | None, float | None, float | None], BeforeValidator(_sides)]


class _Named(Document):
    name: Name | None = None
    """Name in messages and pictures; null: none."""

    earlier: ClassVar[str] = ""
    """A field that once said where the shape is, and is read still."""

    @model_validator(mode="before")
    @classmethod
    def _converted(cls, data: Any) -> Any:
        if not isinstance(data, Mapping) or cls.earlier not in data:
            return data
        value = data[cls.earlier]
        now = _fields_of_pose(value) if cls.earlier == "pose" else {"position_m": value}
        if twice := sorted(now.keys() & data.keys()):
            problem = located(cls.earlier, f'must not be given together with "{twice[0]}", which says the same')
            raise ValidationError.from_exception_data(cls.__name__, [problem])
        return {name: each for name, each in data.items() if name != cls.earlier} | now


def _fields_of_pose(pose: Any) -> dict[str, Any]:
    """The fields of a placement that now stand in the shape itself."""
    if isinstance(pose, Transform):
        return pose.model_dump(exclude_unset=True)
    return dict(pose) if isinstance(pose, Mapping) else {"position_m": pose}


class _Placed(_Named, Transform):
    """A shape with a place and an orientation."""

    earlier = "pose"


class HalfSpace(_Named):
    """All on one side of a plane: of what stands around, the side behind it is solid; a region is the side before."""

    shape: Literal["half_space"] = "half_space"
    """half_space."""
    point_m: Vector = (0.0, 0.0, 0.0)
    """A point of the plane, in the world [m]."""
    normal: Vector = (0.0, 0.0, 1.0)
    """The plane's normal, pointing into what is free; any length but zero."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if not 1e-6 < math.hypot(*self.normal) < 1e6:
            yield "normal", f"must not have length {math.hypot(*self.normal):g}: it says no direction"


class Sphere(_Named):
    """A ball."""

    earlier = "center_m"

    shape: Literal["sphere"] = "sphere"
    """sphere."""
    position_m: Vector = (0.0, 0.0, 0.0)
    """Its centre in the world [m]; center_m says the same."""
    radius_m: PositiveNumber
    """Its radius [m]."""


class Box(_Placed):
    """A box; its place is that of its centre."""

    shape: Literal["box"] = "box"
    """box."""
    size_m: Edges
    """Edge lengths along its own x, y, z [m]."""


class Cylinder(_Placed):
    """A cylinder about its own z; its place is that of its centre."""

    shape: Literal["cylinder"] = "cylinder"
    """cylinder."""
    radius_m: PositiveNumber
    """Its radius [m]."""
    length_m: PositiveNumber
    """Its length [m]."""


class Capsule(_Placed):
    """A cylinder about its own z with a half ball at either end; its place is that of its centre."""

    shape: Literal["capsule"] = "capsule"
    """capsule."""
    radius_m: PositiveNumber
    """Radius of cylinder and half balls [m]."""
    length_m: PositiveNumber
    """Length of the cylinder, between the centres of the half balls [m]."""


class Ellipsoid(_Placed):
    """An ellipsoid; its place is that of its centre."""

    shape: Literal["ellipsoid"] = "ellipsoid"
    """ellipsoid."""
    size_m: Edges
    """Lengths of its axes along its own x, y, z [m]."""


class Mesh(_Placed):
    """The convex hull of points, such as the vertices of a mesh; its place is that of their frame."""

    shape: Literal["mesh"] = "mesh"
    """mesh."""
    vertices_m: Points = None
    """Points [x, y, z] in that frame [m]; they must not lie in a plane."""
    path: Name | None = None
    """A file with the vertices, .stl, .obj or .ply; local runs only."""
    length_unit_m: LengthUnit = 1.0
    """Unit of length of the file in metres: 0.001 of millimetres."""

    def __init__(self, path: Any = None, /, **values: Any):
        Document.__init__(self, **values if path is None else {"path": str(path), **values})

    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        yield from super().conflicts()
        if (self.vertices_m is None) == (self.path is None):
            yield "vertices_m", 'must be given, or else "path": one of the two'
        if self.path is not None and not self.path.lower().endswith(MESH_FILES):
            yield "path", f'must end in {", ".join(MESH_FILES)}, not "{self.path}"'
        if self.path is None and self.length_unit_m != 1:
            yield "length_unit_m", 'must be 1 without "path": vertices_m are in metres'


class OtherRobot(_Named, Arm):
    """Another robot that stands still: all its shapes that may collide, named robot/shape."""

    shape: Literal["robot"] = "robot"
    """robot."""
    configuration: Configuration
    """Where the joints between its base and tip stand [rad or m]; others at its reference."""


class Scene(_Placed):
    """What stands still in an MJCF file: shapes that may collide and that no joint moves, named scene/geom.

    Its place is that of the file's world.
    """

    shape: Literal["scene"] = "scene"
    """scene."""
    mjcf: XmlText | None = None
    """Its text."""
    model: ModelHash | None = None
    """SHA-256 of an MJCF model uploaded to a server, 64 hexadecimal digits."""
    path: Name | None = None
    """An .xml file; local runs only."""
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


def _shape(value: Any) -> Any:
    """A shape by its tag, which an object with a robot need not have."""
    if isinstance(value, Mapping) and "robot" in value:
        value = {"shape": "robot", **value}
    return _tagged(value)


Shape = HalfSpace | Box | Sphere | Cylinder | Capsule | Ellipsoid | Mesh
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
