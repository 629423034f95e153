"""How results are shown: the table of pictures, and what an analysis registers of its own results.

Result, summary, report, command line and server read it; none of them names an analysis. Another package adds a picture
through the entry-point group ``wsrender.pictures``, whose entries are `Picture` objects, a program through
``register_picture``.
"""

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import import_module
from inspect import signature
from operator import attrgetter
from typing import Any

from wsrender.errors import InputError, MissingExtraError
from wsrender.extensions import left_out, load
from wsrender.keywords import keywords
from wsrender.short_repr import short_repr

_REGISTRY = "wsrender.analyses.registry:presentations"  # of the layer above, which is read by name alone
EXTENSIONS = "wsrender.pictures"  # entry points, loaded when the table is first read
NAMED = ("tables", "volumes", "meshes")
PARTS = ("samples", "volume", "skeleton", *NAMED)
"""What a result may hold of what pictures show: the fields of `ResultPlots`; of those NAMED several by name."""

Function = str | Callable[..., Any]
"""A function, or ``"module:name"`` of one that is imported when it is needed."""
Document = Mapping[str, Any]
REACHABLE = "reachable"  # what a headline measures unless an analysis says otherwise


def where_measured(document: Document) -> str:
    """``measured`` of an analysis only some of whose results measure a workspace: those whose headline has a value."""
    return "" if (document.get("headline") or {}).get("value") is None else REACHABLE


@keywords
@dataclass(frozen=True)
class Picture:
    """One picture of a result.

    ``draw(plot, **options)`` returns a matplotlib Figure: ``plot`` is the result's `ResultPlots`, ``options`` are those
    given here. A result has the picture if it holds what the picture ``needs``, of ``PARTS`` or a named one such as
    ``"tables.scan"``, is of one of the ``analyses`` (none: of any), and ``where(plot)`` is true. ``uses`` is drawn too
    where it is there, of ``"samples|meshes"`` the first. ``caption`` stands below it in reports. ``saved``: whether it
    is among a result's files; others are drawn where they are asked for.
    """

    name: str
    draw: Function
    caption: str = ""
    needs: tuple[str, ...] = ()
    uses: tuple[str, ...] = ()
    where: Callable[[Any], bool] = lambda plot: True
    options: Mapping[str, Any] = field(default_factory=dict)
    saved: bool = True
    analyses: tuple[str, ...] = ()

    __repr__ = short_repr

    def missing(self, plot: Any) -> list[str]:
        """What it needs and the result does not hold."""
        return [need for need in self.needs if not _held(plot, need)]

    def drawn(self, plot: Any, *arguments: Any, **options: Any) -> Any:
        """The Figure. Raises InputError where the result does not hold what it needs, MissingExtraError."""
        if missing := self.missing(plot):
            held = ", ".join(word for word in PARTS if _held(plot, word)) or "nothing"
            raise InputError(missing[0], f"{self.name} shows it, which the result does not hold; it holds {held}")
        return imported(self.draw)(plot, *arguments, **{**self.options, **options})

    @property
    def takes(self) -> set[str]:
        """Names of the options that a user may give; they go before those of the row."""
        return set(list(signature(imported(self.draw)).parameters)[1:])


@dataclass(frozen=True)
class Presentation:
    """What an analysis registers of how its results are shown.

    ``pictures``: those of its results alone. Of a result document, ``facts`` gives lines of the summary, (name, text),
    ``title`` what stands beside robot and sampling, ``sections`` what the report shows instead of fields. ``measured``
    says what the headline measures, of all documents or of one; "": no workspace, and the facts stand in its place: the
    first of them says what was found, with its unit.
    ``drawings`` names tables of lines and arcs in a plane, which are saved as drawings. Of a result's `ResultPlots`,
    ``view`` gives what only the analysis adds to its view in a browser, `wsrender.results.view.additions.Additions`; of
    a document, ``job`` is that of the robots which the view shows.
    """

    pictures: tuple[Picture, ...] = ()
    facts: Callable[[Document], Iterator[tuple[str, str]]] = lambda document: iter(())
    title: Callable[[Document], list[str]] = lambda document: []
    sections: Callable[[Document], dict[str, Any]] = lambda document: {}
    measured: str | Callable[[Document], str] = REACHABLE
    drawings: tuple[str, ...] = ()
    view: Function | None = None
    job: Callable[[Document], Any] = lambda document: document.get("job")

    def measures(self, document: Document) -> str:
        """What the headline of a document measures; "": no workspace."""
        return self.measured(document) if callable(self.measured) else self.measured


PLANE = "slice"  # the picture of one plane of voxels
_PLOTS = "wsrender.results.drawing.result_plots:ResultPlots."
CURVES = ("scan", "refinements", "scales", "convergence")  # tables that are drawn against their first column
_CAPTIONS = {"convergence": "The best value so far"}
_ROWS = (
    Picture("robot", _PLOTS + "robot", "The arm in its workspace", ("skeleton",),
            ("samples|meshes|volume", "tables")),
    Picture("scatter", _PLOTS + "scatter", "Samples", ("samples",)),
    Picture("slices", _PLOTS + "slices", "Voxels in planes", ("volume",)),
    Picture("histogram", _PLOTS + "histogram", "Distribution of the indices over the samples", ("samples",),
            where=lambda plot: bool(plot.samples.indices)),
    Picture("admission", _PLOTS + "admission", "Voxels that are free, and those without an admitted sample",
            ("volumes.admission",)),
    Picture("labels", _PLOTS + "labels", "Voxels by whether their centres are reached", ("volumes.reachability",)),
    Picture("share", _PLOTS + "share", "Share of the samples that constraints admit", ("volumes.admission",)),
    *(Picture(name, _PLOTS + "curves", _CAPTIONS.get(name, ""), (f"tables.{name}",), options={"table": name})
      for name in CURVES),
    Picture("field", _PLOTS + "vectors", needs=("volume",), where=lambda plot: bool(plot.volume.vectors)),
    Picture("product", _PLOTS + "slices", needs=("volume",), options={"statistic": "product"},
            where=lambda plot: bool(plot.volume.statistics.get("product"))),
    Picture(PLANE, _PLOTS + "slice", needs=("volume",), saved=False),
)  # fmt: skip
_REGISTERED: dict[str, Picture] = {}


@keywords
def register_picture(row: Picture) -> Picture:
    """Add a picture: results that hold what it needs are then saved with it, and a server draws it.

    It replaces one that was registered before under the same name. Raises InputError, naming the member, where the row
    is not allowed, or its name is one of wsrender's own.

    >>> def heights(plot):
    ...     from matplotlib.figure import Figure
    ...
    ...     figure = Figure()
    ...     figure.subplots().hist(plot.samples.position[:, 2])
    ...     return figure
    >>> ws.register_picture(ws.Picture("heights", heights, needs=("samples",))).name
    'heights'
    """
    _check(row)
    _REGISTERED[row.name] = row
    return row


def presentation_of(document: Document) -> Presentation:
    """What the analysis of a result document registers; an empty one where the analysis is unknown."""
    presentations = _analyses()
    analysis = str(document.get("analysis"))
    return presentations[analysis]() if analysis in presentations else Presentation()


def pictures_of(document: Document) -> dict[str, Picture]:
    """The pictures that results of a document's analysis may have, by name: general, its own, and those added."""
    added = (_extensions() | _REGISTERED).values()
    own = [row for row in added if not row.analyses or document.get("analysis") in row.analyses]
    return {row.name: row for row in (*_ROWS, *presentation_of(document).pictures, *own)}


def all_pictures() -> dict[str, Picture]:
    """Every picture that there is, by its name; of those of one name in several analyses one."""
    return _own() | _extensions() | _REGISTERED


def picture_of(document: Document, name: str) -> Picture:
    """The picture of a name, also one that results of the document's analysis do not have.

    Raises InputError for one that there is not.
    """
    pictures = all_pictures() | pictures_of(document)
    if name not in pictures:
        allowed = f"allowed: {', '.join(pictures)}{left_out(EXTENSIONS)}"
        raise InputError("picture", f"{name!r} is not a picture; {allowed}")
    return pictures[name]


def _own() -> dict[str, Picture]:
    of_analyses = [row for presentation in _analyses().values() for row in presentation().pictures]
    return {row.name: row for row in (*_ROWS, *of_analyses)}


def _analyses() -> Mapping[str, Callable[[], Presentation]]:
    return imported(_REGISTRY)()


@cache
def _extensions() -> dict[str, Picture]:
    """The pictures of other packages."""
    found: dict[str, Picture] = {}

    def add(_: str, row: Any) -> None:
        _check(row)
        if row.name in found:
            raise InputError("name", f"there is a picture {row.name!r} of another package already")
        found[row.name] = row

    load(EXTENSIONS, add)
    return found


def _check(row: Any) -> None:
    """Whether a row of others can be used; raises InputError."""
    if not isinstance(row, Picture):
        raise InputError("picture", f"must be a wsrender.Picture, not {type(row).__name__}")
    if not re.fullmatch(r"[a-z][a-z0-9_]{0,63}", row.name):
        raise InputError("name", f"{row.name!r} is not allowed; 1 to 64 of a-z, 0-9 and _ are, a letter first")
    if row.name in _own():
        raise InputError("name", f"there is a picture {row.name!r} already, wsrender's own")
    for member in ("needs", "uses"):
        for word in (each for words in getattr(row, member) for each in words.split("|")):
            part, dot, _ = word.partition(".")
            if part not in (NAMED if dot else PARTS):
                raise InputError(member, f"{word!r} is none of {', '.join(PARTS)}, nor a named one such as tables.scan")


def _held(plot: Any, word: str) -> bool:
    """Whether a result holds something of a part, or of one of the name after a dot."""
    part, _, name = word.partition(".")
    found = getattr(plot, part)
    found = found.get(name) if name else found
    if part in ("volume", "volumes") and hasattr(found, "n_occupied"):
        return found.n_occupied > 0
    return found is not None and (not hasattr(found, "__len__") or len(found) > 0)


def imported(function: Function) -> Any:
    """The function of a row. Raises MissingExtraError where a package is missing."""
    if not isinstance(function, str):
        return function
    module, _, name = function.partition(":")
    try:
        return attrgetter(name)(import_module(module))
    except ModuleNotFoundError as error:
        if (error.name or "wsrender").partition(".")[0] == "wsrender":
            raise
        raise MissingExtraError(error.name or name, "engine") from error
