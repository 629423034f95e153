"""Arms of six hinges without a spherical wrist: where the last one stands, one equation of the others is left."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from wsrender.robots.closed_form.axes import JOINTS, Axes
from wsrender.robots.closed_form.classes import SolvedClass, open_wrist
from wsrender.robots.closed_form.closed_form import FREE, ClosedForm
from wsrender.robots.closed_form.numbers import (
    elbow_band,
    ends_of,
    geometry_numbers,
    limit_numbers,
    motion_of,
    named_motion,
)
from wsrender.robots.kinematics import Kinematics


@dataclass(frozen=True, eq=False)
class OpenWristForm:
    """What a search along the last hinge, as the arm is solved, takes: of class "open", postures as ``rest`` has them.

    Axes 4 and 5 meet in a point that the last joint moves on a circle, and joints 1 to 3 carry, of which an equation
    holds joint 3 alone. That axes 4 and 5 are at their angle is the equation that is left.
    """

    rest: ClosedForm

    @classmethod
    def of(cls, chain: Kinematics, kind: str = "pose") -> "OpenWristForm | None":
        """That of a chain, from its axes; the last joint before the first, None where it has neither."""
        if chain.geometry is None:
            return None
        near = chain.geometry.relative_to(chain.origin)
        axes = Axes.of(near)
        if axes is None or len(axes.axes) + FREE[kind] != JOINTS:
            return None
        axes = axes.free(list(axes.T_tip[:3, [2, 0, 1][: FREE[kind]]].T))
        solved = open_wrist(axes) or open_wrist(axes.backwards())
        return None if solved is None else cls(ClosedForm(near, chain.origin, kind, solved))

    @property
    def name(self) -> str:
        """The search and the class in words."""
        at = self.solved.axes.axes[5].coordinate
        along = "the turn about the tip's axis" if at is None else f"joint {at + 1}"
        return f"ball search along {along}, {self.rest.name}"

    @property
    def solved(self) -> SolvedClass:
        """How the others are solved."""
        return self.rest.solved

    def numbers(self, position_m: float, angle_rad: float, unlimited: bool = False) -> dict[str, float]:
        """What kernels take, by name; ``unlimited``: as if hinges had no limits.

        Poses within ``position_m`` and ``angle_rad`` of a target count as the target.
        """
        found = self._geometry | limit_numbers(self.solved, unlimited) | elbow_band(self.solved, unlimited)
        axes, reach, world = self.solved.axes, self.solved.axes.reach, self.rest.chain.T_world_base
        lower, upper = ends_of(axes.axes[5], unlimited)
        middle, turned = (lower + upper) / 2, np.eye(4)
        turned[:2, :2] = [[np.cos(middle), np.sin(middle)], [-np.sin(middle), np.cos(middle)]]
        base, tool = motion_of("base", found, reach), motion_of("tool", found, reach)
        # The meeting point is off by what the tip is, and by its turn about the tip: seen from there its own distance.
        held = float(np.linalg.norm((base if axes.reversed else tool)[:3, 3]) / reach)
        held += 0.0 if axes.reversed else float(np.hypot(found["a5"], found["b5"]) + abs(found["along5"]))
        base, tool = (base, world @ tool) if axes.reversed else (base @ np.linalg.inv(world), tool)
        found |= named_motion("base", base, reach) | named_motion("tool", tool @ turned, reach)
        found |= {f"origin{k}": x for k, x in enumerate(self.rest.origin)} | {"scale": 1 / reach}
        found |= {"half": min((upper - lower) / 2, np.pi), "middle_c": np.cos(middle), "middle_s": np.sin(middle)}
        near = max(position_m / reach, 1e-13)  # rounding
        return found | {"near": near + angle_rad * held, "near_by": angle_rad * axes.reversed, "near_turn": angle_rad}

    @cached_property
    def _geometry(self) -> dict[str, float]:
        found, links, reach = geometry_numbers(self.solved), self.solved.links, self.solved.axes.reach
        moved = np.array([found[f"f{r}{k}"] for r in "xy" for k in "cs"])
        right2 = np.hypot(*self.solved.equations[1].right)
        found |= {"right2_size": float(right2), "f_size": float(np.linalg.norm(moved))}
        d5 = float(links.d[4] / reach)
        return found | {"b5": d5 * found["sa5"], "along5": d5 * found["ca5"]}
