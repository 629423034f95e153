"""Models by the names that collections give them: ``menagerie:universal_robots_ur5e``.

MuJoCo Menagerie and robot_descriptions download a model when it is first asked for, and keep it in their own caches.
"""

import sys
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from importlib import import_module
from pathlib import Path
from typing import Any

from wsrender.errors import MissingExtraError, ModelError
from wsrender.robots.packages import Packages

EXTRA = "models"
_MODELS = (".urdf", ".sdf")
_FIELD = "model"


@dataclass(frozen=True)
class NamedModel:
    """The file of a model, and how it is read where it is a xacro file."""

    path: Path
    xacro: dict[str, str] = field(default_factory=dict)
    packages: dict[str, str | Path] = field(default_factory=dict)


def collection_of(name: str) -> str | None:
    """The collection that a name begins with, None where it begins with none."""
    prefix, colon, _ = name.partition(":")
    return prefix if colon and prefix in _COLLECTIONS else None


def find(name: str) -> NamedModel:
    """The model of a name with its collection, downloaded if it is not here yet.

    Raises MissingExtraError without the collection's package, ModelError for a name that it does not have, with those
    that are close, and for what cannot be downloaded.
    """
    collection, _, rest = name.partition(":")
    return _COLLECTIONS[collection](rest)


def _menagerie(name: str) -> NamedModel:
    """A robot of MuJoCo Menagerie alone, or one of its scenes and variants as ``robot/entry``."""
    menagerie = _imported("mujoco_menagerie", "mujoco-menagerie")
    robot, _, entry = name.partition("/")
    _check(robot, menagerie.names(), "MuJoCo Menagerie")
    model = menagerie.get(robot)
    if entry:
        _check(entry, model.entry_names, f"Menagerie's {robot}")
    try:
        return NamedModel(Path(model.xml(entry or model.default_model)))
    except menagerie.MenagerieError as error:
        raise ModelError(_FIELD, f"MuJoCo Menagerie cannot give {robot!r}: {error}") from error


def _robot_descriptions(name: str) -> NamedModel:
    descriptions = _imported("robot_descriptions._descriptions", "robot_descriptions").DESCRIPTIONS
    _check(name, descriptions, "robot_descriptions")
    try:
        module = import_module(f"robot_descriptions.{name}")  # which downloads
    except Exception as error:  # of git, of the network, of the disk
        raise ModelError(_FIELD, f"robot_descriptions cannot give {name!r}: {' '.join(str(error).split())}") from error
    found = next((path for kind in ("MJCF", "URDF", "XACRO") if (path := getattr(module, f"{kind}_PATH", None))), None)
    if found is None:
        raise ModelError(_FIELD, f"robot_descriptions has neither MJCF nor URDF of {name!r}")
    arguments = getattr(module, "XACRO_ARGS", {}) if found == getattr(module, "XACRO_PATH", None) else {}
    return NamedModel(Path(found), dict(arguments), dict(getattr(module, "XACRO_PACKAGE_PATHS", {})))


def _example_robot_data(name: str) -> NamedModel:
    """A file of the installed package, by its name without an ending, or by its path among the robots."""
    places = [Path(each) / "cmeel.prefix/share/example-robot-data/robots" for each in sys.path]
    folder = next((each for each in places if each.is_dir()), None)
    if folder is None:
        raise MissingExtraError("example-robot-data", "test-models")
    found = {path.relative_to(folder).as_posix(): path for path in sorted(folder.rglob("*")) if path.suffix in _MODELS}
    chosen = [path for path in found.values() if name in (path.stem, path.name)]
    if name in found:
        chosen = [found[name]]
    if len(chosen) > 1:
        paths = ", ".join(path.relative_to(folder).as_posix() for path in chosen)
        raise ModelError(_FIELD, f"example-robot-data has several files {name!r}; give one of: {paths}")
    if not chosen:
        _check(name, [path.stem for path in found.values()], "example-robot-data")
    return NamedModel(chosen[0])


def resolved(source: Any, xacro: Mapping[str, Any] | None, packages: Packages | None) -> tuple[Any, Any, Any]:
    """A source, arguments of xacro and packages; of a name with its collection, its path and how that is read.

    What is given goes before what the collection says. Raises as `find`.
    """
    if not (isinstance(source, str) and collection_of(source)):
        return source, xacro, packages
    named = find(source)
    return named.path, named.xacro | dict(xacro or {}), named.packages | dict(packages or {})


_COLLECTIONS: dict[str, Callable[[str], NamedModel]] = {
    "menagerie": _menagerie,
    "robot_descriptions": _robot_descriptions,
    "example-robot-data": _example_robot_data,
}


def _imported(module: str, package: str) -> Any:
    try:
        return import_module(module)
    except ImportError as error:
        raise MissingExtraError(package, EXTRA) from error


def _check(name: str, names: Collection[str], whose: str) -> None:
    if name in names:
        return
    close = get_close_matches(name.lower(), names, n=3, cutoff=0.5) or [each for each in names if name in each][:3]
    hint = f"did you mean {' or '.join(map(repr, close))}?" if close else f"it has {len(names)}, such as {min(names)!r}"
    raise ModelError(_FIELD, f"{whose} has no {name!r}; {hint}")
