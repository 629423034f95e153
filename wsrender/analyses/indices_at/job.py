"""The job ``indices_at``: local indices at given configurations."""

from collections.abc import Iterator
from typing import Annotated, Any, ClassVar, Literal, get_args

from pydantic import BeforeValidator, Field

from wsrender.documents.arm import Arm
from wsrender.documents.array_files import ArrayFile
from wsrender.documents.constraints import Constrained
from wsrender.documents.format import JobDocument, example
from wsrender.documents.options import Configurations, IndexChoices, Precision
from wsrender.documents.quantities import distinct, is_empty, sequence

MOST_DRAWN = 20  # configurations whose polytopes are made
Kind = Literal["velocity", "force", "acceleration"]


def _kinds(value: Any) -> tuple[Any, ...]:
    """The kinds in one order, so that equal jobs have equal documents; what is none of them is refused as it is."""
    asked = distinct(found) if (found := sequence(value)) else ()
    return tuple(sorted(asked, key=lambda kind: get_args(Kind).index(kind) if kind in get_args(Kind) else -1))


Polytopes = Annotated[tuple[Kind, ...], Field(exclude_if=is_empty), BeforeValidator(_kinds)]


class IndicesAtJob(IndexChoices, Constrained, Arm, JobDocument):
    """Local indices at given configurations."""

    model_config = example(
        analysis="indices_at",
        robot={"library": "ur5e"},
        configurations=[[0.0, -1.5, 1.5, 0.0, 1.0, 0.0]],
        indices=["manipulability", "inverse_condition_number"],
    )

    long_fields: ClassVar[tuple[str, ...]] = ("configurations",)

    analysis: Literal["indices_at"] = "indices_at"
    """Name of the analysis."""
    configurations: Configurations
    """Rows of joint values [rad or m], one per joint from base to tip, or a single one; or a file of them,
    {"path": "rows.npy"}, with columns in that order or named as the joints."""
    polytopes: Polytopes = ()
    """Polytopes of the tip at each of at most 20 configurations, as meshes: "velocity", "force", "acceleration"; in the
    linear rows of the task, and in float64."""
    precision: Precision = "float64"
    """Floating-point type of the kernels."""

    def conflicts(self) -> Iterator[tuple[str, str]]:
        """(field, message) of every pair of fields that do not go together."""
        yield from super().conflicts()
        if not isinstance(self.configurations, ArrayFile) and self.too_many(len(self.configurations)):
            yield "polytopes", self.too_many(len(self.configurations))

    def too_many(self, count: int) -> str:
        """Why polytopes must not be given with so many configurations; empty: they may."""
        if not self.polytopes or count <= MOST_DRAWN:
            return ""
        return f"must not be given with {count} configurations; {MOST_DRAWN} at most"

    @property
    def needs_ranges(self) -> bool:
        """No: the configurations are given. Where the ends of ranges are penalised, the evaluation asks for them."""
        return False
