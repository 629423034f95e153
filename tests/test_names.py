"""A name means one thing: no module hides a function, and no two classes are called alike."""

import ast
from collections import defaultdict

from tests.test_import_cycles import modules


def trees():
    return {name: (path, ast.parse(path.read_text())) for name, path in modules().items()}


def names_of(tree):
    """What a package's __init__ defines, exports, or imports from other modules than itself."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            yield node.name
        elif isinstance(node, ast.ImportFrom):
            yield from (each.asname or each.name for each in node.names if node.module != "__future__")
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            yield from (target.id for target in targets if isinstance(target, ast.Name))


def test_no_module_is_called_like_what_its_package_exports():
    """Importing the module would hide the function; `wsrender.run` is the module itself."""
    found = trees()
    hidden = {
        f"{package}.{name}"
        for package, (path, tree) in found.items()
        if path.name == "__init__.py"
        for name in names_of(tree)
        if f"{package}.{name}" in found
    }
    assert hidden == {"wsrender.run"}


def test_no_two_classes_of_a_package_are_called_alike():
    """What a server and a client say of one thing may share a word: they are packages of their own."""
    found = defaultdict(list)
    for module, (_, tree) in trees().items():
        package = "client" if module.startswith("wsrender.client.") else module.partition(".")[0]
        for node in ast.walk(tree):
            if isinstance(node, ast.ClassDef):
                found[package, node.name].append(module)
    assert len(found) > 500
    assert {name: where for (_, name), where in found.items() if len(where) > 1} == {}
