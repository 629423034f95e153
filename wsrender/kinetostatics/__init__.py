"""Kinetostatic rendering: limits and conditioning of a robot as forces that a person can feel ([CB])."""

from wsrender.kinetostatics.characteristic_length import (
    CharacteristicLength,
    condition_number,
    conditioning_length,
    homogeneous,
    least_condition_length,
    rms_length,
)
from wsrender.kinetostatics.force_fields import FieldState, ForceField, force_field, posture_tables

__all__ = [
    "CharacteristicLength",
    "FieldState",
    "ForceField",
    "condition_number",
    "conditioning_length",
    "force_field",
    "homogeneous",
    "least_condition_length",
    "posture_tables",
    "rms_length",
]
