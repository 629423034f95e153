"""What the page draws, pixel by pixel, against numbers that are computed here."""

import base64
import re
from dataclasses import replace

import matplotlib as mpl
import numpy as np
import pytest

import wsrender as ws
from tests.viewer.written import HEIGHT, OFF, WIDTH, WRITTEN, Written, at, decoded, launch, looking, manifest, pixels
from wsrender.results.drawing.color_scale import color_scale
from wsrender.results.view import robot_view
from wsrender.results.view.robots import chain_entry
from wsrender.results.view.surfaces import ColoredMesh, glb
from wsrender.robots import library
from wsrender.robots.chain import Chain

SIZE, FIRST, SHAPE = 0.1, (-6, -5, -4), (12, 9, 10)
TARGET, HALF = np.array([0.0, 0.0, 0.1]), 0.75
ON = {"visible": True, "opacity": 1}
WHOLE = {"low": None, "high": None, "scale": "linear", "clipped": False}
LAYER = 4  # along y: the voxels from -0.1 to 0 m
SLICE = {"axis": "y", "at_m": SIZE * (FIRST[1] + LAYER + 0.5), "normal": [0, 0, 1], "visible": True}


def block(seed=0):
    """Values of a volume with holes, of several orders of magnitude."""
    rng = np.random.default_rng(seed)
    values = 10.0 ** rng.uniform(-2.0, 0.5, SHAPE)
    values[rng.random(SHAPE) < 0.15] = np.nan
    return values


def centers(layer=LAYER):
    """Of the voxels of a layer along y: indices (N, 3) and places (N, 3) [m]."""
    x, z = (each.ravel() for each in np.meshgrid(np.arange(SHAPE[0]), np.arange(SHAPE[2]), indexing="ij"))
    cells = np.stack([x, np.full_like(x, layer), z], axis=1)
    return cells, (cells + FIRST + 0.5) * SIZE


def viridis(t):
    return mpl.colormaps["viridis"](np.clip(t, 0.0, 1.0), bytes=True)[..., :3].astype(int)


def show_block(views, values, **patch):
    written = Written()
    shown = manifest(volumes=[written.volume("block", values, FIRST, SIZE)])
    volume = {"style": "cells"} | patch.pop("volume", {})
    given = {"volumes": {"block": volume}, "camera": looking(TARGET, HALF), "range": WHOLE} | patch
    views.show(shown, written.blobs, **given)


def seen(views, layer=LAYER):
    """Values and colours of a layer's voxel centres."""
    cells, places = centers(layer)
    return cells, at(views.picture(), pixels(places, TARGET, HALF))


@pytest.mark.parametrize("name", library.names())
def test_forward_kinematics_of_the_page(views, name):
    """Every library robot, with coupled and sliding joints, at 100 configurations, to a millionth of a metre."""
    robot = ws.load_robot(name)
    q = np.random.default_rng(3).uniform(-3.0, 3.0, (100, robot.chain.n))
    chain = chain_entry(robot, robot.chain, robot.chain.T_world_base)
    found = views.page.evaluate(
        """async ([chain, q]) => { const {tip} = await import("/viewer/viewer.js");
        return q.map(each => Array.from(tip(chain, each))); }""",
        [chain, q.tolist()],
    )
    assert np.abs(np.reshape(found, (-1, 4, 4)) - robot.forward_kinematics(q)).max() < 1e-6


def test_offsets_and_couplings_of_joints(views):
    """Of no library robot are they other than 0 and 1 all over; here every joint has its own."""
    rng = np.random.default_rng(8)
    chain = ws.load_robot("stanford_arm").chain.geometry
    assert isinstance(chain, Chain)
    count = len(chain.joint_source)
    changed = {"joint_scale": rng.uniform(-2, 2, count), "joint_offset": rng.uniform(-1, 1, count)}
    chain = replace(chain, joint_source=np.arange(count) // 2, **changed)
    q = rng.uniform(-2.0, 2.0, (20, 3))
    written = {"T_joint": chain.T_joint.reshape(-1, 16), "T_tip": (chain.T_tip @ chain.T_tip_tool).ravel(),
               "T_base": chain.T_world_base.ravel(), "revolute": chain.joint_is_revolute, "source": chain.joint_source,
               "scale": chain.joint_scale, "offset": chain.joint_offset}  # fmt: skip
    found = views.page.evaluate(
        """async ([chain, q]) => { const {tip} = await import("/viewer/viewer.js");
        return q.map(each => Array.from(tip(chain, each))); }""",
        [{name: values.tolist() for name, values in written.items()}, q.tolist()],
    )
    assert np.abs(np.reshape(found, (-1, 4, 4)) - chain.poses(q)).max() < 1e-12


def test_colours_of_voxels_are_exact(views):
    """On a slice and on a cut through the volume, at the centres of at least 100 voxels, to 1 of 255."""
    values = block()
    low, high = np.nanmin(values), np.nanmax(values)
    show_block(views, values, slices=[SLICE], volume={"visible": False})
    cells, colors = seen(views)
    expected = values[tuple(cells.T)]
    known = np.isfinite(expected)
    assert known.sum() >= 100 - 20
    assert np.abs(colors - viridis((expected - low) / (high - low)))[known].max() <= 1
    assert (colors[~known] == 255).all()
    # What is met behind a cut is a face of the voxel itself, drawn by the rays.
    cut = [{"axis": "y", "from_m": SIZE * (FIRST[1] + LAYER), "to_m": None}]
    views.change(slices=[], volumes={"block": {"visible": True, "cut": cut}})
    faces = seen(views)[1]
    assert np.abs(faces - viridis((expected - low) / (high - low)))[known].max() <= 1
    views.change(range=WHOLE | {"scale": "log"})
    log = (np.log10(expected) - np.log10(low)) / (np.log10(high) - np.log10(low))
    assert np.abs(seen(views)[1] - viridis(log))[known].max() <= 1
    views.change(range={"low": 0.5, "high": 1.5, "scale": "linear", "clipped": False})
    assert np.abs(seen(views)[1] - viridis(expected - 0.5))[known].max() <= 1


def test_slices_thresholds_and_cuts(views):
    """What is drawn of a slice changes as the numbers say."""
    values = block(1)
    show_block(views, values, slices=[SLICE], volume={"visible": False})
    least = float(np.nanmedian(values))
    views.change(volumes={"block": {"threshold": least}})
    cells, colors = seen(views)
    drawn = (colors != 255).any(axis=1)
    assert (drawn == (values[tuple(cells.T)] >= np.float32(least))).all()
    assert 20 < drawn.sum() < 80
    # Another place along y shows the voxels that stand there.
    views.change(volumes={"block": {"threshold": None}}, slices=[SLICE | {"at_m": SIZE * (FIRST[1] + 6.5)}])
    cells, colors = seen(views, 6)
    assert ((colors != 255).any(axis=1) == np.isfinite(values[tuple(cells.T)])).all()
    # An oblique plane through the x axis: where it cuts, seen along y, is told by z alone.
    tilted = {"axis": "oblique", "at_m": 0.0, "normal": [0, 1, -1], "visible": True}
    views.change(slices=[tilted])
    x = np.arange(SHAPE[0])
    for k in range(2, 8):
        z = (FIRST[2] + k + 0.5) * SIZE
        j = round(z / SIZE - FIRST[1] - 0.5)  # y = z
        cells = np.stack([x, np.full_like(x, j), np.full_like(x, k)], axis=1)
        places = (cells + FIRST + 0.5) * SIZE
        colors = at(views.picture(), pixels(places, TARGET, HALF))
        assert ((colors != 255).any(axis=1) == np.isfinite(values[:, j, k])).all()


@pytest.mark.parametrize("most", [2, 3, 7, 13, 20, 1000])
def test_the_bar_of_counts_has_whole_ticks(views, most):
    """On the picture; in every range and width, linear and logarithmic, but where no whole number lies in it."""
    values, written = np.resize(np.arange(1.0, most + 1), SHAPE), Written()
    views.show(manifest(volumes=[written.volume("block", values, FIRST, SIZE, whole=True)]), written.blobs)
    views.page.evaluate(WRITTEN)
    views.change(theme="dark")
    views.until("written.some(([, text]) => text === 'index [m]')")
    texts = views.page.evaluate("written.map(([, text]) => text)")
    numbers = {float(text) for text in texts if re.fullmatch(r"[\d.]+", text)}
    assert numbers and all(number.is_integer() for number in numbers)
    ticks = """([low, high, scale, count]) => page.scaleOf({label: "n", unit: "", whole: true}, [low, high], null,
      {low, high, scale, clipped: false}, "viridis").ticks(count)"""
    for low, high in ((1, most), (0, most), (-most, most), (0.5, most + 0.5), (most - 1, most)):
        for scale in ("linear", "log"):
            for count in (3, 5, 9):
                found = np.array(views.page.evaluate(ticks, [low, high, scale, count]))
                assert len(found) and (found == np.round(found)).all(), (low, high, scale, count, found)
    assert views.page.evaluate(ticks, [1.2, 1.8, "linear", 5]) == [1.2, 1.8]


def test_a_bar_has_two_ticks_at_least_within_its_range(views):
    """Round ones, in a linear range of whatever width, also on the narrow bars of a telephone."""
    ticks = """([low, high, count]) => page.scaleOf({label: "n", unit: ""}, [low, high], null,
      {low, high, scale: "linear", clipped: false}, "viridis").ticks(count)"""
    views.page.evaluate("async () => { window.page = await import('/viewer/viewer.js'); }")
    rng = np.random.default_rng(11)
    for low, width in zip(rng.uniform(-1, 1, 200), 10.0 ** rng.uniform(-3, 3, 200), strict=True):
        for count in (3, 5):
            found = np.array(views.page.evaluate(ticks, [low, low + width, count]))
            assert 2 <= len(found) <= 2 * count, (low, width, found)
            assert low - 1e-9 * width <= found[0] and found[-1] <= low + (1 + 1e-9) * width, (low, width, found)
            steps = np.diff(found)
            assert np.allclose(steps, steps[0])
            leading = steps[0] / 10.0 ** np.floor(np.log10(steps[0]) + 1e-9)
            assert np.abs(np.array([1, 2, 2.5, 5, 10]) - leading).min() < 1e-6, (low, width, found)


def measured():
    """Values by what is special about them."""
    rng = np.random.default_rng(9)
    plain = rng.uniform(2.0, 3.0, 1000)
    both = rng.normal(0.3, 1.0, 1000)
    return {
        "plain": plain,
        "one above": np.append(plain, 1e6),
        "one below": np.append(plain, 1e-6),
        "one beyond each end": np.append(plain, [1e-6, 1e6]),
        "few with one above": np.append(np.linspace(0.1, 0.9, 12), 1e9),
        "few with one below": np.append(np.linspace(100.1, 100.9, 12), 1e-3),
        "too few to have outliers": np.append(np.linspace(0.1, 0.9, 8), 1e9),
        "most alike": np.append(np.full(1000, 0.5), [0.25, 0.75]),
        "both signs": both,
        "both signs, further below": -both,
        "both signs, one far below": np.append(both, -1e3),
        "one of the other sign": np.append(plain, -1e3),
        "a sign by rounding": np.append(plain - 2.0, -1e-12),
        "with gaps": np.append(plain, [np.nan, np.inf, -np.inf] * 100),
        "many": rng.normal(5.0, 1.0, 500_000),
    }


@pytest.mark.parametrize("case", measured())
def test_the_scale_of_values_is_that_of_the_pictures(views, case):
    """Limits, pointed ends and colours, of the same values."""
    values = measured()[case].astype(np.float32)
    expected = color_scale(values, "value")
    views.blobs["/values"] = values.tobytes()
    low, high, below, above, diverging = views.page.evaluate(
        """async () => {
          const page = await import("/viewer/viewer.js");
          const of = new Float32Array(await (await fetch("/values")).arrayBuffer());
          const known = [page.extent(of), page.withoutOutliers(of)];
          const scale = page.scaleOf({label: "value", unit: "m"}, ...known, null, "magma");
          return [scale.low, scale.high, scale.below, scale.above, scale.colors === page.table("coolwarm")]; }"""
    )
    assert (low, high, diverging) == (*expected.limits, expected.diverging)
    assert {(True, True): "both", (True, False): "min", (False, True): "max", (False, False): "neither"}[
        below, above
    ] == expected.extend


@pytest.mark.parametrize("style", ["surface", "translucent", "isosurface", "cells", "points"])
def test_styles_draw_the_volume_where_it_is(views, style):
    """A ball at a known place covers the pixels that it covers, in both themes."""
    x = (np.stack(np.meshgrid(*(np.arange(24) - 12,) * 3, indexing="ij"), -1) + 0.5) * 0.05
    distance = np.linalg.norm(x, axis=-1)
    values = np.where(distance < 0.5, 1.0 - distance, np.nan)
    written = Written()
    shown = manifest(volumes=[written.volume("ball", values, (-12,) * 3, 0.05)])
    patch = {"volumes": {"ball": {"style": style, "threshold": 0.5 if style == "isosurface" else None}}}
    views.show(shown, written.blobs, camera=looking([0, 0, 0], 0.8), **patch)
    for theme, paper in (("light", [255, 255, 255]), ("dark", [18, 23, 29])):
        views.change(theme=theme)
        picture = views.picture()[:, :420]  # without the colour bar
        row, column = np.nonzero((np.abs(picture - paper) > 12).any(axis=2))
        radius = 0.5 * HEIGHT / 2 / 0.8
        distances = np.hypot(column + 0.5 - WIDTH / 2, row + 0.5 - HEIGHT / 2)
        assert distances.max() < radius + 0.075 * HEIGHT / 2 / 0.8
        filled = np.hypot(*np.mgrid[-20:21, -20:21]) < 20
        if style != "points":
            middle = picture[HEIGHT // 2 - 20 : HEIGHT // 2 + 21, WIDTH // 2 - 20 : WIDTH // 2 + 21]
            assert (np.abs(middle[filled] - paper) > 12).any(axis=1).all()
        assert np.pi * radius**2 * 0.25 < len(row) < np.pi * (radius * 1.15) ** 2


def test_differences_on_one_lattice(views):
    """Voxel by voxel where both have a value, in colours around 0; other lattices are refused."""
    a, b = block(2), block(3)
    written = Written()
    shifted = np.add(FIRST, [2, 0, 1]).tolist()
    volumes = [
        written.volume("a", a, FIRST, SIZE),
        written.volume("b", b[2:, :, 1:], shifted, SIZE),
        written.volume("c", b, FIRST, 2 * SIZE),
    ]
    views.show(
        manifest(volumes=volumes), written.blobs, camera=looking(TARGET, HALF), range=WHOLE, slices=[SLICE],
        volumes={"a": {"style": "cells", "minus": "b"}, "b": OFF, "c": OFF},
    )  # fmt: skip
    views.change(volumes={"a": {"cut": [{"axis": "y", "from_m": SIZE * (FIRST[1] + LAYER), "to_m": None}]}})
    other = np.full(SHAPE, np.nan)
    other[2:, :, 1:] = b[2:, :, 1:]
    cells, colors = seen(views)
    difference = a - other
    size = np.nanmax(np.abs(difference))
    expected, here = (
        mpl.colormaps["coolwarm"](0.5 + difference / (2 * size), bytes=True)[..., :3].astype(int),
        tuple(cells.T),
    )
    known = np.isfinite(difference[here])
    assert known.sum() > 50
    assert np.abs(colors - expected[here])[known].max() <= 1
    views.change(volumes={"a": {"minus": "c"}})
    assert any("equal voxels" in problem for problem in views.told("problem"))


def test_mappings_are_green_inside_and_red_outside(views):
    """A slave's volume under its scales, turn and offset in its master's."""
    whole = np.ones((10, 10, 10))
    written = Written()
    volumes = [written.volume("master", whole, (-5, -5, -5), 0.1), written.volume("slave", whole, (-5, -5, -5), 0.1)]
    mapping = {"master": "m", "slave": "s", "scale": 0.5, "offset_m": [0.5, 0.0, 0.1], "R": np.eye(3).ravel().tolist(),
               "volumes": {"master": "master", "slave": "slave"}}  # fmt: skip
    views.show(
        manifest(volumes=volumes, mapping=mapping), written.blobs, camera=looking([0, 0, 0], 1.0),
        volumes={"master": OFF, "slave": {"style": "surface"}},
    )  # fmt: skip
    views.change(volumes={"slave": {"cut": [{"axis": "y", "from_m": 0.0, "to_m": None}]}})

    def kinds(x, z):
        red, green, blue = at(views.picture(), pixels(np.array([[x, 0.0, z]]), np.zeros(3), 1.0))[0]
        return "paper" if min(red, green, blue) > 240 else "green" if green > red else "red"

    # It stands from 0.25 to 0.75 along x, from -0.15 to 0.35 along z.
    assert [kinds(x, 0.1) for x in (0.2, 0.3, 0.45, 0.55, 0.7, 0.8)] == [
        "paper",
        "green",
        "green",
        "red",
        "red",
        "paper",
    ]
    assert [kinds(0.4, z) for z in (-0.2, -0.1, 0.3, 0.4)] == ["paper", "green", "green", "paper"]
    views.change(mapping={"scale": [0.4, 1.0, 0.8], "offset_m": [0.2, 0.0, 0.3]})
    assert [kinds(x, 0.3) for x in (-0.05, 0.05, 0.35, 0.45)] == ["paper", "green", "green", "paper"]
    assert [kinds(0.2, z) for z in (-0.15, -0.05, 0.45, 0.55, 0.65, 0.75)] == [
        "paper",
        "green",
        "green",
        "red",
        "red",
        "paper",
    ]


def test_picking(views):
    """Voxels behind cuts and thresholds, robots, maps and points are met where they stand."""
    values = block(4)
    show_block(views, values)
    asked = "([x, y]) => stage.pick(x, y)"
    for layer in (0, 3):
        views.change(volumes={"block": {"cut": [{"axis": "y", "from_m": SIZE * (FIRST[1] + layer), "to_m": None}]}})
        cells, places = centers(layer)
        for cell, place in zip(cells[::7], pixels(places, TARGET, HALF)[::7], strict=True):
            behind = np.flatnonzero(np.isfinite(values[cell[0], layer:, cell[2]]))
            found = views.page.evaluate(asked, place.tolist())
            met = [int(cell[0]), int(layer + behind[0]), int(cell[2])]
            assert found["kind"] == "volume"
            assert found["cell"] == met
            assert found["value"] == np.float32(values[tuple(met)])
            assert np.allclose(found["center_m"], (np.add(met, FIRST) + 0.5) * SIZE)
    least = float(np.nanquantile(values, 0.8))
    views.change(volumes={"block": {"threshold": least, "cut": []}})
    found = [views.page.evaluate(asked, place.tolist()) for place in pixels(centers()[1], TARGET, HALF)[::9]]
    assert any(found)
    assert all(each["value"] >= np.float32(least) for each in found if each)
    assert views.page.evaluate(asked, [2, 2]) is None


def test_a_chosen_voxel_is_marked(views):
    """By its edges, in front of all, even where its volume comes after the settings."""
    cell = [3, LAYER, 6]
    show_block(views, np.ones(SHAPE), selected={"volume": "block", "cell": cell})
    corners = (np.array(FIRST) + cell + np.array([[0, 0.5, 0.5], [1, 0.5, 0.5], [0.5, 0.5, 0], [0.5, 0.5, 1]])) * SIZE
    places = pixels(corners, TARGET, HALF)
    assert np.abs(at(views.picture(), places) - [194, 24, 91]).max() < 40
    views.change(selected=None)
    assert np.abs(at(views.picture(), places) - [194, 24, 91]).max(axis=1).min() > 40


def floor_map(written, shares, T_world):
    """Of a manifest: a map of shares (6, 4) in cells of 20 cm."""
    return {"name": "map", "label": "map", "T_world": np.ravel(T_world).tolist(), "shape": [6, 4], "cell_m": [0.2, 0.2],
            "origin_m": [-0.6, -0.4], "channels": [written.channel("share", shares)]}  # fmt: skip


def test_maps_points_and_robots(views):
    """A map is painted cell by cell on its plane; a robot stands and is met where its kinematics say."""
    written = Written()
    shares = np.random.default_rng(5).random((6, 4))
    shares[2, 1] = np.nan
    T = [[1, 0, 0, 0.0], [0, 0, -1, 0.3], [0, 1, 0, 0.0], [0, 0, 0, 1]]  # its second axis is z
    floor = floor_map(written, shares, T)
    robot = ws.load_robot("scara")
    view = robot_view(robot)
    views.show(manifest(maps=[floor], robots=view.manifest["robots"]), written.blobs | dict(view.blobs),
               camera=looking([0, 0, 0], 1.0), range=WHOLE,
               layers={"robot:0": OFF, "axes": OFF, "scale_bar": OFF})  # fmt: skip
    i, j = (each.ravel() for each in np.meshgrid(np.arange(6), np.arange(4), indexing="ij"))
    places = np.stack([-0.6 + 0.2 * (i + 0.5), np.full(24, 0.3), -0.4 + 0.2 * (j + 0.5)], axis=1)
    where = pixels(places, np.zeros(3), 1.0)
    colors, known = at(views.picture(), where), np.isfinite(shares[i, j])
    low, high = np.nanmin(shares), np.nanmax(shares)
    assert np.abs(colors - viridis((shares[i, j] - low) / (high - low)))[known].max() <= 1
    assert (colors[~known] == 255).all()
    found = views.page.evaluate("([x, y]) => stage.pick(x, y)", where[7].tolist())
    assert (found["kind"], found["cell"]) == ("map", [int(i[7]), int(j[7])])
    views.change(layers={"robot:0": ON, "map": OFF})
    tip = robot.forward_kinematics(np.array([view.manifest["robots"][0]["home"]]))[0, :3, 3]
    arm = views.page.evaluate("([x, y]) => stage.pick(x, y)", pixels(tip[None], np.zeros(3), 1.0)[0].tolist())
    assert arm is None or arm["kind"] == "robot"


def around(picture, place, half=6):
    """Whether anything is drawn within some pixels of a place that a camera along y sees."""
    column, row = np.floor(pixels(place[None], np.zeros(3), 1.0)[0]).astype(int)
    return bool((picture[row - half : row + half + 1, column - half : column + half + 1] != 255).any())


def four_layers(written):
    """Of a manifest: an arrow, a curve, a leg and a triangle, upright beside each other."""
    glyphs = {"name": "arrows", "label": "arrows", "unit": "N", "origins": written.numbers([-0.6, 0, -0.05], "float32"),
              "vectors": written.numbers([0, 0, 4.0], "float32")}  # fmt: skip
    upright = [[[-0.3, 0, -0.2], [-0.3, 0, 0.2]]]
    curve = {"name": "curve", "label": "curve", "closed": False, "points": upright}
    leg = {"name": "leg", "closed": False, "points": [[[0, 0, -0.2], [0, 0, 0.2]]]}
    corners = np.array([[0.2, 0, -0.1], [0.4, 0, -0.1], [0.3, 0, 0.2]])
    written.blobs["patch"] = box = glb([ColoredMesh(corners, np.array([[0, 1, 2]]), (0.0, 0.3, 1.0), "patch")])
    data = {"blob": "patch", "type": "glb", "length": len(box), "compression": None}
    mesh = {"name": "mesh", "label": "mesh", "role": "boundary", "geometry": data}
    return {"glyphs": [glyphs], "curves": [curve], "skeletons": [leg], "meshes": [mesh]}


def test_arrows_lines_legs_surfaces_and_frames_stand_where_they_are(views):
    """Each alone: where it is something is drawn, and nothing beside it; hidden, nothing at all."""
    written, places = Written(), np.array([[-0.6, 0, 0], [-0.3, 0, 0], [0, 0, 0], [0.3, 0, 0]])
    views.show(manifest(**four_layers(written)), written.blobs, camera=looking([0, 0, 0], 1.0))
    views.until("stage.info.idle")
    names, beside = ("arrows", "curve", "leg", "mesh"), places + np.array([0.12, 0, 0])
    for shown in (names, *((name,) for name in names), ()):
        layers = {name: {"visible": name in shown, "opacity": 1} for name in names}
        views.change(layers=layers)
        picture = views.picture()
        drawn = [around(picture, place) for place in places]
        assert drawn == [name in shown for name in names], shown
        assert not any(around(picture, place) for place in beside)
        if shown == ("mesh",):
            red, _, blue = at(picture, pixels(places[3:], np.zeros(3), 1.0))[0]
            assert blue > 2 * red  # of the patch's own colour


def test_the_frames_of_a_robot_stand_at_its_joints(views):
    """Red, green and blue, at the tip that kinematics tell of."""
    robot, view = ws.load_robot("ur5e"), robot_view("ur5e")
    tip = robot.forward_kinematics(np.array([view.manifest["robots"][0]["home"]]))[0, :3, 3]
    views.show(view.manifest, dict(view.blobs), camera=looking(tip, 0.25), layers={"robot:0": OFF, "axes": OFF})
    before = views.picture()
    views.change(layers={"robot:0": ON, "frames": OFF})
    bare = views.picture()
    views.change(layers={"frames": ON})
    near = slice(HEIGHT // 2 - 60, HEIGHT // 2 + 60), slice(WIDTH // 2 - 60, WIDTH // 2 + 60)
    changed = (views.picture() != bare).any(axis=2)[near]
    assert changed.sum() > 30
    colors = views.picture()[near][changed].astype(int)
    for k in range(3):
        others = np.delete(colors, k, axis=1).max(axis=1)
        assert (colors[:, k] > others + 25).sum() > 5, k
    assert (before[near] == 255).all()


def test_a_million_points_are_drawn(views):
    """Points on the CPU, in the order of their depths."""
    written, n = Written(), 1_000_000
    rng = np.random.default_rng(6)
    p = rng.random((n, 3)) * [1.0, 1.0, 1.0] - 0.5
    steps = np.rint((p + 0.5) * 65535)
    points = {"name": "samples", "label": "samples", "count": n, "lower": [-0.5] * 3, "upper": [0.5] * 3,
              "positions": written.numbers(steps.ravel(), "uint16"),
              "channels": [written.channel("depth", p[:, 1] + 0.5)]}  # fmt: skip
    views.show(manifest(points=[points]), written.blobs, camera=looking([0, 0, 0], 1.0), range=WHOLE)
    inner = views.picture()[HEIGHT // 2 - 100 : HEIGHT // 2 + 100, WIDTH // 2 - 100 : WIDTH // 2 + 100]
    # The nearest to the eye, which looks along y, have the least depth, so the darkest end of the colours.
    assert (np.abs(inner - viridis(np.array([0.05]))).max(axis=2) < 60).mean() > 0.95


def test_nothing_is_drawn_at_rest(views):
    """Frames are counted: none without a cause, some for each."""
    show_block(views, block())
    before = views.page.evaluate("stage.info.frames")
    views.page.wait_for_timeout(1200)
    assert views.page.evaluate("stage.info.frames") == before
    views.page.mouse.move(WIDTH / 2, HEIGHT / 2)
    views.page.wait_for_timeout(300)
    assert views.page.evaluate("stage.info.frames") == before
    views.page.evaluate("settings.limits = [{elbow: [0, 1]}]; stage.apply(structuredClone(settings)); null")
    views.page.wait_for_timeout(300)
    assert views.page.evaluate("stage.info.frames") == before  # only the volume that follows will be seen
    views.change(theme="dark")
    assert views.page.evaluate("stage.info.frames") > before


def test_a_surface_that_hides_a_volume_is_fetched_when_it_is_shown(views):
    """And may then fail, which is said."""
    written = Written()
    vertices = np.array([[-0.3, 0, -0.3], [0.3, 0, -0.3], [0, 0, 0.3]])
    box = glb([ColoredMesh(vertices, np.array([[0, 1, 2]]), (1.0, 0.0, 0.0), "5 plane: joint1 upper")])
    written.blobs["surface"] = box
    values = np.full(SHAPE, np.nan)
    values[0, 0, 0] = 1.0  # beside the surface
    volume = written.volume("block", values, FIRST, SIZE)
    meshes = [
        {"name": name, "label": name, "role": "surface",
         "geometry": {"blob": name, "type": "glb", "length": len(box), "compression": None}}
        for name in ("surface", "missing")
    ]  # fmt: skip
    asked = []
    views.page.on("request", lambda request: asked.append(request.url.rpartition("/")[2]))
    views.show(manifest(volumes=[volume], meshes=meshes), written.blobs, camera=looking([0, 0, 0], 1.0))
    assert "surface" not in asked
    middle = pixels(np.array([[0.0, 0.0, -0.1]]), np.zeros(3), 1.0)
    assert (at(views.picture(), middle) == 255).all()
    views.change(layers={"surface": ON})
    views.until("stage.info.idle")
    views.page.wait_for_timeout(300)
    views.rest()
    red, green, blue = at(views.picture(), middle)[0]
    assert red > 100 > max(green, blue)
    assert asked.count("surface") == 1
    found = views.page.evaluate("([x, y]) => stage.pick(x, y)", middle[0].tolist())
    assert (found["kind"], found["patch"]) == ("mesh", "5 plane: joint1 upper")
    views.forgiven = "404"
    views.change(layers={"missing": ON})
    views.until("told.some(each => each[0] === 'problem')")


def test_turning_by_hand_and_by_keys(views):
    """A drag turns, and the coarse picture comes before the fine one; stages that are linked look alike."""
    show_block(views, block(), camera=None)
    views.page.evaluate("told.length = 0; window.moves = []; stage.on('camera', camera => moves.push(camera)); null")
    views.page.mouse.move(200, 240)
    views.page.mouse.down()
    for k in range(5):
        views.page.mouse.move(200 + 20 * k, 240)
        views.page.wait_for_timeout(30)
    views.page.mouse.up()
    views.rest()
    drawn = views.told("drawn")
    assert drawn[0] == "coarse"
    assert drawn[-2:] == ["fine", "finished"]
    moves = views.page.evaluate("moves")
    assert len(moves) >= 3
    radius = {round(float(np.linalg.norm(np.subtract(m["position"], m["target"]))), 6) for m in moves}
    assert len(radius) == 1
    views.page.mouse.wheel(0, -400)
    views.until(f"moves.length > {len(moves)}")
    zoomed = views.page.evaluate("moves.at(-1)")
    assert zoomed["target"] == moves[-1]["target"]
    assert np.linalg.norm(np.subtract(zoomed["position"], zoomed["target"])) < 0.95 * min(radius)
    views.page.mouse.down(button="right")
    views.page.mouse.move(330, 260, steps=3)
    views.page.mouse.up(button="right")
    moves = views.page.evaluate("moves")
    moved = [np.subtract(moves[-1][name], zoomed[name]) for name in ("position", "target")]
    assert np.linalg.norm(moved[1]) > 0.01 and np.allclose(*moved)
    views.page.focus("canvas")
    views.page.keyboard.press("ArrowLeft")
    turned = views.page.evaluate("moves.at(-1)")
    assert not np.allclose(turned["position"], moves[-1]["position"])
    assert np.isclose(turned["position"][2], moves[-1]["position"][2])


def test_views_come_and_go_without_growth(views):
    """What a view holds on the graphics card is freed with it, and a stage frees all: of two views in turn, each with
    all styles, slices and a voxel that is marked."""
    sizes, rng = [], np.random.default_rng(10)
    for number in range(8):
        written, other = Written(), number % 2
        view = robot_view("scara" if other else "ur5e")
        volumes = [written.volume("block", block(number)[: SHAPE[0] - 3 * other], FIRST, SIZE)]
        layers = four_layers(written) if other else {"maps": [floor_map(written, rng.random((6, 4)), np.eye(4))]}
        shown = manifest(volumes=volumes, robots=view.manifest["robots"], **layers)
        folder = f"again{views.count}"
        views.count += 1
        views.blobs |= {f"/{folder}/{name}": data for name, data in (written.blobs | dict(view.blobs)).items()}
        if not sizes:
            views.show(shown, written.blobs | dict(view.blobs))
        views.page.evaluate(
            """async ([manifest, folder]) => {
              await stage.load(manifest, async name => (await fetch(`/${folder}/${name}`)).arrayBuffer());
              window.settings = page.defaultSettings(manifest);
              stage.apply(structuredClone(settings));
              while (!stage.valuesAt("block", [0, 0, 0]).size) await new Promise(done => setTimeout(done, 5));
              for (const style of ["cells", "translucent", "isosurface", "points", "surface"]) {
                settings.volumes.block.style = style;
                settings.slices = [...Array(style.length % 3).keys()].map(k => (
                  {axis: "xyz"[k], at_m: 0.05, normal: [0, 0, 1], visible: true}));
                settings.selected = style === "cells" ? {volume: "block", cell: [3, 4, 6]} : null;
                await new Promise(done => {
                  const off = stage.on("drawn", how => { if (how === "coarse") { off(); done(); } });
                  stage.apply(structuredClone(settings)); }); } }""",
            [shown, folder],
        )
        views.rest()
        sizes.append(views.page.evaluate("[stage.info.geometries, stage.info.textures, stage.info.programs]"))
    assert sizes[4:6] == sizes[6:8] == sizes[2:4]
    views.page.evaluate("stage.dispose(); stage.dispose()")
    assert views.page.evaluate("document.getElementById('here').children.length") == 0
    assert views.page.evaluate("stage.info.textures") == 0
    assert views.page.evaluate("stage.info.geometries") == 0


def test_pictures_are_written_in_parts(views):
    """A picture larger than a part shows what the screen shows, scaled; too large ones are refused."""
    show_block(views, block(), slices=[SLICE], volume={"visible": False})
    png = views.page.evaluate("""async () => {
      const blob = await stage.image({width: 1920, height: 1440, title: "A title"});
      return await new Promise(done => { const reader = new FileReader(); reader.onload = () => done(reader.result);
        reader.readAsDataURL(blob); }); }""")
    picture = decoded(base64.b64decode(png.partition(",")[2]))
    assert picture.shape == (1440, 1920, 3)
    places = pixels(centers()[1], TARGET, HALF)
    assert np.abs(at(picture, 3 * places) - at(views.picture(), places)).max() <= 1
    assert (picture[40:80, 40:300] < 128).any(), "no title"
    said = views.page.evaluate(
        "stage.image({width: 9000, height: 100}).catch(error => `${error.name}: ${error.message}`)"
    )
    assert said == "RangeError: a picture has 16 … 8192 pixels a side, not 9000 × 100"


def test_the_gizmo_is_dragged(views):
    """Along an axis from the tip; the robot's tip is where the kinematics say."""
    view = robot_view("ur5e")
    views.show(view.manifest, dict(view.blobs), camera=looking([0, 0, 0.4], 1.2))
    home = np.array([view.manifest["robots"][0]["home"]])
    T = ws.load_robot("ur5e").forward_kinematics(home)[0]
    views.page.evaluate("stage.setGizmo(0)")
    views.rest()
    start = pixels(T[None, :3, 3], np.array([0, 0, 0.4]), 1.2)[0]
    # The axis of the tool that is seen longest.
    axis = T[:3, :3][:, np.argmax(np.abs(T[[0, 2], :3]).sum(axis=0))]
    step = np.array([axis[0], -axis[2]]) / np.hypot(axis[0], axis[2])
    handle = start + 45 * step
    views.page.mouse.move(*handle)
    views.page.mouse.down()
    views.page.mouse.move(*(handle + 15 * step), steps=3)
    views.page.mouse.move(*(handle + 30 * step), steps=3)
    views.page.mouse.up()
    moved = views.told("gizmo")
    assert moved, "the gizmo was not met"
    assert not moved[-1]["dragging"]
    by = np.reshape(moved[-1]["T"], (4, 4)) - T
    assert np.abs(by[:3, :3]).max() < 1e-6
    assert np.linalg.norm(by[:3, 3]) > 0.03
    assert np.linalg.norm(np.cross(by[:3, 3], axis)) < 1e-6
    assert views.told("pick") == []
    views.page.evaluate("stage.setGizmo(null)")
    views.rest()


def test_the_gizmo_tells_what_is_reached(views):
    """By the colour of a ball at the tip."""
    view = robot_view("ur5e")
    (home,) = [each["home"] for each in view.manifest["robots"]]
    tip = ws.load_robot("ur5e").forward_kinematics(home)[0, :3, 3]
    views.show(view.manifest, dict(view.blobs), camera=looking(tip, 0.3))
    views.page.evaluate("stage.setGizmo(0)")
    for state, color in {"reachable": [46, 157, 106], "unreachable": [216, 66, 60], "blocked": [216, 66, 60]}.items():
        views.page.evaluate("state => stage.setReach(state)", state)
        views.rest()
        near = views.picture()[HEIGHT // 2 - 8 : HEIGHT // 2 + 9, WIDTH // 2 - 8 : WIDTH // 2 + 9]

        assert (np.abs(near - color).max(axis=2) <= 2).sum() > 60, state


def test_lost_graphics_come_back(views):
    """A context that the browser takes away and gives back is drawn again."""
    show_block(views, block())
    before = views.picture()
    views.page.evaluate(
        """window.lose = stage.canvas.getContext("webgl2").getExtension("WEBGL_lose_context"); lose.loseContext()"""
    )
    views.until("told.some(each => each[0] === 'lost' && each[1] === 'lost')")
    views.page.evaluate("lose.restoreContext()")
    views.until("told.some(each => each[0] === 'lost' && each[1] === 'back')")
    views.rest()
    assert np.abs(views.picture() - before).max() <= 2
    views.forgiven = "object does not belong to this context"  # three frees what the browser has freed


def test_a_browser_without_graphics_is_told(playwright, site):
    """The error has a type of its own, so that the page can show pictures instead."""
    browser = launch(playwright, "--disable-3d-apis")
    page = browser.new_page()
    page.goto(site[0])
    said = page.evaluate("""async () => { const page = await import("/viewer/viewer.js");
      try { new page.Stage(document.getElementById("here")); return "drawn"; }
      catch (error) { return error instanceof page.NoGraphics ? error.message : `${error}`; } }""")
    browser.close()
    assert said == "This browser shows no 3-D graphics (WebGL 2)."


def ball_around_an_arm(voxels=24):
    """A view of a full ball whose middle is the base of a UR5e, in cells of 10 cm, (…, …, voxels) of them."""
    x = (np.stack(np.meshgrid(*(np.arange(24) - 12,) * 3, indexing="ij"), -1) + 0.5) * 0.1
    values = np.where(np.linalg.norm(x, axis=-1) < 1.2, 1.0 - x[..., 2], np.nan)[:, :, 12 : 12 + voxels]
    written, view = Written(), robot_view("ur5e")
    volumes = [written.volume("ball", values, (-12, -12, 0), 0.1)]
    return manifest(volumes=volumes, robots=view.manifest["robots"]), written.blobs | dict(view.blobs)


MET = """() => { const met = new Set();
  for (let x = 10; x < 640; x += 6) for (let y = 10; y < 480; y += 6) met.add(stage.pick(x, y)?.kind);
  return [...met]; }"""


def test_a_view_opens_so_that_a_robot_is_seen_within_its_volume(views):
    """Cut open through its base; of thin volumes the voxels are shown, through which it is seen."""
    shown, blobs = ball_around_an_arm()
    views.show(shown, blobs)
    assert views.page.evaluate("settings.volumes.ball.cut") == [{"axis": "y", "from_m": 0.0, "to_m": None}]
    assert {"robot", "volume"} <= set(views.page.evaluate(MET))
    views.page.evaluate("() => { settings.volumes.ball.cut = []; stage.apply(structuredClone(settings)); }")
    views.rest()
    assert "robot" not in views.page.evaluate(MET)
    shown["robots"][0]["chain"]["T_base"][7] = 9.0  # beside the volume
    views.show(shown, blobs)
    assert views.page.evaluate("settings.volumes.ball.cut") == []
    views.show(*ball_around_an_arm(3))
    found = views.page.evaluate("settings.volumes.ball")
    assert found["style"] == "cells" and found["cut"] == [] and found["opacity"] < 1


def test_all_is_shown_in_a_view_of_another_size_until_the_eye_is_moved(views):
    shown, blobs = ball_around_an_arm()
    views.show(shown, blobs)
    away = "Math.hypot(...stage.camera.position.map((p, k) => p - stage.camera.target[k]))"
    wide = views.page.evaluate(away)
    views.page.set_viewport_size({"width": 240, "height": HEIGHT})
    views.rest()
    narrow = views.page.evaluate(away)
    assert narrow > 1.5 * wide
    views.page.evaluate("stage.canvas.focus()")
    views.page.keyboard.press("ArrowLeft")
    views.page.set_viewport_size({"width": WIDTH, "height": HEIGHT})
    views.rest()
    assert views.page.evaluate(away) == pytest.approx(narrow, rel=1e-6)


# Keeps in `boxes` where the last picture's texts and panels stand: [text, or "" of a panel, left, top, right, bottom].
BOXES = """() => {
  const {clearRect, fillText, roundRect} = CanvasRenderingContext2D.prototype, own = CanvasRenderingContext2D.prototype;
  window.boxes = [];
  own.clearRect = function (...at) { boxes.length = 0; clearRect.apply(this, at); };
  own.fillText = function (text, x, y) {
    const m = this.measureText(text), left = x - m.actualBoundingBoxLeft, top = y - m.actualBoundingBoxAscent;
    boxes.push([text, left, top, x + m.actualBoundingBoxRight, y + m.actualBoundingBoxDescent]);
    fillText.call(this, text, x, y);
  };
  own.roundRect = function (x, y, w, h, r) {
    boxes.push(["", x, y, x + w, y + h]);
    roundRect.call(this, x, y, w, h, r);
  };
}"""


@pytest.mark.parametrize(("width", "height"), [(300, 260), (390, 500), (640, 480)])
def test_what_is_written_covers_nothing_that_is_written(views, width, height):
    """Titles and ticks of the axes, scale bar, colour bar; of a small preview, too, whichever way it is turned."""
    views.page.set_viewport_size({"width": width, "height": height})
    view = robot_view("scara")
    shown, blobs = ball_around_an_arm()
    views.page.evaluate(BOXES)
    for what in ((view.manifest, dict(view.blobs)), (shown, blobs)):
        views.show(*what, layers={"axes": ON, "scale_bar": ON})
        for direction in (None, *([np.cos(a), np.sin(a), up] for a in np.arange(0.2, 6.3, 0.7) for up in (0.3, 1.5))):
            if direction:
                views.page.evaluate("each => stage.fit(each)", list(map(float, direction)))
            views.page.evaluate("stage.apply(structuredClone(settings))")
            views.rest()
            found = views.page.evaluate("boxes")
            texts, panels = [each for each in found if each[0]], [each for each in found if not each[0]]
            assert {"x [m]", "y [m]", "z [m]"} <= {each[0] for each in texts} or direction
            scale = panels[0]  # holds its own text alone
            assert sum(scale[1] < each[3] and each[1] < scale[3] and scale[2] < each[4] for each in texts) == 1
            for k, (name, left, top, right, bottom) in enumerate(texts):
                for other in (*texts[:k], *panels):
                    apart = right <= other[1] or other[3] <= left or bottom <= other[2] or other[4] <= top
                    within = left >= other[1] and right <= other[3] and top >= other[2] and bottom <= other[4]
                    own = not other[0] and within and name[1:] != " [m]"
                    assert apart or own, (direction, name, other)


def test_slices_of_a_volume_that_is_hidden_are_in_the_picture(views):
    """The eye stands as far away as from the volume itself."""
    shown, blobs = ball_around_an_arm()
    away = "Math.hypot(...stage.camera.position.map((p, k) => p - stage.camera.target[k]))"
    views.show(shown, blobs)
    whole = views.page.evaluate(away)
    slices = [{"axis": "y", "at_m": 0.0, "normal": [0, 0, 1], "visible": True}]
    views.show(shown, blobs, volumes={"ball": {"visible": False}}, slices=slices)
    assert views.page.evaluate(away) == pytest.approx(whole, rel=1e-6)


def test_links_without_a_colour_of_their_own_are_light(views):
    """MuJoCo's grey would be nearly black under the lights."""
    view = robot_view("ur5e")
    views.show(view.manifest, dict(view.blobs), camera=looking([0, 0, 0.4], 1.2))
    picture = views.picture()
    robot = picture[(np.abs(picture - 255) > 12).any(axis=2)]
    assert len(robot) > 2000 and np.median(robot) > 125
