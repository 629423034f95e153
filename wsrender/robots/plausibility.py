"""Numbers of a chain that its author probably did not mean: other units than metres and radians, no limits."""

from collections.abc import Collection, Iterable
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from wsrender.errors import InputError
from wsrender.notices import Notice
from wsrender.robots.chain import Chain
from wsrender.robots.joint_space import JointSpace

if TYPE_CHECKING:
    from wsrender.robots.shapes import Shape

NO_LIMITS, LENGTH, ANGLE, MESH_LENGTH = "no_usable_limits", "units_length", "units_angle", "units_mesh"

PLAUSIBLE_REACH = (0.02, 20.0)  # [m]
LARGEST_TURN = 4 * pi  # [rad] from zero
NO_LENGTH = 1e-9  # [m]
LONGEST_MESH = 10.0  # [m] and reaches of its arm: a link in millimetres, taken for metres, is longer


def doubts(
    chain: Chain, confirmed: Collection[str], length_confirmed: bool, held: Collection[str] = ()
) -> list[Notice]:
    """What a user should check of a chain; limits of joints ``confirmed`` are the user's, those ``held`` need none."""
    lengths_doubted = None if length_confirmed else _lengths(chain, confirmed)
    found = (_endless(chain, held), _degrees(chain, confirmed), lengths_doubted)
    return [notice for notice in found if notice is not None]


def need_ranges(chain: JointSpace, field: str) -> None:
    """Raises InputError, naming ``field``, where a joint has no usable limits."""
    if not chain.endless:
        return
    example = f'{{"{chain.endless[0]}": [lower, upper]}}'
    raise InputError(
        field,
        f"must give the range of {', '.join(chain.endless)}, such as {example}: the model of {chain.name} has no "
        "usable limits there; or hold the joint (locked), or name a base beyond it",
    )


def lengths(chain: Chain, confirmed: Collection[str] = ()) -> dict[str, float]:
    """What the reach of a chain is made of [m], by name: links, the tip, and the largest displacements of slides.

    Left out are slides without limits, those ``confirmed``, and a virtual base: slides before any length that go as far
    to both sides.
    """
    links = np.linalg.norm(chain.T_joint[:, :3, 3], axis=1)
    found: dict[str, float] = {}
    for i, source in enumerate(chain.joint_source):
        name = chain.joint_names[source]
        if i and links[i] > NO_LENGTH:
            found[f"the link before joint {name!r}"] = float(links[i])
        virtual = not found and np.isclose(chain.lower_limits[source], -chain.upper_limits[source])
        slide = float(chain.largest_slide[i])
        if 0.0 < slide < np.inf and not virtual and name not in confirmed:
            found[f"the range of slide {name!r}"] = slide
    found["the tip beyond the last joint"] = float(np.linalg.norm((chain.T_tip @ chain.T_tip_tool)[:3, 3]))
    return found


def too_long(chain: Chain, confirmed: Collection[str] = ()) -> str:
    """How long a chain is, and what makes it so, where that is no arm's length; empty where it is one's."""
    parts = lengths(chain, confirmed)
    if (reach := sum(parts.values())) <= PLAUSIBLE_REACH[1]:
        return ""
    longest = max(parts, key=lambda name: parts[name])
    return f"the reach of {chain.name!r} is {reach:.3g} m ({longest} alone {parts[longest]:.3g} m)"


def _endless(chain: Chain, held: Collection[str]) -> Notice | None:
    if not (endless := [name for name in chain.endless if name not in held]):
        return None
    message = f"{_joints(endless)} no usable limits: the workspace has no end"
    remedy = "give a range (limits), hold the joint (locked), or name a base beyond it"
    return Notice(NO_LIMITS, message, remedy, "robot.limits")


def _degrees(chain: Chain, confirmed: Collection[str]) -> Notice | None:
    largest = np.maximum(np.abs(chain.lower_limits), np.abs(chain.upper_limits))
    turned = chain.revolute & (largest > LARGEST_TURN) & np.isfinite(largest)
    ranges = [
        f"{name} {low:g} … {high:g} rad ({(high - low) / (2 * pi):.3g} turns)"
        for name, low, high, far in zip(chain.joint_names, chain.lower_limits, chain.upper_limits, turned, strict=True)
        if far and name not in confirmed
    ]
    if not ranges:
        return None
    message = f"limits must be in radians, and look like degrees: {', '.join(ranges)}"
    return Notice(ANGLE, message, "correct the model, or give limits_deg", "robot.limits_deg")


def _lengths(chain: Chain, confirmed: Collection[str]) -> Notice | None:
    reach = sum(lengths(chain, confirmed).values())
    if message := too_long(chain, confirmed):
        remedy = "length_unit_m 0.001 converts millimetres, 1 confirms metres; limits give a slide its range"
        return Notice(LENGTH, f"{message}; lengths must be in metres, not millimetres", remedy, "robot.length_unit_m")
    if NO_LENGTH < reach < PLAUSIBLE_REACH[0] and not chain.endless:
        message = f"the reach of {chain.name!r} is {reach:.3g} m; lengths must be in metres, not millimetres"
        return Notice(LENGTH, message, "length_unit_m converts other units, 1 confirms metres", "robot.length_unit_m")
    return None


def long_shapes(chain: Chain, shapes: "Iterable[Shape]") -> list[Notice]:
    """A notice where meshes of a robot are much longer than the robot."""
    sizes = {
        shape.name: float(np.ptp(shape.vertices, axis=0).max())
        for shape in shapes
        if shape.kind == "mesh" and not shape.surroundings
    }
    most = LONGEST_MESH * max(1.0, chain.reach) if np.isfinite(chain.reach) else np.inf
    if not (long := [name for name, size in sizes.items() if size > most]):
        return []
    message = f"the mesh of {long[0]!r} is {sizes[long[0]]:.3g} m long, and the arm reaches {chain.reach:.3g} m"
    more = f" ({len(long)} meshes are so long)" if len(long) > 1 else ""
    remedy = "the file may be in millimetres: give the mesh the scale 0.001 0.001 0.001 in the model"
    return [Notice(MESH_LENGTH, message + more, remedy)]


def _joints(names: Collection[str]) -> str:
    return f"joint {', '.join(names)} has" if len(names) == 1 else f"joints {', '.join(names)} have"
