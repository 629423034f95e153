"""Talking to a job server; needs nothing but the base dependencies."""

from wsrender.client.async_batch import AsyncBatch
from wsrender.client.async_client import AsyncClient
from wsrender.client.async_job import AsyncJob
from wsrender.client.batch import Batch
from wsrender.client.client import Client
from wsrender.client.job import Job
from wsrender.client.kinetostatic_stream import KinetostaticStream
from wsrender.client.remote_result import RemoteResult

__all__ = ["AsyncBatch", "AsyncClient", "AsyncJob", "Batch", "Client", "Job", "KinetostaticStream", "RemoteResult"]
