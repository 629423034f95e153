"""The page: title, main values, pictures, tables, provenance and the job document."""

import base64
import json
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any

from wsrender.results.export.headline import headline_lines, warning_lines
from wsrender.results.presentation import presentation_of
from wsrender.results.report.entries import facts_html, label, records_html, table_html, value_html
from wsrender.volume.table import Table

if TYPE_CHECKING:
    from wsrender.results.view import View

# Nothing but what is in the page itself: whatever a name may hold, no script runs and nothing is fetched.
_POLICY = "default-src 'none'; img-src data: blob:; style-src 'unsafe-inline'"
_MOST_JOB_TEXT = 100_000  # characters of the job document; result.json has all
_FIRST = ("warnings",)  # above all sections
_LATER = ("robot", "robots", "mechanism", "sampling", "choices")  # after the pictures; results come before them
_NAMED_IN_TABLE = ("comparison",)  # results whose table says the same, with the names of robots over its columns
_LAST = ("job", "artifacts", "provenance", "timing_s")  # sections of their own, at the end
_WIDE = 1.6  # width by height from which a picture takes the whole width
_STYLE = """
:root { color-scheme: light; }
body { font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif; color: #222; background: #fff; margin: 0 auto;
  max-width: 60rem; padding: 2rem 1.5rem; }
h1 { font-size: 1.6rem; margin: 0 0 .2rem; overflow-wrap: anywhere; }
h2 { font-size: 1.15rem; margin: 2.2rem 0 .6rem; border-bottom: 1px solid #ddd; padding-bottom: .2rem; }
h3 { font-size: 1rem; margin: 1.4rem 0 .4rem; }
p.headline { font-size: 1.25rem; font-weight: 600; margin: .8rem 0 .2rem; }
section.warnings { background: #fff6e0; border-left: .3rem solid #e0a000; padding: .1rem 1rem; margin: 1rem 0; }
section.warnings h2 { border: 0; margin: .5rem 0 .2rem; }
section.warnings ul { margin: .2rem 0 .6rem; padding-left: 1.1rem; }
section.warnings li { overflow-wrap: anywhere; }
p.note, figcaption { color: #666; font-size: .85rem; }
table { border-collapse: collapse; font-size: .85rem; margin: .3rem 0; }
th, td { text-align: left; vertical-align: top; padding: .18rem .9rem .18rem 0; }
th { font-weight: 600; }
thead th { border-bottom: 1px solid #bbb; white-space: nowrap; }
td.number, table.matrix td { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
table.facts th { font-weight: 400; color: #555; white-space: nowrap; }
div.wide { overflow-x: auto; }
figure { display: inline-block; width: 49%; min-width: min(20rem, 100%); margin: 0 0 1rem; vertical-align: top; }
figure.wide { width: 100%; } figure img { width: 100%; height: auto; }
pre { background: #f6f6f4; padding: .8rem; font-size: .8rem; white-space: pre-wrap; overflow-wrap: anywhere; }
code { font-size: .8rem; overflow-wrap: anywhere; }
@media print {
  @page { margin: 15mm; }
  body { max-width: none; padding: 0; font-size: 10pt; }
  figure, tr { break-inside: avoid; } h2, h3 { break-after: avoid; }
  div.wide { overflow: visible; orphans: 1; widows: 1; } figure { min-width: 0; }
  th, td { overflow-wrap: anywhere; }
}
"""


@dataclass(frozen=True)
class ShownPicture:
    """A PNG picture and its name, such as ``slices``; ``said`` is its caption, by default its name in words."""

    name: str
    png: bytes
    said: str = ""

    @property
    def caption(self) -> str:
        """What it shows."""
        return self.said or label(self.name)[:1].upper() + label(self.name)[1:]

    @property
    def is_wide(self) -> bool:
        """Whether it is much wider than high."""
        width, height = struct.unpack(">II", self.png[16:24])  # of the header that every PNG starts with
        return width > _WIDE * height


def report_page(
    title: str,
    document: Mapping[str, Any],
    pictures: Sequence[ShownPicture],
    tables: Mapping[str, Table],
    notes: Sequence[str] = (),
    view: "View | None" = None,
) -> str:
    """The HTML text of a report: every value of the document, pictures and ``view`` inside, no link to the outside."""
    from wsrender.results.view.page import embedded, loader_policy, shows_something

    single = {
        key: value for key, value in document.items() if not isinstance(value, Mapping | list) and value is not None
    }
    nested: dict[str, Any] = {
        key: value for key, value in document.items() if isinstance(value, Mapping | list) and value
    }
    nested |= presentation_of(document).sections(document)
    sections = [_head(document), _section("Main values", facts_html(single))]
    results = [key for key in nested if key not in _FIRST + _LATER + _LAST]
    named = {key: tables[key] for key in _NAMED_IN_TABLE if key in tables}
    sections += [
        _section(label(key), table_html(named[key]) if key in named else value_html(nested[key])) for key in results
    ]
    policy = _POLICY
    if view is not None and shows_something(view):
        sections += [_section("View", embedded(view))]
        policy = f"{_POLICY}; {loader_policy()}"  # the viewer's script is one of the page's own, known by its hash
    sections += [_section("Pictures", _pictures(pictures, notes))]
    sections += [_section(label(key), value_html(nested[key])) for key in _LATER if key in nested]
    others = {name: table for name, table in tables.items() if name not in named and len(table)}
    sections += [_section(f"Table: {label(name)}", table_html(table)) for name, table in others.items()]
    sections += [_section(label(key), facts_html(nested[key])) for key in ("provenance", "timing_s") if key in nested]
    sections += [_section("Files", _files(nested["artifacts"]))] if "artifacts" in nested else []
    sections += [_section("Job document", _job(nested["job"]))] if "job" in nested else []
    return _PAGE.format(policy=escape(policy), title=escape(title), style=_STYLE, body="\n".join(sections))


_PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<style>{style}</style>
</head>
<body>
<h1>{title}</h1>
<p class="note">Lengths in metres, angles in radians, positions in the world frame. wsrender.</p>
{body}
</body>
</html>
"""


def _section(heading: str, content: str) -> str:
    heading = heading[:1].upper() + heading[1:]
    return f"<section><h2>{escape(heading)}</h2><div class=wide>{content}</div></section>"


def _head(document: Mapping[str, Any]) -> str:
    """The headline, large, and every warning."""
    lines = "".join(f"<p class=headline>{escape(line)}</p>" for line in headline_lines(document))
    items = "".join(f"<li>{escape(text)}</li>" for text in warning_lines(document))
    return lines + (f"<section class=warnings><h2>Warnings</h2><ul>{items}</ul></section>" if items else "")


def _pictures(pictures: Sequence[ShownPicture], notes: Sequence[str]) -> str:
    figures = "".join(map(_figure, pictures))
    return figures + "".join(f"<p class=note>{escape(note)}</p>" for note in notes)


def _figure(picture: ShownPicture) -> str:
    caption, wide = escape(picture.caption), " class=wide" if picture.is_wide else ""
    source = f"data:image/png;base64,{base64.b64encode(picture.png).decode()}"
    return f'<figure{wide}><img alt="{caption}" src="{source}"><figcaption>{caption}</figcaption></figure>'


def _files(artifacts: Sequence[Mapping[str, Any]]) -> str:
    return records_html([{key: record.get(key) for key in ("name", "bytes", "sha256")} for record in artifacts])


def _job(job: Mapping[str, Any]) -> str:
    text = json.dumps(job, indent=2, ensure_ascii=False)
    cut = len(text) > _MOST_JOB_TEXT
    note = "<p class=note>Cut here; result.json has all of it.</p>" if cut else ""
    return f"<pre>{escape(text[:_MOST_JOB_TEXT])}</pre>{note}"
