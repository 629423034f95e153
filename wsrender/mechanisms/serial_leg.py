"""Legs that are serial chains of any kind: their inverse kinematics is solved numerically, from many starts."""

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from wsrender.documents.arm import dotted
from wsrender.documents.legs import SerialLeg
from wsrender.documents.quantities import quoted
from wsrender.documents.sampling import Sobol
from wsrender.engine import configurations, evaluate_kinematics
from wsrender.errors import InputError
from wsrender.pipeline.pipeline import tip_pipeline
from wsrender.reach import InverseSolver, Solutions
from wsrender.reach.evidence import UNREACHABLE
from wsrender.reach.posture_sets import PostureSolver
from wsrender.reach.reached_set import tolerance_m
from wsrender.reach.starts import towards_limits
from wsrender.reach.targets import reasons_of
from wsrender.robot import Robot, robot_of_spec
from wsrender.robots.kinematics import Kinematics

ANGLE_RAD = 1e-7  # residual that counts as reached
STARTS = 32  # of the search for postures of a leg without a closed form


@dataclass(frozen=True, eq=False)
class LegPostures:
    """Postures of a leg at N poses: configurations ``q`` (N, P, n), those that are ``there`` (N, P) bool.

    ``complete`` (N,) bool: a closed form knows of no other.
    """

    q: np.ndarray
    there: np.ndarray
    complete: np.ndarray

    @classmethod
    def single(cls, q: np.ndarray) -> "LegPostures":
        """One of a pose, of perhaps many."""
        return cls(q[:, None], np.ones((len(q), 1), bool), np.zeros(len(q), bool))

    def at(self, rows: np.ndarray) -> "LegPostures":
        """Of some of the poses alone."""
        return LegPostures(self.q[rows], self.there[rows], self.complete[rows])


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

    def postures(self, poses: np.ndarray, *, device: str = "cpu", threads: int | None = None) -> LegPostures:
        """All that are known of platform poses (N, 4, 4), base frame: from a closed form, or from STARTS starts."""
        solver = _posture_solver(self.chain, self.holds_pose, device, threads)
        if solver.form is None or solver.redundant:
            return self._searched(poses, device, threads)
        found = solver.solve(self.targets(poses))
        number = np.arange(len(found)) - np.searchsorted(found.pose, found.pose)
        q = np.zeros((len(poses), number.max(initial=-1) + 1, self.chain.n))
        there = np.zeros(q.shape[:2], bool)
        q[found.pose, number], there[found.pose, number] = found.configurations, True
        complete = found.complete & ~solver.idle.any()
        complete[found.pose[found.family]] = False
        return LegPostures(q, there, complete)

    def _searched(self, poses: np.ndarray, device: str, threads: int | None) -> LegPostures:
        position, rotation = self._position_and_rotation(poses)
        starts = configurations(tip_pipeline(self.chain, Sobol(STARTS)))
        starts[1::2] = towards_limits(self.chain, starts[1::2])
        rotation = None if rotation is None else np.repeat(rotation, STARTS, axis=0)
        solver = self._solver(device, threads)
        tries = solver.tries(np.tile(starts, (len(poses), 1)), np.repeat(position, STARTS, axis=0), rotation)
        q, there = tries.q.reshape(len(poses), STARTS, -1), tries.reached.reshape(len(poses), STARTS)
        return LegPostures(q, there, np.zeros(len(poses), bool))

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


@lru_cache(maxsize=64)
def _posture_solver(chain: Kinematics, whole_pose: bool, device: str, threads: int | None) -> PostureSolver:
    kind = "pose" if whole_pose else "position"
    return PostureSolver(chain, kind=kind, device=device, threads=threads)


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
