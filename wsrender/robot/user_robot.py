"""A robot defined by a Python class with its own kinematics (local runs only)."""

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

import numpy as np

from wsrender.documents.robot import DHTable, Transform
from wsrender.errors import InputError, ModelError
from wsrender.notices import Notice
from wsrender.robot.model_robot import Robot, configuration_rows, load_robot
from wsrender.robots import of_mujoco
from wsrender.robots.chain import Chain
from wsrender.robots.host_kinematics import HostKinematics
from wsrender.robots.joint_space import unlimited

HASHED_POSES = 16
TURNING = 1e-6  # rad per unit of a joint: less is rounding of finite differences
STEP = 6e-6  # rad or m: the cube root of float64's epsilon, where central differences err least (about 1e-11)


@runtime_checkable
class UserRobot(Protocol):
    """What a user-defined robot gives; ``jacobian`` and ``inertia_matrix`` may be added, batched alike.

    ``limits``: (n, 2) lower and upper [rad or m]. ``forward_kinematics(q: (N, n)) -> (N, 4, 4)``: poses in
    the base frame, which is the world's unless the robot is `placed`. ``jacobian(q) -> (N, 6, n)``, linear then angular
    rows at the tip in base axes; absent: finite differences, for which poses are taken 6e-6 rad or m beyond the limits
    too. ``inertia_matrix(q) -> (N, n, n)``; absent: no dynamic indices. ``joint_names`` and ``name`` are optional.
    """

    limits: Any

    def forward_kinematics(self, q: np.ndarray) -> np.ndarray:
        """Poses of the end effector, (N, 4, 4)."""
        ...


class HostRobot(Robot):
    """A user-defined robot behind the public interface of a robot; its kinematics run on the host."""

    def __init__(self, user: UserRobot, T_world_base: np.ndarray | None = None):
        self.user = user
        self.spec = self.base = self.tip = None
        limits = _limits(user)
        n = len(limits)
        names = tuple(str(name) for name in getattr(user, "joint_names", None) or (f"joint{i + 1}" for i in range(n)))
        self.name = str(getattr(user, "name", type(user).__name__))
        if len(names) != n:
            raise ModelError("joint_names", f"{len(names)} names for {n} rows of limits")
        if len(set(names)) < n:
            raise ModelError("joint_names", f"{', '.join(names)} are not distinct")
        chain = _kinematics(self.name, names, limits, _Checked(user, limits), hasattr(user, "inertia_matrix"))
        self._chain = chain.placed(T_world_base)

    @property
    def chain(self) -> HostKinematics:
        """Names, kinds and limits of the joints, and the user's kinematics."""
        return self._chain

    @property
    def definition(self) -> str:
        """The class, ``module.Class``."""
        return f"{type(self.user).__module__}.{type(self.user).__qualname__}"

    @property
    def notices(self) -> tuple[Notice, ...]:
        """None: a class that is odd is refused."""
        return ()

    @property
    def model_hash(self) -> str:
        """SHA-256 of the class name, the limits and poses between them: the code itself cannot be hashed."""
        digest = hashlib.sha256(f"{type(self.user).__qualname__}{self._chain.content_hash}".encode())
        digest.update(self._chain.base_pose(_between(self._chain.lower_limits, self._chain.upper_limits)).tobytes())
        return digest.hexdigest()

    def forward_kinematics(self, q: Any, *, precision: str = "float64", device: str = "cpu") -> np.ndarray:
        """Poses of the end effector in the world, (N, 4, 4)."""
        return _finite("forward_kinematics", self._chain.poses(configuration_rows(q, self.chain.n)))

    def jacobian(self, q: Any, *, precision: str = "float64", device: str = "cpu") -> np.ndarray:
        """Jacobians (N, 6, n), the user's or by central differences."""
        return _finite("jacobian", self._chain.jacobians(configuration_rows(q, self.chain.n)))

    def inertia_matrix(
        self, q: Any, *, method: str = "kernel", precision: str = "float64", device: str = "cpu"
    ) -> np.ndarray:
        """Inertia matrices (N, n, n), the user's."""
        rows = configuration_rows(q, self.chain.n)
        if not self.has_inertia:
            raise InputError("inertia_matrix", f"{self.name} does not define inertia_matrix")
        n = self.chain.n
        values = self.user.inertia_matrix(rows)  # type: ignore[attr-defined]
        return _finite("inertia_matrix", _shaped("inertia_matrix", values, (len(rows), n, n)))

    def given_inertia(self, inertia: str) -> Callable[[np.ndarray], np.ndarray]:
        """The user's own. Raises InputError for those of a model."""
        if inertia == "mujoco":
            raise InputError("inertia", f'"mujoco" is not allowed: {self.name} has no model but its own class')
        return self.inertia_matrix

    def placed(self, placement: Transform) -> Robot:
        """The same robot with its base frame, in which the class gives its poses, elsewhere in the world."""
        return HostRobot(self.user, placement.matrix())

    def changed(
        self,
        *,
        limits: Mapping[str, tuple[float, float]] | None = None,
        placement: np.ndarray | None = None,
        tool: np.ndarray | None = None,
    ) -> Robot:
        """The same robot with its base elsewhere; its limits and its tip are those of the class."""
        for field, given in (("limits", limits), ("tool", tool)):
            if given is not None and len(given):
                raise InputError(field, f"must not be given: {self.name} is defined by a Python class, which fixes it")
        return HostRobot(self.user, self._chain.T_world_base if placement is None else placement)

    def skeleton(self, q: Any) -> np.ndarray:
        """Base and tip alone: what lies between is the user's, (N, 2, 3)."""
        tip = self.forward_kinematics(q)[:, :3, 3]
        return np.stack([np.broadcast_to(self._chain.T_world_base[:3, 3], tip.shape), tip], axis=1)


@dataclass(frozen=True, eq=False)
class _Checked:
    """The class's poses and Jacobians, checked: finite numbers of the right shape at least within the limits."""

    user: UserRobot
    limits: np.ndarray

    def pose(self, q: np.ndarray) -> np.ndarray:
        """Poses (N, 4, 4)."""
        poses = _shaped("forward_kinematics", self.user.forward_kinematics(q), (len(q), 4, 4))
        _finite("forward_kinematics", poses[self._within(q)])
        return poses

    def jacobian(self, q: np.ndarray) -> np.ndarray:
        """Jacobians (N, 6, n)."""
        own = getattr(self.user, "jacobian", None)
        J = finite_difference_jacobian(self.pose, q) if own is None else own(q)
        J = _shaped("jacobian", J, (len(q), 6, q.shape[1]))
        _finite("jacobian", J[self._within(q)])
        return J

    def _within(self, q: np.ndarray) -> np.ndarray:
        return np.all((q >= self.limits[:, 0]) & (q <= self.limits[:, 1]), axis=1)


def finite_difference_jacobian(forward_kinematics, q: np.ndarray) -> np.ndarray:
    """Geometric Jacobians (N, 6, n) by central differences of poses (N, 4, 4)."""
    T = forward_kinematics(q)
    J = np.empty((len(q), 6, q.shape[1]))
    for i in range(q.shape[1]):
        step = np.zeros(q.shape[1])
        step[i] = STEP
        derivative = (forward_kinematics(q + step) - forward_kinematics(q - step)) / (2 * STEP)
        W = derivative[:, :3, :3] @ T[:, :3, :3].transpose(0, 2, 1)
        J[:, :3, i] = derivative[:, :3, 3]
        turning = [W[:, 2, 1] - W[:, 1, 2], W[:, 0, 2] - W[:, 2, 0], W[:, 1, 0] - W[:, 0, 1]]
        J[:, 3:, i] = np.stack(turning, axis=1) / 2
    return J


def as_robot(robot: Any) -> Robot:
    """A Robot as it is; a user-defined robot (see `UserRobot`) wrapped; what `load_robot` takes, loaded.

    Raises InputError for anything else, ModelError as `load_robot` does.
    """
    if isinstance(robot, Robot):
        return robot
    if isinstance(robot, str | Path | DHTable) or of_mujoco(robot):
        return load_robot(robot)
    if isinstance(robot, type):
        raise InputError("robot", f"{robot.__name__} is a class; give an object of it: {robot.__name__}()")
    if isinstance(robot, UserRobot):
        return HostRobot(robot)
    raise InputError(
        "robot",
        f"{type(robot).__name__} is neither a Robot (see load_robot) nor gives limits and forward_kinematics",
    )


def robot_with_model(robot: Any) -> Robot:
    """The robot, if it has a model; InputError for one that is defined by a Python class."""
    subject = as_robot(robot)
    if subject.definition:
        raise InputError("robot", f"{subject.name} is defined by a Python class; a model or a DH table is needed")
    return subject


def model_chain(robot: Any) -> Chain:
    """The chain of a robot that has a model; InputError as `robot_with_model` raises it."""
    return robot_with_model(robot)._loaded.chain


def _limits(user: UserRobot) -> np.ndarray:
    try:
        limits = np.asarray(user.limits, np.float64)
    except (TypeError, ValueError) as error:
        raise ModelError("limits", f"is not an array of numbers: {error}") from error
    if limits.ndim != 2 or limits.shape[1] != 2 or not len(limits):
        raise ModelError("limits", f"has shape {limits.shape}; (n, 2) is needed: lower and upper limit of each joint")
    if not np.isfinite(limits).all():
        raise ModelError("limits", "has a value that is not finite; every joint needs an interval")
    if (limits[:, 0] > limits[:, 1]).any():
        joint = int(np.argmax(limits[:, 0] > limits[:, 1]))
        raise ModelError("limits", f"of joint {joint} are inverted: {limits[joint].tolist()}")
    return limits


def _between(lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
    """A few configurations (N, n) from all lower to all upper limits."""
    return lower + np.linspace(0.0, 1.0, HASHED_POSES)[:, None] * (upper - lower)


def _shaped(name: str, values: Any, shape: tuple[int, ...]) -> np.ndarray:
    array = np.asarray(values, np.float64)
    if array.shape != shape:
        raise ModelError(name, f"returned shape {array.shape}; {shape} is needed (batched)")
    return array


def _finite(name: str, array: np.ndarray) -> np.ndarray:
    if not np.isfinite(array).all():
        raise ModelError(name, "returned a value that is not finite")
    return array


def _kinematics(
    name: str, joint_names: tuple[str, ...], limits: np.ndarray, checked: _Checked, has_inertia: bool
) -> HostKinematics:
    # A joint that turns nothing is a slide.
    turning = np.abs(checked.jacobian(_between(*limits.T))[:, 3:]).max(axis=(0, 1)) > TURNING
    return HostKinematics(
        name=name,
        base_frame="base",
        tip_frame="tip",
        joint_names=joint_names,
        lower_limits=limits[:, 0],
        upper_limits=limits[:, 1],
        periodic=np.zeros(len(limits), bool),
        efforts=unlimited(len(limits)),
        velocity_limits=np.full(len(limits), np.inf),
        turning=turning,
        has_inertia=has_inertia,
        base_pose=checked.pose,
        base_jacobian=checked.jacobian,
    )
