"""What happens where VTK cannot draw: an error that says what to install, never a crash of this process."""

import subprocess
import sys

import numpy as np
import pytest

from wsrender.errors import MissingExtraError, RenderError
from wsrender.results.render import process
from wsrender.results.render.scene import Camera, DrawnScene

SCENE = DrawnScene(Camera(np.zeros(3), np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0]), 1.0), (8, 8))


@pytest.fixture(autouse=True)
def anew():
    """Nothing known of earlier probes."""
    process._first_working.cache_clear()
    yield
    process._first_working.cache_clear()


def answers(monkeypatch, code):
    """Replace what the probe runs."""
    monkeypatch.setattr(process, "_PROBE", code)


def test_an_x_window_without_a_display_is_refused(monkeypatch):
    monkeypatch.setenv(process.CHOICE, process.X11)
    monkeypatch.delenv("DISPLAY", raising=False)
    with pytest.raises(RenderError, match=r"vtkXOpenGLRenderWindow: DISPLAY is not set.*apt install libx11-6 libgl1"):
        process.window_environment()


def test_a_window_that_vtk_does_not_have_is_refused(monkeypatch):
    """The real probe, with a name that VTK answers by another window."""
    monkeypatch.setenv(process.CHOICE, "vtkNoSuchRenderWindow")
    with pytest.raises(RenderError, match="vtkNoSuchRenderWindow: "):
        process.window_environment()


def test_missing_libraries_and_their_packages_are_named(monkeypatch):
    monkeypatch.delenv(process.CHOICE, raising=False)
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.setattr(process.sys, "platform", "linux")
    answers(monkeypatch, "import sys; print('missing', sys.argv[2], flush=True)\nimport os; os.abort()")
    with pytest.raises(RenderError) as refused:
        process.window_environment()
    text = str(refused.value)
    assert "vtkEGLRenderWindow: libEGL.so.1 missing" in text
    assert "vtkOSOpenGLRenderWindow: libOSMesa.so.8 missing" in text
    assert "apt install libegl1 libgl1 libgl1-mesa-dri; or, where there is no EGL: apt install libosmesa6" in text


@pytest.mark.parametrize(
    ("code", "fault"),
    [
        ("import os; os.abort()", "crashes, signal 6"),
        ("print('black')", "does not open or stays black"),
        ("import time; time.sleep(60)", r"did not draw within 0\.5 s"),
    ],
)
def test_a_driver_that_does_not_work_is_no_crash(monkeypatch, code, fault):
    monkeypatch.setenv(process.CHOICE, process.EGL)
    monkeypatch.setattr(process, "PROBE_TIMEOUT_S", 0.5 if "sleep" in code else 60.0)
    answers(monkeypatch, code)
    with pytest.raises(RenderError, match=f"vtkEGLRenderWindow: {fault}"):
        process.window_environment()


def test_the_first_window_that_draws_is_taken_and_remembered(monkeypatch, tmp_path):
    monkeypatch.delenv(process.CHOICE, raising=False)
    monkeypatch.setattr(process.sys, "platform", "linux")
    log = tmp_path / "log"
    answers(
        monkeypatch,
        f"import sys; open({str(log)!r}, 'a').write(sys.argv[1] + '\\n')\n"
        "print('drawn' if sys.argv[1] == 'vtkOSOpenGLRenderWindow' else 'black')",
    )
    for _ in range(2):
        assert process.window_environment()[process.CHOICE] == process.OSMESA
    assert log.read_text().split() == [process.EGL, process.OSMESA]


def test_without_pyvista_the_pip_command_is_named(monkeypatch):
    monkeypatch.setattr(process, "find_spec", lambda name: None)
    with pytest.raises(MissingExtraError, match=r'pyvista is not installed; .*: pip install "\.\[render\]"'):
        process.drawn(SCENE)


@pytest.mark.parametrize(
    ("code", "message"),
    [
        ("import os; os.abort()", "the process that drew the picture failed: killed by signal 6"),
        ("raise MemoryError('4 GiB')", "failed: MemoryError: 4 GiB"),
        ("import time; time.sleep(60)", r"not drawn within 0\.5 s"),
    ],
)
def test_a_crash_while_drawing_is_an_error(monkeypatch, code, message):
    monkeypatch.setattr(process, "find_spec", lambda name: object())
    monkeypatch.setattr(process, "window_environment", dict)
    monkeypatch.setattr(process, "_CHILD", code)
    with pytest.raises(RenderError, match=message):
        process.drawn(SCENE, timeout_s=0.5 if "sleep" in code else 60.0)


def test_preparing_a_picture_loads_neither_pyvista_nor_vtk():
    code = (
        "import sys, wsrender, wsrender.results.render\n"
        "wsrender.results.render.picture, wsrender.results.render.VIEWS, wsrender.results.render.Box\n"
        "sys.exit(any(name.split('.')[0] in ('pyvista', 'vtk', 'vtkmodules') for name in sys.modules))"
    )
    subprocess.run([sys.executable, "-c", code], check=True, env={"PYTHONPATH": ":".join(sys.path), "PATH": ""})
