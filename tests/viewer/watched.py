"""The served page while a test uses it, and what is read off it."""

import base64
import json
import time
import zlib
from collections.abc import Callable
from typing import Any

import numpy as np

from tests.viewer.written import decoded

PATIENCE_MS = 60_000.0  # machines are shared, and draw without a GPU
NOISE = "GPU stall due to ReadPixels"  # a hint of the driver


# Before the page's own script: how many objects the graphics of each canvas hold, in `held` of its context.
HELD = """
for (const what of ["Texture", "Buffer", "Framebuffer", "Renderbuffer", "Program"]) {
  const of = WebGL2RenderingContext.prototype, make = of["create" + what], free = of["delete" + what];
  const count = (gl, by) => { gl.held = {...gl.held, [what]: (gl.held?.[what] ?? 0) + by}; };
  of["create" + what] = function (...given) { count(this, 1); return make.apply(this, given); };
  of["delete" + what] = function (given) { if (given) count(this, -1); return free.call(this, given); };
}
"""

JOB = {
    "analysis": "workspace",
    "robot": {"library": "ur5e"},
    "sampling": {"method": "sobol", "count": 1 << 16},
    "indices": ["manipulability"],
    "voxel_size_m": 0.1,
    "refined_volume": None,
    "device": "cpu",
}


class Watched:
    """A page, and what it must not do: errors on the console, requests to another host."""

    def __init__(self, page: Any, url: str):
        self.page, self.url = page, url
        self.errors: list[str] = []
        self.foreign: list[str] = []
        self.refusals = 0  # answers 4xx that the test provokes; Chromium calls each an error
        page.on("console", lambda message: message.type == "error" and self._hear(message.text))
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        page.on("request", lambda request: self._see(request.url))

    def _hear(self, text: str) -> None:
        if "the server responded with a status of 4" in text:
            self.refusals += 1
        elif NOISE not in text:
            self.errors.append(text)

    def _see(self, url: str) -> None:
        if not url.startswith((self.url, "blob:", "data:")):
            self.foreign.append(url)


def until(holds: Callable[[], bool], patience_s: float = PATIENCE_MS / 1e3) -> None:
    """Asks again and again: the page's policy lets it evaluate no text."""
    end = time.monotonic() + patience_s
    while not holds():
        assert time.monotonic() < end, "never so"
        time.sleep(0.03)


def opened(watched: Watched, place: str, **settings: Any) -> None:
    """The page at a place, once the view is there; with settings as a link gives them."""
    deflate = zlib.compressobj(wbits=-15)
    packed = base64.urlsafe_b64encode(deflate.compress(json.dumps(settings).encode()) + deflate.flush())
    view = f"?view={packed.decode().rstrip('=')}" if settings else ""
    watched.page.goto(f"{watched.url}/#{place}{view}")
    watched.page.get_by_role("button", name="Show all").first.wait_for()
    settle(watched)


def settle(watched: Watched) -> None:
    """Wait until views are there and nothing more is drawn."""
    page, finished = watched.page, ".stage-host[data-drawn=finished]"
    page.wait_for_timeout(150)  # what was changed begins to be drawn
    for number in range(page.locator(".stage-host").count()):
        page.locator(".stage-host").nth(number).locator("xpath=.").and_(page.locator(finished)).wait_for()


def link_holds_the_view(page: Any) -> None:
    """Wait until the page has written its view into its address, by its own clock, however busy it is."""
    page.evaluate("new Promise((done) => setTimeout(done, 800))")


def relink(watched: Watched) -> None:
    """Leave the page, and follow its own address, once that holds the view."""
    link_holds_the_view(watched.page)
    link = watched.page.url
    assert "view=" in link
    watched.page.goto("about:blank")
    watched.page.goto(link)
    watched.page.get_by_role("button", name="Show all").first.wait_for()
    settle(watched)


def pixels(watched: Watched) -> np.ndarray:
    """What is seen of the first view, uint8 (height, width, 3)."""
    settle(watched)
    return decoded(watched.page.locator(".stage-host").first.screenshot())


def spots(watched: Watched, points: Any, target: Any, half_m: float, along: str = "y") -> np.ndarray:
    """Columns and rows (N, 2) on the page of points (N, 3) that the camera `written.looking` sees."""
    box = watched.page.locator(".stage-host").first.bounding_box()
    d = (np.atleast_2d(points) - target) / half_m * box["height"] / 2
    up = d[:, 2 if along == "y" else 1]
    return np.stack([box["x"] + box["width"] / 2 + d[:, 0], box["y"] + box["height"] / 2 - up], axis=1)


def differing(a: np.ndarray, b: np.ndarray) -> int:
    return int((a != b).any(axis=2).sum())


def tip(watched: Watched) -> np.ndarray:
    """Where the page says that the tip of the robot is (3,) [m]."""
    return np.array(watched.page.locator("[data-tip]").get_attribute("data-tip").split(), float)


def clicked(watched: Watched) -> tuple[list[int], dict[str, float]]:
    """Cell and values of a voxel beside the robot, which stands in the middle of the view."""
    box = watched.page.locator(".stage-host").first.bounding_box()
    watched.page.mouse.click(box["x"] + 0.62 * box["width"], box["y"] + 0.53 * box["height"])
    watched.page.locator("[data-voxel] [data-exact]").first.wait_for()
    cell, values = watched.page.locator("[data-voxel]").evaluate(
        """shown => [shown.dataset.voxel,
          [...shown.querySelectorAll("[data-exact]")].map(each => [each.dataset.value, each.dataset.exact])]"""
    )
    return [int(each) for each in cell.split()], {name: float(value) for name, value in values}
