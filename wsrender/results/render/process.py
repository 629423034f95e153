"""Draws scenes in a process of its own, so that a crash of VTK or of a driver is an error and no more."""

import pickle
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from wsrender.errors import MissingExtraError, RenderError
from wsrender.results.render.scene import Scene
from wsrender.results.render.windows import window_environment

TIMEOUT_S = 300.0
# The child finds modules where this process does; it runs nothing of the user's own program.
_CHILD = """
import pickle, sys
sys.path[:] = pickle.load(sys.stdin.buffer)
from wsrender.results.render.painter import main
main()
"""


def drawn(scene: Scene, timeout_s: float = TIMEOUT_S) -> np.ndarray:
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
