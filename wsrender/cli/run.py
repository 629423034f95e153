"""``wsrender run``: a job document, or one built from a robot and options, executed and saved."""

from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console

from wsrender.cli.faults import one_line_faults
from wsrender.cli.job_options import job_document, name_or_list, sampling_document
from wsrender.errors import InputError
from wsrender.progress import RunProgress

_SAMPLING = "Sampling"
_ANALYSIS = "Analysis"


def run(
    job: Annotated[
        str, typer.Argument(metavar="JOB", help="Job document (.json), robot file or robot name.")
    ],
    output: Annotated[Path, typer.Option("--output", "-o", help="Folder for the results.")] = Path("out"),
    tip: Annotated[str | None, typer.Option(help="Site, body or link at the end of the chain.")] = None,
    base: Annotated[str | None, typer.Option(help="Body or link at which the chain starts.")] = None,
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
    precision: Annotated[
        str | None, typer.Option(help="float32 or float64.", rich_help_panel=_ANALYSIS)
    ] = None,
    device: Annotated[
        str | None, typer.Option(help="auto, cpu, cuda or cuda:N.", rich_help_panel=_ANALYSIS)
    ] = None,
    keep_map: Annotated[
        bool, typer.Option("--keep-map", help="Keep one row per sample (map.parquet).")
    ] = False,
    formats: Annotated[
        list[str] | None, typer.Option("--format", help="Also write npz, csv, mat, stl or svg; repeatable.")
    ] = None,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Print the job document and stop: it can be run again.")
    ] = False,
    traceback: Annotated[bool, typer.Option("--traceback", help="Show where an error came from.")] = False,
) -> None:
    """Analyse a robot; write the result document, volume, surface and pictures to a folder.

    Options override the fields of a job document.
    """
    with one_line_faults(traceback):
        document = job_document(job)
        given = {
            "tip": tip,
            "base": base,
            "sampling": sampling_document(
                document.get("sampling"), sampling, grid, samples, seed, lock or []
            ),
            "indices": name_or_list(indices, ("kinematic", "dynamic", "all")),
            "task": name_or_list(task, ("linear", "angular", "full")),
            "convention": convention,
            "voxel_size_m": voxel_size,
            "precision": precision,
            "device": device,
            "keep_map": keep_map or None,
        }
        document.update({field: value for field, value in given.items() if value is not None})
        if dry_run:
            _print_job(document)
        else:
            _check_output(output, tuple(formats or ()))
            _execute(document, output, tuple(formats or ()))


def _print_job(document: dict[str, Any]) -> None:
    import json

    from wsrender.spec import canonical_json, parse_job

    typer.echo(json.dumps(json.loads(canonical_json(parse_job(document))), indent=2))


def _check_output(output: Path, formats: tuple[str, ...]) -> None:
    """Refuse before a long run what saving would refuse after it."""
    from wsrender.result import EXTRA_FORMATS, STANDARD_FORMATS

    if output.exists() and not output.is_dir():
        raise InputError("--output", f"must be a folder, not the file {output}")
    for name in formats:
        if name not in STANDARD_FORMATS + EXTRA_FORMATS:
            raise InputError("--format", f'must be one of {", ".join(EXTRA_FORMATS)}, not "{name}"')


def _execute(document: dict[str, Any], output: Path, formats: tuple[str, ...]) -> None:
    from wsrender.run import execute

    with RunProgress() as progress:
        result = execute(document, progress=progress)
    result.save(output, formats=formats)
    console = Console(soft_wrap=True, highlight=False, markup=False)
    console.print(result.summary())
    for artifact in result.document["artifacts"]:
        console.print(f"{output / artifact['name']}  {_size(artifact['bytes'])}")


def _size(count: float) -> str:
    """Bytes in decimal units, three digits."""
    for unit in ("B", "kB", "MB"):
        if count < 1000:
            return f"{count:.3g} {unit}"
        count /= 1000
    return f"{count:.3g} GB"
