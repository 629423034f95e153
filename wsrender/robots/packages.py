"""Where ROS packages and Gazebo models lie: what a ``package://`` or ``model://`` address leads to."""

import os
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from xml.etree.ElementTree import Element

from wsrender.errors import ModelError
from wsrender.robots import xml_source

Packages = Mapping[str, str | Path]  # folders of packages by name

MOST_FOLDERS = 20_000  # that are looked through for packages below one of ROS_PACKAGE_PATH
_ROOTS = ("ROS_PACKAGE_PATH", "GAZEBO_MODEL_PATH", "GZ_SIM_RESOURCE_PATH", "SDF_PATH")
_NOT_CRAWLED = ("AMENT_IGNORE", "CATKIN_IGNORE", "COLCON_IGNORE", "rospack_nosubdirs")


def folders_of(package: str, folder: Path, packages: Packages) -> Iterator[Path]:
    """Folders in which a package may lie, the likeliest first; not all of them need be there.

    The folder that ``packages`` names, and then no other; one of its name that is above ``folder`` or stands beside one
    that is; those of ROS_PACKAGE_PATH, by name or by their package.xml at any depth, and of Gazebo's paths; those that
    the ament index of AMENT_PREFIX_PATH knows.
    """
    if package in packages:
        yield Path(packages[package])
        return
    for root in (folder, *folder.parents):
        yield from ([root] if root.name == package else [])
        yield root / package
    for variable in _ROOTS:
        for root in _paths(variable):
            yield from ([root] if root.name == package else [])
            yield root / package
    for root in _paths("ROS_PACKAGE_PATH"):
        yield from (found for found in [_crawled(root).get(package)] if found)
    for prefix in _paths("AMENT_PREFIX_PATH"):
        if (prefix / "share/ament_index/resource_index/packages" / package).is_file():
            yield prefix / "share" / package


def find(package: str, folder: Path, packages: Packages, field: str) -> Path:
    """The folder of a package; raises ModelError, saying how to name it, where it is not there."""
    for found in folders_of(package, folder, packages):
        if found.is_dir():
            return found
    raise ModelError(field, not_found(package))


def not_found(package: str) -> str:
    """What is said of a package that is not there."""
    return (
        f"the package {package!r} is neither above the model nor in ROS_PACKAGE_PATH or AMENT_PREFIX_PATH: "
        f'name its folder by packages={{"{package}": …}}'
    )


def _paths(variable: str) -> list[Path]:
    return [Path(each) for each in os.environ.get(variable, "").split(os.pathsep) if each]


@cache
def _crawled(root: Path) -> dict[str, Path]:
    """Packages at any depth below a folder by the names in their package.xml, as rospack finds them."""
    found: dict[str, Path] = {}
    for count, (at, folders, files) in enumerate(os.walk(root)):
        if count == MOST_FOLDERS:
            break
        if "package.xml" in files:
            folders.clear()  # packages do not nest
            found.setdefault(_name(Path(at)), Path(at))
        elif any(name in files for name in _NOT_CRAWLED):
            folders.clear()
        folders[:] = sorted(name for name in folders if not name.startswith("."))
    return found


def _name(package: Path) -> str:
    try:
        root: Element = xml_source.parse(xml_source.read(package / "package.xml"))
    except ModelError:
        return package.name
    return (root.findtext("name") or "").strip() or package.name
