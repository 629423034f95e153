"""A Slurm cluster of this one machine, without systemd and cgroups: state, key, sockets and ports are in one folder."""

import os
import shutil
import signal
import socket
import subprocess
import time
from pathlib import Path

import psutil

from tests.server.conftest import free_port

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "scancel", "squeue")
CONFIGURATION = """
ClusterName=wsrender
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmctldPort={controller_port}
SlurmdPort={node_port}
AuthType=auth/munge
AuthInfo=socket={folder}/socket/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
ReturnToService=2
KillWait=5
NodeName={host} NodeAddr=127.0.0.1 CPUs={cores} RealMemory={megabytes} State=UNKNOWN
PartitionName=main Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


class Slurm:
    """The cluster for as long as a block lasts; only root may start it. ``environment`` is what its commands need."""

    def __init__(self, folder: Path):
        self.folder = folder
        self.environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf")}

    def __enter__(self):
        for name in ("state", "spool", "munge", "socket"):  # munged looks who may write the folders of its files
            (self.folder / name).mkdir(parents=True)
            (self.folder / name).chmod(0o755)
        (self.folder / "munge" / "key").write_bytes(os.urandom(128))
        (self.folder / "munge" / "key").chmod(0o600)
        configuration = CONFIGURATION.format(
            folder=self.folder,
            host=socket.gethostname().partition(".")[0],
            controller_port=free_port(),
            node_port=free_port(),
            cores=os.cpu_count(),
            megabytes=psutil.virtual_memory().total // 2**20 - 512,
        )
        (self.folder / "slurm.conf").write_text(configuration)
        munge = {"key-file": "munge/key", "socket": "socket/munge", "pid-file": "munged.pid", "log-file": "munge/log"}
        munge["seed-file"] = "munge/seed"
        try:
            self.run("munged", "--force", *(f"--{option}={self.folder / file}" for option, file in munge.items()))
            self.run("slurmctld", "-c")
            self.run("slurmd")
            ends = time.monotonic() + 60
            while self.run("sinfo", "-h", "-o", "%T").strip() != "idle":
                assert time.monotonic() < ends, (self.folder / "slurmd.log").read_text()[-2000:]
                time.sleep(0.1)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        if self.jobs():
            self.run("scancel", *self.jobs())
            time.sleep(1)
        for name in ("slurmd", "slurmctld", "munged"):
            file = self.folder / f"{name}.pid"
            if file.exists():
                process = psutil.Process(int(file.read_text()))
                process.send_signal(signal.SIGTERM)
                try:
                    process.wait(20)
                except psutil.TimeoutExpired:
                    process.kill()

    def run(self, program: str, *arguments: str) -> str:
        """What a program says; raises CalledProcessError where it fails."""
        path = shutil.which(program)
        assert path is not None
        ran = subprocess.run([path, *arguments], env=self.environment, capture_output=True, text=True, timeout=60)
        assert ran.returncode == 0 or program == "sinfo", f"{program}: {ran.stderr}"
        return ran.stdout

    def jobs(self) -> list[str]:
        """Ids of the jobs that wait or run."""
        return self.run("squeue", "-h", "-o", "%i").split() if (self.folder / "slurmctld.pid").exists() else []
