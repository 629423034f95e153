"""The job ``capability``: from which directions the end effector can approach each voxel."""

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from wsrender.documents.arm import Arm
from wsrender.documents.constraints import Constrained
from wsrender.documents.format import JobDocument, example
from wsrender.documents.quantities import AngleTolerance, VoxelSize, integer, is_none, real
from wsrender.documents.targets import Deciding

LARGEST_SET = 10_000


def _whole(value: Any) -> int | None:
    return None if value is None else integer(value)


class CapabilityJob(Deciding, Constrained, Arm, JobDocument):
    """Per voxel, the share of approach directions from which its centre is reached, by inverse kinematics.

    Targets are the centres, with the directions. Where the arm's positions fill no volume, as in a plane, the
    reachable point nearest to the centre stands for it. Under constraints a direction is reached where they admit a
    configuration, and blocked where they reject all.
    """

    model_config = example(
        analysis="capability",
        robot={"library": "ur5e"},
        voxel_size_m=0.3,
        directions=12,
    )

    analysis: Literal["capability"] = "capability"
    """Name of the analysis."""
    voxel_size_m: VoxelSize | None = None
    """Edge of a voxel [m]; null: a twentieth of the cube root of the workspace's convex-hull volume."""
    directions: Annotated[int, Field(ge=1, le=LARGEST_SET), BeforeValidator(integer)] = 100
    """Number of approach directions, spread evenly over the sphere."""
    approach_axis: Literal["x", "y", "z", "-x", "-y", "-z"] = "z"
    """Axis of the tip frame that points along the direction; the turn about it is free."""
    rolls: Annotated[int | None, Field(ge=1, le=64, exclude_if=is_none), BeforeValidator(_whole)] = None
    """In how many turns about every direction, spread evenly, postures are counted, of arms with a closed form; null:
    they are not."""
    dexterous_threshold: Annotated[float, Field(gt=0, le=1), BeforeValidator(real)] = 1.0
    """Least reachability index of the dexterous workspace [1]."""
    angle_tolerance_rad: AngleTolerance = 1e-3
    """Largest angle to a direction that counts as reached [rad]."""
