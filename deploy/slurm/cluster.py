"""A Dask scheduler whose workers are Slurm jobs, as many as there is work for: for `wsrender serve --scheduler`.

    python deploy/slurm/cluster.py --certificates certificates --data-dir /shared --interface ib0 --maximum 20

It runs until it is told to end (SIGTERM), prints its address, and takes its jobs with it. It needs dask-jobqueue beside
wsrender, and Slurm's commands. What one site wants is a directive of sbatch: --directive=--gres=gpu:1.
"""

import argparse
import os
import signal
import threading
from pathlib import Path

import dask
from dask_jobqueue import SLURMCluster
from wsrender_server.jobs.worker import security
from wsrender_server.settings import Settings


def main() -> None:
    """Run the scheduler, and sbatch and scancel workers."""
    options = _options()
    folder, data = options.certificates.absolute(), options.data_dir.absolute()
    tls = {f"tls_{name}_file": folder / f"{name}.pem" for name in ("ca", "cert", "key")}
    environment = {
        **{name: value for name, value in os.environ.items() if name.startswith("WSRENDER_")},
        **{f"WSRENDER_{name.upper()}": value for name, value in tls.items()},
        "WSRENDER_DATA_DIR": data,
        "WSRENDER_THREADS_PER_WORKER": options.cores,
        "DASK_DISTRIBUTED__WORKER__DAEMON": "False",  # a daemon may not have the kernel process
    }
    dask.config.set({"distributed.scheduler.worker-ttl": "30s"})  # a worker that hangs for so long is lost
    os.umask(0o077)
    with SLURMCluster(
        cores=1,  # Dask's threads: one task at a time, which uses all of job_cpu
        processes=1,
        job_cpu=options.cores,
        memory=options.memory,
        queue=options.partition,
        walltime=options.time,
        job_name="wsrender-worker",
        job_extra_directives=options.directive,
        job_script_prologue=["umask 077", *(f"export {name}='{value}'" for name, value in environment.items())],
        worker_extra_args=["--preload", "wsrender_server.preload", "--no-dashboard"],
        local_directory=str(data / "dask"),
        log_directory=str(data / "slurm"),
        protocol="tls://",
        security=security(Settings(**tls)),
        interface=options.interface,
        scheduler_options={"port": options.port, "dashboard_address": "127.0.0.1:0"},
    ) as cluster:
        # Tasks are long: whoever has waited for a second may have a worker; one that is idle for ten goes.
        cluster.adapt(
            minimum=options.minimum, maximum=options.maximum, interval="1s", wait_count=10, target_duration="1s"
        )
        print(cluster.scheduler_address, flush=True)
        end = threading.Event()
        for number in (signal.SIGTERM, signal.SIGINT):
            signal.signal(number, lambda *_: end.set())
        end.wait()


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--certificates", type=Path, required=True, help="folder of ca.pem, cert.pem and key.pem")
    parser.add_argument("--data-dir", type=Path, required=True, help="the server's, which all nodes share")
    parser.add_argument("--interface", help="network interface by which nodes reach this machine")
    parser.add_argument("--port", type=int, default=8786)
    parser.add_argument("--minimum", type=int, default=0, help="workers that stay [0]")
    parser.add_argument("--maximum", type=int, default=8, help="workers at most [8]")
    parser.add_argument("--cores", type=int, default=8, help="cores of a worker [8]")
    parser.add_argument("--memory", default="10GiB", help="of a worker, above WSRENDER_MAX_MEMORY_BYTES [10GiB]")
    parser.add_argument("--time", default="12:00:00", help="after which Slurm ends a worker [12:00:00]")
    parser.add_argument("--partition")
    parser.add_argument("--directive", action="append", default=[], help="an option of sbatch; repeatable")
    return parser.parse_args()


if __name__ == "__main__":
    main()
