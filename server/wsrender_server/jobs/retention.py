"""What is kept no longer: by age, size and owner, the least recently used first; and files that nothing names."""

import re
import threading
import time
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from contextlib import AbstractContextManager, suppress
from dataclasses import dataclass
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import structlog
from sqlalchemy import select
from sqlalchemy.orm import Session

from wsrender_server.jobs.background import in_background
from wsrender_server.jobs.clock import Clock
from wsrender_server.jobs.faults import InvalidTransition, StoreUnavailable
from wsrender_server.jobs.records import ENDED, UNFINISHED, ComputationState
from wsrender_server.jobs.sole_use import check_bound
from wsrender_server.jobs.store import JobStore
from wsrender_server.jobs.tables import Computation, Job, Model
from wsrender_server.settings import Settings

NAME = re.compile("[0-9a-f]{1,64}")  # of what the server has made; anything else is not its own to remove
RETRIED = (ComputationState.FAILED, ComputationState.STOPPED)
GRACE = timedelta(minutes=1)  # a result that was made or used so shortly ago is kept, whatever the limits
UPLOAD_S = 3600.0  # the file of a model or document without a row may be one that just comes

log = structlog.get_logger("wsrender.retention")


@dataclass(frozen=True)
class Removal:
    """Something that is kept no longer: a ``job``, a ``result``, a ``model``, or ``files`` of no result."""

    what: str
    id: str
    owner: str
    bytes: int
    reason: str
    attempt: int = 0


class Retention:
    """Finds what the settings let go, and removes it; counts it for the metrics."""

    def __init__(self, store: JobStore, settings: Settings):
        self.store = store
        self.settings = settings
        self._clock = Clock()

    def running(self) -> AbstractContextManager[None]:
        """Sweep every ``retention_interval_s`` in a thread, for as long as the block lasts."""
        return in_background("retention", self._loop)

    def due(self, now: datetime | None = None) -> list[Removal]:
        """What is to go, in the order in which it goes; nothing is changed. Raises StoreUnavailable."""
        check_bound(self.store.transactions, self.store.files)  # a folder of others has no file too many
        now = now or self._clock.now()
        folders = {
            kind: self._entries(kind) for kind in ("partials", "results", "models", "documents")
        }  # before the rows
        with self.store.transactions.read() as session:
            return [
                *self._jobs(session, now),
                *self._results(session, now),
                *self._files(session, folders),
            ]

    def sweep(self, now: datetime | None = None) -> list[Removal]:
        """Remove what is to go; what is needed again by now stays. What was removed. Raises StoreUnavailable.

        A database's log that has become long is emptied.
        """
        done = [removal for removal in self.due(now) if self.remove(removal)]
        for removal in done:
            self.store.removed.update({removal.what: 1, "bytes": removal.bytes})
            log.info("removed", **vars(removal))
        self.store.transactions.shorten_log()
        return done

    def remove(self, removal: Removal) -> bool:
        """Remove something; False where it is needed again by now, or gone."""
        store = self.store
        if removal.what == "job":
            with suppress(InvalidTransition):
                return store.delete(removal.owner, removal.id) is not None
            return False
        if removal.what == "result":
            return store.expire(removal.id, removal.attempt, removal.reason)
        if removal.what == "model":
            return store.forget_model_file(removal.id)
        return store.forget_files(removal.id)

    def _loop(self, end: threading.Event) -> None:
        while not end.wait(self.settings.retention_interval_s):
            try:
                self.sweep()
            except StoreUnavailable as fault:
                log.warning("retention tries again later", fault=str(fault))
            except Exception:
                log.exception("retention goes on after a fault")

    def _jobs(self, session: Session, now: datetime) -> Iterator[Removal]:
        """Ended jobs that are too old, and the oldest of owners who have too many."""
        age, most = self.settings.keep_jobs_s, self.settings.keep_jobs_per_owner
        if age is None and most is None:
            return
        query = select(Job.id, Job.owner, Job.finished_at).where(Job.state.in_(ENDED)).order_by(Job.finished_at.desc())
        kept: Counter[str] = Counter()
        for row in session.execute(query):
            kept[row.owner] += 1
            if age is not None and row.finished_at <= now - timedelta(seconds=age):
                yield Removal("job", row.id, row.owner, 0, f"it ended more than {age:g} s ago")
            elif most is not None and kept[row.owner] > most and row.finished_at <= now - GRACE:
                yield Removal("job", row.id, row.owner, 0, f"its owner has more than {most} ended jobs")

    def _results(self, session: Session, now: datetime) -> Iterator[Removal]:
        """Results that were not used for too long, then the least recently used of too many bytes."""
        limits = self.settings
        query = select(Computation.id, Computation.owner, Computation.bytes, Computation.used_at, Computation.attempt)
        query = query.where(Computation.state == ComputationState.SUCCEEDED).order_by(Computation.used_at)
        rows = session.execute(query).all()
        of_owner: defaultdict[str, int] = defaultdict(int)
        for row in rows:
            of_owner[row.owner] += row.bytes
        total = sum(of_owner.values())
        for row in rows:
            reasons = {
                f"it was not used for more than {limits.keep_results_s} s": limits.keep_results_s is not None
                and row.used_at <= now - timedelta(seconds=limits.keep_results_s),
                f"its owner's results take more than {limits.keep_results_bytes_per_owner} bytes": _above(
                    of_owner[row.owner], limits.keep_results_bytes_per_owner
                ),
                f"all results take more than {limits.keep_results_bytes} bytes": _above(
                    total, limits.keep_results_bytes
                ),
            }
            reason = next((reason for reason, holds in reasons.items() if holds), None)
            if reason is not None and row.used_at <= now - GRACE:
                of_owner[row.owner] -= row.bytes
                total -= row.bytes
                yield Removal(
                    "result", row.id, row.owner, row.bytes, f"the result is no longer kept: {reason}", row.attempt
                )

    def _files(self, session: Session, folders: dict[str, list[Path]]) -> Iterator[Removal]:
        """Files of what has no result, after a while where a retry goes on from them, and those that no row names."""
        now = self._clock.now().timestamp()
        states = {row.id: row for row in session.execute(select(Computation.id, Computation.state, Computation.owner))}
        models = set(session.scalars(select(Model.sha256)))
        for kind, path in [(each, path) for each in ("partials", "results") for path in folders[each]]:
            row = states.get(path.name)
            state, owner = (row.state, row.owner) if row is not None else (None, "")
            kept = state in RETRIED and now - _changed(path) < self.settings.keep_partials_s
            if state in UNFINISHED or kept or (state, kind) == (ComputationState.SUCCEEDED, "results"):
                continue
            reason = "no computation names them" if state is None else f"the computation is {state}"
            yield Removal("files", path.name, owner, _size(path), reason)
        for path in folders["documents"]:
            if path.name not in states and now - _changed(path) > UPLOAD_S:
                yield Removal("files", path.name, "", _size(path), "no computation names them")
        for path in folders["models"]:
            if path.name not in models and now - _changed(path) > UPLOAD_S:
                yield Removal("model", path.name, "", _size(path), "nobody has it")

    def _entries(self, kind: str) -> list[Path]:
        folder = self.store.files.root / kind
        return sorted(path for path in folder.iterdir() if NAME.fullmatch(path.name)) if folder.is_dir() else []


def _above(size: int, limit: int | None) -> bool:
    return limit is not None and size > limit


def _changed(path: Path) -> float:
    """When something was last put into a folder or file; now where it is gone."""
    try:
        return path.stat().st_mtime
    except FileNotFoundError:
        return time.time()


def _size(path: Path) -> int:
    """Bytes of a file, or of all files in a folder."""
    paths: Iterable[Any] = path.rglob("*") if path.is_dir() else [path]
    size = 0
    for each in paths:
        with suppress(FileNotFoundError):
            size += each.stat().st_size if each.is_file() else 0
    return size
