"""The parameters of an analysis's function: the fields of its job, and what stands for some of them in Python."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from tests.python_door.types import default_of, type_of
from wsrender.analyses.registry import job_classes

FIRST = {
    "workspace": ("robot", "sampling", "indices", "task"),
    "indices_at": ("robot", "configurations"),
    "base_placement": ("robot", "points_m", "quats_wxyz"),
    "postures": ("robot", "position_m"),
    "reachability": ("robot", "points_m", "quats_wxyz"),
    "two_arm_placement": ("points_m", "quats_wxyz"),
    "kinetostatic_field": ("robot", "sampling"),
    "planar_boundary": ("robot", "sampling"),
    "shared_workspace": ("robots", "sampling"),
    "robot_comparison": ("robots", "sampling"),
}
"""Parameters before the star; of other analyses those without a default."""
WIDER = {"mechanism": "str", "targets": "str", "scale": "float"}
"""What fields take beside their type, by their validators."""


@dataclass(frozen=True)
class Parameter:
    """A parameter as it is written: its type, its default (None: it has none) and what it means."""

    name: str
    type: str
    default: str | None
    text: str


ROBOT = Parameter(
    "robot",
    "RobotLike",
    None,
    "A Robot, what `load_robot` takes, an object with limits and forward_kinematics, or its part of a job document.",
)
CONFIGURATIONS = Parameter(
    "configurations",
    "Sequence[Sequence[float] | np.ndarray] | Sequence[float] | np.ndarray | str | ArrayFile | Mapping[str, Any]",
    None,
    "Rows of joint values [rad or m], (N, n), one per joint from base to tip, or a single one, (n,); or a .npy, "
    "Parquet or CSV file of them, with columns in that order or named as the joints.",
)
ROBOTS = Parameter(
    "robots",
    "Sequence[RobotLike]",
    None,
    "The robots, placed by `load_robot(…, placement=…)`, each as one robot elsewhere, or its part of a job document; "
    "the arms of one model are loaded with other base and tip.",
)
OPTIONAL = {
    name: {"type": f"{each.type} | None", "default": "None", "text": f"{each.text.rstrip('.')}; null: {other} given."}
    for name, each, other in (("robot", ROBOT, "robots are"), ("robots", ROBOTS, "robot is"))
}
"""Of an analysis that takes either."""
EACH_SAMPLING = Parameter(
    "sampling",
    "SamplingLike | Sequence[SamplingLike | None] | None",
    "None",
    "How joint spaces are sampled, one for all robots or a list of one for each; null: 2^20 Sobol samples, of a robot "
    "that is a Python class 2^16.",
)
NAMES = Parameter(
    "names", "Sequence[str | None] | None", "None", "What the result calls the robots; null: as their models."
)
BOTH_SAMPLING = Parameter(
    "sampling", "SamplingLike | None", "None", "How both joint spaces are sampled; null: 20,000 Sobol samples."
)
FIVE_BAR = Parameter("mechanism", "FiveBar", None, "The five-bar, with its lengths and limits.")
RESUME = Parameter(
    "resume", "Result | None", "None", "An earlier result, whose designs are not evaluated again; null: none."
)
PROGRESS = Parameter(
    "progress",
    "Progress | bool | None",
    "None",
    "True shows a bar on work of more than a second; or a function (done, total, message).",
)
THREADS = Parameter(
    "threads", "int | None", "None", "Threads of the CPU; null: all cores. They change no bit of the result."
)
CHUNK_SIZE = Parameter(
    "chunk_size", "int | None", "None", "Samples of a launch; null: by memory. It changes no bit of the result."
)


def fields_of(analysis: str) -> dict[str, Parameter]:
    """The fields of a job as parameters, but for the name of the analysis."""
    fields = {
        name: field
        for name, field in job_classes()[analysis].model_fields.items()
        if name not in ("analysis", "format")
    }
    return {
        name: Parameter(name, _type(name, field.annotation), _default(field), field.description or "")
        for name, field in fields.items()
    }


def _type(name: str, annotation: Any) -> str:
    if name == "sampling":
        return "SamplingLike | None"
    return " | ".join(filter(None, (WIDER.get(name), type_of(annotation))))


def _default(field: Any) -> str | None:
    return None if field.is_required() else default_of(field.default)


def instead_of(analysis: str, fields: Mapping[str, Parameter]) -> dict[str, Parameter]:
    """The fields with what Python takes in their place, and beside them."""
    found = dict(fields)
    one, several = "robot" in found, "robots" in found
    if one:
        found["robot"] = replace(ROBOT, **OPTIONAL["robot"]) if several else ROBOT
    if "configurations" in found:
        found["configurations"] = CONFIGURATIONS
    if several:
        found |= {"robots": replace(ROBOTS, **OPTIONAL["robots"]) if one else ROBOTS, "names": NAMES}
        found |= {} if one else {"sampling": EACH_SAMPLING}
    for name in found.keys() & {"left", "right", "master", "slave"}:
        who = found[name].text.partition(":")[0].rstrip(".")
        text = f"{who}: a Robot, what `load_robot` takes, points (N, 3) [m], or the part of a job document."
        found[name] = replace(found[name], type="SourceLike", text=text)
    if "master" in found:
        found["sampling"] = BOTH_SAMPLING
    if analysis == "five_bar":
        lengths = ("base_m", "proximal_m", "distal_m", "limits_rad")
        found = {"mechanism": FIVE_BAR} | {name: each for name, each in found.items() if name not in lengths}
    if analysis == "design_optimization":
        found["resume"] = RESUME
    return found


def parameters_of(analysis: str) -> Iterator[tuple[bool, Parameter]]:
    """(whether it has a place of its own, parameter) of a function, those first."""
    found = instead_of(analysis, fields_of(analysis))
    first = FIRST.get(analysis, tuple(name for name, each in found.items() if each.default is None))
    yield from ((True, found[name]) for name in first)
    yield from ((False, each) for name, each in found.items() if name not in first)
    yield from ((False, each) for each in (PROGRESS, THREADS, CHUNK_SIZE))
