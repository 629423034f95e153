"""What the served page does where something is wrong: no graphics, keys, a server that goes, hostile names."""

import json
import time
import zlib
from base64 import urlsafe_b64encode
from pathlib import Path
from typing import Any
from urllib.parse import quote

import httpx2
import numpy as np
import pytest
from wsrender_server.local_server import LocalServer

import wsrender as ws
from tests.viewer.watched import JOB, PATIENCE_MS, Watched, clicked, differing, opened, pixels, settle, until
from tests.viewer.written import launch

SMALL = JOB | {"sampling": {"method": "sobol", "count": 1 << 14}}


def test_without_graphics_the_pictures_of_the_result_are_shown(playwright, server, client, tmp_path: Path) -> None:
    job = client.submit(SMALL).wait()
    browser = launch(playwright, "--disable-3d-apis")
    page = browser.new_page()
    page.set_default_timeout(PATIENCE_MS)
    watched = Watched(page, server.url)
    page.goto(f"{server.url}/#/job/{job.id}")
    shown = page.get_by_role("region", name="Pictures of the result")
    until(lambda: shown.locator("img").count() >= 3)
    for image in shown.locator("img").all():
        until(lambda image=image: image.evaluate("each => each.complete && each.naturalWidth") > 100)
    assert "These are pictures of the result instead." in shown.inner_text()
    job.result().report(tmp_path / "report.html")
    page.goto((tmp_path / "report.html").as_uri())
    page.get_by_text("Pictures of the result, where it has any, are further down.").wait_for()
    assert page.locator("figure img").count() >= 3
    browser.close()
    assert watched.errors == []


def test_a_volume_that_is_too_large_is_reduced_with_a_notice(watched: Watched, client: ws.Client) -> None:
    """A voxel that is clicked is of those that are shown, with the values of the file's."""
    job = client.submit(SMALL | {"voxel_size_m": 0.006}).wait()
    opened(watched, f"/job/{job.id}", volumes={"volume": {"style": "points"}})
    notice = watched.page.locator(".overlay .notice")
    notice.get_by_text("voxels of 0.006 m are shown in voxels 2 times as long, of 0.012 m").wait_for()
    volume = job.result().volume
    assert volume is not None and np.prod(volume.shape) > 256**3
    cells = np.stack(np.unravel_index(volume.voxels.cells, volume.shape), axis=1) + volume.first_voxel
    values = volume.voxels.statistics["maximum"]["manipulability"]
    center = (cells[0] + 0.5) * 0.006
    for name, value in zip("xyz", center, strict=True):
        watched.page.get_by_label(f"{name} of a place [m]").fill(f"{value:.4f}")
    watched.page.get_by_role("button", name="Look there").click()
    shown = watched.page.locator("[data-voxel] [data-value='maximum:manipulability']")
    shown.wait_for()
    within = (cells // 2 == cells[0] // 2).all(axis=1)
    assert float(shown.get_attribute("data-exact")) == values[within].max()


GRAPHICS = """() => document.querySelector("#wsrender").shadowRoot.querySelector(".stage-host canvas")
  .getContext("webgl2").getExtension("WEBGL_lose_context")"""


def test_graphics_that_are_taken_away_leave_the_pictures_until_they_come_back(watched: Watched, finished: str) -> None:
    opened(watched, f"/job/{finished}")
    page, before = watched.page, pixels(watched)
    graphics = page.evaluate_handle(GRAPHICS)
    graphics.evaluate("each => each.loseContext()")
    shown = page.get_by_role("region", name="Pictures of the result")
    shown.get_by_text("The browser has taken the 3-D graphics away.").wait_for()
    until(lambda: shown.locator("img").count() >= 3)
    for image in shown.locator("img").all():
        until(lambda image=image: image.evaluate("each => each.complete && each.naturalWidth") > 100)
    page.locator(".stage-host").evaluate("each => { delete each.dataset.drawn; }")
    graphics.evaluate("each => each.restoreContext()")
    shown.wait_for(state="detached")
    assert differing(before, pixels(watched)) < 100


def test_a_key_is_entered_once_and_kept_by_the_tab(chromium, tmp_path: Path) -> None:
    secret = "a/secret=of,ann-12345"
    (tmp_path / "keys").write_text(f"{secret} ann read,submit\n")
    context = chromium.new_context(viewport={"width": 1280, "height": 720})
    context.set_default_timeout(PATIENCE_MS)
    with LocalServer(tmp_path / "data", ["--api-key-file", str(tmp_path / "keys")]) as server:
        with ws.Client(server.url, token=secret) as client:
            job = client.submit(SMALL | {"best_sample": "manipulability"}).wait()
        page = context.new_page()
        watched, asked = Watched(page, server.url), []
        page.on("request", lambda request: asked.append(request.url))
        page.on("websocket", lambda socket: asked.append(socket.url))
        page.goto(server.url + "/")
        dialog = page.get_by_role("dialog", name="API key")
        dialog.get_by_text("This server asks for an API key.").wait_for()
        for key in ("wrong-key-0123456789", secret):
            dialog.get_by_label("Key").fill(key)
            dialog.get_by_role("button", name="Use it").click()
            if key != secret:
                dialog.get_by_text("The server does not know this key.").wait_for()
        page.get_by_role("button", name=f"View job {job.id[:8]}").click()
        page.get_by_role("button", name="Show all").wait_for()
        settle(watched)
        clicked(watched)  # by the session's WebSocket
        page.get_by_text("Best posture: sample").wait_for()
        page.get_by_role("button", name="Link").click()
        page.get_by_text("The link is", exact=False).first.wait_for()
        assert "view=" in page.url
        page.reload()
        page.get_by_role("button", name="Show all").wait_for()
        stored = page.evaluate("[Object.values(sessionStorage), Object.values(localStorage), document.cookie]")
        assert stored[0] == [secret]
        shown = [*asked, page.url, *stored[1], stored[2]]
        assert any(each.startswith("ws:") for each in shown)
        for form in (secret, quote(secret, safe=""), urlsafe_b64encode(secret.encode()).decode().rstrip("=")):
            assert not any(form in each for each in shown)
        other = context.new_page()
        other.goto(page.url)
        other.get_by_text("This server asks for an API key.").wait_for()
        context.close()
    assert watched.errors == []
    assert watched.foreign == []


def test_a_server_that_goes_is_said_and_found_again(chromium, tmp_path: Path) -> None:
    pages = [chromium.new_page(viewport={"width": 1280, "height": 720}) for _ in range(2)]  # of contexts of their own
    with LocalServer(tmp_path) as server:
        with ws.Client(server.url) as client:
            job = client.submit(SMALL | {"best_sample": "manipulability"}).wait()
            volume = job.result().volume
        assert volume is not None
        for page in pages:
            page.set_default_timeout(PATIENCE_MS)
        view, jobs = (Watched(page, server.url) for page in pages)
        opened(view, f"/job/{job.id}")
        clicked(view)
        jobs.page.goto(server.url)
        jobs.page.locator(f"tr[data-job='{job.id}']").wait_for()
        server.stop()
        lost = [each.page.get_by_text("does not answer. Looking for it again") for each in (view, jobs)]
        for each in lost:
            each.wait_for()
        view.page.get_by_role("button", name="Forget it").click()
        cell, values = clicked(view)
        at = int(np.searchsorted(volume.voxels.cells, np.ravel_multi_index(cell, volume.shape)))
        known = volume.voxels.statistics["maximum"]["manipulability"][at]
        assert values == {"maximum:manipulability": np.float16(known)}
        view.page.get_by_text("These values are rounded to 16 bits.").wait_for()
        server.start()
        for each in lost:
            each.wait_for(state="hidden")
        view.page.get_by_role("button", name="Forget it").click()
        clicked(view)
        view.page.get_by_text("Best posture: sample").wait_for()
        until(lambda: jobs.page.get_by_role("alert").count() == 0)
        with ws.Client(server.url) as client:
            later = client.submit(SMALL)
        jobs.page.locator(f"tr[data-job='{later.id}'][data-state=succeeded]").wait_for()
    for page in pages:
        page.close()
    said = [each for each in view.errors + jobs.errors if "ERR_CONNECTION_REFUSED" not in each]
    assert said == []


FLOOD = """(path) => { window.flood = Promise.all(Array.from({length: 240}, (_, k) =>
  fetch(k % 3 ? path + "/view?channels=" + ["uint8", "float32"][k % 2] : "v1/robots:view", k % 3 ? {} : {
    method: "POST", headers: {"Content-Type": "application/json"},
    body: JSON.stringify({robot: {library: "ur5e", placement: {position_m: [k / 1000, 0, 0]}}})
  }).then((each) => each.status, () => 0))).then((found) => { window.answered = found; }); }"""


def test_a_page_that_floods_its_server_keeps_nobody_waiting(watched: Watched, client: ws.Client, finished: str) -> None:
    """Hundreds of questions at once: another is answered meanwhile, and each of them in the end, or told to wait."""
    page = watched.page
    page.goto(watched.url)
    page.evaluate(FLOOD, f"v1/jobs/{finished}")
    waits = []
    for _ in range(20):
        began = time.monotonic()
        assert httpx2.get(f"{watched.url}/healthz", timeout=30).status_code == 200
        assert client.job(finished).state == "succeeded"
        waits.append(time.monotonic() - began)
    assert sorted(waits)[10] < 1, waits
    until(lambda: page.evaluate("window.answered !== undefined"), 240)
    assert set(page.evaluate("answered")) <= {200, 429}


def packed(content: bytes) -> str:
    """A view's settings as a link has them."""
    deflate = zlib.compressobj(wbits=-15)
    return urlsafe_b64encode(deflate.compress(content) + deflate.flush()).decode().rstrip("=")


@pytest.fixture(scope="module")
def finished(client: ws.Client) -> str:
    """The id of a job that has a result."""
    return client.submit(SMALL | {"best_sample": "manipulability"}).wait().id


WRONG: dict[str, dict[str, Any]] = {
    "every kind": {
        "volumes": 5, "configurations": "x", "slices": [None], "camera": {"position": "a"}, "range": 3, "limits": 7,
        "layers": None, "selected": {"volume": "nope", "cell": [1]}, "measure": [[1]], "theme": "purple",
        "colors": {"a": 1}, "channels": [1], "mapping": {"scale": 2, "offset_m": [0, 0, 0]},
    },
    "within": {
        "volumes": {"volume": {"style": "fog", "channel": 3, "threshold": "x", "cut": [{"axis": "q"}], "opacity": 9}},
        "range": {"low": "a", "scale": "cubic"}, "layers": {"axes": {"visible": "no"}}, "slices": [{"axis": "x"}] * 9,
        "camera": {"position": [0, 0, 0], "target": [0, 0, 0], "up": [0, 0, 1], "orthographic": False},
    },
    "robots": {
        "limits": [{"joint2": ["a", None], "nope": [0, 1]}], "tools": [[1]], "placements": [[1, 2, 3]],
        "configurations": [["a"] * 6],
    },
}  # fmt: skip
LINKS = {name: packed(json.dumps(settings).encode()) for name, settings in WRONG.items()}
LINKS |= {"no base64": "!!!", "not deflated": "AAAA", "no JSON": packed(b"hello")}
LINKS["unfolds to half a gigabyte"] = packed(b"0" * (1 << 29))


def test_a_link_that_is_wrong_opens_the_view_as_it_is_at_first(watched: Watched, finished: str) -> None:
    opened(watched, f"/job/{finished}")
    page, first = watched.page, pixels(watched)
    for name, view in LINKS.items():
        page.goto("about:blank")
        page.goto(f"{watched.url}/#/job/{finished}?view={view}")
        page.get_by_role("button", name="Show all").wait_for()
        settle(watched)
        assert differing(first, pixels(watched)) < 100, name
        assert page.get_by_label("Style").input_value() == "surface", name
    for address in ("/job/123", f"/job/{finished}0", f"/compare/{finished}", "/nowhere"):
        page.goto(f"{watched.url}/#{address}")
        page.get_by_text("The address of this link is no page here").wait_for()
    page.goto(f"{watched.url}/#/job/{'0' * 32}")
    page.get_by_text("there is no such job, or it is not yours").wait_for()


def test_a_job_that_is_deleted_while_it_is_open_is_said(watched: Watched, client: ws.Client) -> None:
    """Its picture stays, and answers with what it holds."""
    job = client.submit(SMALL | {"voxel_size_m": 0.11}).wait()
    opened(watched, f"/job/{job.id}")
    page = watched.page
    assert httpx2.delete(f"{watched.url}/v1/jobs/{job.id}").status_code == 204
    clicked(watched)
    page.get_by_text("These values are rounded to 16 bits.").wait_for()
    page.get_by_text("No more questions about this view are answered: there is no such job").wait_for()


def test_what_a_key_may_not_do_is_said_and_a_revoked_one_asked_for(chromium, tmp_path: Path) -> None:
    admin, reader = "the-key-of-who-administers", "the-key-of-who-reads"
    (tmp_path / "keys").write_text(f"{admin} ann admin,read,submit\n{reader} ann read\n")
    with LocalServer(tmp_path / "data", ["--api-key-file", str(tmp_path / "keys")]) as server:
        headers = {"Authorization": f"Bearer {admin}"}
        made = httpx2.post(f"{server.url}/v1/keys", json={"name": "bob"}, headers=headers).json()
        jobs = []
        for secret in (admin, made["secret"]):
            with ws.Client(server.url, token=secret) as client:
                jobs.append(client.submit(SMALL).wait())
        pages = []
        for secret in (reader, made["secret"]):
            page = chromium.new_context(viewport={"width": 1280, "height": 720}).new_page()
            page.set_default_timeout(PATIENCE_MS)
            page.add_init_script(f"sessionStorage.setItem('wsrender.key', {json.dumps(secret)})")
            pages.append(Watched(page, server.url))
        reading, revoked = pages
        reading.page.goto(server.url)
        reading.page.get_by_role("button", name=f"Delete job {jobs[0].id[:8]}").click()
        reading.page.get_by_role("button", name=f"Really delete job {jobs[0].id[:8]}").click()
        said = reading.page.get_by_text(f"Job {jobs[0].id[:8]}, delete: this key lacks the scope 'submit'")
        said.wait_for()
        with reading.page.expect_response("**/v1/jobs?*"):  # the list is read again
            pass
        assert said.count() == 1 and reading.page.locator(f"tr[data-job='{jobs[0].id}']").count() == 1
        opened(revoked, f"/job/{jobs[1].id}")
        clicked(revoked)
        revoke = f"{server.url}/v1/keys/{made['id']}:revoke"
        assert httpx2.post(revoke, headers=headers).status_code == 200
        dialog = revoked.page.get_by_role("dialog", name="API key")
        dialog.get_by_text("The server does not know this key.").wait_for()
        revoked.page.get_by_text("No more questions about this view are answered: the API key was revoked").wait_for()
        for each in pages:
            each.page.context.close()
            assert each.errors == []
