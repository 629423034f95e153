"""The job ``kinetostatic_field``: a force field over the workspace."""

from collections.abc import Iterator
from typing import Literal

from wsrender.documents.arm import Arm
from wsrender.documents.constraints import Constrained
from wsrender.documents.format import JobDocument, example
from wsrender.documents.kinetostatics import ForceFieldChoice
from wsrender.documents.options import Device
from wsrender.documents.quantities import VoxelSize
from wsrender.documents.sampling import BoundaryBiased, Grid, Random, Sampling, Sobol


class KinetostaticFieldJob(Constrained, Arm, JobDocument):
    """The force field of a robot's limits and conditioning over its workspace, as a volume of vectors.

    Under constraints a voxel's forces are those of admitted configurations; the passivity is that of the field itself,
    wherever a person leads it. The obstacles of the field push the tip, and reject nothing unless they stand in the
    ``environment`` too.
    """

    model_config = example(
        analysis="kinetostatic_field",
        robot={"library": "phantom_omni"},
        sampling={"method": "sobol", "count": 4096},
        voxel_size_m=0.05,
    )

    analysis: Literal["kinetostatic_field"] = "kinetostatic_field"
    """Name of the analysis."""
    field: ForceFieldChoice = ForceFieldChoice()
    """Which forces act."""
    sampling: Sampling = Sobol(100_000)
    """Configurations at which the field is evaluated; a voxel holds the mean over those that reach it."""
    voxel_size_m: VoxelSize | None = None
    """Edge of a voxel [m]; null: a twenty-fifth of the cube root of the workspace's convex-hull volume."""
    device: Device = "auto"
    """Where kernels run that find the workspace's boundary: "auto", "cpu", "cuda" or "cuda:N"."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        yield from super().conflicts()
        if not isinstance(self.sampling, Grid | Random | Sobol | BoundaryBiased):
            yield "sampling", 'must not be "converge": the field is evaluated on one sampling'
