"""Pages of the reference, written at build from what they describe: public names, schemas, commands, routes."""

import inspect
import json
import re
import tempfile
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any

import typer.main
from sphinx.application import Sphinx
from wsrender_server.app import create_app
from wsrender_server.job_body import body_schemas
from wsrender_server.openapi import openapi_document
from wsrender_server.settings import Settings

import wsrender
from wsrender.analyses import registry
from wsrender.cli import command_line

_FUNCTIONS, _CLASSES, _DOCUMENTS, _ERRORS = "Functions", "Classes", "Parts of job documents", "Errors"


def write(app: Sphinx) -> None:
    """Write all pages into ``generated/reference``."""
    folder = Path(app.srcdir) / "generated" / "reference"
    folder.mkdir(parents=True, exist_ok=True)
    for name, lines in PAGES.items():
        text = "\n".join(lines()) + "\n"
        path = folder / f"{name}.md"
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


def _python() -> Iterator[str]:
    groups: dict[str, list[str]] = {_FUNCTIONS: [], _CLASSES: [], _DOCUMENTS: [], _ERRORS: []}
    for name in wsrender.__all__:
        value = getattr(wsrender, name)
        if inspect.isfunction(value):
            groups[_FUNCTIONS].append(name)
        elif inspect.isclass(value):
            error, document = issubclass(value, BaseException), type(value) is not type
            groups[_ERRORS if error else _DOCUMENTS if document else _CLASSES].append(name)
    yield "# Python\n\n`import wsrender as ws`; in examples `np` is NumPy. "
    yield "Lengths are in metres, angles in radians, quaternions w, x, y, z.\n"
    for title, names in groups.items():
        yield f"## {title}\n"
        for name in names:
            value = getattr(wsrender, name)
            yield f"### {name}\n\n```python\n{_called(name, value)}\n```\n\n{_told(value)}\n"
            if inspect.isclass(value):
                yield from _members(value)
    yield "## Modules\n"
    for module in (wsrender.errors, wsrender.math, wsrender.run):
        name = module.__name__.rpartition(".")[2]
        yield f"### {name}\n\n{_told(module)}\n"
        for each in getattr(module, "__all__", ()):  # errors stand above
            called = _called(f"{name}.{each}", getattr(module, each))
            yield f"`{' '.join(called.split())}`\n: " + _told(getattr(module, each)).replace("\n", "\n  ") + "\n"


def _called(name: str, value: Any) -> str:
    """How a function or class is called, an argument a line where they are many."""
    try:
        signature = inspect.signature(value)
    except (TypeError, ValueError):
        return f"ws.{name}"
    arguments = [str(each) for each in signature.parameters.values() if each.name != "self"]
    kinds = [each.kind for each in signature.parameters.values() if each.name != "self"]
    if inspect.Parameter.KEYWORD_ONLY in kinds and inspect.Parameter.VAR_POSITIONAL not in kinds:
        arguments.insert(kinds.index(inspect.Parameter.KEYWORD_ONLY), "*")
    inside = ", ".join(arguments)
    if len(inside) > 80:
        inside = "\n" + "".join(f"    {each},\n" for each in arguments)
    answer = signature.return_annotation
    told = "" if answer is inspect.Signature.empty or inspect.isclass(value) else f" -> {_type(answer)}"
    inside = inside.replace("…", "...")
    return re.sub(r""": (['"])(.*?)\1(?=,|$| = )""", r": \2", f"ws.{name}({inside}){told}", flags=re.MULTILINE)


def _type(annotation: Any) -> str:
    return annotation if isinstance(annotation, str) else getattr(annotation, "__name__", str(annotation))


def _told(value: Any) -> str:
    """A docstring as Markdown: its items on ``names`` as a list, its examples and what is drawn in it as they are."""
    return "\n\n".join(_paragraph(each) for each in (inspect.getdoc(value) or "").split("\n\n") if each != "::")


def _paragraph(text: str) -> str:
    if text.startswith((">>> ", "    ")):
        return f"```{'pycon' if text[0] == '>' else 'text'}\n{inspect.cleandoc(text)}\n```"
    items = re.sub(r"^(?=``\w+``:)", "- ", text, flags=re.MULTILINE)
    return _safe(re.sub(r"``([^`]+)``", r"`\1`", items))


def _safe(text: str) -> str:
    """Text of which Markdown makes no markup but `code`."""
    parts = re.split(r"(`[^`\n]*`)", text)
    return "".join(part if k % 2 else re.sub(r"([*_<>$\[\]|{}])", r"\\\1", part) for k, part in enumerate(parts))


def _members(value: type) -> Iterator[str]:
    """Public methods and properties with their docstrings."""
    own = [each for each in value.__mro__ if each.__module__.startswith("wsrender")]
    for name in dict.fromkeys(name for each in own for name in vars(each) if not name.startswith("_")):
        member = inspect.getattr_static(value, name)
        function = getattr(member, "fget", None) or getattr(member, "func", None) or getattr(member, "__func__", member)
        if not inspect.isfunction(function) or not function.__doc__:
            continue
        is_value = isinstance(member, property) or hasattr(member, "func")
        called = f"{name}" if is_value else _called(name, function).removeprefix("ws.").replace("\n", " ")
        yield f"`{re.sub(r'  +', ' ', called)}`\n: " + _told(function).replace("\n", "\n  ") + "\n"


def _jobs() -> Iterator[str]:
    yield "# Job documents\n"
    yield (
        "A job is a JSON object with the field `analysis`; every other field has a default or is needed. The same\n"
        "names are arguments of the functions in Python and options of `wsrender run`. `wsrender schema` prints\n"
        "the JSON Schema that this page is made of.\n"
    )
    schemas = body_schemas()
    for name, job in registry.job_classes().items():
        schema = schemas[job.__name__]
        yield f"## {name}\n\n{_safe(schema.get('description', ''))}\n"
        yield from _fields(schema)
    yield "## Parts\n"
    jobs = {job.__name__ for job in registry.job_classes().values()}
    for name, schema in sorted(schemas.items()):
        if name not in jobs and not name.endswith("Submission"):
            yield f"### {name}\n\n{_safe(schema.get('description', ''))}\n"
            yield from _fields(schema) if schema.get("properties") else [f"{_kind(schema).capitalize()}.\n"]


def _fields(schema: Mapping[str, Any]) -> Iterator[str]:
    yield "| field | what |\n|---|---|"
    needed = schema.get("required", ())
    for name, field in schema.get("properties", {}).items():
        default = f", by default `{_json(field['default'])}`" if "default" in field else ""
        taken = f"*{_kind(field)}*{', needed' if name in needed else default}"
        yield f"| `{name}` | {taken}<br>{_cell(field.get('description', ''))} |"
    yield ""


def _json(value: Any) -> str:
    text = json.dumps(value)
    return text if len(text) < 60 else "…"


def _kind(field: Mapping[str, Any]) -> str:
    """A few words on a type."""
    if "$ref" in field:
        return f"[{_of(field)}](#{_anchors().get(_of(field), _of(field).lower())})"
    for key in ("anyOf", "oneOf"):
        if key in field:
            found = list(dict.fromkeys(_kind(each) for each in field[key]))
            return " or ".join(found[:5]) + (" …" if len(found) > 5 else "")
    if "const" in field:
        return f"`{_json(field['const'])}`"
    if "enum" in field:
        shown = [f"`{each}`" for each in field["enum"][:6]]
        return ", ".join(shown) + (" …" if len(field["enum"]) > 6 else "")
    if field.get("type") == "array":
        items = field.get("items")
        many = len(field["prefixItems"]) if "prefixItems" in field else None
        of = _kind(items) if isinstance(items, dict) else _kind(field["prefixItems"][0]) if many else "values"
        return f"list of {many or ''} {of}".replace("  ", " ")
    return {"null": "null", None: "any"}.get(field.get("type"), str(field.get("type")))


@cache
def _anchors() -> dict[str, str]:
    """Of the classes of jobs the analysis, under which they stand."""
    return {job.__name__: name for name, job in registry.job_classes().items()}


def _of(field: Mapping[str, Any]) -> str:
    return field["$ref"].rpartition("/")[2]


def _cell(text: str) -> str:
    return _safe(text).replace("\n", " ")


def _results() -> Iterator[str]:
    yield "# Results\n"
    yield (
        "`result.json` is the result document: what was asked (`job`), by whom and when (`provenance`), the `headline` "
        "with its interval, and an entry for each thing below. Beside it lie volumes, tables and pictures. "
        "[How to read a result](../../start/results.md) explains the entries that all of them have.\n"
    )
    for name in registry.job_classes():
        readme = Path(wsrender.__file__).parent / "analyses" / name / "README.md"
        text = readme.read_text(encoding="utf-8")
        text = re.sub(r"^#", "##", text, flags=re.MULTILINE)
        yield re.sub(r"\[([^\]]+)\]\((?!https?:)[^)]*\)", r"\1", text)


def _command_line() -> Iterator[str]:
    yield "# Command line\n\n`wsrender --help` prints the commands, `wsrender COMMAND --help` their options.\n"
    root = typer.main.get_command(command_line(None))
    yield from _commands(root, "wsrender", 1)


def _commands(command: Any, name: str, level: int) -> Iterator[str]:
    if level > 1:
        yield f"{'#' * level} {name}\n\n{_safe(inspect.cleandoc(command.help or ''))}\n"
        rows = [each for each in command.params if not getattr(each, "hidden", False)]
        if rows:
            yield "| option | what |\n|---|---|"
            for each in rows:
                is_option = each.param_type_name == "option"
                names = each.opts if is_option else [(each.metavar or each.name).upper()]
                told = _cell(getattr(each, "help", None) or "")
                yield f"| {', '.join(f'`{one}`' for one in names)} | {told} |"
            yield ""
    for key, sub in sorted(getattr(command, "commands", {}).items()):
        if not sub.hidden:
            yield from _commands(sub, f"{name} {key}", level + 1)


def _http() -> Iterator[str]:
    with tempfile.TemporaryDirectory() as folder:
        document = openapi_document(create_app(Settings(data_dir=Path(folder))), True)
    yield "# HTTP\n"
    yield (
        "A server describes itself at `/openapi.json` and, to be tried, at `/docs`. Keys go into\n"
        "`Authorization: Bearer KEY`, or are the password of Basic authentication. What is wrong is a problem\n"
        "document (RFC 9457), `application/problem+json`.\n"
    )
    for path, methods in sorted(document["paths"].items()):
        for method, operation in methods.items():
            yield f"## {method.upper()} {_safe(path)}\n\n{_safe(operation.get('summary', ''))}\n"
            if operation.get("description"):
                yield _safe(operation["description"]) + "\n"
            if operation.get("parameters"):
                yield "| parameter | in | type | what |\n|---|---|---|---|"
                for each in operation["parameters"]:
                    told = each.get("description") or each["schema"].get("description", "")
                    yield f"| `{each['name']}` | {each['in']} | {_plain(each['schema'])} | {_cell(told)} |"
                yield ""
            for media in operation.get("requestBody", {}).get("content", {}):
                yield f"- takes `{media}`"
            problems = []
            for status, answer in operation["responses"].items():
                if list(answer.get("content", {})) == ["application/problem+json"]:
                    problems.append(status)
                    continue
                media = ", ".join(f"`{each}`" for each in answer.get("content", {}))
                yield f"- **{status}** {_cell(answer.get('description', ''))}{' ' + media if media else ''}"
            yield f"- problems: {', '.join(problems)}\n"


def _plain(schema: Mapping[str, Any]) -> str:
    return re.sub(r"\[([^\]]+)\]\([^)]*\)", r"\1", _kind(schema))


PAGES = {"python": _python, "jobs": _jobs, "results": _results, "command_line": _command_line, "http": _http}


def setup(app: Sphinx) -> dict:
    """Write the pages before any is read."""
    app.connect("builder-inited", write)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
