"""Surfaces as closed meshes: of occupied voxels, and those that a job can ask for with what a result says of them."""

import re
from collections.abc import Iterable
from typing import Any

import numpy as np
import trimesh
from scipy.ndimage import distance_transform_edt
from skimage.measure import block_reduce, marching_cubes

from wsrender.documents.options import AlphaShapeSurface, IsoSurface, Surface
from wsrender.errors import InputError
from wsrender.geometry.alpha_shape import AlphaShape, spatial
from wsrender.volume.volume_data import VolumeData

# A cloud sampled too thinly for its voxels has millions of one-voxel islands; a mesh of them fills the
# memory and shows nothing.
MAX_VOXEL_FACES = 4_000_000
_PEAK = 0.02  # of the level: least height above it of what is on it


def convex_hull(points: np.ndarray) -> trimesh.Trimesh:
    """Convex hull of points (N, 3) [m], outward normals; InputError where they lie in a plane."""
    hull = trimesh.convex.convex_hull(spatial(points))
    hull.metadata = {"frame": "world", "unit": "m", "up": "z"}
    return hull


def surfaces(
    asked: Iterable[Surface], volume: VolumeData, points: np.ndarray
) -> tuple[dict[str, trimesh.Trimesh], dict[str, dict[str, Any]]]:
    """Meshes by name, and the entry of each in the result document.

    Marching cubes and iso-surfaces are of the voxels, alpha shape and convex hull of ``points`` (N, 3) [m]: their
    entries say of how many, and what volume the shape of either half of them has, drawn at random. Where a set encloses
    no volume the entry says why there is no mesh.
    """
    meshes, entries = {}, {}
    for surface in asked:
        name = mesh_name(surface)
        try:
            mesh = _made(surface, volume, points)
        except InputError as error:
            entries[name] = {"mesh": None, "reason": str(error)}
        else:
            meshes[name] = mesh
            entries[name] = surface_entry(name, mesh)
            if _of_points(surface):
                entries[name] |= {"points": len(points), **_half_volumes(surface, points)}
    return meshes, entries


def mesh_name(surface: Surface) -> str:
    """Name of a surface in a result, also of its files."""
    if isinstance(surface, IsoSurface):
        return "iso_" + re.sub(r"[^A-Za-z0-9_-]", "_", surface.iso_surface)
    if isinstance(surface, AlphaShapeSurface):
        return "alpha_shape"
    return {"marching_cubes": "surface"}.get(surface, surface)


def surface_entry(name: str, mesh: trimesh.Trimesh) -> dict[str, Any]:
    """What the result document says of a mesh: volume [m³], area [m²], whether closed, and how it was made."""
    made_with = {key: mesh.metadata[key] for key in ("voxel_size_m", "alpha_m", "split_edges") if key in mesh.metadata}
    return {
        "mesh": name,
        "volume_m3": float(mesh.volume),
        "area_m2": float(mesh.area),
        "watertight": bool(mesh.is_watertight),
        "triangles": len(mesh.faces),
        **made_with,
    }


def _of_points(surface: Surface) -> bool:
    return isinstance(surface, AlphaShapeSurface) or surface == "convex_hull"


def _half_volumes(surface: Surface, points: np.ndarray) -> dict[str, float | None]:
    """Volumes [m³] of the shapes of two halves of the points; None where they enclose nothing.

    Points miss the outermost of a workspace, and leave gaps wider than an alpha shape bridges: how far the halves are
    from the whole says how much more samples would still change.
    """
    halves = np.array_split(np.random.default_rng(0).permutation(points), 2)
    names = ("volume_of_one_half_m3", "volume_of_other_half_m3")
    return {name: _volume(surface, half) for name, half in zip(names, halves, strict=True)}


def _volume(surface: Surface, points: np.ndarray) -> float | None:
    try:
        if isinstance(surface, AlphaShapeSurface):
            return AlphaShape.of(points, surface.alpha_shape).volume_m3
        return float(convex_hull(points).volume)
    except InputError:
        return None


def _made(surface: Surface, volume: VolumeData, points: np.ndarray) -> trimesh.Trimesh:
    if isinstance(surface, AlphaShapeSurface):
        return AlphaShape.of(points, surface.alpha_shape).mesh()
    if isinstance(surface, IsoSurface):
        statistic = "maximum" if "maximum" in volume.statistics else "mean"
        return occupied_surface(volume, surface.iso_surface, statistic=statistic, fraction=surface.fraction)
    return convex_hull(points) if surface == "convex_hull" else occupied_surface(volume)


def occupied_surface(
    volume: VolumeData, index: str | None = None, *, statistic: str = "maximum", fraction: float = 0.9
) -> trimesh.Trimesh:
    """Closed surface around the occupied voxels, in metres in the world frame.

    With ``index``, around the voxels whose ``statistic`` is at least ``fraction`` of its maximum over the
    volume (0.9: iso-surface of Zhang, Cursi, Yang, WSRender, RA-L 2019, Table II). Marching cubes (Lorensen
    and Cline 1987) of the 0/1 field at the voxel centres; outward normals; the surface touches the outer
    faces of the voxels and cuts their edges. Where it would have more than 4 million voxel faces, voxels are
    merged 2×2×2 until it has fewer; ``metadata["voxel_size_m"]`` is the size used.

    Raises InputError for an unknown index or statistic, a fraction outside (0, 1], or no occupied voxel.
    """
    inside = volume.occupied if index is None else _above(volume, index, statistic, fraction)
    if not inside.any():
        raise InputError("volume", "has no occupied voxel, so there is no surface")
    first, size = np.array(volume.first_voxel), volume.voxel_size_m
    padded = np.pad(inside, 1)
    while _voxel_faces(padded) > MAX_VOXEL_FACES:
        inside, first, size = _coarser(inside, first, size)
        padded = np.pad(inside, 1)
    # The Lewiner variant, scikit-image's default, leaves holes where voxels touch at an edge.
    vertices, faces, _, _ = marching_cubes(
        padded.astype(np.float32), 0.5, method="lorensen", gradient_direction="ascent"
    )
    vertices_world = (first + (vertices.astype(np.float64) - 0.5)) * size
    metadata = {"frame": "world", "unit": "m", "up": "z", "voxel_size_m": size}
    return trimesh.Trimesh(vertices_world, faces, process=False, metadata=metadata)


def level_surface(volume: VolumeData, values: np.ndarray, level: float) -> trimesh.Trimesh:
    """Closed surface of where ``values`` (nx, ny, nz), NaN where empty, are at least ``level``, metres, world frame.

    Marching cubes (Lorensen and Cline 1987) of the values, linear between the centres of voxels; towards empty voxels
    it lies on the faces of the others. A voxel above all its neighbours keeps a size that is seen. Raises InputError
    where no value reaches the level.
    """
    above = np.pad(values, 1, constant_values=np.nan) - level
    known = np.isfinite(above)
    if not (above[known] >= 0).any():
        raise InputError("level", f"is {level:g}, above every value: there is no surface")
    peak = _PEAK * max(float(above[known].max()), abs(level), 1e-300)
    above = np.where(above >= 0, np.maximum(above, peak), above)
    nearest: Any = distance_transform_edt(~known, return_distances=False, return_indices=True)
    field = np.where(known, above, -np.abs(above[tuple(nearest)]))
    vertices, faces, _, _ = marching_cubes(field, 0.0, method="lorensen", gradient_direction="ascent")
    return trimesh.Trimesh((np.array(volume.first_voxel) + vertices - 0.5) * volume.voxel_size_m, faces, process=False)


def _above(volume: VolumeData, index: str, statistic: str, fraction: float) -> np.ndarray:
    values = volume.statistics.get(statistic, {}).get(index)
    if values is None:
        kept = sorted({name for by_index in volume.statistics.values() for name in by_index})
        raise InputError("index", f"the volume has no {statistic} of {index!r}; it holds {', '.join(kept)}")
    if not 0 < fraction <= 1:
        raise InputError("fraction", f"is {fraction}; allowed are values above 0, up to 1")
    occupied = volume.occupied
    limit = fraction * values[occupied].max(initial=-np.inf)
    return occupied & (np.nan_to_num(values, nan=-np.inf) >= limit)


def _voxel_faces(padded: np.ndarray) -> int:
    return sum(int(np.count_nonzero(np.diff(padded, axis=axis))) for axis in range(3))


def _coarser(inside: np.ndarray, first: np.ndarray, size: float) -> tuple[np.ndarray, np.ndarray, float]:
    """The lattice of twice the voxel size, whose voxels are inside if any of their eight parts is."""
    aligned = np.pad(inside, [(int(start % 2), 0) for start in first])
    return block_reduce(aligned, 2, np.max), first // 2, 2 * size
