"""A server of one's own, in a process of its own, for as long as a block lasts."""

import os
import queue
import signal
import subprocess
import sys
import threading
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType
from typing import IO, Self

from wsrender.errors import ServerConnectionError

START_S = 60.0  # cold disks; five seconds is the rule
STOP_S = 15.0
READY = "serving at "  # what the command prints before its URL


class LocalServer:
    """``wsrender serve`` on a free port of this machine, a context manager.

    ``options`` are options of the command. Its log goes to the file ``log`` in the data folder.
    """

    def __init__(self, data_dir: Path, options: Sequence[str] = (), port: int = 0):
        self.data_dir = data_dir
        self.log = data_dir / "server.log"
        self._command = [sys.executable, "-m", "wsrender", "serve", "--data-dir", str(data_dir), *options]
        self._port = port
        self.url = ""
        self.process: subprocess.Popen[str]

    def start(self) -> Self:
        """Start the process and wait until it answers; again on the same port if it had one.

        Raises ServerConnectionError with the end of its log where it does not come up.
        """
        self.data_dir.mkdir(mode=0o700, parents=True, exist_ok=True)
        with os.fdopen(os.open(self.log, os.O_WRONLY | os.O_APPEND | os.O_CREAT, 0o600), "a") as log:
            self.process = subprocess.Popen(
                [*self._command, "--port", str(self._port)],
                stdout=subprocess.PIPE,
                stderr=log,
                text=True,
                start_new_session=True,
            )
        self.url = self._announced()
        self._port = int(self.url.rpartition(":")[2])
        return self

    def stop(self) -> int:
        """Ask the process to end; kill it where it does not within 15 s. Its exit code."""
        self.process.send_signal(signal.SIGTERM)
        try:
            return self.process.wait(STOP_S)
        except subprocess.TimeoutExpired:
            self.kill_all()
            return self.process.wait()

    def kill_all(self) -> None:
        """Kill the process and all of its children at once."""
        os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()

    def __enter__(self) -> Self:
        return self.start()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self.process.poll() is None:
            self.stop()

    def _announced(self) -> str:
        """The URL that the process prints."""
        assert self.process.stdout is not None
        lines: queue.Queue[str] = queue.Queue()
        threading.Thread(target=_read_lines, args=(self.process.stdout, lines), daemon=True).start()
        try:
            while True:
                line = lines.get(timeout=START_S)
                if READY in line:
                    return line.partition(READY)[2].strip()
                if not line:
                    break
        except queue.Empty:
            self.kill_all()
        end = self.log.read_text(errors="replace").strip().splitlines()[-5:]
        raise ServerConnectionError("the server did not start: " + " / ".join(end))


def _read_lines(stream: IO[str], lines: "queue.Queue[str]") -> None:
    """Every line of a stream, an empty one at its end; read on so that the writer never waits."""
    with stream:
        for line in stream:
            lines.put(line)
    lines.put("")
