from typing import Literal

from wsrender.documents.arm import Arm


class MiddleTipJob(Arm):
    """Where the tip is in the middle of the joints' ranges."""

    analysis: Literal["middle_tip"] = "middle_tip"
    """Name of the analysis."""
    upwards: bool = False
    """Whether the height alone is wanted."""
