"""The table of analyses: the job of each, and what plans it.

Library, command line and server parse and plan jobs by this table. Another package adds a row through the
entry-point group ``wsrender.analyses``: the entry's name is that of the analysis, its object an ``Entry``.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial
from importlib import import_module
from typing import Any

from wsrender.documents.document import Document
from wsrender.errors import InputError
from wsrender.extensions import load
from wsrender.results.document import ResultDocument
from wsrender.results.presentation import Presentation

EXTENSIONS = "wsrender.analyses"  # entry points, loaded when the table is first read


@dataclass(frozen=True)
class Entry:
    """An analysis: the class of its job, and what plans it, an ``Analysis`` (see `wsrender.analyses.contract`).

    Each may be ``"module:name"``: jobs are imported when the table is first read, what plans one when it is planned.
    ``presentation`` says how its results are shown; None: as those of any analysis. ``result`` is the form of its
    result documents, a class after `wsrender.results.document.ResultDocument`; None: only what all have is known.
    """

    job: str | type[Document]
    run: str | Callable[..., Any]
    presentation: str | Presentation | None = None
    result: str | type[ResultDocument] | None = None


def _own(name: str, job: str, run: str, presentation: str | None = "PRESENTATION") -> Entry:
    """An analysis of this package, in a folder of its name; ``run`` is in its ``run.py``, or says its module."""
    folder = f"{__name__.rpartition('.')[0]}.{name}"
    shown = None if presentation is None else f"{folder}.presentation:{presentation}"
    result = f"{folder}.document:{job.removesuffix('Job')}Result"
    return Entry(f"{folder}.job:{job}", f"{folder}.{run if ':' in run else f'run:{run}'}", shown, result)


_ROWS = {
    "workspace": _own("workspace", "WorkspaceJob", "WorkspaceAnalysis", None),
    "indices_at": _own("indices_at", "IndicesAtJob", "IndicesAtAnalysis"),
    "reachability": _own("reachability", "ReachabilityJob", "ReachabilityAnalysis"),
    "postures": _own("postures", "PosturesJob", "PosturesAnalysis"),
    "capability": _own("capability", "CapabilityJob", "CapabilityAnalysis"),
    "shared_workspace": _own("shared_workspace", "SharedWorkspaceJob", "SharedWorkspaceAnalysis"),
    "robot_comparison": _own("robot_comparison", "RobotComparisonJob", "RobotComparisonAnalysis"),
    "base_placement": _own("base_placement", "BasePlacementJob", "several:alone_or_several"),
    "inverse_reachability": _own("inverse_reachability", "InverseReachabilityJob", "InverseReachabilityAnalysis"),
    "two_arm_placement": _own("two_arm_placement", "TwoArmPlacementJob", "TwoArmPlacementAnalysis"),
    "collaborative_volume": _own("collaborative_volume", "CollaborativeVolumeJob", "CollaborativeVolumeAnalysis"),
    "master_slave_mapping": _own("master_slave_mapping", "MasterSlaveMappingJob", "MasterSlaveMappingAnalysis"),
    "kinetostatic_field": _own("kinetostatic_field", "KinetostaticFieldJob", "KinetostaticFieldAnalysis"),
    "parallel_workspace": _own("parallel_workspace", "ParallelWorkspaceJob", "ParallelWorkspaceAnalysis"),
    "five_bar": _own("five_bar", "FiveBarJob", "FiveBarAnalysis"),
    "planar_boundary": _own("planar_boundary", "PlanarBoundaryJob", "PlanarBoundaryAnalysis"),
    "boundary_patches": _own("boundary_patches", "BoundaryPatchesJob", "BoundaryPatchesAnalysis"),
    "method_comparison": _own("method_comparison", "MethodComparisonJob", "MethodComparisonAnalysis"),
    "design_optimization": _own("design_optimization", "DesignOptimizationJob", "DesignOptimizationAnalysis"),
}


@cache
def job_classes() -> dict[str, type[Document]]:
    """The class of the jobs of every analysis, by its name."""
    return {name: _loaded(entry.job) for name, entry in _table().items()}


@cache
def result_classes() -> dict[str, type[ResultDocument]]:
    """The form of the result documents of every analysis that says it, by its name."""
    return {name: _loaded(entry.result) for name, entry in _table().items() if entry.result is not None}


def planned(job: Any, *robots: Any, resolved: dict[str, Any] | None = None) -> Any:
    """The plan of a job with its robots; ``resolved``: what an earlier plan of it settled."""
    return _loaded(_table()[job.analysis].run)(job, *robots, resolved=resolved)


def presentations() -> dict[str, Callable[[], Presentation]]:
    """What gives the presentation of each analysis that has one, by its name."""
    table = {name: entry.presentation for name, entry in _table().items()}
    return {name: partial(_loaded, named) for name, named in table.items() if named is not None}


def _loaded(named: Any) -> Any:
    if not isinstance(named, str):
        return named
    module, _, name = named.partition(":")
    return getattr(import_module(module), name)


@cache
def _table() -> dict[str, Entry]:
    found = dict(_ROWS)

    def add(name: str, entry: Any) -> None:
        _check(name, entry, found)
        found[name] = entry

    load(EXTENSIONS, add)
    return found


def _check(name: str, entry: Any, found: dict[str, Entry]) -> None:
    """Whether an entry can be a row; raises InputError."""
    if not isinstance(entry, Entry):
        raise InputError("entry", f"must be an Entry, not {type(entry).__name__}")
    if name in found:
        raise InputError("name", f"there is an analysis {name!r} already")
    job = _loaded(entry.job)
    if not (isinstance(job, type) and issubclass(job, Document)):
        raise InputError("job", f"must be a class of documents, not {job!r}")
    field = job.model_fields.get("analysis")
    if field is None or field.default != name:
        raise InputError("job", f'{job.__name__} must have the field analysis: Literal["{name}"] = "{name}"')
    for needed in ("arms", "sweeps"):
        if not callable(getattr(job, needed, None)):
            raise InputError("job", f"{job.__name__} must have the method {needed}(), as Arm has it")
    if not isinstance(shown := _loaded(entry.presentation), Presentation | None):
        raise InputError("presentation", f"must be a Presentation, not {type(shown).__name__}")
    result = _loaded(entry.result)
    if result is not None and not (isinstance(result, type) and issubclass(result, ResultDocument)):
        raise InputError("result", f"must be a class of result documents, not {result!r}")
