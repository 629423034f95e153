"""A real Chromium that draws views which are made here, served from this process."""

import time
from collections.abc import Iterator

import pytest
from wsrender_server.local_server import LocalServer

import wsrender as ws
from tests.viewer.served import serving
from tests.viewer.watched import PATIENCE_MS, Watched
from tests.viewer.written import HEIGHT, OFF, WIDTH, decoded, launch

SHOW = """async ({manifest, folder, patch}) => {
  const page = await import("/viewer/viewer.js");
  window.stage?.dispose();
  const stage = window.stage = new page.Stage(document.getElementById("here"));
  window.page = page;
  window.told = [];
  for (const event of ["pick", "problem", "lost", "gizmo", "drawn"])
    stage.on(event, value => told.push([event, value]));
  await stage.load(manifest, async name => (await fetch(`/${folder}/${name}`)).arrayBuffer());
  window.settings = page.defaultSettings(manifest);
  window.merge = (a, b) => { for (const [k, v] of Object.entries(b))
    if (v && typeof v === "object" && !Array.isArray(v) && a[k]) merge(a[k], v); else a[k] = v; };
  merge(settings, patch);
  stage.apply(structuredClone(settings));
}"""


class Views:
    """A page, and the views that it can show."""

    def __init__(self, page, blobs):
        self.page, self.blobs, self.count = page, blobs, 0
        self.forgiven = "\0"  # text in a warning that a test expects

    def show(self, manifest, blobs, **patch):
        self.count += 1
        folder = f"view{self.count}"
        self.blobs |= {f"/{folder}/{name}": data for name, data in blobs.items()}
        patch = {"theme": "light", "layers": {"axes": OFF, "scale_bar": OFF}} | patch
        self.page.evaluate(SHOW, {"manifest": manifest, "folder": folder, "patch": patch})
        self.rest()

    def change(self, **patch):
        self.page.evaluate("patch => { merge(settings, patch); stage.apply(structuredClone(settings)); }", patch)
        self.rest()

    def rest(self):
        """Until the last picture is drawn."""
        self.page.wait_for_timeout(60)
        self.until("stage.info.idle && told.some(each => each[0] === 'drawn')")
        self.page.wait_for_timeout(60)  # the compositor's

    def until(self, condition, seconds=30.0):
        """Until an expression is true; asked again and again, since the page's policy lets it evaluate no text."""
        end = time.monotonic() + seconds
        while not self.page.evaluate(condition):
            assert time.monotonic() < end, f"never so: {condition} {self.page.evaluate('stage.info')}"
            self.page.wait_for_timeout(30)

    def picture(self):
        """What the screen shows, (HEIGHT, WIDTH, 3) uint8."""
        return decoded(self.page.screenshot())

    def told(self, event):
        return self.page.evaluate("event => told.filter(each => each[0] === event).map(each => each[1])", event)


@pytest.fixture(scope="module")
def playwright():
    api = pytest.importorskip("playwright.sync_api", reason="needs Playwright for Python and a Chromium")
    with api.sync_playwright() as running:
        yield running


@pytest.fixture(scope="module")
def site():
    """Address of a server of the built page and of ``blobs`` by path."""
    with serving() as found:
        yield found


@pytest.fixture(scope="module")
def chromium(playwright):
    browser = launch(playwright)
    yield browser
    browser.close()


@pytest.fixture
def views(chromium, site):
    """A fresh page; it fails the test where the console reports an error, or another host is asked."""
    address, blobs = site
    page = chromium.new_page(viewport={"width": WIDTH, "height": HEIGHT})
    errors = []
    page.on("console", lambda message: errors.append(message.text) if message.type in ("error", "warning") else None)
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.on(
        "request", lambda asked: None if asked.url.startswith((address, "data:", "blob:")) else errors.append(asked.url)
    )
    page.goto(address)
    shown = Views(page, blobs)
    yield shown
    page.close()
    noise = (shown.forgiven, "GPU stall due to ReadPixels")
    assert [each for each in errors if not any(text in each for text in noise)] == []


@pytest.fixture(scope="module")
def server(tmp_path_factory) -> Iterator[LocalServer]:
    with LocalServer(tmp_path_factory.mktemp("viewer")) as server:
        yield server


@pytest.fixture(scope="module")
def client(server) -> Iterator[ws.Client]:
    with ws.Client(server.url) as client:
        yield client


@pytest.fixture
def watched(chromium, server, request) -> Iterator[Watched]:
    """A page of 1280 x 720 of the server, or what a test's parameter says; it must end without errors."""
    context = chromium.new_context(**{"viewport": {"width": 1280, "height": 720}, **getattr(request, "param", {})})
    context.set_default_timeout(PATIENCE_MS)
    page = context.new_page()
    watched = Watched(page, server.url)
    yield watched
    context.close()
    assert watched.errors == []
    assert watched.foreign == []
