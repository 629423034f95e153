"""Pictures of space: what hides what, and whether every number can be read."""

from itertools import combinations

import numpy as np
import pytest
import trimesh

from wsrender.results import drawing
from wsrender.results.drawing.box import space_around, towards_eye
from wsrender.results.drawing.camera import Camera
from wsrender.results.drawing.depth import OVERSAMPLING, DepthBuffer
from wsrender.results.drawing.faces import faces_of
from wsrender.results.drawing.style import DPI
from wsrender.volume.distribution_map import DistributionMap

SIZE = (300, 260)
EYES = [(-58, 24), (122, -24), (-125, 28), (-90, 0), (200, 70), (30, 5)]
EXTENTS = [(1, 1, 1), (1, 1, 0), (1, 0.01, 1), (0.3, 2, 0.1), (1e-4, 1e-4, 2e-4), (3000, 10, 900)]
FRONT = Camera(np.zeros(3), np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0]), 1.0)


@pytest.mark.parametrize("eye", EYES)
@pytest.mark.parametrize("extent", EXTENTS, ids=str)
def test_numbers_and_names_of_a_box_do_not_overlap_and_are_not_cut(eye, extent):
    points = np.random.default_rng(0).uniform(-1, 1, (50, 3)) * extent + 0.3
    for inches in ((5.3, 4.75), (4.4, 4.1)):
        size = round(inches[0] * DPI), round(inches[1] * DPI)
        labels = space_around(points, size, *eye).labels()
        assert [label.text for label in labels[-3:]] == ["x [m]", "y [m]", "z [m]"]
        assert not any(a.overlaps(b) for a, b in combinations(labels, 2))
        for label in labels:
            assert abs(label.x) + label.half[0] <= size[0] / size[1] and abs(label.y) + label.half[1] <= 1


@pytest.mark.parametrize("eye", EYES)
def test_at_most_the_number_at_a_corner_is_left_out(eye):
    """A grid line without its number cannot be read; where there is no room there are fewer lines."""
    for seed in range(20):
        points = np.random.default_rng(seed).uniform(-1, 1, (9, 3)) * [1, 0.8, 0.7] + 0.3
        space = space_around(points, (1060, 950), *eye)
        numbers = len(space.labels()) - 3
        assert numbers >= sum(len(space.ticks(axis)) for axis in range(3)) - 2


@pytest.mark.parametrize("extent", EXTENTS, ids=str)
def test_drawn_texts_do_not_overlap(extent):
    position = np.random.default_rng(0).uniform(-1, 1, (50, 3)) * extent + 0.3
    figure = drawing.scatter(DistributionMap(position, {"w": position[:, 0]}), title="arm")
    figure.draw_without_rendering()
    boxes = [text.get_window_extent() for text in (*figure.axes[0].texts, *figure.texts)]
    assert len(boxes) > 9 and not any(a.overlaps(b) for a, b in combinations(boxes, 2))
    assert all(figure.bbox.x0 <= box.x0 and box.x1 <= figure.bbox.x1 for box in boxes)


def test_the_nearest_triangle_is_seen_where_two_pass_through_each_other():
    """The painter's way, whole triangles from the back to the front, shows one of them everywhere."""
    one = np.array([[-0.8, -0.5, -0.8], [0.8, 0.5, -0.8], [0.0, 0.0, 0.8]])  # left half nearer to the eye at y < 0
    other = one * [1, -1, 1]
    buffer = DepthBuffer.of(FRONT, SIZE, np.stack([one, other]))
    rows, columns = np.nonzero(buffer.nearest >= 0)
    middle = (columns + 0.5) * 2 / buffer.nearest.shape[0] - SIZE[0] / SIZE[1]
    expected = np.where(middle < 0, 0, 1)
    clear = np.abs(middle) > 0.01
    np.testing.assert_array_equal(buffer.nearest[rows, columns][clear], expected[clear])
    area = 0.5 * 1.6 * 1.6 / 4 * buffer.nearest.shape[0] ** 2
    assert len(rows) == pytest.approx(area, rel=0.01)


def test_each_pixel_shows_the_nearest_triangle_around_its_middle_in_the_mean_of_its_colours():
    """Triangles of all sizes, with upright and level sides, partly outside the picture and without area."""
    random = np.random.default_rng(5)
    corners = random.normal(0, 0.9, (120, 1, 3)) + random.normal(0, 1, (120, 3, 3)) * random.uniform(0, 1, (120, 1, 1))
    corners[:20, 1, 0], corners[:20, 2, 2], corners[20, 2] = corners[:20, 0, 0], corners[:20, 0, 2], corners[20, 0]
    colors = random.uniform(0, 1, (120, 3, 3))
    size, n = (64, 48), OVERSAMPLING
    buffer = DepthBuffer.of(FRONT, size, corners)
    column, row = (np.arange(n * edge) + 0.5 for edge in size)
    at = np.stack(np.meshgrid(column * 2 / (n * 48) - 64 / 48, 1 - row * 2 / (n * 48)), axis=-1)
    nearness, seen, color = np.full(at.shape[:2], -np.inf), np.full(at.shape[:2], -1), np.zeros((*at.shape[:2], 3))
    for k, (triangle, shades) in enumerate(zip(corners, colors, strict=True)):
        sides = np.roll(triangle, -1, axis=0) - triangle
        parts = np.stack(
            [d[0] * (at[..., 1] - p[2]) - d[2] * (at[..., 0] - p[0]) for p, d in zip(triangle, sides, strict=True)]
        )
        if not (whole := parts.sum(axis=0)).all():
            continue
        shares = np.roll(parts / whole, -1, axis=0)  # of a corner: the side opposite to it
        near = np.tensordot(shares, -triangle[:, 1], axes=(0, 0))
        front = (shares >= 0).all(axis=0) & (near > nearness)
        nearness[front], seen[front] = near[front], k
        color[front] = np.tensordot(shares, shades, axes=(0, 0))[front]
    assert len(np.unique(seen)) > 40
    np.testing.assert_array_equal(buffer.nearest, seen)
    np.testing.assert_allclose(buffer.nearness[seen >= 0], nearness[seen >= 0], atol=1e-6)
    total, covered = (a.reshape(48, n, 64, n, -1).sum(axis=(1, 3)) for a in (color, seen >= 0))
    image = buffer.image(colors, 0.5)
    np.testing.assert_allclose(image[..., :3], total / np.maximum(covered, 1), atol=1e-5)
    np.testing.assert_allclose(image[..., 3:], 0.5 * covered / n**2, atol=1e-6)


def test_a_sphere_is_seen_without_gaps_and_by_its_front():
    ball = trimesh.creation.icosphere(4, 0.8)
    buffer = DepthBuffer.of(FRONT, SIZE, np.asarray(ball.triangles))
    height, width = buffer.nearest.shape
    row, column = np.indices((height, width)) + 0.5
    across = np.hypot((column - width / 2) * 2 / height, (row - height / 2) * 2 / height)
    assert (buffer.nearest[across < 0.79] >= 0).all() and (buffer.nearest[across > 0.81] < 0).all()
    inside = across < 0.75
    np.testing.assert_allclose(buffer.nearness[inside], np.sqrt(0.64 - across[inside] ** 2), atol=0.01)
    points = np.array([[0, -0.9, 0], [0, -0.8, 0.05], [0, 0.0, 0], [0, 0.9, 0], [0.9, 0.9, 0]])
    assert buffer.hides(points).tolist() == [False, False, True, True, False]


def test_what_a_surface_hides_of_an_arm_lies_below_it():
    """An arm along the line of sight's normal, half of it behind a plate."""
    eye = towards_eye(-58, 24)
    right = np.cross(-eye, [0, 0, 1.0])
    right /= np.linalg.norm(right)
    up = np.cross(right, -eye)
    plate = np.array([a * right + b * up + 0.2 * eye for a, b in ((0, -1), (1, -1), (1, 1), (0, 1))])
    mesh = trimesh.Trimesh(plate, [[0, 1, 2], [0, 2, 3]], process=False)
    arm = np.array([-0.8 * right, 0.0 * right, 0.8 * right])
    axes = drawing.robot(arm[None], surface=faces_of(mesh, None)).axes[0]
    (surface,) = axes.images
    sticks = [line for line in axes.lines if line.get_linestyle() == "-"]
    (joint,) = (line.get_xdata()[0] for line in axes.lines if line.get_marker() == "o")  # at the edge of the plate
    for line in sticks:
        x = line.get_xdata() - joint
        assert (line.get_zorder() < surface.get_zorder()) == (x.mean() > 0)
        assert min(x) >= -0.01 or max(x) <= 0.01
    assert {line.get_zorder() < surface.get_zorder() for line in sticks} == {True, False}
    marks = {line.get_marker(): line.get_zorder() for line in axes.lines if line.get_linestyle() == "None"}
    assert marks["s"] > surface.get_zorder() > marks["*"]
