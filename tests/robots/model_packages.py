"""Model files that others publish, all of them: each loads, or is refused for a reason that is in the table.

The packages are the extra ``test-models``. ``PARTS`` and ``violations`` make it a long measurement: all files,
a quarter in each part.
"""

import re
import sys
import warnings
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

import wsrender as ws
from tests.reference import mujoco_kinematics, urdf_walk
from wsrender.errors import FrameNotFoundError, ModelError
from wsrender.robots import load, xml_source
from wsrender.robots.loaded_robot import LoadedRobot
from wsrender.robots.model_warning import ModelWarning

SUFFIXES = (".urdf", ".xml", ".xacro", ".sdf")
UNSTATED = "refused for no reason of the table:"
MOST_CHOICES = 4  # of base, tip and package, one after the other, before a file counts as refused

# Why a file is refused: the reason in the message, and in words.
REASONS = {
    r"^there is no joint between base": "nothing moves: objects, planes, things that float as a whole",
    r"^there is nothing to move|^the URDF has no <link>": "nothing is there: a part that other files include",
    r"ties .* into a closed loop with the chain": "closed loops, on the chain",
    r"^two models, links, joints or frames are named": "an SDF with two models of one name",
    r"^the root element is <": "no URDF, SDF or MJCF: descriptions of packages, parts that other files include",
    r"is '\$\(": "xacro that was expanded by half",
    r"^xacro refuses .*package://": "xacro that includes an address, where xacro takes names of files",
    r"^xacro refuses .*(is not defined|No such file)": "xacro that names what another package has",
    r"^the package '.*' is neither above the model": "a ROS package that is not there",
    r"^not well-formed XML": "not well-formed XML",
    r"(a finite number is|\d numbers are) needed$": "numbers that cannot be read",
    r"its lower limit .* is above its upper limit": "limits upside down, on the chain",
    r"has type 'spherical'; allowed": "a joint of three freedoms, on the chain",
    r"is a (free|ball) joint on the chain": "a joint of several freedoms on the chain, above links without names",
    r"not found in tendon|unknown element .* in equality": "a part of a model: the rest stands in another file",
    r"global coordinates no longer supported|Schema violation|invalid keyword|required attribute missing": (
        "MJCF that today's MuJoCo does not read"
    ),
    r"plane size\(3\) must be positive": "MJCF that MuJoCo refuses",
}


# Why a file that loads has no shapes: the reason in the message, and in words.
WITHOUT_SHAPES = {
    r"(is|are) not there": "meshes that are not in their package",
    r"encloses no volume|at least 4 enclose a volume|has no triangles": "meshes of no volume",
    r"of no known kind|is of the kind": "shapes of other kinds",
    r"sizes must be positive": "shapes of no size",
    r"cannot be read|is of a format": "meshes that cannot be read",
    r"height field|heights": "height fields",
}
SAME = 1e-12  # of poses [m, 1], by dozens of products in double precision


@dataclass(frozen=True)
class Outcome:
    """What came of a file: ``message`` is empty where it loaded, ``choices`` are the base and tip it took."""

    file: Path
    message: str
    choices: tuple[tuple[str, Any], ...] = ()

    @property
    def reason(self) -> str | None:
        """The reason of the table, "" where the file loaded, None where it was refused for no reason of the table."""
        if not self.message:
            return ""
        return next((said for pattern, said in REASONS.items() if re.search(pattern, self.message)), None)


def folders() -> list[Path]:
    """Where the installed packages have their models."""
    found = []
    for package in ("rtbdata", "pybullet_data", "gymnasium_robotics"):
        if (spec := find_spec(package)) and spec.origin:
            found.append(Path(spec.origin).parent)
    for site in map(Path, sys.path):
        found += [*site.glob("cmeel.prefix/share/example-robot-data/robots")]
    return found


def files() -> list[Path]:
    """Every file that is, or looks like, a model, in an order that depends on names alone."""
    found = [path for folder in folders() for path in folder.rglob("*") if path.suffix in SUFFIXES and path.is_file()]
    return sorted(dict.fromkeys(found), key=lambda path: (path.parts[-3:], path.parts))


def outcome(file: Path) -> Outcome:
    """Loads a file; where a tip or a base must be named, with the first that the error offers.

    A package that is not found is the one that the file lies in.
    """
    choices: dict[str, Any] = {}
    message = ""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        for _ in range(MOST_CHOICES):
            try:
                ws.load_robot(file, **choices)
            except ModelError as error:
                message, chosen = error.message, _chosen(error, file)
                if chosen is None or chosen[0] in choices:
                    break
                choices |= dict([chosen])
            else:
                return Outcome(file, "", tuple(choices.items()))
    return Outcome(file, message, tuple(choices.items()))


def _chosen(error: ModelError, file: Path) -> tuple[str, Any] | None:
    if isinstance(error, FrameNotFoundError):
        return error.field, error.choices[0]
    if absent := re.search(r"^the package '(.+)' is neither above", error.message):
        return "packages", {absent[1]: file.parent.parent}  # some have theirs in a folder of another name
    below = re.search(r"name a base below it, such as '(.+)'$", error.message)
    return ("base", below[1]) if below else None


def fault(found: Outcome) -> str:
    """What is wrong with a robot that loaded: with its kinematics, or with its shapes; empty where nothing is."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        robot = load(found.file, **dict(found.choices))
    chain, rng = robot.chain, np.random.default_rng(5)
    q = rng.uniform(-1.0, 1.0, chain.n)
    T = np.linalg.inv(chain.T_world_base) @ chain.frames(q[None])[0, -1]
    scale = max(1.0, float(np.abs(T).max()))
    if (worst := float(np.abs(T - _expected(robot, found, q)).max()) / scale) > SAME:
        return f"its tip is off by {worst:.2g}"
    for purpose in ("bodies", "visuals"):
        try:
            _ = getattr(robot, purpose)
        except ModelError as error:
            if not any(re.search(pattern, error.message) for pattern in WITHOUT_SHAPES):
                return f"its {purpose}: {error.message}"
    return ""


def _expected(robot: LoadedRobot, found: Outcome, q: np.ndarray) -> np.ndarray:
    """The tip in the base: of a URDF by a walk of its own, else by MuJoCo's kinematics."""
    chain = robot.chain
    if found.file.suffix == ".urdf":
        root, values = xml_source.parse(found.file.read_bytes()), dict(zip(chain.joint_names, q, strict=True))
        base = dict(found.choices).get("base")
        above = np.eye(4) if base is None else urdf_walk.pose(root, base, values)
        return np.linalg.inv(above) @ urdf_walk.pose(root, chain.tip_frame, values)
    data = mujoco.MjData(robot.model)
    robot.set_configuration(data, q)
    mujoco.mj_kinematics(robot.model, data)
    base, tip = (mujoco_kinematics.pose(robot.model, data, name) for name in (chain.base_frame, chain.tip_frame))
    return np.linalg.inv(base) @ tip


def whole(part: slice = slice(None)) -> Sequence[Outcome]:
    """What came of every file, or of a part of them."""
    return [outcome(file) for file in files()[part]]


def counted(part: slice) -> dict[str, int]:
    """How many files of a part loaded, and were refused for each reason; by name where that is not in the table."""
    found = whole(part)
    found = [each if each.message or not (said := fault(each)) else replace(each, message=said) for each in found]
    named = (
        f"{UNSTATED} {each.file}: {each.message}" if each.reason is None else each.reason or "loaded" for each in found
    )
    return dict(Counter(named).most_common())


def violations(figures: Mapping[str, Mapping[str, int]]) -> list[str]:
    """The files that were refused for no reason of the table."""
    return [said for counts in figures.values() for said in counts if said.startswith(UNSTATED)]


PARTS = {f"{first + 1} of 4": partial(counted, slice(first, None, 4)) for first in range(4)}
