"""Constraints of a robot: from the words of a job document to the pipeline's, and what results say of them."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from wsrender.documents.constraints import Constrained, Constraints, TorqueChoice
from wsrender.documents.environment import Environment
from wsrender.documents.robot import matrix_of
from wsrender.errors import InputError
from wsrender.notices import Notice
from wsrender.pipeline.constraints.constraint import Constraint, Structure, in_order
from wsrender.pipeline.constraints.expression import ExpressionConstraint
from wsrender.pipeline.constraints.region import Point, RegionConstraint
from wsrender.pipeline.constraints.registry import constraints_of
from wsrender.pipeline.constraints.torque import Torque
from wsrender.robot.chain_indices import EFFORTS
from wsrender.robot.gravity import GRAVITY, gravity_of
from wsrender.robot.indices import check_inertias, task_rows
from wsrender.robot.model_robot import Robot
from wsrender.robots.moving_base import MovingBase

LINEAR = (0, 1, 2)  # rows of a task


def constraints_of_job(job: Any, robot: Robot) -> tuple[Constraint, ...]:
    """The constraints of a job of one arm, with its environment and gravity, task and precision if it has any."""
    rows, precision = task_rows(getattr(job, "task", "linear")), getattr(job, "precision", "float64")
    asked = {"gravity": gravity_of(job), "rows": rows, "precision": precision}
    return constraints_for(robot, job.constraints, job.environment, **asked)


def constraints_for(
    robot: Robot,
    choice: Constraints | None,
    environment: Environment | None = None,
    *,
    gravity: Point = GRAVITY,
    rows: tuple[int, ...] = LINEAR,
    precision: str = "float64",
    base: MovingBase | None = None,
) -> tuple[Constraint, ...]:
    """The constraints for a robot, in what stands around it, with a task's ``rows``.

    Those of shapes are for configurations that begin with the coordinates of its ``base``, if one moves.

    Raises InputError for one that is unknown, or not for such a robot.
    """
    constraints = constraints_of(choice)
    if choice and choice.torque:
        constraints = in_order((*constraints, _torque(robot, choice.torque, gravity, rows, precision)))
    if environment or (choice and (choice.self_collision or choice.environment)):
        from wsrender.robot.collisions import collision_constraints

        constraints = in_order((*constraints, *collision_constraints(robot, choice, environment, base)))
    return tuple(_for_robot(each, robot, gravity) for each in constraints)


def _for_robot(each: Constraint, robot: Robot, gravity: Point) -> Constraint:
    """A constraint with what it asks of the robot. Raises InputError where it is not for such a robot."""
    if isinstance(each, RegionConstraint):
        return each
    if (chain := robot.chain.geometry) is None:
        raise InputError(f"constraints.{each.name}", "is not available for a robot that is defined by a class")
    if not isinstance(each, ExpressionConstraint):
        return each
    if not robot.has_inertia and (weighing := [name for name in ("g", "M") if name in each.asks]):
        message = f"takes {weighing[0]}, and the model of {robot.name} lacks masses or inertias"
        raise InputError(f"constraints.{each.name}", message)
    if each.asks:
        if chain.with_branches is not None and "frames" in each.asks:
            message = "takes frames, and joints of this robot follow or lead a joint on another branch"
            raise InputError(f"constraints.{each.name}", message)
        keeps = frozenset[Structure]() if chain.with_branches is not None else each.keeps
        each = replace(each, chain=chain.dynamic, gravity=gravity, keeps=keeps)
    try:
        each.device.traced(chain.n, len(chain.joint_source))
    except InputError as error:
        message = f"takes a joint that this robot of {chain.n} does not have"
        raise InputError(f"constraints.{each.name}", message) from error
    return each


def _torque(robot: Robot, choice: TorqueChoice, gravity: Point, rows: tuple[int, ...], precision: str) -> Torque:
    """Raises InputError for a robot without what it asks for."""
    chain = robot.chain.geometry
    if chain is None:
        raise InputError("constraints.torque", "is not available for a robot that is defined by a class")
    if not robot.has_inertia:
        raise InputError("constraints.torque", f"must not be given: the model of {robot.name} lacks masses or inertias")
    if missing := chain.unlimited_efforts:
        message = f"must not be given: {robot.name} lacks torque limits of {', '.join(missing)} ({EFFORTS})"
        raise InputError("constraints.torque", message)
    linear = tuple(row for row in rows if row in LINEAR)
    if choice.acceleration_m_s2:
        if not linear:
            message = f"must be 0 with a task without linear rows, not {choice.acceleration_m_s2:g}"
            raise InputError("constraints.torque.acceleration_m_s2", message)
        check_inertias(robot, precision)
    inertia = None if choice.payload_inertia_kg_m2 is None else matrix_of(choice.payload_inertia_kg_m2)
    laden = chain.dynamic.carrying(choice.payload_kg, np.array(choice.payload_com_m), inertia)
    return Torque(laden, gravity, choice.acceleration_m_s2, linear if choice.acceleration_m_s2 else ())


def notices_of(robot: Robot, job: Any, path: str) -> tuple[Notice, ...]:
    """What is odd about the robot at ``path`` of a job, and about its shapes where constraints ask for them."""
    if robot.definition or not (isinstance(job, Constrained) and job.asks_for_shapes):
        return tuple(each.within(path) for each in robot.notices)
    bodies = robot.bodies
    found = tuple(each.within(path) for each in (*robot.notices, *bodies.notices))
    if len(bodies.pairs) or not (job.constraints and job.constraints.self_collision):
        return found
    message = f"self_collision keeps nothing apart: no two shapes of {robot.name} may collide"
    remedy = "contype, conaffinity and excludes of its model, and which links are neighbours, say which may"
    return (*found, Notice("no_pairs", message, remedy, "constraints.self_collision"))


def samples_entry(constraints: Sequence[Any], drawn: int, rejected: np.ndarray) -> dict[str, Any]:
    """The entry ``samples`` of a constrained run: drawn, admitted, and by reason rejected; none of any other."""
    if not constraints:
        return {}
    reasons = {each.name: int(number) for each, number in zip(constraints, rejected, strict=True)}
    return {"samples": {"drawn": drawn, "admitted": drawn - sum(reasons.values()), "rejected": reasons}}
