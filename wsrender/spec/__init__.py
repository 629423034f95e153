"""Job documents (pydantic), shared by Python, the command line and the server."""

from wsrender.spec.analysed_jobs import IndicesAtJob, WorkspaceJob
from wsrender.spec.boundary_patches import BoundaryPatchesJob
from wsrender.spec.capability import CapabilityJob
from wsrender.spec.collaborative import CollaborativeVolumeJob
from wsrender.spec.design import DesignOptimizationJob
from wsrender.spec.five_bar import FiveBarJob
from wsrender.spec.jobs import ANALYSES, Job
from wsrender.spec.kinetostatics import KinetostaticFieldJob
from wsrender.spec.mapping import MasterSlaveMappingJob
from wsrender.spec.method_comparison import MethodComparisonJob
from wsrender.spec.parallel_workspace import ParallelWorkspaceJob
from wsrender.spec.parsing import canonical_json, job_schema, parse_job
from wsrender.spec.planar_boundary import PlanarBoundaryJob
from wsrender.spec.reachability import ReachabilityJob
from wsrender.spec.several_robots import RobotComparisonJob, SharedWorkspaceJob

__all__ = [
    "ANALYSES",
    "BoundaryPatchesJob",
    "CapabilityJob",
    "CollaborativeVolumeJob",
    "DesignOptimizationJob",
    "FiveBarJob",
    "IndicesAtJob",
    "Job",
    "KinetostaticFieldJob",
    "MasterSlaveMappingJob",
    "MethodComparisonJob",
    "ParallelWorkspaceJob",
    "PlanarBoundaryJob",
    "ReachabilityJob",
    "RobotComparisonJob",
    "SharedWorkspaceJob",
    "WorkspaceJob",
    "canonical_json",
    "job_schema",
    "parse_job",
]
