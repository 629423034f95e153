"""Job documents (pydantic), shared by Python, the command line and the server."""

from wsrender.spec.jobs import ANALYSES, IndicesAtJob, Job, WorkspaceJob
from wsrender.spec.parsing import canonical_json, job_schema, parse_job

__all__ = ["ANALYSES", "IndicesAtJob", "Job", "WorkspaceJob", "canonical_json", "job_schema", "parse_job"]
