"""Legs that are serial chains of any kind: their inverse kinematics is solved numerically, from many starts."""

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from wsrender.documents.arm import dotted
from wsrender.documents.legs import SerialLeg
from wsrender.documents.quantities import quoted
from wsrender.engine import evaluate_kinematics
from wsrender.errors import InputError
from wsrender.reach import InverseSolver, Solutions
from wsrender.reach.evidence import UNREACHABLE
from wsrender.reach.reached_set import tolerance_m
from wsrender.reach.targets import reasons_of
from wsrender.robot import Robot, robot_of_spec
from wsrender.robots.kinematics import Kinematics

ANGLE_RAD = 1e-7  # residual that counts as reached


@dataclass(frozen=True, eq=False)
class NumericLeg:
    """A leg, ``number`` in the document, whose ``robot`` stands in the mechanism's base frame, its world.

    The platform holds its tip at ``T_platform_tip`` (4, 4): as a pose, or where ``holds_pose`` is false its position.
    ``actuated`` (n,) bool, by coordinate of the chain.
    """

    number: int
    robot: Robot
    T_platform_tip: np.ndarray
    holds_pose: bool
    actuated: np.ndarray

    @property
    def chain(self) -> Kinematics:
        """The leg's chain, its world the mechanism's base frame."""
        return self.robot.chain

    @property
    def constraints(self) -> int:
        """What a joint at the platform fixes: 3 or 6."""
        return 6 if self.holds_pose else 3

    @property
    def rows(self) -> int:
        """Rows of the leg in A ẋ = B q̇: constraints that passive joints leave."""
        return self.constraints - int(np.count_nonzero(~self.actuated))

    def seen_from(self, T_platform_tool: np.ndarray) -> "NumericLeg":
        """The same leg with the platform's frame moved to a tool that it carries, (4, 4)."""
        return replace(self, T_platform_tip=np.linalg.inv(T_platform_tool) @ self.T_platform_tip)

    def targets(self, poses: np.ndarray) -> np.ndarray:
        """Where platform poses (N, 4, 4) hold the tip, base frame, (N, 4, 4)."""
        return poses @ self.T_platform_tip

    def solve(self, poses: np.ndarray, *, device: str = "cpu", threads: int | None = None) -> Solutions:
        """Configurations and labels of platform poses (N, 4, 4), base frame; they depend on the pose alone."""
        return self._solver(device, threads).solve(*self._position_and_rotation(poses))

    def reason(self, pose: np.ndarray) -> str:
        """Why the leg does not reach a platform pose (4, 4), in words; empty where it does."""
        solver = self._solver("cpu", None)
        position, rotation = self._position_and_rotation(pose[None])
        found = solver.solve(position, rotation)
        (reason,) = reasons_of(solver, found, position, rotation)
        if not reason:
            return ""
        verb = "does not reach" if found.label[0] == UNREACHABLE else "may not reach"
        return f"leg {self.number + 1} (serial) {verb} its place at the platform: {reason}"

    def jacobian(self, q: np.ndarray) -> np.ndarray:
        """Geometric Jacobians (N, 6, n) at the tip, base axes, of configurations (N, n)."""
        return evaluate_kinematics(self.chain, q, device="cpu").jacobian

    def skeleton(self, pose: np.ndarray) -> np.ndarray:
        """Base, joints and tip at a reached platform pose (4, 4), (K, 3) [m], base frame."""
        return self.robot.skeleton(self.solve(pose[None]).q)[0]

    def _position_and_rotation(self, poses: np.ndarray) -> tuple[np.ndarray, np.ndarray | None]:
        T = self.targets(poses)
        return T[:, :3, 3], T[:, :3, :3] if self.holds_pose else None

    def _solver(self, device: str, threads: int | None) -> InverseSolver:
        return _solver(self.chain, self.holds_pose, device, threads)


@lru_cache(maxsize=64)
def _solver(chain: Kinematics, whole_pose: bool, device: str, threads: int | None) -> InverseSolver:
    """The solver of a leg; what it keeps serves all its poses, wherever serial joints carry the mechanism."""
    kind = "pose" if whole_pose else "position"
    return InverseSolver(
        chain, kind=kind, position_m=tolerance_m(chain), angle_rad=ANGLE_RAD, device=device, threads=threads
    )


def numeric_leg(number: int, leg: SerialLeg, robot: Robot | None = None) -> NumericLeg:
    """The leg of a document, at a place among its legs; its robot is loaded unless it is given.

    Raises ModelError and InputError naming the leg.
    """
    path = ("mechanism", "legs", number)
    try:
        loaded = robot or robot_of_spec(leg.robot, leg.base, leg.tip)
    except InputError as error:
        raise error.within(dotted(path)) from None
    names = loaded.chain.joint_names
    if unknown := [name for name in leg.actuated if name not in names]:
        field = dotted(path, "actuated")
        raise InputError(field, f"must name joints of the leg, {quoted(names)}, not {quoted(unknown)}")
    actuated = np.array([name in leg.actuated for name in names])
    return NumericLeg(number, loaded, leg.attachment.matrix(), leg.holds == "pose", actuated)
