"""Messages of the live stream ``/v1/kinetostatic-stream``, version 1, each a JSON text.

The client sends one ``open``, then ``sample`` after ``sample``, ``statistics`` when it likes, and ``close``. The server
answers ``opened``, a ``force`` at the next tick for the newest sample, and at every change of state; ``statistics``,
``closed``, and ``fault`` where it refuses.
"""

from collections.abc import Iterator
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, model_validator

from wsrender.documents.arm import Arm
from wsrender.documents.document import Document
from wsrender.documents.kinetostatics import ForceFieldChoice, JointValues
from wsrender.documents.quantities import PositiveNumber, real, sequence

LARGEST_SAMPLE = 4096  # bytes
LARGEST_COORDINATE = 1e6  # of a sample: squares and rotations of it are finite
Scale = Literal["rough", "medium", "fine", "view"]
State = Literal["waiting", "rendering", "clutched", "stale", "invalid_input"]
Coordinate = Annotated[float, Field(ge=-LARGEST_COORDINATE, le=LARGEST_COORDINATE)]


def _frequencies(value: Any) -> tuple[float, ...]:
    numbers = tuple(real(number) for number in sequence(value))
    if len(numbers) != 2 or not 0 < numbers[0] <= numbers[1] <= 1000:
        raise ValueError("must be [low, high], 0 < low ≤ high ≤ 1000")
    return numbers


class MotionScales(Document):
    """Motion of the tip per motion of the device, by the name that a sample gives; "view" moves no tip."""

    rough: PositiveNumber = 3.0
    """Scale "rough" [1]."""
    medium: PositiveNumber = 1.0
    """Scale "medium" [1]."""
    fine: PositiveNumber = 0.25
    """Scale "fine" [1]."""

    def factor(self, name: Scale) -> float:
        """The factor of a name; 0 for "view"."""
        return 0.0 if name == "view" else float(getattr(self, name))


class Cues(Document):
    """What is felt besides the force."""

    viscosity_n_s_per_m: Annotated[float, Field(ge=0), BeforeValidator(real)] = 0.1
    """Viscosity b at the end of the conditioning ramp [N s/m]; the force −b v rises with the ramp."""
    vibration_n: Annotated[float, Field(ge=0), BeforeValidator(real)] = 0.3
    """Amplitude of the vibration at a limit [N]."""
    vibration_hz: Annotated[tuple[float, float], BeforeValidator(_frequencies)] = (40.0, 160.0)
    """Its frequency at the beginning of a ramp, and at a limit [Hz]."""
    motion_scales: MotionScales = MotionScales()
    """Scales between the device and the tip, for the input "pose"."""


class StreamOpen(Arm):
    """First message: which robot, which forces, what the samples hold."""

    type: Literal["open"] = "open"
    """open."""
    version: Literal[1] = 1
    """Version of the messages."""
    field: ForceFieldChoice = ForceFieldChoice()
    """Which forces act."""
    input: Literal["configuration", "pose"] = "configuration"
    """What samples hold: joint values, or positions (and for a wrench device orientations) of the tip."""
    start: JointValues = None
    """Configuration from which the first pose is solved [rad or m]; null: the middle of every joint's range."""
    cues: Cues = Cues()
    """What is felt besides the force."""
    stale_after_s: Annotated[float, Field(ge=0.005, le=10), BeforeValidator(real)] = 0.05
    """Silence of the client after which the force is zero [s]."""
    rise_s: Annotated[float, Field(ge=0.01, le=10), BeforeValidator(real)] = 0.1
    """Time in which the force rises from zero to the peak after a pause [s]."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        most = self.field.haptic_device.damping_n_s_per_m / 2
        if self.cues.viscosity_n_s_per_m > most:
            yield "cues", f"must have a viscosity of at most half the device's own damping, {most:g} N s/m"
        if self.input == "configuration" and self.start is not None:
            yield "start", 'must be null with the input "configuration"'


class Message(BaseModel):
    """A message of a running stream; NaN and infinities are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True, allow_inf_nan=False)


class Sample(Message):
    """Where the device is."""

    type: Literal["sample"] = "sample"
    """sample."""
    sequence: int = Field(ge=0, lt=2**53)
    """Number by which the answer names the sample."""
    configuration: tuple[Coordinate, ...] | None = None
    """Joint values [rad or m], for the input "configuration"."""
    position_m: tuple[Coordinate, Coordinate, Coordinate] | None = None
    """Position of the device in the world [m], for the input "pose"."""
    quat_wxyz: tuple[Coordinate, Coordinate, Coordinate, Coordinate] | None = None
    """Its orientation, for a wrench device."""
    scale: Scale = "medium"
    """Scale from the device's motion to the tip's."""
    clutch: bool = False
    """Whether the device is let go of the tip: it moves freely and feels nothing."""

    @model_validator(mode="after")
    def _one_place(self) -> "Sample":
        if (self.configuration is None) == (self.position_m is None):
            raise ValueError("must hold either configuration or position_m")
        return self


class Ask(Message):
    """Asks for statistics, or for the end."""

    type: Literal["statistics", "close"]
    """statistics or close."""


class StreamWarning(Message):
    """Something that the person should know."""

    kind: Literal[
        "joint_limit", "unfelt_joint_limit", "ill_conditioned", "boundary", "obstacle", "not_tracking", "thermal_limit"
    ]
    """What is near, or wrong."""
    joint: str | None = None
    """The joint that it is about."""


class CueValues(Message):
    """The cues of a tick; the device makes the vibration itself."""

    viscosity_n_s_per_m: float
    """Viscosity b [N s/m]; its force −b v is part of ``force_n``."""
    injected_damping_n_s_per_m: float
    """Damping that dissipates energy which the loop would otherwise have created [N s/m]; part of ``force_n``."""
    vibration_amplitude_n: float
    """Amplitude [N]."""
    vibration_frequency_hz: float
    """Frequency [Hz]."""
    motion_scale: Scale
    """Scale in force."""
    motion_scale_factor: float
    """Motion of the tip per motion of the device [1]."""
    clutch: bool
    """Whether the device is let go."""


class Force(Message):
    """What the device shall render until the next one."""

    type: Literal["force"] = "force"
    """force."""
    sequence: int | None
    """The newest sample that it answers; null: none has come."""
    tick: int
    """Number of the loop's period."""
    state: State
    """In all states but "rendering" the force is zero."""
    force_n: tuple[float, float, float]
    """Force [N], world axes."""
    torque_n_m: tuple[float, float, float]
    """Torque [N m]; zero for a force device."""
    inverse_condition_number: float | None
    """1/κ of the posture; null before the first sample."""
    limit_distances: tuple[float | None, ...]
    """Distance of every joint to its nearer limit [rad or m]; null: none."""
    boundary_m: float | None
    """Distance to the workspace's boundary [m]; null: not part of the field."""
    obstacle_m: float | None
    """Distance to the nearest obstacle [m]; null: none."""
    configuration: tuple[float, ...]
    """Joint values [rad or m] at which the field was evaluated."""
    position_m: tuple[float, ...]
    """Position of the tip there [m]."""
    tracking_error_m: float | None
    """Distance of the tip to where the device leads it [m]; null for the input "configuration"."""
    warnings: tuple[StreamWarning, ...]
    """Limits that are near, and the like."""
    cues: CueValues
    """What is felt besides the force."""
    detail: str | None
    """What was wrong with the input; null: nothing."""
    wait_s: float
    """From the sample's arrival at the server to its tick [s]."""
    latency_s: float
    """From there until the force was known [s]."""
    late_s: float
    """How late the tick came [s]."""


class Opened(Message):
    """The loop runs."""

    type: Literal["opened"] = "opened"
    """opened."""
    version: Literal[1] = 1
    """Version of the messages."""
    robot: str
    """Name of the robot."""
    joint_names: tuple[str, ...]
    """Its joints, in the order of configurations."""
    lower_limits: tuple[float, ...]
    """Lower joint limits [rad or m]."""
    upper_limits: tuple[float, ...]
    """Upper joint limits [rad or m]."""
    period_s: float
    """Period of the loop [s]."""
    form: Literal["normalised", "potential"]
    """Form of the forces."""
    characteristic_length_m: float
    """Characteristic length [m]."""
    characteristic_length_method: str
    """How it was found."""
    stiffness_bound_n_per_m: float
    """2b/T of the device [N/m]."""
    enforced_stiffness_n_per_m: float
    """The stiffness that the loop renders at most [N/m], with room for its damping."""
    largest_loop_work_j: float
    """Largest net work of the field's force on closed paths that were tried [J]."""
    loop_damping_n_s_per_m: float
    """Damping that dissipates it at 0.1 m/s [N s/m]."""
    scheduling: Literal["fifo", "normal"]
    """How the loop's process is scheduled."""


class Statistics(Message):
    """How well the loop has kept its time, over its last minute."""

    type: Literal["statistics", "closed"]
    """statistics; "closed" at the end."""
    ticks: int
    """Periods so far."""
    missed_ticks: int
    """Periods that were skipped because the process did not run."""
    samples: int
    """Valid samples so far."""
    refused: int
    """Messages that were refused."""
    late_s: dict[str, float]
    """Lateness of ticks [s]: p50, p99, p999, max."""
    latency_s: dict[str, float]
    """From the tick that takes a sample to its force [s]: p50, p99, p999, max."""
    created_energy_j: float
    """Energy that the loop has given beyond what it was given and the device dissipates, at worst [J]."""


class Fault(Message):
    """The stream was refused, or ends."""

    type: Literal["fault"] = "fault"
    """fault."""
    code: str
    """The kind of problem for programs; stable, those of problem documents among them."""
    detail: str
    """What went wrong."""
    errors: tuple[dict[str, str], ...] = ()
    """Every bad field: pointer and detail."""


FROM_CLIENT = (StreamOpen, Sample, Ask)
FROM_SERVER = (Opened, Force, Statistics, Fault)
