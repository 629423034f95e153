"""A figure that shows itself: in notebooks by itself, from scripts in the system's viewer of pictures."""

import os
import shutil
import subprocess
import sys
import tempfile
import threading
import warnings
from pathlib import Path

from matplotlib.figure import Figure

from wsrender.notebook import display, in_notebook
from wsrender.results.drawing.paper import png


class ShownFigure(Figure):
    """A matplotlib figure without pyplot.

    Jupyter shows it where it is the last value of a cell. ``show`` opens it from anywhere.
    """

    def _repr_png_(self) -> bytes:
        return png(self)

    def show(self, warn: bool = True) -> None:
        """Show the figure: below the cell of a notebook, else in the system's viewer of pictures.

        Without a viewer or a display a UserWarning says so, unless ``warn`` is false; ``savefig`` writes a file.
        """
        if in_notebook():
            display(self)
            return
        viewer = system_viewer()
        if viewer is None:
            if warn:
                text = 'there is no display or viewer to show the picture; write it: figure.savefig("picture.png")'
                warnings.warn(text, UserWarning, stacklevel=2)
            return
        path = Path(tempfile.mkdtemp(prefix="wsrender-")) / "picture.png"  # stays: the viewer may open it late
        path.write_bytes(self._repr_png_())
        nowhere = subprocess.DEVNULL
        opened = subprocess.Popen([viewer, path], start_new_session=True, stdout=nowhere, stderr=nowhere)
        threading.Thread(target=opened.wait, daemon=True).start()


def system_viewer() -> str | None:
    """The command that opens a file in the system's viewer; None where there is none, or no display."""
    if sys.platform == "darwin":
        return shutil.which("open")
    has_display = os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    return shutil.which("xdg-open") if has_display else None
