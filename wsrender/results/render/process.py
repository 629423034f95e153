"""Draws scenes in a process of its own, so that a crash of VTK or of a driver is an error and no more.

Which of VTK's windows can draw here is found out in a child process too: a missing GL library crashes VTK.
"""

import os
import pickle
import subprocess
import sys
import tempfile
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from wsrender.errors import MissingExtraError, RenderError
from wsrender.results.render.scene import DrawnScene

CHOICE = "VTK_DEFAULT_OPENGL_WINDOW"  # VTK's own variable; set by the user, nothing else is tried
EGL, OSMESA, X11 = "vtkEGLRenderWindow", "vtkOSOpenGLRenderWindow", "vtkXOpenGLRenderWindow"
PROBE_TIMEOUT_S = 60.0
# Debian and Ubuntu packages of each window, with the library that shows whether one is there.
PACKAGES = {
    EGL: {"libegl1": "libEGL.so.1", "libgl1": "libGL.so.1", "libgl1-mesa-dri": None},
    OSMESA: {"libosmesa6": "libOSMesa.so.8"},
    X11: {"libx11-6": "libX11.so.6", "libgl1": "libGL.so.1", "libgl1-mesa-dri": None},
}

# Says what libraries are missing, then draws a white square and says what it sees.
_PROBE = """
import ctypes, sys
for library in sys.argv[2:]:
    try:
        ctypes.CDLL(library)
    except OSError:
        print("missing", library, flush=True)
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
import vtkmodules.vtkRenderingOpenGL2
from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow
window = vtkRenderWindow()
if sys.argv[1] not in ("", window.GetClassName()):
    sys.exit(1)
window.SetOffScreenRendering(1)
renderer = vtkRenderer()
renderer.SetBackground(1, 1, 1)
window.AddRenderer(renderer)
window.SetSize(8, 8)
window.Render()
seen = vtkUnsignedCharArray()
window.GetPixelData(0, 0, 7, 7, 1, seen, 0)
print("drawn" if seen.GetNumberOfValues() and seen.GetValue(0) == 255 else "black", flush=True)
"""
TIMEOUT_S = 300.0
# The child finds modules where this process does; it runs nothing of the user's own program.
_CHILD = """
import pickle, sys
sys.path[:] = pickle.load(sys.stdin.buffer)
from wsrender.results.render.painter import main
main()
"""


def window_environment() -> dict[str, str]:
    """Environment variables of a process that is to draw; the same as here but for the window that VTK opens.

    Prefers EGL to OSMesa to an X server. The variable VTK_DEFAULT_OPENGL_WINDOW, where set, is the only choice.
    Raises RenderError, naming what is missing.
    """
    asked = os.environ.get(CHOICE)
    choices = (asked,) if asked else _choices(sys.platform)
    return {**os.environ, CHOICE: _first_working(choices, os.environ.get("DISPLAY", ""))}


def _choices(platform: str) -> tuple[str, ...]:
    return (EGL, OSMESA, X11) if platform.startswith("linux") else ("",)


@cache
def _first_working(windows: tuple[str, ...], display: str) -> str:
    faults = {}
    for window in windows:
        faults[window] = _fault(window, display)
        if not faults[window]:
            return window
    raise RenderError(_refusal(faults))


def _fault(window: str, display: str) -> str:
    """What keeps a window from drawing; empty if it draws."""
    if window == X11 and not display:
        return "DISPLAY is not set"
    libraries = [library for library in PACKAGES.get(window, {}).values() if library]
    try:
        probe = subprocess.run(
            [sys.executable, "-c", _PROBE, window, *libraries],
            env={**os.environ, CHOICE: window},
            capture_output=True,
            text=True,
            timeout=PROBE_TIMEOUT_S,
        )
    except subprocess.TimeoutExpired:
        return f"did not draw within {PROBE_TIMEOUT_S:g} s"
    said = probe.stdout.split("\n")
    if "drawn" in said:
        return ""
    missing = [line.removeprefix("missing ") for line in said if line.startswith("missing ")]
    if missing:
        return f"{' and '.join(missing)} missing"
    return f"crashes, signal {-probe.returncode}" if probe.returncode < 0 else "does not open or stays black"


def _refusal(faults: dict[str, str]) -> str:
    tried = "; ".join(f"{window or 'the default window'}: {fault}" for window, fault in faults.items())
    text = f"3-D pictures need OpenGL, and VTK cannot draw here ({tried})"
    packages = list(PACKAGES.get(next(iter(faults)), {}))
    if not packages:
        return text
    other = "" if OSMESA in faults and len(faults) == 1 else "; or, where there is no EGL: apt install libosmesa6"
    return f"{text}; on Debian and Ubuntu: apt install {' '.join(packages)}{other}"


def drawn(scene: DrawnScene, timeout_s: float = TIMEOUT_S) -> np.ndarray:
    """The picture of a scene, uint8 (height, width, 3).

    Raises MissingExtraError without PyVista; RenderError where VTK cannot draw, crashes or is too slow.
    """
    if find_spec("pyvista") is None:
        raise MissingExtraError("pyvista", "render")
    environment = window_environment()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "picture.npy"
        task = pickle.dumps(sys.path) + pickle.dumps((scene, str(path)))
        try:
            child = subprocess.run(
                [sys.executable, "-c", _CHILD], input=task, env=environment, capture_output=True, timeout=timeout_s
            )
        except subprocess.TimeoutExpired:
            raise RenderError(f"the picture was not drawn within {timeout_s:g} s") from None
        if child.returncode != 0:
            raise RenderError(f"the process that drew the picture failed: {_reason(child)}")
        return np.load(path, allow_pickle=False)


def _reason(child: subprocess.CompletedProcess[bytes]) -> str:
    if child.returncode < 0:
        return f"killed by signal {-child.returncode}"
    lines = child.stderr.decode(errors="replace").strip().splitlines()
    return lines[-1] if lines else f"exit code {child.returncode}"
