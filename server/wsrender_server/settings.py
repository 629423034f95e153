"""Settings of the server: environment variables WSRENDER_…, options of the commands, defaults."""

import os
import re
import warnings
from difflib import get_close_matches
from functools import cached_property
from ipaddress import IPv4Network, IPv6Network, ip_address
from pathlib import Path
from typing import Annotated, Any, Self

from pydantic import AfterValidator, BeforeValidator, Field, model_validator
from pydantic_settings import BaseSettings, NoDecode, SettingsConfigDict

OLD_FOLDER = Path("wsrender-data")  # in the working directory: the default of 0.1
GIB = 2**30
_ORIGIN = re.compile(r"https?://(\[[0-9a-f:.]+\]|[a-z0-9._-]+)(:[0-9]{1,5})?")
_TARGET = re.compile(r"https?://(\[[0-9a-f:.]+\]|\*|(\*\.)?[a-z0-9_-][a-z0-9._-]*)(:[0-9]{1,5})?")
PREFIX = "WSRENDER_"
# Variables that are not the server's: of kernels, of collision tables and uploaded models, of the client, of results.
OTHERS = ("THREADS", "CACHE_DIR", "MODELS", "SERVER", "TOKEN", "SAY_HOST")


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


def _listed(value: Any) -> Any:
    return [part.strip().lower() for part in value.split(",") if part.strip()] if isinstance(value, str) else value


def _origin(value: str) -> str:
    if not _ORIGIN.fullmatch(value):
        raise ValueError(f"must be origins, such as https://lab.example.org or http://localhost:3000, not {value!r}")
    return value


def _target(value: str) -> str:
    if not _TARGET.fullmatch(value):
        such = "https://hooks.example.org, https://*.example.org, https://* or http://receiver:9000"
        raise ValueError(f"must be origins, such as {such}, not {value!r}")
    return value


Names = Annotated[tuple[str, ...], NoDecode, BeforeValidator(_listed)]
Origins = Annotated[tuple[Annotated[str, AfterValidator(_origin)], ...], NoDecode, BeforeValidator(_listed)]
TargetOrigins = Annotated[tuple[Annotated[str, AfterValidator(_target)], ...], NoDecode, BeforeValidator(_listed)]
Networks = Annotated[tuple[IPv4Network | IPv6Network, ...], NoDecode, BeforeValidator(_listed)]


class Settings(BaseSettings):
    """Everything that an administrator may set."""

    model_config = SettingsConfigDict(env_prefix=PREFIX, extra="forbid", use_attribute_docstrings=True)

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
    worker_start_s: float = Field(default=300.0, gt=0)
    """How long a worker and its kernel process may take to start; what takes longer is started again."""
    warm_spare: bool = True
    """Whether a worker keeps a second process ready, some 400 MiB, so that the job after a canceled one need not wait
    for one to start."""
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
    allowed_hosts: Names = ()
    """Names, separated by commas, that the server answers to beside addresses, this machine's own name and names
    without a dot or in .local; their pages may ask it too. Without an API key only localhost and these."""
    cors_origins: Origins = ()
    """Origins, separated by commas, whose pages may ask the server and read its answers (CORS), each with an API key of
    its own where the server asks for one."""
    root_path: str = Field(default="", pattern=r"^((/[A-Za-z0-9._~-]+)+)?$")
    """Prefix under which a proxy shows the server, such as /lab: addresses in answers begin with it."""
    trusted_proxies: Networks = ()
    """Addresses or networks of proxies, separated by commas: their X-Forwarded-Prefix counts, and their connections are
    not limited."""
    webhook_targets: TargetOrigins = ()
    """Origins, separated by commas, that webhooks may be sent to: https://hooks.example.org, https://*.example.org for
    every name below it, https://* for all, http://… where it need not be encrypted. Empty: none is sent."""
    webhook_networks: Networks = ()
    """Addresses or networks, separated by commas, that webhooks may reach beside public ones: 10.0.0.0/8."""
    webhook_retry_s: float = Field(default=5.0, gt=0, le=3600)
    """Longest wait after the first failure of a delivery [s]; it doubles with each, up to an hour."""
    webhook_give_up_s: float = Field(default=3 * 86_400.0, ge=0)
    """Age of a delivery after which a failure is its last [s]."""

    read_timeout_s: float = Field(default=20.0, gt=0)
    """Time for the head of a request, and for its body beside its length at 16 KiB/s [s]."""
    max_connections_per_client: int = Field(default=512, ge=1)
    """Connections that an address may have at a time, WebSockets among them."""

    max_body_bytes: int = Field(default=16 * 2**20, ge=1)
    """Largest request body, but of an upload."""
    max_upload_bytes: int = Field(default=64 * 2**20, ge=1)
    """Largest upload, of a model, a ZIP, a mesh or a table."""
    max_samples: int = Field(default=10**11, ge=1)
    """Largest number of samples of a job."""
    max_memory_bytes: int = Field(default=8 * GIB, ge=2**28)
    """Resident memory at which a job's process is killed."""
    max_planning_memory_bytes: int = Field(default=2 * GIB, ge=2**28)
    """Memory that planning a job may take, also for an estimate."""
    max_planning_s: float = Field(default=900.0, gt=0)
    """How long planning a job may take; for an estimate 180 s at most."""
    max_queued_per_owner: int = Field(default=1000, ge=1)
    """Unfinished jobs that an owner may have."""
    min_free_disk_bytes: int = Field(default=GIB // 2, ge=0)
    """Free disk below which nothing new is accepted."""
    keep_results_s: float | None = Field(default=None, ge=0)
    """Time for which a result is kept that nobody uses [s]; its jobs expire then, and can be retried. None: ever."""
    keep_results_bytes: int | None = Field(default=None, ge=0)
    """Bytes of all results; the least recently used go first. None: no limit."""
    keep_results_bytes_per_owner: int | None = Field(default=None, ge=0)
    """Bytes of an owner's results; the least recently used go first. None: no limit."""
    keep_jobs_s: float | None = Field(default=None, ge=0)
    """Time after its end at which a job is deleted [s]. None: never."""
    keep_jobs_per_owner: int | None = Field(default=None, ge=1)
    """Ended jobs of an owner, answers from the cache among them; the oldest are deleted. None: no limit."""
    keep_partials_s: float = Field(default=86400.0, ge=0)
    """Time for which partial results of failed and canceled jobs are kept for a retry [s]."""
    max_model_bytes_per_owner: int | None = Field(default=None, ge=0)
    """Bytes of the models, meshes and tables that an owner may have uploaded. None: no limit."""
    retention_interval_s: float = Field(default=60.0, gt=0)
    """Time between two looks for what is kept no longer [s]."""
    job_timeout_s: float | None = Field(default=86_400.0, gt=0)
    """Timeout of jobs that ask for none."""
    max_job_timeout_s: float | None = Field(default=None, gt=0)
    """Longest timeout that a job may ask for, and the timeout of those that ask for none."""
    max_streams: int = Field(default=4, ge=0)
    """Live streams at a time; each has a process with a loop of a kilohertz."""
    max_streams_per_owner: int = Field(default=2, ge=0)
    """Live streams that an owner may have at a time."""
    max_view_sessions: int = Field(default=8, ge=0)
    """Interactive sessions of pages at a time; each has a process, behind the jobs."""
    max_view_sessions_per_owner: int = Field(default=4, ge=0)
    """Interactive sessions that an owner may have at a time."""
    max_view_session_memory_bytes: int = Field(default=2 * GIB, ge=2**28)
    """Resident memory at which the process of an interactive session is killed."""
    shard_samples: int = Field(default=1 << 26, ge=1)
    """Samples of a sweep's shard on the CPU, 256 times as many on a GPU; large jobs get larger shards. Those of other
    analyses take about as long."""

    @model_validator(mode="before")
    @classmethod
    def _no_other_variables(cls, values: Any) -> Any:
        known = [PREFIX + name.upper() for name in (*cls.model_fields, *OTHERS)]
        for name in sorted(os.environ):
            said = name.upper()  # of settings, letters of either case count
            if said.startswith(PREFIX) and said not in known and not said.startswith(f"{PREFIX}TEST_"):
                near = "".join(f"; the nearest is {each}" for each in get_close_matches(said, known, n=1))
                raise ValueError(f"the environment variable {name} is none of the server's settings{near}")
        return values

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
        return None if self.database else self.data_dir.absolute() / "wsrender.db"

    @property
    def database_place(self) -> str:
        """Where the database is, without a password."""
        if self.database_file is not None:
            return str(self.database_file)
        from sqlalchemy import make_url

        return make_url(self.database_url).render_as_string()

    def trusts(self, client: str) -> bool:
        """Whether an address is a trusted proxy's."""
        try:
            return any(ip_address(client) in network for network in self.trusted_proxies)
        except ValueError:  # no address: a test's client
            return False

    def timeout_of(self, requested: float | None) -> float | None:
        """The timeout [s] of a job that asks for ``requested``; the shorter of it and the maximum."""
        limits = [t for t in (requested or self.job_timeout_s, self.max_job_timeout_s) if t is not None]
        return min(limits, default=None)
