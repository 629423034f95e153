"""What the page holds while it is used: after many rounds no more than after a few.

The ten minutes that the goals are of: `benchmarks/viewer.py use`.
"""

import numpy as np
import pytest

import wsrender as ws
from tests.viewer.watched import HELD, JOB, Watched, settle

FIRST, LATER = 1, 3  # rounds: caches have filled after the first
GROWTH = {
    "heap": 1.5e6,
    "arrays": 1e5,
}  # bytes; of the heap, what the engine of JavaScript compiles and keeps meanwhile
STYLES = ("cells", "isosurface", "points")
SMALL = {"viewport": {"width": 1120, "height": 420}}  # all panels beside a little picture
ALIVE = ("WebGL2RenderingContext", "WebSocket", "Worker")  # kinds of which none outlives its view
CANVAS = "document.querySelector('#wsrender').shadowRoot.querySelector('.stage-host canvas')"


@pytest.fixture(scope="module")
def two(client: ws.Client) -> list[ws.client.Job]:
    """Jobs of two robots, whose volumes have other sizes."""
    scara = JOB | {"robot": {"library": "scara"}, "voxel_size_m": 0.02}
    return [client.submit(document).wait() for document in (JOB | {"best_sample": "manipulability"}, scara)]


def round_of_use(watched: Watched, two: list[ws.client.Job], upper_deg: float) -> list[dict[str, int]]:
    """Both views are opened, changed and left, one after the other; one has a volume that follows a limit. Returns what
    their graphics held at the end."""
    page, held = watched.page, []
    for job in two:
        page.get_by_role("button", name=f"View job {job.id[:8]}").click()
        page.get_by_role("button", name="Show all").wait_for()
        for style in STYLES:
            page.get_by_label("Style").select_option(style)
            settle(watched)
        page.get_by_role("button", name="Slices").click()
        for what in ("Add a slice", "Add a slice", "Remove"):
            page.get_by_role("button", name=what).first.click()
            settle(watched)
        if job is two[0]:
            page.get_by_text("Change limits").click()
            upper = page.get_by_label("Upper limit of joint2 [°], as a number")
            upper.fill(str(upper_deg))
            upper.press("Enter")
            page.locator("[data-live=done][data-volume]").wait_for()
            settle(watched)
        held.append(page.evaluate(f"{CANVAS}.getContext('webgl2').held"))
        page.get_by_role("link", name="Jobs").click()
        page.locator("tr[data-job]").first.wait_for()
    return held


def kept(watched: Watched) -> tuple[dict[str, int], dict[str, float]]:
    """What the page keeps where no view is, by kind, and bytes by kind, after a collection."""
    session = watched.page.context.new_cdp_session(watched.page)
    for _ in range(3):
        session.send("HeapProfiler.collectGarbage")
    found = {}
    for kind in ALIVE:
        of = session.send("Runtime.evaluate", {"expression": f"{kind}.prototype", "objectGroup": "kept"})
        asked = {"prototypeObjectId": of["result"]["objectId"], "objectGroup": "kept"}
        found[kind] = int(session.send("Runtime.queryObjects", asked)["objects"]["description"][len("Array(") : -1])
    session.send("Runtime.releaseObjectGroup", {"objectGroup": "kept"})
    session.send("HeapProfiler.collectGarbage")
    size, counted = session.send("Runtime.getHeapUsage"), session.send("Memory.getDOMCounters")
    session.detach()
    found |= {name: counted[name] for name in ("nodes", "jsEventListeners")}
    return found, {"heap": size["usedSize"], "arrays": size["backingStorageSize"]}


@pytest.mark.parametrize("watched", [SMALL], indirect=True)
def test_nothing_grows_while_the_page_is_used(watched: Watched, two: list[ws.client.Job]) -> None:
    page = watched.page
    page.add_init_script(HELD)
    page.goto(watched.url)
    held, found = {}, {}
    for number in range(1, LATER + 1):
        held[number] = round_of_use(watched, two, -60 - number)
        page.wait_for_timeout(300)
        found[number] = kept(watched)
    # Another program is compiled where a picture is drawn coarsely first: a question of time.
    programs = [[each.pop("Program") for each in held[number]] for number in (FIRST, LATER)]
    assert held[FIRST][0]["Texture"] > 3 and held[LATER] == held[FIRST], held
    assert np.abs(np.subtract(*programs)).max() <= 1, programs
    (first, before), (later, after) = found[FIRST], found[LATER]
    assert later == first and [later[kind] for kind in ALIVE] == [0] * len(ALIVE), found
    assert all(after[name] < before[name] + GROWTH[name] for name in GROWTH), found
