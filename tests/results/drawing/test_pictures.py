import hashlib
import subprocess
import sys
from dataclasses import replace

import matplotlib as mpl
import numpy as np
import pytest
import trimesh
from matplotlib.collections import PathCollection
from PIL import Image

import wsrender as ws
from tests.results.export.sample_data import ODD_NAMES, random_map, random_volume
from wsrender.analyses.robot_comparison.pictures import side_by_side
from wsrender.errors import InputError
from wsrender.results import drawing
from wsrender.results.drawing.box import AZIMUTH_DEG, ELEVATION_DEG, space_around
from wsrender.results.drawing.distribution import finite, histogram_data
from wsrender.results.drawing.style import DPI
from wsrender.results.drawing.view import PLACE
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.volume_data import VolumeData

SKELETON = np.cumsum(np.random.default_rng(3).normal(size=(3, 5, 3)), axis=1)


def dots_of(figure):
    (dots,) = (each for each in figure.axes[0].collections if isinstance(each, PathCollection))
    return dots


def camera_of(points):
    """That of a picture of space which holds the points."""
    size = round(PLACE[2] * DPI), round(PLACE[3] * DPI)
    return space_around(points, size, AZIMUTH_DEG, ELEVATION_DEG).camera


def drawn_plane(figure) -> tuple[np.ndarray, list[float]]:
    """Values (vertical, horizontal) and extent [m] of the first image in a figure."""
    (image,) = figure.axes[0].images
    return np.ma.filled(image.get_array(), np.nan), image.get_extent()


@pytest.mark.parametrize(("axis", "name"), list(enumerate("xyz")))
def test_slice_shows_the_voxels_of_its_plane_where_they_are(axis, name):
    volume = random_volume((5, 4, 3))
    layer = 2
    at = volume.centers(axis)[layer] + 0.4 * volume.voxel_size_m
    values, extent = drawn_plane(drawing.slice_plane(volume, **{name: at}, index="x", statistic="mean"))
    np.testing.assert_array_equal(values, volume.statistics["mean"]["x"].take(layer, axis).T)
    lower, upper = volume.origin_m, volume.origin_m + np.array(volume.count.shape) * volume.voxel_size_m
    horizontal, vertical = [across for across in range(3) if across != axis]
    expected = [lower[horizontal], upper[horizontal], lower[vertical], upper[vertical]]
    np.testing.assert_allclose(extent, expected, atol=1e-12)


def test_slice_at_a_voxel_border_shows_the_voxel_above_it_and_the_upper_end_the_last():
    volume = VolumeData(0.1, (0, 0, 2), np.arange(1, 4).reshape(1, 1, 3))
    for z, count in ((0.2, 1), (0.3, 2), (0.4, 3), (0.5, 3)):
        values, _ = drawn_plane(drawing.slice_plane(volume, z=z))
        assert values == count


def test_colours_of_robots_side_by_side_span_their_values_alone():
    """Also where each robot's values are all the same: a single slice would widen its range."""
    count = np.ones((3, 3, 3), int)
    volumes = {
        name: VolumeData(0.1, (0, 0, 0), count, {"maximum": {"x": np.full(count.shape, value)}})
        for name, value in (("a", 5.5), ("b", 7.0))
    }
    figure = side_by_side(volumes, index="x")
    images = [image for axes in figure.axes for image in axes.images]
    assert len(images) >= 6 and {(image.norm.vmin, image.norm.vmax) for image in images[:6]} == {(5.5, 7.0)}


def test_robots_side_by_side_are_cut_where_most_voxels_are_occupied():
    """Not where most hold a value: labels of voxels without samples count for nothing."""
    count = np.zeros((3, 3, 6), int)
    count[:2, :2, 1] = 1
    label = np.where(count > 0, 1.0, np.nan)
    label[:, :, 4] = 0.0
    volume = VolumeData(0.1, (0, 0, 0), count, {"maximum": {"x": label}})
    figure = side_by_side({"a": volume, "b": volume}, index="x")
    shown = np.ma.filled(figure.axes[0].images[0].get_array(), np.nan)
    np.testing.assert_array_equal(shown, label[:, :, 1].T)


@pytest.mark.parametrize("vectors", [np.nan, 1.0])
def test_vectors_of_a_volume_without_occupied_voxels_are_not_drawn(vectors):
    shape = (3, 4, 5)
    volume = VolumeData(0.1, (0, 0, 0), np.zeros(shape, int), vectors={"force": np.full((*shape, 3), vectors)})
    with pytest.raises(InputError, match="volume: has no occupied voxel"):
        drawing.vector_planes(volume)


def test_slice_without_coordinate_shows_zero_or_the_fullest_plane():
    count = np.ones((2, 2, 3), int)
    count[0, 0, 0] = 0
    for first, layer in ((-2, 2), (5, 1)):
        volume = VolumeData(0.1, (0, 0, first), count)
        assert f"z = {(first + layer + 0.5) * 0.1:.3g} m" in drawing.slice_plane(volume).axes[0].get_title()
        volume = VolumeData(0.1, (0, first, 0), count.transpose(0, 2, 1))
        assert f"y = {(first + layer + 0.5) * 0.1:.3g} m" in drawing.slice_plane(volume, axis="y").axes[0].get_title()
    with pytest.raises(InputError, match="axis: must be x, y or z, not 'yz'"):
        drawing.slice_plane(volume, axis="yz")


@pytest.mark.parametrize(("at_zero", "shown"), [(4, 0.05), (3, 0.15)])
def test_slice_without_coordinate_shows_no_plane_that_is_almost_empty(at_zero, shown):
    count = np.ones((4, 4, 2), int)
    count[:, :, 0] = np.arange(16).reshape(4, 4) < at_zero
    title = drawing.slice_plane(VolumeData(0.1, (0, 0, 0), count)).axes[0].get_title()
    assert title.startswith(f"z = {shown} m")


def test_slice_without_coordinate_shows_a_plane_with_values():
    """A product of two robots is known where both reach: not at 0 here."""
    product = np.full((3, 3, 3), np.nan)
    product[:, :, 2] = 0.5
    volume = VolumeData(0.1, (0, 0, 0), np.ones((3, 3, 3), int), {"product": {"x": product}})
    assert drawing.slice_plane(volume, statistic="product").axes[0].get_title().startswith("z = 0.25 m")


def test_colours_span_the_whole_volume_not_the_slice():
    volume = random_volume((5, 4, 3))
    values = volume.statistics["maximum"]["manipulability"]
    for z in volume.centers(2):
        (image,) = drawing.slice_plane(volume, z=z).axes[0].images
        assert image.get_clim() == (np.nanmin(values), np.nanmax(values))
        assert image.get_cmap().name == "viridis"


def test_three_slices_have_equal_scales_and_a_labelled_colour_bar():
    figure = drawing.slices(random_volume((5, 4, 3)), at=(None, None, 0.6), title="arm")
    *panels, bar = figure.axes
    assert [axes.get_aspect() for axes in panels] == [1.0] * 3
    assert [axes.get_xlabel() for axes in panels] == ["y [m]", "x [m]", "x [m]"]
    assert [axes.get_ylabel() for axes in panels] == ["z [m]", "z [m]", "y [m]"]
    assert bar.get_ylabel() == "Maximum of manipulability [m³]"
    assert figure.get_suptitle() == "arm"
    assert all("(world)" in axes.get_title() for axes in panels)


def test_volume_with_counts_alone_shows_counts():
    volume = VolumeData(0.1, (0, 0, 0), np.array([[[0, 3]]]))
    values, _ = drawn_plane(drawing.slice_plane(volume, x=0.05))
    np.testing.assert_array_equal(values, [[np.nan], [3]])


def test_scatter_colours_each_point_by_its_index():
    samples = random_map()
    figure = drawing.scatter(samples, "x")
    cloud, camera = dots_of(figure), camera_of(samples.position)
    order = np.argsort(camera.nearness(samples.position))  # the nearest is drawn last, over the others
    np.testing.assert_allclose(cloud.get_offsets(), camera.to_picture(samples.position[order]), atol=1e-12)
    values = samples.indices["x"][order]
    expected = mpl.colormaps["viridis"]((values - values.min()) / (values.max() - values.min()))
    np.testing.assert_allclose(cloud.get_facecolor(), expected, atol=1 / 255)
    assert figure.axes[1].get_ylabel() == "x [rad]"


def test_space_has_equal_scales_in_metres():
    figure = drawing.scatter(random_map())
    axes = figure.axes[0]
    inches = axes.get_position().size * figure.get_size_inches()
    spans = np.ptp([axes.get_xlim(), axes.get_ylim()], axis=1)
    np.testing.assert_allclose(inches / spans, inches[0] / spans[0], rtol=1e-3)
    assert {"x [m]", "y [m]", "z [m]"} <= {text.get_text() for text in axes.texts}


def test_large_maps_are_thinned_evenly():
    position = np.zeros((100_000, 3))
    position[:, 0] = np.arange(100_000)
    shown = dots_of(drawing.scatter(DistributionMap(position, {}))).get_offsets()
    along = camera_of(position).to_picture(np.array([[0.0, 0, 0], [99_999, 0, 0]]))
    share = (shown - along[0]) @ (along[1] - along[0]) / ((along[1] - along[0]) ** 2).sum()
    x = np.sort(np.round(share * 99_999, 6))
    assert (len(x), x[0], x[-1]) == (30_000, 0, 99_999)
    assert np.ptp(np.diff(x)) <= 1.001


def test_histogram_has_a_panel_per_index_whose_bars_sum_to_all_samples():
    samples = random_map()
    figure = drawing.histogram(samples)
    panels = [axes for axes in figure.axes if axes.get_visible()]
    assert len(panels) == len(ODD_NAMES)
    for axes, name in zip(panels, ODD_NAMES, strict=True):
        assert axes.patches[0].get_data().values.sum() == pytest.approx(100)
        assert axes.lines[0].get_xdata()[0] == pytest.approx(samples.indices[name].mean(), rel=1e-6)


def test_long_names_below_histograms_do_not_overlap():
    samples = random_map(names=("dynamic_order_independent_manipulability", "dynamic_harmonic_mean_manipulability"))
    units = dict.fromkeys(samples.indices, "(1/(kg m))^2")
    figure = drawing.histogram(replace(samples, units=units))
    figure.draw_without_rendering()
    first, second = (axes.xaxis.label.get_window_extent() for axes in figure.axes)
    assert first.x1 < second.x0


def test_histograms_are_of_finite_values(tmp_path):
    """Samples that have none, as of a user's index, are in no interval; an index without any has words instead."""
    samples = random_map(100, names=("some", "all", "none"))
    samples.indices["some"][::2] = np.nan
    samples.indices["some"][1] = np.inf
    samples.indices["none"][:] = np.nan
    edges, share = histogram_data(finite(samples.indices["some"]))
    kept = samples.indices["some"][3::2]
    assert (edges[0], edges[-1]) == (kept.min(), kept.max()) and share.sum() == pytest.approx(1)
    some, all_of, none = drawing.histogram(samples).axes[:3]
    assert some.patches and all_of.patches and not none.patches
    assert [text.get_text() for text in none.texts] == ["no finite value"]
    drawing.write_histogram_csv(samples, tmp_path / "histogram.csv")
    rows = [row.split(",") for row in (tmp_path / "histogram.csv").read_text().splitlines()[1:]]
    assert {row[0] for row in rows} == {"some", "all"}
    assert sum(float(row[4]) for row in rows if row[0] == "some") == pytest.approx(1)


def test_histogram_csv_holds_what_is_drawn(tmp_path):
    drawing.write_histogram_csv(random_map(names=("manipulability",)), tmp_path / "histogram.csv")
    header, *rows = (tmp_path / "histogram.csv").read_text().splitlines()
    assert header == "index,unit,lower,upper,share"
    assert rows[0].startswith("manipulability,m³,")
    assert sum(float(row.split(",")[4]) for row in rows) == pytest.approx(1)


@pytest.mark.parametrize(("samples", "bars"), [(20, 5), (120, 12), (500, 50), (10_000, 50)])
def test_few_samples_have_few_bars(samples, bars):
    _, share = histogram_data(np.linspace(0.0, 1.0, samples))
    assert len(share) == bars and share.sum() == pytest.approx(1)


@pytest.mark.parametrize("noise", [0.0, 2.0**-52, 1e-12])
def test_an_index_that_is_constant_but_for_rounding_is_one_bar(noise):
    values = 1.0 + noise * np.arange(-3.0, 4.0)
    edges, share = histogram_data(values)
    assert (edges[0], edges[-1]) == (values.min(), values.max()) and share.tolist() == [1]


@pytest.mark.parametrize("value", [0.0, 0.25, -3.0])
def test_an_index_that_is_constant_has_one_number_below_its_bar(value):
    axes = drawing.histogram(DistributionMap(np.zeros((9, 3)), {"w": np.full(9, value)})).axes[0]
    assert axes.get_xticks().tolist() == [value]
    assert [label.get_text() for label in axes.get_xticklabels()] == [f"{value:.4g}".replace("-", "−")]
    bar = axes.patches[0].get_data()
    low, high = axes.get_xlim()
    assert bar.values.tolist() == [100] and low < bar.edges[0] < value < bar.edges[1] < high
    assert max(axes.get_yticks()) == 100


def test_arms_of_several_robots_have_a_colour_and_a_name_each():
    document = {"robots": [{"name": "left"}, {"name": "right"}]}
    figure = ws.Result(document, skeleton=SKELETON[:2]).plot.robot()
    entries = figure.axes[0].get_legend()
    named = {text.get_text(): line.get_color() for text, line in zip(entries.texts, entries.get_lines(), strict=True)}
    assert list(named)[:2] == ["left", "right"] and named["left"] != named["right"]
    thick = [line.get_color() for line in figure.axes[0].lines if line.get_linewidth() == 3.2]
    assert set(thick) == {named["left"], named["right"]}


@pytest.mark.parametrize("held", ["volume", "volumes"])
def test_an_arm_without_samples_is_drawn_in_the_surface_of_its_voxels(held):
    volume = VolumeData(0.1, (0, 0, 0), np.ones((6, 5, 4), int))
    data = {"volume": volume} if held == "volume" else {"volumes": {"only": volume}}
    figure = ws.Result({"robot": {"name": "arm"}}, skeleton=SKELETON[:1], **data).plot.robot()
    (image,) = figure.axes[0].images
    assert np.count_nonzero(np.asarray(image.get_array())[..., 3]) > 1000


def test_voxels_that_are_reached_once_have_no_scale_of_samples():
    count = np.ones((4, 4, 4), int)
    assert drawing.slices(VolumeData(0.1, (0, 0, 0), count)).axes[-1].get_ylabel() == "Reached voxels"
    assert drawing.slices(VolumeData(0.1, (0, 0, 0), 2 * count)).axes[-1].get_ylabel() == "Samples per voxel"


def test_robot_is_drawn_through_its_joints():
    figure = drawing.robot(SKELETON, random_map())
    camera = camera_of(np.concatenate([SKELETON.reshape(-1, 3), random_map().position]))
    lines = [line.get_xydata() for line in figure.axes[0].lines]
    for arm in (*SKELETON, SKELETON[0, 1:-1]):
        assert any(line.shape == (len(arm), 2) and np.allclose(line, camera.to_picture(arm)) for line in lines)
    labels = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert labels == ["base", "joint", "tip"]


THIN = {
    "planar": np.random.default_rng(0).normal(size=(50, 3)) * [1, 1, 0],
    "linear": np.linspace(0, 1, 50)[:, None] * [0, 1, 0],
    "one point": np.ones((50, 3)),
    "no rows": np.empty((0, 3)),
}


@pytest.mark.parametrize("position", list(THIN.values()), ids=list(THIN))
@pytest.mark.parametrize("names", [(), ("w",)], ids=["no index", "one index"])
def test_thin_sets_and_constant_values_are_drawn(tmp_path, position, names):
    samples = DistributionMap(position, {name: np.zeros(len(position)) for name in names})
    for name, figure in {"scatter": drawing.scatter(samples), "robot": drawing.robot(SKELETON, samples)}.items():
        drawing.save_figure(figure, tmp_path / f"{name}.png")
        assert np.ptp(np.asarray(Image.open(tmp_path / f"{name}.png").convert("L"))) > 100


@pytest.mark.parametrize("shape", [(1, 1, 1), (30, 1, 1), (30, 20, 1)], ids=str)
def test_thin_volumes_are_drawn(tmp_path, shape):
    figure = drawing.slices(random_volume(shape))
    drawing.save_figure(figure, tmp_path / "slices.png")
    with Image.open(tmp_path / "slices.png") as image:
        width, height = image.size
    assert 300 < height < width < 3000


def test_names_are_shown_as_they_are(tmp_path):
    names = ("$a_{b", "50 % \\alpha$x$")
    samples = random_map(names=names)
    figure = drawing.scatter(samples, names[0], title="robot $1$ & <2>")
    drawing.save_figure(figure, tmp_path / "scatter.svg")
    drawing.save_figure(drawing.histogram(samples), tmp_path / "histogram.png")
    assert figure.axes[1].get_ylabel() == "$a {b"


@pytest.mark.parametrize("suffix", ["png", "svg"])
def test_equal_pictures_are_equal_files(tmp_path, suffix):
    hashes = set()
    with mpl.rc_context():
        for k in range(2):
            mpl.rcParams["font.size"] = 10 + k  # the user's own settings play no part
            figures = (drawing.scatter(random_map()), drawing.slices(random_volume((5, 4, 3))))
            for number, figure in enumerate(figures):
                drawing.save_figure(figure, tmp_path / f"{number}.{suffix}")
            hashes.add(b"".join(hashlib.sha256(path.read_bytes()).digest() for path in sorted(tmp_path.iterdir())))
        assert len(hashes) == 1
        assert mpl.rcParams["font.size"] == 11


def test_no_display_and_no_pyplot_is_needed():
    code = (
        "import sys, numpy as np\n"
        "from wsrender.results import drawing\n"
        "from wsrender.volume.distribution_map import DistributionMap\n"
        "assert 'matplotlib' not in sys.modules\n"
        "drawing.scatter(DistributionMap(np.eye(3), {'w': np.arange(3.0)}))\n"
        "assert 'matplotlib.pyplot' not in sys.modules\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, env={"MPLBACKEND": "agg", "PATH": ""})


@pytest.mark.parametrize(
    ("draw", "message"),
    [
        (
            lambda: drawing.slice_plane(random_volume((2, 2, 2)), z=9),
            r"z: the plane z = 9 m misses the workspace, 0\.55",
        ),
        (lambda: drawing.slice_plane(random_volume((2, 2, 2)), x=0, y=0), "takes one of x, y, z"),
        (
            lambda: drawing.slice_plane(random_volume((2, 2, 2)), index="speed"),
            "no 'speed'; it holds manipulability",
        ),
        (
            lambda: drawing.slice_plane(random_volume((2, 2, 2)), statistic="mode"),
            "no 'mode'; it holds maximum, mean",
        ),
        (lambda: drawing.slices(VolumeData(0.1, (0, 0, 0), np.zeros((0, 0, 0), int))), "no occupied voxel"),
        (lambda: drawing.scatter(random_map(), "speed"), "no 'speed'; it holds manipulability"),
        (lambda: drawing.scatter(DistributionMap(np.eye(3), {}), "speed"), "no 'speed'; it holds no index"),
        (lambda: drawing.histogram(random_map(0)), "holds no values"),
        (lambda: drawing.robot(np.zeros((2, 3))), r"shape \(2, 3\)"),
        (lambda: drawing.save_figure(drawing.scatter(random_map(1)), "a.bmp"), r"must end in \.png or \.svg"),
    ],
)
def test_errors_name_what_is_there(draw, message):
    with pytest.raises(InputError, match=message):
        draw()


def test_a_shared_volume_shows_how_many_robots_reach_a_voxel():
    """Of an index its product, whatever number of indices there are."""
    ones = np.ones((2, 3, 4), np.float32)
    for names in (["x"], ["x", "y"]):
        statistics = {"number": {"robots": 2 * ones}, "product": dict.fromkeys(names, ones / 2)}
        volume = VolumeData(0.1, (0, 0, 0), np.ones((2, 3, 4), int), statistics, {"robots": "1"})
        assert drawing.slice_plane(volume).axes[-1].get_ylabel() == "Number of robots"
        assert drawing.slice_plane(volume, index=names[-1]).axes[-1].get_ylabel().startswith("Product of")


def test_what_robots_share_is_highlighted_in_their_workspace():
    box = trimesh.creation.box
    meshes = {"union": box((2, 2, 2)), "intersection": box((1, 1, 1))}
    document = {"robots": [{"name": "a"}, {"name": "b"}]}
    figure = ws.Result(document, skeleton=SKELETON[:2], meshes=meshes).plot.robot()
    assert "shared by at least two" in [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    (_, drawn) = (np.asarray(image.get_array()) for image in figure.axes[0].images)
    r, g, b = drawn[drawn[..., 3] > 0][:, :3].mean(axis=0)
    assert g > 2 * r and g > b
    assert len(ws.Result(document, skeleton=SKELETON[:2], meshes={"union": box()}).plot.robot().axes[0].images) == 1
