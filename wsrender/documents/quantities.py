"""Numbers, names and lists as job documents write them: strict, finite, never a string or a bool."""

import math
import re
from collections.abc import Callable, Iterable
from itertools import chain
from numbers import Integral, Real
from types import NoneType
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, StrictStr

from wsrender.errors import InputError

LARGEST_COUNT = 10**15
SMALLEST_VOXEL_M, LARGEST_VOXEL_M = 1e-10, 1e6
LARGEST_SEED = 2**63 - 1
LONGEST_NAME = 4096  # characters
_NUMERIC = {int, float, bool, NoneType}
_FILE_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,63}")


def real(value: Any) -> float:
    """A finite float from any real number (NumPy scalars included); ValueError otherwise."""
    if not _is_number(value):
        raise ValueError("must be a number")
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise ValueError("must be a finite number")
    return number


def positive(value: Any) -> float:
    """A finite float above 0 from any real number; ValueError otherwise."""
    number = real(value)
    if number <= 0:
        raise ValueError("must be greater than 0")
    return number


def integer(value: Any) -> int:
    """An int from a whole number (1e6 is one, as in JSON Schema); ValueError otherwise."""
    if not _is_number(value) or (not isinstance(value, Integral) and not float(value).is_integer()):
        raise ValueError("must be a whole number")
    return int(value)


def _is_number(value: Any) -> bool:
    return type(value) in (float, int) or (isinstance(value, Real) and not isinstance(value, bool))


def is_none(value: Any) -> bool:
    """Whether it is null, as what a document then does not say."""
    return value is None


def is_empty(value: Any) -> bool:
    """Whether it is an empty list or object, as what a document then does not say."""
    return not value


def sequence(value: Any) -> list:
    """A list from a list, a tuple or a NumPy array; ValueError otherwise (a string is not a list)."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if not isinstance(value, list | tuple):
        raise ValueError("must be a list")
    return list(value)


def numbers_of(value: Any) -> tuple[float, ...]:
    """The finite numbers of a list; none of anything else, which the caller refuses in its own words."""
    try:
        return tuple(real(number) for number in sequence(value))
    except ValueError:
        return ()


def number_rows(value: Any) -> tuple[tuple[float, ...], ...]:
    """Rows of finite numbers; ValueError for the first that is none.

    There may be millions: they are looked at all at once, and one by one only where something is wrong.
    """
    rows = sequence(value)
    if _kinds(rows) <= {list, tuple} and _kinds(chain.from_iterable(rows)) <= {int, float}:
        try:
            if math.isfinite(sum(chain.from_iterable(rows))):
                return tuple(map(tuple, rows))
        except OverflowError:  # of integers
            pass
    return tuple(tuple(real(item) for item in sequence(row)) for row in rows)


def is_numeric(value: Any) -> bool:
    """Whether a list holds nothing but numbers and nulls, or rows of them."""
    kinds = _kinds(value)
    return kinds <= _NUMERIC or (kinds == {list} and _kinds(chain.from_iterable(value)) <= _NUMERIC)


def _kinds(values: Iterable[Any]) -> set[type]:
    return set(map(type, values))


def points_of(value: Any) -> tuple[tuple[float, ...], ...]:
    """Points [x, y, z] of finite numbers; none of anything else, which the caller refuses in its own words."""
    try:
        points = number_rows(value)
    except ValueError:
        return ()
    return points if set(map(len, points)) == {3} else ()


def share(value: Any) -> float:
    """A number above 0, up to 1; ValueError otherwise."""
    number = real(value)
    if not 0 < number <= 1:
        raise ValueError("must be above 0, and at most 1")
    return number


def argument(field: str, convert: Callable[[Any], Any], value: Any) -> Any:
    """What ``convert`` makes of an argument of a Python function; InputError, naming the field, where it refuses."""
    try:
        return convert(value)
    except ValueError as error:
        raise InputError(field, f"{error}, not {value!r}") from None


def rows_of(width: int, least: int = 0) -> BeforeValidator:
    """Rows of so many numbers, or a single one as it is; only the first wrong one is told: there may be millions."""

    def rows(value: Any) -> tuple[tuple[float, ...], ...]:
        found = number_rows(listed_rows(value))
        wrong = next((k for k, row in enumerate(found) if len(row) != width), None)
        if wrong is not None:
            raise ValueError(f"must hold rows of {width} numbers; row {wrong} has {len(found[wrong])}")
        return found

    single = tuple[tuple([Number] * width)]  # type: ignore[valid-type]
    several = Annotated[tuple[single, ...], Field(min_length=least)] if least else tuple[single, ...]
    return BeforeValidator(rows, json_schema_input_type=several | single)


def listed_rows(value: Any) -> list[Any]:
    """A list of rows: what is given, or a single row in a list. Raises ValueError for what is no list."""
    listed = sequence(value)
    return [listed] if listed and not hasattr(listed[0], "__len__") else listed


def distinct(values: Iterable) -> tuple:
    """The values as a tuple; ValueError if there is none or one is repeated."""
    values = tuple(values)
    if not values:
        raise ValueError("must not be empty")
    seen = set()
    for value in values:
        key = value if isinstance(value, str | Real) else repr(value)  # lists and objects cannot be kept in a set
        if key in seen:
            raise ValueError(f'must not repeat "{value}"')
        seen.add(key)
    return values


def quoted(names: Iterable[str]) -> str:
    """The names in double quotes, separated by commas."""
    return ", ".join(f'"{name}"' for name in names)


Number = Annotated[float, BeforeValidator(real)]
PositiveNumber = Annotated[float, Field(gt=0), BeforeValidator(real)]
AngleTolerance = Annotated[float, Field(gt=0, le=3.14), BeforeValidator(real)]
NonNegativeNumber = Annotated[float, Field(ge=0), BeforeValidator(real)]
# Edge of a voxel [m]: from below the parts of any robot to beyond any, far from overflow. What a robot's size allows
# within that, `wsrender.volume.lattice` says.
VoxelSize = Annotated[float, Field(ge=SMALLEST_VOXEL_M, le=LARGEST_VOXEL_M), BeforeValidator(positive)]
RelativeTolerance = Annotated[float, Field(ge=1e-4, le=0.5), BeforeValidator(real)]
Count = Annotated[int, Field(ge=1, le=LARGEST_COUNT), BeforeValidator(integer)]
Seed = Annotated[int, Field(ge=0, le=LARGEST_SEED), BeforeValidator(integer)]


def _file_name(value: Any) -> Any:
    if isinstance(value, str) and not _FILE_NAME.fullmatch(value):
        raise ValueError("must have 1 to 64 letters, digits, and . _ - after the first")
    return value


Name = Annotated[StrictStr, Field(min_length=1, max_length=LONGEST_NAME)]
Sha256 = Annotated[StrictStr, Field(pattern=r"^[0-9a-f]{64}$")]
FileName = Annotated[StrictStr, Field(pattern=f"^{_FILE_NAME.pattern}$"), BeforeValidator(_file_name)]
