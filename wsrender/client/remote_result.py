"""The result of a job on a server: the same object as a local run, its files downloaded when needed."""

import shutil
import tempfile
import weakref
from collections.abc import Iterable
from functools import cached_property
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

import numpy as np

from wsrender import export
from wsrender.client.connection import Connection
from wsrender.client.downloads import download
from wsrender.export.artifacts import DOCUMENT, artifact_records, named_data, publish, write_document
from wsrender.export.atomic import staging_folder
from wsrender.result import Result
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData

if TYPE_CHECKING:
    import trimesh


class RemoteFiles:
    """The artifacts of one job; each is downloaded once, to a temporary folder that goes with this object."""

    def __init__(self, connection: Connection, job_id: str, document: dict[str, Any]):
        self._connection = connection
        self._path = f"/v1/jobs/{quote(job_id, safe='')}/artifacts"
        self.records = dict(artifact_records(document))
        self._downloaded: dict[tuple[str, str | None], Path] = {}

    @cached_property
    def _folder(self) -> Path:
        folder = tempfile.mkdtemp(prefix="wsrender-")
        weakref.finalize(self, shutil.rmtree, folder, ignore_errors=True)
        return Path(folder)

    def fetch(self, name: str, target: Path, format: str | None = None) -> Path:
        """Download an artifact to the file ``target``."""
        sha256 = self.records[name].get("sha256") if format is None and name in self.records else None
        return download(self._connection, f"{self._path}/{quote(name)}", target, sha256, format)

    def local(self, name: str, format: str | None = None) -> Path:
        """Path of a downloaded artifact."""
        key = (name, format)
        if key not in self._downloaded:
            target = self._folder / f"{len(self._downloaded)}-{Path(name).name}"
            self._downloaded[key] = self.fetch(name, target, format)
        return self._downloaded[key]

    def read(self, name: str, kind: str, package: str) -> Any:
        """What the artifact holds, read from npz where ``package`` is missing; None where there is no such file."""
        if name not in self.records:
            return None
        if find_spec(package) is None:
            return getattr(export, f"read_{kind}_npz")(self.local(name, "npz"))
        return getattr(export, f"read_{kind}_{name.rpartition('.')[2]}")(self.local(name))


class RemoteResult(Result):
    """A Result whose map, sample, volumes, tables, meshes and skeleton are downloaded when they are first used.

    They raise ServerConnectionError where the server is gone by then; ``save`` keeps everything.
    """

    def __init__(self, document: dict[str, Any], files: RemoteFiles):
        self.document = document
        self._files = files

    @cached_property
    def map(self) -> DistributionMap | None:  # type: ignore[override]
        """One row per sample, where it was kept."""
        return self._files.read("map.parquet", "table", "pyarrow")

    @cached_property
    def sample(self) -> DistributionMap | None:  # type: ignore[override]
        """The fixed subsample that pictures use."""
        return self._files.read("sample.parquet", "table", "pyarrow")

    @cached_property
    def volume(self) -> VolumeData | None:  # type: ignore[override]
        """Statistics by voxel."""
        return self._files.read("volume.vtkhdf", "volume", "h5py")

    @cached_property
    def skeleton(self) -> np.ndarray | None:  # type: ignore[override]
        """World positions [m] of base, joint origins and tip, (K, L+2, 3)."""
        name = "skeleton.npy"
        return export.read_skeleton(self._files.local(name)) if name in self._files.records else None

    @cached_property
    def meshes(self) -> "dict[str, trimesh.Trimesh]":  # type: ignore[override]
        """Meshes by name [m, world frame]; they need the extra [engine]."""
        files = named_data(self._files.records, ".ply")
        return {name: export.read_mesh(self._files.local(file)) for name, file in files.items()}

    @cached_property
    def tables(self) -> dict[str, Table]:  # type: ignore[override]
        """Tables by name."""
        files = named_data(self._files.records, ".parquet")
        return {name: self._files.read(file, "table", "pyarrow") for name, file in files.items()}

    @cached_property
    def volumes(self) -> dict[str, VolumeData]:  # type: ignore[override]
        """Further volumes by name."""
        files = named_data(self._files.records, ".vtkhdf")
        return {name: self._files.read(file, "volume", "h5py") for name, file in files.items()}

    def save(self, folder: str | Path, formats: Iterable[str] = ()) -> None:
        """Download every file of the result to a folder, as a local run would have written it.

        With ``formats`` (npz, csv, mat, stl, svg) all files are written here, which needs the extra [engine]. If
        anything fails, nothing changes. Raises InputError, ServerConnectionError, ServerError.
        """
        formats = tuple(formats)
        if formats:
            super().save(folder, formats)
            return
        with staging_folder(folder) as staging:
            for name in self._files.records:
                self._files.fetch(name, staging / name)
            write_document(self.document, staging / DOCUMENT)
            publish(staging, Path(folder).absolute())
