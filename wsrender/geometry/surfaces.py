"""The surfaces that a job can ask for, each a closed mesh, and what a result says of them."""

import re
from collections.abc import Iterable
from typing import Any

import numpy as np
import trimesh

from wsrender.documents.surfaces import AlphaShapeSurface, IsoSurface, Surface
from wsrender.errors import InputError
from wsrender.geometry.alpha_shape import AlphaShape, spatial
from wsrender.geometry.voxel_surface import occupied_surface
from wsrender.volume.volume_data import VolumeData


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
