"""``wsrender run``, and what commands take that take a job: a document, or a robot and options for the common case."""

import inspect
import json
from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import Annotated, Any

import typer

from wsrender.cli.faults import one_line_faults
from wsrender.cli.job_options import corrected_robot, job_document, name_or_list, sampling_document
from wsrender.cli.saving import Formats, check_output, save_and_report
from wsrender.progress import RunProgress

_SAMPLING = "Sampling"
_ANALYSIS = "Analysis"


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
    job: Annotated[str, typer.Argument(metavar="JOB", help="Job document (.json), robot file or robot name.")],
    tip: Annotated[str | None, typer.Option(help="Site, body or link at the end of the chain.")] = None,
    base: Annotated[str | None, typer.Option(help="Body or link at which the chain starts.")] = None,
    limits: Annotated[
        list[str] | None,
        typer.Option(help="JOINT=LOWER,UPPER instead of the model's limits, in rad or m; repeatable."),
    ] = None,
    length_unit_m: Annotated[
        float | None, typer.Option(help="The model's unit of length in metres; 1 confirms metres.")
    ] = None,
    sampling: Annotated[
        str | None, typer.Option(help="grid, random, sobol, boundary or converge.", rich_help_panel=_SAMPLING)
    ] = None,
    grid: Annotated[
        str | None, typer.Option(help="Samples per joint: N, or N,N,… by joint.", rich_help_panel=_SAMPLING)
    ] = None,
    samples: Annotated[
        str | None,
        typer.Option(help="Number of samples, such as 1e6 (Sobol by default).", rich_help_panel=_SAMPLING),
    ] = None,
    seed: Annotated[int | None, typer.Option(help="Seed of the samples.", rich_help_panel=_SAMPLING)] = None,
    lock: Annotated[
        list[str] | None,
        typer.Option(help="JOINT=VALUE held still, in rad or m; repeatable.", rich_help_panel=_SAMPLING),
    ] = None,
    indices: Annotated[
        str | None,
        typer.Option(help="kinematic, dynamic, all, or names: a,b,c.", rich_help_panel=_ANALYSIS),
    ] = None,
    task: Annotated[
        str | None,
        typer.Option(help="linear, angular, full, or rows such as x,y.", rich_help_panel=_ANALYSIS),
    ] = None,
    convention: Annotated[
        str | None, typer.Option(help="standard, table_1 or wsrender_code.", rich_help_panel=_ANALYSIS)
    ] = None,
    voxel_size: Annotated[
        float | None, typer.Option(help="Edge of a voxel in metres.", rich_help_panel=_ANALYSIS)
    ] = None,
    precision: Annotated[str | None, typer.Option(help="float32 or float64.", rich_help_panel=_ANALYSIS)] = None,
    device: Annotated[str | None, typer.Option(help="auto, cpu, cuda or cuda:N.", rich_help_panel=_ANALYSIS)] = None,
    keep_map: Annotated[bool, typer.Option("--keep-map", help="Keep one row per sample (map.parquet).")] = False,
) -> dict[str, Any]:
    """The job document that JOB and the options say; options override the fields of a document."""
    from wsrender.documents.sampling import DEFAULT_COUNT, SEVERAL_COUNT

    document = job_document(job)
    count = SEVERAL_COUNT if keep_map else DEFAULT_COUNT
    given = {
        "robot": corrected_robot(document, limits or [], length_unit_m),
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
