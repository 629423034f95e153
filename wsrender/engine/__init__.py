"""The only host code that talks to Warp: devices, packing, chunking, launches and partial results."""

from wsrender_kernels.closed_form import REACHABLE, UNDECIDED, UNREACHABLE

from wsrender.engine.closed_form import (
    CLOSED_MARGIN,
    ClosedPostures,
    closed_labels,
    closed_postures,
    placed_bits,
    placed_slacks,
)
from wsrender.engine.devices import devices_of, target_of, thread_count
from wsrender.engine.drawn_configurations import configurations
from wsrender.engine.free_joint import FreeJointSearch, search_free_joint
from wsrender.engine.index_units import units_of
from wsrender.engine.inverse import Accuracy, Tries, solve_inverse, try_bytes
from wsrender.engine.kinematics import EvaluatedKinematics, evaluate_kinematics, evaluate_poses
from wsrender.engine.membership import (
    LegTest,
    OrientationCounts,
    count_orientations,
    count_orientations_at,
    joined,
    poses_reached,
)
from wsrender.engine.open_wrist import open_wrist_postures, search_open_wrist
from wsrender.engine.partial import Partial, merge
from wsrender.engine.rows import Evaluated, evaluate_samples, evaluated_of, sampled_positions
from wsrender.engine.slabs import fitted
from wsrender.engine.sweep_plan import SweepPlan, label_bytes, sweep

__all__ = [
    "CLOSED_MARGIN",
    "REACHABLE",
    "UNDECIDED",
    "UNREACHABLE",
    "Accuracy",
    "ClosedPostures",
    "Evaluated",
    "EvaluatedKinematics",
    "FreeJointSearch",
    "LegTest",
    "OrientationCounts",
    "Partial",
    "SweepPlan",
    "Tries",
    "closed_labels",
    "closed_postures",
    "configurations",
    "count_orientations",
    "count_orientations_at",
    "devices_of",
    "evaluate_kinematics",
    "evaluate_poses",
    "evaluate_samples",
    "evaluated_of",
    "fitted",
    "joined",
    "label_bytes",
    "merge",
    "open_wrist_postures",
    "placed_bits",
    "placed_slacks",
    "poses_reached",
    "sampled_positions",
    "search_free_joint",
    "search_open_wrist",
    "solve_inverse",
    "sweep",
    "target_of",
    "thread_count",
    "try_bytes",
    "units_of",
]
