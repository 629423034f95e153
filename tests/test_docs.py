"""What the pages of the docs show works as it is written."""

import re
from pathlib import Path

import pytest
from typer.main import get_command

import wsrender as ws
from tests.snippets import CLONE, blocks, run
from wsrender.analyses.jobs import parse_job
from wsrender.analyses.registry import job_classes
from wsrender.cli import command_line

PAGES = [page for page in sorted(CLONE.glob("docs/*/*.md")) if page.stem != "ten_minutes"]  # which test_ten_minutes has

ANALYSES, RESULTS = (CLONE.joinpath("docs", "start", name).read_text("utf-8") for name in ("analyses.md", "results.md"))


def with_blocks(language):
    pages = [page for page in PAGES if blocks(page.read_text(encoding="utf-8"), language)]
    return pytest.mark.parametrize("page", pages, ids=lambda page: page.stem)


@with_blocks("python")
def test_snippets(page, tmp_path, monkeypatch):
    run(page, tmp_path, monkeypatch)


@with_blocks("python")
def test_snippets_are_small(page):
    """A snippet is read at a glance."""
    for snippet in blocks(page.read_text(encoding="utf-8"), "python"):
        assert snippet.count("\n") <= 25


def test_the_job_document_that_is_shown():
    (example,) = blocks(ANALYSES, "json")
    assert parse_job(example).robot.library == "phantom_omni"


def test_every_analysis_is_listed_with_its_function():
    listed = dict(re.findall(r"^\| `(\w+)` \| `ws\.(\w+)`", ANALYSES, flags=re.MULTILINE))
    assert listed.keys() == job_classes().keys()
    assert set(listed.values()) <= set(ws.__all__)


def test_the_files_of_a_result_are_listed(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    ws.analyze("scara", sampling=ws.Grid(3), task=["x", "y"], voxel_size_m=0.05, keep_map=True).save("out")
    listed = set(re.findall(r"`([\w/.]+)`", RESULTS.split("## Files")[1].split("\n\n")[1]))
    written = {path.name for path in Path("out").iterdir()}
    assert {name.strip("/") for name in listed} >= written


TYPED = [*PAGES, *(CLONE / name for name in ("README.md", "server/README.md", "deploy/README.md", "clients/README.md"))]


@pytest.mark.parametrize("page", TYPED, ids=lambda page: "/".join(page.parts[-2:]))
def test_commands_that_are_shown_are_known(page):
    """Their names, and their options, in blocks and in text."""
    text = page.read_text("utf-8")
    fenced = re.findall(r"^```([^\n]*)\n(.*?)^```", text, flags=re.DOTALL | re.MULTILINE)
    shown = "".join(content for language, content in fenced if language in ("", "sh"))
    typed = re.findall(r"^ *(wsrender [a-z].*)$", shown, flags=re.MULTILINE) + re.findall(
        r"`(wsrender [a-z][^`]*)`", text
    )
    faults = {line: _unknown(re.split(r"[#|;&]", line)[0].split()[1:]) for line in typed}
    assert {line: fault for line, fault in faults.items() if fault} == {}


def _unknown(words):
    """Of a command's words those that are no command where one must stand, or no option of it."""
    command = get_command(command_line(None))
    while words and hasattr(command, "commands"):
        if words[0] not in command.commands:
            return words[:1]
        command, words = command.commands[words[0]], words[1:]
    known = {name for each in command.params for name in (*each.opts, *each.secondary_opts)} | {"--help"}
    return [word for word in words if word.startswith("-") and word.partition("=")[0].rstrip(",.") not in known]
