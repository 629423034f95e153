"""Arms of seven hinges of which one at an end may stand anywhere: a closed form of the others, where it does."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from wsrender.robots.closed_form.axes import JOINTS, Axes, Axis
from wsrender.robots.closed_form.classes import SolvedClass, shoulder_and_wrist
from wsrender.robots.closed_form.closed_form import FREE, ClosedForm
from wsrender.robots.closed_form.numbers import TURN, ends_of, geometry_numbers, limit_numbers, zeros
from wsrender.robots.kinematics import Kinematics


@dataclass(frozen=True, eq=False)
class FreeJointForm:
    """What a search along a hinge takes: ``free``, the first as the arm is solved, and the closed form of the ``rest``.

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
            solved = shoulder_and_wrist(rest) if free.revolute else None
            if solved:
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
        turned, tool = np.eye(4), _matrix("tool", found, reach)
        turned[:2, :2] = [[np.cos(middle), np.sin(middle)], [-np.sin(middle), np.cos(middle)]]
        # Seen from the tip the base is behind the wrist's centre.
        base = turned @ np.linalg.inv(frame if back else world @ frame)
        found |= _named("base", base, reach) | _named("tool", world @ tool if back else tool, reach)
        found |= {f"origin{k}": x for k, x in enumerate(self.rest.origin)} | {"scale": 1 / reach}
        found |= {"half": min((upper - lower) / 2, np.pi)} | self._band(unlimited)
        # The wrist's centre is off by what the tip is, and by its turn about the tip: seen from there its own distance.
        near = max(position_m / reach, 1e-13)  # rounding
        held = np.linalg.norm((frame if back else tool)[:3, 3]) / reach
        return found | {"near": near + angle_rad * held, "near_by": angle_rad * back, "near_turn": angle_rad}

    @cached_property
    def _geometry(self) -> dict[str, float]:
        """Those of the others, and how the free joint's frame lies to theirs."""
        found, reach = geometry_numbers(self.solved), self.solved.axes.reach
        link = _matrix("base", found, reach) @ self._frame
        R, p = link[:3, :3], link[:3, 3] / reach
        found |= _named("link", link, reach)
        for k, equation in enumerate(self.solved.equations, 1):
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

    def _band(self, unlimited: bool) -> dict[str, float]:
        """The least and the most that equation 1's right side is within the limits of joint 3."""
        right = self.solved.equations[0].right
        lower, upper = (end + zeros(self.solved)[2] for end in ends_of(self.solved.axes.axes[2], unlimited))
        top = np.arctan2(right[1], right[0])
        if upper - lower >= TURN:
            at = top + np.array([0.0, np.pi])
        else:
            extremes = top + np.pi * np.arange(-8, 9)
            at = np.array([lower, upper, *extremes[(extremes > lower) & (extremes < upper)]])
        values = right[0] * np.cos(at) + right[1] * np.sin(at)
        return {"right1_low": values.min(), "right1_high": values.max()}

    def standing(self, T: np.ndarray, at: np.ndarray) -> np.ndarray:
        """Poses (N, 4, 4) that the others must reach where the free joint stands ``at`` (N,), as kernels say [rad]."""
        world = np.eye(4)
        world[:3, 3] = self.rest.origin
        world, angle = world @ self.rest.chain.T_world_base, at + self._middle(False)
        turn = np.tile(np.eye(4), (len(T), 1, 1))
        turn[:, 0, 0] = turn[:, 1, 1] = np.cos(angle)
        turn[:, 0, 1], turn[:, 1, 0] = np.sin(angle), -np.sin(angle)
        turn = self._frame @ turn @ np.linalg.inv(self._frame)
        if self.solved.axes.reversed:
            return T @ np.linalg.inv(turn)
        return world @ turn @ np.linalg.inv(world) @ T

    def configurations(self, rows: np.ndarray, at: np.ndarray) -> np.ndarray:
        """Configurations (N, ..., n) of postures (N, ..., 12) of the others where the free joint stands ``at`` (N,)."""
        q = self.rest.configurations(rows)
        if (coordinate := self.free.coordinate) is not None:
            chain = self.rest.chain
            value = (at + self._middle(False) - self.free.offset) * self.free.sign
            value = np.clip(value, chain.lower_limits[coordinate], chain.upper_limits[coordinate])
            q[..., coordinate] = value.reshape(-1, *[1] * (q.ndim - 2))
        return q


def _named(name: str, T: np.ndarray, reach: float) -> dict[str, float]:
    """A motion (4, 4) [m] as kernels take it: rotation by rows, position [reach]."""
    return {f"{name}{k}": x for k, x in enumerate([*T[:3, :3].ravel(), *T[:3, 3] / reach])}


def _matrix(name: str, numbers: dict[str, float], reach: float) -> np.ndarray:
    """The motion (4, 4) [m] of such numbers."""
    T, values = np.eye(4), np.array([numbers[f"{name}{k}"] for k in range(12)])
    T[:3, :3], T[:3, 3] = values[:9].reshape(3, 3), values[9:] * reach
    return T
