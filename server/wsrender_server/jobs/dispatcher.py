"""The dispatcher: brings the computations of the job table to the engine, and their ends back."""

import logging
import queue
import threading
import time
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from typing import Any

from distributed import Future

from wsrender_server.jobs.attempt import Attempt
from wsrender_server.jobs.computations import ComputationStore
from wsrender_server.jobs.engine import Engine, outcome_of
from wsrender_server.jobs.fair_share import FairShare
from wsrender_server.jobs.faults import EngineSlow, EngineUnavailable, StoreUnavailable
from wsrender_server.jobs.records import ArtifactRecord, ComputationState
from wsrender_server.jobs.task import Outcome, Step, TaskLimits, Verdict, error
from wsrender_server.settings import Settings

TICK_S = 0.1
LOOK_S = 1.0  # between looks at a table that this process has not changed
MOST_LAUNCHES = 16  # at a tick: whoever asks the server for anything has their turn in between
AHEAD = 16  # attempts that wait at the scheduler; where more do, workers need no others yet
FEW_LAUNCHES = 1  # now and then: whoever starts workers for what waits sees ever more
PACE_S = 0.5
RECORD_S = 0.5
PAUSE_S = 1.0
MOST_LOSSES = 4
# A cluster without workers for so much longer than one takes to start is replaced where it is embedded; so is a target.
WORKERS_S = 30.0

log = logging.getLogger(__name__)


class Dispatcher:
    """A thread between job table and engine. The table alone knows what is to be done: whatever is lost is done again.

    At the start, and after the scheduler was lost, everything unfinished is submitted, by the names that it may still
    have there; partial results that are on disk are not computed again.
    """

    def __init__(self, store: ComputationStore, settings: Settings):
        self.store = store
        self.engine = Engine(settings, self._on_message)
        self._limits = TaskLimits.of(settings)
        self._attempts: dict[str, Attempt] = {}
        self._inbox: queue.SimpleQueue[Callable[[], None]] = queue.SimpleQueue()
        self._deferred: list[Callable[[], None]] = []
        self._targets: dict[str, str] = {}
        self._shares = defaultdict[int, FairShare](FairShare)  # by priority: turns count among equals
        self._generation = 0  # of the scheduler's losses
        self._recorded = 0.0
        self._launched = 0.0
        self._ticked = 0.0
        self._known: dict[str, tuple[ComputationState, int]] = {}  # what is unfinished, as it was when it was looked at
        self._looked = 0.0
        self._written = -1  # transactions of this process by then
        self._made = time.time()
        self._served = time.monotonic()  # when a worker was last there
        self._sought = 0.0  # when lost targets were looked for
        self._seen: dict[str, float] = {}  # when a worker of each target was last alive
        self._workers_s = WORKERS_S + settings.worker_start_s
        self._hurried = 0.0  # when the table was last looked at for somebody who had just changed it
        self._changed = threading.Event()  # by others: requests
        self._end = threading.Event()
        self._wake = threading.Event()
        self._thread = threading.Thread(target=self._loop, name="dispatcher", daemon=True)

    def start(self) -> None:
        """Start the thread; the engine starts within it."""
        self.store.changes.listener = self._hear
        self._thread.start()

    def stop(self) -> None:
        """End thread and engine; what is unfinished stays in the table."""
        self._end.set()
        self._wake.set()
        self._thread.join()
        self.engine.close()

    @property
    def alive(self) -> bool:
        """Whether the thread runs, the scheduler answers and a worker is there."""
        return self._thread.is_alive() and self.engine.connected and bool(self._targets)

    def waits_for(self, device: str) -> str:
        """What queued jobs that ask for a device wait for."""
        if not self.engine.connected:
            return f"waiting for {'the workers to start' if self.engine.embedded else 'the scheduler to answer'}"
        if self._targets and device.partition(":")[0] not in self._targets:
            return "waiting for a worker with a CUDA GPU"
        return f"waiting for {'a free worker' if self._targets else 'a worker to start'}"

    def _hear(self) -> None:
        """A job has changed: one that was just submitted does not wait for the next tick."""
        if threading.current_thread() is not self._thread:
            self._changed.set()
            self._wake.set()

    def _loop(self) -> None:
        recovered = joined = False
        while not self._end.is_set():
            try:
                if not recovered:
                    self.store.recover()
                    self.store.files.empty_scratch(self.store.unfinished(), self._made)
                    recovered = True
                if not joined or not self.engine.connected:
                    self._join_engine()
                    joined = True
                self._tick()
            except StoreUnavailable as fault:
                log.warning("%s; trying again", fault)
                self._end.wait(PAUSE_S)
            except EngineSlow as fault:
                log.warning("%s; waiting for it", fault)
                self._end.wait(PAUSE_S)
            except EngineUnavailable as fault:
                log.warning("%s; joining again", fault)
                joined = False
                self._end.wait(PAUSE_S)
            except Exception:
                log.exception("the dispatcher goes on after a fault")
                self._end.wait(PAUSE_S)
            self._wake.wait(TICK_S)
            self._wake.clear()

    def _join_engine(self) -> None:
        """Connect; what is out is submitted again by its names, which a scheduler that was not lost knows."""
        self._targets.clear()
        self.engine.connect(self._resume)
        log.info("connected to the scheduler")

    def _resume(self) -> None:
        for computation_id, attempt in [*self._attempts.items()]:
            if attempt.failure is not None or attempt.stopping:  # it has ended, once the database has taken that
                continue
            if attempt.futures:
                self._hand_out(attempt, {place: str(future.key) for place, future in attempt.futures.items()})
            else:  # it was between two steps
                del self._attempts[computation_id]

    def _tick(self) -> None:
        self._handle_inbox()
        now = time.monotonic()
        if now - self._ticked < TICK_S:  # messages come by the hundred, and each wakes this thread
            if self._changed.is_set() and now - self._hurried >= TICK_S and not self._waiting():
                self._hurried = now
                self._look(now, FEW_LAUNCHES)
            return
        self._ticked = now
        self.store.sole_use.keep()
        self.store.time_out()
        self._update_targets()
        if now - self._sought >= LOOK_S:
            self._sought = now
            self._leave_lost_targets()
        self._look(now)
        self._record_progress()

    def _look(self, now: float, most: int = MOST_LAUNCHES) -> None:
        """Stop what nobody wants any more, and hand out so much of what waits."""
        self._changed.clear()
        known = self._unfinished(now)
        old = [key for key, attempt in self._attempts.items() if known.get(key, (None, 0))[1] != attempt.record.attempt]
        unwanted = [key for key, (state, _) in known.items() if state == ComputationState.STOPPING]
        self._stop(set(old + unwanted))
        if self._targets or not self.engine.embedded:  # our own workers come anyway, and say what they are
            self._launch_some(most)

    def _unfinished(self, now: float) -> Mapping[str, tuple[ComputationState, int]]:
        """What is unfinished: thousands of rows, read when anything was written."""
        written = self.store.transactions.written
        if written != self._written or now - self._looked >= LOOK_S:
            self._known, self._written, self._looked = self.store.unfinished(), written, now
        return self._known

    def _launch_some(self, most: int = MOST_LAUNCHES) -> None:
        """Hand out what waits, of much the first; owners take turns."""
        now = time.monotonic()
        if self._waiting() >= AHEAD:
            if now - self._launched < PACE_S:
                return
            most = FEW_LAUNCHES
        stopping = ComputationState.STOPPING
        ready = [key for key, (state, _) in self._known.items() if state != stopping and key not in self._attempts]
        if len(ready) > most:
            ready = self.store.in_turn(most, but=self._known.keys() - set(ready))
        if ready:
            self._launched = now
        for computation_id in ready:
            self._launch(computation_id)

    def _waiting(self) -> int:
        """How many attempts wait at the scheduler for workers that are there."""
        here = {*self._targets, *self.engine.alive}
        return sum(not attempt.begun and attempt.target in here for attempt in self._attempts.values())

    def _handle_inbox(self) -> None:
        """Handle what came in; where the database does not answer, keep the rest for later."""
        while not self._inbox.empty():
            self._deferred.append(self._inbox.get())
        while self._deferred:
            self._deferred[0]()
            self._deferred.pop(0)

    def _update_targets(self) -> None:
        if self._targets and time.monotonic() - self._recorded < RECORD_S:
            return
        targets = self.engine.targets()
        if targets:
            self._served = time.monotonic()
        elif time.monotonic() - self._served > self._workers_s and self.engine.embedded:
            self._served = time.monotonic()
            self.engine.close()
            raise EngineUnavailable("the embedded cluster has no workers any more")
        if targets != self._targets:
            if targets:
                self.store.set_targets(targets)
            self._targets = targets

    def _launch(self, computation_id: str) -> None:
        record = self.store.computation(computation_id)
        if record is None:
            return
        kind = record.document.device.partition(":")[0]
        target, resolved = self._planners(kind), record.resolved
        if resolved is not None and (not self._targets or record.target in self.engine.alive):
            target = record.target or target
        elif resolved is not None:
            # The hardware is another one now; partial results of two targets do not mix.
            self.store.files.forget_partials(computation_id)
            resolved = None
        attempt = self._attempts[computation_id] = Attempt(record, target, resolved, self._generation, self._limits)
        attempt.turn = self._shares[record.priority].turn(record.owner)
        if resolved is None:
            self._submit(attempt, Step.PLAN)
        else:
            self._submit_shards(attempt)

    def _planners(self, kind: str) -> str:
        """Which workers plan for a kind of device, and so choose the target; for "auto" those with GPUs, if any.

        Without them the plan waits at the scheduler, where whoever starts workers for what waits sees it; to one's own
        workers no others come: they say what they lack.
        """
        if kind == "auto" and "cuda" in self._targets:
            return "cuda"
        return "auto" if self.engine.embedded and self._targets and kind not in self._targets else kind

    def _leave_lost_targets(self) -> None:
        """Begin anew what waits for hardware that has been away for long, while other is there."""
        now = time.monotonic()
        self._seen.update(dict.fromkeys((*self.engine.alive, *self._targets), now))
        for computation_id, attempt in list(self._attempts.items()):
            away = now - self._seen.setdefault(attempt.target, now)
            elsewhere = attempt.resolved is not None or attempt.record.document.device == "auto"
            if elsewhere and self._targets and away > self._workers_s:
                self.engine.stop([], list(attempt.futures.values()))
                self._generation += 1  # its tasks get other names
                del self._attempts[computation_id]

    def _submit(self, attempt: Attempt, step: Step, shards: Sequence[int] = (0,)) -> None:
        self._hand_out(attempt, {(step, shard): attempt.key(step, shard) for shard in shards})

    def _hand_out(self, attempt: Attempt, keys: Mapping[tuple[Step, int], str]) -> None:
        """Submit tasks of one step by the names ``keys``."""
        tasks = {key: attempt.task(*place) for place, key in keys.items()}
        futures = self.engine.submit(tasks, attempt.record.priority, attempt.target, attempt.turn)
        for place, future in zip(keys, futures, strict=True):
            attempt.futures[place] = future
            future.add_done_callback(partial(self._future_done, attempt, *place))

    def _future_done(self, attempt: Attempt, step: Step, shard: int, future: Future) -> None:
        self._put(lambda: self._ended(attempt, step, shard, future))

    def _submit_shards(self, attempt: Attempt) -> None:
        missing = attempt.begin_shards(self.store.files)
        if missing:
            self._submit(attempt, Step.SHARD, missing)
        else:
            self._submit_finish(attempt)

    def _submit_finish(self, attempt: Attempt) -> None:
        began, attempt.started = attempt.started, time.monotonic()
        attempt.seconds["sweep"] = attempt.seconds.get("sweep", 0.0) + attempt.started - began
        attempt.step, attempt.stale = Step.FINISH, True
        self._submit(attempt, Step.FINISH, [len(attempt.shards)])  # of another name after every round

    def _put(self, action: Callable[[], None]) -> None:
        self._inbox.put(action)
        self._wake.set()

    def _on_message(self, message: dict[str, Any]) -> None:
        self._put(lambda: self._reported(message))

    def _reported(self, message: dict[str, Any]) -> None:
        """A worker began a step or did samples of a shard."""
        computation_id = message["token"].partition("-")[0]
        attempt = self._attempts.get(computation_id)
        if attempt is None or attempt.token != message["token"]:
            return
        if "step" in message:
            attempt.begun = True
            self._shares[attempt.record.priority].begun(attempt.turn)
            self.store.begin(computation_id, attempt.record.attempt)
            attempt.stale = True
        elif "decided" in message:
            attempt.refined(*message["decided"])
        else:
            attempt.reported(message["shard"], message["done"])

    def _ended(self, attempt: Attempt, step: Step, shard: int, future: Future) -> None:
        """A task ended: go on with the next step, or end the attempt."""
        computation_id = attempt.record.id
        if self._attempts.get(computation_id) is not attempt or attempt.futures.get((step, shard)) is not future:
            return
        if attempt.failure is not None:  # its tasks were stopped by us, and the database did not answer then
            self._fail(attempt, attempt.failure)
            return
        if future.status in ("cancelled", "lost") and attempt.stopping:  # by us
            return
        if future.status in ("cancelled", "lost"):  # with the connection
            raise EngineUnavailable("the scheduler was lost for a moment")
        outcome = outcome_of(future)
        if outcome is None or outcome.verdict in (Verdict.LOST, Verdict.STOPPED):
            self._lost(attempt, step, shard, outcome)
        elif outcome.verdict == Verdict.FAILED:
            if outcome.value:
                log.error("computation %s, %s: %s", computation_id, step, outcome.value)
            self._fail(attempt, outcome.error or {})
        elif isinstance(outcome.value, dict):  # a plan, or more shards of it
            self.store.settle(computation_id, outcome.value["resolved"], outcome.value["target"])
            attempt.resolved, attempt.target = outcome.value["resolved"], outcome.value["target"]
            attempt.seconds.setdefault("plan", outcome.value.get("seconds", 0.0))
            self._submit_shards(attempt)
            self._drop(attempt, (step, shard), future)
        elif step == Step.SHARD:
            attempt.reported(shard, attempt.shards[shard][1])
            if len(attempt.futures) == 1:
                self._submit_finish(attempt)
            self._drop(attempt, (step, shard), future)
        else:
            records = [ArtifactRecord(**record) for record in outcome.value]
            self.store.complete(computation_id, attempt.record.attempt, records)
            del self._attempts[computation_id]

    def _drop(self, attempt: Attempt, place: tuple[Step, int], future: Future) -> None:
        """Forget a task once what follows is out: where that fails, its end is handled again."""
        if attempt.futures.get(place) is future:  # and not the same step, out once more
            del attempt.futures[place]

    def _lost(self, attempt: Attempt, step: Step, shard: int, outcome: Outcome | None) -> None:
        """A task was lost with its worker, or a partial result was: do it again, a few times."""
        attempt.losses += 1
        if attempt.losses > MOST_LOSSES:
            reason = (outcome and outcome.error) or error(
                "worker_lost", "the workers that ran the job were lost, again and again", retryable=True
            )
            self._fail(attempt, reason)
        elif step == Step.FINISH:
            future = attempt.futures[step, shard]
            self._submit_shards(attempt)  # those whose files are there are not computed again
            self._drop(attempt, (step, shard), future)
        else:
            self._submit(attempt, step, [shard])

    def _fail(self, attempt: Attempt, reason: dict[str, Any]) -> None:
        """End an attempt that failed; its other tasks are stopped first, so that a retry meets none of them."""
        attempt.failure = reason
        self.engine.stop([attempt.token], list(attempt.futures.values()))
        self.store.fail(attempt.record.id, attempt.record.attempt, reason)
        self._attempts.pop(attempt.record.id, None)

    def _stop(self, computations: Iterable[str]) -> None:
        """Kill what runs of computations that nobody wants any more, all at once: a worker may be slow to answer."""
        found = {key: self._attempts.get(key) or self._unknown_attempt(key) for key in computations}
        attempts = {key: attempt for key, attempt in found.items() if attempt is not None}
        if not attempts:
            return
        futures = [future for attempt in attempts.values() for future in attempt.futures.values()]
        for attempt in attempts.values():
            attempt.stopping = True
        self.engine.stop([attempt.token for attempt in attempts.values()], futures)
        for computation_id, attempt in attempts.items():
            self.store.stopped(computation_id, attempt.record.attempt)
            self._attempts.pop(computation_id, None)

    def _unknown_attempt(self, computation_id: str) -> Attempt | None:
        """The attempt at a computation that this server has not launched: an earlier run of it may have."""
        record = self.store.computation(computation_id)
        return None if record is None else Attempt(record, "", None, self._generation, self._limits)

    def _record_progress(self) -> None:
        now = time.monotonic()
        if now - self._recorded < RECORD_S:
            return
        self._recorded = now
        stale = {key: attempt for key, attempt in self._attempts.items() if attempt.stale}
        if stale:
            self.store.report({key: attempt.progress() for key, attempt in stale.items()})
        for attempt in stale.values():
            attempt.stale = False
