"""The form of the result documents of the analysis ``kinetostatic_field``."""

from typing import Literal

from wsrender.results.document import (
    Count,
    Rejections,
    ResultDocument,
    ResultPart,
    ResultSamples,
    RobotEntry,
    Share,
    may_lack,
)


class FieldSampling(ResultPart):
    """What was sampled."""

    method: str
    """How."""
    samples: Count
    """How many."""


class FieldLength(ResultPart):
    """The length that makes rows of a Jacobian comparable."""

    length_m: float
    """The length [m]."""
    method: str
    """What gave it."""
    posture: list[float] | None
    """At which configuration [rad or m]."""
    condition_number: float | None
    """The condition number there."""


class Passivity(ResultPart):
    """Whether a device renders the field without giving energy."""

    stiffness_bound_n_per_m: float
    """Stiffness that it renders passively [N/m]."""
    largest_stiffness_n_per_m: float
    """Largest of the field at random postures [N/m]."""
    share_of_postures_within_bound: Share
    """Share of these below the bound."""
    largest_loop_work_j: float
    """Most work on a closed path [J]."""
    loop_work_bound_j: float
    """What that can be by the error of integration [J]."""
    share_of_loops_clipped: Share
    """Share of the paths on which a force is clipped."""
    conservative: str
    """Where the field is conservative, in words."""
    loop_length_m: float
    """Length of a path [m]."""
    loops: Count
    """Paths that were tried."""
    damping_that_dissipates_it_n_s_per_m: float
    """Damping that dissipates that work [N s/m]."""
    at_speed_m_per_s: float
    """At which speed [m/s]."""


class FieldEntry(ResultPart):
    """The force field."""

    form: str
    """Its form."""
    characteristic_length: FieldLength
    """The length in it."""
    voxels: Count
    """Voxels that are reached."""
    share_of_voxels_with_force: Share
    """Share of them in which a force acts."""
    largest_force_n: float
    """Largest force [N]."""
    mean_force_n: float
    """Mean force [N]."""
    passivity: Passivity
    """Whether a device renders it."""


class KinetostaticFieldResult(ResultDocument):
    """The force field of a robot's limits and conditioning."""

    analysis: Literal["kinetostatic_field"]
    """Name of the analysis."""
    robot: RobotEntry
    """The robot."""
    sampling: FieldSampling
    """What was sampled."""
    samples: ResultSamples = may_lack()
    """Under constraints: what they admit."""
    rejections: Rejections = may_lack()
    """Under constraints: what they reject."""
    voxel_size_m: float
    """Edge of a voxel [m]."""
    kinetostatic_field: FieldEntry
    """The field."""
