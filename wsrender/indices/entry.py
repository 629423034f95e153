"""What the catalogue knows of an index."""

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Literal

from wsrender.documents.options import STATISTICS
from wsrender.errors import InputError
from wsrender.indices.expression import trace
from wsrender.indices.option import Option
from wsrender.indices.units import UnitRule

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


@dataclass(frozen=True)
class Index:
    """A local index: a named function of what it ``needs`` and of nothing else.

    ``function(sigma, m, n, **options)`` gets the m singular values of the task matrix, descending, each a number or
    array, and the values of its ``options``. ``needs`` is ``("sigma",)``, those of J, and then ``dynamic_<name>`` is
    the same of J M⁻¹; or ``("dynamic_sigma",)``, those of J M⁻¹ alone. ``unit`` is a text, or follows from the task
    matrix, as in ``lambda A: A.volume``. ``conventions`` and ``convention_units`` hold what another convention than
    the standard defines differently.

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

    @property
    def dynamic(self) -> bool:
        """Whether it needs J M⁻¹ by itself, without a form of J."""
        return "dynamic_sigma" in self.needs

    def function_for(self, convention: str, options: Mapping[str, Any] | None = None) -> Callable[..., Any]:
        """The function ``(sigma, m, n)`` in a convention, with these options or their defaults."""
        function = self.conventions.get(convention, self.function)
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
    """The index; InputError names the field of an entry that cannot be used."""
    if not _NAME.fullmatch(index.name) or index.name.startswith(DYNAMIC_PREFIX):
        allowed = f"an identifier not starting with {DYNAMIC_PREFIX!r} is"
        raise InputError("name", f"{index.name!r} is not allowed; {allowed}")
    _check_needs(index)
    _check_bound(index)
    _check_lists(index)
    names = [option.name for option in index.options]
    if len(set(names)) < len(names):
        raise InputError("options", f"{index.name} has two of one name: {', '.join(names)}")
    try:
        for m in (3, 6):
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
