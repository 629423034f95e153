"""The table of file formats: what each holds, its media type, what writes and what reads it.

Library, command line and server read this table; none of them names a format. Another package adds a row through the
entry-point group ``wsrender.formats``, whose entries are ``Format`` objects, a program through ``register_format``.
"""

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path, PurePosixPath
from typing import Any, Literal

from wsrender.errors import InputError, MissingExtraError
from wsrender.extensions import left_out, load
from wsrender.keywords import keywords
from wsrender.short_repr import short_repr

EXTENSIONS = "wsrender.formats"  # entry points, loaded when the table is first read
GLB_FRAME = "world, +Y up"
STORED = ("kept", "always")  # what is written of every result

# What a file may hold, and what its writer gets and its reader returns.
KINDS = {
    "table": "maps and tables",  # DistributionMap or Table
    "volume": "volumes",  # VolumeData
    "mesh": "meshes",  # trimesh.Trimesh
    "skeleton": "skeletons",  # (K, L+2, 3), as Result has it
    "drawing": "plane boundaries",  # Table of lines and arcs
    "picture": "pictures",  # matplotlib Figure
    "document": "documents",  # dict
}

Function = str | Callable[..., Any]
"""A function, or ``"module:name"`` of one that is imported when it is needed."""


@keywords
@dataclass(frozen=True)
class Format:
    """One kind of thing in one kind of file.

    ``suffix`` is the ending of its files without the dot; ``kind`` one of ``KINDS``. ``writer(data, path)`` writes a
    file; ``reader(path)`` returns what was written, equal in every array, name, unit and axis, whatever the name of
    the file; None: only other programs read it. Functions are called in other processes too, so they stand in modules.
    ``packages`` must be importable for both, ``extra`` installs them. ``written``: "kept" formats are in every saved
    result and what ``Result.load`` reads, "always" beside them, "asked" only by name; "converted" is never in a result,
    where it would be taken for another part, but what files are converted to. ``frame`` is that of coordinates,
    where it is not the data's own.
    """

    suffix: str
    kind: str
    media_type: str
    writer: Function
    reader: Function | None = None
    packages: tuple[str, ...] = ()
    extra: str | None = None
    written: Literal["kept", "always", "asked", "converted"] = "asked"
    frame: str | None = None

    __repr__ = short_repr

    def write(self, data: Any, path: str | Path) -> None:
        """Write a file. Raises MissingExtraError, and what the writer raises."""
        self._function(self.writer)(data, path)

    def read(self, path: str | Path) -> Any:
        """What a file holds. Raises InputError where it is damaged or the format has no reader, MissingExtraError."""
        if self.reader is None:
            raise InputError("path", f"{Path(path).name}: wsrender writes .{self.suffix} files, but does not read them")
        return self._function(self.reader)(path)

    def file(self, name: str) -> str:
        """Name of the file that holds the part ``name`` of a result."""
        return f"{name}.{self.suffix}"

    def _function(self, function: Function) -> Callable[..., Any]:
        if not isinstance(function, str):
            return function
        module, _, name = function.partition(":")
        try:
            return getattr(import_module(module), name)
        except ModuleNotFoundError as error:
            if self.extra is None:
                raise
            raise MissingExtraError(error.name or name, self.extra) from error


def _own(
    suffix: str, kind: str, media_type: str, writer: str, reader: str | None, packages: str = "", **facts: Any
) -> Format:
    """A row whose functions are those of modules of this package."""
    extra = "engine" if packages else None
    here = __name__.rpartition(".")[0]
    read = None if reader is None else f"{here}.{reader}"
    return Format(suffix, kind, media_type, f"{here}.{writer}", read, tuple(packages.split()), extra, **facts)


_VTK_XML = "application/vnd.vtk.vti"
_MATLAB = "application/x-matlab-data"
_PICTURE = "wsrender.results.drawing:save_figure"

# In the order in which a result lists its files. Rows without a reader are for other programs.
# fmt: off
_ROWS = [
    _own("parquet", "table", "application/vnd.apache.parquet",
         "parquet:write_table_parquet", "parquet:read_table_parquet", "pyarrow", written="kept"),
    _own("npz", "table", "application/x-npz", "npz:write_table_npz", "npz:read_table_npz"),
    _own("csv", "table", "text/csv", "csv:write_table_csv", None, "pyarrow"),
    _own("mat", "table", _MATLAB, "mat:write_table_mat", None, "scipy"),
    _own("vtkhdf", "volume", "application/x-hdf5",
         "vtkhdf:write_volume_vtkhdf", "vtkhdf:read_volume_vtkhdf", "h5py", written="kept"),
    _own("npz", "volume", "application/x-npz", "npz:write_volume_npz", "npz:read_volume_npz"),
    _own("csv", "volume", "text/csv", "csv:write_volume_csv", None, "pyarrow"),
    _own("parquet", "volume", "application/vnd.apache.parquet", "parquet:write_volume_parquet", None, "pyarrow",
         written="converted"),
    _own("mat", "volume", _MATLAB, "mat:write_volume_mat", None, "scipy"),
    _own("vti", "volume", _VTK_XML, "vti:write_volume_vti", None),
    _own("glb", "mesh", "model/gltf-binary", "meshes:write_mesh", "meshes:read_glb", "trimesh",
         written="always", frame=GLB_FRAME),
    _own("ply", "mesh", "model/ply", "meshes:write_mesh", "meshes:read_ply", "trimesh", written="kept"),
    _own("stl", "mesh", "model/stl", "meshes:write_mesh", "meshes:read_stl", "trimesh"),
    _own("obj", "mesh", "model/obj", "meshes:write_mesh", "meshes:read_obj", "trimesh"),
    _own("npy", "skeleton", "application/x-npy", "skeleton:write_skeleton", "skeleton:read_skeleton", written="kept"),
    _own("dxf", "drawing", "image/vnd.dxf", "drawings:write_dxf", None, "ezdxf", written="always"),
    _own("svg", "drawing", "image/svg+xml", "drawings:write_svg", None, written="always"),
    Format("png", "picture", "image/png", _PICTURE, None, ("matplotlib",), "engine", "always"),
    Format("svg", "picture", "image/svg+xml", _PICTURE, None, ("matplotlib",), "engine"),
    _own("json", "document", "application/json", "artifacts:write_document", None, written="always"),
]
# fmt: on
_OWN = {(row.kind, row.suffix): row for row in _ROWS}
_REGISTERED: dict[tuple[str, str], Format] = {}


@keywords
def register_format(row: Format) -> Format:
    """Add a format: results are then saved in it where it is asked for, and a server converts files to it.

    It replaces one that was registered before under the same suffix and kind. Raises InputError, naming the member,
    where the row is not allowed, or is one of wsrender's own.

    >>> row = ws.Format("txt", "document", "text/plain", lambda data, path: path.write_text(str(data)))
    >>> ws.register_format(row).suffix
    'txt'
    """
    _check(row)
    _REGISTERED[row.kind, row.suffix] = row
    return row


def _check(row: Format) -> None:
    if not isinstance(row, Format):
        raise InputError("format", f"must be a wsrender.Format, not {type(row).__name__}")
    if not re.fullmatch(r"[a-z0-9][a-z0-9_-]{0,31}", row.suffix):
        raise InputError("suffix", f"{row.suffix!r} is not allowed; 1 to 32 of a-z, 0-9, - and _, without the dot, are")
    if row.kind not in KINDS:
        raise InputError("kind", f"{row.kind!r} is not one of {', '.join(KINDS)}")
    if not re.fullmatch(r"[\w.+-]+/[\w.+-]+", row.media_type):
        raise InputError("media_type", f"{row.media_type!r} is not one; it reads like application/x-npz")
    if row.written != "asked":
        raise InputError("written", f'{row.written!r} is for wsrender\'s own formats; others are "asked"')
    if (row.kind, row.suffix) in _OWN:
        raise InputError("suffix", f"{KINDS[row.kind]} have a format {row.suffix!r} already, wsrender's own")
    other = next((each for each in _ROWS if each.suffix == row.suffix and each.media_type != row.media_type), None)
    if other is not None:
        raise InputError("media_type", f".{row.suffix} files are {other.media_type}, not {row.media_type}")


def table(own: bool = False) -> list[Format]:
    """All rows: wsrender's ``own``, then those of other packages, then those registered here."""
    return list(_OWN.values()) if own else list((_OWN | _extensions() | _REGISTERED).values())


def rows(kind: str, own: bool = False) -> list[Format]:
    """The formats of a kind of thing; ``own``: without those of other packages."""
    return [row for row in table(own) if row.kind == kind]


def kept(kind: str) -> Format:
    """The format in which results keep a kind of thing, which ``Result.load`` reads."""
    return next(row for row in _ROWS if row.kind == kind and row.written == "kept")


def written(kind: str, asked: Iterable[str]) -> list[Format]:
    """The formats in which a kind of thing is written if those of the suffixes ``asked`` are wanted too."""
    return [row for row in rows(kind) if row.written in STORED or (row.written == "asked" and row.suffix in asked)]


def of_file(name: str) -> Format | None:
    """The format of a file that every saved result may hold; None where only an asked one has its ending."""
    suffix = PurePosixPath(name).suffix.removeprefix(".")
    return next((row for row in _ROWS if row.suffix == suffix and row.written in STORED), None)


def others(row: Format | None) -> dict[str, Format]:
    """By suffix, what a file of a format can be converted to: nothing where wsrender does not read it."""
    if row is None or row.reader is None:
        return {}
    return {other.suffix: other for other in rows(row.kind) if other.suffix != row.suffix}


def readable(row: Format) -> Format:
    """The format itself, or where a package is missing that it needs, the first other one that can be read."""
    choices = (each for each in (row, *others(row).values()) if each.reader is not None)
    return next((each for each in choices if all(find_spec(package) for package in each.packages)), row)


def media_type(name: str) -> str:
    """Media type of a file, by its ending. Raises InputError where the table has none."""
    suffix = PurePosixPath(name).suffix.removeprefix(".")
    for row in table():
        if row.suffix == suffix:
            return row.media_type
    raise InputError("name", f"{name} must end in one of {', '.join(f'.{each}' for each in suffixes(table()))}")


def suffixes(of: Iterable[Format]) -> list[str]:
    """The distinct suffixes of rows, in their order."""
    return list(dict.fromkeys(row.suffix for row in of))


def convertible() -> list[str]:
    """The suffixes that files of results can be converted to."""
    return suffixes(other for row in table() if row.written in STORED for other in others(row).values())


def asked(own: bool = False) -> list[str]:
    """The suffixes that are written only where they are asked for; ``own``: without those of other packages."""
    return suffixes(row for row in table(own) if row.written == "asked")


def check_asked(names: Iterable[str], field: str = "formats") -> tuple[str, ...]:
    """The names of formats that a user asks for in ``field``; InputError, with the choices, for an unknown one."""
    names, known = tuple(names), suffixes(table())
    for name in names:
        if name not in known:
            allowed = f"allowed: {', '.join(asked())}{left_out(EXTENSIONS)}"
            raise InputError(field, f"{name!r} is not a format that can be added; {allowed}")
    return names


def by_ending(kind: str, path: str | Path, field: str = "path", own: bool = False) -> Format:
    """The format of a file that shall hold a kind of thing, by its ending; InputError, with the choices, otherwise."""
    name = Path(path).name
    choices = {row.suffix: row for row in rows(kind, own)}
    suffix = Path(path).suffix.removeprefix(".").lower()
    if suffix not in choices:
        left = "" if own else left_out(EXTENSIONS)
        raise InputError(field, f'must end in {one_of(f".{each}" for each in choices)}, not "{name}"{left}')
    return choices[suffix]


def one_of(names: Iterable[str]) -> str:
    """``npz, csv or mat``."""
    *first, last = names
    return f"{', '.join(first)} or {last}" if first else last


def own_functions() -> dict[str, str]:
    """Modules of this package that the functions of wsrender's own rows stand in, by the functions' names."""
    here = __name__.rpartition(".")[0] + "."
    texts = [each for row in _ROWS for each in (row.writer, row.reader) if isinstance(each, str)]
    places = (text.removeprefix(here).partition(":") for text in texts if text.startswith(here))
    return {name: module for module, _, name in places}


@cache
def _extensions() -> dict[tuple[str, str], Format]:
    """The rows of other packages."""
    found: dict[tuple[str, str], Format] = {}

    def add(_: str, row: Any) -> None:
        _check(row)
        if (row.kind, row.suffix) in found:
            raise InputError("suffix", f"{KINDS[row.kind]} have a format {row.suffix!r} of another package already")
        found[row.kind, row.suffix] = row

    load(EXTENSIONS, add)
    return found
