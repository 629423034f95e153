"""What pictures show, with and without OpenGL."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from PIL import Image
from scipy.spatial import ConvexHull

import wsrender as ws
from tests.results.export.sample_data import random_volume
from wsrender.errors import InputError
from wsrender.results.drawing.box import space_around
from wsrender.results.render import VIEWS, Box, Floor, Subject, composition, picture
from wsrender.results.render.environment import surfaces
from wsrender.results.render.process import drawn
from wsrender.results.render.scene import Dots, DrawnScene, DrawnSurface, Plates, Rods
from wsrender.results.render.views import Choice
from wsrender.volume.volume_data import VolumeData

SIZE = (240, 200)
CHOICE = Choice(index=None, statistic=None, threshold=0.6, alpha=0.02, at=(None, None, None), azimuth_deg=-58.0)


@pytest.fixture
def blank(monkeypatch):
    """Pictures without OpenGL: the scene that would be drawn is kept, and the picture is white."""
    scenes = []

    def draw(scene):
        scenes.append(scene)
        return np.full((*scene.size[::-1], 3), 255, np.uint8)

    monkeypatch.setattr(composition, "drawn", draw)
    return scenes


def labels_of(figure):
    return {text.get_text() for text in figure.legends[0].get_texts()}


def seen(camera, points):
    """Pixels (N, 2), from the upper left, where points appear."""
    width, height = SIZE
    x, y = (camera.to_picture(np.asarray(points, float)) * height / 2).T
    return np.stack([width / 2 + x, height / 2 - y], axis=1)


def bounds_of(layers):
    return np.concatenate([composition._layer_points(layer) for layer in layers])


def render(layers, camera=None):
    camera = camera or space_around(bounds_of(layers), SIZE, -58, 24).camera
    return drawn(DrawnScene(camera, SIZE, layers)), camera


@pytest.mark.usefixtures("opengl")
def test_things_appear_where_the_camera_says():
    space = space_around(np.array([[-1, -1, -1], [1, 1, 1]]), SIZE, -58, 24)
    points = np.array([[0.5, -0.7, 0.2], [-0.8, 0.1, 0.9]])
    colors = np.array([[200, 0, 0], [0, 0, 200]], np.uint8)
    image, _ = render([Dots(points, colors, 6)], space.camera)
    for place, channel in zip(seen(space.camera, points), (0, 2), strict=True):
        ink = np.delete(255 - image.astype(float), channel, axis=2).sum(axis=2) * (image[:, :, channel] > 150)
        rows, columns = np.indices(ink.shape) + 0.5
        np.testing.assert_allclose([(ink * columns).sum() / ink.sum(), (ink * rows).sum() / ink.sum()], place, atol=0.6)


@pytest.mark.usefixtures("opengl")
@pytest.mark.parametrize(
    ("view", "lower", "upper"),
    [
        ("boundary", (-0.6, -0.5, 0.2), (0.6, 0.5, 1.0)),
        ("volume", (-0.6, -0.5, 0.2), (0.6, 0.5, 1.0)),
        ("isosurface", (-0.6, -0.5, 0.63), (0.6, 0.5, 1.0)),  # 4.8 between the centres of voxels of 4 and 5
    ],
)
def test_a_block_covers_the_area_of_its_outline(block, view, lower, upper):
    choice = CHOICE if view == "isosurface" else replace(CHOICE, alpha=0.99)
    layers = VIEWS[view]([block], choice).layers
    corners = np.stack(np.meshgrid(*zip(lower, upper, strict=True)), axis=-1).reshape(-1, 3)
    if view != "volume":  # marching cubes cuts the edges; the block is convex
        corners = layers[0].vertices
        np.testing.assert_allclose([corners.min(axis=0), corners.max(axis=0)], [lower, upper], atol=1e-6)
        layers[0] = replace(layers[0], smooth=False)
    image, camera = render(layers)
    ink = 255 - image.min(axis=2).astype(int)
    covered = np.count_nonzero(ink > (55 if view == "volume" else ink.max() / 2))
    # Half a voxel between the samples of a ray leaves the very edges of a cloud pale.
    assert covered == pytest.approx(ConvexHull(seen(camera, corners)).volume, rel=0.04 if view == "volume" else 0.015)


@pytest.mark.usefixtures("opengl")
def test_slices_show_the_exact_colours_of_their_voxels(block):
    drawing = VIEWS["slice"]([block], CHOICE)
    image, camera = render(drawing.layers)
    assert drawing.scale.label == "Maximum of reach [m²]"
    for z in (0.75, 0.95):  # on the plane x = 0.05, y towards the eye, nothing before it
        column, row = seen(camera, [[0.05, -0.4, z]])[0].astype(int)
        value = np.floor((z - 0.2) / 0.1) + 1
        expected = drawing.scale(value)[:3] * 255
        np.testing.assert_allclose(image[row, column], expected, atol=10)  # seen through the faint boundary


@pytest.mark.usefixtures("opengl")
def test_a_surface_has_the_colours_of_the_bar(block):
    """A shade would stand for another value; an opaque boundary is one whose colours do not blend."""
    drawing = VIEWS["boundary"]([block], replace(CHOICE, index="reach", alpha=None))
    image, camera = render(drawing.layers)
    for place, value in (([0, 0, 1.0], 8), ([0.1, -0.5, 0.25], 1)):  # the upper side, and low on one towards the eye
        column, row = seen(camera, [place])[0].astype(int)
        np.testing.assert_allclose(image[row, column], drawing.scale(value)[:3] * 255, atol=3)
    assert not drawing.notes[1:]
    assert VIEWS["boundary"]([block], replace(CHOICE, index="reach", alpha=0.5)).notes[1:]
    assert VIEWS["boundary"]([block], replace(CHOICE, alpha=None)).scale is None


@pytest.mark.parametrize("view", ["solid", "scatter"])
def test_views_cut_open_leave_out_the_quarter_towards_the_eye(block, view):
    (layer,) = VIEWS[view]([block], CHOICE).layers
    points = layer.vertices if view == "solid" else layer.positions
    centers = block.samples.position
    kept = centers[~in_quarter(centers)]
    assert 0 < len(kept) < len(centers)
    np.testing.assert_allclose(
        [points.min(axis=0), points.max(axis=0)], [kept.min(axis=0), kept.max(axis=0)], atol=0.051
    )
    if view == "scatter":
        np.testing.assert_array_equal(points, kept)
    else:  # every vertex is half a voxel from a kept centre
        assert (np.abs(points[:, None] - kept).max(axis=2).min(axis=1) < 0.051).all()


def in_quarter(points):
    """Within 45° of the direction of the eye, -58°, from the upright line through the base (0, 0)."""
    azimuth = np.degrees(np.arctan2(points[:, 1], points[:, 0]))
    return (azimuth > -58 - 45) & (azimuth < -58 + 45)


@pytest.mark.usefixtures("opengl")
def test_the_arm_shines_through_what_hides_it():
    (plate,) = surfaces(Box((0, -0.5, 0), (2, 0.1, 2)), np.zeros(3), np.ones(3))
    arm = Rods(np.array([[0, 0.5, -0.5], [0, 0.5, 0.5]]), 0.08, (1.0, 0.0, 0.0))
    camera = space_around(np.array([[-1, -1, -1], [1, 1, 1]]), SIZE, -90, 0).camera
    image, _ = render([plate, arm], camera)
    (column, row), (beside, _) = seen(camera, [[0, 0.5, 0], [0.4, 0.5, 0]]).astype(int)
    red, plain = image[row, column].astype(int), image[row, beside].astype(int)
    assert red[0] - red[1] > plain[0] - plain[1] + 40


@pytest.mark.usefixtures("opengl")
def test_a_saved_result_is_drawn_in_a_process_of_its_own(tmp_path, planar_result):
    before = {name.partition(".")[0] for name in sys.modules}
    planar_result.render("boundary", tmp_path / "view.png", environment=[Floor(-0.2)])
    with Image.open(tmp_path / "view.png") as image:
        assert image.size == (1400, 1080)
        assert len(image.convert("RGB").getcolors(2**20)) > 100
    assert not {"pyvista", "vtkmodules"} & ({name.partition(".")[0] for name in sys.modules} - before)


@pytest.fixture(scope="module")
def planar_result():
    table = ws.DHTable(convention="standard", rows=[ws.DHRow(a=0.5), ws.DHRow(a=0.4)], name="planar & <2R>")
    return ws.analyze(
        ws.load_robot(table), ws.Grid(40), ["manipulability"], ["x", "y"], voxel_size_m=0.05, device="cpu"
    )


@pytest.mark.parametrize("view", list(VIEWS))
def test_every_picture_has_axes_colour_bar_legend_and_robot(blank, planar_result, view):
    figure = planar_result.render(view, environment=[Floor(-0.2), Box((1, 0, 0), (0.2, 0.2, 0.2))])
    texts = [text.get_text() for text in figure.axes[0].texts]
    assert {"x [m]", "y [m]", "z [m]"} <= set(texts)
    if view == "boundary":  # of one colour, translucent: there is nothing to read off a bar
        assert len(figure.axes) == 1
    else:
        assert figure.axes[1].get_ylabel().lower().endswith("manipulability [m²]")
    assert {"planar & <2R>", "joint", "tip", "floor", "box"} <= labels_of(figure)
    assert figure.get_suptitle() == "planar & <2R> · 1,600 samples (grid)"
    (rods,) = [layer for layer in blank[0].layers if isinstance(layer, Rods)]
    np.testing.assert_array_equal(rods.points, planar_result.skeleton[0])


def test_several_results_share_one_box_and_tell_robots_apart(blank, planar_result):
    figure = planar_result.render(others=[planar_result], alpha=0.3)
    assert {"planar & <2R> 1", "planar & <2R> 2"} <= labels_of(figure)
    bodies = [layer for layer in blank[0].layers if isinstance(layer, DrawnSurface)]
    assert len({body.color for body in bodies}) == 2
    assert {body.alpha for body in bodies} == {0.3}
    shared = planar_result.render(others=[planar_result], index="manipulability")
    assert len(shared.axes) == 2  # one colour bar


def test_the_robots_of_one_result_are_drawn_each_with_its_volume(blank):
    volumes = {f"robot_{name}": VolumeData(0.1, (k, 0, 0), np.full((3, 3, 3), 9)) for k, name in enumerate("ab")}
    arms = np.arange(12.0).reshape(2, 2, 3)
    figure = ws.Result({"robots": [{"name": "a"}, {"name": "b"}]}, skeleton=arms, volumes=volumes).render()
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert {"a", "b", "boundary of a", "boundary of b"} <= set(labels)
    rods = [layer.points for layer in blank[0].layers if isinstance(layer, Rods)]
    np.testing.assert_array_equal(rods, arms)
    lows = [layer.vertices[:, 0].min() for layer in blank[0].layers if isinstance(layer, DrawnSurface)]
    np.testing.assert_allclose(lows, [0.0, 0.1], atol=1e-9)


def test_determinants_have_zero_in_the_middle_in_every_view(block):
    volume = block.volume
    values = np.where(volume.count > 0, -0.5 - np.arange(8.0) / 10, np.nan)
    signed = replace(
        block, volume=VolumeData(0.1, volume.first_voxel, volume.count, {"center": {"determinant_A": values}})
    )
    with pytest.raises(InputError, match=r"share of the maximum, and that of Determinant A is -0\.5, not above 0"):
        VIEWS["isosurface"]([signed], CHOICE)
    zero = {"center": {"determinant_A": np.where(volume.count > 0, 0.0, np.nan)}}
    singular = replace(block, volume=VolumeData(0.1, volume.first_voxel, volume.count, zero))
    with pytest.raises(InputError, match=r"that of Determinant A is 0, not above 0"):
        VIEWS["isosurface"]([singular], CHOICE)
    for view in ("solid", "volume", "slice"):
        scale = VIEWS[view]([signed], CHOICE).scale
        assert scale.diverging and scale.limits == pytest.approx((-1.2, 1.2))


def test_a_picture_says_that_pale_parts_of_an_arm_are_hidden(blank, planar_result):
    for view, said in (("solid", True), ("boundary", False)):
        texts = [text.get_text() for text in planar_result.render(view).texts]
        assert (composition.SHINING in texts) == said


def test_what_two_robots_share_stands_out(blank):
    volumes = {f"robot_{name}": VolumeData(0.1, (k, 0, 0), np.full((3, 3, 3), 9)) for k, name in enumerate("ab")}
    both = trimesh.creation.box((0.2, 0.3, 0.3))
    result = ws.Result({"robots": [{"name": "a"}, {"name": "b"}]}, volumes=volumes, meshes={"intersection": both})
    figure = result.render()
    *_, surface = [layer for layer in blank[0].layers if isinstance(layer, DrawnSurface)]
    np.testing.assert_array_equal(surface.vertices, both.vertices)
    assert "shared by at least two" in labels_of(figure)


def test_colours_of_a_surface_are_those_of_the_nearest_voxels(block):
    drawing = VIEWS["boundary"]([block], replace(CHOICE, index="reach"))
    (surface,) = drawing.layers
    for z, value in ((0.25, 1), (0.95, 8)):
        rows = np.abs(surface.vertices[:, 2] - z) < 1e-6
        expected = np.round(drawing.scale(value)[:3] * 255)
        assert rows.any()
        np.testing.assert_allclose(surface.colors[rows].astype(int), np.broadcast_to(expected, (rows.sum(), 3)), atol=2)


ARM = (
    '<mujoco model="arm"><worldbody><body><joint axis="0 0 1" range="-1 1"/>'
    '<geom type="capsule" fromto="0 0 0 .5 0 0" size=".03"/>'
    '<body pos=".5 0 0"><joint axis="0 0 1" range="-1 1"/><geom size=".05"/><site name="tool" pos="{} 0 0"/></body>'
    "</body></worldbody></mujoco>"
)


@pytest.fixture
def arm(tmp_path):
    """A file of the arm, and its result where it stands elsewhere, with a tool."""
    path = tmp_path / "arm.xml"
    path.write_text(ARM.format(0.4))
    robot = ws.load_robot(path, placement=ws.Transform(position_m=(0, 0, 1)), tool=ws.Transform(position_m=(0.1, 0, 0)))
    return path, ws.analyze(robot, ws.Grid(5), ["manipulability"], ["x", "y"], voxel_size_m=0.1, device="cpu")


def test_links_are_drawn_with_the_bodies_of_the_model(blank, arm):
    path, result = arm
    result.render(robot=str(path), configuration=[0.3, 0.4])
    scene = blank[0]
    links = [layer for layer in scene.layers if isinstance(layer, DrawnSurface) and layer.alpha == 1]
    assert len(links) == 2 and links[0].vertices[:, 2].mean() == pytest.approx(1)
    (rods,) = [layer for layer in scene.layers if isinstance(layer, Rods)]
    tip = [0.5 * np.cos(0.3) + 0.5 * np.cos(0.7), 0.5 * np.sin(0.3) + 0.5 * np.sin(0.7), 1]
    np.testing.assert_allclose(rods.points[-1], tip)


def test_what_is_odd_about_a_robot_is_said_once(blank, arm):
    path, result = arm
    inertial = '<inertial pos="0 0 0" mass="1" diaginertia="1 1 9"/>'
    path.write_text(ARM.format(0.4).replace("<geom type", f"{inertial}<geom type"))
    placement, tool = ws.Transform(position_m=(0, 0, 1)), ws.Transform(position_m=(0.1, 0, 0))
    with pytest.warns(UserWarning, match="triangle inequality"):
        odd = ws.load_robot(path, placement=placement, tool=tool)
    document = result.document | {"robot": result.document["robot"] | {"model_hash": odd.model_hash}}
    with pytest.warns(UserWarning, match="triangle inequality") as said:
        ws.Result(document, volume=result.volume).render(robot=path)
    assert len(said) == 1


def test_another_arm_is_not_drawn_under_the_name_of_the_first(blank, arm, tmp_path):
    _, result = arm
    (tmp_path / "longer.xml").write_text(ARM.format(0.41).replace("arm", "longer", 1))
    for other in (tmp_path / "longer.xml", "scara", ws.load_robot("scara")):
        name = "longer" if isinstance(other, Path) else "scara"
        message = rf"robot: {name} \(model \w{{8}}\) is another arm than that of the result, arm \(model \w{{8}}\)"
        with pytest.raises(ws.InputError, match=message):
            result.render(robot=other)
    assert not blank


def test_the_same_arm_elsewhere_is_not_drawn_either(blank, arm):
    path, result = arm
    placed = ws.load_robot(path, placement=ws.Transform(position_m=(0, 0, 1)))
    with pytest.raises(ws.InputError, match=r"robot: arm goes from world to tool where it is placed.* the same base"):
        result.render(robot=placed)


def test_of_several_robots_it_is_the_one_that_is_given(blank):
    arms = [ws.load_robot(name) for name in ("scara", "phantom_omni")]
    both = ws.shared_workspace(arms, ws.Sobol(500), voxel_size_m=0.05, indices=["manipulability"], device="cpu")
    tip = arms[1].forward_kinematics(np.zeros(6))[0, :3, 3]
    both.render(robot="phantom_omni", configuration=np.zeros(6))
    ends = [layer.points[-1] for layer in blank[-1].layers if isinstance(layer, Rods)]
    assert len(ends) == 2 and np.linalg.norm(np.array(ends) - tip, axis=1).min() < 1e-6
    with pytest.raises(ws.InputError, match=r"of the result, scara \(model \w+\) and phantom_omni \(model \w+\)"):
        both.render(robot="puma560")


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"view": "side"}, "view: 'side' is not a view; allowed: boundary, solid"),
        ({"index": "speed"}, "index: the volume has no 'speed'; it holds manipulability"),
        ({"view": "scatter", "index": "speed"}, "index: the map has no 'speed'"),
        ({"statistic": "mode"}, "the volume has no 'mode'"),
        ({"threshold": 0}, "threshold: is 0; allowed are values above 0, up to 1"),
        ({"alpha": 1.5}, "alpha: is 1.5"),
        ({"elevation_deg": 90}, "elevation_deg: is 90"),
        ({"view": "slice", "at": (9, None, None)}, "x: the plane x = 9 m misses the workspace"),
        ({"view": "slice", "at": (0, 0)}, "at: must be the three planes x, y, z"),
    ],
)
def test_errors_name_what_is_there(planar_result, options, message):
    with pytest.raises(InputError, match=message):
        planar_result.render(**options)


def test_results_without_volume_say_so():
    with pytest.raises(InputError, match="the result of bare holds no occupied voxel"):
        picture([Subject("bare")])
    with pytest.raises(InputError, match="the result of bare holds neither a map nor a sample"):
        picture([Subject("bare")], "scatter")


def test_sparse_voxels_are_merged_until_gaps_close():
    count = np.random.default_rng(0).poisson(1.0, (96, 96, 96))
    dense = Subject("sparse", volume=VolumeData(0.01, (0, 0, 0), count)).dense_voxels()
    assert dense.voxel_size_m == pytest.approx(0.02)
    assert dense.count.sum() == count.sum()
    full = random_volume((30, 20, 10))
    assert Subject("coarse", volume=full).dense_voxels() is full


@pytest.mark.parametrize("view", ["boundary", "solid"])
def test_a_workspace_known_by_its_surface_is_drawn_face_by_face_with_all_legs(blank, view):
    result = ws.parallel_workspace("six_pus", method="exact", device="cpu")
    figure = result.render(view)
    (scene,) = blank
    faces = [layer for layer in scene.layers if isinstance(layer, DrawnSurface)]
    assert len(faces) == 11 and {layer.alpha for layer in faces} == {0.1 if view == "boundary" else 1.0}
    assert sum(len(layer.faces) for layer in faces) == len(result.meshes["workspace"].faces)
    assert sum(isinstance(layer, Rods) for layer in scene.layers) == 6
    labels = labels_of(figure)
    assert "six_pus" in labels and "leg 4 at its upper limit" in labels


def test_slices_of_a_set_in_a_plane_are_that_plane_alone():
    flat = Subject("flat", volume=VolumeData(0.1, (0, 0, 2), np.ones((6, 5, 1), int)))
    for subject, count, said in (
        (flat, 1, "slices at z = 0.25 m"),
        (replace(flat, volume=VolumeData(0.1, (0, 0, 0), np.ones((6, 5, 4), int))), 3, "slices at x = "),
    ):
        drawing = VIEWS["slice"]([subject], CHOICE)
        assert len([layer for layer in drawing.layers if isinstance(layer, Plates)]) == count
        assert drawing.notes[-1].startswith(said)
