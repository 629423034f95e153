"""How the steps of a job run here."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from wsrender.engine.devices import thread_count, whole_number


@dataclass(frozen=True)
class Execution:
    """What every step of a job is run with, and what changes no bit of its result.

    ``threads``: CPU threads of the kernels; None: the variable WSRENDER_THREADS, else all cores that this process may
    use. ``chunk_size``: samples that a thread takes at a time; None: as many as keep all threads busy. ``checkpoint``:
    the file in which a plan that can go on where it was stopped keeps what it has done; None: it keeps nothing.
    ``runner``: runs a job that is a part of this one, as `wsrender.run.execute` does.

    Raises InputError for threads or a chunk size below 1.
    """

    threads: int | None = None
    chunk_size: int | None = None
    checkpoint: Path | None = None
    runner: Callable[..., Any] | None = None

    def __post_init__(self) -> None:
        """Settle the number of threads once, whatever the variable says later."""
        object.__setattr__(self, "threads", thread_count(self.threads))
        if self.chunk_size is not None:
            object.__setattr__(self, "chunk_size", whole_number("chunk_size", self.chunk_size))

    def run_inside(self, job: Any) -> Any:
        """The result of a job that is a part of this one."""
        assert self.runner is not None
        return self.runner(job, threads=self.threads, chunk_size=self.chunk_size)
