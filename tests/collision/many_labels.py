"""Labels of self-collision against MuJoCo's contacts: a million of every library arm, and of models with meshes.

``PARTS`` and ``violations`` make it a long measurement. The models are those of the extra ``test-models``.
"""

import ast
import re
import warnings
from collections.abc import Mapping
from functools import partial
from pathlib import Path

import numpy as np

import wsrender as ws
from tests.collision.robots import collides, drawn, nearest
from tests.collision.test_labels import UNSURE, labels
from tests.robots import model_packages
from wsrender.documents.constraints import Constraints
from wsrender.errors import InputError
from wsrender.pipeline.constraints.collision import CollisionConstraint
from wsrender.robot.constraints import constraints_for
from wsrender.robots.library import names
from wsrender.robots.model_warning import ModelWarning

AT_ONCE = 50_000
# Of example-robot-data, with the tip of those that end in several places.
MODELS: dict[str, str | None] = {
    "panda": "panda_hand_tcp",
    "ur3_gripper": None,
    "ur5_robot": None,
    "ur10_robot": None,
    "hextilt_flying_arm_5": None,
    "xarm7": None,
    "so100": None,
    "z1": None,
    "talos_left_arm": "gripper_left_motor_double_link",
    "ur5_gripper": None,
}


def model(name: str) -> ws.Robot:
    """A robot of `MODELS`."""
    (file, *_) = (each for each in model_packages.files() if each.name == f"{name}.urdf" and _of_data(each))
    tip = MODELS[name]
    return ws.load_robot(file, **({} if tip is None else {"tip": tip}))


def _of_data(file: Path) -> bool:
    return "example-robot-data" in file.parts


def self_collision(robot: ws.Robot) -> CollisionConstraint:
    """The constraint, without the pairs that are refused as always colliding."""
    try:
        (found,) = constraints_for(robot, Constraints(self_collision=True))
    except InputError as error:
        told = re.search(r"exclude = (\[.*\]) lets them", error.message)
        assert told, error.message
        (found,) = constraints_for(robot, Constraints(self_collision={"exclude": ast.literal_eval(told[1])}))
    assert isinstance(found, CollisionConstraint)
    return found


def compared(robot: ws.Robot, count: int, first_seed: int = 0) -> dict[str, float]:
    """How many labels differ where MuJoCo's distance tells which is right, of how many, and the share that collides."""
    constraint, wrong, colliding = self_collision(robot), 0, 0
    for number in range(-(-count // AT_ONCE)):
        q = drawn(robot, min(AT_ONCE, count - number * AT_ONCE), first_seed + number)
        found = labels(robot, q, (constraint,)) > 0
        colliding += int(found.sum())
        differ = np.flatnonzero(found != collides(robot, q, constraint.pairs))
        if len(differ):
            least = nearest(constraint, q[differ])
            wrong += int(((np.abs(least) > UNSURE) & ((least < 0) != found[differ])).sum())
    return {"configurations": count, "colliding": colliding / count, "wrong": wrong}


def of_arm(name: str, seed: int) -> dict[str, float]:
    """A quarter of a million labels of a library arm."""
    return compared(ws.load_robot(name), 250_000, seed)


def of_model(name: str) -> dict[str, float]:
    """Labels of a robot of `MODELS`."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        return compared(model(name), 20_000)


def violations(figures: Mapping[str, Mapping[str, float]]) -> list[str]:
    """The parts with labels that are wrong."""
    return [f"{part}: {each['wrong']} labels are wrong" for part, each in figures.items() if each["wrong"]]


PARTS = {
    f"{name}, {quarter + 1} of 4": partial(of_arm, name, seed)
    for name in names()
    for quarter, seed in enumerate((0, 5, 10, 15))
} | {f"model {name}": partial(of_model, name) for name in MODELS}
