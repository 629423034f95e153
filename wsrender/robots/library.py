"""The robot library: one folder per robot under ``mjcf/``, with its model and the source of every number.

Mechanisms with closed loops have theirs under ``mjcf/mechanisms/``: they are no serial robots, and their analyses take
their own documents; the models are for simulation, and check the analyses.
"""

import re
import tomllib
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cache
from pathlib import Path
from xml.etree import ElementTree

import wsrender
from wsrender.errors import ModelError

_NAME = re.compile(r"\w+")  # no part of a path


@dataclass(frozen=True)
class LibraryRobot:
    """What the library says of one of its robots.

    The description and the source stand in the model file, all below the path in ``robot.toml`` beside it, so that
    results of a model stay valid when another name of it is added. None: not published, or an arm of a paper.
    """

    name: str
    joints: int
    description: str
    source: str  # where its numbers come from, in one line; the README beside the model has them all
    path: Path
    full_name: str | None = None
    maker: str | None = None
    payload_kg: float | None = None  # that the maker rates the arm for
    reach_m: float | None = None  # as the maker measures it
    closed_form: str | None = None  # see Robot.closed_form
    aliases: tuple[str, ...] = ()  # names that other packages have for it
    second_source: str | None = None  # what its kinematics are compared with
    frames: str | None = None  # which frames of its maker or of ROS "world" and "tool" are


def names() -> list[str]:
    """Names of all robots of the library, sorted."""
    return sorted(path.stem for path in _folder().glob("*/*.xml") if path.stem == path.parent.name)


def canonical(name: str) -> str:
    """The library's own name of a robot that another program calls so (``aliases`` of its robot.toml), or the name."""
    return _aliases(_folder()).get(name, name)


def find(name: str) -> Path:
    """The MJCF file of a library robot by its name or an alias; raises ModelError listing the names otherwise."""
    # A server asks often: the folder of one robot says what the list of all would.
    path = _folder() / str(name) / f"{name}.xml"
    if _NAME.fullmatch(str(name)) and path in path.parent.glob("*.xml"):
        return path
    known, name = names(), canonical(str(name))
    if name in known:
        return _folder() / name / f"{name}.xml"
    close = get_close_matches(str(name).lower().replace("-", "_"), known, n=1, cutoff=0.5)
    hint = f'; did you mean "{close[0]}"?' if close else "."
    if name in {mechanism.name for mechanism in mechanisms()}:
        raise ModelError("library", _for_mechanism(name))
    raise ModelError("library", f'has no robot "{name}"{hint} It has: {", ".join(known)}')


def describe() -> list[LibraryRobot]:
    """Every robot of the library, sorted by name, as its model file describes it."""
    return [_robot(_folder() / name / f"{name}.xml") for name in names()]


def mechanisms() -> list[LibraryRobot]:
    """Every model of a mechanism with closed loops, sorted by name; ``joints`` counts the actuated ones."""
    paths = sorted(_folder().glob("mechanisms/*/*.xml"))
    return [_described(path.stem, path, "actuator/*") for path in paths]


def _robot(path: Path) -> LibraryRobot:
    return _described(path.stem, path, "worldbody//joint")


@cache
def _aliases(folder: Path) -> dict[str, str]:
    """Names of robots by their aliases."""
    robots = [_robot(path) for path in sorted(folder.glob("*/*.xml")) if path.stem == path.parent.name]
    return {alias: robot.name for robot in robots for alias in robot.aliases}


def for_mechanism(path: Path) -> str | None:
    """What to do with a mechanism's file of the library, which is no robot's; None of any other file."""
    if path.parent.parent.name == "mechanisms" and path.resolve() in {each.path.resolve() for each in mechanisms()}:
        return _for_mechanism(path.stem)
    return None


def _for_mechanism(name: str) -> str:
    analysis = f'parallel_workspace, with "mechanism": "{name}"'
    if name == "five_bar":
        analysis = "five_bar, with its lengths base_m, proximal_m and distal_m,"
    return f'"{name}" is a mechanism with closed loops, not a robot: the analysis {analysis} takes it'


def _described(name: str, path: Path, counted: str) -> LibraryRobot:
    model = ElementTree.parse(path).getroot()  # our own file: the parser need not distrust it
    texts = {text.get("name"): text.get("data", "") for text in model.iterfind("custom/text")}
    joints = sum(1 for _ in model.iterfind(counted))
    beside = path.with_name("robot.toml")
    facts = tomllib.loads(beside.read_text(encoding="utf-8")) if beside.is_file() else {}  # mechanisms have none
    facts["aliases"] = tuple(facts.get("aliases", ()))
    return LibraryRobot(name, joints, texts["description"], texts["source"], path, **facts)


def _folder() -> Path:
    """``mjcf/`` inside the installed package, or beside it in a checkout."""
    package = Path(wsrender.__file__).parent
    installed = package / "mjcf"
    return installed if installed.is_dir() else package.parent / "mjcf"
