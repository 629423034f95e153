"""Running a job, in the four steps that every door uses: plan, run_shard, merge, finish."""

from wsrender.run.design_from_python import design_optimization
from wsrender.run.mechanisms_from_python import five_bar, method_comparison, parallel_workspace
from wsrender.run.patches_from_python import boundary_patches
from wsrender.run.planar_from_python import exact_boundary, planar_boundary
from wsrender.run.robot_from_python import analyze, kinetostatic_field
from wsrender.run.several_from_python import (
    collaborative_volume,
    master_slave_mapping,
    robot_comparison,
    shared_workspace,
)
from wsrender.run.steps import Plan, execute, finish, merge, plan, run_shard

__all__ = [
    "Plan",
    "analyze",
    "boundary_patches",
    "collaborative_volume",
    "design_optimization",
    "exact_boundary",
    "execute",
    "finish",
    "five_bar",
    "kinetostatic_field",
    "master_slave_mapping",
    "merge",
    "method_comparison",
    "parallel_workspace",
    "plan",
    "planar_boundary",
    "robot_comparison",
    "run_shard",
    "shared_workspace",
]
