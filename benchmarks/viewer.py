"""How fast the viewer is. The machine should be idle.

python benchmarks/viewer.py frames [--frames 12] [--size 1280x720]
python benchmarks/viewer.py engine
python benchmarks/viewer.py served [--drags 40] [--size 1280x720]
python benchmarks/viewer.py use [--minutes 10]

``frames``: frame times of the page in a browser: 100³ and 200³ voxels in every style, a million points. ``engine``:
from a question about a volume to its message, as limits are dragged: planned, swept and packed. ``served``: the page of
a real server: from its address to the picture of a UR5e's volume, bytes, from a joint limit's slider to the picture of
the volume that follows it. ``use``: memory of page and browser while it is used. All but ``engine`` need Playwright for
Python and a Chromium, which without a graphics card draws in software.
"""

import argparse
import json
import random
import shutil
import statistics
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import psutil
from wsrender_server.local_server import LocalServer

import wsrender as ws
from tests.viewer.served import serving
from tests.viewer.watched import HELD
from tests.viewer.written import Written, manifest
from wsrender.results.view.container import message
from wsrender.results.view.interactive import Interactive

SAMPLES, RUNS = 10**6, 60
CASES = {"54³": 0.04, "107³": 0.02}


STYLES = ("surface", "translucent", "isosurface", "cells", "points")
OPEN = """async ({manifest, folder, style}) => {
  const page = await import("/viewer/viewer.js"), from = performance.now();
  window.stage?.dispose();
  const stage = window.stage = new page.Stage(document.getElementById("here"));
  const first = new Promise(done => { let fine; stage.on("drawn", what => {
    if (what === "fine" && stage.ready) { fine = performance.now() - from; done(fine); } }); });
  await stage.load(manifest, async name => (await fetch(`/${folder}/${name}`)).arrayBuffer());
  const settings = window.settings = page.defaultSettings(manifest);
  for (const volume of Object.values(settings.volumes)) volume.style = style;
  stage.apply(settings);
  stage.ready = true;
  return first;
}"""
TURN = """async frames => {
  const gl = stage.canvas.getContext("webgl2"), pixel = new Uint8Array(4), times = [];
  for (let k = 0; k < frames; k++) {
    const camera = stage.camera, [x, y, z] = camera.position, [a, b] = camera.target;
    const c = Math.cos(.05), s = Math.sin(.05);
    camera.position = [a + c * (x - a) - s * (y - b), b + s * (x - a) + c * (y - b), z];
    const from = performance.now();
    const drawn = new Promise(done => { const off = stage.on("drawn", () => { off(); done(); }); });
    stage.apply({...settings, camera});
    await drawn;
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    times.push(performance.now() - from);
  }
  const {scale: share, stride} = stage.info, from = performance.now();
  await new Promise(done => { const off = stage.on("drawn", what => { if (what === "fine") { off(); done(); } }); });
  const fine = performance.now() - from, before = stage.info.frames;
  while (!stage.info.idle) await new Promise(done => setTimeout(done, 20));
  const finished = performance.now() - from, still = stage.info.frames;
  await new Promise(done => setTimeout(done, 500));
  return {times, share, stride, fine, finished, drawn_at_rest: stage.info.frames - still, before};
}"""


JOB = {
    "analysis": "workspace",
    "robot": {"library": "ur5e"},
    "sampling": {"method": "sobol", "count": 1 << 20},
    "indices": ["manipulability"],
    "best_sample": "manipulability",
    "voxel_size_m": 0.02,
    "refined_volume": None,
    "device": "cpu",
}
# Before the page's own script: times [ms] of what it says in attributes.
WATCH = """
window.seen = [];
const attach = Element.prototype.attachShadow;
Element.prototype.attachShadow = function (options) {
  const root = attach.call(this, options);
  new MutationObserver(all => { for (const {target, attributeName: name} of all) {
    const value = target.getAttribute(name);
    if (value === "coarse") { // wait for the picture, not for its orders
      const gl = target.querySelector("canvas").getContext("webgl2");
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    }
    seen.push({at: performance.now(), name, value});
  } }).observe(root, {subtree: true, attributes: true, attributeFilter: ["data-drawn", "data-live", "data-volume"]});
  return root;
};
"""
LOADED = """() => {
  const blobs = performance.getEntriesByType("resource").filter(each => each.name.includes("/blobs/volume"));
  const first = Math.min(...blobs.filter(each => each.name.includes("channel")).map(each => each.responseEnd));
  const last = Math.max(...blobs.map(each => each.responseEnd));
  const drawn = (value, after) => seen.find(each => each.value === value && each.at > after)?.at;
  return {first: drawn("coarse", first), fine: drawn("fine", last), finished: drawn("finished", last)};
}"""
# A slider is put to a value: ms until the volume that follows is drawn; `done`: and let go, until it is drawn finely.
DRAG = """async ({label, value, done}) => {
  const root = document.querySelector("#wsrender").shadowRoot;
  const slider = root.querySelector(`input[aria-label="${label}"]`);
  const from = performance.now(), end = from + 30000;
  slider.value = value;
  slider.dispatchEvent(new Event("input", {bubbles: true}));
  if (done) slider.dispatchEvent(new Event("change", {bubbles: true}));
  const after = (name, value, at) => seen.find(each => each.name === name && each.value === value && each.at > at)?.at;
  while (performance.now() < end) {
    const known = after("data-live", "done", from);
    const drawn = known && after("data-drawn", done ? "fine" : "coarse", known);
    if (drawn) return {computed: known - from, drawn: drawn - from};
    await new Promise(soon => setTimeout(soon, 1));
  }
  throw new Error("no picture followed the slider");
}"""


def ball(n: int) -> np.ndarray:
    """Values of n³ voxels, NaN outside a ball with a hollow."""
    x = (np.arange(n) + 0.5) / n * 2 - 1
    r = np.sqrt(x[:, None, None] ** 2 + x[None, :, None] ** 2 + x[None, None, :] ** 2)
    return np.where((r < 0.95) & (r > 0.2), 1.0 - r + 0.1 * np.sin(20 * x)[:, None, None], np.nan)


def scenes() -> dict[str, tuple[dict[str, Any], dict[str, bytes]]]:
    """Manifests and blobs by name."""
    found = {}
    for n in (100, 200):
        written = Written()
        found[f"{n}³"] = manifest(volumes=[written.volume("ball", ball(n), (-n // 2,) * 3, 2.0 / n)]), written.blobs
    written, count = Written(), 1_000_000
    p = np.random.default_rng(1).normal(size=(count, 3))
    p /= np.linalg.norm(p, axis=1, keepdims=True)
    steps = np.rint((p + 1) / 2 * 65535).ravel()
    points = {"name": "samples", "label": "samples", "count": count, "lower": [-1.0] * 3, "upper": [1.0] * 3,
              "positions": written.numbers(steps, "uint16"),
              "channels": [written.channel("z", p[:, 2] + 1)]}  # fmt: skip
    found["1e6 points"] = manifest(points=[points]), written.blobs
    return found


def engine() -> None:
    """Seconds of volumes of a UR5e while the upper limit of a joint moves."""
    robot = ws.load_robot("ur5e")
    interactive = Interactive({}, [robot])
    print(f"{robot.name}, {SAMPLES:,} samples, maximum of manipulability")
    for name, voxel_size_m in CASES.items():
        took = []
        for k in range(RUNS + 5):
            started = time.perf_counter()
            question = {"ask": "volume", "robot": 0, "index": "manipulability", "samples": SAMPLES}
            question |= {"voxel_size_m": voxel_size_m, "limits": {"joint2": [-2.0, 0.05 * k - 1.5]}}
            header, blobs = interactive.answer(question)
            size = len(message({"id": k, "answer": header}, blobs))
            took.append(time.perf_counter() - started)
        ms, shape = 1e3 * np.array(took[5:]), " x ".join(map(str, header["volume"]["shape"]))
        print(f"  {name} ({shape} voxels): median {np.median(ms):.0f} ms, least {ms.min():.0f} ms, {size / 1e3:.0f} kB")


def frames(arguments: argparse.Namespace) -> None:
    """Frame times in a browser."""
    from playwright.sync_api import sync_playwright

    width, height = map(int, arguments.size.split("x"))
    print("| ms, median (min … max) | first fine | frame, turning | share, step | fine | finished | drawn at rest |")
    print("|---|--:|--:|--:|--:|--:|--:|")
    print("| goal | | 100 (10 frames/s) | | | | 0 |")
    with serving() as (address, blobs), sync_playwright() as running:
        browser = running.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": width, "height": height})
        page.goto(address)
        for name, (shown, data) in scenes().items():
            folder = f"scene{len(blobs)}"
            blobs |= {f"/{folder}/{key}": value for key, value in data.items()}
            for style in STYLES if shown["volumes"] else ("points",):
                first = page.evaluate(OPEN, {"manifest": shown, "folder": folder, "style": style})
                page.evaluate(TURN, arguments.frames)  # the share of the resolution settles
                found = page.evaluate(TURN, arguments.frames)
                times = found["times"]
                spread = f"{statistics.median(times):.0f} ({min(times):.0f} … {max(times):.0f})"
                ends = f"{found['fine']:.0f} | {found['finished']:.0f} | {found['drawn_at_rest']}"
                share = f"{found['share']:.2f}, {found['stride']:.1f}"
                print(f"| {name}, {style} | {first:.0f} | {spread} | {share} | {ends} |", flush=True)
        browser.close()


@contextmanager
def viewed(size: str) -> Iterator[tuple[str, Any]]:
    """The address of a job's view on a server, and what makes a page that is watched."""
    from playwright.sync_api import sync_playwright

    width, height = map(int, size.split("x"))
    with tempfile.TemporaryDirectory() as data, LocalServer(Path(data)) as server, sync_playwright() as running:
        with ws.Client(server.url) as client:
            job = client.submit(JOB).wait()
        browser = running.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])

        def page() -> Any:
            made = browser.new_context(viewport={"width": width, "height": height}).new_page()
            made.set_default_timeout(120_000)
            made.add_init_script(WATCH + HELD)
            return made

        yield f"{server.url}/#/job/{job.id}", page
        browser.close()


def finished(page: Any) -> None:
    """Wait until nothing more is drawn."""
    page.wait_for_timeout(200)
    page.locator(".stage-host[data-drawn=finished]").first.wait_for()


def served(arguments: argparse.Namespace) -> None:
    """Load times, bytes, and times from a slider to the picture."""
    with viewed(arguments.size) as (address, new_page):
        print(f"UR5e, {JOB['sampling']['count']:,} samples, voxels of {JOB['voxel_size_m']} m, {arguments.size}")
        for which in ("first view of the server's life", "again, nothing in the browser's cache"):
            page = new_page()
            sent, asked = [], page.context.new_cdp_session(page)
            asked.send("Network.enable")
            asked.on("Network.loadingFinished", lambda each, sent=sent: sent.append(each["encodedDataLength"]))
            page.goto(address)
            page.get_by_role("button", name="Show all").wait_for()
            finished(page)
            ms = page.evaluate(LOADED)
            print(f"{which}: first picture {ms['first']:.0f} ms, fine {ms['fine']:.0f}, finished {ms['finished']:.0f}; "
                  f"{sum(sent) / 1e3:,.0f} kB in {len(sent)} answers")  # fmt: skip
            if "first" in which:
                page.context.close()
        received: list[int] = []
        page.on("websocket", lambda socket: socket.on("framereceived", lambda frame: received.append(len(frame))))
        page.get_by_text("Change limits").click()
        label = "Upper limit of joint2 [°]"
        page.evaluate(DRAG, {"label": label, "value": 0, "done": True})  # its session begins
        finished(page)
        for name, done, goal in (("while dragged", False, 120), ("let go, fine", True, 1500)):
            received.clear()
            count = max(1, arguments.drags // (4 if done else 1))
            found = []
            for k in range(count):
                found.append(page.evaluate(DRAG, {"label": label, "value": -5 - 80 * k / count, "done": done}))
                if done:
                    finished(page)
            for what in ("computed", "drawn"):
                ms = [each[what] for each in found]
                spread = f"{statistics.median(ms):.0f} ms ({min(ms):.0f} … {max(ms):.0f})"
                told = f"; goal: a median of {goal} ms" if what == "drawn" else ""
                print(f"slider, {name}: {what} after a median of {spread}{told}")
            print(f"  {np.median([each for each in received if each > 10_000]) / 1e3:,.0f} kB a volume")
            finished(page)


def resident(kind: str) -> float:
    """Memory [MB] of the processes of a kind of the browser."""
    own = psutil.Process().children(recursive=True)
    return sum(each.memory_info().rss for each in own if f"--type={kind}" in each.cmdline()) / 1e6


def gestures(page: Any, draw: random.Random) -> None:
    """Some of what a person does."""
    box = page.locator(".stage-host").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    for _ in range(6):
        page.mouse.move(x + draw.uniform(-200, 200), y + draw.uniform(-100, 100))
    page.mouse.up()
    page.get_by_label("Style").select_option(draw.choice(STYLES))
    page.get_by_label("Colour map").select_option(draw.choice(["viridis", "magma", "cividis"]))
    for _ in range(5):
        page.evaluate(DRAG, {"label": "Upper limit of joint2 [°]", "value": draw.uniform(-90, -1), "done": False})
    finished(page)
    page.mouse.click(x + 0.1 * box["width"], y)
    page.get_by_role("button", name="Other postures").click()
    page.get_by_text("1 of ", exact=False).first.wait_for()
    page.get_by_role("button", name="Back to the result").click()
    page.get_by_role("link", name="Jobs").click()
    page.locator("tr[data-job]").first.wait_for()
    page.get_by_role("button", name="View").first.click()
    page.get_by_role("button", name="Show all").wait_for()
    finished(page)
    page.get_by_text("Change limits").click()


# The browser's inspector, which drives the page, keeps copies of answers in the renderer up to a bound: fill it first,
# or its growth is taken for the page's.
FILL = """async () => {
  const sizes = performance.getEntriesByType("resource").map((each) => [each.encodedBodySize, each.name]);
  const [bytes, name] = sizes.reduce((a, b) => (a[0] > b[0] ? a : b));
  for (let sum = 0; sum < 400e6; sum += bytes) await (await fetch(name, {cache: "no-store"})).arrayBuffer();
}"""


def use(arguments: argparse.Namespace) -> None:
    """Memory while the page is used."""
    draw = random.Random(0)
    with viewed(arguments.size) as (address, new_page):
        page = new_page()
        page.goto(address)
        page.get_by_role("button", name="Show all").wait_for()
        finished(page)
        page.evaluate(FILL)
        page.get_by_text("Change limits").click()
        asked, began, rows, rounds = page.context.new_cdp_session(page), time.monotonic(), [], 0
        print("| minute | rounds | heap, MB | nodes | listeners | renderer, MB | graphics, MB | held by the graphics |")
        print("|--:|--:|--:|--:|--:|--:|--:|---|")
        while not rows or time.monotonic() - began < 60 * arguments.minutes:
            until = time.monotonic() + 60 * arguments.minutes / 10
            while time.monotonic() < until or not rounds:
                gestures(page, draw)
                rounds += 1
            page.evaluate("seen.length = 0; performance.clearResourceTimings()")
            for _ in range(3):
                asked.send("HeapProfiler.collectGarbage")
            heap = asked.send("Runtime.getHeapUsage")["usedSize"] / 1e6
            counted = asked.send("Memory.getDOMCounters")
            held = page.locator(".stage-host canvas").first.evaluate("each => each.getContext('webgl2').held")
            rows.append(heap)
            print(f"| {(time.monotonic() - began) / 60:.1f} | {rounds} | {heap:.1f} | {counted['nodes']} | "
                  f"{counted['jsEventListeners']} | {resident('renderer'):.0f} | "
                  f"{resident('gpu-process'):.0f} | {json.dumps(held)} |", flush=True)  # fmt: skip
        print(f"heap: {rows[0]:.1f} MB at first, {rows[-1]:.1f} MB at the end, {max(rows):.1f} MB at most; "
              "goal: no growth, of what is held neither")  # fmt: skip


PARTS = {"frames": frames, "engine": lambda _: engine(), "served": served, "use": use}


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])  # type: ignore[union-attr]
    parser.add_argument("part", choices=PARTS)
    parser.add_argument("--frames", type=int, default=12)
    parser.add_argument("--drags", type=int, default=40)
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--size", default="1280x720")
    arguments = parser.parse_args()
    PARTS[arguments.part](arguments)


if __name__ == "__main__":
    main()
