"""No module needs one that needs it: not at import, and not when a function that imports is called."""

import ast
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest
import wsrender_kernels
import wsrender_server

import wsrender


def modules():
    """Path of every module by its name."""
    found = {}
    for package in (wsrender, wsrender_kernels, wsrender_server):
        root = Path(package.__file__).parent
        for path in root.rglob("*.py"):
            parts = [package.__name__, *path.relative_to(root).with_suffix("").parts]
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imported(tree, names):
    """The modules that statements anywhere in a module import, but for those that type checkers alone read."""
    if isinstance(tree, ast.If) and "TYPE_CHECKING" in ast.unparse(tree.test):
        return
    if isinstance(tree, ast.Import):
        yield from (each.name for each in tree.names if each.name in names)
    elif isinstance(tree, ast.ImportFrom):
        assert tree.level == 0  # names are absolute here
        inner = {f"{tree.module}.{each.name}" for each in tree.names}
        yield from inner & names
        if tree.module in names and inner - names:
            yield tree.module
    for child in ast.iter_child_nodes(tree):
        yield from imported(child, names)


def graph_of(paths):
    return {name: set(imported(ast.parse(path.read_text()), paths.keys())) for name, path in paths.items()}


def test_no_module_needs_one_that_needs_it():
    graph = graph_of(modules())
    assert "wsrender.engine.devices" in graph["wsrender.analyses.execution"]
    assert "wsrender.geometry.surfaces" in graph["wsrender.analyses.workspace.result"]  # in a function
    parts = graph["wsrender.analyses.parallel_workspace.refined"]
    assert "wsrender.analyses.parallel_workspace.run" not in parts  # for type checkers
    assert len(graph) > 400
    list(TopologicalSorter(graph).static_order())


def test_a_cycle_through_a_function_is_found(tmp_path):
    for name, text in {"a": "def f():\n    from b import g\n", "b": "from a import f\n"}.items():
        (tmp_path / f"{name}.py").write_text(text)
    with pytest.raises(CycleError, match="a"):
        list(TopologicalSorter(graph_of({name: tmp_path / f"{name}.py" for name in "ab"})).static_order())
