"""The catalogue of local indices: the one place that knows their names, units and functions."""

import difflib
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from wsrender.errors import InputError, MissingInertiaError
from wsrender.indices import functions as f
from wsrender.indices.expression import trace

CONVENTIONS = ("standard", "table_1", "wsrender_code")
DYNAMIC_PREFIX = "dynamic_"


@dataclass(frozen=True)
class Index:
    """A local index: a named function ``(sigma, m, n) -> value`` of the singular values and nothing else.

    ``conventions`` holds the function where another convention than the standard defines it differently;
    ``sigma_power`` gives the unit: [unit of sigma]^power, m being the number of task rows ("m" stands for it).
    ``unit`` overrides it. ``exact_root`` is the power that removes the root of the last step, for comparisons.
    """

    name: str
    symbol: str
    function: Callable[..., Any]
    source: str
    range: tuple[float, float] = (0.0, float("inf"))
    sigma_power: int | str = 0
    unit: str | None = None
    aliases: tuple[str, ...] = ()
    conventions: dict[str, Callable[..., Any]] = field(default_factory=dict)
    user_defined: bool = False

    def function_for(self, convention: str) -> Callable[..., Any]:
        """The function in a convention."""
        return self.conventions.get(convention, self.function)


_CATALOGUE: dict[str, Index] = {
    index.name: index
    for index in (
        Index(
            "manipulability", "μ", f.manipulability, "Yoshikawa 1985",
            sigma_power="m", aliases=("yoshikawa",),
            conventions={"wsrender_code": f.code_manipulability},
        ),
        Index(
            "inverse_condition_number", "1/κ", f.inverse_condition_number, "Salisbury & Craig 1982",
            range=(0.0, 1.0), aliases=("inverse-condition", "invcondition"),
            conventions={
                "table_1": f.table_1_inverse_condition_number,
                "wsrender_code": f.code_inverse_condition_number,
            },
        ),
        Index(
            "minimum_singular_value", "σ_min", f.minimum_singular_value, "Klema & Laub 1980",
            sigma_power=1, aliases=("minsingular",),
            conventions={
                "table_1": f.table_1_minimum_singular_value,
                "wsrender_code": f.code_minimum_singular_value,
            },
        ),
        Index(
            "order_independent_manipulability", "μ_o", f.order_independent_manipulability, "Kim & Khosla 1991",
            sigma_power=2,
            conventions={
                "table_1": f.table_1_order_independent_manipulability,
                "wsrender_code": f.code_order_independent_manipulability,
            },
        ),
        Index(
            "harmonic_mean_manipulability", "μ_h", f.harmonic_mean_manipulability, "Kim & Khosla 1991",
            sigma_power=1,
            conventions={"wsrender_code": f.code_harmonic_mean_manipulability},
        ),
        Index(
            "isotropy", "Δ", f.isotropy, "Kim & Khosla 1991",
            range=(0.0, 1.0),
            conventions={"table_1": f.table_1_isotropy, "wsrender_code": f.code_isotropy},
        ),
    )
}  # fmt: skip

KINEMATIC = tuple(_CATALOGUE)
DYNAMIC = tuple(DYNAMIC_PREFIX + name for name in KINEMATIC)


def register_index(
    name: str, function: Callable[..., Any], *, symbol: str = "", unit: str = "", source: str = "user"
) -> Index:
    """Add an index to the catalogue; it then works in maps, volumes, plots and on the command line.

    ``function(sigma, m, n)`` gets the m singular values of the task matrix, descending, each a number or array, and
    may use arithmetic, Python's ``sum`` and ``wsrender.math``. The dynamic variant is ``dynamic_<name>``. Raises
    InputError where the name is not an identifier or taken, or the function uses anything else.
    """
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]{0,63}", name) or name.startswith(DYNAMIC_PREFIX):
        raise InputError("name", f"{name!r} is not allowed; an identifier not starting with {DYNAMIC_PREFIX!r} is")
    existing = _CATALOGUE.get(name) or _by_alias().get(name)
    if existing is not None and not existing.user_defined:
        raise InputError("name", f"{name!r} is taken by the catalogue ({existing.source})")
    try:
        for m in (3, 6):
            trace(function, m, m, 6)
    except Exception as error:
        raise InputError("function", f"{name} cannot be compiled: {error}") from error
    index = Index(name, symbol or name, function, source, (float("-inf"), float("inf")), unit=unit, user_defined=True)
    _CATALOGUE[name] = index
    return index


def _by_alias() -> dict[str, Index]:
    return {alias: index for index in _CATALOGUE.values() for alias in index.aliases}


def catalogue() -> dict[str, Index]:
    """All indices by name, without the dynamic variants."""
    return dict(_CATALOGUE)


def is_dynamic(name: str) -> bool:
    """Whether a name is that of a dynamic variant."""
    return name.startswith(DYNAMIC_PREFIX)


def find(name: str) -> Index:
    """The index of a name, alias or dynamic variant; InputError lists the names otherwise."""
    plain = name.removeprefix(DYNAMIC_PREFIX)
    index = _CATALOGUE.get(plain) or _by_alias().get(plain)
    if index is None:
        near = difflib.get_close_matches(plain, _CATALOGUE, 1)
        hint = f" (did you mean {near[0]!r}?)" if near else ""
        names = ", ".join(_CATALOGUE)
        raise InputError("indices", f"unknown index {name!r}{hint}; allowed: {names}, each also as dynamic_<name>")
    return index


def resolve(request: str | Sequence[str], has_inertia: bool) -> tuple[str, ...]:
    """Canonical names of a request: "kinematic", "dynamic", "all" or names and aliases, each once.

    "all" means the kinematic six for a robot without inertias; asking it for a dynamic index raises
    MissingInertiaError.
    """
    if request == "all":
        return KINEMATIC + (DYNAMIC if has_inertia else ())
    if isinstance(request, str):
        request = {"kinematic": KINEMATIC, "dynamic": DYNAMIC}.get(request, (request,))
    names = tuple(dict.fromkeys((DYNAMIC_PREFIX if is_dynamic(name) else "") + find(name).name for name in request))
    dynamic = [name for name in names if is_dynamic(name)]
    if dynamic and not has_inertia:
        raise MissingInertiaError(
            "indices", f"{dynamic[0]} needs link inertias, which this robot's model does not have; ask for kinematic"
        )
    return names


def unit(name: str, rows: Sequence[int], convention: str) -> str:
    """Unit of an index for task rows (0…5: x y z rx ry rz), radians left out: "m^3", "1/(kg m)", "1"."""
    index = find(name)
    if index.unit is not None:
        return index.unit
    power = len(rows) if index.sigma_power == "m" else int(index.sigma_power)
    linear, angular = any(r < 3 for r in rows), any(r >= 3 for r in rows)
    mixed = linear and angular
    if convention == "table_1" and index.name == "minimum_singular_value":
        power = 2
    if convention != "standard" and index.name in ("order_independent_manipulability", "isotropy"):
        return ""  # a root of a product of other units: none that means anything
    if convention == "wsrender_code":
        mixed = index.name != "manipulability" or is_dynamic(name)
        power = 3 if index.name == "manipulability" else power
        linear = True
    if power == 0:
        return "1"
    if mixed:
        return "" if convention == "wsrender_code" else ("1" if not is_dynamic(name) else "")
    base = ("1/(kg m)" if linear else "1/(kg m^2)") if is_dynamic(name) else ("m" if linear else "1")
    if power == 1 or base == "1":
        return base
    return f"{base}^{power}" if base == "m" else f"({base})^{power}"
