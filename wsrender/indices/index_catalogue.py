"""The catalogue of local indices: the one place that knows their names, units, bounds and functions."""

import difflib
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import cache
from math import inf, sqrt
from typing import Any

from wsrender.documents.options import STATISTICS
from wsrender.documents.problems import path_text
from wsrender.errors import InputError, MissingInertiaError
from wsrender.extensions import left_out, load
from wsrender.indices import functions as f
from wsrender.indices.entry import DYNAMIC_PREFIX, Bound, Index, Option, Value, checked, values
from wsrender.indices.units import TaskMatrix, UnitRule, unit_text
from wsrender.keywords import keywords

CONVENTIONS = ("standard", "table_1", "wsrender_code")
EXTENSIONS = "wsrender.indices"  # entry points of other packages: each an Index, or a list of them


def at_equal_values(function: Callable[..., Any]) -> Callable[..., float]:
    """The bound of an index that is largest, of all matrices of one Frobenius norm, where all m σ are equal."""
    return lambda norm, m, n: float(function([norm / sqrt(m)] * m, m, n))


SIX = (
    Index(
        "manipulability", "μ", f.manipulability, "Yoshikawa 1985",
        unit=lambda A: A.volume, bound=at_equal_values(f.manipulability), aliases=("yoshikawa",),
        conventions={"wsrender_code": f.code_manipulability},
    ),
    Index(
        "inverse_condition_number", "1/κ", f.inverse_condition_number, "Salisbury & Craig 1982",
        range=(0.0, 1.0), unit=lambda A: A.ratio, bound=at_equal_values(f.inverse_condition_number),
        aliases=("inverse-condition", "invcondition"),
        conventions={
            "table_1": f.table_1_inverse_condition_number,
            "wsrender_code": f.code_inverse_condition_number,
        },
    ),
    Index(
        "minimum_singular_value", "σ_min", f.minimum_singular_value, "Klema & Laub 1980",
        unit=lambda A: A.value, bound=at_equal_values(f.minimum_singular_value), aliases=("minsingular",),
        conventions={
            "table_1": f.table_1_minimum_singular_value,
            "wsrender_code": f.code_minimum_singular_value,
        },
        convention_units={"table_1": lambda A: A.value**2},
    ),
    Index(
        "order_independent_manipulability", "μ_o", f.order_independent_manipulability, "Kim & Khosla 1991",
        unit=lambda A: A.volume ** Fraction(2, A.m), bound=at_equal_values(f.order_independent_manipulability),
        conventions={
            "table_1": f.table_1_order_independent_manipulability,
            "wsrender_code": f.code_order_independent_manipulability,
        },
        convention_units={
            "table_1": lambda A: A.volume ** Fraction(2, A.n),
            "wsrender_code": lambda A: A.volume ** Fraction(1, A.n),
        },
    ),
    Index(
        "harmonic_mean_manipulability", "μ_h", f.harmonic_mean_manipulability, "Kim & Khosla 1991",
        unit=lambda A: A.value, bound=at_equal_values(f.harmonic_mean_manipulability),
        conventions={"wsrender_code": f.code_harmonic_mean_manipulability},
    ),
    Index(
        "isotropy", "Δ", f.isotropy, "Kim & Khosla 1991",
        range=(0.0, 1.0), unit=lambda A: A.ratio, bound=at_equal_values(f.isotropy),
        conventions={"table_1": f.table_1_isotropy, "wsrender_code": f.code_isotropy},
        convention_units={
            "table_1": lambda A: A.volume ** Fraction(2, A.n) / A.value**2,
            "wsrender_code": lambda A: A.volume ** Fraction(1, A.n) / A.value,
        },
    ),
)  # fmt: skip
_LIMIT = Option("limit_m", 0.25, "m", range=(1e-3, 10.0), description="what farther distances are told as, either sign")
_ABOUT = {
    "function": f.given_by_shapes, "range": (-inf, inf), "unit": "m", "needs": ("clearance",),
    "bound": lambda norm, m, n, limit_m: limit_m, "options": (_LIMIT,),
    "voxel_statistics": ("count", "maximum", "mean", "minimum"),
}  # fmt: skip
CLEARANCE = (
    Index("clearance", "d", source="MuJoCo's mj_geomDistance", **_ABOUT),
    Index("clearance_lower_bound", "d_low", source="capsules around the shapes", **_ABOUT),
)
_ACCELERATION = Option("acceleration_m_s2", 0.0, "m/s^2", range=(0.0, inf), description="of the tip, in any direction")
_DIRECTION = Option(
    "direction", (), kind="numbers", description="in the world, of any length; none: the least over all directions"
)


def _place(name: str, what: str) -> Option:
    return Option(name, (0.0, 0.0, 0.0), "m", "numbers", length=3, description=f"where {what} is in the tip's frame")


def _of_joints(name: str, unit: str, what: str) -> Option:
    return Option(name, (), unit, "numbers", range=(0.0, 1e15), description=f"{what} of every joint")


_CHAIN: dict[str, Any] = {"function": f.of_chain, "voxel_statistics": ("count", "maximum", "mean", "minimum")}
CHAIN = (
    Index(
        "joint_limit_margin", "δ", source="share of the ranges", range=(0.0, 0.5), unit="1",
        needs=("configuration", "limits"), bound=0.5, **_CHAIN,
    ),
    Index(
        "torque_margin", "δ_τ", source="Khatib 1987", range=(-1.0, 1.0), unit="1", bound=1.0,
        needs=("jacobian", "inertia", "gravity", "limits"), **_CHAIN,
        options=(
            Option("payload_kg", 0.0, "kg", range=(0.0, inf), description="mass that the tip carries"),
            _place("payload_com_m", "that mass"),
            _ACCELERATION,
        ),
    ),
    Index(
        "payload_capacity", "m", source="static holding capacity", unit="kg",
        needs=("jacobian", "inertia", "gravity", "limits"), bound=lambda norm, m, n, limit_kg, **_: limit_kg, **_CHAIN,
        options=(
            _place("com_m", "the mass"),
            _ACCELERATION,
            Option("limit_kg", 100.0, "kg", range=(1e-6, 1e9), description="what larger masses are told as"),
        ),
    ),
    Index(
        "velocity_radius", "v", source="Yoshikawa 1985; Chiacchio et al. 1997", unit="m/s",
        needs=("jacobian", "limits"), options=(_DIRECTION,), **_CHAIN,
    ),
    Index(
        "force_radius", "f", source="Chiacchio et al. 1997", unit="N", needs=("jacobian", "gravity", "limits"),
        bound=lambda norm, m, n, limit_N, **_: limit_N, **_CHAIN,
        options=(
            _DIRECTION, Option("limit_N", 1e4, "N", range=(1e-6, 1e12), description="what larger forces are told as")
        ),
    ),
    Index(
        "acceleration_radius", "a", source="Bowling and Khatib 2005", unit="m/s^2",
        needs=("jacobian", "inertia", "gravity", "limits"), options=(_DIRECTION,), **_CHAIN,
    ),
    Index(
        "tip_compliance", "c", source="largest eigenvalue of J_v K⁻¹ J_vᵀ", unit="m/N", needs=("jacobian",),
        options=(_of_joints("joint_stiffness", "N m/rad or N/m", "stiffness"),), **_CHAIN,
    ),
    Index(
        "position_error", "σ_p", source="largest eigenvalue of J_v diag(δ²) J_vᵀ", unit="m", needs=("jacobian",),
        options=(_of_joints("joint_sigma", "rad or m", "one standard deviation"),), **_CHAIN,
    ),
)  # fmt: skip
KINEMATIC = tuple(index.name for index in SIX)
DYNAMIC = tuple(DYNAMIC_PREFIX + name for name in KINEMATIC)
_SHIPPED: dict[str, Index] = {index.name: index for index in (*SIX, *CLEARANCE, *CHAIN)}
_ADDED: dict[str, Index] = {}  # by the user


@keywords
def register_index(
    name: str,
    function: Callable[..., Any],
    *,
    symbol: str = "",
    unit: str | UnitRule = "",
    source: str = "user",
    range: tuple[float, float] = (-inf, inf),
    needs: tuple[str, ...] = ("sigma",),
    bound: Bound | None = None,
    options: Sequence[Option] = (),
    voxel_statistics: Sequence[str] = ("count", "maximum"),
    survives: frozenset[str] | None = None,
) -> Index:
    """Add an index to the catalogue; it then works in maps, volumes, plots and on the command line.

    ``function(sigma, m, n)`` gets the m singular values of the task matrix, descending, each a number or array, and
    its options by name; it may use arithmetic, Python's ``sum`` and ``wsrender.math``. The dynamic variant is
    ``dynamic_<name>``.

    Or it is of the whole chain, and its parameters say of what, the first of them too: ``q``, the joint values [rad or
    m]; ``J[row][joint]``, linear then angular rows at the tip in the world; ``M[i][j]``, the joint-space inertia;
    ``g``, what the joints take against gravity [N m or N]; ``limits.lower``, ``.upper`` and ``.effort``, infinite where
    there is none; ``frames[i].position`` and ``.axes`` of joint i in the world; ``position`` and ``axes`` of the tip;
    and its options, which are numbers then. Only what is taken is computed.

    The other arguments are those of `Index`. Registered so, an index is known to this process;
    the entry-point group ``wsrender.indices`` adds those of an installed package to all. Raises InputError where the
    name is not an identifier or taken, the function uses anything else, or another field is not allowed.

    >>> ws.register_index("spread", lambda sigma, m, n: sigma[0] - sigma[-1], unit="m").name
    'spread'
    >>> found = ws.evaluate_indices("ur5e", [0, -1.5, 1.5, 0, 1, 0], ["spread", "minimum_singular_value"])
    >>> found["spread"].shape
    (1,)
    """
    index = Index(
        name, symbol or name, function, source, range, unit, tuple(needs), bound, tuple(options),
        tuple(voxel_statistics), survives,
    )  # fmt: skip
    if (existing := _known(name)) is not None and existing.name not in _ADDED:
        raise InputError("name", f"{name!r} is taken by the catalogue ({existing.source})")
    _ADDED[name] = checked(index)
    return _ADDED[name]


@cache
def _extensions() -> dict[str, Index]:
    """The indices of other packages."""
    found: dict[str, Index] = {}

    def add(_: str, indices: Any) -> None:
        new: dict[str, Index] = {}
        for index in map(checked, [indices] if isinstance(indices, Index) else indices):
            if index.name in _SHIPPED | found | new:
                raise InputError("name", f"there is an index {index.name!r} already")
            new[index.name] = index
        found.update(new)

    load(EXTENSIONS, add)
    return found


def catalogue() -> dict[str, Index]:
    """All indices by name, without the dynamic variants."""
    return _SHIPPED | _extensions() | _ADDED


def _known(name: str) -> Index | None:
    """The index of a name or alias; those of other packages are looked for where it is neither shipped nor added."""
    here = _SHIPPED | _ADDED
    return here.get(name) or _by_alias(here).get(name) or _extensions().get(name) or _by_alias(_extensions()).get(name)


def _by_alias(indices: Mapping[str, Index]) -> dict[str, Index]:
    return {alias: index for index in indices.values() for alias in index.aliases}


def is_dynamic(name: str) -> bool:
    """Whether a name is that of a dynamic variant, or of an index of J M⁻¹ alone."""
    return name.startswith(DYNAMIC_PREFIX) or find(name).dynamic


def find(name: str) -> Index:
    """The index of a name, alias or dynamic variant; InputError lists the names otherwise."""
    plain = name.removeprefix(DYNAMIC_PREFIX)
    index = _known(plain)
    if index is None:
        known = catalogue()
        near = difflib.get_close_matches(plain, known, 1)
        hint = f" (did you mean {near[0]!r}?)" if near else ""
        names = ", ".join(known)
        allowed = f"allowed: {names}, those of singular values also as dynamic_<name>{left_out(EXTENSIONS)}"
        raise InputError("indices", f"unknown index {name!r}{hint}; {allowed}")
    if plain != name and not index.has_dynamic_form:
        why = "is of the accelerations already" if index.dynamic else "is of no singular values"
        why = "is of shapes" if index.given else why
        raise InputError("indices", f"unknown index {name!r}; {plain!r} {why}")
    return index


def names_of(index: Index) -> tuple[str, ...]:
    """Every name by which a job may ask for an index: its own, aliases, and those of its dynamic variant."""
    plain = (index.name, *index.aliases)
    return plain if not index.has_dynamic_form else (*plain, *(DYNAMIC_PREFIX + name for name in plain))


def resolve(request: str | Sequence[str], has_inertia: bool) -> tuple[str, ...]:
    """Canonical names of a request: "kinematic", "dynamic", "all" or names and aliases, each once.

    The groups are the six and their dynamic variants, whatever is added. "all" means the kinematic six for a robot
    without inertias; asking it for a dynamic index raises MissingInertiaError.
    """
    if request == "all":
        return KINEMATIC + (DYNAMIC if has_inertia else ())
    if isinstance(request, str):
        request = {"kinematic": KINEMATIC, "dynamic": DYNAMIC}.get(request, (request,))
    names = tuple(dict.fromkeys(_canonical(name) for name in request))
    dynamic = [name for name in names if is_dynamic(name)]
    if dynamic and not has_inertia:
        raise MissingInertiaError(
            "indices", f"{dynamic[0]} needs link inertias, which this robot's model does not have; ask for kinematic"
        )
    return names


def _canonical(name: str) -> str:
    return (DYNAMIC_PREFIX if name.startswith(DYNAMIC_PREFIX) else "") + find(name).name


def unit(name: str, matrix: TaskMatrix, convention: str = "standard") -> str:
    """Unit of an index for the task matrix that it, or its dynamic variant, is a function of: see `unit_text`."""
    return unit_text(find(name).unit_for(convention), matrix)


def default_statistics(names: Sequence[str]) -> tuple[str, ...]:
    """The voxel statistics that mean something for one of these indices, count first."""
    asked = {"count"}.union(*(find(name).voxel_statistics for name in names))
    return tuple(statistic for statistic in STATISTICS if statistic in asked)


def option_values(given: Mapping[str, Mapping[str, Any]], names: Sequence[str]) -> dict[str, dict[str, Value]]:
    """The options of those of the indices ``names`` that have any, from a job's ``index_options``.

    Raises InputError, naming the option, for one that is unknown or not allowed, or of an index that is not asked for.
    """
    by_name = {}
    for key, options in given.items():
        try:
            name = _canonical(key)
        except InputError as error:
            raise InputError(path_text("index_options", key), error.message) from None
        if name not in names:
            raise InputError(path_text("index_options", key), f"is not among the job's indices: {', '.join(names)}")
        if name in by_name:
            raise InputError(path_text("index_options", key), f"gives options of {name} twice")
        try:
            by_name[name] = values(find(name).options, options)
        except InputError as error:
            raise error.within(path_text("index_options", key)) from None
    return {name: by_name.get(name) or values(find(name).options, {}) for name in names if find(name).options}
