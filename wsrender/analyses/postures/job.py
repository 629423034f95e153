"""The job ``postures``: all configurations of given poses."""

import math
from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal

from pydantic import BeforeValidator, Field, StrictBool

from wsrender.documents.arm import Arm
from wsrender.documents.constraints import Constrained
from wsrender.documents.format import JobDocument, example
from wsrender.documents.options import IndexChoices, IndicesOrNone, Precision
from wsrender.documents.quantities import Seed, integer, real
from wsrender.documents.target_lists import UNIT, ListOrTable, is_none
from wsrender.documents.targets import Points, Quaternions


class PosturesJob(IndexChoices, Constrained, Arm, JobDocument):
    """All configurations of given poses: every posture, windings counted apart.

    Arms with a closed form give all there are; of others those that a search finds; of arms with a joint more than the
    pose has freedoms, curves of them. Constraints and environment say of
    each posture whether it is free.
    """

    model_config = example(
        analysis="postures",
        robot={"library": "ur5e"},
        position_m=[0.4, 0.2, 0.3],
        quat_wxyz=[0.0, 1.0, 0.0, 0.0],
    )

    long_fields: ClassVar[tuple[str, ...]] = ("position_m", "quat_wxyz", "targets")

    analysis: Literal["postures"] = "postures"
    """Name of the analysis."""
    position_m: Points | None = None
    """Positions of the tip in the world frame, rows of x, y, z, or a single one [m]; null: targets are given."""
    quat_wxyz: Quaternions | None = None
    """Orientations, a quaternion w, x, y, z of unit length for each position, or one for all; null: any
    orientation will do."""
    free_axis: Annotated[Literal["x", "y", "z"] | None, Field(exclude_if=is_none)] = None
    """Axis of the tip about which it may turn as it likes; null: none."""
    targets: Annotated[ListOrTable | None, Field(exclude_if=is_none)] = None
    """Instead of position_m and quat_wxyz: targets one by one, or as a table in a file, {"path": "holes.csv"}, or a
    volume to cover. All say an orientation or none does, and one free axis serves all; their weights and tolerances
    change nothing, for postures are those of the pose itself."""
    windings: Annotated[int, Field(ge=1, le=4096), BeforeValidator(integer)] = 1
    """How many configurations of a posture are listed that differ by whole turns of hinges; all are counted."""
    starts: Annotated[int, Field(ge=1, le=65536), BeforeValidator(integer)] = 512
    """Starts of the search for postures of a pose, where no closed form knows them all."""
    curve_step: Annotated[float, Field(gt=0, le=0.2), BeforeValidator(real)] = 0.05
    """Between points of self-motions: largest change of a joint, about [rad, reaches]."""
    aspects: StrictBool = False
    """Whether it is told which listed configurations of a pose connect without a singular one on the way."""
    indices: IndicesOrNone = ()
    """Local indices of every configuration: "kinematic", "dynamic", "all", or a list of names; empty: none."""
    seed: Seed = 0
    """Seed of the starts."""
    precision: Precision = "float64"
    """Floating-point type of the indices; postures are computed in double."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        yield from super().conflicts()
        if (self.position_m is None) == (self.targets is None):
            yield "position_m", 'must be given, or else "targets": one of the two'
        if self.position_m is None:
            if self.quat_wxyz is not None:
                yield "quat_wxyz", 'must not be given without "position_m": targets say their own orientations'
            return
        if self.quat_wxyz is None:
            if self.free_axis is not None:
                yield "free_axis", 'must not be given without "quat_wxyz", of which it is an axis'
            return
        if len(self.quat_wxyz) != len(self.position_m):
            rows = f"{len(self.position_m)}, not {len(self.quat_wxyz)}"
            yield "quat_wxyz", f"must have as many rows as position_m, {rows}"
        for k, quat in enumerate(self.quat_wxyz):
            if abs((length := math.hypot(*quat)) - 1) > UNIT:
                yield "quat_wxyz", f"must be of unit length: row {k} has length {length:.6g}"
                return
