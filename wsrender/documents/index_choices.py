"""The fields shared by all jobs that evaluate local indices."""

from collections.abc import Iterator
from typing import Literal

from pydantic import Field, StrictBool

from wsrender.documents.document import Document
from wsrender.documents.options import Device, IndexOptions, Indices, Penalty, Task
from wsrender.documents.quantities import PositiveNumber


class IndexChoices(Document):
    """Which local indices are evaluated, and how."""

    indices: Indices = "kinematic"
    """Local indices: "kinematic", "dynamic", "all", or a list of names."""
    index_options: IndexOptions = Field(default={})
    """Options of the indices that have any: {index: {option: value}}."""
    task: Task = "linear"
    """Rows of the Jacobian, in base axes: "linear", "angular", "full", or a list from x y z rx ry rz."""
    characteristic_length_m: PositiveNumber = 1.0
    """Length that divides the linear rows of a task that mixes linear and angular rows [m]."""
    convention: Literal["standard", "table_1", "wsrender_code"] = "standard"
    """Which definition of the indices: the standard one, Table I of the WSRender paper, or its program."""
    joint_limit_penalty: Penalty = None
    """K of the joint-limit penalisation [1]; null or false: off; true: 10."""
    torque_scaling: StrictBool = False
    """Whether dynamic indices scale every joint by its largest effort [N m or N]."""
    inertia: Literal["kernel", "mujoco"] = "kernel"
    """What evaluates the joint-space inertia: the kernels, or MuJoCo itself."""
    precision: Literal["float32", "float64"] = "float32"
    """Floating-point type of the kernels."""
    device: Device = "auto"
    """Where the kernels run: "auto" (a GPU if there is one), "cpu", "cuda" or "cuda:N"."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        if self.convention == "wsrender_code":
            if self.task not in ("linear", "full"):
                yield "task", 'must be left at "linear": the convention "wsrender_code" chooses its own rows'
            if self.precision == "float32":
                yield "precision", 'must be "float64" with the convention "wsrender_code", not "float32"'
            if self.torque_scaling:
                yield "torque_scaling", 'must be false with the convention "wsrender_code", which has none'
        elif self.torque_scaling and self.indices == "kinematic":
            yield "torque_scaling", "must be false with kinematic indices: it scales dynamic ones"
