"""A picture of the viewer as large as can be asked for, 8192 pixels a side, drawn in software.

``PARTS`` and ``violations`` make it a long measurement, which needs Playwright for Python and a Chromium.
"""

import base64
import time
from collections.abc import Mapping
from typing import Any

import numpy as np

from tests.viewer.conftest import SHOW
from tests.viewer.served import serving
from tests.viewer.written import HEIGHT, OFF, WIDTH, Written, decoded, launch, looking, manifest

SIDE = 8192
PICTURE = """async side => {
  const bytes = new Uint8Array(await (await stage.image({width: side, height: side})).arrayBuffer());
  let text = "";
  for (let k = 0; k < bytes.length; k += 8192) text += String.fromCharCode(...bytes.subarray(k, k + 8192));
  return btoa(text);
}"""


def largest() -> dict[str, float]:
    """Seconds, the size, and how many voxels of a checkerboard have not their colour, below title and colour bar."""
    from playwright.sync_api import sync_playwright

    written, n, size = Written(), 8, 0.1
    board = (np.indices((n, 1, n)).sum(axis=0) % 2).astype(float)
    shown = manifest(volumes=[written.volume("board", board, (-n // 2, 0, -n // 2), size)])
    patch = {"theme": "light", "layers": {"axes": OFF, "scale_bar": OFF}, "volumes": {"board": {"style": "cells"}},
             "camera": looking([0, 0, 0], n * size / 2),
             "range": {"low": 0.0, "high": 1.0, "scale": "linear", "clipped": False}}  # fmt: skip
    with serving() as (address, blobs), sync_playwright() as running:
        browser = launch(running)
        page = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT})
        page.goto(address)
        blobs |= {f"/board/{name}": data for name, data in written.blobs.items()}
        page.evaluate(SHOW, {"manifest": shown, "folder": "board", "patch": patch})
        page.wait_for_timeout(3000)
        began = time.perf_counter()
        picture = decoded(base64.b64decode(page.evaluate(PICTURE, SIDE)))
        seconds = time.perf_counter() - began
        browser.close()
    height, width, _ = picture.shape
    middles = ((np.arange(n) + 0.5) / n * SIDE).astype(int)
    light = picture[middles[::-1]][:, middles].sum(axis=2) > 300  # the upper end of viridis; z upwards
    wrong = int((light != board[:, 0].T.astype(bool))[: n - 2].sum())
    return {"seconds": seconds, "width": width, "height": height, "wrong": wrong}


PARTS = {"8192": largest}


def violations(figures: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """What is not as asked for."""
    return [
        f"picture of {SIDE} pixels: {found}"
        for found in figures.values()
        if (found["width"], found["height"], found["wrong"]) != (SIDE, SIDE, 0)
    ]
