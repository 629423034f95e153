"""Waiting for jobs, and comparing what they give with a local run."""

import fnmatch
import json
import os
import time
from contextlib import contextmanager, suppress
from pathlib import Path

import wsrender as ws

PATIENCE_S = 300.0  # machines are shared, and kernels may have to be compiled


def wait_until(condition, timeout=PATIENCE_S, what="the condition"):
    """The first true value of ``condition()``; the seconds that it took are for the caller to measure."""
    ends = time.monotonic() + timeout
    while not (value := condition()):
        assert time.monotonic() < ends, f"{what} did not come true in {timeout} s"
        time.sleep(0.02)
    return value


@contextmanager
def within(seconds):
    """The block takes so many seconds at most; on a busy machine as much longer as others get of it."""
    began = time.monotonic()
    yield
    took, load = time.monotonic() - began, os.getloadavg()[0]
    with suppress(OSError):  # the mean of a minute knows nothing yet of a load that has just come
        load = max(load, int(Path("/proc/loadavg").read_text().split()[3].partition("/")[0]))
    assert took <= seconds * max(1.0, load / (os.cpu_count() or 1)), f"{took:.1f} s, at a load of {load}"


def ended(store, job, owner="ann", timeout=PATIENCE_S):
    """The record of a job that has ended."""

    def check():
        record = store.get(owner, job)
        return record if record.state not in ("queued", "running", "canceling") else None

    return wait_until(check, timeout, f"the end of job {job}")


def in_state(store, job, state, owner="ann", timeout=PATIENCE_S):
    """Wait for a job to enter a state."""
    return wait_until(lambda: store.get(owner, job).state == state, timeout, f"state {state}")


def comparable(document):
    """A result document without what may differ between two runs: seconds and host."""
    copy = json.loads(json.dumps(document))
    del copy["timing_s"], copy["provenance"]["host"], copy["provenance"]["run"]
    return copy


def local_document(document, folder):
    """The result document of a local run, with the hashes of its artifacts."""
    result = ws.execute(document)
    result.save(folder)
    return comparable(result.document)


def partial_times(data_dir, computation=""):
    """Modification times of the partial results on disk, of one computation or of all, by path [ns]."""
    times = {}
    # A computation may end at any moment: os.walk passes over a folder that is gone, unlike Path.glob.
    for folder, _, names in os.walk(data_dir / "partials" / computation):
        for path in (Path(folder, name) for name in fnmatch.filter(names, "[0-9]*.npz")):
            with suppress(FileNotFoundError):
                times[str(path.relative_to(data_dir))] = path.stat().st_mtime_ns
    return times
