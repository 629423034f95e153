"""Settings of the server: environment variables WSRENDER_…, options of the commands, defaults."""

import warnings
from functools import cached_property
from pathlib import Path
from typing import Self

from pydantic import Field, model_validator
from pydantic_settings import BaseSettings, SettingsConfigDict

OLD_FOLDER = Path("wsrender-data")  # in the working directory: the default of 0.1
GIB = 2**30


def default_data_dir() -> Path:
    """The user's own folder for wsrender; ``./wsrender-data`` where there is one, with a warning. Creates nothing."""
    import platformdirs

    users = platformdirs.user_data_path("wsrender", appauthor=False)
    if not OLD_FOLDER.is_dir():
        return users
    text = (
        f"data_dir: {OLD_FOLDER.absolute()} is used, the default folder of earlier versions; the default is now "
        f"{users}: move the folder there, or name it by --data-dir or WSRENDER_DATA_DIR"
    )
    warnings.warn(text, UserWarning, stacklevel=2)
    return OLD_FOLDER.absolute()


class Settings(BaseSettings):
    """Everything that an administrator may set."""

    model_config = SettingsConfigDict(env_prefix="WSRENDER_", extra="forbid", use_attribute_docstrings=True)

    host: str = "127.0.0.1"
    """Address to listen on; any other than loopback needs an API key."""
    port: int = Field(default=8000, ge=0, le=65535)
    """Port to listen on; 0 takes a free one."""
    data_dir: Path = Field(default_factory=default_data_dir)
    """Folder of database, models, partial results and artifacts; by default the user's own (``default_data_dir``).
    Workers on other hosts need it shared."""
    workers: int = Field(default=1, ge=0)
    """Worker processes of the embedded cluster; each computes with all cores or its GPU."""
    threads_per_worker: int | None = Field(default=None, ge=1)
    """CPU threads of each worker's kernels; None: the machine's cores divided by the workers."""
    api_key_file: Path | None = None
    """File of API keys, one to a line."""
    database: str | None = None
    """SQLAlchemy URL of the database; None: SQLite in the data folder."""
    scheduler: str | None = None
    """Address of a Dask scheduler, tls://host:port; None: an embedded cluster."""
    tls_ca_file: Path | None = None
    """Certificate authority of the scheduler's cluster (PEM)."""
    tls_cert_file: Path | None = None
    """This process's certificate (PEM)."""
    tls_key_file: Path | None = None
    """This process's private key (PEM)."""
    shared_cache: bool = False
    """Whether owners share results of library robots."""

    max_body_bytes: int = Field(default=16 * 2**20, ge=1)
    """Largest request body."""
    max_samples: int = Field(default=10**11, ge=1)
    """Largest number of samples of a job."""
    max_memory_bytes: int = Field(default=8 * GIB, ge=2**28)
    """Resident memory at which a job's process is killed."""
    max_queued_per_owner: int = Field(default=1000, ge=1)
    """Unfinished jobs that an owner may have."""
    min_free_disk_bytes: int = Field(default=GIB // 2, ge=0)
    """Free disk below which nothing new is accepted."""
    job_timeout_s: float | None = Field(default=None, gt=0)
    """Timeout of jobs that ask for none; None: none."""
    max_job_timeout_s: float | None = Field(default=None, gt=0)
    """Longest timeout that a job may ask for, and the timeout of those that ask for none."""
    max_streams: int = Field(default=4, ge=0)
    """Live streams at a time; each has a process with a loop of a kilohertz."""
    max_streams_per_owner: int = Field(default=2, ge=0)
    """Live streams that an owner may have at a time."""
    shard_samples: int = Field(default=1 << 26, ge=1)
    """Samples of a sweep's shard on the CPU, 256 times as many on a GPU; large jobs get larger shards. Those of other
    analyses take about as long."""

    @model_validator(mode="after")
    def _complete_tls(self) -> Self:
        files = (self.tls_ca_file, self.tls_cert_file, self.tls_key_file)
        if self.scheduler is not None:
            if not self.scheduler.startswith("tls://"):
                raise ValueError(f"scheduler must be a tls:// address, not {self.scheduler!r}")
            if None in files:
                raise ValueError("a scheduler needs tls_ca_file, tls_cert_file and tls_key_file")
        return self

    @cached_property
    def database_url(self) -> str:
        """SQLAlchemy URL of the database."""
        return self.database or f"sqlite:///{self.database_file}"

    @property
    def database_file(self) -> Path | None:
        """The SQLite file in the data folder; None where ``database`` names another."""
        return self.data_dir.absolute() / "wsrender.db" if self.database is None else None

    def timeout_of(self, requested: float | None) -> float | None:
        """The timeout [s] of a job that asks for ``requested``; the shorter of it and the maximum."""
        limits = [t for t in (requested or self.job_timeout_s, self.max_job_timeout_s) if t is not None]
        return min(limits, default=None)
