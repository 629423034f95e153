"""The form of the result documents of the analysis ``capability``."""

from typing import Literal

from wsrender.results.document import Count, ResultDocument, ResultPart, RobotEntry, Share, may_lack


class CountedPostures(ResultPart):
    """Postures per voxel."""

    poses_of_a_voxel: Count
    """Poses that were asked of each."""
    mean: float
    """Postures of a pose, in the mean."""
    most: Count
    """At most."""


class ResultCapability(ResultPart):
    """From which directions voxels are reached."""

    method: str
    """How that was decided."""
    directions: Count
    """Directions that were asked of each voxel."""
    approach_axis: Literal["x", "y", "z", "-x", "-y", "-z"]
    """Axis of the tip that points along them."""
    evidence: str
    """What that rests on."""
    voxels: Count
    """Voxels that are reached."""
    mean_index: Share
    """Share of the directions, in the mean over these."""
    maximum_index: Share
    """At most."""
    undecided_pairs: Count
    """Pairs of a voxel and a direction that are undecided."""
    reachable_volume_m3: float
    """Volume of the voxels that are reached [m³]."""
    dexterous_threshold: float
    """Share of the directions from which a voxel is dexterous."""
    dexterous_volume_m3: float
    """Volume of dexterous voxels [m³]."""
    blocked_pairs: dict[str, Count] = may_lack()
    """Under constraints: pairs of which they reject all configurations."""
    postures: CountedPostures = may_lack()
    """Where they were counted."""


class CapabilityResult(ResultDocument):
    """From which directions a robot reaches its workspace."""

    analysis: Literal["capability"]
    """Name of the analysis."""
    robot: RobotEntry
    """The robot."""
    voxel_size_m: float
    """Edge of a voxel [m]."""
    capability: ResultCapability
    """What was found."""
