"""A robot with the frames between which its chain runs, and every robot of a document."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any

from pydantic import BeforeValidator

from wsrender.documents.document import Document
from wsrender.documents.quantities import Name, is_numeric
from wsrender.documents.robot import SOURCES, RobotSpec

FILED = ("targets", "configurations", "points_m", "joint_angles_rad")  # fields whose lists a file may hold
OF_POINTS = ("left", "right", "master", "slave")  # fields that may be points, in a file too
PYTHON_CLASS = "user_defined"  # says in a result's job of which class a robot is that no document describes
OF_FILES = ("mesh", "convex_mesh", "height_field")  # shapes that a file may say
ArmPath = tuple[str | int, ...]
"""Keys from a job document to an arm in it; empty: the job itself is one."""


def robot_named(value: Any) -> Any:
    """The robot of a document; a string is the name of a library robot."""
    return {"library": value} if isinstance(value, str) else value


class Arm(Document):
    """A robot and the frames between which its chain runs."""

    robot: Annotated[RobotSpec, BeforeValidator(robot_named)]
    """The robot and where it stands; a string is the name of a library robot."""
    base: Name | None = None
    """Body, link or site at which the chain starts; null: the world."""
    tip: Name | None = None
    """Site, body or link at the end of the chain; null: the site "tool", or else the only end there is."""

    @property
    def held_joints(self) -> Mapping[str, float]:
        """Joints that the job holds at a value, by name [rad or m]."""
        return getattr(getattr(self, "sampling", self), "locked", {})

    @property
    def needs_ranges(self) -> bool:
        """Whether every other joint must have limits."""
        return True

    def arms(self) -> "dict[ArmPath, Arm]":
        """Every arm of a job by its path, in the order of its robots; a job of one robot is an arm itself."""
        return {(): self}

    def sweeps(self) -> list[Any]:
        """The arms whose joint spaces a job samples, each as often as it does."""
        return [arm for arm in self.arms().values() if hasattr(arm, "sampling")]


def models_in(document: Any, path: ArmPath = ()) -> Iterator[tuple[ArmPath, dict[str, Any]]]:
    """(path, part) of everything in a canonical document that a model or a file says: robots, scenes, meshes."""
    for at, value in _entries(document, path):
        if isinstance(value, dict) and (
            at[-1] in FILED
            or (at[-1] == "robot" and _is_robot(value))
            or (at[-1] in OF_POINTS and isinstance(value.get("path") or value.get("model"), str))
            or _names_a_file(value)
        ):
            yield at, value


def _entries(document: Any, path: ArmPath) -> Iterator[tuple[ArmPath, Any]]:
    """(path, value) of all that a document holds, an object before what is in it; lists of numbers as wholes."""
    for key, value in document.items() if isinstance(document, dict) else enumerate(document):
        yield (*path, key), value
        if isinstance(value, dict) or (isinstance(value, list) and not is_numeric(value)):
            yield from _entries(value, (*path, key))


def _is_robot(part: dict[str, Any]) -> bool:
    """Whether it is no constraint or index of that name, whose options are numbers."""
    return any(name in part and not isinstance(part[name], int | float) for name in (*SOURCES, PYTHON_CLASS))


def _names_a_file(part: dict[str, Any]) -> bool:
    sources = part.get("path"), part.get("model")
    return part.get("shape") == "scene" or (part.get("shape") in OF_FILES and sources != (None, None))


def local_paths(document: Any, path: ArmPath = ()) -> Iterator[ArmPath]:
    """Where a canonical document names a file of the machine that runs it."""
    return (at for at, value in _entries(document, path) if at[-1] == "path" and isinstance(value, str))


def at_path(document: Any, path: ArmPath) -> Any:
    """What a document holds at a path."""
    for key in path:
        document = document[key]
    return document


def dotted(path: ArmPath, *fields: str) -> str:
    """A path as errors write it, with fields below it: ``robots.0.robot.path``."""
    return ".".join(map(str, (*path, *fields)))
