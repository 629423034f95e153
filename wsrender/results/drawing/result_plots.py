"""The pictures of one result: what ``result.plot`` offers."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from wsrender.errors import InputError
from wsrender.results.drawing.admission import blocked_planes, label_planes
from wsrender.results.drawing.distribution import histogram
from wsrender.results.drawing.faces import Faces, faces_of
from wsrender.results.drawing.faces_of_surface import surface_faces
from wsrender.results.drawing.planes import slice_plane, slices
from wsrender.results.drawing.point_cloud import scatter
from wsrender.results.drawing.stick_figure import robot
from wsrender.results.drawing.style import Heading
from wsrender.results.drawing.table_curves import curves
from wsrender.results.drawing.vector_field import vector_planes
from wsrender.results.drawing.warned import Kind, heading
from wsrender.results.presentation import Picture, all_pictures, picture_of, pictures_of
from wsrender.short_repr import short_repr
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VOXEL_LABELS, VolumeData

if TYPE_CHECKING:
    import trimesh


@dataclass(frozen=True)
class ResultPlots:
    """Pictures of a result, each a matplotlib Figure titled with its robot and sampling.

    Those below, of any result; and by attribute, or by name as in ``plot("targets")``, those of the table of pictures
    (`wsrender.results.presentation`): of the result's analysis, and what packages add.
    """

    document: Mapping[str, Any]
    title: str
    samples: DistributionMap | None
    volume: VolumeData | None
    skeleton: np.ndarray | None
    tables: Mapping[str, Table] = field(default_factory=dict)
    volumes: Mapping[str, VolumeData] = field(default_factory=dict)
    meshes: "Mapping[str, trimesh.Trimesh]" = field(default_factory=dict)
    arms: int = 1  # robots whose skeletons stand one after the other
    seen: Callable[[], list[Faces | None]] | None = None  # finds what is seen of the robot in each row of the skeleton

    __repr__ = short_repr

    @property
    def pictures(self) -> list[Picture]:
        """The rows of the pictures that the result is saved with."""
        rows = pictures_of(self.document).values()
        return [row for row in rows if row.saved and not row.missing(self) and row.where(self)]

    def __call__(self, name: str, *arguments: Any, **options: Any) -> Figure:
        """The picture of a name, with its options.

        Raises InputError for one that there is not, and where the result does not hold what it needs.
        """
        return picture_of(self.document, name).drawn(self, *arguments, **options)

    def __getattr__(self, name: str) -> Any:
        """The picture of a name, as a function of its options."""
        if name.startswith("_") or name not in pictures_of(self.document) | all_pictures():
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")
        return partial(self, name)

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *pictures_of(self.document)})

    @property
    def bodies(self) -> list[Faces | None]:
        """What is seen of the robot in each row of the skeleton; None where that is not known."""
        if self.skeleton is None:
            return []
        return [None] * len(self.skeleton) if self.seen is None else self.seen()

    def heading(self, kind: Kind) -> Heading:
        """The title of a picture of this kind, with the result's warnings that concern it."""
        return heading(self.title, self.document.get("warnings") or (), kind)

    def curves(self, table: str) -> Figure:
        """A table as curves over its first column."""
        return curves(self._table(table), title=self.heading("other"))

    def surface(self, mesh: str | None = None) -> Figure:
        """A mesh of the result (by default the first) from two sides, its faces in their colours where they are known.

        The table ``surfaces`` names them: of a mechanism's workspace each lies on a ball, where a leg is at a limit.
        """
        if not self.meshes or (mesh is not None and mesh not in self.meshes):
            raise InputError("mesh", f"the result has no {mesh!r}; it holds {', '.join(self.meshes) or 'no mesh'}")
        shown = self.meshes[mesh or next(iter(self.meshes))]
        return surface_faces(faces_of(shown, self.tables.get("surfaces")), title=self.heading("surface"))

    def scatter(self, index: str | None = None) -> Figure:
        """Sampled positions in space, coloured by an index (by default the first)."""
        return scatter(self._samples(), index, title=self.heading("samples"))

    def histogram(self, index: str | None = None) -> Figure:
        """Distribution of an index over the samples; of each index by default."""
        return histogram(self._samples(), index, title=self.heading("samples"))

    def slice(
        self,
        *,
        x: float | None = None,
        y: float | None = None,
        z: float | None = None,
        axis: str = "z",
        index: str | None = None,
        statistic: str | None = None,
    ) -> Figure:
        """Voxels cut by the plane at x, y or z [m], or one normal to ``axis``, coloured by a statistic of an index."""
        choice: dict[str, Any] = {"index": index, "statistic": statistic, "title": self.heading("volume")}
        return slice_plane(self._volume(), x=x, y=y, z=z, axis=axis, **choice)

    def slices(
        self,
        at: tuple[float | None, float | None, float | None] = (None, None, None),
        *,
        index: str | None = None,
        statistic: str | None = None,
    ) -> Figure:
        """Planes normal to x, y and z at the coordinates ``at`` [m]; of voxels in a plane that one alone."""
        return slices(self._volume(), at=at, index=index, statistic=statistic, title=self.heading("volume"))

    def admission(self, at: tuple[float | None, float | None, float | None] = (None, None, None)) -> Figure:
        """Planes of the voxels that constraints leave free, and of those that they block, by the reason."""
        return blocked_planes(self.volumes["admission"], at=at, title=self.heading("volume"))

    def labels(self, at: tuple[float | None, float | None, float | None] = (None, None, None)) -> Figure:
        """Planes of the voxels by whether their centres are reached, and under constraints what blocks them."""
        return label_planes(self.volumes[VOXEL_LABELS], at=at, title=self.heading("volume"))

    def share(self, at: tuple[float | None, float | None, float | None] = (None, None, None)) -> Figure:
        """Planes of the share of samples in each voxel that constraints admit."""
        return slices(self.volumes["admission"], at=at, statistic="share", title=self.heading("volume"))

    def vectors(
        self, name: str | None = None, at: tuple[float | None, float | None, float | None] = (None, None, None)
    ) -> Figure:
        """Stream lines of a vector (by default the first) in three planes, normal to x, y and z at ``at`` [m]."""
        return vector_planes(self._volume(), name, at=at, title=self.heading("volume"))

    def robot(self, index: str | None = None) -> Figure:
        """The arm's bodies, or a stick figure, in its workspace, coloured by an index (by default the first).

        Without samples the workspace is drawn as a surface; arms of several robots have a colour and name each.
        """
        if self.skeleton is None:
            raise InputError("skeleton", "the result holds no configurations of the arm to draw")
        surface = None if self.samples is not None else self._workspace()
        names = [str(each.get("name")) for each in self.document.get("robots") or ()]
        both = self.meshes.get("intersection") if self.arms > 1 else None
        shared = None if both is None else faces_of(both, None)
        kept = {"surface": surface, "shared": shared, "arms": self.arms, "names": names, "bodies": self.bodies}
        return robot(self.skeleton, self.samples, index, **kept, title=self.heading("samples"))

    def _workspace(self) -> Faces | None:
        """What the arm is drawn in where there are no samples: a mesh, or the surface of the voxels."""
        if self.meshes:
            return faces_of(next(iter(self.meshes.values())), None)
        volumes = [volume for volume in (self.volume, *self.volumes.values()) if volume is not None]
        if len(volumes) != 1 or not volumes[0].n_occupied:
            return None
        from wsrender.geometry.surfaces import occupied_surface

        return faces_of(occupied_surface(volumes[0]), None)

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
