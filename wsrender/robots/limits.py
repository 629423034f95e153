"""Limits of the coordinates of a chain: what every joint that a coordinate drives allows."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from wsrender.errors import ModelError
from wsrender.notices import Notice
from wsrender.robots.joint_space import unlimited

LARGEST_ANGLE, LARGEST_SLIDE = 1e4, 1e5  # rad, m: beyond them an exporter has written that there is no limit
ANY_EFFORT = np.array([-np.inf, np.inf])
ROUNDING = 1e-6  # share of a leader's range: rounding of a model file's numbers


@dataclass(frozen=True)
class Drive:
    """A joint of the chain: displaced from ``qpos0`` by scale × q[source] + offset [rad or m]."""

    joint: int
    source: int
    scale: float
    offset: float


def joint_name(model: mujoco.MjModel, joint: int) -> str:
    """Name of a joint, or one made from its number where it has none; unique in the model."""
    if name := model.joint(joint).name:
        return name
    name = f"joint{joint + 1}"
    while mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name) >= 0:
        name += "_"
    return name


def coordinate_limits(
    model: mujoco.MjModel, drives: list[Drive], leaders: list[int], given: Mapping[str, tuple[float, float]], field: str
) -> tuple[np.ndarray, np.ndarray, np.ndarray, tuple[Notice, ...]]:
    """Lower and upper limits [rad or m] and periodicity of the coordinates, (n,) each, and what narrows them.

    ``leaders`` are the joints whose value is the coordinate; ``drives`` has them and all that follow. A coordinate
    is periodic, −π … π, if no joint it drives has limits (or limits beyond 10⁴ rad or 10⁵ m, as some exporters write
    for none) and all of them turn by whole turns; otherwise its interval is what all its joints allow, infinite where
    none has limits. Those ``given`` by name go before. Raises ModelError where an interval is empty.
    """
    lower, upper = np.empty(len(leaders)), np.empty(len(leaders))
    periodic = np.zeros(len(leaders), bool)
    notices = []
    for k, leader in enumerate(leaders):
        driven = [drive for drive in drives if drive.source == k]
        name = joint_name(model, leader)
        if name in given:
            lower[k], upper[k] = given[name]
            continue
        interval = _intersection(model, driven)
        if interval is None:
            periodic[k] = all(_whole_turns(model, drive) for drive in driven)
            interval = (-np.pi, np.pi) if periodic[k] else (-np.inf, np.inf)
        lower[k], upper[k] = interval
        limiting = _Limiting.of(model, leader, driven)
        if not lower[k] < upper[k]:
            raise ModelError(
                field,
                f"joint {name!r}: its limits and those of its followers leave {lower[k]:g} … {upper[k]:g}; "
                f"a finite interval is needed{limiting.told}",
            )
        if limiting.followers:
            notices.append(limiting.notice(name, lower[k], upper[k]))
    return lower, upper, periodic, tuple(notices)


@dataclass(frozen=True)
class _Limiting:
    """The limits of a leader itself, None where it has none, and by follower those that are narrower."""

    own: tuple[float, float] | None
    followers: dict[str, tuple[float, float]]  # as the leader's values

    @classmethod
    def of(cls, model: mujoco.MjModel, leader: int, driven: list[Drive]) -> "_Limiting":
        own = _intersection(model, [drive for drive in driven if drive.joint == leader])
        low, high = own or (-np.inf, np.inf)
        slack = ROUNDING * (high - low) if own else 0.0
        found = {joint_name(model, d.joint): _intersection(model, [d]) for d in driven if d.joint != leader}
        narrower = {n: i for n, i in found.items() if i and (i[0] > low + slack or i[1] < high - slack)}
        return cls(own, narrower)

    @property
    def told(self) -> str:
        """The limits that followers set, as the end of a sentence; empty for none."""
        said = [f"{name!r} allows it {low:g} … {high:g}" for name, (low, high) in self.followers.items()]
        own = "it has none of its own" if self.own is None else f"its own are {self.own[0]:g} … {self.own[1]:g}"
        return f": {own}, but {' and '.join(said)}" if said else ""

    def notice(self, name: str, low: float, high: float) -> Notice:
        """That followers leave the leader ``name`` less than its own limits."""
        return Notice(
            "follower_limits",
            f"the limits of joint {name!r} are {low:g} … {high:g}{self.told}",
            "widen the limits of the followers if they are not meant",
            "robot",
        )


def effort_limits(model: mujoco.MjModel, drives: list[Drive], n: int, given: Mapping[str, float]) -> np.ndarray:
    """Least and largest torque or force of n coordinates [N m or N], (2, n): by Cᵀ those of the joints they drive.

    Of the joints that have a limit; infinite where none has. That of a joint is the one ``given`` by name, or the
    smaller of its ``actuatorfrcrange`` and the sum over its actuators of their force limits times gear.
    """
    efforts = np.zeros((2, n))
    limited = np.zeros(n, bool)
    for drive in drives:
        own = _narrower(_joint_effort(model, drive.joint), _actuator_effort(model, drive.joint))
        if (largest := given.get(joint_name(model, drive.joint))) is not None:
            own = np.array([-largest, largest])
        if np.isfinite(own).all():
            limited[drive.source] = True
            efforts[:, drive.source] += np.sort(drive.scale * own)
    return np.where(limited, efforts, unlimited(n))


def velocity_limits(
    model: mujoco.MjModel, drives: list[Drive], n: int, stated: Sequence[float], given: Mapping[str, float]
) -> np.ndarray:
    """Largest speeds of n coordinates [rad/s or m/s], (n,): what all joints that they drive allow; infinite: any.

    ``stated``: by the model's number of a joint, 0 for none; those ``given`` by name go before.
    """
    speeds = np.full(n, np.inf)
    for drive in drives:
        own = given.get(joint_name(model, drive.joint), stated[drive.joint] if stated else 0.0)
        if own > 0.0 and drive.scale:
            speeds[drive.source] = min(speeds[drive.source], own / abs(drive.scale))
    return speeds


def _intersection(model: mujoco.MjModel, driven: list[Drive]) -> tuple[float, float] | None:
    """What the limited joints of ``driven`` allow their coordinate; None if none is limited."""
    ends = []
    for drive in driven:
        if model.jnt_limited[drive.joint] and not _no_limits(model, drive.joint):
            zero = model.qpos0[model.jnt_qposadr[drive.joint]] + drive.offset
            ends.append(sorted((model.jnt_range[drive.joint] - zero) / drive.scale))
    if not ends:
        return None
    return max(low for low, _ in ends), min(high for _, high in ends)


def _no_limits(model: mujoco.MjModel, joint: int) -> bool:
    """Whether a range is a way of writing none: its values would have lost their digits."""
    hinge = model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE
    return bool(np.abs(model.jnt_range[joint]).max() > (LARGEST_ANGLE if hinge else LARGEST_SLIDE))


def _whole_turns(model: mujoco.MjModel, drive: Drive) -> bool:
    return model.jnt_type[drive.joint] == mujoco.mjtJoint.mjJNT_HINGE and drive.scale.is_integer()


def _joint_effort(model: mujoco.MjModel, joint: int) -> np.ndarray:
    return _two_sided(model.jnt_actfrcrange[joint]) if model.jnt_actfrclimited[joint] else ANY_EFFORT


def _actuator_effort(model: mujoco.MjModel, joint: int) -> np.ndarray:
    transmissions = (mujoco.mjtTrn.mjTRN_JOINT, mujoco.mjtTrn.mjTRN_JOINTINPARENT)
    efforts = [
        np.sort(model.actuator_gear[actuator, 0] * _force(model, actuator))
        for actuator in range(model.nu)
        if mujoco.mjtTrn(model.actuator_trntype[actuator]) in transmissions
        and model.actuator_trnid[actuator, 0] == joint
        and model.actuator_gear[actuator, 0]
    ]
    return np.sum(efforts, axis=0) if efforts else ANY_EFFORT


def _force(model: mujoco.MjModel, actuator: int) -> np.ndarray:
    """Force limits (2,) of an actuator before its gear: its range, or for motors what the control range gives."""
    force = ANY_EFFORT
    if model.actuator_forcelimited[actuator]:
        force = _two_sided(model.actuator_forcerange[actuator])
    motor = (
        model.actuator_gaintype[actuator] == mujoco.mjtGain.mjGAIN_FIXED
        and model.actuator_biastype[actuator] == mujoco.mjtBias.mjBIAS_NONE
        and model.actuator_dyntype[actuator] == mujoco.mjtDyn.mjDYN_NONE
    )
    if motor and model.actuator_ctrllimited[actuator]:
        by_control = model.actuator_gainprm[actuator, 0] * model.actuator_ctrlrange[actuator]
        force = _narrower(force, _two_sided(np.sort(by_control)))
    return force


def _narrower(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.array([max(a[0], b[0]), min(a[1], b[1])])


def _two_sided(limits: np.ndarray) -> np.ndarray:
    """The limits in both directions; none where one direction has none at all."""
    return np.array(limits) if limits[0] < 0.0 < limits[1] else ANY_EFFORT
