"""What a job would take, by planning it in a process of its own."""

import asyncio
import json
from typing import Any

from wsrender_server.problems import HttpProblem
from wsrender_server.side_process import SideProcess

PATIENCE_S = 5.0  # the first plan of a kind of robot compiles kernels
TIMEOUT_S = 180.0
MOST_KEPT = 64

Estimated = dict[str, float | None]


class Estimates:
    """Plans documents; what takes longer than a request should goes on, and answers when it is asked for again."""

    def __init__(self, process: SideProcess):
        self._process = process
        self._tasks: dict[str, asyncio.Task[Estimated]] = {}

    async def of(self, document: dict[str, Any]) -> Estimated:
        """Samples, bytes and seconds of a canonical document.

        Raises HttpProblem 409 for whatever planning refuses, and, retryable, while planning goes on.
        """
        key = json.dumps(document, sort_keys=True)
        task = self._tasks.get(key)
        if task is None:
            task = self._tasks[key] = asyncio.create_task(self._process.run(planned, document, timeout_s=TIMEOUT_S))
            task.add_done_callback(lambda done: done.cancelled() or done.exception())  # nobody may ask again
            for old in list(self._tasks)[:-MOST_KEPT]:
                del self._tasks[old]
        await asyncio.wait({task}, timeout=PATIENCE_S)
        if not task.done():
            detail = "the job is being planned, which takes longer the first time; ask again"
            raise HttpProblem(409, detail, "planning", retryable=True)
        self._tasks.pop(key, None)
        return task.result()

    def close(self) -> None:
        """Stop the process."""
        self._process.close()


def planned(document: dict[str, Any]) -> Estimated:
    """The estimate of a plan; None for what the analysis does not estimate. Raises what planning raises."""
    from wsrender.run import plan

    found = plan(document)
    return {"samples": float(found.samples), "bytes": None, "seconds": None} | found.estimate
