"""Metrics for Prometheus."""

from collections.abc import Iterable, Mapping
from http import HTTPMethod

from prometheus_client import CollectorRegistry, Counter, Gauge, Histogram, generate_latest

from wsrender_server.jobs.records import QueueSummary, WorkerRecord

MEDIA_TYPE = "text/plain; version=0.0.4; charset=utf-8"
METHODS = frozenset(HTTPMethod)
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
        self.kept = Gauge("wsrender_kept_bytes", "Bytes of results and models.", ("what",), registry=self.registry)
        self.removed = Counter(
            "wsrender_retention_removed", "What retention has removed.", ("what",), registry=self.registry
        )
        self.freed = Counter("wsrender_retention_freed_bytes", "Bytes that it has freed.", registry=self.registry)
        self._told = dict.fromkeys(("job", "result", "model", "files", "bytes"), 0)  # of what retention has removed
        self.webhooks = Counter(
            "wsrender_webhook_deliveries",
            "Attempts that delivered or failed, and messages that were given up.",
            ("outcome",),
            registry=self.registry,
        )
        self._delivered = dict.fromkeys(("delivered", "failed", "given_up"), 0)
        self.webhooks_waiting = Gauge(
            "wsrender_webhook_deliveries_waiting", "Messages that webhooks have not got yet.", registry=self.registry
        )
        self.free_disk = Gauge("wsrender_free_disk_bytes", "Free disk of the data folder.", registry=self.registry)

    def answered(self, method: str, route: str, status: int, seconds: float) -> None:
        """Count a request; methods that HTTP does not know are one: each would be a line for ever."""
        method = method if method in METHODS else "other"
        self.requests.labels(method, route, str(status)).inc()
        self.seconds.labels(method, route).observe(seconds)

    def text(
        self,
        queue: QueueSummary,
        workers: Iterable[WorkerRecord],
        free_bytes: int,
        kept: Mapping[str, int],
        removed: Mapping[str, int],
        deliveries: Mapping[str, int],
        waiting_deliveries: int,
    ) -> bytes:
        """All metrics in Prometheus' text format; ``removed`` counts things by kind, and ``bytes``."""
        for outcome, told in self._delivered.items():
            self._delivered[outcome] = deliveries.get(outcome, 0)
            self.webhooks.labels(outcome).inc(self._delivered[outcome] - told)
        self.webhooks_waiting.set(waiting_deliveries)
        for what, size in kept.items():
            self.kept.labels(what).set(size)
        for what, told in self._told.items():
            counter = self.freed if what == "bytes" else self.removed.labels(what)
            counter.inc(removed.get(what, 0) - told)
            self._told[what] = removed.get(what, 0)
        for state, count in queue.jobs.items():
            self.jobs.labels(state).set(count)
        self.computations.labels("waiting").set(queue.waiting)
        self.computations.labels("running").set(queue.running)
        busy = [worker.busy for worker in workers]
        self.workers.labels("busy").set(sum(busy))
        self.workers.labels("idle").set(len(busy) - sum(busy))
        self.free_disk.set(free_bytes)
        return generate_latest(self.registry)
