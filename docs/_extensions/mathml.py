"""Formulas as MathML, written at build by docutils: pages need no script and no network; screen readers read them."""

import re

from docutils import nodes
from docutils.utils.math import MathError
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.writers.html5 import HTML5Translator

log = logging.getLogger(__name__)

_SPACE = '<mspace width="0.17em"/>'
_FACTOR = r"</(?:mn|mi|msub|msup|msqrt|mfrac)>\s*"  # before a function, in "338 arccos x"
_FUNCTION = r"<mi[^>]*>[a-z]{2,}</mi>\s*<mo>&ApplyFunction;</mo>\s*"


def spaced(formula: str) -> str:
    """MathML with thin spaces around names of functions, as TeX sets them; browsers set none."""
    formula = re.sub(f"({_FACTOR})(?={_FUNCTION})", rf"\1{_SPACE}", formula)
    return re.sub(rf"({_FUNCTION})(?!(?:<mrow>\s*)?<mo[^>]*>[(\[])", rf"\1{_SPACE}", formula)


def _mathml(node: nodes.math | nodes.math_block, as_block: bool) -> str:
    """The formula of a node; one that cannot be read is a warning, and so an error of a build with -W."""
    try:
        return spaced(tex2mathml(node.astext(), as_block=as_block))
    except MathError as fault:
        log.warning("formula %r: %s", node.astext(), fault, location=node)
        return ""


def inline(translator: HTML5Translator, node: nodes.math) -> None:
    """Write a formula in a sentence."""
    translator.body.append(_mathml(node, as_block=False))
    raise nodes.SkipNode


def block(translator: HTML5Translator, node: nodes.math_block) -> None:
    """Write a formula that stands by itself; one that is wider than a phone scrolls."""
    translator.body.append(f'<div class="math-block" tabindex="0">{_mathml(node, as_block=True)}</div>')
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict:
    """Register the renderer; ``html_math_renderer = "mathml"`` chooses it."""
    app.add_html_math_renderer("mathml", inline_renderers=(inline, None), block_renderers=(block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
