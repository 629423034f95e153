"""A job service in a process of its own, to be killed."""

import os
import signal
import subprocess
import sys
import time

import psutil

SERVE = """
import logging, signal, sys, threading
from wsrender_server.jobs.service import JobService
from wsrender_server.settings import Settings

if __name__ == "__main__":
    logging.basicConfig(level=logging.WARNING)
    end = threading.Event()
    signal.signal(signal.SIGTERM, lambda *_: end.set())
    with JobService(Settings.model_validate_json(sys.argv[1])):
        end.wait()
"""

WORK = """
import sys
from wsrender_server.jobs.worker import serve_scheduler
from wsrender_server.settings import Settings

if __name__ == "__main__":
    serve_scheduler(Settings.model_validate_json(sys.argv[1]))
"""


class ServerProcess:
    """A program in a process, with all that it starts."""

    def __init__(self, settings, folder, program=SERVE):
        self.settings = settings
        self.script = folder / f"{id(program):x}.py"
        self.script.write_text(program)
        self.log = folder / f"{self.script.stem}.{time.monotonic_ns()}.log"
        self.start()

    def start(self):
        """Start it, or start it again."""
        command = [sys.executable, self.script, self.settings.model_dump_json()]
        path = os.pathsep.join(folder for folder in sys.path if folder)
        environment = {**os.environ, "PYTHONPATH": path}
        with self.log.open("ab") as log:
            self.process = subprocess.Popen(command, stdout=log, stderr=log, env=environment)

    def kill(self):
        """kill -9 of the one process."""
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()

    def children(self):
        """Everything that it has started and that lives, newest last."""
        if self.process.poll() is not None:  # its number may be another's by now
            return []
        return psutil.Process(self.process.pid).children(recursive=True)

    def kill_all(self):
        """kill -9 of it and of everything that it has started."""
        children = self.children()
        self.kill()
        for child in children:
            if child.is_running():
                child.kill()

    def stop(self):
        """End it in good order, or by force after a while."""
        self.process.terminate()
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.kill_all()
