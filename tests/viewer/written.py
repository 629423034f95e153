"""Views that are written by hand, and where they are seen."""

import io
import json
import shutil

import numpy as np
import pytest
from matplotlib.image import imread

WIDTH, HEIGHT = 640, 480
HALF = np.tan(np.deg2rad(16.0))  # of the field of view
OFF = {"visible": False, "opacity": 1}


def launch(playwright, *more):
    """Chromium of the system; of playwright where there is none."""
    path = shutil.which("chromium") or shutil.which("chromium-browser")
    try:
        return playwright.chromium.launch(executable_path=path, args=["--no-sandbox", *more])
    except Exception as error:
        pytest.skip(f"no Chromium: {error}")


def decoded(png):
    return np.round(imread(io.BytesIO(png), format="png")[..., :3] * 255).astype(int)


class Written:
    """Blobs of a view that is written by hand."""

    def __init__(self):
        self.blobs = {}

    def numbers(self, values, kind):
        width = {"uint8": "u1", "uint16": "<u2", "float16": "<f2", "float32": "<f4"}[kind]
        name = f"blob{len(self.blobs)}"
        self.blobs[name] = np.asarray(values).astype(width).tobytes()
        return {"blob": name, "type": kind, "length": int(np.asarray(values).size), "compression": None}

    def channel(self, name, values, **more):
        """A channel of values (…), x fastest."""
        low, high = float(np.nanmin(values)), float(np.nanmax(values))
        data = self.numbers(values.ravel(order="F"), "float32")
        return {"name": name, "statistic": "maximum", "label": name, "unit": "m", "minimum": low, "maximum": high,
                "data": data} | more  # fmt: skip

    def volume(self, name, values, first, size, **more):
        """A volume of one channel, NaN where it is empty."""
        occupied = self.numbers(np.isfinite(values).ravel(order="F"), "uint8")
        return {"name": name, "label": name, "shape": list(values.shape), "first_voxel": list(first),
                "voxel_size_m": size, "occupancy": occupied, "channels": [self.channel("index", values, **more)],
                "exact": True}  # fmt: skip


# Records what is written onto the page's canvases: [canvas, text] of each.
WRITTEN = """() => {
  const write = CanvasRenderingContext2D.prototype.fillText;
  window.written = [];
  CanvasRenderingContext2D.prototype.fillText = function (text, ...at) {
    written.push([this.canvas, text]);
    write.call(this, text, ...at);
  };
}"""


def manifest(**parts):
    lists = "headline warnings robots skeletons volumes meshes points glyphs curves maps plots pictures omitted"
    empty = {name: [] for name in lists.split()}
    return json.loads(
        json.dumps({"format": 1, "title": "", "analysis": "", "job": None, "mapping": None} | empty | parts)
    )


def looking(target, half_m, along="y"):
    """An orthographic camera that sees ``half_m`` above and below its target, x to the right and z (or y) up."""
    away = np.array([0.0, -1.0, 0.0] if along == "y" else [0.0, 0.0, 1.0]) * half_m / HALF
    up = [0, 0, 1] if along == "y" else [0, 1, 0]
    position = (np.asarray(target) + away).tolist()
    return {"position": position, "target": list(map(float, target)), "up": up, "orthographic": True}


def pixels(points, target, half_m):
    """Columns and rows (N, 2) of points (N, 3) that a camera along y sees."""
    d = (np.asarray(points) - target) / half_m
    return np.stack([WIDTH / 2 + d[:, 0] * HEIGHT / 2, HEIGHT / 2 - d[:, 2] * HEIGHT / 2], axis=1)


def at(picture, places):
    """Colours (N, 3) of the pixels at places (N, 2)."""
    column, row = np.floor(places).astype(int).T
    return picture[row, column]
