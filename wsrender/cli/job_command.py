"""``wsrender run``, and what commands take that take a job: a document, or a robot and options for the common case."""

import inspect
import json
from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import Annotated, Any

import typer

from wsrender.cli import completion
from wsrender.cli.faults import one_line_faults
from wsrender.cli.saving import Formats, check_output, save_and_report
from wsrender.errors import InputError
from wsrender.progress import RunProgress

_SAMPLING = "Sampling"
_ANALYSIS = "Analysis"
ROBOT_FILES = (".xml", ".mjcf", ".urdf", ".xacro", ".sdf", ".world", ".zip")
COUNTED_METHODS = ("random", "sobol", "boundary")


def job_command(command: Callable[..., None]) -> Callable[..., None]:
    """Give a command the argument JOB and every option that writes a job document.

    ``command`` is called with the document first, then with its own options. ``--dry-run`` prints the document
    instead, ``--traceback`` lets errors through.
    """
    own = list(inspect.signature(command).parameters.values())[1:]
    written = list(inspect.signature(_document).parameters.values())
    switches = list(inspect.signature(_switches).parameters.values())

    @wraps(command)
    def whole(*, traceback: bool, dry_run: bool, **values: Any) -> None:
        with one_line_faults(traceback):
            document = _document(**{option.name: values.pop(option.name) for option in written})
            if dry_run:
                _print_job(document)
            else:
                command(document, **values)

    parameters = [written[0], *own, *written[1:], *switches]
    # A call by name only: the order is that of the help text, options without a default may come late.
    parameters = [option.replace(kind=inspect.Parameter.KEYWORD_ONLY) for option in parameters]
    whole.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    whole.__annotations__ = {option.name: option.annotation for option in parameters}
    return whole


def _document(
    job: Annotated[
        str,
        typer.Argument(
            metavar="JOB",
            help="Job document (.json), robot name, robot file, ZIP or ./folder.",
            autocompletion=completion.job,
        ),
    ],
    tip: Annotated[str | None, typer.Option(help="Site, body or link at the end of the chain.")] = None,
    base: Annotated[str | None, typer.Option(help="Body or link at which the chain starts.")] = None,
    limits: Annotated[
        list[str] | None, typer.Option(help="JOINT=LOWER,UPPER instead of the model's limits, in rad or m; repeatable.")
    ] = None,
    length_unit_m: Annotated[
        float | None, typer.Option(help="The model's unit of length in metres; 1 confirms metres.")
    ] = None,
    package: Annotated[
        list[str] | None, typer.Option(help="NAME=FOLDER of a ROS package, for package://; repeatable.")
    ] = None,
    xacro: Annotated[list[str] | None, typer.Option(help="NAME=VALUE of a xacro file's argument; repeatable.")] = None,
    entry: Annotated[str | None, typer.Option(help="Which file of a ZIP or folder is the model.")] = None,
    sampling: Annotated[
        str | None,
        typer.Option(
            help="grid, random, sobol, boundary or converge.",
            rich_help_panel=_SAMPLING,
            autocompletion=completion.sampling,
        ),
    ] = None,
    grid: Annotated[
        str | None, typer.Option(help="Samples per joint: N, or N,N,… by joint.", rich_help_panel=_SAMPLING)
    ] = None,
    samples: Annotated[
        str | None, typer.Option(help="Number of samples, such as 1e6 (Sobol by default).", rich_help_panel=_SAMPLING)
    ] = None,
    seed: Annotated[int | None, typer.Option(help="Seed of the samples.", rich_help_panel=_SAMPLING)] = None,
    lock: Annotated[
        list[str] | None,
        typer.Option(help="JOINT=VALUE held still, in rad or m; repeatable.", rich_help_panel=_SAMPLING),
    ] = None,
    indices: Annotated[
        str | None,
        typer.Option(
            help="kinematic, dynamic, all, or names: a,b,c.",
            rich_help_panel=_ANALYSIS,
            autocompletion=completion.indices,
        ),
    ] = None,
    task: Annotated[
        str | None,
        typer.Option(
            help="linear, angular, full, or rows such as x,y.",
            rich_help_panel=_ANALYSIS,
            autocompletion=completion.one_of("linear", "angular", "full"),
        ),
    ] = None,
    convention: Annotated[
        str | None,
        typer.Option(
            help="standard, table_1 or wsrender_code.",
            rich_help_panel=_ANALYSIS,
            autocompletion=completion.one_of("standard", "table_1", "wsrender_code"),
        ),
    ] = None,
    voxel_size: Annotated[
        float | None, typer.Option(help="Edge of a voxel in metres.", rich_help_panel=_ANALYSIS)
    ] = None,
    precision: Annotated[
        str | None,
        typer.Option(
            help="float32 or float64.",
            rich_help_panel=_ANALYSIS,
            autocompletion=completion.one_of("float32", "float64"),
        ),
    ] = None,
    device: Annotated[
        str | None,
        typer.Option(
            help="auto, cpu, cuda or cuda:N.",
            rich_help_panel=_ANALYSIS,
            autocompletion=completion.one_of("auto", "cpu", "cuda"),
        ),
    ] = None,
    keep_map: Annotated[bool, typer.Option("--keep-map", help="Keep one row per sample (map.parquet).")] = False,
) -> dict[str, Any]:
    """The job document that JOB and the options say; options override the fields of a document."""
    from wsrender.documents.sampling import DEFAULT_COUNT, SEVERAL_COUNT

    document = job_document(job)
    count = SEVERAL_COUNT if keep_map else DEFAULT_COUNT
    given = {
        "robot": corrected_robot(document, limits or [], length_unit_m, package or [], xacro or [], entry),
        "tip": tip,
        "base": base,
        "sampling": sampling_document(document.get("sampling"), sampling, grid, samples, seed, lock or [], count),
        "indices": name_or_list(indices, ("kinematic", "dynamic", "all")),
        "task": name_or_list(task, ("linear", "angular", "full")),
        "convention": convention,
        "voxel_size_m": voxel_size,
        "precision": precision,
        "device": device,
        "keep_map": keep_map or None,
    }
    return document | {field: value for field, value in given.items() if value is not None}


def _switches(
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Print the job document and stop: it can be run again.")
    ] = False,
    traceback: Annotated[bool, typer.Option("--traceback", help="Show where an error came from.")] = False,
) -> None:
    """What every such command has."""


def _print_job(document: dict[str, Any]) -> None:
    from wsrender.analyses.jobs import canonical_json, parse_job

    typer.echo(json.dumps(json.loads(canonical_json(parse_job(document))), indent=2))


@job_command
def run(
    document: dict[str, Any],
    output: Annotated[Path, typer.Option("--output", "-o", help="Folder for the results.")] = Path("out"),
    formats: Formats = None,
) -> None:
    """Analyse a robot; write the result document, volume, surface and pictures to a folder.

    Options override the fields of a job document.
    """
    check_output(output, formats)
    from wsrender.run import execute

    with RunProgress() as progress:
        result = execute(document, progress=progress)
    save_and_report(result, output, formats)


def job_document(job: str) -> dict[str, Any]:
    """The document of a JOB argument: read from a .json file, or about a robot file or library robot.

    Raises InputError where the file cannot be read, DocumentError where it is not JSON.
    """
    path = Path(job)
    if path.suffix == ".json":
        from wsrender.documents.reading import read_json

        document = read_json(_read(path))
        if not isinstance(document, dict):
            raise InputError("JOB", f"{job} must hold an object, not {type(document).__name__}")
        return document
    if _of_collection(job):
        return {"analysis": "workspace", "robot": _named_robot(job)}
    folder = path.is_dir() and ("/" in job or "\\" in job)  # one beside us may have the name of a library robot
    source = "path" if path.suffix.lower() in ROBOT_FILES or path.is_file() or folder else "library"
    return {"analysis": "workspace", "robot": {source: job}}


def _of_collection(job: str) -> bool:
    from wsrender.robots import named_models

    return named_models.collection_of(job) is not None


def _named_robot(job: str) -> dict[str, Any]:
    """The part of a document of a robot that a collection has."""
    from wsrender.robots import named_models

    named = named_models.find(job)
    given = {"path": str(named.path), "xacro": named.xacro, "packages": named.packages}
    return {field: value for field, value in given.items() if value}


def corrected_robot(
    document: dict[str, Any],
    limits: list[str],
    length_unit_m: float | None,
    packages: list[str] | tuple[str, ...] = (),
    xacro: list[str] | tuple[str, ...] = (),
    entry: str | None = None,
) -> dict[str, Any] | None:
    """The robot of a document with limits, unit of length and how its file is read from options; None without options.

    Raises InputError naming the option, and for a document that has not one robot.
    """
    options = {"--limits": limits, "--length-unit-m": length_unit_m, "--package": packages, "--xacro": xacro}
    options["--entry"] = entry
    named = [option for option, value in options.items() if value not in (None, [], ())]
    if not named:
        return None
    robot: Any = document.get("robot")
    robot = {"library": robot} if isinstance(robot, str) else robot
    if not isinstance(robot, dict):
        raise InputError(named[0], "goes with a job of one robot")
    given: dict[str, Any] = {"entry": entry, "length_unit_m": length_unit_m}
    given["limits"] = robot.get("limits", {}) | dict(_limits(text) for text in limits)
    given["packages"] = robot.get("packages", {}) | dict(_named("--package", text) for text in packages)
    given["xacro"] = robot.get("xacro", {}) | dict(_named("--xacro", text) for text in xacro)
    return robot | {field: value for field, value in given.items() if value}


def _named(option: str, text: str) -> tuple[str, str]:
    name, equals, value = text.partition("=")
    if not equals or not name:
        raise InputError(option, f'must be NAME=VALUE, not "{text}"')
    return name, value


def sampling_document(
    current: Any,
    method: str | None,
    grid: str | None,
    samples: str | None,
    seed: int | None,
    lock: list[str],
    count: int,
) -> dict[str, Any] | None:
    """The sampling that the options ask for, on top of that of the document; None without options.

    A grid size chooses the grid, anything else the Sobol sequence; ``count``: its samples where none are given.
    Raises InputError naming the option.
    """
    if not lock and all(option is None for option in (method, grid, samples, seed)):
        return None
    if grid is not None and (samples is not None or method in COUNTED_METHODS):
        raise InputError("--grid", "does not go with --samples, nor with a method that takes a number of samples")
    fields: dict[str, Any] = dict(current) if isinstance(current, dict) else {"method": "sobol"}
    if method is None and grid is not None:
        method = "grid"
    if method is None and samples is not None and fields.get("method") not in COUNTED_METHODS:
        method = "sobol"
    if method is not None and method != fields.get("method"):
        counted = {"count": fields["count"]} if "count" in fields and method in COUNTED_METHODS else {}
        fields = {"method": method, **counted, "locked": fields.get("locked", {})}
    if grid is not None:
        counts = [_number("--grid", text) for text in grid.split(",")]
        fields["per_joint"] = counts if len(counts) > 1 else counts[0]
    if samples is not None:
        fields["count"] = _number("--samples", samples)
    if fields["method"] in COUNTED_METHODS:
        fields.setdefault("count", count)
    if seed is not None:
        fields["seed"] = seed
    if lock:
        fields["locked"] = {**fields.get("locked", {}), **dict(_locked(text) for text in lock)}
    return fields


def name_or_list(text: str | None, names: tuple[str, ...]) -> str | list[str] | None:
    """One of the names as it is; anything else as a list separated by commas; None stays None."""
    return text if text is None or text in names else [name.strip() for name in text.split(",")]


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise InputError("JOB", f"{path} cannot be read: {error.strerror}") from None


def _locked(text: str) -> tuple[str, float]:
    joint, equals, value = text.rpartition("=")
    if not equals or not joint:
        raise InputError("--lock", f'must be JOINT=VALUE, not "{text}"')
    return joint, _number("--lock", value)


def _limits(text: str) -> tuple[str, list[float]]:
    joint, equals, ends = text.rpartition("=")
    if not equals or not joint or ends.count(",") != 1:
        raise InputError("--limits", f'must be JOINT=LOWER,UPPER, not "{text}"')
    return joint, [_number("--limits", end) for end in ends.split(",")]


def _number(option: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InputError(option, f'must be a number, not "{text}"') from None
