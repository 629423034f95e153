"""Write the golden files again: ``python -m tests.golden.write [name …]``, all by default.

Each keeps its job; for a new one write a file that holds ``{"job": …}``. What changes shows in the version control.
"""

import json
import os
import sys

import wsrender as ws
from tests.golden.facts import facts_of
from tests.golden.files import DOCUMENTS, golden_names, job_of
from wsrender.run import plan

THREADS = "WSRENDER_THREADS"


def write(name: str) -> None:
    """Run a golden job and write what its estimate and its result are."""
    job = job_of(name)
    entry = {"job": job, **run(job)}
    (DOCUMENTS / f"{name}.json").write_text(_text(entry), encoding="utf-8")


def run(job: dict) -> dict:
    """What a golden file says of a job."""
    return facts_of(ws.execute(job), estimate_in_one_thread(job))


def estimate_in_one_thread(job: dict) -> dict:
    """Samples, bytes and seconds, whatever the machine."""
    before = os.environ.get(THREADS)
    os.environ[THREADS] = "1"
    try:
        return plan(job).estimate
    finally:
        os.environ.pop(THREADS)
        if before is not None:
            os.environ[THREADS] = before


def _text(entry: dict) -> str:
    """JSON with a line for each part of the document and each array, so that a change is one line."""
    parts = []
    for name, value in entry.items():
        if isinstance(value, dict):
            lines = ",\n  ".join(f"{json.dumps(key)}: {_line(each)}" for key, each in value.items())
            value_text = f"{{\n  {lines}\n }}" if lines else "{}"
        else:
            value_text = _line(value)
        parts.append(f" {json.dumps(name)}: {value_text}")
    return "{\n" + ",\n".join(parts) + "\n}\n"


def _line(value) -> str:
    return json.dumps(value, ensure_ascii=False)


if __name__ == "__main__":
    for name in sys.argv[1:] or golden_names():
        write(name)
        print(name)
