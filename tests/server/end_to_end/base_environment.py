"""A virtual environment with the base dependencies only, made without a network."""

import os
import sys
import tomllib
import venv
from importlib.metadata import distribution
from pathlib import Path

from packaging.requirements import Requirement

import wsrender

CHECKOUT = Path(wsrender.__file__).parent.parent
PROJECT = Path(__file__).parents[3] / "pyproject.toml"


def make_base_environment(folder: Path) -> Path:
    """Its interpreter: what pyproject.toml requires without extras is linked from the running environment."""
    venv.create(folder, with_pip=False, symlinks=True)
    version = f"python{sys.version_info.major}.{sys.version_info.minor}"
    packages = folder / "lib" / version / "site-packages"
    for name in _required(tomllib.loads(PROJECT.read_text())["project"]["dependencies"]):
        _link(name, packages)
    (packages / "wsrender").symlink_to(CHECKOUT / "wsrender")
    return folder / "bin" / "python"


def _required(requirements: list[str]) -> set[str]:
    """Names of the distributions that the requirements need, and those that these need."""
    names: set[str] = set()
    pending = [Requirement(text) for text in requirements]
    while pending:
        requirement = pending.pop()
        wanted = requirement.marker is None or any(
            requirement.marker.evaluate({"extra": extra}) for extra in ("", *requirement.extras)
        )
        if wanted and requirement.name not in names:
            names.add(requirement.name)
            pending += [Requirement(text) for text in distribution(requirement.name).requires or []]
    return names


def _link(name: str, packages: Path) -> None:
    found = distribution(name)
    for top in {file.parts[0] for file in found.files or []}:
        source, link = Path(os.fspath(found.locate_file(top))), packages / top
        if top not in ("..", "__pycache__") and source.exists() and not link.exists():
            link.symlink_to(source)
