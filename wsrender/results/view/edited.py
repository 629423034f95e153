"""What is edited before there is a job, as the page sends it."""

from typing import Annotated

from pydantic import BeforeValidator

from wsrender.documents.arm import robot_named
from wsrender.documents.constraints import Constrained
from wsrender.documents.quantities import Name
from wsrender.documents.robot import RobotSpec


class Edited(Constrained):
    """A robot, what stands around it, or both, as they are edited before there is a job, and what constrains it."""

    robot: Annotated[RobotSpec, BeforeValidator(robot_named)] | None = None
    """The robot and where it stands; a string is the name of a library robot."""
    base: Name | None = None
    """Body, link or site at which the chain starts; null: the world."""
    tip: Name | None = None
    """Site, body or link at the end of the chain; null: the site "tool", or else the only end there is."""
