"""The process of one live stream: a loop of fixed steps between a link of lines and a rendering.

Lines to it: ``<arrival in ns> <JSON>``; lines from it: JSON. Times are those of ``time.perf_counter``, which all
processes of a machine share on Linux.
"""

import contextlib
import gc
import json
import math
import os
import socket
import time
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Discriminator, TypeAdapter, ValidationError

from wsrender.documents.kinetostatic_stream import Ask, Fault, Opened, Sample, Statistics, StreamOpen
from wsrender.errors import WsrenderError
from wsrender.kinetostatics.force_fields import ForceField
from wsrender.kinetostatics.passivity import largest_loop_work, stiffness_bound
from wsrender.kinetostatics.rendering import Rendered, Rendering
from wsrender.robot import robot_of_spec
from wsrender.robots.uploaded import MODELS_VARIABLE
from wsrender_server.jobs.child_process import settle_in
from wsrender_server.problems import problem_of_error
from wsrender_server.streams.scheduling import hurry

MOST_WAITING = 1 << 16  # bytes that are not taken: then forces are dropped, not sent late
HISTORY = 60_000  # ticks whose times are kept
IDLE_S = 300.0  # without a message: the session ends
LOOPS_TRIED = 12
REPORT_S = 0.1  # between forces while no sample comes

_messages: TypeAdapter[Sample | Ask] = TypeAdapter(Annotated[Sample | Ask, Discriminator("type")])


def run_loop(link: socket.socket, document: str, models: Path) -> None:
    """Open the session of a `StreamOpen` document and run until the link closes."""
    settle_in()
    os.environ[MODELS_VARIABLE] = str(models)
    lines = _Lines(link)
    try:
        rendering, opened = _opened(document)
    except WsrenderError as error:
        lines.send(fault_of(error).model_dump_json().encode())
        return
    gc.collect()
    gc.freeze()
    gc.disable()  # what a tick makes is freed by counting references
    link.setblocking(False)
    lines.send(opened.model_dump_json().encode())
    _Loop(lines, rendering).run()


def fault_of(error: WsrenderError) -> Fault:
    """A fault message of an exception."""
    problem = problem_of_error(error)
    return Fault(code=problem["code"], detail=problem["detail"], errors=tuple(problem.get("errors", ())))


def _opened(document: str) -> tuple[Rendering, Opened]:
    choice = StreamOpen(**json.loads(document))
    robot = robot_of_spec(choice.robot, choice.base, choice.tip)
    field = ForceField(robot, choice.field, "cpu")
    if choice.start is not None:
        field.evaluate(choice.start)  # says what is wrong with it
    rendering, chain = Rendering(field, choice), field.chain
    work = largest_loop_work(field, LOOPS_TRIED)
    return rendering, Opened(
        robot=robot.name,
        joint_names=chain.joint_names,
        lower_limits=tuple(chain.lower_limits.tolist()),
        upper_limits=tuple(chain.upper_limits.tolist()),
        period_s=field.device.period_s,
        form=choice.field.form,
        characteristic_length_m=field.length.length_m,
        characteristic_length_method=field.length.method,
        stiffness_bound_n_per_m=stiffness_bound(field.device),
        enforced_stiffness_n_per_m=rendering.energy.stiffness,
        largest_loop_work_j=work.work_j,
        loop_damping_n_s_per_m=work.damping_n_s_per_m,
        scheduling="fifo" if hurry() else "normal",
    )


class _Lines:
    """Lines of a socket that never waits once it is set so."""

    def __init__(self, link: socket.socket):
        self._link = link
        self._in = self._out = b""

    def received(self) -> list[bytes] | None:
        """The lines that have come; None where the link is closed."""
        try:
            while block := self._link.recv(1 << 16):
                self._in += block
            return None
        except BlockingIOError:
            *lines, self._in = self._in.split(b"\n")
            return lines
        except OSError:
            return None

    def send(self, line: bytes, droppable: bool = False) -> None:
        """Send a line as far as the link takes it, the rest with the next; or drop it where much is waiting."""
        if droppable and len(self._out) > MOST_WAITING:
            return
        self._out += line + b"\n"
        with contextlib.suppress(OSError):  # full, or closed: the next receive says so
            self._out = self._out[self._link.send(self._out) :]


class _Loop:
    def __init__(self, lines: _Lines, rendering: Rendering):
        self._lines, self._rendering = lines, rendering
        self._period = rendering.field.device.period_s
        self._ticks = self._missed = self._samples = self._refused = 0
        self._late, self._latency = np.zeros(HISTORY), np.zeros(HISTORY)
        self._sequence: int | None = None
        self._state, self._told, self._heard = "waiting", 0.0, time.perf_counter()

    def run(self) -> None:
        """Tick until the client closes, the link is gone, or nobody has spoken for long."""
        due = time.perf_counter()
        while True:
            due += self._period
            if (left := due - time.perf_counter()) > 0:
                time.sleep(left)
            late = time.perf_counter() - due
            if late > self._period:  # the process did not run: what is past is not made up for
                self._missed += math.floor(late / self._period)
                due += math.floor(late / self._period) * self._period
            if not self._tick(late):
                return

    def _tick(self, late: float) -> bool:
        """One period; False at the end."""
        started = time.perf_counter()
        lines = self._lines.received()
        if lines is None:
            return False
        self._ticks += 1
        sample, arrived, going = self._newest(lines)
        if lines:
            self._heard = started
        rendered = self._rendering.tick(sample)
        if sample is not None:
            self._samples += 1
            self._sequence = sample.sequence
            self._latency[self._samples % HISTORY] = time.perf_counter() - started
        self._late[self._ticks % HISTORY] = late
        if lines or rendered.state != self._state or started - self._told > REPORT_S:
            wait = started - arrived if arrived else 0.0
            latency = time.perf_counter() - started if sample else 0.0
            self._lines.send(self._force(rendered, wait, latency, late), droppable=True)
            self._state, self._told = rendered.state, started
        if not going or started - self._heard > IDLE_S:
            self._lines.send(self._statistics("closed"))
            return False
        return True

    def _newest(self, lines: list[bytes]) -> tuple[Sample | None, float, bool]:
        """The newest sample, when it arrived [s], and whether the client goes on; other messages are answered."""
        sample, arrived, going = None, 0.0, True
        for line in lines:
            stamp, _, text = line.partition(b" ")
            try:
                message = _messages.validate_json(text)
            except ValidationError as error:
                self._refused += 1
                self._rendering.refuse(_reason(error))
                sample = None  # what came before it is out of date
                continue
            if isinstance(message, Sample):
                sample, arrived = message, int(stamp) * 1e-9
            elif message.type == "close":
                going = False
            else:
                self._lines.send(self._statistics("statistics"))
        return sample, arrived, going

    def _force(self, rendered: Rendered, wait: float, latency: float, late: float) -> bytes:
        """The message `Force` of a tick; not through its model, which takes as long as the field."""
        state, cues = rendered.field, rendered.cues
        distances = () if state is None else state.limit_distances.tolist()
        message = {
            "type": "force",
            "sequence": self._sequence,
            "tick": self._ticks,
            "state": rendered.state,
            "force_n": rendered.force.tolist(),
            "torque_n_m": rendered.torque.tolist(),
            "inverse_condition_number": None if state is None else state.inverse_condition,
            "limit_distances": [_finite(distance) for distance in distances],
            "boundary_m": None if state is None else _finite(state.boundary_m),
            "obstacle_m": None if state is None else _finite(state.obstacle_m),
            "configuration": [] if state is None else state.posture.q.tolist(),
            "position_m": [] if state is None else state.posture.position.tolist(),
            "tracking_error_m": rendered.tracking_error_m,
            "warnings": [vars(warning) for warning in rendered.warnings],
            "cues": vars(cues),
            "detail": rendered.detail,
            "wait_s": wait,
            "latency_s": latency,
            "late_s": late,
        }
        return json.dumps(message, separators=(",", ":"), allow_nan=False).encode()

    def _statistics(self, kind: Literal["statistics", "closed"]) -> bytes:
        return (
            Statistics(
                type=kind,
                ticks=self._ticks,
                missed_ticks=self._missed,
                samples=self._samples,
                refused=self._refused,
                late_s=_percentiles(self._late[1 : self._ticks + 1]),
                latency_s=_percentiles(self._latency[1 : self._samples + 1]),
                created_energy_j=self._rendering.energy.most_created,
            )
            .model_dump_json()
            .encode()
        )


def _reason(error: ValidationError) -> str:
    first: Any = error.errors(include_url=False, include_input=False)[0]
    field = ".".join(str(part) for part in first["loc"] if part not in ("sample", "statistics", "close"))
    return f"{field or 'message'}: {first['msg']}"


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _percentiles(times: np.ndarray) -> dict[str, float]:
    names = ("p50", "p99", "p999", "max")
    values = np.percentile(times, [50, 99, 99.9, 100]) if len(times) else np.zeros(4)
    return dict(zip(names, values.tolist(), strict=True))
