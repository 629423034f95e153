"""Inverse kinematics of an arm in closed form."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from wsrender.robots.chain import Chain
from wsrender.robots.closed_form.axes import JOINTS, Axes
from wsrender.robots.closed_form.classes import SolvedClass, solved_class
from wsrender.robots.closed_form.numbers import geometry_numbers, limit_numbers, motion_of, named_motion, zeros
from wsrender.robots.kinematics import Kinematics

FREE = {"pose": 0, "axis": 1, "position": 3}  # freedoms that targets of a kind leave open


@dataclass(frozen=True, eq=False)
class ClosedForm:
    """All configurations of a ``chain`` that reach targets of a ``kind``: "pose", "axis" (the tip's z) or "position".

    ``solved`` says how: the chain's joints, in what order, and joints that it does not have, held or free. The chain
    stands in a world whose origin is at ``origin`` (3,) [m].
    """

    chain: Chain
    origin: np.ndarray
    kind: str
    solved: SolvedClass

    @classmethod
    def of(cls, chain: Kinematics, kind: str = "pose") -> "ClosedForm | None":
        """The closed form of a chain, from its axes; None where it has none of those that are known here."""
        if chain.geometry is None:
            return None
        near = chain.geometry.relative_to(chain.origin)
        axes = Axes.of(near)
        if axes is None or len(axes.axes) + FREE[kind] > JOINTS:
            return None
        if FREE[kind]:
            axes = axes.free(list(axes.T_tip[:3, [2, 0, 1][: FREE[kind]]].T))
        solved = solved_class(axes)
        return None if solved is None else cls(near, chain.origin, kind, solved)

    @property
    def name(self) -> str:
        """The class in words."""
        return self.solved.name

    @cached_property
    def _geometry(self) -> dict[str, float]:
        return geometry_numbers(self.solved)

    def numbers(self, unlimited: bool = False) -> dict[str, float]:
        """What kernels take, by name; ``unlimited``: as if hinges had no limits."""
        return self._geometry | (limit_numbers(self.solved, True) if unlimited else self._limits)

    @cached_property
    def _limits(self) -> dict[str, float]:
        return limit_numbers(self.solved)

    def targets(self, T: np.ndarray) -> np.ndarray:
        """Poses (N, 4, 4) in the world as those that are solved for, (N, 12): rotation by rows, position [reach]."""
        T = T.copy()
        T[:, :3, 3] -= self.origin
        T = np.linalg.inv(self.chain.T_world_base) @ T
        if self.solved.axes.reversed:
            T = np.linalg.inv(T)
        return np.concatenate([T[:, :3, :3].reshape(-1, 9), T[:, :3, 3] / self.solved.axes.reach], axis=1)

    def bases(self, T_world_base: np.ndarray) -> np.ndarray:
        """Where the base stands, (N, 4, 4) in the world, as rows (N, 12) that kernels take in place of `targets`."""
        R, p = T_world_base[:, :3, :3], T_world_base[:, :3, 3] / self.solved.axes.reach
        if not self.solved.axes.reversed:
            R, p = R.transpose(0, 2, 1), -np.einsum("nji,nj->ni", R, p)
        return np.concatenate([R.reshape(-1, 9), p], axis=1)

    def numbers_to(self, T_world_tip: np.ndarray) -> dict[str, float]:
        """What kernels take that solve for one pose (4, 4) in the world from any of the `bases`, by name."""
        numbers, name = self.numbers(), "base" if self.solved.axes.reversed else "tool"
        T, scaled = np.eye(4), T_world_tip.copy()
        values = np.array([numbers[f"{name}{k}"] for k in range(12)])
        T[:3, :3], T[:3, 3] = values[:9].reshape(3, 3), values[9:]
        scaled[:3, 3] /= self.solved.axes.reach
        T = T @ np.linalg.inv(scaled) if self.solved.axes.reversed else scaled @ T
        return numbers | {f"{name}{k}": x for k, x in enumerate([*T[:3, :3].ravel(), *T[:3, 3]])}

    def numbers_in_world(self) -> dict[str, float]:
        """What kernels take that solve for poses as they are in the world, by name."""
        found, axes, world = self.numbers(), self.solved.axes, self.chain.T_world_base
        name = "tool" if axes.reversed else "base"
        T = motion_of(name, found, axes.reach)
        found |= named_motion(name, world @ T if axes.reversed else T @ np.linalg.inv(world), axes.reach)
        return found | {f"origin{k}": x for k, x in enumerate(self.origin)} | {"scale": 1 / axes.reach}

    def configurations(self, rows: np.ndarray) -> np.ndarray:
        """Configurations (..., n) of what kernels give of postures, (..., 12), moved into the limits."""
        chain, axes, zero = self.chain, self.solved.axes, zeros(self.solved)
        values = np.arctan2(rows[..., 1::2], rows[..., ::2])
        self._part(values, rows)
        q = np.empty((*rows.shape[:-1], chain.n))
        q[...] = (chain.lower_limits + chain.upper_limits) / 2
        for k, axis in enumerate(axes.axes):
            if axis.coordinate is None:
                continue
            if axis.revolute:
                ends = (axis.lower, axis.upper) if np.isfinite(axis.upper - axis.lower) else (-np.pi, np.pi)
                middle = sum(ends) / 2
                moved = middle + np.remainder(values[..., k] - zero[k] - middle + np.pi, 2 * np.pi) - np.pi
            else:
                moved = rows[..., 2 * k] * axes.reach - zero[k]
            low, high = chain.lower_limits[axis.coordinate], chain.upper_limits[axis.coordinate]
            q[..., axis.coordinate] = np.clip((moved - axis.offset) * axis.sign, low, high)
        return q

    def _part(self, values: np.ndarray, rows: np.ndarray) -> None:
        """Of families, whose sum or difference of joints 4 and 6 is all that is known, a member within the limits."""
        family = np.abs(rows[..., 10]) > 3
        if not family.any():
            return
        sign, axes, zero = np.sign(rows[..., 10]), self.solved.axes.axes, zeros(self.solved)
        (middle4, half4), (middle6, half6) = (
            ((axes[k].lower + axes[k].upper) / 2 + zero[k], (axes[k].upper - axes[k].lower) / 2) for k in (3, 5)
        )
        off = np.remainder(values[..., 3] - middle4 - sign * middle6 + np.pi, 2 * np.pi) - np.pi
        share = half4 / (half4 + half6) if half4 + half6 > 0 else 0.5
        values[..., 3] = np.where(family, middle4 + share * off, values[..., 3])
        values[..., 5] = np.where(family, middle6 + sign * (1 - share) * off, values[..., 5])
