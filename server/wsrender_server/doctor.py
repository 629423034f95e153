"""Whether a server can run here: each check says what it found, and of what is wrong the command that mends it."""

import importlib.metadata
import os
import shutil
import socket
import stat
import subprocess
import sys
from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from wsrender.errors import InputError, WsrenderError
from wsrender_server.gpus import present_gpus
from wsrender_server.jobs.faults import StoreUnavailable
from wsrender_server.jobs.files import OTHERS
from wsrender_server.settings import Settings

PATIENCE_S = 60.0
KERNELS = "import warp; warp.init(); print('', *(device.name for device in warp.get_cuda_devices()), sep='|')"
PICTURE = """import pyvista
plotter = pyvista.Plotter(off_screen=True, window_size=(32, 32))
plotter.add_mesh(pyvista.Sphere())
assert plotter.screenshot(None, return_img=True).std() > 0
print(plotter.render_window.GetClassName())"""


@dataclass(frozen=True)
class Finding:
    """What a check found; ``remedy`` is the command that mends it, empty where nothing is wrong."""

    check: str
    found: str
    remedy: str = ""


def findings(settings: Settings) -> Iterator[Finding]:
    """All checks, one after the other; they change nothing."""
    for check in (_versions, _gpu, _opengl, _permissions, _store, _database, _port, _scheduler):
        yield from check(settings)


def _versions(settings: Settings) -> Iterator[Finding]:
    from packaging.requirements import Requirement

    python = ".".join(map(str, sys.version_info[:3]))
    try:
        needed = [Requirement(text) for text in importlib.metadata.requires("wsrender") or ()]
    except importlib.metadata.PackageNotFoundError:
        yield Finding("versions", f"Python {python}; wsrender is not installed", 'pip install ".[server]"')
        return
    for each in needed:
        if each.name == "wsrender" or not any(each.marker is None or each.marker.evaluate({"extra": extra}) for extra in
                                              ("", "engine", "server")):  # fmt: skip
            continue
        try:
            version = importlib.metadata.version(each.name)
        except importlib.metadata.PackageNotFoundError:
            version = ""
        if not each.specifier.contains(version or "0", prereleases=True) or not version:
            yield Finding(
                "versions", f"{each.name} {version or 'is missing'}", f'pip install "{each.name}{each.specifier}"'
            )
            return
    yield Finding("versions", f"wsrender {importlib.metadata.version('wsrender')}, Python {python}")


def _gpu(settings: Settings) -> Iterator[Finding]:
    present, (fault, seen) = present_gpus(), _run(KERNELS)
    if fault:
        yield Finding("gpu", f"Warp does not start: {fault}", 'pip install --force-reinstall "warp-lang>=1.19,<2"')
        return
    devices = seen.strip().splitlines()[-1].split("|")[1:] if "|" in seen else []
    if len(devices := [name for name in devices if name]) < len(present):
        yield Finding("gpu", f"of {len(present)} GPUs Warp sees {len(devices)}", "apt-get install nvidia-driver")
    else:
        yield Finding("gpu", ", ".join(devices) or "none: jobs are computed on the CPU")


def _opengl(settings: Settings) -> Iterator[Finding]:
    fault, window = _run(PICTURE)
    if "No module named 'pyvista'" in fault:
        yield Finding("opengl", 'no 3-D pictures without the extra "render", which is not installed')
    elif fault:
        yield Finding("opengl", f"no picture could be drawn: {fault}", "apt-get install libgl1 libegl1 libxrender1")
    else:
        yield Finding("opengl", window.strip())


def _permissions(settings: Settings) -> Iterator[Finding]:
    folder = settings.data_dir.absolute()
    private = [path for path in (settings.tls_key_file, settings.api_key_file) if path is not None]
    for path in (settings.tls_ca_file, settings.tls_cert_file, *private):
        if path is not None and not os.access(path, os.R_OK):
            yield Finding("permissions", *_unreadable(path, settings))
            return
    for path in (*private, *([folder] if folder.exists() else [])):
        if path.stat().st_mode & (OTHERS if path == folder else _open_to_others(path)):
            yield Finding("permissions", f"other users may look into {path}", f"chmod go= {path}")
            return
    where = next(path for path in (folder, *folder.parents) if path.exists())
    if not os.access(where, os.W_OK | os.X_OK):
        yield Finding("permissions", f"{where} cannot be written", f"chown {os.geteuid()} {where}")
        return
    yield Finding(
        "permissions", f"{folder} is writable" + ("" if where == folder else ", and is made at the first start")
    )


def _unreadable(path: Path, settings: Settings) -> tuple[str, str]:
    """What is wrong with a file that cannot be read, and the command that mends it."""
    if path.exists():
        return f"{path} cannot be read", f"chown {os.geteuid()} {path} && chmod u+r {path}"
    if path == settings.api_key_file:
        return f"{path} is not there", f"(umask 077 && openssl rand -hex 24 > {path})"
    return f"{path} is not there", f"deploy/certificates.sh {path.parent}  # makes ca.pem, cert.pem and key.pem"


def _open_to_others(path: Path) -> int:
    """Rights of a file that others must not have: what its group may read is right where we read it by the group.

    So is a secret mounted by Kubernetes: root's, 0440, of the group that the pod's processes have.
    """
    status = path.stat()
    by_group = status.st_uid != os.geteuid() and status.st_gid in (os.getegid(), *os.getgroups())
    return OTHERS & ~stat.S_IRGRP if by_group else OTHERS


def _store(settings: Settings) -> Iterator[Finding]:
    folder = settings.data_dir.absolute()
    free = shutil.disk_usage(next(path for path in (folder, *folder.parents) if path.exists())).free
    found, least = f"{free / 2**30:.1f} GiB of disk are free in {folder}", settings.min_free_disk_bytes
    if free >= least:
        yield Finding("store", found)
        return
    week = "WSRENDER_KEEP_RESULTS_S=604800"  # results that nobody has used for so long
    remedy = f"{week} wsrender database prune --data-dir {folder}"
    yield Finding("store", f"{found}, less than {least / 2**30:.1f} GiB", remedy)


def _database(settings: Settings) -> Iterator[Finding]:
    from sqlalchemy import make_url

    from wsrender_server.jobs.store import open_existing_store

    where = settings.database_place
    try:
        store = open_existing_store(settings)
        if store is None:
            yield Finding("database", f"{where} is made at the first start")
            return
        with closing(store):
            store.ping()
    except StoreUnavailable as error:
        url = make_url(settings.database_url)
        remedy = f"pg_isready -h {url.host} -p {url.port or 5432}" if settings.database else f"fuser -v {where}"
        yield Finding("database", " ".join(str(error).split()), remedy)
    except InputError as error:
        which = "  # with the same WSRENDER_DATABASE" if settings.database else f" --data-dir {settings.data_dir}"
        command = "upgrade" if "wsrender database upgrade" in error.message else "restore"  # what only a backup mends
        yield Finding("database", error.message, f"wsrender database {command}{which}")
    else:
        yield Finding("database", f"{where} answers")


def _port(settings: Settings) -> Iterator[Finding]:
    from wsrender_server.serving import listen

    where = f"{settings.host}:{settings.port}"
    try:
        listen(settings).close()
    except (WsrenderError, OSError) as error:
        yield Finding("port", str(error), f"ss -ltnp 'sport = :{settings.port}'  # or wsrender serve --port 0")
    else:
        yield Finding("port", f"{where} is free")


def _scheduler(settings: Settings) -> Iterator[Finding]:
    if settings.scheduler is None:
        yield Finding("scheduler", "embedded")
        return
    host, _, port = settings.scheduler.removeprefix("tls://").rpartition(":")
    try:
        socket.create_connection((host, int(port)), timeout=5).close()
    except (OSError, ValueError) as error:
        remedy = f"dask scheduler --protocol tls --port {port or 8786}  # with the cluster's certificates"
        yield Finding("scheduler", f"nobody listens at {settings.scheduler}: {error}", remedy)
    else:
        yield Finding("scheduler", f"{settings.scheduler} listens")


def _run(program: str) -> tuple[str, str]:
    """The last line of what a Python program complains of, empty where it ends well, and what it prints."""
    try:
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=PATIENCE_S)
    except subprocess.TimeoutExpired:
        return f"nothing came within {PATIENCE_S:g} s", ""
    said = done.stderr.strip().splitlines() or [f"it ended with {done.returncode}"]
    return (said[-1] if done.returncode else ""), done.stdout
