"""The units, as far as systemd judges them without running."""

import re
import shutil
import subprocess

import pytest

from deploy.run_here import of_systemd
from tests.server.deploy.conftest import RECIPES, require

UNITS = RECIPES / "systemd"


def check(folder):
    require("systemd-analyze")
    return subprocess.run([folder / "check.sh"], capture_output=True, text=True)


def test_units_are_understood_and_not_exposed():
    checked = check(UNITS)
    assert checked.returncode == 0, checked.stdout + checked.stderr
    exposures = [float(number) for number in re.findall(r"service: ([\d.]+)", checked.stdout)]
    assert len(exposures) == 3
    assert max(exposures) <= 2.5


@pytest.mark.parametrize(
    ("file", "right", "wrong", "told"),
    [
        ("wsrender.service", "KillMode=", "KilMode=", "KilMode"),
        ("wsrender-worker.service", "TimeoutStopSec=30", "TimeoutStopSec=soon", "soon"),
        ("wsrender-scheduler.service", "bin/dask", "bin/dusk", "dusk"),
        ("hardening.conf", "CapabilityBoundingSet=", "#", "CapabilityBoundingSet"),
    ],
)
def test_what_is_wrong_in_a_unit_is_told(tmp_path, file, right, wrong, told):
    folder = shutil.copytree(UNITS, tmp_path / "units")
    text = (folder / file).read_text()
    assert right in text
    (folder / file).write_text(text.replace(right, wrong, 1))
    checked = check(folder)
    assert checked.returncode != 0
    assert told in checked.stdout + checked.stderr


def test_nobody_else_reads_the_files_of_a_service():
    assert {process.umask for process in of_systemd()} == {0o077}


def test_what_takes_a_capability_from_a_service_that_needs_it_is_left_out():
    """Kernels of the CPU are written into memory and run; live streams ask for real time; GPUs are devices."""
    denied = {
        unit: set(re.findall(r"(MemoryDenyWriteExecute|RestrictRealtime|PrivateDevices)=yes", text))
        for unit in ("wsrender", "wsrender-worker", "wsrender-scheduler", "hardening")
        for text in [next(UNITS.glob(f"{unit}.[sc]*")).read_text()]
    }
    assert denied == {
        "wsrender": set(),
        "wsrender-worker": {"RestrictRealtime"},
        "wsrender-scheduler": {"MemoryDenyWriteExecute", "RestrictRealtime", "PrivateDevices"},
        "hardening": set(),
    }
