"""``import wsrender`` is cheap, and every public name is there."""

import os
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import wsrender as ws
from wsrender.analyses import registry

HEAVY = (
    "mujoco",
    "warp",
    "scipy",
    "matplotlib",
    "pyarrow",
    "h5py",
    "skimage",
    "trimesh",
    "numpy",
    "pydantic",
)
CHECKOUT = Path(ws.__file__).parent.parent
SCRIPT = f"""
import sys, time
sys.path.insert(0, {str(CHECKOUT)!r})
started = time.perf_counter()
import wsrender
print(time.perf_counter() - started, *[name for name in {HEAVY!r} if name in sys.modules])
"""


def test_import_loads_nothing_heavy_and_takes_less_than_half_a_second():
    runs = [
        subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=True).stdout.split()
        for _ in range(3)
    ]
    assert [loaded for _, *loaded in runs] == [[]] * 3
    assert min(float(seconds) for seconds, *_ in runs) < 0.5


def test_what_an_analysis_needs_is_imported_when_it_is_planned():
    """Neither the server's process, which computes nothing, nor a run of another analysis waits for it."""
    script = """
import sys
import wsrender_server.app
print(*sys.modules.keys() & {"warp", "mujoco", "scipy", "matplotlib", "trimesh"})
import wsrender.run
print(*sys.modules.keys() & {"mujoco", "matplotlib", "trimesh", "skimage", "scipy.stats"})
"""
    path = os.pathsep.join(folder for folder in sys.path if folder)
    environment = {**os.environ, "PYTHONPATH": path}
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True, env=environment)
    assert run.stdout.split("\n") == ["", "", ""]


def test_a_run_imports_its_own_analysis_alone():
    """But for the jobs of all, which are read to tell them apart."""
    script = """
import sys
import wsrender as ws
ws.execute({"analysis": "indices_at", "robot": "scara", "configurations": [[0, 0, 0, 0]]})
print(*sorted(name for name in sys.modules if name.startswith("wsrender.analyses.") and name.endswith(".run")))
"""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(folder for folder in sys.path if folder)}
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True, env=environment)
    assert run.stdout.split() == ["wsrender.analyses.indices_at.run"]


@pytest.mark.parametrize("analysis", registry._ROWS)
def test_an_analysis_is_a_folder_of_its_name(analysis):
    entry, folder = registry._ROWS[analysis], f"wsrender.analyses.{analysis}"
    assert entry.job.partition(":")[0] == f"{folder}.job"
    assert entry.run.partition(":")[0] in (f"{folder}.run", f"{folder}.several")  # the latter of one robot or several
    readme = CHECKOUT / "wsrender" / "analyses" / analysis / "README.md"
    assert readme.read_text().startswith(f"# {analysis}\n")


@pytest.mark.parametrize("name", ws.__all__)
def test_public_name_is_importable(name):
    assert getattr(ws, name) is not None
    assert name in dir(ws)


def test_all_is_sorted_and_complete():
    assert list(ws.__all__) == sorted(set(ws.__all__))
    lazy = {*ws._MODULE_OF_NAME, *ws._MODULES}
    errors = {name for name, value in vars(ws.errors).items() if isinstance(value, type) and name.endswith("Error")}
    assert lazy | errors | {"__version__"} == set(ws.__all__)


def test_public_modules_stay_modules():
    import wsrender.run

    assert ws.run is wsrender.run
    assert ws.execute is wsrender.run.execute


def test_analyses_hide_no_public_function():
    """A module becomes an attribute of its package when it is imported."""
    for entry in registry._table().values():
        for text in (entry.job, entry.run):
            import_module(text.partition(":")[0])
    assert all(callable(getattr(ws.run, name)) for name in ws.run.__all__)


def test_unknown_name():
    with pytest.raises(AttributeError, match="module 'wsrender' has no attribute 'analyse'"):
        ws.analyse  # noqa: B018


def test_a_missing_extra_names_the_pip_command(monkeypatch):
    def import_module(name):
        raise ModuleNotFoundError("No module named 'warp'", name="warp")

    monkeypatch.setattr(ws, "import_module", import_module)
    monkeypatch.delitem(vars(ws), "load_robot", raising=False)
    with pytest.raises(ws.MissingExtraError, match=r'warp is not installed; .*: pip install "\.\[engine\]"'):
        ws.load_robot  # noqa: B018
