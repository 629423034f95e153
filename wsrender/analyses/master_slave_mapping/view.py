"""What the view of a mapping adds: both workspaces as voxels, and how one becomes part of the other."""

from typing import TYPE_CHECKING, Any

import numpy as np

from wsrender.results.view.additions import Additions
from wsrender.results.view.manifest import Mapping
from wsrender.volume.volume_data import VolumeData
from wsrender.volume.voxels import Voxels

if TYPE_CHECKING:
    import trimesh

    from wsrender.results.drawing.result_plots import ResultPlots

CELLS = 48  # along the longest edge of a workspace
MASTER, SLAVE = "master", "slave"


def view(plot: "ResultPlots") -> Additions:
    """The master's shape, and the slave's in its own world; nothing where either has none.

    The result has the slave's as it is mapped, S R p + offset.
    """
    if not {MASTER, SLAVE} <= set(plot.meshes):
        return Additions()
    found, turn = plot.document["mapping"], (plot.document["job"] or {}).get("rotation")
    scale, offset, R = np.array(found["scale"], float), np.array(found["offset_m"], float), rotation_of(turn)
    own = plot.meshes[SLAVE].copy()
    own.vertices = ((own.vertices - offset) / scale) @ R
    x, y, z = scale.tolist()
    mapping: Mapping = {
        "master": MASTER,
        "slave": SLAVE,
        "scale": (x, y, z),
        "offset_m": (float(offset[0]), float(offset[1]), float(offset[2])),
        "R": R.ravel().tolist(),
        "volumes": {"master": MASTER, "slave": SLAVE},
    }
    return Additions(mapping=mapping, volumes={MASTER: filled(plot.meshes[MASTER]), SLAVE: filled(own)})


def rotation_of(document: object) -> np.ndarray:
    """The rotation (3, 3) of a job; none is the identity."""
    from wsrender.documents.robot import Transform

    return np.eye(3) if document is None else Transform.model_validate(document).matrix()[:3, :3]


def filled(mesh: "trimesh.Trimesh") -> VolumeData:
    """The voxels of the world lattice in or on a mesh, about 48 along its longest edge."""
    edge = float(mesh.extents.max()) / CELLS
    corners = mesh.vertices / edge - 0.5  # trimesh's cells have their centres at whole numbers
    shifted = mesh.copy()
    shifted.vertices = corners
    solid: Any = shifted.voxelized(1.0)
    places = np.rint(solid.fill().points).astype(np.int64)
    first, voxels = Voxels.at_places(places, np.ones(len(places), np.int64))
    return VolumeData.of_voxels(edge, first, voxels)
