"""Messages of a live stream as types, by the names of `wsrender.documents.kinetostatic_stream`, where units stand."""

from typing import Literal, TypedDict

State = Literal["waiting", "rendering", "clutched", "stale", "invalid_input"]
Scale = Literal["rough", "medium", "fine", "view"]
WarningKind = Literal[
    "joint_limit", "unfelt_joint_limit", "ill_conditioned", "boundary", "obstacle", "not_tracking", "thermal_limit"
]


class StreamWarning(TypedDict):
    """Something that the person should know."""

    kind: WarningKind
    joint: str | None


class CueValues(TypedDict):
    """The cues of a tick."""

    viscosity_n_s_per_m: float
    injected_damping_n_s_per_m: float
    vibration_amplitude_n: float
    vibration_frequency_hz: float
    motion_scale: Scale
    motion_scale_factor: float
    clutch: bool


class Force(TypedDict):
    """What the device shall render until the next one."""

    type: Literal["force"]
    sequence: int | None
    tick: int
    state: State
    force_n: list[float]
    torque_n_m: list[float]
    inverse_condition_number: float | None
    limit_distances: list[float | None]
    boundary_m: float | None
    obstacle_m: float | None
    configuration: list[float]
    position_m: list[float]
    tracking_error_m: float | None
    warnings: list[StreamWarning]
    cues: CueValues
    detail: str | None
    wait_s: float
    latency_s: float
    late_s: float


class Opened(TypedDict):
    """The loop runs."""

    type: Literal["opened"]
    version: Literal[1]
    robot: str
    joint_names: list[str]
    lower_limits: list[float]
    upper_limits: list[float]
    period_s: float
    form: Literal["normalised", "potential"]
    characteristic_length_m: float
    characteristic_length_method: str
    stiffness_bound_n_per_m: float
    enforced_stiffness_n_per_m: float
    largest_loop_work_j: float
    loop_damping_n_s_per_m: float
    scheduling: Literal["fifo", "normal"]


class Statistics(TypedDict):
    """How well the loop has kept its time, over its last minute."""

    type: Literal["statistics", "closed"]
    ticks: int
    missed_ticks: int
    samples: int
    refused: int
    late_s: dict[str, float]
    latency_s: dict[str, float]
    created_energy_j: float
