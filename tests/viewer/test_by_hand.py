"""What is measured, chosen in plots and dropped into the served page, by the mouse."""

import base64
import hashlib
import io
import json
from pathlib import Path
from typing import Any

import httpx2
import numpy as np
import pytest
import trimesh
from wsrender_server.local_server import LocalServer

import wsrender as ws
from tests.server.hostile.cases import zipped
from tests.server.http.test_view import read_message
from tests.viewer.watched import JOB, PATIENCE_MS, Watched, clicked, differing, opened, pixels, settle, tip, until
from tests.viewer.written import WRITTEN, decoded, looking
from wsrender.documents.robot import DHTable
from wsrender.results.view.interactive import Interactive

ARM = """<mujoco model="pair"><worldbody><body name="upper"><joint name="shoulder" axis="0 0 1" range="-90 90"/>
<geom type="capsule" size=".03" fromto="0 0 0 .4 0 0"/><body name="lower" pos=".4 0 0">
<joint name="elbow" axis="0 1 0" range="-90 90"/><geom type="capsule" size=".03" fromto="0 0 0 .3 0 0"/>
<site name="tool" pos=".3 0 0"/></body></body></worldbody></mujoco>"""


@pytest.fixture(scope="module")
def finished(client) -> str:
    """The id of a job that has a result."""
    return client.submit(JOB).wait().id


def test_the_distance_of_two_places(watched: Watched, client: ws.Client, finished: str) -> None:
    """On the plane y = 0, through which the volume is cut: known from where the mouse is, and drawn."""
    half, target, size = 1.2, np.zeros(3), JOB["voxel_size_m"]
    volume = client.job(finished).result().volume
    assert volume is not None
    layer = volume.occupied[:, -volume.first_voxel[1]]
    cut = {"style": "cells", "cut": [{"axis": "y", "from_m": 0.0, "to_m": None}]}
    opened(watched, f"/job/{finished}", camera=looking(target, half), volumes={"volume": cut},
           layers={"robot:0": {"visible": False, "opacity": 1}})  # fmt: skip
    page, box = watched.page, watched.page.locator(".stage-host").bounding_box()
    metre = box["height"] / 2 / half
    middle = np.array([box["x"] + box["width"] / 2, box["y"] + box["height"] / 2])
    cells = np.argwhere(layer)
    at = (cells[[0, -1]] + np.array(volume.first_voxel)[[0, 2]] + 0.5) * size  # x and z
    places = np.round(middle + at * [metre, -metre])  # whole pixels
    assert (np.abs(at) < half).all()
    before = pixels(watched)
    page.get_by_role("button", name="Measure").click()
    for place in places:
        page.mouse.click(*place)
    shown = page.locator("[data-distance]")
    shown.wait_for()
    distance = float(shown.get_attribute("data-distance"))
    expected = np.linalg.norm(places[1] - places[0]) / metre
    assert distance == pytest.approx(expected, rel=1e-4)
    assert shown.inner_text() == f"{expected:.4g} m"
    assert differing(before, pixels(watched)) > 100  # the line
    assert page.locator("[data-voxel]").count() == 0  # no voxel was chosen meanwhile
    page.get_by_role("button", name="Clear").click()
    assert differing(before, pixels(watched)) < 20
    page.mouse.click(*places[0])
    assert shown.count() == 0 and "second point" in page.get_by_role("region", name="Selected").inner_text()


def test_a_range_is_dragged_in_a_histogram_and_a_voxel_is_marked_there(watched: Watched, finished: str) -> None:
    manifest = httpx2.get(f"{watched.url}/v1/jobs/{finished}/view", timeout=60).json()
    (plot,) = (each for each in manifest["plots"] if each["kind"] == "histogram")
    first, last = plot["x"]["values"][0], plot["x"]["values"][-1]
    opened(watched, f"/job/{finished}")
    page, before = watched.page, pixels(watched)
    over = page.locator(".plot .u-over")
    over.scroll_into_view_if_needed()
    box = over.bounding_box()
    chosen = [first + share * (last - first) for share in (0.2, 0.6)]
    y = box["y"] + box["height"] / 2
    page.mouse.move(box["x"] + 0.2 * box["width"], y)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.4 * box["width"], y)
    page.mouse.move(box["x"] + 0.6 * box["width"], y)
    page.mouse.up()
    settle(watched)
    pixel = (last - first) / box["width"]
    for end, value in zip(("Lower", "Upper"), chosen, strict=True):
        assert float(page.get_by_label(f"{end} end of the range").input_value()) == pytest.approx(value, abs=2 * pixel)
    assert differing(before, pixels(watched)) > 1000
    _, values = clicked(watched)
    over.scroll_into_view_if_needed()
    page.wait_for_timeout(200)
    box = over.bounding_box()
    seen = decoded(over.screenshot())
    red, green, blue = seen[:8].mean(axis=0).T  # above most bars
    marked = np.flatnonzero((red > 150) & (green < 140) & (blue < 90))
    at = (values["maximum:manipulability"] - first) / (last - first) * box["width"]
    assert len(marked) and np.abs(marked - at).max() <= 4


def test_counts_beside_a_plot_are_whole(watched: Watched, client: ws.Client) -> None:
    """Of so few samples that a bar counts one or two of them."""
    few = {"sampling": {"method": "sobol", "count": 16}, "keep_map": True, "voxel_size_m": 0.3}
    job = client.submit(JOB | few).wait()
    watched.page.add_init_script(f"({WRITTEN})()")
    opened(watched, f"/job/{job.id}")
    watched.page.locator(".plot canvas").wait_for()
    own = "written.filter(([canvas]) => canvas.closest('.plot')).map(([, text]) => text)"
    written = set(watched.page.evaluate(own))
    assert {"Samples", "0", "1"} <= written
    assert written.isdisjoint({"0.2", "0.5", "1.5", "2.5"})


def dropped(watched: Watched, field: Any, *files: tuple[str, bytes]) -> None:
    """Files by name, dropped onto a field as from a folder."""
    transfer = watched.page.evaluate_handle(
        """(files) => {
          const transfer = new DataTransfer();
          for (const [name, text] of files)
            transfer.items.add(new File([Uint8Array.from(atob(text), (each) => each.charCodeAt(0))], name));
          return transfer;
        }""",
        [[name, base64.b64encode(content).decode()] for name, content in files],
    )
    field.dispatch_event("dragover", {"dataTransfer": transfer})
    field.dispatch_event("drop", {"dataTransfer": transfer})


def at_model(watched: Watched) -> tuple[Any, Any]:
    """A new job's field of an uploaded model, and what is wrong there."""
    page = watched.page
    page.goto(watched.url + "/#/new")
    page.locator('[data-pointer="#/robot"]').first.select_option(label="Robot …")
    page.locator('[data-pointer="#/robot#source"]').select_option(label="Model")
    field = page.locator('[data-pointer="#/robot/model"]')
    return field, page.locator('.field:has([data-pointer="#/robot/model"]) .problem')


def test_a_model_is_dropped_into_the_form(watched: Watched, client: ws.Client) -> None:
    """It is uploaded, named by its SHA-256, shown, and computed; what is no model is refused where it was dropped."""
    page, (field, problem) = watched.page, at_model(watched)
    markup = "<img src=x onerror=alert(1)>.xml"
    dropped(watched, field, (markup, b"no model"))
    problem.filter(has_text=markup).wait_for()
    assert page.locator("img").count() == 0
    assert field.input_value() == ""
    dropped(watched, field, ("pair.xml", ARM.encode()))
    page.get_by_text("pair.xml is uploaded").wait_for()
    assert problem.count() == 0
    assert field.input_value() == hashlib.sha256(ARM.encode()).hexdigest()
    page.locator(".preview-host canvas").first.wait_for()
    assert computed(watched, client)["name"] == "pair"


def computed(watched: Watched, client: ws.Client) -> dict[str, Any]:
    """What the result of a small job says of the robot in the form."""
    page = watched.page
    page.locator('[data-pointer="#/sampling"]').select_option(label="Sobol …")
    page.locator('[data-pointer="#/sampling/count"]').fill("1000")
    page.locator('[data-pointer="#/voxel_size_m"]').fill("0.1")
    page.get_by_text("Samples", exact=True).wait_for()
    with page.expect_response(lambda answer: answer.url.endswith("/v1/jobs") and answer.status == 202) as answer:
        page.get_by_role("button", name="Submit", exact=True).click()
    return client.job(answer.value.json()["id"]).result().document["robot"]


def test_a_folder_comes_into_the_form_as_a_zip(watched: Watched, client: ws.Client) -> None:
    """A model alone is told which of its files are missing; with them, in a ZIP, its mesh is what is seen."""
    page, (field, problem) = watched.page, at_model(watched)
    alone = ARM.replace("<worldbody>", '<asset><mesh name="m" file="meshes/m.stl"/></asset><worldbody>', 1).replace(
        "</body></body>", '<geom type="mesh" mesh="m" contype="0" conaffinity="0" mass="0"/></body></body>'
    )
    dropped(watched, field, ("pair.xml", alone.encode()))
    page.get_by_text("Without files that it names (meshes/m.stl): upload the model's folder as a ZIP").wait_for()
    wide = trimesh.creation.box((0.1, 0.1, 3.0)).export(file_type="stl")
    assert isinstance(wide, bytes)
    for files, said in (
        ([("a.xml", b""), ("b.stl", b"")], "Several files: drop their folder as a ZIP"),
        ([("meshes.zip", zipped({"m.stl": wide}))], "meshes.zip"),
    ):
        dropped(watched, field, *files)
        problem.filter(has_text=said).wait_for()
    content = zipped({"arm/pair.xml": alone.encode(), "arm/meshes/m.stl": wide})
    chooser = page.locator('.field:has([data-pointer="#/robot/model"]) input[type=file]')
    chooser.set_input_files({"name": "arm.zip", "mimeType": "application/zip", "buffer": content})
    page.get_by_text("arm.zip is uploaded").wait_for()
    assert field.input_value() == hashlib.sha256(content).hexdigest()
    assert problem.count() == 0 and page.get_by_text("Without files that it names").count() == 0
    edited = {"robot": {"model": field.input_value()}}
    _, blobs = read_message(httpx2.post(f"{watched.url}/v1/robots:view", json=edited, timeout=60).content)
    (lower,) = (each for name, each in blobs.items() if name.endswith("link1.glb"))
    assert trimesh.load(io.BytesIO(lower), file_type="glb").extents.max() == pytest.approx(3.0, rel=1e-5)
    assert computed(watched, client)["name"] == "pair"


def test_what_no_field_of_text_takes_is_said(watched: Watched) -> None:
    page = watched.page
    page.goto(watched.url + "/#/new")
    page.locator('[data-pointer="#/robot"]').first.select_option(label="Robot …")
    page.locator('[data-pointer="#/robot#source"]').select_option(label="Mjcf")
    field = page.locator('[data-pointer="#/robot/mjcf"]')
    dropped(watched, field, ("arm.zip", zipped({"arm.xml": ARM.encode()})))
    page.get_by_text("arm.zip is a ZIP: choose the source “Model” to upload it").wait_for()
    assert field.input_value() == ""
    dropped(watched, field, ("pair.xml", ARM.encode()))
    until(lambda: field.input_value() == ARM)
    assert page.get_by_text("arm.zip is a ZIP").count() == 0


def test_a_robot_that_is_edited_is_moved_and_its_volume_followed(watched: Watched) -> None:
    """Before there is a job: pose and volumes are the library's, and what was dragged goes into the form."""
    rows = [{"a": 0.5, "limits": [-2, 2]}, {"a": 0.3, "limits": [-2, 2]}, {"joint": "prismatic", "limits": [0, 0.2]}]
    robot = {"dh": {"convention": "standard", "name": "drawn", "rows": rows}}
    arm = ws.load_robot(DHTable(**robot["dh"]))
    page = watched.page
    page.goto(f"{watched.url}/#/new")
    page.get_by_role("button", name="Edit as JSON").click()
    page.get_by_label("Job document").fill(json.dumps({"analysis": "workspace", "robot": robot}))
    page.get_by_role("button", name="Robot: drawn").click()
    for joint, value in (("joint1 [°]", "30"), ("joint2 [°]", "-45"), ("joint3 [m]", "0.1")):
        field = page.get_by_label(f"Joint {joint}, as a number")
        field.fill(value)
        field.press("Enter")
    q = [np.radians(30), np.radians(-45), 0.1]
    until(lambda: np.abs(tip(watched) - arm.forward_kinematics(q)[0, :3, 3]).max() < 1e-6)
    assert page.locator("main.at-new").count(), "Enter in a field of the preview submits nothing"

    def followed() -> float:
        return float(page.locator("[data-live=done]").get_attribute("data-volume") or 0)

    asked = {"ask": "volume", "index": "manipulability", "samples": 1 << 20}
    local = Interactive({}, [arm])
    header, _ = local.answer(asked)
    page.get_by_text("Change limits").click()
    page.get_by_role("button", name="Compute its volume").click()
    until(lambda: followed() == pytest.approx(header["volume_m3"], rel=1e-12))
    limit = page.get_by_label("Upper limit of joint2 [°], as a number")
    limit.fill("10")
    limit.press("Enter")
    size, limits = header["volume"]["voxel_size_m"], {"joint2": [-2, np.radians(10)]}
    narrower, _ = local.answer(asked | {"voxel_size_m": size, "limits": limits})
    assert narrower["volume_m3"] < 0.9 * header["volume_m3"]
    until(lambda: followed() == pytest.approx(narrower["volume_m3"], rel=1e-12))
    page.get_by_role("button", name="Into the form").click()
    until(lambda: "limits" in json.loads(page.get_by_label("Job document").input_value())["robot"])
    written = json.loads(page.get_by_label("Job document").input_value())["robot"]
    assert written["dh"] == robot["dh"]
    np.testing.assert_allclose(written["limits"]["joint2"], limits["joint2"], atol=1e-12)


def test_an_upload_that_is_too_large_is_told_the_limit(chromium, tmp_path: Path, monkeypatch) -> None:
    """Though the server stops reading it: the page is no less sure of the server for that."""
    monkeypatch.setenv("WSRENDER_MAX_UPLOAD_BYTES", str(1 << 20))
    page = chromium.new_page()
    page.set_default_timeout(PATIENCE_MS)
    with LocalServer(tmp_path) as server:
        watched = Watched(page, server.url)
        _, problem = at_model(watched)
        chooser = page.locator('.field:has([data-pointer="#/robot/model"]) input[type=file]')
        for size in ((1 << 20) + 1, 24 << 20):
            file = {"name": f"{size}.zip", "mimeType": "application/zip", "buffer": b"PK\3\4" + bytes(size - 4)}
            chooser.set_input_files(file)
            problem.get_by_text(f"{size}.zip: the body may have 1,048,576 bytes").wait_for()
            assert "WSRENDER_MAX_UPLOAD_BYTES" in problem.inner_text()
        page.wait_for_timeout(500)
        assert page.get_by_text("does not answer").count() == 0
    page.close()
    assert watched.errors == []
