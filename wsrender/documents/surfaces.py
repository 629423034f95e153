"""The surfaces that a job can ask for."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from wsrender.documents.document import Document
from wsrender.documents.quantities import Name, PositiveNumber, real, sequence

_ALLOWED = (
    'must be a list of "marching_cubes", "convex_hull", {"alpha_shape": radius in metres} and '
    '{"iso_surface": index, "fraction": of its maximum}'
)


def _fraction(value: Any) -> float:
    number = real(value)
    if not 0 < number <= 1:
        raise ValueError("must be above 0, and at most 1")
    return number


class AlphaShapeSurface(Document):
    """Boundary of the Delaunay tetrahedra of the sampled positions whose circumspheres are small enough."""

    alpha_shape: PositiveNumber
    """Largest radius of the circumspheres, α [m]."""


class IsoSurface(Document):
    """Surface of the voxels in which an index comes close to its maximum."""

    iso_surface: Name
    """The index; its largest value per voxel counts (its mean where the volume holds no maximum)."""
    fraction: Annotated[float, Field(gt=0, le=1), BeforeValidator(_fraction)] = 0.9
    """Threshold μ, a fraction of the largest value of all voxels."""


Surface = Literal["marching_cubes", "convex_hull"] | AlphaShapeSurface | IsoSurface
_NAMED = ("marching_cubes", "convex_hull")
_KINDS = {"alpha_shape": AlphaShapeSurface, "iso_surface": IsoSurface}


def _surface(value: Any) -> Any:
    if isinstance(value, Document) or value in _NAMED:
        return value
    kinds = [kind for key, kind in _KINDS.items() if isinstance(value, Mapping) and key in value]
    if len(kinds) != 1:
        raise ValueError(_ALLOWED)
    return kinds[0].model_validate(value)


def _surfaces(value: Any) -> tuple[Any, ...]:
    surfaces = tuple(_surface(item) for item in sequence(value))
    if any(surface in surfaces[:k] for k, surface in enumerate(surfaces)):
        raise ValueError("must not ask for a surface twice")
    return surfaces


Surfaces = Annotated[tuple[Surface, ...], BeforeValidator(_surfaces)]
