"""The table of pictures: each is drawn wherever it says that it can be; nothing general names an analysis."""

import ast
from pathlib import Path

import pytest
import wsrender_server
from matplotlib.figure import Figure
from wsrender_server.conversions import draw

import wsrender as ws
from tests.golden.files import analyses, golden, golden_names
from wsrender.analyses.registry import job_classes
from wsrender.results import presentation
from wsrender.results.drawing import png
from wsrender.results.export.formats import rows
from wsrender.results.presentation import all_pictures, pictures_of
from wsrender.results.result import files_of_parts

PNG = next(row for row in rows("picture", own=True) if row.suffix == "png")


@pytest.mark.parametrize("name", golden_names())
def test_every_picture_is_drawn_for_every_golden_job(name, local):
    """Also those that are drawn only where they are asked for."""
    result = local(name)
    plot = result.plot
    assert sorted(row.name for row in plot.pictures) == golden(name)["pictures"]
    offered = [row for row in pictures_of(result.document).values() if not row.missing(plot) and row.where(plot)]
    for row in offered:
        figure = getattr(plot, row.name)()
        assert isinstance(figure, Figure) and figure.axes, row.name
        assert row.name in dir(plot)


@pytest.mark.parametrize("analysis", analyses())
def test_a_server_draws_the_same_pictures_of_what_they_need(analysis, saved):
    """Byte for byte, of no other files than those of what a row says that it needs and uses."""
    result = ws.Result.load(saved(analysis))
    files = {record["name"]: str(saved(analysis) / record["name"]) for record in result.document["artifacts"]}
    for row in result.plot.pictures:
        needed = files_of_parts((*row.needs, *row.uses), files)
        assert 0 < len(needed) < len(files)
        given = {name: files[name] for name in needed}
        drawn = draw(str(saved(analysis) / "result.json"), given, row.name, PNG, {"index": None})
        assert drawn == png(row.drawn(result.plot)), row.name


def test_every_picture_is_of_a_golden_job():
    seen = {name for job in golden_names() for name in golden(job)["pictures"]}
    assert {row.name for row in all_pictures().values() if row.saved} == seen


def test_a_picture_that_there_is_not(local):
    with pytest.raises(ws.InputError, match="'sunset' is not a picture; allowed: robot, scatter, slices"):
        local("workspace").plot("sunset")
    with pytest.raises(AttributeError, match="sunset"):
        local("workspace").plot.sunset  # noqa: B018
    with pytest.raises(ws.InputError, match="tables: aspects shows it, which the result does not hold; it holds"):
        local("workspace").plot.aspects()


def test_nothing_general_names_an_analysis():
    """But for examples of documents; "workspace" and "postures" are words too."""
    names = set(job_classes()) - {"workspace", "postures"}
    folders = [Path(presentation.__file__).parent, Path(wsrender_server.__path__[0]), Path(ws.run.__file__).parent]
    found = []
    for path in (path for folder in folders for path in folder.rglob("*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        examples = [node for node in tree.body if isinstance(node, ast.Assign) and _named(node, "EXAMPLES")]
        skipped = {each for node in examples for each in ast.walk(node)}
        for node in set(ast.walk(tree)) - skipped:
            if isinstance(node, ast.Constant) and node.value in names:
                found.append(f"{path.name}: {node.value}")
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("wsrender.analyses."):
                found += [f"{path.name}: {node.module}"] * bool(set(node.module.split(".")) & names)
    assert found == []


def _named(assignment, name):
    target = assignment.targets[0]
    return isinstance(target, ast.Name) and target.id == name
