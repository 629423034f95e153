"""Targets as arrays: of a job document, or of the table in a file that it names."""

import csv
import hashlib
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from io import StringIO
from itertools import islice
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from wsrender.documents.quantities import quoted
from wsrender.documents.target_lists import (
    ANGLES,
    AXES,
    LONGEST_TEXT,
    MOST_TARGETS,
    NUMBERS,
    POSITION,
    QUATERNION,
    TEXTS,
    TOLERANCES,
    UNIT,
    ListedTargets,
    Target,
    TargetTable,
    TargetVolume,
)
from wsrender.errors import InputError
from wsrender.robots.array_files import content_of, of_npy, open_parquet

ALLOWED = f"allowed: {', '.join((*NUMBERS, *TEXTS))}"
LARGEST = 1e6  # m
FAR = 20.0  # reaches from an arm at which half of the targets must be meant in another unit
MILLIMETRES = 1000.0

Columns = dict[str, np.ndarray]


@dataclass(frozen=True, eq=False)
class TargetList:
    """N targets in the world.

    ``position`` (N, 3) [m]; ``quat_wxyz`` (N, 4), NaN where any orientation will do; ``free_axis`` (N,) "x", "y", "z"
    or ""; ``name`` (N,); ``weight`` (N,); ``tolerances`` (N, 2) [m, rad], NaN: those of the job; ``sha256``: of the
    file, hexadecimal, None of targets that a document lists.
    """

    position: np.ndarray
    quat_wxyz: np.ndarray
    free_axis: np.ndarray
    name: np.ndarray
    weight: np.ndarray
    tolerances: np.ndarray
    sha256: str | None = None

    def __len__(self) -> int:
        return len(self.position)

    def part(self, own: slice | np.ndarray) -> "TargetList":
        """Some of them."""
        rows = {name: value[own] for name, value in vars(self).items() if isinstance(value, np.ndarray)}
        return replace(self, **rows)

    @property
    def oriented(self) -> np.ndarray:
        """Which say an orientation, (N,) bool."""
        return np.isfinite(self.quat_wxyz[:, 0])

    def columns(self, listed: bool) -> Columns:
        """What a table of results says they are; names, weights and free axes only of ``listed`` ones."""
        found = {"name": self.name, "weight": self.weight} if listed else {}
        found |= {"position": self.position} | ({"quat_wxyz": self.quat_wxyz} if self.oriented.any() else {})
        return found | ({"free_axis": self.free_axis} if (self.free_axis != "").any() else {})

    @property
    def provenance(self) -> dict[str, str]:
        """The file that says them."""
        return {} if self.sha256 is None else {"targets_sha256": self.sha256}


def targets_of_job(job: ListedTargets, center: Callable[[np.ndarray], np.ndarray], reach: float) -> TargetList:
    """The targets of a job; ``center``: of positions (N, 3) where an arm that may reach them stands.

    Raises InputError for a table that cannot be read, or that looks like millimetres.
    """
    if job.targets is None:
        return listed_targets(np.array(job.points_m), None if job.quats_wxyz is None else np.array(job.quats_wxyz))
    return checked_targets(job.targets, center, reach)


def checked_targets(
    targets: tuple[Target, ...] | TargetTable | TargetVolume, center: Callable[[np.ndarray], np.ndarray], reach: float
) -> TargetList:
    """The ``targets`` of a job document; see `targets_of_job`."""
    found = target_list(targets)
    if isinstance(targets, TargetTable):
        check_unit(found, targets, center(found.position), reach)
    return found


def target_list(targets: tuple[Target, ...] | TargetTable | TargetVolume, field: str = "targets") -> TargetList:
    """The targets of a job document. Raises InputError, naming row and column, for a file that says something else."""
    if isinstance(targets, TargetVolume):
        return _covering(targets)
    if not isinstance(targets, TargetTable):
        return _listed(targets)
    where, name = (f"{field}.path", str(targets.path)) if targets.model is None else (f"{field}.model", "the table")
    content = content_of(targets.path, targets.model, where)
    columns = _columns(content, where, name)
    return replace(
        _of_columns(columns, where, targets.length_unit_m or 1.0), sha256=hashlib.sha256(content).hexdigest()
    )


def listed_targets(position: np.ndarray, quat_wxyz: np.ndarray | None = None) -> TargetList:
    """Targets (N, 3) [m], or poses with orientations (N, 4) of any length, that weigh the same."""
    count = len(position)
    quat = np.full((count, 4), np.nan) if quat_wxyz is None else quat_wxyz
    text = np.full(count, "", dtype="<U1")
    return TargetList(position, quat, text, text, np.ones(count), np.full((count, 2), np.nan))


def _covering(volume: TargetVolume) -> TargetList:
    points, quat = volume.points, volume.quat_wxyz
    found = listed_targets(points, None if quat is None else np.tile(np.array(quat), (len(points), 1)))
    return replace(found, free_axis=np.full(len(points), volume.free_axis or ""))


def covered(volume: Any, reached: np.ndarray, undecided: np.ndarray) -> dict[str, Any]:
    """The entry ``covered`` of targets (N,) bool; nothing of other targets than a volume's."""
    if not isinstance(volume, TargetVolume):
        return {}
    share, open_ = float(reached.mean()), float(undecided.mean())
    return {
        "covered": {
            "points": len(reached),
            "step_m": volume.step_m,
            "volume_m3": len(reached) * volume.cell_m3,
            "share": share,
            "undecided_share": open_,
            "evidence": f"sampled: centres of cells of at most {volume.step_m:g} m; between them nothing is proven",
        }
    }


def check_unit(found: TargetList, table: TargetTable, center: np.ndarray, reach: float) -> None:
    """InputError where half of the targets are so far from an arm that they are probably millimetres.

    ``center``: (3,), or (N, 3) where it may stand elsewhere for each.
    """
    if table.length_unit_m is not None or not np.isfinite(reach):
        return
    distance = float(np.median(np.linalg.norm(found.position - center, axis=1)))
    if distance > FAR * reach:
        looks = "millimetres" if distance < FAR * reach * MILLIMETRES else "another unit than metres"
        message = f"half of the targets are {distance:.3g} m away from an arm that reaches {reach:.3g} m: {looks}?"
        raise InputError("targets.length_unit_m", f"{message} 0.001 converts millimetres, 1 confirms metres")


def _listed(targets: tuple[Target, ...]) -> TargetList:
    def rows(name: str, width: int) -> np.ndarray:
        given = [getattr(each, name) for each in targets]
        return np.array([[np.nan] * width if row is None else row for row in given], np.float64).reshape(-1, width)

    columns = dict(zip(POSITION, rows("position_m", 3).T, strict=True))
    columns |= dict(zip(QUATERNION, rows("quat_wxyz", 4).T, strict=True))
    columns |= dict(zip(ANGLES, rows("rpy_deg", 3).T, strict=True))
    for name in ("weight", *TOLERANCES):
        columns[name] = np.array([getattr(each, name) for each in targets], np.float64)
    columns |= {name: np.array([getattr(each, name) or "" for each in targets]) for name in TEXTS}
    return _of_columns(columns, "targets", 1.0)


def _columns(content: bytes, field: str, name: str) -> Columns:
    """Columns of a file, which may come from strangers, by what it begins with: numbers, NaN where empty, and texts."""
    if content[:4] == b"PAR1":
        return _parquet(content, field, name)
    if content[:6] == b"\x93NUMPY":
        return _npy(content, field, name)
    return _csv(content, field, name)


def _npy(content: bytes, field: str, name: str) -> Columns:
    needed = "numbers (N, 3) are needed"
    points = of_npy(content, field, name, needed)
    if points.shape[1] != 3:
        raise InputError(field, f"{name} has the shape {points.shape}; {needed}")
    _check_rows(len(points), field, name)
    return _finite(dict(zip(POSITION, points.T.astype(np.float64), strict=True)), field)


def _csv(content: bytes, field: str, name: str) -> Columns:
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(field, f"{name} must be UTF-8 text; byte {error.start} is not") from None
    try:
        rows = list(islice(csv.reader(StringIO(text), strict=True), MOST_TARGETS + 2))
    except csv.Error as error:
        raise InputError(field, f"{name} cannot be read as CSV: {error}") from None
    rows = [[cell.strip() for cell in row] for row in rows if any(cell.strip() for cell in row)]
    header = list(POSITION) if rows and len(rows[0]) == 3 and all(map(_is_number, rows[0])) else None
    if header is None and rows:
        header = rows.pop(0)
    header = header or []
    _check_header(header, field, name)
    _check_rows(len(rows), field, name)
    for k, row in enumerate(rows, 1):
        if len(row) != len(header):
            raise InputError(field, f"row {k} has {len(row)} cells, not {len(header)} as the header")
    columns = {}
    for column, cells in zip(header, zip(*rows, strict=True), strict=True):
        columns[column] = _texts(cells) if column in TEXTS else _numbers(cells, column, field)
    return columns


def _texts(cells: Iterable[str]) -> np.ndarray:
    """Texts as an array, of none more than shows that it is too long."""
    return np.array([cell[: LONGEST_TEXT + 1] for cell in cells], dtype=str)


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _numbers(cells: tuple[str, ...], column: str, field: str) -> np.ndarray:
    """Numbers of cells, NaN of empty ones."""
    for k, cell in enumerate(cells, 1):
        if cell and not (_is_number(cell) and np.isfinite(float(cell))):
            raise InputError(field, f'row {k}, column {column}: must be a finite number, not "{cell[:40]}"')
    return np.array([float(cell) if cell else np.nan for cell in cells])


def _parquet(content: bytes, field: str, name: str) -> Columns:
    import pyarrow

    file, header = open_parquet(content, field, name, TEXTS)
    _check_header(header, field, name)
    _check_rows(file.metadata.num_rows, field, name)
    for column in header:
        kind = file.schema_arrow.field(column).type
        kind = kind.value_type if pyarrow.types.is_dictionary(kind) else kind
        text = pyarrow.types.is_string(kind) or pyarrow.types.is_large_string(kind) or pyarrow.types.is_null(kind)
        number = pyarrow.types.is_floating(kind) or pyarrow.types.is_integer(kind) or pyarrow.types.is_null(kind)
        if not (text if column in TEXTS else number):
            raise InputError(
                field, f"column {column}: must hold {'text' if column in TEXTS else 'numbers'}, not {kind}"
            )
    try:
        table = file.read(columns=header)
        return _finite({column: _of_arrow(table[column], column) for column in header}, field, missing=table)
    except (pyarrow.ArrowException, OSError, MemoryError) as error:
        raise InputError(field, f"{name} cannot be read as Parquet: {error}") from None


def _of_arrow(column: Any, name: str) -> np.ndarray:
    import pyarrow

    if name not in TEXTS:
        return column.cast("float64").to_numpy().astype(np.float64)
    texts = []
    for chunk in column.cast(pyarrow.dictionary("int32", "string")).chunks:  # each text once, however often it occurs
        once = np.append(_texts(chunk.dictionary.to_pylist()), "")
        texts.append(once[chunk.indices.fill_null(len(once) - 1).to_numpy()])
    return np.concatenate([*texts, np.zeros(0, "<U1")])


def _finite(columns: Columns, field: str, missing: Any = None) -> Columns:
    """The columns. Raises InputError where a number is none that counts, but where it is ``missing``."""
    for column, values in columns.items():
        if column not in TEXTS:
            wrong = ~np.isfinite(values)
            if missing is not None:
                wrong &= ~np.asarray(missing[column].is_null())
            if wrong.any():
                k = int(np.argmax(wrong))
                raise InputError(field, f"row {k + 1}, column {column}: must be a finite number, not {values[k]:g}")
    return columns


def _check_header(header: list[str], field: str, name: str) -> None:
    for k, column in enumerate(header):
        if column in header[:k]:
            raise InputError(field, f'{name} has the column "{column}" twice')
        if column in (*NUMBERS, *TEXTS):
            continue
        unit = "; in millimetres call it x_m … and give length_unit_m 0.001" if column.endswith("_mm") else ""
        raise InputError(
            field, f'{name} has the column "{column[:60]}", which no table of targets has{unit}; {ALLOWED}'
        )
    for names in (POSITION, QUATERNION, ANGLES):
        lacking = [column for column in names if column not in header]
        if lacking and (names is POSITION or len(lacking) < len(names)):
            raise InputError(field, f"{name} lacks the column {', '.join(lacking)}; {ALLOWED}")
    if QUATERNION[0] in header and ANGLES[0] in header:
        raise InputError(field, f"{name} says orientations twice: by {quoted(QUATERNION)} and {quoted(ANGLES)}")


def _check_rows(count: int, field: str, name: str) -> None:
    if not 1 <= count <= MOST_TARGETS:
        raise InputError(field, f"{name} has {count} rows of targets; allowed: 1 … {MOST_TARGETS}")


def _of_columns(columns: Columns, field: str, unit: float) -> TargetList:
    """Targets of columns, each row checked. Raises InputError naming row and column."""
    count = len(columns[POSITION[0]])
    none = np.full(count, np.nan)

    def together(names: tuple[str, ...]) -> np.ndarray:
        return np.stack([columns.get(name, none) for name in names], axis=1)

    def refuse(wrong: np.ndarray, column: str, message: str) -> None:
        if wrong.any():
            k = int(np.argmax(wrong))
            found = str(columns[column][k])
            found = "empty" if found in ("nan", "") else found[:40]
            raise InputError(field, f"row {k + 1}, column {column}: {message}, not {found}")

    position, quat, angles = together(POSITION), together(QUATERNION), together(ANGLES)
    for name in POSITION:
        refuse(~np.isfinite(columns[name]), name, "must be given")
        refuse(np.abs(columns[name]) * unit > LARGEST, name, f"must be within ±{LARGEST:g} m")
    for names, values in ((QUATERNION, quat), (ANGLES, angles)):
        partly = np.isfinite(values).any(axis=1)
        for name, column in zip(names, values.T, strict=True):
            refuse(partly & ~np.isfinite(column), name, "must be given, as the others of its rotation")
    length = np.linalg.norm(quat, axis=1)
    if (wrong := np.abs(length - 1) > UNIT).any():
        k = int(np.argmax(wrong))
        message = f"must be a quaternion of unit length, not of length {length[k]:.6g}"
        raise InputError(field, f"row {k + 1}, columns {' '.join(QUATERNION)}: {message}")
    turned = np.isfinite(angles[:, 0])
    quat = quat / length[:, None]
    if turned.any():
        of_angles = Rotation.from_euler("xyz", angles[turned], degrees=True)
        quat[turned] = of_angles.as_quat(scalar_first=True)
    texts = {name: columns.get(name, np.full(count, "", dtype="<U1")) for name in TEXTS}
    for name, cells in texts.items():
        refuse(np.char.str_len(cells) > LONGEST_TEXT, name, f"must have at most {LONGEST_TEXT} characters")
    free = texts["free_axis"]
    refuse(~np.isin(free, ("", *AXES)), "free_axis", f"must be empty or one of {quoted(AXES)}")
    refuse((free != "") & ~np.isfinite(quat[:, 0]), "free_axis", "must be empty where there is no orientation")
    for name in ("weight", *TOLERANCES):
        refuse(columns.get(name, none) <= 0, name, "must be greater than 0")
    refuse(columns.get(TOLERANCES[1], none) > 3.14, TOLERANCES[1], "must be at most 3.14")
    weight = np.where(np.isfinite(columns.get("weight", none)), columns.get("weight", none), 1.0)
    return TargetList(position * unit, quat, free, texts["name"], weight, together(TOLERANCES))
