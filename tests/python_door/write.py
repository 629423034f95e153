"""Write ``wsrender/python.py`` from the job classes: ``python -m tests.python_door.write``."""

import re
from inspect import cleandoc
from pathlib import Path
from textwrap import fill

import wsrender
from tests.python_door.parameters import Parameter, parameters_of
from tests.python_door.types import documents_in
from wsrender.analyses.registry import job_classes
from wsrender.documents.document import Document

PATH = Path(wsrender.__file__).parent / "python.py"
WIDTH = 120
FUNCTIONS = {"workspace": "analyze", "postures": "all_postures"}
"""Functions that are not called like their analysis."""
NOTES = {
    "workspace": "A robot that is a Python class is sampled by Sobol(2**16) by default.",
    "indices_at": "`evaluate_indices` is the quick form, which gives arrays.",
    "reachability": "`reachable` is the quick form, which gives labels and arrays.",
    "postures": "`postures` is the quick form, which gives arrays.",
    "kinetostatic_field": "`force_field` gives the forces of single configurations.",
    "boundary_patches": (
        "The result has tables ``patches``, ``edges``, ``corners`` and the mesh ``patches``; its document the volume. "
        'Patches of critical sets have the ``method`` "critical_set", fitted ones "fitted": primitives where the '
        "points are within ``fit_tolerance_m``, 2e-6 of the reach (single ones at edges within eight times that: "
        "``residual_m`` says); free forms, with the nearest primitive, elsewhere. Free forms that touch smoothly are "
        "one patch; where primitives do the edge is known to a cell. Points that stay ``undecided`` count as outside. "
        "A ur5e takes some 12 s of CPU time."
    ),
    "design_optimization": "A Pareto search needs pymoo, or else MissingExtraError is raised.",
}
ERRORS = "DocumentError, InputError, ModelError, ResourceError, NumericalError, NotConvergedError"
HEAD = '''"""The analyses from Python: a function for each, whose parameters are the fields of its job document.

Written by ``python -m tests.python_door.write`` from the job classes; change those. `runs` makes each function run.
"""

# Defaults are frozen:
# ruff: noqa: B008

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

{imports}

if TYPE_CHECKING:
    from wsrender.mechanisms.five_bar import FiveBar
    from wsrender.results.result import Result
    from wsrender.run.from_python import RobotLike, SamplingLike, SourceLike
    from wsrender.run.steps import Progress
'''
TAIL = "\n\nworkspace = analyze\n"
_WORDS = {"null": "None", "true": "True", "false": "False"}


def function_name(analysis: str) -> str:
    """What the function of an analysis is called."""
    return FUNCTIONS.get(analysis, analysis)


def module_text() -> str:
    """The whole module."""
    functions = "".join(f"\n\n{_function(analysis)}" for analysis in job_classes())
    return HEAD.format(imports=_imports(functions)) + functions + TAIL


def _function(analysis: str) -> str:
    parameters = list(parameters_of(analysis))
    lines = [_line(each) for placed, each in parameters if placed]
    lines += ["    *,", *(_line(each) for placed, each in parameters if not placed)]
    head = f'@runs("{analysis}")\ndef {function_name(analysis)}(\n'
    return head + "\n".join(lines) + f'\n) -> Result:\n    """{_docstring(analysis)}\n    """\n    ...\n'


def _line(parameter: Parameter) -> str:
    """A parameter, on several lines where one does not hold it, as ruff divides them."""
    default = "" if parameter.default is None else f" = {parameter.default}"
    line = f"    {parameter.name}: {parameter.type}{default},"
    if len(line) <= WIDTH:
        return line
    members = _members(parameter.type)
    if len(members) > 1:
        return f"    {parameter.name}: " + "\n    | ".join(members) + f"{default},"
    generic, _, inner = parameter.type.partition("[")
    return f"    {parameter.name}: {generic}[\n        {inner[:-1]}\n    ]{default},"


def _members(union: str) -> list[str]:
    """The members of a union, brackets kept whole."""
    members, depth = [""], 0
    for word in union.split(" | "):
        members[-1] += f" | {word}" if depth else word
        depth += word.count("[") - word.count("]")
        members += [] if depth else [""]
    return members[:-1]


def _docstring(analysis: str) -> str:
    """What the job's class says, what is special in Python, the parameters' meanings, and errors."""
    own = cleandoc(job_classes()[analysis].__doc__ or "")
    first, *more = _pythonic(own).split("\n\n")
    more += [NOTES[analysis]] if analysis in NOTES else []
    meanings = [_filled(f"``{each.name}``: {_pythonic(each.text)}", "    ") for _, each in parameters_of(analysis)]
    return "\n\n".join([first, *map(_filled, more), "\n".join(meanings), _filled(f"Raises {ERRORS}.")])


def _filled(paragraph: str, hanging: str = "") -> str:
    return fill(paragraph, WIDTH, initial_indent="    ", subsequent_indent="    " + hanging)


def _pythonic(text: str) -> str:
    """The text with the words of JSON as Python has them."""
    return re.sub(r"\b(null|(true|false)(?=:))", lambda word: _WORDS[word[0]], text)


def _imports(functions: str) -> str:
    """Statements for the documents that the functions name, and for what makes them run."""
    used: dict[str, set[str]] = {"wsrender.run.from_python": {"runs"}}
    code = re.sub(r'""".*?"""', "", functions, flags=re.DOTALL)
    for document in _documents():
        if re.search(rf"\b{document.__name__}\b", code):
            used.setdefault(document.__module__, set()).add(document.__name__)
    return "\n".join(_import(module, sorted(names)) for module, names in sorted(used.items()))


def _import(module: str, names: list[str]) -> str:
    line = f"from {module} import {', '.join(names)}"
    return line if len(line) <= WIDTH else f"from {module} import (\n    " + ",\n    ".join(names) + ",\n)"


def _documents() -> set[type[Document]]:
    fields = [field for job in job_classes().values() for field in job.model_fields.values()]
    return {Document} | {each for field in fields for each in documents_in(field.annotation)}


if __name__ == "__main__":
    PATH.write_text(module_text(), encoding="utf-8")
