"""The served page as a person uses it."""

import json
import re
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest

import wsrender as ws
from tests.golden.files import analyses, job_of
from tests.viewer.axe import serious_faults
from tests.viewer.watched import (
    JOB,
    Watched,
    clicked,
    differing,
    link_holds_the_view,
    opened,
    pixels,
    relink,
    settle,
    spots,
    until,
)
from tests.viewer.written import decoded, looking


@pytest.fixture(scope="module")
def finished(client) -> str:
    """The id of a job that has a result."""
    return client.submit(JOB).wait().id


NARROW = {
    **JOB,
    "robot": {"library": "ur5e", "limits": {"joint2": [-1.5, 0.0]}},
    "sampling": {"method": "sobol", "count": 1 << 20},  # as many as follow a slider
}


@pytest.fixture(scope="module")
def narrower(client) -> str:
    """The same with a joint's limits drawn together."""
    return client.submit(NARROW).wait().id


def test_a_job_is_submitted_through_the_form_and_watched(watched: Watched) -> None:
    page = watched.page
    page.goto(watched.url + "/")
    page.get_by_role("button", name="New job").click()
    page.locator('[data-pointer="#/robot"]').first.select_option(label="ur5e")
    page.locator('[data-pointer="#/sampling"]').select_option(label="Sobol …")
    page.locator('[data-pointer="#/sampling/count"]').fill("0")
    problem = page.locator('.field:has([data-pointer="#/sampling/count"]) .problem')
    problem.wait_for()
    assert "at least 1" in problem.inner_text()
    page.locator('[data-pointer="#/sampling/count"]').fill("5e4")
    page.locator('[data-pointer="#/voxel_size_m"]').fill("0.1")
    page.get_by_text("Samples", exact=True).wait_for()
    assert page.locator(".facts dd").first.inner_text() == "50,000"
    page.get_by_role("button", name="Submit").click()
    row = page.locator("tbody tr[data-job]").first
    row.wait_for()
    page.locator("tr[data-state=succeeded]").first.wait_for()
    row.get_by_role("button", name="View").click()
    page.get_by_role("button", name="Show all").wait_for()
    assert watched.refusals <= 4


def test_every_analysis_has_a_form_that_keeps_its_document(watched: Watched) -> None:
    """Written as JSON, shown as fields, found good by the server with what it takes, and the same JSON again."""
    page = watched.page
    page.goto(watched.url + "/#/new")
    edit = page.get_by_role("button", name="Edit as JSON")
    for analysis in analyses():
        document = job_of(analysis)
        edit.click()
        page.get_by_label("Job document").fill(json.dumps(document))
        edit.click()
        until(lambda analysis=analysis: page.get_by_label("Analysis", exact=True).input_value() == analysis)
        for name in document.keys() - {"analysis"}:
            assert page.locator(f'[data-pointer^="#/{name}"]').count(), (analysis, name)
        page.get_by_text("Samples", exact=True).wait_for()
        assert page.locator(".problems li, .problem:not(:empty)").count() == 0, analysis
        choices = "all => all.map((select) => [...select.options].map((option) => option.text))"
        for labels in page.locator("select").evaluate_all(choices):
            assert len({*labels}) == len(labels), (analysis, labels)
        edit.click()
        assert json.loads(page.get_by_label("Job document").input_value()) == document, analysis
        edit.click()


def test_what_stands_around_is_edited_before_ones_eyes(watched: Watched, client: ws.Client) -> None:
    """A box that is added in the form is seen, larger when its edges grow; the job that is submitted has it."""
    page = watched.page
    page.goto(watched.url + "/#/new")
    page.locator('[data-pointer="#/robot"]').first.select_option(label="scara")
    stage = page.locator(".preview-host")
    stage.locator("canvas").first.wait_for()
    page.get_by_label("Environment", exact=True).check()
    page.get_by_role("button", name="Add to items").click()
    page.locator('[data-pointer="#/environment/items/0"]').select_option(label="Box …")

    def tan() -> int:
        """Pixels in the colour of what stands around."""
        red, green, blue = np.moveaxis(decoded(stage.screenshot()).astype(int), 2, 0)
        return int(((red > green + 10) & (green > blue + 15) & (red > 90)).sum())

    assert tan() < 20
    sizes = []
    for edge in (0.3, 0.6):
        for field, values in (("size_m", [edge] * 3), ("position_m", [0, 1.2, 0])):
            cells = page.locator(f'[data-pointer="#/environment/items/0/{field}"] input')
            for cell, value in zip(cells.all(), values, strict=True):
                cell.fill(str(value))
        with page.expect_response("**/v1/robots:view"):
            pass
        until(lambda: tan() > (sizes[-1] if sizes else 0) + 100)
        sizes.append(tan())
    page.locator('[data-pointer="#/voxel_size_m"]').fill("0.1")
    page.get_by_role("button", name="Submit").click()
    page.locator("tr[data-job]").first.wait_for()
    (item,) = next(iter(client.jobs())).result().document["job"]["environment"]["items"]
    assert (item["shape"], item["size_m"], item["position_m"]) == ("box", [0.6] * 3, [0, 1.2, 0])


def test_whole_numbers_keep_their_digits(watched: Watched, client: ws.Client) -> None:
    """Beyond 2^53 they are no numbers of JavaScript's: in the editor, in the form, and in a job that was dragged."""
    page, seeds = watched.page, [2**53 + 1, 2**63 - 1]

    def editor() -> Any:
        page.get_by_role("button", name="Edit as JSON").click()
        return page.get_by_label("Job document")

    def submitted() -> tuple[ws.client.Job, ws.Result]:
        page.get_by_text("Samples", exact=True).wait_for()
        with page.expect_response(lambda answer: answer.url.endswith("/v1/jobs") and answer.status == 202) as answer:
            page.get_by_role("button", name="Submit", exact=True).click()
        job = client.job(answer.value.json()["id"])
        return job, job.result()

    page.goto(watched.url + "/#/new")
    document = JOB | {"voxel_size_m": 0.2, "sampling": {"method": "sobol", "count": 1 << 10, "seed": seeds[0]}}
    editor().fill(json.dumps(document))
    page.get_by_role("button", name="Edit as JSON").click()
    seed = page.locator('[data-pointer="#/sampling/seed"]')
    assert seed.input_value() == str(seeds[0])
    job, result = submitted()
    assert result.document["job"]["sampling"]["seed"] == seeds[0]
    opened(watched, f"/job/{job.id}", limits=[{"joint2": [-1.5, 0.0]}])
    page.get_by_role("button", name="Submit as a job").click()
    seed.wait_for()
    assert seed.input_value() == str(seeds[0])
    seed.fill(str(seeds[1]))
    assert page.locator('.field:has([data-pointer="#/sampling/seed"]) .problem').count() == 0
    assert json.loads(editor().input_value())["sampling"]["seed"] == seeds[1]
    _, result = submitted()
    assert result.document["job"]["sampling"]["seed"] == seeds[1]


def test_slices_threshold_and_range_change_the_picture(watched: Watched, finished: str) -> None:
    opened(watched, f"/job/{finished}")
    page, first = watched.page, pixels(watched)
    page.get_by_label("Style").select_option("isosurface")
    threshold = page.get_by_label("Threshold [m³], as a number")
    few = pixels(watched)
    threshold.fill(str(float(threshold.input_value()) * 1.5))
    threshold.press("Enter")
    fewer = pixels(watched)
    assert differing(first, few) > 500
    assert differing(few, fewer) > 500
    page.get_by_label("Style").select_option("surface")
    again = pixels(watched)
    assert differing(first, again) < 50
    page.get_by_label("Upper end of the range").fill("0.05")
    assert differing(again, pixels(watched)) > 1000
    page.get_by_role("button", name="Slices").click()
    page.get_by_role("button", name="Add a slice").click()
    page.get_by_label("Show Volume").uncheck()
    sliced = pixels(watched)
    place = page.get_by_label("Slice 1, place [m], as a number")
    place.fill("0.3")
    place.press("Enter")
    assert differing(sliced, pixels(watched)) > 200


def test_values_of_a_clicked_voxel_are_the_files(watched: Watched, client: ws.Client, finished: str) -> None:
    opened(watched, f"/job/{finished}")
    cell, values = clicked(watched)
    volume = client.job(finished).result().volume
    assert volume is not None
    number = int(np.ravel_multi_index(cell, volume.shape))
    at = int(np.searchsorted(volume.voxels.cells, number))
    assert volume.voxels.cells[at] == number
    assert values["maximum:manipulability"] == volume.voxels.statistics["maximum"]["manipulability"][at]


def test_the_volume_that_follows_a_limit_is_a_jobs(
    watched: Watched, client: ws.Client, finished: str, narrower: str
) -> None:
    opened(watched, f"/job/{finished}")
    page = watched.page
    page.get_by_text("Change limits").click()
    for label, value in (("Upper", 0.0), ("Lower", np.rad2deg(-1.5))):
        field = page.get_by_label(f"{label} limit of joint2 [°], as a number")
        field.fill(repr(float(value)))
        field.press("Enter")
    volume = client.job(narrower).result().volume
    assert volume is not None
    expected = len(volume.voxels.cells) * float(volume.voxel_size_m) ** 3
    page.locator(f"[data-live=done][data-volume='{expected!r}']").wait_for()
    page.get_by_role("button", name="Submit as a job").click()
    page.get_by_label("Analysis").wait_for()
    page.get_by_role("button", name="Edit as JSON").click()
    written = json.loads(page.get_by_label("Job document").input_value())
    assert written["robot"]["limits"] == {"joint2": pytest.approx([-1.5, 0.0], abs=1e-12)}
    assert written["refined_volume"] is None


def test_the_volume_follows_tool_and_base_and_is_that_of_the_job_they_make(
    watched: Watched, client: ws.Client, finished: str
) -> None:
    """What the page submits as a job has the voxels that were shown; it names tool and placement."""
    opened(watched, f"/job/{finished}")
    page = watched.page
    page.get_by_text("Change limits").click()
    for label, value in (("Tool z [m]", 0.2), ("Base x [m]", 0.35)):
        field = page.get_by_label(f"{label}, as a number")
        field.fill(repr(value))
        field.press("Enter")
    page.get_by_role("button", name="Submit as a job").wait_for()
    done = page.locator("[data-live=done][data-volume]")
    done.wait_for()
    settle(watched)
    seen = float(done.get_attribute("data-volume"))
    page.get_by_role("button", name="Submit as a job").click()
    page.get_by_role("button", name="Edit as JSON").click()
    written = json.loads(page.get_by_label("Job document").input_value())
    arm = ws.load_robot("ur5e")
    as_written = ws.load_robot("ur5e", tool=written["robot"]["tool"]).placed(
        ws.Transform(**written["robot"]["placement"])
    )
    T = arm.forward_kinematics([0.1] * 6)[0] @ np.diag([1.0, 1, 1, 1])
    expected = T[:3, 3] + 0.2 * T[:3, 2] + [0.35, 0, 0]
    assert np.abs(as_written.forward_kinematics([0.1] * 6)[0, :3, 3] - expected).max() < 1e-9
    as_many = written | {"sampling": NARROW["sampling"]}  # as follow a slider
    page.get_by_label("Job document").fill(json.dumps(as_many))
    page.get_by_text("Samples", exact=True).wait_for()
    with page.expect_response(lambda answer: answer.url.endswith("/v1/jobs") and answer.status == 202) as answer:
        page.get_by_role("button", name="Submit", exact=True).click()
    volume = client.job(answer.value.json()["id"]).result().volume
    assert volume is not None and seen == len(volume.voxels.cells) * float(volume.voxel_size_m) ** 3


def test_the_indices_of_a_configuration_are_the_librarys(watched: Watched, finished: str) -> None:
    q = [0.3, -1.4, 1.6, -0.4, 1.1, 0.2]
    opened(watched, f"/job/{finished}", configurations=[q])
    page = watched.page
    page.get_by_label("Joint joint6 [°], as a number").fill("20")
    page.get_by_label("Joint joint6 [°], as a number").press("Enter")
    page.get_by_text("Indices of this configuration").click()
    shown = page.locator("dt:has-text('anipulability [m³]') + dd").last.inner_text()
    known = ws.indices_at("ur5e", [[*q[:5], np.deg2rad(20)]], indices=["manipulability"])
    assert float(shown) == pytest.approx(float(known.map.indices["manipulability"][0]), rel=1e-4)


ENDLESS = JOB | {"sampling": {"method": "sobol", "count": 10**10}}


def test_jobs_are_filtered_canceled_retried_and_deleted(watched: Watched, client: ws.Client, finished: str) -> None:
    """A long one is watched as it goes on; what is deleted is gone from the server too."""
    long = ENDLESS | {"robot": {"library": "scara"}, "labels": {"of": "the-long-one"}}
    job, page = client.submit(long), watched.page
    short = job.id[:8]
    page.goto(watched.url)
    row = page.locator(f"tr[data-job='{job.id}']")
    row.locator("progress").wait_for()
    other = page.locator(f"tr[data-job='{finished}']")
    other.wait_for()
    for each, robots in ((row, "scara"), (other, "ur5e")):
        each.get_by_text(robots, exact=True).wait_for()
    for filter_, choose, shown in (
        ("State", lambda each: each.select_option("succeeded"), (False, True)),
        ("State", lambda each: each.select_option(""), (True, True)),
        ("Label", lambda each: each.fill("of=the-long-one"), (True, False)),
        ("Label", lambda each: each.fill(""), (True, True)),
        ("Robot", lambda each: each.fill("CAR"), (True, False)),
        ("Robot", lambda each: each.fill("r5"), (False, True)),
        ("Robot", lambda each: each.fill(""), (True, True)),
        ("Analysis", lambda each: each.select_option("postures"), (False, False)),
        ("Analysis", lambda each: each.select_option(""), (True, True)),
    ):
        choose(
            page.locator(".jobs > .bar label").filter(has_text=re.compile(rf"^\s*{filter_}\b")).locator("select, input")
        )
        for each, is_shown in zip((row, other), shown, strict=True):
            each.wait_for(state="visible" if is_shown else "detached")
    state = page.locator(f"tr[data-job='{job.id}'][data-state=canceled]")
    page.get_by_role("button", name=f"Cancel job {short}").click()
    state.wait_for()
    page.get_by_role("button", name=f"Retry job {short}").click()
    page.get_by_role("button", name=f"Cancel job {short}").click()
    until(lambda: client.job(job.id).state == "canceled")
    state.wait_for()
    page.get_by_role("button", name=f"Delete job {short}").click()
    page.get_by_role("button", name=f"Really delete job {short}").click()
    row.wait_for(state="detached")
    assert job.id not in [each.id for each in client.jobs()]


# Records in `seen` the states that a row is shown in.
WATCH = """(id) => {
  const root = document.querySelector("#wsrender").shadowRoot;
  window.seen = [];
  new MutationObserver(() => {
    const state = root.querySelector(`tr[data-job='${id}']`)?.dataset.state;
    if (state && state !== seen.at(-1)) seen.push(state);
  }).observe(root, {subtree: true, childList: true, characterData: true, attributes: true});
}"""


def test_a_job_that_is_retried_is_not_shown_in_its_past_states(watched: Watched, client: ws.Client) -> None:
    """Its events are followed from where the list is, not from the job's first one."""
    job, page, asked = client.submit(ENDLESS), watched.page, []
    page.on("request", lambda each: asked.append((each.url, each.headers.get("last-event-id"))))
    page.goto(watched.url)
    row = page.locator(f"tr[data-job='{job.id}']")
    row.locator("progress").wait_for()
    job.cancel()
    canceled = page.locator(f"tr[data-job='{job.id}'][data-state=canceled]")
    canceled.wait_for()
    known = client.job(job.id).record["last_event"]
    page.evaluate(WATCH, job.id)
    asked.clear()
    page.get_by_role("button", name=f"Retry job {job.id[:8]}").click()
    row.locator("progress").wait_for()
    page.wait_for_timeout(500)
    seen = page.evaluate("seen")
    assert seen[-1] == "running" and set(seen[:-1]) <= {"queued"}, seen
    after = [int(number) for url, number in asked if url.endswith(f"{job.id}/events")]
    assert after and min(after) > known
    page.get_by_role("button", name=f"Cancel job {job.id[:8]}").click()
    canceled.wait_for()


def test_an_answer_that_an_event_has_overtaken_takes_nothing_back(watched: Watched, client: ws.Client) -> None:
    """The list is asked for, the job ends, and only then the list comes, as it was."""
    job, page, held = client.submit(ENDLESS), watched.page, []
    page.goto(watched.url)
    page.locator(f"tr[data-job='{job.id}'] progress").wait_for()
    page.route("**/v1/jobs?*", lambda route: route.continue_() if held else held.append((route, route.fetch())))
    while not held:
        page.wait_for_timeout(50)
    job.cancel()
    page.locator(f"tr[data-job='{job.id}'][data-state=canceled]").wait_for()
    page.evaluate(WATCH, job.id)
    ((route, answer),) = held
    assert next(each for each in answer.json()["items"] if each["id"] == job.id)["state"] == "running"
    route.fulfill(response=answer)
    page.wait_for_timeout(500)
    assert set(page.evaluate("seen")) <= {"canceled"}
    page.unroute_all()


def test_the_list_is_that_of_the_filters_that_were_chosen_last(
    watched: Watched, client: ws.Client, finished: str
) -> None:
    """An answer to the filters before comes after theirs, and is not shown."""
    page, held = watched.page, []
    page.goto(watched.url)
    row = page.locator(f"tr[data-job='{finished}']")
    row.wait_for()
    page.route("**/v1/jobs?*robot=r5*", lambda route: held.append((route, route.fetch())))
    field = page.get_by_label("Robot", exact=True)
    field.fill("r5")
    until(lambda: page.wait_for_timeout(50) or bool(held))
    field.fill("nobody")
    page.get_by_text("No jobs like that").wait_for()
    for route, answer in held:
        assert finished in [each["id"] for each in answer.json()["items"]]
        route.fulfill(response=answer)
    page.wait_for_timeout(500)
    assert row.count() == 0
    page.unroute_all()


def test_a_link_restores_the_view(watched: Watched, finished: str) -> None:
    opened(watched, f"/job/{finished}")
    page = watched.page
    page.get_by_label("Colour map").select_option("magma")
    page.get_by_label("Style").select_option("cells")
    page.get_by_label("Joint joint2 [°], as a number").fill("-60")
    page.get_by_label("Joint joint2 [°], as a number").press("Enter")
    box = page.locator(".stage-host").bounding_box()
    page.mouse.move(box["x"] + 300, box["y"] + 300)
    page.mouse.down()
    page.mouse.move(box["x"] + 380, box["y"] + 330, steps=4)
    page.mouse.up()
    seen = pixels(watched)
    link_holds_the_view(page)
    link = page.url
    assert "view=" in link
    page.goto("about:blank")
    page.goto(link)
    page.get_by_role("button", name="Show all").wait_for()
    settle(watched)
    assert page.get_by_label("Colour map").input_value() == "magma"
    assert page.get_by_label("Joint joint2 [°], as a number").input_value() == "-60"
    assert differing(seen, pixels(watched)) < 100


def test_a_link_of_an_older_page_begins_with_todays_settings_where_it_says_nothing(
    watched: Watched, finished: str
) -> None:
    range_ = {"low": None, "high": 0.05}
    opened(watched, f"/job/{finished}", volumes={"volume": {"style": "cells"}}, range=range_, configurations=[[1.0]])
    page = watched.page
    assert page.get_by_label("Style").input_value() == "cells"
    assert page.get_by_label("Upper end of the range").input_value() == "0.05"
    assert page.get_by_label("Leave out outliers").is_checked()
    assert page.get_by_label("Show Volume", exact=True).is_checked()
    assert page.get_by_label("Joint joint6 [°], as a number").input_value() == "0"


def test_a_link_restores_the_look_of_a_volume_that_follows_limits(watched: Watched, finished: str) -> None:
    opened(watched, f"/job/{finished}", limits=[{"joint2": [-1.5, 0.0]}])
    page, done = watched.page, watched.page.locator("[data-live=done][data-volume]")
    done.wait_for()
    page.get_by_label("Style").select_option("cells")
    page.get_by_label("Show Volume", exact=True).check()
    relink(watched)
    done.wait_for()
    assert page.get_by_label("Style").input_value() == "cells"
    assert page.get_by_label("Show Volume", exact=True).is_checked()


def test_a_link_to_two_results_restores_both_and_their_difference(
    watched: Watched, finished: str, narrower: str
) -> None:
    opened(watched, f"/compare/{finished}/{narrower}")
    page, subtracted = watched.page, watched.page.get_by_text("the first minus the second")
    assert [title.split()[0] for title in page.locator("h1").all_text_contents()] == [finished[:8], narrower[:8]]
    second = page.locator(".viewer").nth(1)
    page.get_by_role("button", name="Difference, on the left").click()
    subtracted.wait_for()
    second.get_by_role("button", name="Look").click()
    second.get_by_label("Style").select_option("cells")
    second.get_by_role("button", name="Look").click()
    seen = pixels(watched)
    second.get_by_role("button", name="Link").click()
    page.get_by_text("The link is", exact=False).first.wait_for()
    relink(watched)
    subtracted.wait_for()
    assert differing(seen, pixels(watched)) < 100
    second.get_by_role("button", name="Look").click()
    assert second.get_by_label("Style").input_value() == "cells"


def test_the_difference_of_two_results_is_that_of_their_numbers(
    watched: Watched, client: ws.Client, finished: str, narrower: str
) -> None:
    """Colours of at least 30 voxels in the plane of a cut, against the values of both files."""
    first, second = (client.job(each).result().volume for each in (finished, narrower))
    assert first is not None and second is not None
    size, half = first.voxel_size_m, 1.2
    known = {}
    for volume in (first, second):
        cells = np.stack(np.unravel_index(volume.voxels.cells, volume.shape), axis=1) + volume.first_voxel
        values = volume.voxels.statistics["maximum"]["manipulability"].tolist()
        known[id(volume)] = dict(zip(map(tuple, cells.tolist()), values, strict=True))
    a, b = known.values()
    difference = {cell: a[cell] - b[cell] for cell in a if cell in b}
    most = max(map(abs, difference.values()))
    cut = {"style": "cells", "cut": [{"axis": "y", "from_m": 0.0, "to_m": None}]}
    whole = {"low": None, "high": None, "scale": "linear", "clipped": False}
    off = {"visible": False, "opacity": 1}
    opened(watched, f"/compare/{finished}/{narrower}", camera=looking([0, 0, 0.2], half), volumes={"volume": cut},
           range=whole, layers={"robot:0": off, "axes": off, "scale_bar": off})  # fmt: skip
    watched.page.get_by_role("button", name="Difference, on the left").click()
    watched.page.get_by_text("the first minus the second").wait_for()
    picture, box = pixels(watched), watched.page.locator(".stage-host").first.bounding_box()
    seen = 0
    for (x, y, z), value in difference.items():
        if y != 0:
            continue
        ((column, row),) = spots(watched, [[(x + 0.5) * size, 0, (z + 0.5) * size]], [0, 0, 0.2], half)
        column, row = int(column - box["x"]), int(row - box["y"])
        if not (0 <= column < box["width"] and 80 < row < box["height"]):  # below the colour bar
            continue
        expected = mpl.colormaps["coolwarm"](0.5 + value / (2 * most), bytes=True)[:3]
        assert np.abs(picture[row, column] - np.array(expected, int)).max() <= 3, (x, y, z)
        seen += 1
    assert seen >= 30 and len({round(each, 4) for each in difference.values()}) > 10


def test_two_results_turn_together(watched: Watched, finished: str, narrower: str) -> None:
    opened(watched, f"/compare/{finished}/{narrower}")
    page, views = watched.page, watched.page.locator(".stage-host")
    bars = [decoded(views.nth(k).screenshot())[-30:, :200].max(axis=2) < 120 for k in range(2)]
    left, right = (int(bar.sum(axis=1).max()) for bar in bars)
    assert left > 50 and abs(left - right) <= 2  # the scale bars: one camera from the first
    before = views.nth(1).screenshot()
    box = views.nth(0).bounding_box()
    page.mouse.move(box["x"] + 200, box["y"] + 200)
    page.mouse.down()
    page.mouse.move(box["x"] + 290, box["y"] + 200, steps=4)
    page.mouse.up()
    settle(watched)
    assert views.nth(1).screenshot() != before
    page.get_by_role("button", name="Difference, on the left").click()
    page.get_by_text("the first minus the second").wait_for()


def test_a_picture_has_the_size_that_is_asked_for(watched: Watched, finished: str, tmp_path: Path) -> None:
    opened(watched, f"/job/{finished}")
    page = watched.page
    page.get_by_role("button", name="Picture").click()
    page.get_by_label("Width").fill("1600")
    page.get_by_label("Height").fill("900")
    with page.expect_download() as download:
        page.get_by_role("button", name="Save").click()
    download.value.save_as(tmp_path / "view.png")
    picture = decoded((tmp_path / "view.png").read_bytes())
    assert picture.shape == (900, 1600, 3)
    assert len(np.unique(picture[::9, ::9].reshape(-1, 3), axis=0)) > 50


def test_the_page_is_used_by_keyboard_alone(watched: Watched, finished: str) -> None:
    page = watched.page
    page.goto(watched.url + "/")
    page.locator(f"tr[data-job='{finished}']").wait_for()
    focused = "document.querySelector('#wsrender').shadowRoot.activeElement?.getAttribute('aria-label')"
    for _ in range(80):
        page.keyboard.press("Tab")
        if page.evaluate(focused) == f"View job {finished[:8]}":
            break
    else:
        raise AssertionError("the button that shows the result is not reached")
    page.keyboard.press("Enter")
    page.get_by_role("button", name="Show all").wait_for()
    settle(watched)
    before = pixels(watched)
    page.get_by_label("Joint joint1 [°]", exact=True).focus()
    value = page.get_by_label("Joint joint1 [°]", exact=True).input_value()
    for _ in range(20):
        page.keyboard.press("ArrowRight")
    assert page.get_by_label("Joint joint1 [°]", exact=True).input_value() != value
    page.locator("canvas[tabindex]").focus()
    for _ in range(4):
        page.keyboard.press("ArrowLeft")
    assert differing(before, pixels(watched)) > 500


TABLET = {"color_scheme": "dark", "reduced_motion": "reduce", "viewport": {"width": 1024, "height": 768}}


@pytest.mark.parametrize("place", ["/jobs", "/new", "job"])
@pytest.mark.parametrize("watched", [{"color_scheme": "light"}, TABLET], indirect=True)
def test_axe_finds_no_serious_fault(watched: Watched, finished: str, place: str) -> None:
    page = watched.page
    if place == "job":
        opened(watched, f"/job/{finished}")
        if page.viewport_size["width"] < 1100:
            page.get_by_role("button", name="Explore").click()
    else:
        page.goto(f"{watched.url}/#{place}")
        page.locator("table, .submit").first.wait_for()
    assert serious_faults(page) == []


SCREENS = {"telephone": (390, 844), "tablet": (820, 1180), "tablet lying": (1024, 768), "desk": (1280, 720)}
SIZES = [{"viewport": {"width": width, "height": height}} for width, height in SCREENS.values()]


@pytest.mark.parametrize("watched", SIZES, indirect=True, ids=SCREENS)
def test_on_every_screen_all_is_within_reach(watched: Watched, finished: str, narrower: str) -> None:
    """Every button of the bars stands within the screen, and the panels open there."""
    page, wide = watched.page, watched.page.viewport_size["width"]
    for place in ("/", "/new", f"/job/{finished}", f"/compare/{finished}/{narrower}"):
        page.goto(f"{watched.url}/#{place}")
        bar = page.get_by_role(
            "button", name="Show all" if finished in place else "New job" if place == "/" else "Submit"
        )
        bar.first.wait_for()
        assert page.evaluate("document.documentElement.scrollWidth") <= wide
        if place == "/":
            page.locator(f"tr[data-job='{finished}']").wait_for()
        for each in page.locator(".top a, .top button, .top select, .viewer .bar button, .jobs .actions button").all():
            box = each.bounding_box()
            assert box["x"] >= 0 and box["x"] + box["width"] <= wide, (place, each.inner_text())
    opened(watched, f"/job/{finished}")
    for name, panel in (("Look", "What it looks like"), ("Explore", "Explore")):
        button = page.get_by_role("button", name=name, exact=True)
        if button.get_attribute("aria-expanded") == "false":
            button.click()
        box = page.get_by_role("group", name=panel).bounding_box()
        assert box["x"] >= 0 and box["x"] + box["width"] <= wide
        button.click()


def test_a_job_that_failed_says_why_in_the_list(watched: Watched, client: ws.Client) -> None:
    floor = {"items": [{"shape": "box", "name": "block", "size_m": [1, 1, 1], "position_m": [0, 0, 0]}]}
    job = client.submit(JOB | {"environment": floor}).wait()
    assert job.state == "failed"
    watched.page.goto(watched.url)
    row = watched.page.locator(f"tr[data-job='{job.id}']")
    why = job.record["error"]["detail"]
    row.get_by_text(why).wait_for()
    assert "block" in why


def test_names_are_text(watched: Watched, client: ws.Client) -> None:
    name = "<img src=x onerror=alert(1)>"
    rows = [{"a": 0.4, "limits": [-2, 2], "name": f"{name}{k}"} for k in range(3)]
    robot = {"dh": {"convention": "standard", "rows": rows, "name": name}}
    job = client.submit({**JOB, "robot": robot, "voxel_size_m": 0.2}, labels={"study": name})
    page = watched.page
    page.goto(watched.url + "/")
    page.locator(f"tr[data-job='{job.id}']").get_by_text(f"study={name}").wait_for()
    job.wait()
    opened(watched, f"/job/{job.id}")
    assert name in page.get_by_role("heading", level=1).inner_text()
    page.get_by_label(f"Show {name}", exact=True).wait_for()
    page.get_by_label(f"Joint {name}0 [°]", exact=True).wait_for()
    assert page.locator("img").count() == 0
