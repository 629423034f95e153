"""The job ``planar_boundary``: the boundary of an arm that moves in a plane."""

from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal

from pydantic import BeforeValidator, Field

from wsrender.documents.arm import Arm
from wsrender.documents.format import JobDocument, example
from wsrender.documents.options import Device
from wsrender.documents.point_sets import PairsOrFile
from wsrender.documents.quantities import PositiveNumber, integer
from wsrender.documents.sampling import BoundaryBiased, Converge, Sampling

MOST_CELLS = 1_000_000


class PlanarBoundaryJob(Arm, JobDocument):
    """The boundary of the positions that a planar arm reaches: exact, as lines and arcs, and estimated from samples.

    The arm's end effector must stay in a plane: joints turn about its normal or slide within it, or are locked.
    """

    model_config = example(
        analysis="planar_boundary",
        robot={"library": "scara"},
        sampling={"method": "random", "count": 5000, "locked": {"joint4": 0.0}},
        cells=400,
    )

    long_fields: ClassVar[tuple[str, ...]] = ("points_m",)
    constraints_elsewhere: ClassVar[str] = 'boundaries are those of joint limits alone; "workspace" takes them'

    analysis: Literal["planar_boundary"] = "planar_boundary"
    """Name of the analysis."""
    sampling: Sampling = BoundaryBiased(400_000)
    """Samples of the Monte Carlo boundary, N_m in number. Joints locked here are held for the exact boundary too."""
    cells: Annotated[int, Field(ge=1, le=MOST_CELLS), BeforeValidator(integer)] | None = None
    """N_g: number of cells of the grid over the samples; null: 2500, as published, or the most that the samples fill,
    down to 110."""
    line_tolerance_m2: PositiveNumber | None = None
    """TOLL: largest mean squared distance of boundary cells from a line [m²]; null: by the cells' width."""
    arc_tolerance_m4: PositiveNumber | None = None
    """TOLA: largest mean of (r² − R²)² of boundary cells about an arc [m⁴]; null: by the cells' width."""
    points_m: PairsOrFile = ()
    """Points to be found inside or outside, with the nearest point of the boundary: rows of two coordinates in the
    plane [m], x and y of the world for an arm that moves in that plane; or a file of them, {"path": "points.npy"}."""
    device: Device = "auto"
    """Where the samples are evaluated: "auto" (a GPU if there is one), "cpu", "cuda" or "cuda:N"."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if isinstance(self.sampling, Converge):
            yield "sampling", 'must not be "converge": the positions of one sampling are used'
