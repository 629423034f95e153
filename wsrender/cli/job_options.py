"""The parts of a job document that command-line options write."""

from pathlib import Path
from typing import Any

from wsrender.errors import InputError

ROBOT_FILES = (".xml", ".mjcf", ".urdf")
COUNTED_METHODS = ("random", "sobol", "boundary")


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
    source = "path" if path.suffix.lower() in ROBOT_FILES or path.is_file() else "library"
    return {"analysis": "workspace", "robot": {source: job}}


def corrected_robot(document: dict[str, Any], limits: list[str], length_unit_m: float | None) -> dict[str, Any] | None:
    """The robot of a document with limits and unit of length from options; None without options.

    Raises InputError naming the option, and for a document that has not one robot.
    """
    if not limits and length_unit_m is None:
        return None
    robot: Any = document.get("robot")
    robot = {"library": robot} if isinstance(robot, str) else robot
    if not isinstance(robot, dict):
        raise InputError("--limits" if limits else "--length-unit-m", "goes with a job of one robot")
    given = {"limits": robot.get("limits", {}) | dict(_limits(text) for text in limits), "length_unit_m": length_unit_m}
    return robot | {field: value for field, value in given.items() if value}


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
