"""The constraints that there are: those of job documents, and those that users and other packages add.

Another package adds an `ExpressionConstraint` through the entry-point group ``wsrender.constraints``.
"""

import inspect
import re
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import cache
from math import hypot, inf, radians
from typing import Any

from wsrender.documents.constraints import Constraints, OrientationChoice, RegionChoice
from wsrender.documents.problems import path_text
from wsrender.errors import InputError
from wsrender.extensions import left_out, load
from wsrender.indices.chain_expression import ASKED, MOST_JOINTS
from wsrender.keywords import keywords
from wsrender.pipeline.constraints.constraint import ORDER, STRUCTURES, Constraint, Structure, in_order
from wsrender.pipeline.constraints.expression import ExpressionConstraint
from wsrender.pipeline.constraints.host_function import HostConstraint
from wsrender.pipeline.constraints.orientation import Orientation
from wsrender.pipeline.constraints.region import Point, RegionConstraint

EXTENSIONS = "wsrender.constraints"  # entry points, loaded when a job names one
_ADDED: dict[str, ExpressionConstraint | HostConstraint] = {}  # by the user


@keywords
def register_constraint(
    name: str, function: Callable[..., Any], *, keeps: frozenset[Structure] = frozenset(), on_host: bool = False
) -> None:
    """Add a constraint on configurations; jobs then take it by its name among their ``constraints``.

    ``function(q, position, axes, **options)`` is 0 or more where a configuration is admitted: ``q``, the joint values
    [rad or m]; ``position``, x, y, z of the tip in the world [m]; ``axes``, its three axes in the world, three numbers
    each; ``options``, numbers with defaults, which a job may give. It may use arithmetic and ``wsrender.math``. By name
    it may ask for more: ``frames[i].position`` and ``.axes`` of joint i, as those of the tip; ``J[row][joint]``, linear
    then angular rows at the tip in the world; ``g``, what the joints take against gravity [N m or N]; ``M[i][j]``, the
    joint-space inertia; ``limits.lower``, ``.upper`` and ``.effort``, infinite where there is none.
    ``keeps``: what of a grid repeats its answers, so that fewer are asked: "base_joint" where the first joint's value
    changes none, "trailing_joints" where the values of last joints do not whose axes pass through the tip. Raises
    InputError where the name is not an identifier or taken, for another structure, or where the function uses anything
    else.

    ``on_host``: the function is any, ``function(q, poses, **options)`` of configurations (N, n) [rad or m] and poses of
    the tip in the world (N, 4, 4) to (N,) bool, whether each is admitted; NumPy's pace, and of this process alone.

    >>> ws.register_constraint("elbow_up", lambda q, position, axes, least=0.0: q[2] - least)
    >>> elbow = {"elbow_up": {"least": 0.2}}
    >>> result = ws.analyze("ur5e", ws.Sobol(4096), constraints=elbow, refined_volume=None)
    >>> list(result.document["samples"]["rejected"])
    ['elbow_up']
    """
    if isinstance(keeps, str) or not isinstance(keeps, Iterable):
        raise InputError("keeps", f"must be a set of {', '.join(STRUCTURES)}, not {keeps!r}")
    _check(name, keeps)
    if on_host:
        options = _parameters_of(name, function, 2)[1]
        _ADDED[name] = HostConstraint(name, function, tuple(options.items()), frozenset(keeps))
    else:
        _ADDED[name] = _checked(ExpressionConstraint(name, function, keeps=frozenset(keeps)))


def _checked(constraint: Any) -> ExpressionConstraint:
    """A constraint that can be used, with the options that its function has."""
    if not isinstance(constraint, ExpressionConstraint):
        raise InputError("constraint", f"must be an ExpressionConstraint, not {type(constraint).__name__}")
    name, function = constraint.name, constraint.function
    _check(name, constraint.keeps)
    asks, options = _parameters_of(name, function)
    constraint = replace(constraint, options=tuple(options.items()), asks=asks)
    try:
        constraint.device.traced(MOST_JOINTS, MOST_JOINTS)
    except Exception as error:
        raise InputError("function", f"{name} cannot be compiled: {error}") from error
    return constraint


def _check(name: str, keeps: Iterable[str]) -> None:
    known = isinstance(name, str) and re.fullmatch(r"[A-Za-z][A-Za-z0-9_]{0,63}", name)
    if not known or name in (*ORDER, "expression"):
        raise InputError("name", f"{name!r} is not allowed; an identifier other than {', '.join(ORDER)} is")
    if unknown := [each for each in keeps if each not in STRUCTURES]:
        raise InputError("keeps", f"{unknown} is not allowed; allowed: {', '.join(STRUCTURES)}")


def added_constraints() -> dict[str, ExpressionConstraint | HostConstraint]:
    """The constraints that packages and the user add, by name, with the defaults of their options."""
    return _extensions() | _ADDED


def constraints_of(choice: Constraints | None) -> tuple[Constraint, ...]:
    """The constraints of a job in the order in which they are asked. Raises InputError for a name or option unknown."""
    if choice is None:
        return ()
    found: list[Constraint] = [] if choice.region is None else [_region(choice.region)]
    if choice.orientation is not None:
        found.append(_orientation(choice.orientation))
    named = choice.model_extra or {}
    there = added_constraints() if named else {}
    for name in named:
        if name not in there:
            allowed = f"{', '.join((*Constraints.model_fields, *there))}{left_out(EXTENSIONS)}"
            raise InputError(path_text("constraints", name), f"unknown constraint; allowed: {allowed}")
    for name, options in choice.added.items():
        known = dict(there[name].options)
        for option in options:
            if option not in known:
                allowed = ", ".join(known) or "none"
                raise InputError(path_text("constraints", name, option), f"unknown option; allowed: {allowed}")
        found.append(replace(there[name], options=tuple((known | options).items())))
    return in_order(tuple(found))


def _region(choice: RegionChoice) -> RegionConstraint:
    bounds, ball, half = choice.box, choice.sphere, choice.half_space
    return RegionConstraint(
        bounds and (_corner(bounds.lower_m, -inf), _corner(bounds.upper_m, inf)),
        ball and (ball.position_m, ball.radius_m),
        half and (half.point_m, half.normal),
    )


def _orientation(choice: OrientationChoice) -> Orientation:
    within = radians(choice.within_deg)
    if choice.toward is not None:
        return Orientation((_unit(choice.axis),), (_unit(choice.toward),), within)
    x, y, z = (tuple(axis) for axis in choice.rotation.matrix()[:3, :3].T.tolist())
    return Orientation(((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)), (x, y, z), within)


def _unit(vector: Point) -> Point:
    length = hypot(*vector)
    x, y, z = (each / length for each in vector)
    return x, y, z


def _corner(sides: tuple[float | None, float | None, float | None], open_side: float) -> Point:
    """A corner of bounds, infinitely far where they have no side."""
    x, y, z = (open_side if side is None else side for side in sides)
    return x, y, z


def _parameters_of(name: str, function: Callable[..., Any], first: int = 3) -> tuple[tuple[str, ...], dict[str, float]]:
    """What a constraint's function asks for by name, and its options with their defaults."""
    try:
        parameters = list(inspect.signature(function).parameters.values())[first:]
    except (TypeError, ValueError) as error:
        raise InputError("function", f"of {name} must be a function that says its parameters: {error}") from error
    asks = tuple(each.name for each in parameters if each.name in ASKED)
    options = [each for each in parameters if each.name not in ASKED]
    without = [each.name for each in options if not isinstance(each.default, int | float)]
    if without:
        raise InputError("function", f"the options of {name} must have numbers as defaults: {', '.join(without)}")
    return asks, {each.name: float(each.default) for each in options}


@cache
def _extensions() -> dict[str, ExpressionConstraint]:
    """The constraints of other packages."""
    found: dict[str, ExpressionConstraint] = {}

    def add(_: str, constraint: Any) -> None:
        if (new := _checked(constraint)).name in found:
            raise InputError("name", f"there is a constraint {new.name!r} of another package already")
        found[new.name] = new

    load(EXTENSIONS, add)
    return found
