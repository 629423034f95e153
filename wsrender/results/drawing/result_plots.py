"""The pictures of one result: what ``result.plot`` offers."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from wsrender.errors import InputError
from wsrender.results.drawing.arm_plane import planar_boundary
from wsrender.results.drawing.comparison import side_by_side
from wsrender.results.drawing.designs import sweep_surface, trade_off
from wsrender.results.drawing.distribution import histogram
from wsrender.results.drawing.faces import Faces, faces_of
from wsrender.results.drawing.faces_of_surface import surface_faces
from wsrender.results.drawing.five_bar import MODE_VOLUMES, aspect_maps, conditioning_maps
from wsrender.results.drawing.master_slave import mapped_points
from wsrender.results.drawing.method_comparison import errors_by_size
from wsrender.results.drawing.orientation_map import orientations
from wsrender.results.drawing.patches import faces_of_patches
from wsrender.results.drawing.planes import slice_plane, slices
from wsrender.results.drawing.point_cloud import scatter
from wsrender.results.drawing.posture import limits_and_ellipsoids
from wsrender.results.drawing.stick_figure import robot
from wsrender.results.drawing.style import Heading
from wsrender.results.drawing.table_curves import curves
from wsrender.results.drawing.targets import labelled_targets
from wsrender.results.drawing.vector_field import vector_planes
from wsrender.results.drawing.warned import Kind, heading
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData

if TYPE_CHECKING:
    import trimesh


@dataclass(frozen=True)
class ResultPlots:
    """Pictures of a result, each a matplotlib Figure titled with its robot and sampling."""

    title: str
    samples: DistributionMap | None
    volume: VolumeData | None
    skeleton: np.ndarray | None
    tables: Mapping[str, Table] = field(default_factory=dict)
    volumes: Mapping[str, VolumeData] = field(default_factory=dict)
    meshes: "Mapping[str, trimesh.Trimesh]" = field(default_factory=dict)
    arms: int = 1  # robots whose skeletons stand one after the other
    warnings: Sequence[Mapping[str, Any]] = ()  # of the result document
    robots: Sequence[str] = ()  # names of several robots

    def curves(self, table: str) -> Figure:
        """A table as curves over its first column."""
        return curves(self._table(table), title=self._heading("other"))

    def mapping(self) -> Figure:
        """A slave's points in its master's workspace: green inside, red outside."""
        if "mapping" not in self.tables:
            raise InputError("table", "the result holds no mapping of a slave to its master")
        return mapped_points(self.tables["mapping"], title=self._heading("samples"))

    def targets(self) -> Figure:
        """The targets of a reachability job by their labels, with the arm at the first that it reaches."""
        return labelled_targets(self._table("targets"), self.skeleton, title=self._heading("other"))

    def orientations(self) -> Figure:
        """Which orientations of a mechanism's platform are reached at a point."""
        if "orientations" not in self.tables:
            raise InputError("table", "the result holds no orientations at a point")
        return orientations(self.tables["orientations"], title=self._heading("other"))

    def conditioning(self, matrix: str = "j", space: str = "cartesian") -> Figure:
        """κ of a five-bar's Jacobian A, B or J ("a", "b", "j") over P ("cartesian") or θ1 and θ2 ("joint")."""
        volumes = {mode: self.volumes[name] for mode, name in MODE_VOLUMES.items() if name in self.volumes}
        return conditioning_maps(volumes, self._five_bar_tables(), matrix, space, title=self._heading("other"))

    def aspects(self) -> Figure:
        """Singularity-free aspects of a five-bar with their areas, one panel for each working mode."""
        return aspect_maps(self._five_bar_tables(), title=self._heading("other"))

    def sweep(self, value: str | None = None) -> Figure:
        """A value of a design sweep over its first two parameters, as a surface and as contours."""
        return sweep_surface(self._table("sweep"), value, title=self._heading("other"))

    def methods(self) -> Figure:
        """Errors of the methods of a comparison against the edge of their voxels or triangles."""
        return errors_by_size(self._table("methods"), title=self._heading("other"))

    def surface(self, mesh: str | None = None) -> Figure:
        """A mesh of the result (by default the first) from two sides, its faces in their colours where they are known.

        The table ``surfaces`` names them: of a mechanism's workspace each lies on a ball, where a leg is at a limit.
        """
        if not self.meshes or (mesh is not None and mesh not in self.meshes):
            raise InputError("mesh", f"the result has no {mesh!r}; it holds {', '.join(self.meshes) or 'no mesh'}")
        shown = self.meshes[mesh or next(iter(self.meshes))]
        return surface_faces(faces_of(shown, self.tables.get("surfaces")), title=self._heading("surface"))

    def trade_off(self, x: str, y: str) -> Figure:
        """Two objectives of a Pareto search against each other."""
        return trade_off(self._table("evaluations"), self._table("pareto"), x, y, title=self._heading("other"))

    def boundary(self) -> Figure:
        """The boundary of a planar arm: samples, Monte Carlo segments and the exact lines and arcs."""
        return planar_boundary(self.tables, title=self._heading("boundary"))

    def patches(self) -> Figure:
        """The boundary of a spatial arm from two sides: patches in their colours, edges and corners."""
        if "patches" not in self.meshes:
            raise InputError("mesh", "the result holds no patches of a boundary")
        return surface_faces(
            faces_of_patches(self.meshes["patches"], self._table("patches")), title=self._heading("surface")
        )

    def side_by_side(self, index: str | None = None, *, statistic: str | None = None) -> Figure:
        """The robots of a comparison in the same planes, with the same axes and one colour scale."""
        if not self.volumes:
            raise InputError("volumes", "the result holds no volumes of several robots")
        robots = {name.removeprefix("robot_"): volume for name, volume in self.volumes.items()}
        return side_by_side(robots, index=index, statistic=statistic, title=self._heading("volume"))

    def scatter(self, index: str | None = None) -> Figure:
        """Sampled positions in space, coloured by an index (by default the first)."""
        return scatter(self._samples(), index, title=self._heading("samples"))

    def histogram(self, index: str | None = None) -> Figure:
        """Distribution of an index over the samples; of each index by default."""
        return histogram(self._samples(), index, title=self._heading("samples"))

    def slice(
        self,
        *,
        x: float | None = None,
        y: float | None = None,
        z: float | None = None,
        index: str | None = None,
        statistic: str | None = None,
    ) -> Figure:
        """Voxels cut by the plane at x, y or z [m], coloured by a statistic of an index."""
        choice: dict[str, Any] = {"index": index, "statistic": statistic, "title": self._heading("volume")}
        return slice_plane(self._volume(), x=x, y=y, z=z, **choice)

    def slices(
        self,
        at: tuple[float | None, float | None, float | None] = (None, None, None),
        *,
        index: str | None = None,
        statistic: str | None = None,
    ) -> Figure:
        """Planes normal to x, y and z at the coordinates ``at`` [m]; of voxels in a plane that one alone."""
        return slices(self._volume(), at=at, index=index, statistic=statistic, title=self._heading("volume"))

    def vectors(
        self, name: str | None = None, at: tuple[float | None, float | None, float | None] = (None, None, None)
    ) -> Figure:
        """Stream lines of a vector (by default the first) in three planes, normal to x, y and z at ``at`` [m]."""
        return vector_planes(self._volume(), name, at=at, title=self._heading("volume"))

    def posture(self) -> Figure:
        """The arm in one posture: links coloured by nearness to joint limits, ellipsoids of velocity and force."""
        if not {"posture", "ellipsoids"} <= set(self.tables):
            raise InputError("table", "the result holds no posture with its ellipsoids")
        return limits_and_ellipsoids(self.tables["posture"], self.tables["ellipsoids"], title=self._heading("other"))

    def robot(self, index: str | None = None) -> Figure:
        """The arm as a stick figure in its workspace, coloured by an index (by default the first).

        Without samples the workspace is drawn as a surface; arms of several robots have a colour and name each.
        """
        if self.skeleton is None:
            raise InputError("skeleton", "the result holds no configurations of the arm to draw")
        surface = None if self.samples is not None else self._workspace()
        kept = {"surface": surface, "arms": self.arms, "names": self.robots}
        return robot(self.skeleton, self.samples, index, **kept, title=self._heading("samples"))

    def _workspace(self) -> Faces | None:
        """What the arm is drawn in where there are no samples: a mesh, or the surface of the voxels."""
        if self.meshes:
            return faces_of(next(iter(self.meshes.values())), None)
        volumes = [volume for volume in (self.volume, *self.volumes.values()) if volume is not None]
        if len(volumes) != 1 or not volumes[0].n_occupied:
            return None
        from wsrender.geometry.surfaces import occupied_surface

        return faces_of(occupied_surface(volumes[0]), None)

    def _heading(self, kind: Kind) -> Heading:
        return heading(self.title, self.warnings, kind)

    def _five_bar_tables(self) -> Mapping[str, Table]:
        if "aspect_outlines" not in self.tables:
            raise InputError("tables", "the result is not one of a five-bar")
        return self.tables

    def _table(self, name: str) -> Table:
        if name not in self.tables:
            raise InputError("table", f"the result has no {name!r}; it holds {', '.join(self.tables) or 'no table'}")
        return self.tables[name]

    def _samples(self) -> DistributionMap:
        if self.samples is None:
            raise InputError("map", "the result holds neither a map nor a sample of it")
        return self.samples

    def _volume(self) -> VolumeData:
        if self.volume is None:
            raise InputError("volume", "the result holds no volume data")
        return self.volume
