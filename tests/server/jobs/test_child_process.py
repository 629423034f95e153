"""Children that are killed and how they ended."""

import signal
import subprocess
from contextlib import contextmanager

import psutil
import pytest
from wsrender_server.jobs.child_process import how_it_ended, kill
from wsrender_server.jobs.kernel_process import KernelProcess
from wsrender_server.settings import Settings

from tests.server.jobs.waiting import wait_until


@contextmanager
def stranger():
    """Process id of one that is no child of this process."""
    command = ["sh", "-c", "sleep 600 & echo $!; wait"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as between:
        process = psutil.Process(int(between.stdout.readline()))
        try:
            yield process
        finally:
            process.kill()


def lives_on(process):
    """For a second, within which whoever was killed would have ended."""
    with pytest.raises(psutil.TimeoutExpired):
        process.wait(1)
    return True


def test_a_child_is_killed_and_whoever_else_has_its_number_is_not():
    with subprocess.Popen(["sleep", "600"]) as child:
        kill(child.pid)
        assert child.wait(60) == -signal.SIGKILL
    with stranger() as other:
        kill(other.pid)
        assert lives_on(other)
    kill(child.pid)  # that nobody has
    kill(None)


def test_a_kernel_process_that_ended_long_ago_takes_nobody_along(tmp_path):
    """Its number may be another's by the time that it is missed."""
    process = KernelProcess(Settings(data_dir=tmp_path, warm_spare=False))
    process.describe()
    child = process._child
    psutil.Process(process.pid).kill()
    wait_until(lambda: not child.pool.active or not psutil.pid_exists(child.pid), what="its end")
    with stranger() as other:
        child.gauges[0] = other.pid
        process.close()
        assert lives_on(other)


@pytest.mark.parametrize(
    ("code", "said"),
    [(0, "exit code 0"), (130, "exit code 130"), (-9, "SIGKILL"), (-40, "signal 40"), (None, "unknown how")],
)
def test_how_a_process_ended(code, said):
    assert how_it_ended(code) == said
