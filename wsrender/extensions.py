"""What other packages add to the tables through entry points, read alike for all of them."""

from collections.abc import Callable
from importlib.metadata import entry_points
from typing import Any

from wsrender.notices import OWN_PACKAGES, Notice, warn

_LEFT_OUT: dict[str, list[str]] = {}  # by group, in words


def load(group: str, add: Callable[[str, Any], None]) -> list[str]:
    """Give ``add`` the name and the object of every entry point of a group; the names of those that it took.

    One that cannot be imported, or of which ``add`` raises anything, is left out with a warning that names it.
    """
    taken, _LEFT_OUT[group] = [], []
    for point in entry_points(group=group):
        try:
            add(point.name, point.load())
        except Exception as error:  # whatever a stranger's module raises
            if point.module.partition(".")[0] in OWN_PACKAGES:
                if isinstance(error, ModuleNotFoundError) and (error.name or "").partition(".")[0] not in OWN_PACKAGES:
                    continue  # of an extra that is not installed
                raise
            package = point.dist.name if point.dist is not None else point.value
            text = f"the entry point {point.name!r} of {group} in the package {package} is left out: {error}"
            _LEFT_OUT[group].append(text)
            warn([Notice("extension_left_out", text, f"repair or uninstall {package}")], UserWarning)
        else:
            taken.append(point.name)
    return taken


def left_out(group: str) -> str:
    """What errors about an unknown name add: the entry points that were left out, which may have had it; or nothing."""
    return "".join(f"; {text}" for text in _LEFT_OUT.get(group, ()))
