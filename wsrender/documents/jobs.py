"""Job documents: what to analyse, one discriminated union on ``analysis``."""

from typing import Annotated, get_args

from pydantic import BeforeValidator, Discriminator

from wsrender.documents.analysed_jobs import AnyAnalysedJob
from wsrender.documents.design import DesignOptimizationJob
from wsrender.documents.document import Document
from wsrender.documents.problems import tagged

_AnyJob = AnyAnalysedJob | DesignOptimizationJob
ANALYSES: dict[str, type[Document]] = {job.model_fields["analysis"].default: job for job in get_args(_AnyJob)}

Job = Annotated[_AnyJob, Discriminator("analysis"), BeforeValidator(tagged("analysis", ANALYSES))]
