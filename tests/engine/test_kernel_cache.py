"""Each kernel is compiled once: by one of the processes that need it, and whatever was compiled before it."""

import os
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import SimpleNamespace

import warp as wp

import wsrender as ws
from wsrender.engine import devices_of
from wsrender.engine.kernel_cache import loaded

SCRIPT = """
import sys
import warp as wp
import wsrender as ws
from wsrender.engine import devices_of

devices_of("cpu")
wp.config.log_level = wp.LOG_INFO
for indices in sys.argv[1:]:
    ws.analyze("phantom_omni", sampling=ws.Random(300, seed=1), indices=[indices], voxel_size_m=0.02, device="cpu")
"""

CONSTRAINED = """
import sys
import warp as wp
import wsrender as ws
from wsrender.engine import devices_of

devices_of("cpu")
wp.config.log_level = wp.LOG_INFO
around = {"sphere": {"center_m": [0, 0, 0], "radius_m": 2.0}}
toward = {"toward": [0, 0, 1], "within_deg": 170}
asked = {"constrained": {"self_collision": True, "region": around, "orientation": toward}, "bare": None}
for name in sys.argv[1:]:
    own = {"constraints": asked[name], "refined_volume": None, "device": "cpu"}
    ws.analyze("ur5e", sampling=ws.Random(300, seed=1), indices=["isotropy"], voxel_size_m=0.1, **own)
"""

SMALL_KERNEL = """
import sys
import warp as wp
from wsrender_kernels.pointwise import configuration_kernel
from wsrender.engine import devices_of
from wsrender.engine.kernel_cache import loaded

device = devices_of("cpu")[0]
wp.config.log_level = wp.LOG_INFO
loaded(configuration_kernel(wp.float32, int(sys.argv[1]), "random"), device)
"""


def start(cache, *arguments, script=SCRIPT):
    environment = {**os.environ, "WARP_CACHE_PATH": str(cache)}
    command = [sys.executable, "-c", script, *arguments]
    return subprocess.Popen(command, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def compiled(processes):
    """Names of the modules that each process compiled."""
    return [[name for name, how in each.items() if how == "(compiled)"] for each in modules(processes)]


def modules(processes):
    """Of each process by name of a module whether it was "(compiled)" or "(cached)"."""
    logs = [process.communicate(timeout=600)[0] for process in processes]
    for process, log in zip(processes, logs, strict=True):
        assert process.returncode == 0, log
    lines = [[line.split() for line in log.splitlines() if line.startswith("Module ")] for log in logs]
    return [{words[1]: words[-1] for words in each} for each in lines]


def test_processes_share_what_one_of_them_compiles(tmp_path):
    one, other = compiled([start(tmp_path, "manipulability"), start(tmp_path, "manipulability")])
    assert one + other
    assert len(set(one + other)) == len(one + other)
    # A kernel is the same after others as before them.
    after, alone = compiled([start(tmp_path, "manipulability", "isotropy")]), compiled([start(tmp_path, "isotropy")])
    assert after[0] and not alone[0]


def test_a_sweep_without_constraints_has_no_code_of_any(tmp_path):
    """Its kernels are the same whether a process has made constrained ones before or none, and name nothing of them."""
    (before,) = modules([start(tmp_path, "constrained", "bare", script=CONSTRAINED)])
    (alone,) = modules([start(tmp_path, "bare", script=CONSTRAINED)])
    made = {name for name, how in before.items() if how == "(compiled)"}
    assert set(alone.values()) == {"(cached)"} and set(alone) < made
    assert any("sweep" in name for name in alone)
    code = {name: next(tmp_path.rglob(f"wp_{name}_*.cpp")).read_text().lower() for name in made}
    words = ("reject", "label", "constraint", "collision", "first_of", "_region", "limits")
    assert {word for name in alone for word in words if word in code[name]} == set()
    others = "".join(code[name] for name in made - set(alone))
    assert all(word in others for word in words)


def test_the_precompiled_header_is_kept(tmp_path):
    """Made by the first process that compiles, used by the next, also for a kernel of other options."""
    assert compiled([start(tmp_path, "2", script=SMALL_KERNEL)])[0]
    (made,) = {(header.stat().st_ino, header.stat().st_mtime_ns) for header in tmp_path.rglob("header_*/*.pch")}
    assert compiled([start(tmp_path, "3", script=SMALL_KERNEL)])[0]
    assert compiled([start(tmp_path, "manipulability")])[0]
    assert {(header.stat().st_ino, header.stat().st_mtime_ns) for header in tmp_path.rglob("header_*/*.pch")} == {made}


def test_a_header_that_does_not_fit_is_done_away_with(tmp_path):
    assert compiled([start(tmp_path, "2", script=SMALL_KERNEL)])[0]
    headers = set(tmp_path.rglob("header_*/*.pch"))
    next(iter(headers)).write_bytes(b"cut")  # by all its names
    assert compiled([start(tmp_path, "3", script=SMALL_KERNEL)])[0]
    assert set(tmp_path.rglob("header_*/*.pch")) < headers


def test_a_launch_runs_what_was_loaded(device, precision, monkeypatch):
    """And does not have it compiled once more, for another number of threads per block."""
    before, launch = [], wp.launch

    def watched(kernel, **options):
        before.append((kernel.module, len(kernel.module.execs)))
        launch(kernel, **options)

    monkeypatch.setattr(wp, "launch", watched)
    ws.analyze("phantom_omni", sampling=ws.Random(300), voxel_size_m=0.02, precision=precision, device=device)
    assert before
    assert all(len(module.execs) == count > 0 for module, count in before)


def test_threads_compile_one_after_the_other():
    """Options of the compiler are those of the whole process."""
    busy, most = [], []

    class Kernel:
        def __init__(self, number):
            self.module = SimpleNamespace(name=f"test_{number}", load=self.load, options={"cpu_compiler_flags": ""})

        def load(self, device, block_dim):
            busy.append(self)
            most.append(len(busy))
            time.sleep(0.02)
            busy.remove(self)

    device = devices_of("cpu")[0]
    with ThreadPoolExecutor(4) as pool:
        list(pool.map(lambda number: loaded(Kernel(number), device), range(8)))
    assert most == [1] * 8
    for number in range(8):
        Path(wp.config.kernel_cache_dir, f"test_{number}.lock").unlink(missing_ok=True)
