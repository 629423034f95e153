"""The pictures of the guide to the viewer: each in both themes, by a Chromium, of a server that is started for them.

python docs/guides/viewer.py [folder [name …]]

Needs `pip install ".[server]" playwright pillow` and a Chromium.
"""

import base64
import io
import json
import shutil
import sys
import tempfile
import zlib
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import wsrender as ws

PICTURES = Path(__file__).with_suffix("")
THEMES = ("light", "dark")
SIZE: Any = {"width": 1280, "height": 720}
COLORS = 200  # of a picture; fewer where it is larger than MOST_BYTES
MOST_BYTES = 150_000
PATIENCE_MS = 30_000


def workspace(robot: Any, **more: Any) -> dict[str, Any]:
    """A job."""
    sampling = {"method": "sobol", "count": 1 << 19, "seed": 0}
    return {"analysis": "workspace", "robot": robot, "sampling": sampling, "indices": ["manipulability"],
            "voxel_size_m": 0.05, "refined_volume": None} | more  # fmt: skip


PUMA = {"library": "puma560", "placement": {"position_m": [0.9, 0.4, 0.0], "rpy_deg": [0, 0, 180]}}
SAMPLED = {"method": "sobol", "count": 1 << 17, "seed": 0}
HOLES = [[0.5 + 0.06 * row, y, 0.12] for row in range(5) for y in (-0.03, 0.03)]
JOBS: dict[str, dict[str, Any]] = {
    "arm": workspace({"library": "ur5e"}, best_sample="manipulability"),
    "cell": workspace(
        {"library": "ur5e"},
        sampling={"method": "sobol", "count": 1 << 22, "seed": 0},
        voxel_size_m=0.03,
        environment={"items": [
            {"shape": "box", "name": "table", "size_m": [1.6, 1.2, 0.05], "position_m": [0.35, 0, -0.03]},
            {"shape": "box", "name": "shelf", "size_m": [0.3, 0.8, 0.02], "position_m": [0.65, 0, 0.45]},
        ]},
        constraints={"self_collision": True, "environment": {"margin_m": 0.001}},
    ),
    "narrower": workspace({"library": "ur5e", "limits": {"joint2": [-2.2, -0.6]}}),
    "two": {
        "analysis": "shared_workspace",
        "robots": [{"robot": {"library": "ur5e"}, "sampling": SAMPLED}, {"robot": PUMA, "sampling": SAMPLED}],
        "voxel_size_m": 0.06,
        "refined_volume": None,
    },
    "placement": {
        "analysis": "base_placement",
        "robot": {"library": "ur5e"},
        "points_m": HOLES,
        "quats_wxyz": [[0, 1, 0, 0]] * len(HOLES),
        "over": {"x_m": [-0.5, 1.4, 0.05], "y_m": [-0.9, 0.9, 0.05], "yaw_deg": [0, 360, 90]},
        "index": "minimum_singular_value",
    },
    "parallel": {"analysis": "parallel_workspace", "mechanism": "six_pus", "voxel_size_m": 0.08,
                 "indices": ["manipulability"], "refined_volume": None},
}  # fmt: skip


def look(**volume: Any) -> dict[str, Any]:
    """Settings of a link: how the volume is shown."""
    whole = {"visible": True, "opacity": 1, "style": "surface", "channel": "maximum:manipulability",
             "threshold": None, "cut": [], "minus": ""}  # fmt: skip
    return {"volumes": {"volume": whole | volume}}


def sliced(axis: str, at_m: float) -> dict[str, Any]:
    """A plane across an axis."""
    return {"axis": axis, "at_m": at_m, "normal": [0, 0, 1], "visible": True}


def click_a_voxel(page: Any) -> None:
    """The robot moves to the best sample of a voxel of the cut."""
    box = page.locator(".stage-host").bounding_box()
    page.mouse.click(box["x"] + 0.59 * box["width"], box["y"] + 0.5 * box["height"])
    page.locator("[data-voxel] [data-exact]").first.wait_for()


def see_limits(page: Any) -> None:
    """The volume that the server has computed for the limits of the link."""
    page.locator("[data-live=done]").first.wait_for()


def close_panels(page: Any) -> None:
    """The picture alone."""
    for name in ("Look", "Explore"):
        page.get_by_role("button", name=name, exact=True).click()


def choose_an_arm(page: Any) -> None:
    """In the form, whose preview shows it."""
    page.locator("select").filter(has_text="franka_panda").first.select_option("ur5e")
    page.locator(".stage-host[data-drawn], .preview-host canvas").first.wait_for()
    page.wait_for_timeout(2000)  # the preview is drawn
    page.get_by_text("Checking …").wait_for(state="detached")


@dataclass(frozen=True)
class Shown:
    """A picture: the page of which jobs, in a look, after which gestures."""

    name: str
    place: str
    look: dict[str, Any] | None = None
    gesture: Callable[[Any], None] | None = None
    alone: bool = False  # without what stands around the stage


SHOWN = (
    Shown("cell", "/job/{cell}", {
        **look(cut=[{"axis": "y", "from_m": 0.21, "to_m": None}]),
        "camera": {"position": [0.9, -2.9, 1.3], "target": [0.15, 0, 0.38], "up": [0, 0, 1], "orthographic": False},
        "configurations": [[2.3, -1.1, 1.7, -2.17, -1.5708, 0.0]],
        "layers": {name: {"visible": False, "opacity": 1} for name in ("axes", "surface", "samples", "frames")},
    }, close_panels, alone=True),
    Shown("workspace", "/job/{arm}"),
    Shown("isosurface", "/job/{arm}", look(style="isosurface", threshold=0.12)),
    Shown("slices", "/job/{arm}", {
        **look(visible=False),
        "slices": [sliced("y", 0.0), sliced("z", 0.1)],
        "colors": "cividis",
    }),
    Shown("voxel", "/job/{arm}", None, click_a_voxel),
    Shown("limits", "/job/{arm}", {"limits": [{"joint2": [-2.2, -0.6]}]}, see_limits),
    Shown("placement", "/job/{placement}"),
    Shown("two_arms", "/job/{two}"),
    Shown("parallel", "/job/{parallel}", look(style="translucent")),
    Shown("compare", "/compare/{arm}/{narrower}"),
    Shown("form", "/new", None, choose_an_arm),
)  # fmt: skip


def packed(settings: dict[str, Any]) -> str:
    """Settings as a link holds them: JSON, deflated, base64url."""
    squeezed = zlib.compressobj(9, zlib.DEFLATED, -15)
    data = squeezed.compress(json.dumps(settings).encode()) + squeezed.flush()
    return base64.urlsafe_b64encode(data).rstrip(b"=").decode()


def settle(page: Any) -> None:
    """Until nothing more is drawn."""
    for _ in range(2):
        page.wait_for_timeout(700)
        for host in page.locator(".viewer .stage-host").all():
            host.and_(page.locator("[data-drawn=finished]")).wait_for()


@contextmanager
def served(names: Sequence[str]) -> Iterator[tuple[str, dict[str, str]]]:
    """A server's address, and the ids there of the jobs of pictures by their names in ``JOBS``."""
    from wsrender_server.local_server import LocalServer

    places = "".join(each.place for each in SHOWN if each.name in names)
    with tempfile.TemporaryDirectory() as folder, LocalServer(Path(folder)) as server, ws.Client(server.url) as client:
        submitted = {name: client.submit(job) for name, job in JOBS.items() if f"{{{name}}}" in places}
        yield server.url, {name: job.wait().id for name, job in submitted.items()}


def quantised(png: bytes) -> bytes:
    """The picture in few colours, as few as it takes to be small."""
    from PIL import Image

    image, colors = Image.open(io.BytesIO(png)).convert("RGB"), COLORS
    while True:
        written = io.BytesIO()
        image.quantize(colors, dither=Image.Dither.NONE).save(written, "png", optimize=True)
        if written.tell() <= MOST_BYTES:
            return written.getvalue()
        colors //= 2


def draw(folder: Path, names: Sequence[str] = tuple(each.name for each in SHOWN)) -> None:
    """Write ``folder``/<name>_<theme>.png for each name."""
    from playwright.sync_api import sync_playwright

    folder.mkdir(parents=True, exist_ok=True)
    with sync_playwright() as running, served(names) as (url, ids):
        path = shutil.which("chromium") or shutil.which("chromium-browser")
        browser = running.chromium.launch(executable_path=path, args=["--no-sandbox"])
        for theme in THEMES:
            for each in (each for each in SHOWN if each.name in names):
                page = browser.new_page(viewport=SIZE, color_scheme=theme)
                page.set_default_timeout(PATIENCE_MS)
                view = "" if each.look is None else f"?view={packed(each.look)}"
                page.goto(f"{url}/#{each.place.format(**ids)}{view}")
                if each.place != "/new":
                    page.get_by_role("button", name="Show all").first.wait_for()
                    settle(page)
                if each.gesture is not None:
                    each.gesture(page)
                    settle(page)
                seen = page.locator(".stage").first if each.alone else page
                (folder / f"{each.name}_{theme}.png").write_bytes(quantised(seen.screenshot()))
                page.close()
        browser.close()


if __name__ == "__main__":
    draw(Path(sys.argv[1]) if len(sys.argv) > 1 else PICTURES, sys.argv[2:] or [each.name for each in SHOWN])
