"""The job ``inverse_reachability``: from which base poses a robot reaches one target."""

from collections.abc import Iterator
from typing import Any, Literal

from pydantic import StrictBool

from wsrender.analyses.registry import job_classes
from wsrender.documents.arm import Arm
from wsrender.documents.constraints import Constrained
from wsrender.documents.format import JobDocument, example
from wsrender.documents.placements import Mounting, PlacementSpace
from wsrender.documents.target_lists import Target
from wsrender.documents.targets import WeighedDeciding
from wsrender.documents.transform import Transform
from wsrender.errors import DocumentError

POSITIONS = ("x_m", "y_m", "z_m")
_ON_LATTICE = 1e-6  # of a cell
_SHARED = (
    *("robot", "base", "tip", "constraints", "environment", "gravity_m_s2", "over", "mounting", "use_symmetry"),
    *WeighedDeciding.model_fields,
)


class InverseReachabilityJob(WeighedDeciding, Constrained, Arm, JobDocument):
    """From which base poses of a space a robot reaches one target: a map over x and y, or a volume over x, y and z.

    What ``base_placement`` decides of one target, kept base by base. Target, constraints and environment stand in the
    world.
    """

    model_config = example(
        analysis="inverse_reachability",
        robot={"library": "ur5e"},
        target={"position_m": [0.1, 0.05, 0.3], "rpy_deg": [180, 0, 0]},
        over={"x_m": [-0.6, 1.2, 0.2], "y_m": [-0.9, 0.9, 0.2], "yaw_deg": [0, 360, 90]},
    )

    analysis: Literal["inverse_reachability"] = "inverse_reachability"
    """Name of the analysis."""
    target: Target
    """The pose of the tip, or point, that is to be reached."""
    object_frame: Transform | None = None
    """Frame in the world in which the target is given, such as that of a part; null: the world itself."""
    over: PlacementSpace
    """Where the base may stand. ``robot.placement`` is how it stands in the frame that is placed. Of ranges in x, y and
    z the cells are voxels: of one step, which divides their lower ends."""
    mounting: Mounting = "floor"
    """How the base is mounted in the frame that is placed, before ``robot.placement``: its z is that frame's z on the
    floor, its x on a wall, its -z under a ceiling."""
    use_symmetry: StrictBool = True
    """Whether one yaw alone is decided where others change nothing but the first joint's value."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        yield from super().conflicts()
        try:
            _ = self.placements
        except DocumentError as error:
            yield from error.problems
        ranges = [(name, self.over.ranges[name]) for name in POSITIONS if name in self.over.ranges]
        if len(ranges) < len(POSITIONS):
            return
        _, (_, _, edge) = ranges[0]
        for name, (lower, _, step) in ranges:
            if abs(step / edge - 1) > _ON_LATTICE:
                yield f"over.{name}", f"must have the step of over.x_m, {edge:g}, not {step:g}: its cells are voxels"
            elif abs(lower / edge - round(lower / edge)) > _ON_LATTICE:
                yield f"over.{name}", f"must begin at a multiple of its step, {step:g}, not at {lower:g}: voxels do"

    @property
    def placements(self) -> Any:
        """The ``base_placement`` job of the target alone; raises DocumentError."""
        given = {name: getattr(self, name) for name in _SHARED}
        return job_classes()["base_placement"](**given, targets=[self.target_in_world], refine=False)

    @property
    def target_in_world(self) -> Target:
        """The target as it stands in the world."""
        from scipy.spatial.transform import Rotation  # documents are read without it

        if self.object_frame is None:
            return self.target
        target, T = self.target, self.object_frame.matrix()
        oriented = target.quat_wxyz is not None or target.rpy_deg is not None
        own = Transform(position_m=target.position_m, quat_wxyz=target.quat_wxyz, rpy_deg=target.rpy_deg)
        T = T @ own.matrix()
        quat = Rotation.from_matrix(T[:3, :3]).as_quat(scalar_first=True).tolist() if oriented else None
        return target.model_copy(
            update={"position_m": tuple(T[:3, 3].tolist()), "quat_wxyz": quat and tuple(quat), "rpy_deg": None}
        )
