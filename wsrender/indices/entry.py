"""What the catalogue knows of an index, and the options that it declares: ``index_options`` of a job."""

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, Literal

from wsrender.documents.options import STATISTICS
from wsrender.documents.problems import shown
from wsrender.documents.quantities import integer, real, sequence
from wsrender.errors import InputError
from wsrender.indices.chain_expression import MOST_JOINTS, NEEDED, Expressed, of_index, taken
from wsrender.indices.expression import trace
from wsrender.indices.functions import of_chain
from wsrender.indices.units import UnitRule
from wsrender.keywords import keywords
from wsrender.short_repr import short_repr

Value = bool | int | float | tuple[float, ...]
_SCHEMAS: dict[str, dict[str, Any]] = {
    "number": {"type": "number"},
    "integer": {"type": "integer"},
    "boolean": {"type": "boolean"},
    "numbers": {"type": "array", "items": {"type": "number"}},
}
DYNAMIC_PREFIX = "dynamic_"
BASE_JOINT, TRAILING_JOINTS = "base_joint", "trailing_joints"
# What an index may need, and the structures of a grid that it survives at most.
NEEDS: dict[str, frozenset[str]] = {
    "sigma": frozenset({BASE_JOINT, TRAILING_JOINTS}),
    "dynamic_sigma": frozenset({BASE_JOINT}),
    "configuration": frozenset(),
    "frames": frozenset(),
    "jacobian": frozenset(),
    "inertia": frozenset({BASE_JOINT}),
    "gravity": frozenset(),
    "limits": frozenset(),
    "clearance": frozenset(),
}
SUPPLIED = ("sigma", "dynamic_sigma")  # by the engine
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,63}")
Bound = float | Callable[..., float]


@keywords
@dataclass(frozen=True)
class Option:
    """An option of an index, passed to its function by name.

    ``kind`` is "number", "integer", "boolean" or "numbers" (a list, of ``length`` numbers where that is given);
    ``range`` is that of every number, both ends allowed. Raises InputError for a default that it would not take.
    """

    name: str
    default: Value
    unit: str = "1"
    kind: Literal["number", "integer", "boolean", "numbers"] = "number"
    range: tuple[float, float] = (-math.inf, math.inf)
    length: int | None = None
    description: str = ""

    def __post_init__(self):
        if not self.name.isidentifier():
            raise InputError("options", f"{self.name!r} is not allowed; an identifier is")
        if self.kind not in _SCHEMAS:
            raise InputError("options", f"{self.kind!r} of {self.name} is not allowed; {', '.join(_SCHEMAS)} are")
        try:
            self.value(self.default)
        except ValueError as error:
            raise InputError("options", f"the default of {self.name} {error}") from None

    def value(self, given: Any) -> Value:
        """The value of a document; ValueError says what is allowed."""
        try:
            return self._converted(given)
        except ValueError as error:
            raise ValueError(f"{error}, not {shown(given)}") from None

    def _converted(self, given: Any) -> Value:
        if self.kind == "boolean":
            if not isinstance(given, bool):
                raise ValueError("must be true or false")
            return given
        if self.kind != "numbers":
            return self._within(integer(given) if self.kind == "integer" else real(given))
        numbers = tuple(self._within(real(item)) for item in sequence(given))
        if self.length is not None and len(numbers) != self.length:
            raise ValueError(f"must have {self.length} numbers")
        return numbers

    def _within(self, number: float) -> float:
        low, high = self.range
        if not low <= number <= high:
            unit = "" if self.unit == "1" else f" {self.unit}"
            if math.isinf(high):
                raise ValueError(f"must be at least {low:g}{unit}")
            raise ValueError(f"must be {low:g} … {high:g}{unit}" if math.isfinite(low) else f"must be at most {high:g}")
        return number

    def schema(self) -> dict[str, Any]:
        """JSON Schema of its values."""
        description = f"{self.description or self.name.replace('_', ' ')} [{self.unit}]"
        schema = {**_SCHEMAS[self.kind], "default": self.default, "description": description}
        ends = {name: end for name, end in zip(("minimum", "maximum"), self.range, strict=True) if math.isfinite(end)}
        if self.kind != "numbers":
            return schema | (ends if self.kind != "boolean" else {})
        lengths = {} if self.length is None else {"minItems": self.length, "maxItems": self.length}
        return schema | lengths | {"default": list(self.default), "items": {"type": "number"} | ends}  # type: ignore[arg-type]


def values(options: tuple[Option, ...], given: Mapping[str, Any]) -> dict[str, Value]:
    """The values of all options, defaults where none are given; InputError names the option, below the index."""
    known = {option.name: option for option in options}
    found = {name: option.default for name, option in known.items()}
    for name, value in given.items():
        if name not in known:
            allowed = f"allowed: {', '.join(known)}" if known else "it has none"
            raise InputError(name, f"is not an option of this index; {allowed}")
        try:
            found[name] = known[name].value(value)
        except ValueError as error:
            raise InputError(name, str(error)) from None
    return found


@keywords
@dataclass(frozen=True)
class Index:
    """A local index: a named function of what it ``needs`` and of nothing else.

    ``function(sigma, m, n, **options)`` gets the m singular values of the task matrix, descending, each a number or
    array, and the values of its ``options``; or it takes by name what else it is a function of, as `register_index`
    says, and ``needs`` follows from that. Else ``needs`` is ``("sigma",)``, those of J, and then ``dynamic_<name>`` is
    the same of J M⁻¹; or ``("dynamic_sigma",)``, those of J M⁻¹ alone; catalogued ones of ``("clearance",)`` are given
    by the host, those of others are kernels of their own. ``unit`` is a text, or follows from the task matrix, as in
    ``lambda A: A.volume``. ``conventions`` and ``convention_units`` hold what another convention than the standard
    defines differently.

    ``bound`` is the largest absolute value, for the fixed-point sums: a number, or for σ of J in the standard
    convention ``bound(norm, m, n, **options)`` of an upper bound of the task matrix's Frobenius norm; None: twice the
    maximum over 2^16 Sobol samples. ``voxel_statistics`` are kept where a job asks for none. ``survives``: structures
    of a grid, "base_joint" and "trailing_joints", by which one sample may stand for others; None: what it needs does.
    """

    name: str
    symbol: str
    function: Callable[..., Any]
    source: str
    range: tuple[float, float] = (0.0, math.inf)
    unit: str | UnitRule = ""
    needs: tuple[str, ...] = ("sigma",)
    bound: Bound | None = None
    options: tuple[Option, ...] = ()
    voxel_statistics: tuple[str, ...] = ("count", "maximum")
    survives: frozenset[str] | None = None
    aliases: tuple[str, ...] = ()
    conventions: Mapping[str, Callable[..., Any]] = field(default_factory=dict)
    convention_units: Mapping[str, UnitRule] = field(default_factory=dict)

    __repr__ = short_repr

    @property
    def given(self) -> bool:
        """Whether the host gives its values, by its options: it is no function of singular values."""
        return "clearance" in self.needs

    @property
    def of_chain(self) -> bool:
        """Whether kernels compute it of the whole chain, and not as a function of singular values."""
        return not self.given and not set(self.needs) <= set(SUPPLIED)

    @property
    def expressed(self) -> Expressed:
        """The function of a user's index of the chain, as the engine traces it; raises InputError."""
        return of_index(self.name, self.function, tuple(option.name for option in self.options))

    @property
    def signed(self) -> bool:
        """Whether it is no ratio of its largest value, as what is less than nothing has none."""
        return self.range[0] < 0 and not set(self.needs) <= set(SUPPLIED)

    @property
    def has_dynamic_form(self) -> bool:
        """Whether there is one of J M⁻¹ beside it."""
        return not (self.given or self.of_chain or self.dynamic)

    @property
    def dynamic(self) -> bool:
        """Whether it needs J M⁻¹ by itself, without a form of J."""
        return "dynamic_sigma" in self.needs

    def function_for(self, convention: str, options: Mapping[str, Any] | None = None) -> Callable[..., Any]:
        """The function ``(sigma, m, n)`` in a convention, with these options or their defaults."""
        function = self.conventions.get(convention, of_chain if taken(self.function) else self.function)
        if not self.options:
            return function
        return partial(function, **{option.name: option.default for option in self.options} | dict(options or {}))

    def unit_for(self, convention: str) -> str | UnitRule:
        """The unit in a convention."""
        return self.convention_units.get(convention, self.unit)

    def surviving(self, dynamic: bool) -> frozenset[str]:
        """Structures of a grid that it, or its dynamic form, survives."""
        needs = ("dynamic_sigma",) if dynamic else self.needs
        most = frozenset.intersection(*(NEEDS[need] for need in needs))
        return most if self.survives is None else most & self.survives


def checked(index: Index) -> Index:
    """The index, with what it needs; InputError names the field of an entry that cannot be used."""
    if not _NAME.fullmatch(index.name) or index.name.startswith(DYNAMIC_PREFIX):
        allowed = f"an identifier not starting with {DYNAMIC_PREFIX!r} is"
        raise InputError("name", f"{index.name!r} is not allowed; {allowed}")
    names = taken(index.function)
    if names is None:
        _check_needs(index)
    else:
        index = replace(index, needs=tuple(dict.fromkeys(NEEDED[each] for each in names if each in NEEDED)))
    _check_bound(index)
    _check_lists(index)
    options = [option.name for option in index.options]
    if len(set(options)) < len(options):
        raise InputError("options", f"{index.name} has two of one name: {', '.join(options)}")
    if names and (others := [option for option in index.options if option.kind not in ("number", "integer")]):
        kind, name = others[0].kind, others[0].name
        raise InputError("options", f"{name} of {index.name} is of kind {kind}; a function of the chain takes numbers")
    try:
        if names is not None:
            index.expressed.traced(MOST_JOINTS, MOST_JOINTS)
        for m in (3, 6) if names is None else ():
            trace(index.function_for("standard"), m, m, 6)
    except Exception as error:
        raise InputError("function", f"{index.name} cannot be compiled: {error}") from error
    return index


def _check_needs(index: Index) -> None:
    if unknown := [need for need in index.needs if need not in NEEDS]:
        raise InputError("needs", f"{unknown[0]!r} is not allowed; {', '.join(NEEDS)} are")
    if missing := [need for need in index.needs if need not in SUPPLIED]:
        known = " or ".join(SUPPLIED)
        raise InputError("needs", f"{index.name} needs {missing[0]}, which the engine does not supply; it does {known}")
    if len(index.needs) != 1:
        raise InputError("needs", f"{index.name} must need one of {', '.join(SUPPLIED)}, not {len(index.needs)}")


def _check_bound(index: Index) -> None:
    bound = index.bound
    if isinstance(bound, bool) or not (bound is None or callable(bound) or isinstance(bound, int | float)):
        raise InputError("bound", f"of {index.name} must be a number, a function or None, not {bound!r}")
    if isinstance(bound, int | float) and not 0 < bound < math.inf:
        raise InputError("bound", f"of {index.name} must be greater than 0 and finite, not {bound!r}")


def _check_lists(index: Index) -> None:
    allowed: dict[Literal["voxel_statistics", "survives"], tuple[str, ...]] = {
        "voxel_statistics": STATISTICS,
        "survives": (BASE_JOINT, TRAILING_JOINTS),
    }
    for name, known in allowed.items():
        if unknown := [item for item in getattr(index, name) or () if item not in known]:
            raise InputError(name, f"{unknown[0]!r} is not allowed; {', '.join(known)} are")
