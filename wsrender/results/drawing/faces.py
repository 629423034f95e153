"""A closed surface whose faces have colours of their own, with its edges and corners."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from wsrender.results.drawing.okabe_ito import BLUE, GREEN, PURPLE, SKY_BLUE, VERMILION
from wsrender.short_repr import short_repr
from wsrender.volume.table import Table

if TYPE_CHECKING:
    import trimesh

Color = tuple[float, float, float]

NUMBER = "surface"  # attribute of triangles: the row of the table of surfaces on which each lies
PLAIN: Color = (0.45, 0.62, 0.75)
# Of each leg one for its upper limit and a pale one for its lower.
_LEGS = (BLUE, VERMILION, GREEN, PURPLE, "#b8a800", SKY_BLUE)
_PALE = 0.5
_CREASE = 0.77  # cosine of the angle between a triangle and the mean around its corner from which on it is an edge
_GREYS = ("#8c8c8c", "#a6a6a6", "#bfbfbf", "#707070", "#d9d9d9", "#595959")


@dataclass(frozen=True, eq=False)
class Faces:
    """Triangles (T, 3) of vertices (V, 3) [m]; ``number`` (T,) says which face each belongs to.

    ``labels`` and ``colors`` are of the numbers that occur; ``normals`` (T, 3, 3) those of the true surface at the
    corners of each triangle, outwards, where it is known.
    """

    vertices: np.ndarray
    triangles: np.ndarray
    number: np.ndarray
    labels: Mapping[int, str]
    colors: Mapping[int, Color]
    normals: np.ndarray | None = None

    __repr__ = short_repr

    @property
    def corners(self) -> np.ndarray:
        """Corners (T, 3, 3) of the triangles [m]."""
        return self.vertices[self.triangles]

    @property
    def closed(self) -> bool:
        """Whether every side of a triangle is one of another's too, the other way round, and all face outwards."""
        a, b = self.triangles, np.roll(self.triangles, -1, axis=1)
        count = len(self.vertices)
        there, back = (np.sort((p.astype(np.int64) * count + q).ravel()) for p, q in ((a, b), (b, a)))
        return np.array_equal(there, back) and float(np.linalg.det(self.corners - self.vertices[0]).sum()) > 0

    def facets(self) -> np.ndarray:
        """Unit normals (T, 3) of the triangles; 0 of those without area."""
        return _unit(self._across())

    def smooth_normals(self) -> np.ndarray:
        """Unit normals (T, 3, 3) at the corners: means of the triangles that meet there in a face, by their areas.

        A surface that is not known by its faces keeps its creases: corners where a triangle is far from the mean.
        """
        at = self.number[:, None] * len(self.vertices) + self.triangles
        at = np.unique(at, return_inverse=True)[1].reshape(at.shape)
        across = np.repeat(self._across(), 3, axis=0)
        total = np.stack([np.bincount(at.ravel(), across[:, k]) for k in range(3)], axis=1)
        smooth = _unit(total)[at]
        if self.labels:
            return smooth
        own = np.broadcast_to(self.facets()[:, None], smooth.shape)
        return np.where((own * smooth).sum(axis=2, keepdims=True) > _CREASE, smooth, own)

    def _across(self) -> np.ndarray:
        """Normals (T, 3) of the triangles, twice as long as their areas."""
        a, b, c = self.corners.transpose(1, 0, 2)
        return np.cross(b - a, c - a)

    def borders(self) -> tuple[np.ndarray, np.ndarray]:
        """Vertices (E, 2) of the sides that two faces share, and where three or more faces meet, (C,)."""
        sides = np.sort(self.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        number = np.repeat(self.number, 3)
        order = np.lexsort(sides.T)
        sides, number = sides[order], number[order]
        between = (sides[1:] == sides[:-1]).all(axis=1) & (number[1:] != number[:-1])
        at = np.unique(np.stack([self.triangles.ravel(), np.repeat(self.number, 3)], axis=1), axis=0)
        return sides[1:][between], np.flatnonzero(np.bincount(at[:, 0], minlength=len(self.vertices)) > 2)


def _unit(vectors: np.ndarray) -> np.ndarray:
    """Vectors (…, 3) of length 1; 0 stays 0."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(length > 0, length, 1.0)


def faces_of(mesh: "trimesh.Trimesh", table: Table | None) -> Faces:
    """The faces of a mesh by the attribute ``surface`` of its triangles, named by the table of surfaces.

    A mesh without the attribute, or a result without the table, is one face of one colour.
    """
    number = mesh.face_attributes.get(NUMBER)
    if number is None or table is None:
        none = np.zeros(len(mesh.faces), np.int64)
        return Faces(np.asarray(mesh.vertices), np.asarray(mesh.faces), none, {}, {0: PLAIN})
    legs = leg_numbers(table)
    present = sorted(np.unique(number).tolist(), key=lambda row: (legs[row] == 0, legs[row], row))
    labels = {row: _label(table, row) for row in present}
    colors = {row: _color(table, row) for row in present}
    return Faces(np.asarray(mesh.vertices), np.asarray(mesh.faces), number, labels, colors)


def leg_numbers(table: Table) -> np.ndarray:
    """The leg of each surface, counted from 1, (K,) int64; 0: none.

    Tables of version 0.1 count from 0, and have −1 for none: there the first leg is at a limit of its own.
    """
    from_zero = bool(((table["leg"] == 0) & (table["limit"] != "")).any())
    return np.maximum(table["leg"] + from_zero, 0)


def _label(table: Table, row: int) -> str:
    """Such as ``leg 2 at its upper limit``, ``inside ball 3`` or ``z = 0.5 m``."""
    kind, leg = str(table["kind"][row]), int(leg_numbers(table)[row])
    if leg:
        return f"leg {leg} at its {table['limit'][row]} limit"
    if kind != "plane":
        return f"{kind} ball {row}"
    axis = int(np.abs(table["normal"][row]).argmax())
    along = abs(table["normal"][row][axis]) > 1 - 1e-9
    return f"{'xyz'[axis]} = {table['center'][row][axis]:.4g} m" if along else f"plane {row}"


def _color(table: Table, row: int) -> Color:
    leg = int(leg_numbers(table)[row])
    if table["kind"][row] == "plane":
        return _rgb(_GREYS[row % len(_GREYS)])
    color = _rgb(_LEGS[(leg - 1 if leg else row) % len(_LEGS)])
    if table["limit"][row] == "lower" or (leg == 0 and table["kind"][row] == "outside"):
        red, green, blue = (1 - _PALE * (1 - part) for part in color)
        return red, green, blue
    return color


def _rgb(text: str) -> Color:
    red, green, blue = (int(text[k : k + 2], 16) / 255 for k in (1, 3, 5))
    return red, green, blue
