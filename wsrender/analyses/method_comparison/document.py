"""The form of the result documents of the analysis ``method_comparison``."""

from typing import Literal

from wsrender.results.document import ResultDocument, ResultPart


class NamedMechanism(ResultPart):
    """The mechanism."""

    name: str
    """Its name."""


class ExactVolume(ResultPart):
    """Volume [m³]."""

    exact: float
    """The exact one."""


class MethodRun(ResultPart):
    """A run of a method."""

    method: str
    """Which."""
    size_m: float | None
    """Edge of its voxels or triangles [m]; null: it has none."""
    volume_m3: float
    """What it gives [m³]."""
    relative_error: float | None
    """From the exact volume; null: that is 0."""


class MethodComparisonResult(ResultDocument):
    """Methods beside each other."""

    analysis: Literal["method_comparison"]
    """Name of the analysis."""
    mechanism: NamedMechanism
    """The mechanism."""
    volume_m3: ExactVolume
    """Volume [m³]."""
    methods: list[MethodRun]
    """Runs; their times stand in `timing_s`."""
