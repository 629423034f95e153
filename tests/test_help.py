"""What a newcomer asks at a prompt: help that is short, and words for a keyword that is wrong."""

import inspect
import pydoc

import numpy as np
import pytest

import wsrender as ws
from wsrender.documents.document import Document

LONGEST = 60  # lines
DOCUMENTS = sorted(
    name for name in ws.__all__ if inspect.isclass(kind := getattr(ws, name)) and issubclass(kind, Document)
)
FUNCTIONS = sorted(name for name in ws.__all__ if inspect.isfunction(getattr(ws, name)))


@pytest.mark.parametrize("name", DOCUMENTS)
def test_help_on_a_document_is_short_and_names_its_fields(name):
    kind = getattr(ws, name)
    text = pydoc.plain(pydoc.render_doc(kind))
    assert len(text.splitlines()) <= LONGEST
    assert " at 0x" not in text and "Annotated" not in text and "model_dump" not in text
    head = next(line for line in text.splitlines() if line.startswith(f" |  {name}("))
    assert all(field in head for field in kind.model_fields if field not in ("method", "locked"))


def test_help_on_sobol():
    text = pydoc.plain(pydoc.render_doc(ws.Sobol))
    assert "Sobol(count: int, seed: int = 0, *, locked: Mapping[str, float] | None = None" in text


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_function_says_which_keyword_may_be_meant(name):
    function = getattr(ws, name)
    parameters = inspect.signature(function).parameters.values()
    keywords = [each.name for each in parameters if each.kind in (each.KEYWORD_ONLY, each.POSITIONAL_OR_KEYWORD)]
    if any(each.kind is each.VAR_KEYWORD for each in parameters):
        keywords = []  # they go on into a document, which says it
    for keyword in keywords:
        wrong = f"{keyword[:-1]}x{keyword[-1]}"
        with pytest.raises(TypeError, match=rf"\w+\(\) has no parameter {wrong}; did you mean {keyword}\?"):
            function(**{wrong: 1})


def test_methods_and_constructors_say_it_too():
    arm = ws.load_robot("scara")
    result = ws.indices_at(arm, np.zeros((1, 4)))
    wrong = {
        "did you mean precision": lambda: arm.jacobian([0] * 4, precison="float32"),
        "did you mean token": lambda: ws.Client(tokn="a"),
        "did you mean formats": lambda: result.save("out", format=["vti"]),
        "did you mean per_joint": lambda: ws.Grid(perjoint=3),
        "did you mean max_samples": lambda: ws.Converge(maxsamples=3),
        "did you mean limits_rad": lambda: ws.FiveBar(1, (1, 1), (1, 1), limit_rad=None),
        "did you mean seed": lambda: ws.Sobol(10, sed=1),
        "did you mean size_m": lambda: ws.Box(siz_m=(1, 1, 1)),
        "did you mean source": lambda: ws.Index("a", "b", None, sourc="c"),
    }
    for words, call in wrong.items():
        with pytest.raises((TypeError, ws.InputError), match=words):
            call()


def test_what_is_right_is_called():
    assert ws.load_robot(source="scara", name="mine").name == "mine"
    assert ws.Grid(per_joint=3).per_joint == 3
