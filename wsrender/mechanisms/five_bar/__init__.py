"""The five-bar: kinematics in all modes, workspace, singularities, aspects and conditioning ([CB])."""

from wsrender.mechanisms.five_bar.condition_numbers import (
    Conditioning,
    conditioning,
    conditioning_gradients,
    jacobian,
    parallel_jacobian,
    serial_jacobian,
)
from wsrender.mechanisms.five_bar.mechanism import ASSEMBLY_MODES, WORKING_MODES, FiveBar
from wsrender.mechanisms.five_bar.region import workspace

__all__ = [
    "ASSEMBLY_MODES",
    "WORKING_MODES",
    "Conditioning",
    "FiveBar",
    "conditioning",
    "conditioning_gradients",
    "jacobian",
    "parallel_jacobian",
    "serial_jacobian",
    "workspace",
]
