"""Job documents (pydantic), shared by Python, the command line and the server."""

from wsrender.documents.analysed_jobs import IndicesAtJob, WorkspaceJob
from wsrender.documents.boundary_patches import BoundaryPatchesJob
from wsrender.documents.capability import CapabilityJob
from wsrender.documents.collaborative import CollaborativeVolumeJob
from wsrender.documents.design import DesignOptimizationJob
from wsrender.documents.five_bar import FiveBarJob
from wsrender.documents.jobs import ANALYSES, Job
from wsrender.documents.kinetostatics import KinetostaticFieldJob
from wsrender.documents.mapping import MasterSlaveMappingJob
from wsrender.documents.method_comparison import MethodComparisonJob
from wsrender.documents.parallel_workspace import ParallelWorkspaceJob
from wsrender.documents.parsing import canonical_json, job_schema, parse_job
from wsrender.documents.planar_boundary import PlanarBoundaryJob
from wsrender.documents.reachability import ReachabilityJob
from wsrender.documents.several_robots import RobotComparisonJob, SharedWorkspaceJob

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
