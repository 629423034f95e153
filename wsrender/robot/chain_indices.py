"""Indices of the whole chain for a robot: what joints hold, how fast the tip moves, how far it gives way."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from wsrender.errors import InputError, MissingInertiaError
from wsrender.indices.index_catalogue import find
from wsrender.indices.units import LINEAR_ROWS
from wsrender.pipeline.chain_index import ChainIndex
from wsrender.pipeline.constraints.expression import ExpressionIndex
from wsrender.pipeline.constraints.region import Point
from wsrender.robot.model_robot import Robot
from wsrender.robots.chain import Chain

EFFORTS = "robot.effort_limits, MJCF actuatorfrcrange or forcerange, URDF effort, effort_limit of DH rows"
VELOCITIES = 'robot.velocity_limits, URDF velocity, MJCF <custom><numeric name="velocity_limits">'
OUT_OF_TASK = 1e-9  # share of a direction that may lie outside a task's rows
STILL, POSTURES = 1e-12, 4  # of the reach: what moves less, in this many postures, does not move


@dataclass(frozen=True)
class ChainAsked:
    """What is asked for by name of a robot, with options; it is refused where the robot has not what it takes."""

    name: str
    robot: Robot
    options: Mapping[str, Any]
    rows: tuple[int, ...]
    gravity: Point
    held: Collection[str] = ()
    field: str = "indices"

    @property
    def chain(self) -> Chain:
        """The chain that all of what moves is in."""
        if (chain := self.robot.chain.geometry) is None:
            raise InputError(self.field, f"{self.name} is not available for a robot that is defined by a class")
        return chain.dynamic

    def linear(self) -> tuple[int, ...]:
        """The linear rows of the task."""
        if not (found := tuple(row for row in self.rows if row in LINEAR_ROWS)):
            raise InputError("task", f"must have linear rows for {self.name}, which is of the tip's position")
        return found

    def efforts(self) -> np.ndarray:
        """Limits back and forth (2 n,)."""
        if missing := self.chain.unlimited_efforts:
            told = f"{self.name} needs torque limits, which {self.robot.name} lacks of {', '.join(missing)} ({EFFORTS})"
            raise InputError(self.field, told)
        return np.abs(self.chain.efforts).ravel()

    def speeds(self) -> np.ndarray:
        """Largest speeds (n,)."""
        if missing := self.chain.unlimited_velocities:
            told = f"{self.name} needs speeds, which {self.robot.name} lacks of {', '.join(missing)} ({VELOCITIES})"
            raise InputError(self.field, told)
        return self.chain.velocity_limits

    def weighing(self) -> Chain:
        """The chain with what it weighs."""
        if not self.robot.has_inertia:
            told = f"{self.name} needs link inertias, which the model of {self.robot.name} does not have"
            raise MissingInertiaError(self.field, told)
        return self.chain

    def direction(self, rows: tuple[int, ...]) -> np.ndarray:
        """The unit vector along which it is asked for, in the task's rows; empty for all directions."""
        given = np.array(self.options["direction"])
        if not len(given):
            return given
        if len(given) != 3 or not given.any():
            raise self.refusal("direction", "must have 3 numbers, not all 0, or none")
        given = given / np.abs(given).max()  # whose square neither overflows nor vanishes
        found = self.chain.T_world_base[:3, :3].T @ given / np.linalg.norm(given)
        if np.linalg.norm(np.delete(found, rows)) > OUT_OF_TASK:
            raise self.refusal("direction", "must lie within the task's linear rows, which are in base axes")
        return found[list(rows)] / np.linalg.norm(found[list(rows)])

    def of_joints(self, option: str) -> np.ndarray:
        """The option (n,) that has a number greater than 0 for every joint."""
        given = np.array(self.options[option])
        if len(given) != self.chain.n or not (given > 0).all():
            names = ", ".join(self.chain.joint_names)
            raise self.refusal(option, f"must have {self.chain.n} numbers greater than 0, of {names}")
        return given

    def refusal(self, option: str, why: str) -> InputError:
        """The error of an option, with what was given."""
        given = np.array(self.options[option]).tolist()
        return InputError(f"index_options.{self.name}.{option}", f"{why}, not {given}")


def chain_indices_of(
    robot: Robot,
    options: Mapping[str, Mapping[str, Any]],
    names: Collection[str],
    rows: tuple[int, ...],
    gravity: Point,
    held: Collection[str] = (),
) -> dict[str, ChainIndex | ExpressionIndex]:
    """Those of indices ``names`` that are of the whole chain, at a task's ``rows`` and in gravity (3,) [m/s²].

    ``held``: joints that the job holds at a value. Raises InputError for what the robot lacks.
    """
    return {
        name: _INDICES.get(name, _expressed)(ChainAsked(name, robot, options.get(name, {}), rows, gravity, held))
        for name in names
        if find(name).of_chain
    }


def _expressed(asked: ChainAsked) -> ExpressionIndex:
    """The index of a function of users."""
    index, given = find(asked.name), asked.options
    function = index.expressed
    options = tuple((name, float(given[name])) for name in function.options)
    chain, plain = asked.weighing() if {"g", "M"} & set(function.asks) else asked.chain, asked.robot.chain.geometry
    if "frames" in function.asks and plain is not None and plain.with_branches is not None:
        message = f"{asked.name} takes frames, and joints of {asked.robot.name} follow a joint on another branch"
        raise InputError("indices", message)
    try:
        function.traced(chain.n, len(chain.joint_source))
    except InputError as error:
        message = f"{asked.name} takes a joint that {asked.robot.name}, with {chain.n}, does not have"
        raise InputError("indices", message) from error
    return ExpressionIndex(
        asked.name, function.function, options, asks=function.asks, chain=chain, gravity=asked.gravity
    )


def _joint_limit_margin(asked: ChainAsked) -> ChainIndex:
    chain = asked.chain
    ends = np.stack([chain.lower_limits, chain.upper_limits])
    counts = np.isfinite(ends).all(axis=0) & ~chain.periodic & (ends[0] < ends[1])
    counts &= [name not in asked.held for name in chain.joint_names]
    lower, upper = np.where(counts, ends, 0.0)
    per_range = np.where(counts, 1.0 / np.where(counts, upper - lower, 1.0), 0.0)
    return ChainIndex(asked.name, chain, (), (*lower, *upper, *per_range))


def _torque_margin(asked: ChainAsked) -> ChainIndex:
    chain, acceleration = asked.weighing(), asked.options["acceleration_m_s2"]
    laden = chain.carrying(asked.options["payload_kg"], np.array(asked.options["payload_com_m"]))
    rows = asked.linear() if acceleration else ()
    return ChainIndex(asked.name, chain, (rows,), (*asked.gravity, acceleration, *asked.efforts()), (laden,))


def _payload_capacity(asked: ChainAsked) -> ChainIndex:
    chain, acceleration, com = asked.weighing(), asked.options["acceleration_m_s2"], asked.options["com_m"]
    rows = asked.linear() if acceleration else ()
    if acceleration and (others := [row for row in LINEAR_ROWS if row not in rows]):
        tool = chain.T_tip_tool.copy()
        tool[:3, 3] += tool[:3, :3] @ com
        q = np.random.default_rng(0).uniform(chain.within(0.0), chain.within(1.0), (POSTURES, chain.n))
        if np.abs(chain.placed(np.eye(4), tool).jacobians(q)[:, others]).max() > STILL * max(chain.reach, 1.0):
            raise asked.refusal("acceleration_m_s2", "must be 0 where the mass moves out of the task's linear rows")
    numbers = (*asked.gravity, asked.options["limit_kg"], *com, acceleration, *asked.efforts())
    bare = replace(chain, mass=np.zeros_like(chain.mass)).carrying(1.0, np.array(com))
    return ChainIndex(asked.name, chain, (rows,), numbers, (chain, bare), asked.options["limit_kg"])


def _velocity_radius(asked: ChainAsked) -> ChainIndex:
    chain, rows = asked.chain, asked.linear()
    speeds, along = asked.speeds(), asked.direction(rows)
    return ChainIndex(asked.name, chain, (rows, len(along) > 0), (*speeds, *along))


def _force_radius(asked: ChainAsked) -> ChainIndex:
    chain, rows = asked.weighing(), asked.linear()
    along = asked.direction(rows)
    numbers = (*asked.gravity, asked.options["limit_N"], *asked.efforts(), *along)
    return ChainIndex(asked.name, chain, (rows, len(along) > 0), numbers, (chain,), asked.options["limit_N"])


def _acceleration_radius(asked: ChainAsked) -> ChainIndex:
    chain, rows = asked.weighing(), asked.linear()
    along = asked.direction(rows)
    return ChainIndex(asked.name, chain, (rows, len(along) > 0), (*asked.gravity, *asked.efforts(), *along), (chain,))


def _tip_compliance(asked: ChainAsked) -> ChainIndex:
    weights = 1 / np.sqrt(asked.of_joints("joint_stiffness"))
    return ChainIndex("weighted_norm", asked.chain, (asked.linear(), True), tuple(weights))


def _position_error(asked: ChainAsked) -> ChainIndex:
    return ChainIndex("weighted_norm", asked.chain, (asked.linear(), False), tuple(asked.of_joints("joint_sigma")))


_INDICES: dict[str, Callable[[ChainAsked], ChainIndex]] = {
    "joint_limit_margin": _joint_limit_margin,
    "torque_margin": _torque_margin,
    "payload_capacity": _payload_capacity,
    "velocity_radius": _velocity_radius,
    "force_radius": _force_radius,
    "acceleration_radius": _acceleration_radius,
    "tip_compliance": _tip_compliance,
    "position_error": _position_error,
}
