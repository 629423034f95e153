"""A test that hangs ends, wherever it hangs."""

import subprocess
import sys
from pathlib import Path

HANGING = """
import ctypes

def test_that_hangs_and_lets_no_other_thread_run():
    ctypes.PyDLL(None).sleep(60)  # as a kernel does: no signal is handled, the interpreter's lock is held
"""


def test_a_hanging_test_ends_its_process_and_says_where(pytestconfig, tmp_path):
    """By what this suite is configured with, in a hundredth of its time."""
    settings = {name: pytestconfig.getini(name) for name in ("faulthandler_timeout", "faulthandler_exit_on_timeout")}
    assert 0 < float(settings["faulthandler_timeout"]) <= 300
    (tmp_path / "test_hanging.py").write_text(HANGING)
    command = [sys.executable, "-m", "pytest", "-c", str(pytestconfig.inipath), "--rootdir", str(tmp_path)]
    own = ["-o", "faulthandler_timeout=3", "-p", "no:cacheprovider", str(tmp_path)]
    ended = subprocess.run([*command, *own], capture_output=True, text=True, timeout=250, cwd=Path(__file__).parent)
    assert ended.returncode == 1
    assert "Timeout (0:00:03)!" in ended.stderr and "test_that_hangs_and_lets_no_other_thread_run" in ended.stderr
