"""What a 3-D picture shows, as plain arrays: what goes to the process that draws it."""

from dataclasses import dataclass, field

import numpy as np

from wsrender.results.drawing.camera import Camera

Color = tuple[float, float, float]
"""Red, green, blue, 0 … 1."""


@dataclass(frozen=True, eq=False)
class DrawnSurface:
    """Triangles: ``vertices`` (V, 3) [m], ``faces`` (F, 3), one colour or uint8 ``colors`` (V, 3) per vertex.

    ``smooth`` rounds off the steps of voxels, in the picture only.
    """

    vertices: np.ndarray
    faces: np.ndarray
    color: Color = (0.5, 0.5, 0.5)
    colors: np.ndarray | None = None
    alpha: float = 1.0
    smooth: bool = False


@dataclass(frozen=True, eq=False)
class Plates:
    """Flat quadrangles without shading: ``corners`` (N, 4, 3) [m] and uint8 ``colors`` (N, 3)."""

    corners: np.ndarray
    colors: np.ndarray


@dataclass(frozen=True, eq=False)
class Dots:
    """Dots: ``positions`` (N, 3) [m], uint8 ``colors`` (N, 3), ``size`` in pixels of the figure."""

    positions: np.ndarray
    colors: np.ndarray
    size: float


@dataclass(frozen=True, eq=False)
class Cloud:
    """A density of light per voxel: uint8 ``levels`` (nx, ny, nz) into ``table`` (256, 4), RGBA 0 … 1.

    ``origin`` (3,) is the lower corner of the first voxel [m]; alpha is per voxel length.
    """

    levels: np.ndarray
    table: np.ndarray
    origin: np.ndarray
    voxel_size: float


@dataclass(frozen=True, eq=False)
class Lines:
    """Thin straight lines: ``ends`` (N, 2, 3) [m]."""

    ends: np.ndarray
    color: Color = (0.8, 0.8, 0.8)
    width: float = 1.0


@dataclass(frozen=True, eq=False)
class Rods:
    """Round rods from point to point (N, 3) [m], with balls at the ends and corners."""

    points: np.ndarray
    radius: float
    color: Color
    joint_color: Color = (1.0, 1.0, 1.0)
    tip_color: Color = (0.784, 0.063, 0.18)


Layer = DrawnSurface | Plates | Dots | Cloud | Lines | Rods


@dataclass(frozen=True, eq=False)
class DrawnScene:
    """Layers, seen by a camera in a picture of ``size`` (width, height) pixels."""

    camera: Camera
    size: tuple[int, int]
    layers: list[Layer] = field(default_factory=list)
