"""The result of a job on a server: as of a local run, its files downloaded when needed, with resume, and verified."""

from collections.abc import Iterable
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from wsrender.client.remote_files import Document, RemoteFiles
from wsrender.results import conversion
from wsrender.results.export.artifacts import named_files, part_file
from wsrender.results.export.formats import check_asked
from wsrender.results.result import Result
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData

if TYPE_CHECKING:
    import trimesh
    import xarray


class RemoteResult(Result):
    """A Result whose map, sample, volumes, tables, meshes and skeleton are downloaded when they are first used.

    They raise ServerConnectionError where the server is gone by then; ``save`` keeps everything. Of voxels,
    ``to_xarray`` downloads what is used.
    """

    def __init__(self, document: Document, files: RemoteFiles):
        self.document = document
        self.files = files

    @cached_property
    def map(self) -> DistributionMap | None:  # type: ignore[override]
        """One row per sample, where it was kept."""
        return self.files.part("map")

    @cached_property
    def sample(self) -> DistributionMap | None:  # type: ignore[override]
        """The fixed subsample that pictures use."""
        return self.files.part("sample")

    @cached_property
    def volume(self) -> VolumeData | None:  # type: ignore[override]
        """Statistics by voxel."""
        return self.files.part("volume")

    @cached_property
    def skeleton(self) -> np.ndarray | None:  # type: ignore[override]
        """World positions [m] of base, joint origins and tip, (K, L+2, 3)."""
        return self.files.part("skeleton")

    @cached_property
    def meshes(self) -> "dict[str, trimesh.Trimesh]":  # type: ignore[override]
        """Meshes by name [m, world frame]; they need the extra [engine]."""
        return self.files.named("meshes")

    @cached_property
    def tables(self) -> dict[str, Table]:  # type: ignore[override]
        """Tables by name."""
        return self.files.named("tables")

    @cached_property
    def volumes(self) -> dict[str, VolumeData]:  # type: ignore[override]
        """Further volumes by name."""
        return self.files.named("volumes")

    def to_xarray(self, name: str | None = None) -> "xarray.Dataset":
        """As `wsrender.Result.to_xarray`; of voxels only what is used is downloaded, each array when it is.

        The file holds layers of constant z together: ``to_xarray()["count"].sel(z=0.3, method="nearest")`` downloads a
        few, a plane of constant x them all. What is read by ranges is not verified by the file's SHA-256; what
        ``volume`` or ``save`` download is. Closing the Dataset closes its file.
        """
        held = self._voxels()
        if not held or (name is not None and name not in held):  # a map of cells, or nothing
            return super().to_xarray(name)
        for package, extra in (("xarray", "data"), ("h5py", "engine")):
            conversion.required(package, extra)
        from wsrender.client.remote_voxels import remote_dataset

        return remote_dataset(self.files.opened(conversion.one_of("volume", held, name)), self.document)

    def _voxels(self) -> dict[str, str]:
        """The files of volumes by name, in the order in which one is taken where none is named."""
        volume = part_file("volume")
        own = {"volume": volume} if volume in self.files.records else {}
        return own | dict(named_files("volumes", self.files.records))

    def save(self, folder: str | Path, formats: Iterable[str] = ()) -> None:
        """Download every file of the result to a folder, as a local run would have written it.

        With ``formats`` all files are written here, which needs the extra [engine]. If
        anything fails, nothing changes. Raises InputError, ServerConnectionError, ServerError.
        """
        formats = check_asked(formats)
        if formats:
            super().save(folder, formats)
        else:
            self.files.run(self.files.saved(folder, self.document))
