"""The job ``boundary_patches``: the boundary of an arm that moves in space, in patches."""

from typing import Annotated, ClassVar, Literal

from pydantic import BeforeValidator, Field

from wsrender.documents.arm import Arm
from wsrender.documents.format import JobDocument, example
from wsrender.documents.quantities import Name, Number, integer

FEWEST_CELLS, MOST_CELLS = 8, 256


class BoundaryPatchesJob(Arm, JobDocument):
    """The boundary surface of the positions that a spatial arm reaches, segmented in patches, with edges and corners.

    At least three joints must move the end effector's position; others, such as those of a wrist, may follow that do
    not, or are locked. With three, patches are found from the arm's critical sets, and each comes with the joints at
    their limits that generate it. With more, they are fitted to points of the boundary that inverse kinematics finds.
    Each is the plane, sphere, cylinder, cone or torus that it is to within the points' error, or else a free form.
    """

    model_config = example(
        analysis="boundary_patches",
        robot={"library": "spherical"},
        cells=16,
    )

    constraints_elsewhere: ClassVar[str] = 'boundaries are those of joint limits alone; "workspace" takes them'

    analysis: Literal["boundary_patches"] = "boundary_patches"
    """Name of the analysis."""
    locked: dict[Name, Number] = Field(default={})
    """Joints held at a value, by name [rad or m]."""
    cells: Annotated[int, Field(ge=FEWEST_CELLS, le=MOST_CELLS), BeforeValidator(integer)] = 64
    """Cells along the longest edge of the workspace's box, in which patches, edges and corners are looked for: what is
    smaller than a cell is not seen. Surfaces and curves of critical sets are exact whatever their number."""
