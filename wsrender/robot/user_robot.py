"""A robot defined by a Python class with its own kinematics (local runs only)."""

import hashlib
from typing import Any, Protocol, runtime_checkable

import numpy as np

from wsrender.errors import InputError, ModelError
from wsrender.robot.model_robot import Robot, configuration_rows
from wsrender.robots.chain import Chain
from wsrender.spec.robot import Transform

HASHED_POSES = 16
STEP = 6e-6  # rad or m: the cube root of float64's epsilon, where central differences err least (about 1e-11)


@runtime_checkable
class UserRobot(Protocol):
    """What a user-defined robot gives; ``jacobian`` and ``inertia_matrix`` may be added, batched alike.

    ``limits``: (n, 2) lower and upper [rad or m]. ``forward_kinematics(q: (N, n)) -> (N, 4, 4)`` poses in
    the world. ``jacobian(q) -> (N, 6, n)``, linear then angular rows at the tip in world axes; absent: finite
    differences. ``inertia_matrix(q) -> (N, n, n)``; absent: no dynamic indices. ``joint_names`` and ``name``
    are optional.
    """

    limits: Any

    def forward_kinematics(self, q: np.ndarray) -> np.ndarray:
        """Poses of the end effector, (N, 4, 4)."""
        ...


class HostRobot(Robot):
    """A user-defined robot behind the public interface of a robot; its kinematics run on the host."""

    def __init__(self, user: UserRobot):
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
        self._chain = _chain_of_limits(self.name, names, limits, hasattr(user, "inertia_matrix"))

    @property
    def chain(self) -> Chain:
        """Names and limits; its geometry is empty."""
        return self._chain

    @property
    def model_hash(self) -> str:
        """SHA-256 of the class name, the limits and poses between them: the code itself cannot be hashed."""
        digest = hashlib.sha256(f"{type(self.user).__qualname__}{self._chain.content_hash}".encode())
        shares = np.linspace(0.0, 1.0, HASHED_POSES)[:, None]
        q = self.lower_limits + shares * (self.upper_limits - self.lower_limits)
        digest.update(self.forward_kinematics(q).tobytes())
        return digest.hexdigest()

    def forward_kinematics(self, q: Any, *, precision: str = "float64", device: str = "cpu") -> np.ndarray:
        """Poses of the end effector, (N, 4, 4)."""
        rows = configuration_rows(q, self.chain.n)
        return _checked("forward_kinematics", self.user.forward_kinematics(rows), (len(rows), 4, 4))

    def jacobian(self, q: Any, *, precision: str = "float64", device: str = "cpu") -> np.ndarray:
        """Jacobians (N, 6, n), the user's or by central differences."""
        rows = configuration_rows(q, self.chain.n)
        own = getattr(self.user, "jacobian", None)
        if own is not None:
            return _checked("jacobian", own(rows), (len(rows), 6, self.chain.n))
        return finite_difference_jacobian(self.forward_kinematics, rows)

    def inertia_matrix(
        self, q: Any, *, method: str = "kernel", precision: str = "float64", device: str = "cpu"
    ) -> np.ndarray:
        """Inertia matrices (N, n, n), the user's."""
        rows = configuration_rows(q, self.chain.n)
        if not self.has_inertia:
            raise InputError("inertia_matrix", f"{self.name} does not define inertia_matrix")
        n = self.chain.n
        return _checked("inertia_matrix", self.user.inertia_matrix(rows), (len(rows), n, n))  # type: ignore[attr-defined]

    def placed(self, placement: Transform) -> Robot:
        """Raises InputError: where the robot stands is part of the user's own forward kinematics."""
        raise InputError("placement", f"of {self.name} cannot be changed: a user-defined robot stands where it says")

    def position_and_jacobian(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Tip positions (N, 3) and Jacobians (N, 6, n)."""
        return self.forward_kinematics(q)[:, :3, 3], self.jacobian(q)

    def skeleton(self, q: Any) -> np.ndarray:
        """Base and tip alone: what lies between is the user's, (N, 2, 3)."""
        tip = self.forward_kinematics(q)[:, :3, 3]
        return np.stack([np.zeros_like(tip), tip], axis=1)


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
    """A Robot as it is; a user-defined robot (see `UserRobot`) wrapped; InputError for anything else."""
    if isinstance(robot, Robot):
        return robot
    if isinstance(robot, type):
        raise InputError("robot", f"{robot.__name__} is a class; give an object of it: {robot.__name__}()")
    if isinstance(robot, UserRobot):
        return HostRobot(robot)
    raise InputError(
        "robot",
        f"{type(robot).__name__} is neither a Robot (see load_robot) nor gives limits and forward_kinematics",
    )


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


def _checked(name: str, values: Any, shape: tuple[int, ...]) -> np.ndarray:
    array = np.asarray(values, np.float64)
    if array.shape != shape:
        raise ModelError(name, f"returned shape {array.shape}; {shape} is needed (batched)")
    if not np.isfinite(array).all():
        raise ModelError(name, "returned a value that is not finite")
    return array


def _chain_of_limits(name: str, joint_names: tuple[str, ...], limits: np.ndarray, has_inertia: bool) -> Chain:
    n = len(limits)
    return Chain(
        name=name,
        base_frame="world",
        tip_frame="tip",
        joint_names=joint_names,
        lower_limits=limits[:, 0],
        upper_limits=limits[:, 1],
        periodic=np.zeros(n, bool),
        effort_limits=None,
        joint_is_revolute=np.ones(n, bool),
        joint_source=np.arange(n),
        joint_scale=np.ones(n),
        joint_offset=np.zeros(n),
        T_joint=np.tile(np.eye(4), (n, 1, 1)),
        T_tip=np.eye(4),
        mass=np.zeros(n),
        center_of_mass=np.zeros((n, 3)),
        inertia=np.zeros((n, 3, 3)),
        armature=np.zeros(n),
        has_inertia=has_inertia,
    )
