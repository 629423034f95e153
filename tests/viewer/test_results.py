"""Results of the analyses in the page: every part of a view is drawn, lines and arrows where the result has them."""

import numpy as np
import pytest
from scipy import ndimage

import wsrender as ws
from tests.contracts.conftest import result_of
from tests.golden.files import golden_names
from tests.viewer.watched import JOB, Watched, differing, opened, pixels, relink, spots, until
from tests.viewer.written import HEIGHT, OFF, WIDTH, decoded, looking
from tests.viewer.written import pixels as places_of
from wsrender.results.view import view_of
from wsrender.results.view.interactive import Interactive

ON = {"visible": True, "opacity": 1}
LISTS = ("meshes", "points", "glyphs", "curves", "maps", "skeletons")


@pytest.mark.parametrize("name", golden_names())
def test_every_part_of_a_view_is_seen(views, name):
    """Of each golden result: each volume, robot and layer alone changes the picture, and without them it is empty."""
    view = view_of(result_of(name))
    shown = view.manifest
    layers = [f"robot:{k}" for k in range(len(shown["robots"]))] + [
        each["name"] for key in LISTS for each in shown[key]
    ]
    volumes = [each["name"] for each in shown["volumes"]]
    nothing = {"layers": dict.fromkeys([*layers, "axes", "scale_bar", "frames"], OFF)}
    nothing["volumes"] = {volume: {"visible": False, "cut": []} for volume in volumes}
    views.show(shown, dict(view.blobs), **nothing)
    below = slice(90, None)  # colour bars
    empty = views.picture()[below]
    assert (empty == 255).all()
    for layer in layers:
        views.change(layers={layer: ON})
        views.until("stage.info.idle")
        seen = int((views.picture()[below] != empty).any(axis=2).sum())
        assert seen > 12, (layer, seen)
        views.change(layers={layer: OFF})
    for volume in volumes:
        views.change(volumes={volume: {"visible": True}})
        seen = int((views.picture()[below] != empty).any(axis=2).sum())
        assert seen > 30, (volume, seen)
        views.change(volumes={volume: {"visible": False}})
    assert views.told("problem") == []


def near_segments(starts, ends):
    """How far each pixel's middle is from the nearest of segments (N, 2) to (N, 2), (HEIGHT, WIDTH)."""
    y, x = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    nearest = np.full((HEIGHT, WIDTH), np.inf)
    for (u, v), (p, q) in zip(starts, ends, strict=True):
        du, dv = p - u, q - v
        t = np.clip(((x - u) * du + (y - v) * dv) / max(du * du + dv * dv, 1e-12), 0, 1)
        nearest = np.minimum(nearest, np.hypot(x - u - t * du, y - v - t * dv))
    return nearest


def test_arrows_of_approach_stand_at_their_voxels_along_the_directions_that_are_reached(views):
    """Seen along y: blue from each voxel's centre on, nothing where no arrow of the map can be."""
    job = {"analysis": "capability", "robot": {"library": "ur5e"}, "voxel_size_m": 0.5, "directions": 6}
    result = ws.execute(job | {"angle_tolerance_rad": 0.6, "device": "cpu"})
    cells, directions = result.tables["capability"], result.tables["directions"]["direction"]
    reached = np.unpackbits(cells["direction_bits"].astype(np.uint8), axis=1, count=len(directions)).astype(bool)
    voxel, which = np.nonzero(reached)
    assert len(voxel) >= 4 and not reached.all()
    origin, along = cells["position"][voxel], directions[which]
    view = view_of(result)
    (arrows,) = view.manifest["glyphs"]
    layers = [f"robot:{k}" for k in range(len(view.manifest["robots"]))]
    layers += [each["name"] for key in LISTS for each in view.manifest[key] if each is not arrows]
    target, half = origin.mean(axis=0), 1.3 * np.ptp(origin, axis=0).max()
    views.show(view.manifest, dict(view.blobs), camera=looking(target, half),
               layers=dict.fromkeys([*layers, "axes", "scale_bar"], OFF),
               volumes={each["name"]: {"visible": False} for each in view.manifest["volumes"]})  # fmt: skip
    red, _, blue = np.moveaxis(views.picture(), 2, 0)
    drawn, arrow = blue > red + 40, 0.12 * half  # drawn ones are about as long

    def at(share):
        return places_of(origin + share * arrow * along, target, half)

    lengths = np.linalg.norm(at(1.0) - at(0.0), axis=1)
    seen = lengths > 4  # not along the eye's own way
    assert seen.sum() > 3
    for share in (0.1, 0.3):
        column, row = np.floor(at(share)[seen]).astype(int).T
        assert ndimage.binary_dilation(drawn)[row, column].all()
    assert not drawn[near_segments(at(0.0), at(6.0)) > 8].any()
    assert drawn.sum() > 20


def test_a_planar_boundary_is_drawn_where_it_is(watched: Watched, client: ws.Client) -> None:
    """Of an arm of two links without limits: the circles of the sum and of the difference of their lengths."""
    rows = [{"a": a, "limits": [-np.pi, np.pi]} for a in (0.4, 0.3)]
    robot = {"dh": {"convention": "standard", "name": "two_links", "rows": rows}}
    done = client.submit({"analysis": "planar_boundary", "robot": robot, "device": "cpu"}).wait()
    half = 0.9
    hidden = dict.fromkeys(["robot:0", "axes", "scale_bar"], OFF)
    opened(watched, f"/job/{done.id}", camera=looking([0, 0, 0], half, along="z"), layers=hidden)
    picture, box = pixels(watched), watched.page.locator(".stage-host").bounding_box()
    red, _, blue = np.moveaxis(picture, 2, 0)
    line = blue > red + 60
    turn = np.linspace(0, 2 * np.pi, 90, endpoint=False)
    for radius, drawn in ((0.7, True), (0.1, True), (0.66, False), (0.74, False), (0.4, False), (0.14, False)):
        circle = radius * np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
        columns, rows = (
            np.floor(spots(watched, circle, [0, 0, 0], half, along="z") - [box["x"], box["y"]]).astype(int).T
        )
        near = [
            line[row - 1 : row + 2, column - 1 : column + 2].any() for row, column in zip(rows, columns, strict=True)
        ]
        assert all(near) if drawn else not any(near), radius


@pytest.fixture(scope="module")
def converged(client) -> ws.client.Job:
    """A job whose sampling converges."""
    sampling = {"method": "converge", "index": "manipulability", "start": 3, "step": 1, "tolerance": 3e-3}
    job = JOB | {"robot": {"library": "puma560"}, "sampling": sampling}
    return client.submit(job).wait()


def test_a_point_of_a_convergence_curve_shows_the_volume_of_its_samples(watched: Watched, converged) -> None:
    """Computed by the engine, marked on the curve, kept by a link, and left again for that of the result."""
    document = converged.result().document
    grids = document["convergence"]
    assert len(grids) >= 3
    opened(watched, f"/job/{converged.id}")
    page, live = watched.page, watched.page.locator("[data-live]")
    over, steps = page.locator(".plot .u-over"), page.locator("label:has-text('Volume of') select")
    page.locator("label:has-text('Plot') select").select_option(label="Convergence")
    labels = ["the result", *(f"{each['samples']:,} samples" for each in grids)]
    assert steps.locator("option").all_inner_texts() == labels

    def marked() -> list[float]:
        """Where the curve is marked, as shares of its width."""
        page.wait_for_timeout(200)
        red, green, blue = np.moveaxis(decoded(over.screenshot()), 2, 0)
        return (np.flatnonzero(((red > 150) & (green < 140) & (blue < 90)).mean(axis=0) > 0.6) / red.shape[1]).tolist()

    engine = Interactive(document["job"], [ws.load_robot("puma560")])
    asked = {"ask": "volume", "index": "manipulability", "statistic": "maximum", "voxel_size_m": 0.1}
    over.scroll_into_view_if_needed()
    assert marked() == []
    places, volumes = [], set()
    for share, grid in ((0.01, grids[0]), (0.99, grids[-1])):
        over.click(position={"x": share * over.bounding_box()["width"], "y": 20})
        expected = engine.answer(asked | {"samples": grid["samples"]})[0]["volume_m3"]
        until(lambda expected=expected: float(live.get_attribute("data-volume") or 0) == pytest.approx(expected))
        assert steps.input_value() == str(grid["samples"])
        page.get_by_label(f"Show Of {grid['samples']:,} samples", exact=True).wait_for()
        assert not page.get_by_label("Show Volume", exact=True).is_checked()
        places.append(np.mean(marked()))
        volumes.add(expected)
    assert len(volumes) == 2 and places[0] < places[1]
    assert page.locator("button", has_text="Submit as a job").is_disabled()  # nothing was dragged
    seen = pixels(watched)
    relink(watched)
    page.locator("label:has-text('Plot') select").select_option(label="Convergence")
    until(lambda: steps.input_value() == str(grids[-1]["samples"]))
    page.get_by_label(f"Show Of {grids[-1]['samples']:,} samples", exact=True).wait_for()
    assert differing(seen, pixels(watched)) < 100
    steps.select_option("")
    until(lambda: page.get_by_label("Show Volume", exact=True).is_checked())
    assert marked() == []


def test_a_point_of_the_curve_over_scales_is_the_scale_of_the_mapping(watched: Watched, client: ws.Client) -> None:
    """Three scales keep their shares: their geometric mean is the curve's."""
    unit = np.stack(np.meshgrid(*[np.linspace(-0.5, 0.5, 6)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    job = {"analysis": "master_slave_mapping", "master": {"points": (unit * [1.0, 0.8, 0.6]).tolist()}}
    job |= {"slave": {"points": (0.2 * unit).tolist()}, "search": {"scale": [0.5, 4.5], "steps": 9}}
    done = client.submit(job).wait()
    table = done.result().tables["scales"]
    opened(watched, f"/job/{done.id}")
    page, over = watched.page, watched.page.locator(".plot .u-over")
    over.scroll_into_view_if_needed()

    def scales() -> np.ndarray:
        return np.array([float(page.get_by_label(f"Scale {k}, as a number").input_value()) for k in "xyz"])

    first = scales()
    for share, scale in ((0.01, table["scale"][0]), (0.99, table["scale"][-1])):
        before = pixels(watched)
        over.click(position={"x": share * over.bounding_box()["width"], "y": 20})
        until(lambda scale=scale: np.cbrt(scales().prod()) == pytest.approx(scale, rel=1e-3))
        np.testing.assert_allclose(scales() / scales()[0], first / first[0], rtol=2e-3)
        assert differing(before, pixels(watched)) > 200
