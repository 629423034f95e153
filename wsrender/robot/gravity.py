"""Gravity of a job: along -z of the world unless it says otherwise, whatever the robot's model says."""

from collections.abc import Iterator
from typing import Any

from wsrender.indices.index_catalogue import find
from wsrender.notices import Notice
from wsrender.pipeline.constraints.region import Point
from wsrender.pipeline.constraints.registry import constraints_of
from wsrender.robot.model_robot import Robot

GRAVITY: Point = (0.0, 0.0, -9.81)  # m/s², in the world


def gravity_of(job: Any) -> Point:
    """Gravity in the world (3,) [m/s²]."""
    return getattr(job, "gravity_m_s2", None) or GRAVITY


def gravity_notices(job: Any, robot: Robot) -> Iterator[Notice]:
    """That the gravity which a robot's model states is not that of a job which asks for gravity and says none."""
    stated = robot.stated_gravity
    if stated not in (None, GRAVITY) and getattr(job, "gravity_m_s2", None) is None and _asks_for_gravity(job):
        told = (
            f"the model of {robot.name} states a gravity of {list(stated)} m/s²; {list(GRAVITY)} in the world is used"
        )
        yield Notice("gravity", told, "gravity_m_s2 says another", "gravity_m_s2")


def _asks_for_gravity(job: Any) -> bool:
    choice, indices = getattr(job, "constraints", None), getattr(job, "indices", ())
    by_constraints = choice and (choice.torque or any("g" in getattr(c, "asks", ()) for c in constraints_of(choice)))
    by_polytopes = any(kind != "velocity" for kind in getattr(job, "polytopes", ()))
    return (
        bool(by_constraints)
        or by_polytopes
        or any("gravity" in find(name).needs for name in indices if not isinstance(indices, str))
    )
