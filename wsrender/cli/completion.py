"""What the shell offers where a value is typed: robots, views, indices, samplings and other names."""

from collections.abc import Callable, Iterable
from pathlib import Path

# Of wsrender.results.render.VIEWS, which are slow to import.
VIEWS = ("boundary", "solid", "scatter", "volume", "slice", "isosurface")
STATES = ("queued", "running", "canceling", "succeeded", "failed", "canceled", "timed_out", "expired")
JOB_FILES = (".json", ".xml", ".mjcf", ".urdf")

Completion = Callable[[str], list[str]]


def one_of(*names: str) -> Completion:
    """Those of some names that begin with what is typed."""
    return lambda incomplete: _beginning(incomplete, names)


def job(incomplete: str) -> list[str]:
    """Robots of the library, and files that hold a job or a robot, with the folders on the way."""
    from wsrender.robots import library

    return _beginning(incomplete, library.names()) + _files(incomplete)


def analyses(incomplete: str) -> list[str]:
    """Names of analyses."""
    from wsrender.analyses.registry import job_classes

    return _beginning(incomplete, job_classes())


def sampling(incomplete: str) -> list[str]:
    """Methods of sampling."""
    from wsrender.documents.sampling import METHODS

    return _beginning(incomplete, METHODS)


def indices(incomplete: str) -> list[str]:
    """Sets of indices; or the last index of a list."""
    from wsrender.indices.index_catalogue import catalogue, names_of

    before, comma, last = incomplete.rpartition(",")
    given = before.split(",")
    names = [] if comma else ["kinematic", "dynamic", "all"]
    names += [name for index in catalogue().values() for name in names_of(index) if name not in given]
    return [f"{before}{comma}{name}" for name in _beginning(last, names)]


def _beginning(incomplete: str, names: Iterable[str]) -> list[str]:
    return [name for name in names if name.startswith(incomplete)]


def _files(incomplete: str) -> list[str]:
    typed = Path(incomplete)
    folder, begins = (typed, "") if incomplete.endswith("/") else (typed.parent, typed.name)
    try:
        found = sorted(each for each in folder.iterdir() if each.name.startswith(begins))
    except OSError:
        return []
    folders = [f"{each}/" for each in found if each.is_dir() and not each.name.startswith(".")]
    return folders + [str(each) for each in found if each.suffix.lower() in JOB_FILES]
