"""Arms of seven joints of which one at an end may stand anywhere: a closed form of the others, where it does."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from wsrender.robots.closed_form.axes import JOINTS, Axes, Axis
from wsrender.robots.closed_form.classes import SolvedClass, shoulder_and_wrist
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
class FreeJointForm:
    """What a search along a joint takes: ``free``, the first as the arm is solved, and the closed form of the ``rest``.

    Only arms whose ``rest`` has its first three joints by an equation of joint 3 alone, and an orthogonal wrist: of
    others no bounds are known here.
    """

    rest: ClosedForm
    free: Axis

    @classmethod
    def of(cls, chain: Kinematics, kind: str = "pose") -> "FreeJointForm | None":
        """That of a chain, from its axes; joint 7 before joint 1, None where it has neither."""
        if chain.geometry is None:
            return None
        near = chain.geometry.relative_to(chain.origin)
        axes = Axes.of(near)
        if axes is None or len(axes.axes) + FREE[kind] != JOINTS + 1:
            return None
        axes = axes.free(list(axes.T_tip[:3, [2, 0, 1][: FREE[kind]]].T))
        for way in (axes.backwards(), axes):
            free, rest = way.axes[0], replace(way, axes=way.axes[1:])
            if (solved := shoulder_and_wrist(rest)) and (free.revolute or np.isfinite(free.upper - free.lower)):
                return cls(ClosedForm(near, chain.origin, kind, solved), free)
        return None

    @property
    def name(self) -> str:
        """The search and the class in words."""
        at = self.free.coordinate
        along = "the turn about the tip's axis" if at is None else f"joint {at + 1}"
        return f"ball search along {along} over a closed form ({self.rest.name})"

    @property
    def solved(self) -> SolvedClass:
        """How the others are solved."""
        return self.rest.solved

    def numbers(self, position_m: float, angle_rad: float, unlimited: bool = False) -> dict[str, float]:
        """What kernels take, by name; ``unlimited``: as if hinges had no limits.

        Poses within ``position_m`` and ``angle_rad`` of a target count as the target.
        """
        found = self._geometry | limit_numbers(self.solved, unlimited)
        frame, middle, reach = self._frame, self._middle(unlimited), self.solved.axes.reach
        back, world, (lower, upper) = (
            self.solved.axes.reversed,
            self.rest.chain.T_world_base,
            ends_of(self.free, unlimited),
        )
        tool = motion_of("tool", found, reach)
        # Seen from the tip the base is behind the wrist's centre.
        base = self._taken_back(np.array([middle]))[0] @ np.linalg.inv(frame if back else world @ frame)
        found |= named_motion("base", base, reach) | named_motion("tool", world @ tool if back else tool, reach)
        found |= {f"origin{k}": x for k, x in enumerate(self.rest.origin)} | {"scale": 1 / reach}
        half = (upper - lower) / 2
        found |= {"half": min(half, np.pi) if self.free.revolute else half / reach} | elbow_band(self.solved, unlimited)
        # The wrist's centre is off by what the tip is, and by its turn about the tip: seen from there its own distance.
        near = max(position_m / reach, 1e-13)  # rounding
        held = np.linalg.norm((frame if back else tool)[:3, 3]) / reach
        return found | {"near": near + angle_rad * held, "near_by": angle_rad * back, "near_turn": angle_rad}

    @cached_property
    def _geometry(self) -> dict[str, float]:
        """Those of the others, and how the free joint's frame lies to theirs."""
        found, reach = geometry_numbers(self.solved), self.solved.axes.reach
        link = motion_of("base", found, reach) @ self._frame
        R, p = link[:3, :3], link[:3, 3] / reach
        found |= named_motion("link", link, reach)
        for k, equation in enumerate(self.solved.equations if self.free.revolute else (), 1):
            turn = (2 * equation.squares * R.T @ p + equation.left[2] * R[2])[:2]
            found |= {f"turn{k}_x": turn[0], f"turn{k}_y": turn[1], f"turn{k}_size": np.hypot(*turn)}
        moved = np.array([found[f"f{r}{k}"] for r in "xy" for k in "cs"])
        return found | {"right2_size": np.hypot(*self.solved.equations[1].right), "f_size": np.linalg.norm(moved)}

    @cached_property
    def _frame(self) -> np.ndarray:
        """A frame (4, 4) whose z axis is the free one, its origin nearest to that of the others' base."""
        axis, base = self.free, self.solved.links.base
        h = axis.direction
        x = np.cross(h, np.eye(3)[np.argmin(np.abs(h))])
        x /= np.linalg.norm(x)
        T = np.eye(4)
        T[:3, :3] = np.column_stack([x, np.cross(h, x), h])
        T[:3, 3] = axis.point + h * (h @ (base[:3, 3] - axis.point))
        return T

    def _middle(self, unlimited: bool) -> float:
        return sum(ends_of(self.free, unlimited)) / 2

    def _displacement(self, at: np.ndarray) -> np.ndarray:
        """That of the free joint (N,) [rad or m] where kernels say that it stands ``at``."""
        return at * (1.0 if self.free.revolute else self.solved.axes.reach) + self._middle(False)

    def _taken_back(self, by: np.ndarray) -> np.ndarray:
        """Motions (N, 4, 4) in the free joint's frame that undo its displacements (N,) [rad or m]."""
        T = np.tile(np.eye(4), (len(by), 1, 1))
        if self.free.revolute:
            T[:, 0, 0] = T[:, 1, 1] = np.cos(by)
            T[:, 0, 1], T[:, 1, 0] = np.sin(by), -np.sin(by)
        else:
            T[:, 2, 3] = -by
        return T

    def standing(self, T: np.ndarray, at: np.ndarray) -> np.ndarray:
        """Poses (N, 4, 4) that the others must reach where the free joint stands ``at`` (N,), as kernels say."""
        world = np.eye(4)
        world[:3, 3] = self.rest.origin
        world = world @ self.rest.chain.T_world_base
        back = self._frame @ self._taken_back(self._displacement(at)) @ np.linalg.inv(self._frame)
        if self.solved.axes.reversed:
            return T @ np.linalg.inv(back)
        return world @ back @ np.linalg.inv(world) @ T

    def configurations(self, rows: np.ndarray, at: np.ndarray) -> np.ndarray:
        """Configurations (N, ..., n) of postures (N, ..., 12) of the others where the free joint stands ``at`` (N,)."""
        q = self.rest.configurations(rows)
        if (coordinate := self.free.coordinate) is not None:
            chain = self.rest.chain
            value = (self._displacement(at) - self.free.offset) * self.free.sign
            value = np.clip(value, chain.lower_limits[coordinate], chain.upper_limits[coordinate])
            q[..., coordinate] = value.reshape(-1, *[1] * (q.ndim - 2))
        return q
