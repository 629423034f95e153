"""Constraints of a robot: from the words of a job document to the pipeline's, and what results say of them."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from wsrender.documents.constraints import Constraints
from wsrender.documents.environment import Environment
from wsrender.errors import InputError
from wsrender.pipeline.constraints.constraint import Constraint, Expressed, in_order
from wsrender.pipeline.constraints.region import Region
from wsrender.pipeline.constraints.registry import constraints_of
from wsrender.robot.model_robot import Robot


def constraints_for(
    robot: Robot, choice: Constraints | None, environment: Environment | None = None
) -> tuple[Constraint, ...]:
    """The constraints of a job for its robot, and its environment.

    Raises InputError for one that is unknown, or not for such a robot.
    """
    constraints = constraints_of(choice)
    if environment or (choice and (choice.self_collision or choice.environment)):
        from wsrender.robot.collisions import collision_constraints

        constraints = in_order((*constraints, *collision_constraints(robot, choice, environment)))
    for each in constraints:
        if robot.definition and not isinstance(each, Region):
            raise InputError(f"constraints.{each.name}", "is not available for a robot that is defined by a class")
        if not isinstance(each.device, Expressed):
            continue
        try:
            each.device.traced(robot.chain.n)
        except InputError as error:
            message = f"takes a joint that this robot of {robot.chain.n} does not have"
            raise InputError(f"constraints.{each.name}", message) from error
    return constraints


def samples_entry(constraints: Sequence[Constraint], drawn: int, rejected: np.ndarray) -> dict[str, Any]:
    """The entry ``samples`` of a constrained run: drawn, admitted, and by reason rejected; none of any other."""
    if not constraints:
        return {}
    reasons = {each.name: int(number) for each, number in zip(constraints, rejected, strict=True)}
    return {"samples": {"drawn": drawn, "admitted": drawn - sum(reasons.values()), "rejected": reasons}}


def check_admitted(samples: dict[str, Any]) -> None:
    """Raises InputError where the constraints of a `samples_entry` admit nothing."""
    if samples and not samples["samples"]["admitted"]:
        entry = samples["samples"]
        by = ", ".join(f"{name} {number}" for name, number in entry["rejected"].items() if number)
        raise InputError("constraints", f"admit none of {entry['drawn']} samples (rejected by {by}): widen them")
