"""Solids that joints carry, all convex but those between surfaces that stand, and the pairs that must not touch."""

import hashlib
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

Kind = Literal["sphere", "capsule", "cylinder", "ellipsoid", "box", "hull", "half_space", "surface"]
BASE = -1  # "joint" of what stands with the base


@dataclass(frozen=True, eq=False)
class Solid:
    """A solid in the frame of the joint that carries it, convex but of kind "surface".

    ``joint``: its number in the chain, BASE where it stands with the base; ``T`` (4, 4): its frame in that joint's
    after the motion, in the base's frame for BASE; ``size`` (3,) [m] as MuJoCo has it: half extents, or radius and half
    length along z; ``vertices`` (V, 3) [m] of a hull, in its own frame. A half-space is what lies below its z = 0. A
    surface stands with the base: what its triangles ``faces`` (F, 3) enclose, by their winding number.
    """

    name: str
    kind: Kind
    joint: int
    T: np.ndarray
    size: np.ndarray
    vertices: np.ndarray | None = None
    faces: np.ndarray | None = None

    @property
    def points(self) -> np.ndarray:
        """Points (V, 3) [m] in its own frame; with ``radius`` and ``disc`` around them they span the solid.

        Of a surface the corners of a box around it.
        """
        if self.kind == "surface" and self.vertices is not None:
            low, high = self.vertices.min(axis=0), self.vertices.max(axis=0)
            return low + (high - low) * np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
        if self.kind == "hull" and self.vertices is not None:
            return self.vertices
        if self.kind == "box":
            return self.size * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        if self.kind in ("capsule", "cylinder"):
            return np.array([[0, 0, -self.size[1]], [0, 0, self.size[1]]])
        return np.zeros((1, 3))

    @property
    def corners(self) -> np.ndarray:
        """Corners (F, 3, 3) [m] of a surface's triangles, in its own frame."""
        assert self.vertices is not None and self.faces is not None
        return self.vertices[self.faces]

    @property
    def radius(self) -> float:
        """Of the ball around each point [m]."""
        return float(self.size[0]) if self.kind in ("sphere", "capsule") else 0.0

    @property
    def disc(self) -> float:
        """Of the disc across z around each point [m]."""
        return float(self.size[0]) if self.kind == "cylinder" else 0.0

    @cached_property
    def bounding_radius(self) -> float:
        """Of a ball around the origin of its own frame that holds it [m]; infinite of a half-space."""
        if self.kind == "half_space":
            return np.inf
        if self.kind == "ellipsoid":
            return float(max(self.size))
        far = np.hypot(np.linalg.norm(self.points[:, :2], axis=1) + self.disc, self.points[:, 2])
        return float(far.max()) + self.radius

    @property
    def is_round(self) -> bool:
        """Whether it is its own capsule."""
        return self.kind in ("sphere", "capsule")


@dataclass(frozen=True, eq=False)
class Pairs:
    """Pairs of solids that must keep ``margin_m`` [m] apart: (P, 2) numbers of solids, the lower joint first.

    ``reason`` (P,): number of the constraint that the pair belongs to, from 0; pairs stand in the order of reasons.
    ``around`` by constraint: whether its pairs are of solids and what stands around them.
    """

    solids: tuple[Solid, ...]
    pairs: np.ndarray
    reason: np.ndarray
    margin_m: tuple[float, ...]
    around: tuple[bool, ...]

    @classmethod
    def of(cls, solids: tuple[Solid, ...], *groups: tuple[np.ndarray, float, bool]) -> "Pairs":
        """Of every constraint, in order, pairs (P, 2), margin, and whether they are of what stands around."""
        ordered = []
        for pairs, _margin, _around in groups:
            pairs = np.array(pairs, int).reshape(-1, 2)
            joints = np.array([solid.joint for solid in solids])[pairs]
            ordered.append(np.where(joints[:, :1] > joints[:, 1:], pairs[:, ::-1], pairs))
        numbers = [np.full(len(pairs), number) for number, pairs in enumerate(ordered)]
        margins = tuple(float(margin) for _, margin, _ in groups)
        return cls(
            solids,
            np.concatenate([np.zeros((0, 2), int), *ordered]),
            np.concatenate([[], *numbers]).astype(int),
            margins,
            tuple(around for _, _, around in groups),
        )

    def margin(self, pair: int) -> float:
        """How far a pair must stay apart [m]."""
        return self.margin_m[self.reason[pair]]

    def name(self, pair: int) -> str:
        """The two names of a pair."""
        a, b = self.pairs[pair]
        return f"{self.solids[a].name} and {self.solids[b].name}"

    @cached_property
    def digest(self) -> str:
        """Of all that structures are made of."""
        made = hashlib.sha256(repr((self.margin_m, self.around, self.pairs.tolist(), self.reason.tolist())).encode())
        for solid in self.solids:
            made.update(f"{solid.kind} {solid.joint}".encode())
            surface = () if solid.faces is None else (solid.vertices, solid.faces)
            for numbers in (solid.T, solid.size, solid.points, *surface):
                made.update(np.ascontiguousarray(numbers, np.float64).tobytes())
        return made.hexdigest()
