"""The clients by their names and types: one set for both, nothing that is Any, records as the server has them."""

import inspect
import typing
from datetime import datetime

import pytest
import trimesh
import xarray
from pydantic import BaseModel
from wsrender_server.app import catalogue, job_routes, operation
from wsrender_server.problems import Problem, ProblemField
from wsrender_server.routes import job_views

from wsrender import client
from wsrender.client import records, stream_records
from wsrender.documents import kinetostatic_stream

TWINS = [(client.Client, client.AsyncClient), (client.Job, client.AsyncJob), (client.Batch, client.AsyncBatch)]
TYPES = {"trimesh": trimesh, "xarray": xarray}  # which stand in annotations only
ASYNC = {"__enter__": "__aenter__", "__exit__": "__aexit__"}
MESSAGES = [
    (records.JobRecord, job_views.JobView),
    (records.JobLinks, job_views.JobLinks),
    (records.JobProgress, job_views.ProgressView),
    (records.JobWarning, job_views.WarningView),
    (records.Problem, Problem),
    (records.ProblemField, ProblemField),
    (records.Analysis, catalogue.AnalysisView),
    (records.LibraryRobot, catalogue.RobotView),
    (records.Worker, operation.WorkerView),
    (records.Estimate, job_routes.Estimate),
    (stream_records.Opened, kinetostatic_stream.Opened),
    (stream_records.Force, kinetostatic_stream.Force),
    (stream_records.CueValues, kinetostatic_stream.CueValues),
    (stream_records.StreamWarning, kinetostatic_stream.StreamWarning),
    (stream_records.Statistics, kinetostatic_stream.Statistics),
]


def offered(kind):
    """Public members of a class by name, its constructor and what makes it a context manager among them."""
    special = ("__init__", *ASYNC, *ASYNC.values())
    return {name: member for name, member in inspect.getmembers(kind) if name[0] != "_" or name in special}


@pytest.mark.parametrize(("waiting", "awaited"), TWINS, ids=lambda kind: kind.__name__)
def test_both_clients_have_one_set_of_names_and_parameters(waiting, awaited):
    ours, theirs = offered(waiting), offered(awaited)
    theirs = {next((name for name, other in ASYNC.items() if other == key), key): m for key, m in theirs.items()}
    assert ours.keys() == theirs.keys()
    for name, member in ours.items():
        if name == "__init__" and waiting is not client.Client:
            continue  # made by the client
        if inspect.isroutine(member):
            one, other = (
                [(p.name, p.kind, p.default) for p in inspect.signature(each).parameters.values()]
                for each in (member, theirs[name])
            )
            assert one == other, name
        else:
            assert isinstance(member, property) and isinstance(theirs[name], property)


def parts(hint):
    """A type and all that it is made of."""
    yield hint
    for part in typing.get_args(hint):
        yield from parts(part)


@pytest.mark.parametrize("name", client.__all__)
def test_public_signatures_say_what_they_take_and_give(name):
    kind = getattr(client, name)
    own = [each for each in kind.__mro__ if each.__module__.startswith("wsrender.client.")]
    members = {key: member for each in own for key, member in vars(each).items() if key[0] != "_" or key == "__init__"}
    assert members
    for key, member in members.items():
        function = member.fget if isinstance(member, property) else getattr(member, "func", member)
        if not inspect.isroutine(function):
            continue
        function = inspect.unwrap(function)
        hints = typing.get_type_hints(function, localns=TYPES)
        expected = {*inspect.signature(function).parameters} - {"self"} | ({"return"} if key != "__init__" else set())
        assert hints.keys() >= expected, key
        of_library = key == "__init__" and name == "RemoteResult"  # its document is a Result's
        assert of_library or not any(each is typing.Any for hint in hints.values() for each in parts(hint)), key


def of_json(hint):
    """A type of the server as JSON has it, for comparison."""
    if typing.get_origin(hint) is typing.Annotated:
        return of_json(typing.get_args(hint)[0])
    if isinstance(hint, type) and issubclass(hint, BaseModel):
        return dict
    if isinstance(hint, type) and typing.is_typeddict(hint):
        return dict
    if hint is datetime:
        return str
    origin, args = typing.get_origin(hint), typing.get_args(hint)
    if origin in (typing.Required, typing.NotRequired):
        return of_json(args[0])
    if origin is dict:
        return dict
    if origin in (list, tuple):
        return list, of_json(args[0])
    if origin is typing.Literal:
        return frozenset(args)
    if hint is typing.Any:
        return object
    if args:
        return frozenset(of_json(each) for each in args)
    if isinstance(hint, type) and issubclass(hint, str) and hint is not str:  # an enumeration
        return frozenset(each.value for each in hint)
    return hint


@pytest.mark.parametrize(("record", "view"), MESSAGES, ids=lambda each: each.__name__)
def test_records_are_the_servers_views(record, view):
    fields = {field.alias or name: view.model_fields[name] for name, field in view.model_fields.items()}
    hints = typing.get_type_hints(record, include_extras=True)
    assert hints.keys() == fields.keys()
    for name, field in fields.items():
        assert of_json(hints[name]) == of_json(field.annotation), name
