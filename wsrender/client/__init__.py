"""Talking to a job server; needs nothing but the base dependencies."""

from wsrender.client.batch import Batch
from wsrender.client.client import Client
from wsrender.client.job import Job
from wsrender.client.kinetostatic_stream import KinetostaticStream

__all__ = ["Batch", "Client", "Job", "KinetostaticStream"]
