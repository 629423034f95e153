"""Metrics for Prometheus."""

from collections.abc import Iterable

from prometheus_client import CollectorRegistry, Counter, Gauge, Histogram, generate_latest

from wsrender_server.jobs.records import QueueSummary, WorkerRecord

MEDIA_TYPE = "text/plain; version=0.0.4; charset=utf-8"
SECONDS = (0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 60.0)


class Metrics:
    """Counts of this process's requests, and what the job table says at the moment of asking."""

    def __init__(self):
        self.registry = CollectorRegistry()
        labels = ("method", "route", "status")
        self.requests = Counter("wsrender_http_requests", "Requests answered.", labels, registry=self.registry)
        self.seconds = Histogram(
            "wsrender_http_request_seconds",
            "Time from the request to the first byte of its answer [s].",
            ("method", "route"),
            buckets=SECONDS,
            registry=self.registry,
        )
        self.submissions = Counter(
            "wsrender_submissions", "Jobs submitted, by what became of them.", ("outcome",), registry=self.registry
        )
        self.jobs = Gauge("wsrender_jobs", "Jobs by state.", ("state",), registry=self.registry)
        self.computations = Gauge("wsrender_computations", "Computations by state.", ("state",), registry=self.registry)
        self.workers = Gauge("wsrender_workers", "Workers by activity.", ("activity",), registry=self.registry)
        self.free_disk = Gauge("wsrender_free_disk_bytes", "Free disk of the data folder.", registry=self.registry)

    def answered(self, method: str, route: str, status: int, seconds: float) -> None:
        """Count a request."""
        self.requests.labels(method, route, str(status)).inc()
        self.seconds.labels(method, route).observe(seconds)

    def text(self, queue: QueueSummary, workers: Iterable[WorkerRecord], free_bytes: int) -> bytes:
        """All metrics in Prometheus' text format."""
        for state, count in queue.jobs.items():
            self.jobs.labels(state).set(count)
        self.computations.labels("waiting").set(queue.waiting)
        self.computations.labels("running").set(queue.running)
        busy = [worker.busy for worker in workers]
        self.workers.labels("busy").set(sum(busy))
        self.workers.labels("idle").set(len(busy) - sum(busy))
        self.free_disk.set(free_bytes)
        return generate_latest(self.registry)
