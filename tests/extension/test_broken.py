"""A package that is broken: one warning for each entry point, all else works, and who asks for it learns why."""

import warnings

import pytest

import wsrender as ws
from wsrender.analyses import registry
from wsrender.documents.constraints import Constraints
from wsrender.indices import KINEMATIC, catalogue
from wsrender.pipeline.constraints.registry import added_constraints, constraints_of
from wsrender.results.export import formats
from wsrender.results.presentation import all_pictures

ABSENT = "No module named 'no_such_module'"
WORKSPACE = {"analysis": "workspace", "robot": "scara", "sampling": {"method": "grid", "per_joint": 3}, "device": "cpu"}
REASONS = {
    "analyses": {
        "absent_module": ABSENT,
        "no_entry": "must be an Entry, not str",
        "no_job": "must be a class of documents",
        "other_name": 'WorkspaceJob must have the field analysis: Literal["other_name"] = "other_name"',
        "workspace": "there is an analysis 'workspace' already",
    },
    "constraints": {
        "absent": ABSENT,
        "function": "must be an ExpressionConstraint, not function",
        "taken": "'region' is not allowed",
        "untraceable": "wavy cannot be compiled",
    },
    "formats": {
        "absent": ABSENT,
        "taken": "volumes have a format 'vti' already, wsrender's own",
        "text": "must be a wsrender.Format, not str",
    },
    "indices": {
        "absent": ABSENT,
        "needy": "heavy needs gravity",
        "number": "'int' object is not iterable",
        "taken": "there is an index 'manipulability' already",
        "twice": "there is an index 'largest' already",
    },
    "pictures": {
        "absent": ABSENT,
        "needy": "'curve.scan' is none of samples, volume",
        "part": "'samples.x' is none of samples, volume",
        "taken": "there is a picture 'aspects' already, wsrender's own",
        "text": "must be a wsrender.Picture, not str",
        "upper": "'Upper' is not allowed",
    },
}


def read(group):
    """What a table holds."""
    return {
        "analyses": lambda: list(registry.job_classes()),
        "constraints": lambda: list(added_constraints()),
        "formats": formats.table,
        "indices": lambda: list(catalogue()),
        "pictures": lambda: list(all_pictures()),
    }[group]()


@pytest.mark.parametrize("group", REASONS)
def test_each_entry_point_is_a_warning_that_names_it(group, installed):
    whole = read(group)
    installed("broken")
    with pytest.warns(UserWarning) as warned:
        assert read(group) == whole
    texts = sorted(text for text in (str(each.message) for each in warned) if f" of wsrender.{group} in " in text)
    for text, (name, reason) in zip(texts, REASONS[group].items(), strict=True):
        start = f"the entry point '{name}' of wsrender.{group} in the package broken-lab is left out: "
        assert text.startswith(start) and reason in text and text.endswith("; repair or uninstall broken-lab")
    assert read(group) == whole  # and is not warned of again


@pytest.mark.parametrize(
    ("group", "ask", "field"),
    [
        ("analyses", lambda: ws.execute({"analysis": "absent_module", "robot": "scara"}), "analysis"),
        ("constraints", lambda: constraints_of(Constraints(wavy=True)), "constraints.wavy"),
        ("constraints", lambda: ws.execute(WORKSPACE | {"constraints": {"wavy": {}}}), "constraints.wavy"),
        ("formats", lambda: formats.check_asked(["voxels"]), "formats"),
        ("formats", lambda: formats.by_ending("volume", "a.voxels"), "path"),
        ("pictures", lambda: ws.Result({"analysis": "workspace"}).plot("needy"), "picture"),
        ("indices", lambda: ws.execute(WORKSPACE | {"indices": ["heavy"]}), "indices"),
    ],
)
def test_who_names_something_of_it_learns_why(group, ask, field, installed):
    installed("broken")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with pytest.raises(ws.InputError) as raised:
            ask()
    assert raised.value.field == field
    for name, reason in REASONS[group].items():
        start = f"; the entry point '{name}' of wsrender.{group} in the package broken-lab is left out: "
        assert start in str(raised.value) and reason in str(raised.value)


def test_the_rest_works(installed):
    installed("broken")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        region = {"region": {"sphere": {"radius_m": 9}}}
        result = ws.execute(WORKSPACE | {"indices": "kinematic", "constraints": region})
    assert list(result.document["indices"]) == list(KINEMATIC)


def test_the_command_line_works_and_says_so(installed, wsrender):
    installed("broken")
    with warnings.catch_warnings():
        warnings.simplefilter("default")
        code, out, err = wsrender("--help")
    assert code == 0 and "serve" in out
    start = "warning: the entry point 'absent' of wsrender.commands in the package broken-lab is left out: "
    assert err.splitlines()[0].startswith(start) and len(err.splitlines()) == 2
    assert "must be a typer.Typer, not function" in err
