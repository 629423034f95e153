"""The command line around the engine: listing, faults, exit codes, progress, extensions."""

import io
import json
import sys
import time
import warnings
from importlib import import_module
from importlib.metadata import EntryPoint
from types import ModuleType, SimpleNamespace

import pytest
import typer
from typer.main import get_command

import wsrender as ws
from wsrender import cli, extensions
from wsrender.analyses.registry import job_classes
from wsrender.documents.quantities import quoted
from wsrender.errors import InputError, MissingExtraError, ModelError, NumericalError
from wsrender.progress import LINE_EVERY_S, RunProgress
from wsrender.robots import library


@pytest.fixture
def wsrender(capsys):
    """Run the command line: the exit code, standard output and standard error."""

    def run(*arguments):
        with pytest.raises(SystemExit) as ended:
            cli.main(arguments)
        written = capsys.readouterr()
        return ended.value.code, written.out, written.err

    return run


@pytest.fixture
def execute(monkeypatch):
    """Put a function in the place of ``wsrender.run.execute``."""

    def put(function):
        module = ModuleType("wsrender.run")
        module.execute = function
        monkeypatch.setitem(sys.modules, "wsrender.run", module)

    return put


def raising(error):
    def execute(document, progress=None):
        raise error

    return execute


def pip(what, extra):
    return f"error: {MissingExtraError(what, extra)}\n"


def test_version(wsrender):
    assert wsrender("--version") == (0, f"wsrender {ws.__version__}\n", "")


def test_schema(wsrender):
    code, out, _ = wsrender("schema", "indices_at")
    assert (code, json.loads(out)["title"]) == (0, "IndicesAtJob")
    assert (
        wsrender("schema", "--analysis", "indices_at")
        == (0, out, "")
        == wsrender("schema", "indices_at", "--analysis", "indices_at")
    )
    code, _, err = wsrender("schema", "workspace", "--analysis", "indices_at")
    assert (code, err) == (2, "error: analysis: is given twice, as workspace and as indices_at\n")
    assert json.loads(wsrender("schema")[1])["discriminator"]["propertyName"] == "analysis"
    code, _, err = wsrender("schema", "nope")
    assert (code, err) == (2, f'error: analysis: must be one of {quoted(job_classes())}, not "nope"\n')


def test_robots(wsrender):
    code, out, _ = wsrender("robots")
    assert code == 0
    rows = {line.split()[0]: line for line in out.splitlines() if line.strip()}
    assert {"ur5e", "scara", "puma560"} <= set(rows)
    assert rows["scara"].split()[1] == "4"
    assert rows["ur5e"].split()[1:6] == ["6", "Universal", "Robots", "5", "0.85"]
    assert "payload [kg]" in out and "three parallel axes" in rows["ur5e"]


def listed(wsrender, *arguments):
    code, out, _ = wsrender("robots", "--json", *arguments)
    assert code == 0
    return {kind: {robot["name"]: robot for robot in robots} for kind, robots in json.loads(out).items()}


def test_robots_that_are_asked_for(wsrender):
    everything = listed(wsrender)
    assert list(everything["robots"]) == library.names()
    assert everything["robots"]["franka_panda"]["payload_kg"] == 3.0
    assert everything["robots"]["scara"]["maker"] is None and "delta" in everything["mechanisms"]
    for arguments, said, kept in (
        (["universalUR5e"], "aliases", lambda robot: "universalUR5e" in robot["aliases"]),
        (["--joints", "4"], "joints", lambda robot: robot["joints"] == 4),
        (["--payload", "5"], "payload_kg", lambda robot: (robot["payload_kg"] or 0) >= 5),
        (["--reach", "0.84"], "reach_m", lambda robot: (robot["reach_m"] or 0) >= 0.84),
        (["--closed-form", "Parallel"], "closed_form", lambda robot: "parallel" in (robot["closed_form"] or "")),
    ):
        found = listed(wsrender, *arguments)["robots"]
        assert 0 < len(found) < len(everything["robots"]), said
        assert found == {name: robot for name, robot in everything["robots"].items() if kept(robot)}, said


@pytest.mark.parametrize(
    ("error", "code", "line"),
    [
        (ModelError("robot", "has no joints"), 2, "error: robot: has no joints\n"),
        (InputError("tip", "holds [bold] text"), 2, "error: tip: holds [bold] text\n"),
        (NumericalError("a σ is not finite"), 1, "error: a σ is not finite\n"),
        (MissingExtraError("mujoco", "engine"), 1, pip("mujoco", "engine")),
        (ModuleNotFoundError("No module", name="mujoco"), 1, pip("mujoco", "engine")),
        (OSError(28, "No space left on device"), 1, "error: [Errno 28] No space left on device\n"),
        (ZeroDivisionError("by zero"), 1, "error: ZeroDivisionError: by zero (--traceback shows where)\n"),
    ],
)  # fmt: skip
def test_faults_are_one_line(wsrender, execute, error, code, line):
    execute(raising(error))
    assert wsrender("run", "ur5e") == (code, "", line)


def test_ctrl_c_says_what_was_kept(wsrender, execute):
    stopped = KeyboardInterrupt()
    execute(raising(stopped))
    assert wsrender("run", "ur5e") == (130, "", "stopped: nothing was kept\n")
    stopped.add_note("samples, 5 of 9 done; nothing of this run was kept")
    assert wsrender("run", "ur5e")[2] == "stopped: samples, 5 of 9 done; nothing of this run was kept\n"


def test_traceback_on_request(execute):
    execute(raising(ZeroDivisionError("by zero")))
    with pytest.raises(ZeroDivisionError):
        cli.main(["run", "ur5e", "--traceback"])


def test_warnings_are_one_line(wsrender, execute):
    def execute_with_warning(document, progress=None):
        with warnings.catch_warnings():
            warnings.simplefilter("default")
            warnings.warn("geometry was dropped", stacklevel=1)
        raise ModelError("robot", "nothing left")

    execute(execute_with_warning)
    _, _, err = wsrender("run", "ur5e")
    assert err == "warning: geometry was dropped\nerror: robot: nothing left\n"


def test_run_saves_and_prints_the_summary_and_the_files(wsrender, execute, tmp_path):
    seen = {}

    class Result:
        def __init__(self):
            self.document = {"artifacts": [{"name": "volume.vtkhdf", "bytes": 12_345_678}]}

        def save(self, folder, formats):
            seen.update(folder=folder, formats=formats)
            (folder / "result.json").write_bytes(b" " * 1234)

        def summary(self):
            return "manipulability [m³] up to 0.2"

    def execute_job(document, progress=None):
        seen["document"] = document
        progress(1, 2, "sampling")
        return Result()

    execute(execute_job)
    code, out, err = wsrender("run", "ur5e", "-o", str(tmp_path), "--format", "csv", "--format", "npz")
    assert (code, err) == (0, "")
    assert out.splitlines() == [
        "manipulability [m³] up to 0.2",
        f"{tmp_path}/result.json  1.23 kB",
        f"{tmp_path}/volume.vtkhdf  12.3 MB",
    ]
    assert seen["document"] == {"analysis": "workspace", "robot": {"library": "ur5e"}}
    assert (seen["folder"], seen["formats"]) == (tmp_path, ("csv", "npz"))


def test_outputs_that_cannot_be_saved_are_refused_before_the_run(wsrender, execute, tmp_path):
    execute(raising(AssertionError("ran")))
    occupied = tmp_path / "file"
    occupied.write_text("")
    code, _, err = wsrender("run", "ur5e", "-o", str(occupied))
    assert (code, err) == (2, f"error: --output: must be a folder, not the file {occupied}\n")
    code, _, err = wsrender("run", "ur5e", "-o", str(tmp_path), "--format", "pickle")
    allowed = "allowed: npz, csv, mat, vti, stl, obj, svg"
    assert (code, err) == (2, f"error: --format: 'pickle' is not a format that can be added; {allowed}\n")


@pytest.mark.parametrize("command", cli.SERVER_COMMANDS)
def test_server_commands_name_the_pip_command(wsrender, command, monkeypatch):
    monkeypatch.setattr(extensions, "entry_points", lambda group: [])
    code, _, err = wsrender(command, "--port", "8000")
    assert (code, err) == (1, pip("The server", "server"))


def test_every_command_of_the_server_is_known_without_it():
    command = get_command(import_module("wsrender_server.commands").app)
    assert set(cli.SERVER_COMMANDS) == set(command.commands)


def test_extensions_join_the_command_line_only_where_they_are_needed(wsrender, monkeypatch):
    extension = typer.Typer()
    loads = []

    @extension.command("serve")
    def serve(port: int = 1):
        typer.echo(f"serving on {port}")

    @extension.command("keys")
    def keys():
        """Manage keys."""

    def load(self):
        loads.append(self.name)
        return extension

    monkeypatch.setattr(EntryPoint, "load", load)
    found = [EntryPoint("server", "wsrender_server.cli:app", cli.EXTENSIONS)]
    monkeypatch.setattr(extensions, "entry_points", lambda group: found)
    assert wsrender("serve", "--port", "8000") == (0, "serving on 8000\n", "")
    assert "Manage keys." in wsrender("--help")[1]
    loads.clear()
    wsrender("schema")
    assert loads == []


def test_an_extension_whose_requirements_are_missing_names_the_pip_command(wsrender, monkeypatch):
    def load(self):
        raise ModuleNotFoundError("No module named 'fastapi'", name="fastapi")

    monkeypatch.setattr(EntryPoint, "load", load)
    found = [EntryPoint("server", "wsrender_server.cli:app", cli.EXTENSIONS)]
    monkeypatch.setattr(extensions, "entry_points", lambda group: found)
    assert wsrender("--help")[0] == 0
    code, _, err = wsrender("serve")
    assert (code, err) == (1, pip("The server", "server"))


class Terminal(io.StringIO):
    def isatty(self):
        return True


def lines_of(monkeypatch, reports):
    """What progress writes off a terminal when (time, done, message) are reported of 4 million samples."""
    now = SimpleNamespace(value=0.0)
    monkeypatch.setattr("wsrender.progress.time", SimpleNamespace(monotonic=lambda: now.value))
    stream = io.StringIO()
    with RunProgress(stream) as progress:
        for now.value, done, message in reports:
            progress(done, 4_000_000, message)
    return stream.getvalue().splitlines()


def test_work_below_a_second_shows_nothing(monkeypatch):
    assert lines_of(monkeypatch, [(0.0, 0, "planning"), (0.5, 100, "samples"), (0.9, 4_000_000, "samples")]) == []


def test_plain_lines_off_a_terminal_do_not_count_planning_in_the_rate(monkeypatch):
    reports = [
        (0.0, 0, "planning"),
        (10.0, 0, "samples"),
        (12.0, 1_000_000, "samples"),
        (12.1, 1_100_000, "samples"),
        (12.0 + LINE_EVERY_S, 3_500_000, "samples"),
    ]
    assert lines_of(monkeypatch, reports) == [
        "samples: 25 %, 1e+06, 5e+05/s, 6 s left",
        "samples: 88 %, 3.5e+06, 5e+05/s, 1 s left",
    ]


def test_bar_on_a_terminal_appears_after_the_quiet_time(monkeypatch):
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr("wsrender.progress.QUIET_S", 0.05)
    quick, slow = Terminal(), Terminal()
    with RunProgress(quick) as progress:
        progress(1, 2, "samples")
    with RunProgress(slow) as progress:
        progress(0, 4_000_000, "samples")
        time.sleep(0.3)
        progress(2_000_000, 4_000_000, "samples")
        time.sleep(0.3)
    assert "samples" not in quick.getvalue()
    assert "50 %" in slow.getvalue()
    assert "/s" in slow.getvalue()
