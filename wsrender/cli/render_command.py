"""``wsrender render`` and ``wsrender report``: a 3-D picture and an HTML page of saved results."""

from pathlib import Path
from typing import Annotated, Any

import typer

from wsrender.cli.completion import VIEWS, one_of
from wsrender.cli.faults import one_line_faults
from wsrender.errors import InputError
from wsrender.results.export.formats import by_ending, rows, suffixes
from wsrender.results.export.formats import one_of as listed

_SURROUNDINGS = "Surroundings"
_ENDINGS = listed(f".{suffix}" for suffix in suffixes(rows("picture", own=True)))


def render(
    folder: Annotated[Path, typer.Argument(metavar="FOLDER", help="Folder of a saved result.")],
    output: Annotated[Path, typer.Option("--output", "-o", help=f"Picture to write, {_ENDINGS}.")] = Path("view.png"),
    view: Annotated[
        str, typer.Option(help="boundary, solid, scatter, volume, slice or isosurface.", autocompletion=one_of(*VIEWS))
    ] = "boundary",
    other: Annotated[
        list[Path] | None, typer.Option("--with", help="Folder of a result to draw in the same box; repeatable.")
    ] = None,
    index: Annotated[str | None, typer.Option(help="Index that gives the colours; by default the first.")] = None,
    statistic: Annotated[str | None, typer.Option(help="maximum, mean, minimum or count, of a voxel.")] = None,
    threshold: Annotated[float, typer.Option(help="Iso-surface, as a share of the maximum.")] = 0.9,
    alpha: Annotated[float | None, typer.Option(help="1: opaque; by default 0.1, of a coloured boundary 1.")] = None,
    x: Annotated[float | None, typer.Option(help="Slice normal to x [m].")] = None,
    y: Annotated[float | None, typer.Option(help="Slice normal to y [m].")] = None,
    z: Annotated[float | None, typer.Option(help="Slice normal to z [m].")] = None,
    azimuth: Annotated[float, typer.Option(help="Direction of the eye about z, from x [deg].")] = -58.0,
    elevation: Annotated[float, typer.Option(help="Height of the eye [deg].")] = 24.0,
    robot: Annotated[str | None, typer.Option(help="The result's robot, by file or name: draws its links.")] = None,
    floor: Annotated[float | None, typer.Option(help="Height of a floor [m].", rich_help_panel=_SURROUNDINGS)] = None,
    table: Annotated[
        list[str] | None,
        typer.Option(help="X,Y,Z of the top's middle, size along x, y [m]; repeatable.", rich_help_panel=_SURROUNDINGS),
    ] = None,
    box: Annotated[
        list[str] | None,
        typer.Option(help="X,Y,Z of its centre, size along x, y, z [m]; repeatable.", rich_help_panel=_SURROUNDINGS),
    ] = None,
    traceback: Annotated[bool, typer.Option("--traceback", help="Show where an error came from.")] = False,
) -> None:
    """Draw the workspace of a saved result in three dimensions (needs the extra "render")."""
    with one_line_faults(traceback):
        from wsrender.results.render import Box, Floor, Table
        from wsrender.results.result import Result

        environment: list[Any] = [] if floor is None else [Floor(floor)]
        for cx, cy, cz, dx, dy in (_numbers("--table", text, 5) for text in table or []):
            environment.append(Table((cx, cy, cz), (dx, dy), floor or 0.0))
        for cx, cy, cz, dx, dy, dz in (_numbers("--box", text, 6) for text in box or []):
            environment.append(Box((cx, cy, cz), (dx, dy, dz)))
        _check_output(output)
        Result.load(folder).render(
            view,
            output,
            others=[Result.load(path) for path in other or []],
            robot=robot,
            index=index,
            statistic=statistic,
            threshold=threshold,
            alpha=alpha,
            at=(x, y, z),
            environment=environment,
            azimuth_deg=azimuth,
            elevation_deg=elevation,
        )
        typer.echo(output)


def _check_output(output: Path) -> None:
    """Refuse before the picture is drawn what writing it would refuse after."""
    by_ending("picture", output, "--output")
    if not output.absolute().parent.is_dir():
        raise InputError("--output", f"the folder {output.parent} does not exist")


def _numbers(option: str, text: str, count: int) -> tuple[float, ...]:
    try:
        numbers = tuple(float(part) for part in text.split(","))
    except ValueError:
        numbers = ()
    if len(numbers) != count:
        raise InputError(option, f'must be {count} numbers separated by commas, not "{text}"')
    return numbers


def report(
    folder: Annotated[Path, typer.Argument(metavar="FOLDER", help="Folder of a saved result.")],
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Page to write; by default report.html in FOLDER.")
    ] = None,
    view: Annotated[
        list[str] | None,
        typer.Option(
            help="3-D picture to show, as in `wsrender render`; repeatable. By default boundary, isosurface.",
            autocompletion=one_of(*VIEWS),
        ),
    ] = None,
    flat: Annotated[bool, typer.Option("--flat", help="No 3-D pictures.")] = False,
    traceback: Annotated[bool, typer.Option("--traceback", help="Show where an error came from.")] = False,
) -> None:
    """Write one HTML page about a saved result: pictures, tables, provenance and job document."""
    with one_line_faults(traceback):
        from wsrender.results.export.headline import head_lines
        from wsrender.results.result import REPORT_VIEWS, Result

        path = output or folder / "report.html"
        result = Result.load(folder)
        result.report(path, () if flat else view or REPORT_VIEWS)
        for line in head_lines(result.document):
            typer.echo(line, err=True)  # the path alone is for programs
        typer.echo(path)
