"""The job ``two_arm_placement``: where two arms stand best that share targets."""

import math
from collections.abc import Iterator
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import Field

from wsrender.analyses.registry import job_classes
from wsrender.documents.arm import Arm, ArmPath
from wsrender.documents.constraints import ArmsConstraints, Constrained
from wsrender.documents.document import Document
from wsrender.documents.format import JobDocument, example
from wsrender.documents.placements import Mounting, PlacementSpace
from wsrender.documents.quantities import Count, is_none
from wsrender.documents.target_lists import ListedTargets, TargetVolume
from wsrender.documents.targets import Points, Quaternions, Targets
from wsrender.documents.transform import Transform
from wsrender.errors import DocumentError

MOST_PAIRS = 1_000_000_000  # of a placement of either arm
MOST_WITH_HAND_OVER = 1_000_000  # of these where poses of a hand-over are told of each
MOST_POSES = 100_000
SIDES = ("first", "second")
_SHARED = (*ListedTargets.model_fields, *Constrained.model_fields)
PHI, PSI = math.sqrt(2), 1.533751168755204288118041  # of Alexa's spirals: psi^4 = psi + 4


class HandOver(Document):
    """Poses at which one arm may hand something to the other, of the first arm's tip in the world."""

    long_fields: ClassVar[tuple[str, ...]] = ("points_m", "quats_wxyz")

    points_m: Points | None = None
    """Positions, rows of x, y, z [m]; null: a volume is given."""
    quats_wxyz: Quaternions | None = None
    """Orientations, a quaternion w, x, y, z for each point, or one for all; null: each point is tried with all of
    ``orientations``."""
    volume: TargetVolume | None = None
    """Instead of points, the centres of cells that fill a volume, with its orientation or else all of them."""
    orientations: Count = 60
    """How many orientations, spread evenly over all rotations, are tried at points without one of their own."""
    second_in_first: Transform = Transform()
    """How the second arm's tip stands in the first's at a hand-over; without it both tips are at the same pose, with
    {"rpy_deg": [180, 0, 0]} they face each other."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if (self.points_m is None) == (self.volume is None):
            yield "points_m", 'must be given, or else "volume": one of the two'
            return
        if self.volume and self.volume.free_axis:
            yield "volume.free_axis", "must not be given: a hand-over is a whole pose"
        if self.volume and self.quats_wxyz is not None:
            yield "quats_wxyz", 'must not be given beside "volume", which says its own orientation'
        if self.points_m:
            yield from Targets.model_construct(points_m=self.points_m, quats_wxyz=self.quats_wxyz).conflicts()
        if self.count > MOST_POSES:
            yield "orientations", f"would make {self.count:,} poses, allowed are {MOST_POSES:,}"

    @property
    def _turned(self) -> bool:
        """Whether points say how tips stand."""
        return (self.volume.quat_wxyz if self.volume else self.quats_wxyz) is not None

    @property
    def _points(self) -> np.ndarray:
        return self.volume.points if self.volume else np.array(self.points_m)

    @property
    def count(self) -> int:
        """How many poses there are; of a ball at most."""
        points = math.prod(self.volume.cells) if self.volume else len(self.points_m or ())
        return points * (1 if self._turned else self.orientations)

    @property
    def poses(self) -> tuple[np.ndarray, np.ndarray]:
        """Positions (N, 3) [m] and quaternions (N, 4): of a point all of its orientations follow one another."""
        points = self._points
        if not self._turned:
            quats = spread_rotations(self.orientations)
            return np.repeat(points, len(quats), axis=0), np.tile(quats, (len(points), 1))
        given = self.quats_wxyz if self.volume is None else [self.volume.quat_wxyz] * len(points)
        return points, np.array(given)


def spread_rotations(count: int) -> np.ndarray:
    """Quaternions (count, 4) of super-Fibonacci spirals, which spread evenly over all rotations (Alexa 2022)."""
    s = np.arange(count) + 0.5
    r, R, alpha, beta = np.sqrt(s / count), np.sqrt(1 - s / count), 2 * np.pi * s / PHI, 2 * np.pi * s / PSI
    return np.stack([r * np.sin(alpha), r * np.cos(alpha), R * np.sin(beta), R * np.cos(beta)], axis=1)


class ArmOnBase(Arm):
    """An arm, and where its base may stand."""

    over: PlacementSpace
    """Where the base may stand; numbers alone hold it in one place. ``robot.placement`` is how it stands there."""
    mounting: Mounting = "floor"
    """How the base is mounted in the frame that is placed, before ``robot.placement``: its z is that frame's z on the
    floor, its x on a wall, its -z under a ceiling."""


class TwoArmPlacementJob(ListedTargets, Constrained, JobDocument):
    """Which of two arms serves which targets, and where they stand so that one or the other serves most of them.

    Either base stands in one place or anywhere in a space. Of pairs of placements that serve the same weight that is
    best of which both arms serve most. At the targets the arms are taken to work in turn: nothing is said of collisions
    of one with the other. With ``hand_over`` pairs of placements from which there is a pose that both can hold at once
    come before those without, and of pairs that serve the same weight that is best which offers most of these poses.
    Targets, constraints, which either arm must satisfy, and environment stand in the world.
    """

    model_config = example(
        analysis="two_arm_placement",
        targets=[
            {"position_m": [0.4, -0.1, 0.3], "quat_wxyz": [0, 1, 0, 0], "name": "near"},
            {"position_m": [1.6, 0.3, 0.2], "quat_wxyz": [0, 1, 0, 0], "weight": 2},
        ],
        first={"robot": {"library": "ur5e"}, "over": {"x_m": [-0.2, 0.4, 0.2]}},
        second={"robot": {"library": "puma560"}, "over": {"x_m": [0.6, 2.4, 0.2], "y_m": [-0.4, 0.8, 0.2]}},
    )

    long_fields: ClassVar[tuple[str, ...]] = ListedTargets.long_fields

    analysis: Literal["two_arm_placement"] = "two_arm_placement"
    """Name of the analysis."""
    first: ArmOnBase
    """One arm, and where it may stand."""
    second: ArmOnBase
    """The other."""
    hand_over: Annotated[HandOver | None, Field(exclude_if=is_none)] = None
    """Poses at which the arms may hand something over; null: none is asked for."""
    constraints: ArmsConstraints | None = None  # pyright: ignore[reportIncompatibleVariableOverride]
    """Which configurations of both arms are admitted, and which of a hand-over's they may be in together; null: all."""

    def arms(self) -> dict[ArmPath, Arm]:
        """Both arms by their paths."""
        return {(side,): getattr(self, side) for side in SIDES}

    def sweeps(self) -> list[Any]:
        """None: no joint space is sampled."""
        return []

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        faults = [*super().conflicts()]
        yield from faults
        for side in SIDES if not faults else ():
            try:
                _ = self.placements(side)
            except DocumentError as error:
                own = ("over", "mounting")
                yield from ((f"{side}.{f}" if f.startswith(own) else f, message) for f, message in error.problems)
        counts = [getattr(self, side).over.count for side in SIDES]
        most, told = (MOST_WITH_HAND_OVER, " beside hand_over") if self.hand_over else (MOST_PAIRS, "")
        if math.prod(counts) > most:
            each = " × ".join(f"{count:,}" for count in counts)
            yield "first.over", f"must have at most {most:,} pairs with second.over{told}, not {each}"
        if self.constraints and self.constraints.arms_collision and not self.hand_over:
            yield "constraints.arms_collision", 'must not be given without "hand_over": the arms work in turn'

    def placements(self, side: str, *, at_hand_over: bool = False) -> Any:
        """The ``base_placement`` job of one arm, for targets or for poses of the hand-over; raises DocumentError."""
        arm = getattr(self, side)
        given = {name: getattr(self, name) for name in _SHARED}
        given["constraints"] = self.constraints and self.constraints.of_each
        own = {name: getattr(arm, name) for name in ArmOnBase.model_fields}
        if at_hand_over:
            assert self.hand_over
            position, quat = self.hand_over.poses
            if side == SIDES[1]:
                position, quat = _seen_by_second(position, quat, self.hand_over.second_in_first)
            given |= {"targets": None, "points_m": position.tolist(), "quats_wxyz": quat.tolist()}
        return job_classes()["base_placement"](**given, **own, refine=False)


def _seen_by_second(position: np.ndarray, quat: np.ndarray, T: Transform) -> tuple[np.ndarray, np.ndarray]:
    """Poses of the second arm's tip where the first's is at ``position`` (N, 3) [m] and ``quat`` (N, 4)."""
    from scipy.spatial.transform import Rotation  # documents are read without it

    first, T_first_second = Rotation.from_quat(quat, scalar_first=True), T.matrix()
    turned = first * Rotation.from_matrix(T_first_second[:3, :3])
    return position + first.apply(T_first_second[:3, 3]), turned.as_quat(scalar_first=True)
