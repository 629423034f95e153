"""Watertight triangle meshes of ball regions: every vertex lies on the exact surfaces, borders are shared."""

from typing import Any

import numpy as np
import trimesh

from wsrender.mechanisms.exact.borders import LARGEST_ANGLE, Borders, steps_of
from wsrender.mechanisms.exact.faces import Chart, Face, FacesOnSurface
from wsrender.mechanisms.exact.triangulation import refined

LONGER = 1.3  # edges inside faces than those along borders, without which halving near a border does not end


def region_mesh(borders: Borders, patches: list[FacesOnSurface], faces: list[Face], step: float) -> trimesh.Trimesh:
    """Closed mesh [m], normals out of the region, its edges inside faces at most about ``step`` (scaled) long.

    The attribute ``surface`` of its triangles numbers the surface on which each lies.
    """
    surfaces = borders.arcs.surfaces
    points, triangles, owners = [borders.points], [], []
    if patches:
        inner, covering = _covered(patches, LONGER * steps_of(surfaces, step), len(borders.points))
        points.append(inner)
        triangles += [_outwards(own, surfaces.sides[patch.surface]) for patch, own in covering]
        owners += [np.full(len(own), patch.surface) for patch, own in covering]
    for sphere in (face.surface for face in faces if not face.loops):
        radius, total = float(surfaces.radii[0, sphere]), sum(map(len, points))
        ball = trimesh.creation.icosphere(_subdivisions(min(step / radius, LARGEST_ANGLE)), radius)
        triangles.append(_outwards(ball.faces + total, surfaces.side[sphere]))
        owners.append(np.full(len(ball.faces), sphere))
        points.append(ball.vertices + surfaces.centres[0, sphere])
    triangles = np.concatenate([np.zeros((0, 3), int), *triangles])
    used, renumbered = np.unique(triangles, return_inverse=True)
    vertices = surfaces.origin[0] + surfaces.scale[0] * np.concatenate(points)[used]
    metadata = {"frame": "base", "unit": "m", "up": "z"}
    numbers: dict[str, Any] = {"surface": np.concatenate([np.zeros(0, int), *owners]).astype(np.int32)}
    return trimesh.Trimesh(
        vertices, renumbered.reshape(-1, 3), face_attributes=numbers, process=False, metadata=metadata
    )


def _outwards(triangles: np.ndarray, side: float) -> np.ndarray:
    return triangles if side > 0 else triangles[:, ::-1]


def _subdivisions(step: float) -> int:
    """How often the edges of an icosahedron, 1.05 of its radius, are halved to be at most ``step``."""
    return int(np.clip(np.ceil(np.log2(1.05 / step)), 1, 7))


def _covered(
    patches: list[FacesOnSurface], steps: np.ndarray, first: int
) -> tuple[np.ndarray, list[tuple[FacesOnSurface, np.ndarray]]]:
    """Points (n, 3) inside faces, to be numbered from ``first``, and the triangles (t, 3) of every patch."""
    counts = [len(patch.ids) for patch in patches]
    before = np.cumsum([0, *counts[:-1]])
    charts = [patch.chart for patch in patches]
    flat, owner, triangles = refined(
        np.concatenate([patch.flat for patch in patches]),
        np.repeat(np.arange(len(patches)), counts),
        np.concatenate([patch.triangles + start for patch, start in zip(patches, before, strict=True)]),
        lambda flat, owner: _lifted(charts, flat, owner),
        # A chart of a plane is flat: no edge is too long for it.
        np.array([steps[patch.surface] if patch.chart.radius else np.inf for patch in patches]),
    )
    borders = sum(counts)
    ids = np.concatenate([*(patch.ids for patch in patches), first + np.arange(len(flat) - borders)])
    of = owner[triangles[:, 0]]
    covering = [(patch, ids[triangles[of == k]]) for k, patch in enumerate(patches)]
    return _lifted(charts, flat[borders:], owner[borders:]), covering


def _lifted(charts: list[Chart], flat: np.ndarray, owner: np.ndarray) -> np.ndarray:
    """Points (n, 3) at places (n, 2) of the charts numbered by ``owner`` (n,)."""
    points = np.empty((len(flat), 3))
    for number, chart in enumerate(charts):
        own = owner == number
        points[own] = chart.lifted(flat[own])
    return points
