"""Where results come from: how the software is cited, and the command that asked.

One source of what ``wsrender cite``, provenance and CITATION.cff say.
"""

import json
from collections.abc import Mapping
from contextvars import ContextVar
from typing import Literal, get_args

from wsrender.version import __version__

TITLE = "wsrender: workspace analysis of robotic manipulators"
AUTHORS = "The wsrender developers"
LICENSE = "Apache-2.0"
RELEASED = "2026-11-28"
# What the indices and maps follow, as far as it is cited in this project's sources.
PAPER = {
    "title": "WSRender: A Workspace Analysis and Visualization Toolbox for Robotic Manipulator Design and Verification",
    "journal": "IEEE Robotics and Automation Letters",
    "volume": 4,
    "number": 4,
    "year": 2019,
}
PAPER_AUTHORS = ("Zhang", "Cursi", "Yang")

asked_by: ContextVar[str | None] = ContextVar("asked_by", default=None)
"""What the user typed, where the command line runs a job."""

Style = Literal["text", "bibtex", "cff"]
STYLES: tuple[str, ...] = get_args(Style)


def citation(style: Style = "text") -> str:
    """The software in a line, or the software and the paper that it follows as BibTeX or as a CITATION.cff."""
    return {"text": _text, "bibtex": _bibtex, "cff": _cff}[style]()


def _text() -> str:
    return f"{AUTHORS} ({RELEASED[:4]}). {TITLE}, version {__version__}. {LICENSE}."


def _bibtex() -> str:
    software = {
        "title": f"{{{TITLE}}}",
        "author": f"{{{AUTHORS}}}",
        "version": __version__,
        "year": RELEASED[:4],
        "note": f"License: {LICENSE}",
    }
    paper = {
        "title": f"{{{PAPER['title']}}}",
        "author": " and ".join(PAPER_AUTHORS),
        **{k: PAPER[k] for k in list(PAPER)[1:]},
    }
    return "\n\n".join(_entry(*each) for each in (("software", "wsrender", software), ("article", "wsr2019", paper)))


def _entry(kind: str, key: str, fields: Mapping[str, object]) -> str:
    lines = "\n".join(f"  {name} = {{{value}}}," for name, value in fields.items())
    return f"@{kind}{{{key},\n{lines}\n}}"


def _cff() -> str:
    """Strings are written as JSON's, which are YAML's."""
    lines = [
        "cff-version: 1.2.0",
        'message: "If you use this software, please cite it."',
        "type: software",
        f"title: {json.dumps(TITLE)}",
        "authors:",
        f"  - name: {json.dumps(AUTHORS)}",
        f"version: {__version__}",
        f"date-released: {RELEASED}",
        f"license: {LICENSE}",
        "references:",
        "  - type: article",
        f"    title: {json.dumps(PAPER['title'])}",
        "    authors:",
    ]
    lines += [f"      - family-names: {name}" for name in PAPER_AUTHORS]
    lines += [f"    journal: {PAPER['journal']}", f"    volume: {PAPER['volume']}", f"    issue: {PAPER['number']}"]
    return "\n".join([*lines, f"    year: {PAPER['year']}"])
