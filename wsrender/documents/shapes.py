"""Shapes of job documents, in one vocabulary: of what stands around, of regions, and of tools.

Lengths are full lengths. A shape is solid; a half-space is solid behind its plane.
"""

import math
from collections.abc import Iterator, Mapping
from typing import Annotated, Any, ClassVar, Literal, get_args

import numpy as np
from pydantic import BeforeValidator, Discriminator, Field, StrictBool, ValidationError, model_validator

from wsrender.documents.document import Document
from wsrender.documents.problems import located, tagged
from wsrender.documents.quantities import Name, PositiveNumber, Sha256, is_none, numbers_of, points_of, sequence
from wsrender.documents.transform import LengthUnit, Transform, Vector

MOST_VERTICES = 10_000
MOST_HEIGHTS = 40_000  # 200 by 200; a file may have as many
MESH_FILES = (".obj", ".ply", ".stl")
MEDIA_TYPES = {ending: f"model/{ending[1:]}" for ending in MESH_FILES} | {".npy": "application/x-npy"}
"""Of files that say a shape, by their endings."""


def _points(value: Any) -> tuple[tuple[float, ...], ...] | None:
    if value is None:
        return None
    points = points_of(value)
    if not 4 <= len(points) <= MOST_VERTICES:
        raise ValueError(f"must be a list of 4 … {MOST_VERTICES} points [x, y, z], finite numbers")
    return points


def _heights(value: Any) -> tuple[tuple[float, ...], ...] | None:
    if value is None:
        return None
    rows = [numbers_of(row) for row in sequence(value)]
    count = sum(len(row or ()) for row in rows)
    if len({len(row or ()) for row in rows}) != 1 or min(len(rows), len(rows[0] or ())) < 2 or count > MOST_HEIGHTS:
        raise ValueError(f"must be at least 2 rows of as many numbers, at least 2, and at most {MOST_HEIGHTS} in all")
    return tuple(map(tuple, rows))  # type: ignore[arg-type]


Edges = Annotated[tuple[PositiveNumber, PositiveNumber, PositiveNumber], BeforeValidator(sequence)]
Heights = Annotated[tuple[tuple[PositiveNumber, ...], ...] | None, BeforeValidator(_heights)]
Points = Annotated[tuple[tuple[float, float, float], ...] | None, BeforeValidator(_points)]


class Named(Document):
    """What may have a name."""

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


class Placed(Named, Transform):
    """A shape with a place and an orientation."""

    earlier = "pose"


class HalfSpace(Named):
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


class Sphere(Named):
    """A ball."""

    earlier = "center_m"

    shape: Literal["sphere"] = "sphere"
    """sphere."""
    position_m: Vector = (0.0, 0.0, 0.0)
    """Its centre in the world [m]; center_m says the same."""
    radius_m: PositiveNumber
    """Its radius [m]."""

    def matrix(self) -> np.ndarray:
        """Its frame in the world, as those of other shapes; turned as the world."""
        return Transform(position_m=self.position_m).matrix()


class Box(Placed):
    """A box; its place is that of its centre."""

    shape: Literal["box"] = "box"
    """box."""
    size_m: Edges
    """Edge lengths along its own x, y, z [m]."""


class Cylinder(Placed):
    """A cylinder about its own z; its place is that of its centre."""

    shape: Literal["cylinder"] = "cylinder"
    """cylinder."""
    radius_m: PositiveNumber
    """Its radius [m]."""
    length_m: PositiveNumber
    """Its length [m]."""


class Capsule(Placed):
    """A cylinder about its own z with a half ball at either end; its place is that of its centre."""

    shape: Literal["capsule"] = "capsule"
    """capsule."""
    radius_m: PositiveNumber
    """Radius of cylinder and half balls [m]."""
    length_m: PositiveNumber
    """Length of the cylinder, between the centres of the half balls [m]."""


class Ellipsoid(Placed):
    """An ellipsoid; its place is that of its centre."""

    shape: Literal["ellipsoid"] = "ellipsoid"
    """ellipsoid."""
    size_m: Edges
    """Lengths of its axes along its own x, y, z [m]."""


class _OfVertices(Placed):
    """A shape by points or by the file of a mesh; its place is that of their frame."""

    vertices_m: Points = None
    """Points [x, y, z] in that frame, of which the convex hull counts [m]; they must not lie in a plane."""
    path: Name | None = None
    """A file of triangles, .stl, .obj or .ply; local runs only."""
    model: Annotated[Sha256 | None, Field(exclude_if=is_none)] = None
    """SHA-256 of such a file that was uploaded to a server, 64 hexadecimal digits."""
    length_unit_m: LengthUnit = 1.0
    """Unit of length of the file in metres: 0.001 of millimetres."""

    def __init__(self, path: Any = None, /, **values: Any):
        Document.__init__(self, **values if path is None else {"path": str(path), **values})

    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        yield from super().conflicts()
        if sum(each is not None for each in (self.vertices_m, self.path, self.model)) != 1:
            yield "vertices_m", 'must be given, or else "path" or "model": one of them'
        if self.path is not None and not self.path.lower().endswith(MESH_FILES):
            yield "path", f'must end in {", ".join(MESH_FILES)}, not "{self.path}"'
        if self.vertices_m is not None and self.length_unit_m != 1:
            yield "length_unit_m", 'must be 1 without "path" or "model": vertices_m are in metres'


class ConvexMesh(_OfVertices):
    """The convex hull of points, such as the vertices of a mesh; its place is that of their frame."""

    shape: Literal["convex_mesh"] = "convex_mesh"
    """convex_mesh."""


class Mesh(_OfVertices):
    """What a closed mesh encloses, or the convex hull of points; its place is that of their frame."""

    shape: Literal["mesh"] = "mesh"
    """mesh."""
    convex: Annotated[StrictBool | None, Field(exclude_if=is_none)] = None
    """null: of what stands around, the solid that the file's triangles enclose; of vertices_m, and of tools, the convex
    hull. true: the hull, as a convex_mesh. false: the solid in convex pieces that hold it."""
    tolerance_m: Annotated[PositiveNumber | None, Field(exclude_if=is_none)] = None
    """How far convex pieces may go beyond the solid [m]; null: 0.001."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        yield from super().conflicts()
        if self.vertices_m is not None and self.convex is False:
            yield "convex", "must not be false with vertices_m, which say no triangles"
        if self.convex is not False and self.tolerance_m is not None:
            yield "tolerance_m", 'must not be given but with "convex": false'


class HeightField(Placed):
    """The ground between heights on a grid and a base below them, as MuJoCo's; its place is that of the base's middle.

    Heights stand at equal steps over the size, corner to corner, the first row at the lowest y, its first at the lowest
    x. Two triangles span each cell, cut from its corner of lowest x and y to that of highest x and y.
    """

    shape: Literal["height_field"] = "height_field"
    """height_field."""
    size_m: Annotated[tuple[PositiveNumber, PositiveNumber], BeforeValidator(sequence)]
    """Full lengths along its own x and y [m]."""
    heights_m: Heights = None
    """Rows of heights above the base, along x [m], at least 2 of at least 2 positive numbers."""
    path: Name | None = None
    """A file with them, .npy; local runs only."""
    model: Annotated[Sha256 | None, Field(exclude_if=is_none)] = None
    """SHA-256 of such a file that was uploaded to a server, 64 hexadecimal digits."""
    length_unit_m: LengthUnit = 1.0
    """Unit of length of the file in metres: 0.001 of millimetres."""

    def __init__(self, path: Any = None, /, **values: Any):
        Document.__init__(self, **values if path is None else {"path": str(path), **values})

    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        yield from super().conflicts()
        if sum(each is not None for each in (self.heights_m, self.path, self.model)) != 1:
            yield "heights_m", 'must be given, or else "path" or "model": one of them'
        if self.path is not None and not self.path.lower().endswith(".npy"):
            yield "path", f'must end in .npy, not "{self.path}"'
        if self.heights_m is not None and self.length_unit_m != 1:
            yield "length_unit_m", 'must be 1 without "path" or "model": heights_m are in metres'


_Bounded = Box | Sphere | Cylinder | Capsule | Ellipsoid | ConvexMesh | Mesh
_TAGS = [each.model_fields["shape"].default for each in get_args(_Bounded)]
ToolShape = Annotated[_Bounded, Discriminator("shape"), BeforeValidator(tagged("shape", _TAGS))]
"""One that a tip may carry."""


def half_sizes(shape: _Bounded) -> tuple[float, float, float]:
    """Radius and half length, or half edges [m], as MuJoCo has them; zeros of a mesh."""
    match shape:
        case Sphere():
            return shape.radius_m, 0.0, 0.0
        case Box() | Ellipsoid():
            x, y, z = shape.size_m
            return x / 2, y / 2, z / 2
        case Cylinder() | Capsule():
            return shape.radius_m, shape.length_m / 2, 0.0
    return 0.0, 0.0, 0.0
