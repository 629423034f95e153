"""What the view of a boundary adds: what its patches are called."""

from typing import TYPE_CHECKING

from wsrender.analyses.boundary_patches.pictures import faces_of_patches
from wsrender.results.view.additions import Additions

if TYPE_CHECKING:
    from wsrender.results.drawing.result_plots import ResultPlots


def view(plot: "ResultPlots") -> Additions:
    """Patches by kind, numbers and what generates them."""
    mesh = plot.meshes.get("patches")
    return Additions() if mesh is None else Additions(faces={"patches": faces_of_patches(mesh, plot.tables["patches"])})
