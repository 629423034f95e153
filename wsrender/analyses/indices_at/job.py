"""The job ``indices_at``: local indices at given configurations."""

from typing import ClassVar, Literal

from wsrender.documents.arm import Arm
from wsrender.documents.constraints import Constrained
from wsrender.documents.format import JobDocument
from wsrender.documents.options import Configurations, IndexChoices


class IndicesAtJob(IndexChoices, Constrained, Arm, JobDocument):
    """Local indices at given configurations."""

    long_fields: ClassVar[tuple[str, ...]] = ("configurations",)

    analysis: Literal["indices_at"] = "indices_at"
    """Name of the analysis."""
    configurations: Configurations
    """Rows of joint values [rad or m], one per joint from base to tip."""
    precision: Literal["float32", "float64"] = "float64"
    """Floating-point type of the kernels."""

    @property
    def needs_ranges(self) -> bool:
        """No: the configurations are given. Where the ends of ranges are penalised, the evaluation asks for them."""
        return False
