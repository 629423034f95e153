"""The examples in docstrings run and print what they say; ``ws`` and ``np`` are there."""

import doctest
import inspect
from importlib import import_module

import numpy as np
import pytest

import wsrender as ws
from tests.test_import_cycles import modules
from wsrender.indices import index_catalogue
from wsrender.pipeline.constraints import registry
from wsrender.results import presentation
from wsrender.results.export import formats

GIVEN = {"ws": ws, "np": np}


def examples():
    """The docstrings with examples, of all modules, each a doctest."""
    finder = doctest.DocTestFinder(exclude_empty=True)
    for name, path in sorted(modules().items()):
        if ">>>" in path.read_text(encoding="utf-8"):
            yield from (test for test in finder.find(import_module(name), extraglobs=GIVEN) if test.examples)


EXAMPLES = {test.name: test for test in examples()}


@pytest.mark.parametrize("name", EXAMPLES)
def test_examples_print_what_they_say(name, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    for module, member in (
        (index_catalogue, "_ADDED"),
        (registry, "_ADDED"),
        (formats, "_REGISTERED"),
        (presentation, "_REGISTERED"),
    ):
        monkeypatch.setattr(module, member, {})
    said = []
    runner = doctest.DocTestRunner(verbose=False)
    assert runner.run(EXAMPLES[name], out=said.append).failed == 0, "".join(said)


def test_what_is_no_analysis_has_an_example():
    """Examples of analyses are the README's, the guides' and the gallery's."""
    functions = {name: getattr(ws, name) for name in ws.__all__ if inspect.isfunction(getattr(ws, name))}
    own = {name: function for name, function in functions.items() if function.__module__ != "wsrender.python"}
    assert len(own) >= 14
    assert [name for name, function in own.items() if ">>>" not in (function.__doc__ or "")] == []
