"""Write the golden files again: ``python -m tests.golden.write [name …]``, all by default.

Each keeps its job; for a new one write a file that holds ``{"job": …}``. What changes shows in the version control.
"""

import json
import sys

import wsrender as ws
from tests.golden.facts import facts_of
from tests.golden.files import DOCUMENTS, golden_names, job_of


def write(name: str) -> None:
    """Run a golden job and write what its result is."""
    job = job_of(name)
    entry = {"job": job, **facts_of(ws.execute(job))}
    (DOCUMENTS / f"{name}.json").write_text(_text(entry), encoding="utf-8")


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
