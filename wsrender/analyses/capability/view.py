"""What the view of a capability map adds: the directions from which each voxel is reached."""

from typing import TYPE_CHECKING

import numpy as np

from wsrender.results.view.additions import Additions, Arrows

if TYPE_CHECKING:
    from wsrender.results.drawing.result_plots import ResultPlots


def view(plot: "ResultPlots") -> Additions:
    """An arrow for each direction of approach that is reached, from the voxel's centre."""
    cells, directions = plot.tables["capability"], plot.tables["directions"]["direction"]
    reached = np.unpackbits(cells["direction_bits"].astype(np.uint8), axis=1, count=len(directions)).astype(bool)
    voxels, which = np.nonzero(reached)
    return Additions(arrows=[Arrows("approach_directions", cells["position"][voxels], directions[which])])
