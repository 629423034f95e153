"""What pages show in Python, run as it is written: the snippets of a page are one program, in their order."""

import re
from pathlib import Path
from shutil import copytree

from wsrender.indices import index_catalogue
from wsrender.pipeline.constraints import registry

CLONE = Path(__file__).parents[1]


def blocks(text, language):
    """The fenced blocks of a language, in the order of the page."""
    return re.findall(rf"^```{language}\n(.*?)^```", text, flags=re.DOTALL | re.MULTILINE)


def run(page, folder, monkeypatch):
    """Run the snippets of a page in an empty folder beside the examples of the docs; the names that they leave."""
    monkeypatch.chdir(folder)
    monkeypatch.setattr(index_catalogue, "_ADDED", {})
    monkeypatch.setattr(registry, "_ADDED", {})
    copytree(CLONE / "docs" / "examples", folder / "docs" / "examples")
    names = {}
    for snippet in blocks(page.read_text(encoding="utf-8"), "python"):
        exec(compile(snippet, str(page), "exec"), names)
    return names
