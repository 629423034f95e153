"""Wheel and sdist, built from this checkout and used outside of it; needs a package registry."""

import os
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest
from wsrender_server.local_server import LocalServer

import wsrender as ws

CHECKOUT = Path(__file__).parents[2]
QUICK = {
    "analysis": "workspace",
    "robot": {"library": "ur5e"},
    "sampling": {"method": "sobol", "count": 4096},
    "indices": ["manipulability"],
    "voxel_size_m": 0.1,
    "device": "cpu",
}


def run(*command, folder, **environment):
    """The output of a command that succeeds, run where nothing of the checkout is found by accident."""
    done = subprocess.run(
        [str(part) for part in command],
        cwd=folder,
        env={**os.environ, "PYTHONSAFEPATH": "1", **environment},
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def base(tmp_path_factory):
    """Folder of a new virtual environment."""
    folder = tmp_path_factory.mktemp("base")
    run(sys.executable, "-m", "venv", folder / "venv", folder=folder)
    return folder


@pytest.fixture(scope="module")
def built(base):
    """The sdist, and the wheel made of it."""
    run(base / "venv/bin/pip", "install", "--quiet", "build", folder=base)
    run(base / "venv/bin/python", "-m", "build", "--outdir", base / "dist", CHECKOUT, folder=base)
    (sdist,), (wheel,) = (base / "dist").glob("*.tar.gz"), (base / "dist").glob("*.whl")
    return sdist, wheel


@pytest.fixture(scope="module")
def installed(built, tmp_path_factory):
    """PYTHONPATH of the wheel and of the sdist, each installed beside the packages of this environment."""
    folders = {}
    for name, archive in zip(("sdist", "wheel"), built, strict=True):
        folders[name] = tmp_path_factory.mktemp(name)
        command = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--target", folders[name], archive]
        run(*command, folder=folders[name])
    return folders


def test_archives_hold_what_they_should(built):
    sdist, wheel = built
    files = set(zipfile.ZipFile(wheel).namelist())
    assert {
        "wsrender/__init__.py",
        "wsrender/py.typed",
        "wsrender/mjcf/ur5e/ur5e.xml",
        "wsrender_kernels/sweep.py",
        "wsrender_server/migrations/versions/0001_jobs.py",
        "wsrender_server/static/swagger-ui/swagger-ui-bundle.js",
    } <= files
    tops = {name.partition("/")[0] for name in files}
    assert tops == {"wsrender", "wsrender_kernels", "wsrender_server", f"wsrender-{ws.__version__}.dist-info"}
    with tarfile.open(sdist) as archive:
        inside = {name.partition("/")[2] for name in archive.getnames()}
    assert {
        "README.md",
        "LICENSE",
        "pyproject.toml",
        "mjcf/ur5e/ur5e.xml",
        "kernels/wsrender_kernels/sweep.py",
    } <= inside


@pytest.mark.parametrize("kind", ["wheel", "sdist"])
def test_installed_outside_the_checkout(installed, kind, tmp_path):
    path = {"PYTHONPATH": str(installed[kind])}
    where = run(sys.executable, "-c", "import wsrender; print(wsrender.__file__)", folder=tmp_path, **path)
    assert Path(where.strip()).is_relative_to(installed[kind])
    wsrender = (sys.executable, "-m", "wsrender")
    assert "ur5e" in run(*wsrender, "robots", folder=tmp_path, **path)
    run(*wsrender, "run", "scara", "--grid", "4", "--device", "cpu", "-o", "out", folder=tmp_path, **path)
    assert len(ws.Result.load(tmp_path / "out").document["artifacts"]) > 5
    assert "--data-dir" in run(*wsrender, "serve", "--help", folder=tmp_path, **path)


def test_base_only_environment_completes_a_job(base, built, installed, tmp_path, monkeypatch):
    """The wheel without extras talks to the server of the wheel, through a socket."""
    pip, python = base / "venv/bin/pip", base / "venv/bin/python"
    run(pip, "install", "--quiet", built[1], folder=tmp_path)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONSAFEPATH", "1")
    monkeypatch.setenv("PYTHONPATH", str(installed["wheel"]))
    with LocalServer(tmp_path / "data") as server:
        monkeypatch.delenv("PYTHONPATH")
        script = f"""
import importlib.util
for heavy in ("warp", "mujoco", "h5py", "pyarrow", "scipy", "matplotlib", "fastapi", "dask"):
    assert importlib.util.find_spec(heavy) is None, heavy
import wsrender
with wsrender.Client({server.url!r}) as client:
    result = client.submit({QUICK!r}).wait(progress=True, timeout=300).result()
    assert len(result.sample.position) == 4096
    print(int(result.volume.count.sum()))
    result.save("out")
"""
        assert run(python, "-c", script, folder=tmp_path) == "4096\n"
        assert "succeeded" in run(python, "-m", "wsrender", "jobs", "list", "--server", server.url, folder=tmp_path)
    assert (tmp_path / "out/surface.glb").is_file()
    assert run(python, "-m", "wsrender", "--version", folder=tmp_path) == f"wsrender {ws.__version__}\n"
    refused = subprocess.run([python, "-m", "wsrender", "serve"], capture_output=True, text=True, cwd=tmp_path)
    assert refused.returncode == 1 and f'pip install "{built[1].name}[server]"' in refused.stderr
