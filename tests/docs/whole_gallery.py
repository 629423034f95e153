"""The site with all scripts of its gallery and all tutorials run, every page opened in Chromium, by `test_site`.

``PARTS`` and ``violations`` make it a long measurement, which needs the extra ``docs`` and a Chromium.
"""

import os
import subprocess
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

CLONE = Path(__file__).parents[2]
MOST_S = 3600


def gallery() -> dict[str, Any]:
    """Seconds, how pytest ended, and the end of what it said."""
    command = [sys.executable, "-m", "pytest", "-q", "-x", "-rs", "-o", f"faulthandler_timeout={MOST_S}", "tests/docs"]
    began = time.perf_counter()
    environment = os.environ | {"DOCS_CHOICE": "all"}
    done = subprocess.run(command, cwd=CLONE, env=environment, capture_output=True, text=True, timeout=MOST_S)
    said = done.stdout.strip().splitlines()
    return {"seconds": round(time.perf_counter() - began), "ended": done.returncode, "said": said[-10:]}


PARTS = {"all": gallery}
TOO_LONG = ("all",)  # for a run of a few minutes


def violations(figures: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """Tests that failed, or were skipped for want of what they need."""
    return [
        f"the whole gallery: {found}"
        for found in figures.values()
        if found["ended"] != 0 or "skipped" in " ".join(found["said"])
    ]
