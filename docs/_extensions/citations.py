"""Sources as items of a list: docutils gives them a role that browsers no longer take for one."""

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.writers.html5 import HTML5Translator


def visit(translator: HTML5Translator, node: nodes.citation) -> None:
    """Begin a source as docutils does, within a list if it is the first."""
    type(translator).visit_citation(translator, node)
    translator.body[-1] = translator.body[-1].replace('role="doc-biblioentry"', 'role="listitem"')


def depart(translator: HTML5Translator, node: nodes.citation) -> None:
    """End a source as docutils does."""
    type(translator).depart_citation(translator, node)


def setup(app: Sphinx) -> dict:
    """Take the place of docutils' way."""
    app.add_node(nodes.citation, override=True, html=(visit, depart))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
