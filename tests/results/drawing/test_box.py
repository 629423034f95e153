import numpy as np
import pytest

from wsrender.results.drawing.box import space_around

SIZE = (600, 500)
DIRECTIONS = [(-58, 24), (30, 24), (130, -40), (200, 70)]
POINTS = np.random.default_rng(0).normal(size=(50, 3)) * [1, 2, 0.5]


@pytest.mark.parametrize("eye", DIRECTIONS)
def test_the_picture_holds_the_box_and_room_for_its_numbers(eye):
    space = space_around(POINTS, SIZE, *eye)
    assert (space.lower < POINTS).all() and (space.upper > POINTS).all()
    seen = np.abs(space.camera.to_picture(np.array([space.lower, space.upper, *POINTS])))
    assert (seen < [SIZE[0] / SIZE[1] - 0.2, 0.85]).all()


@pytest.mark.parametrize("eye", DIRECTIONS)
def test_the_projection_is_that_of_the_eye(eye):
    azimuth, elevation = np.radians(eye)
    camera = space_around(POINTS, SIZE, *eye).camera
    towards = [np.cos(azimuth) * np.cos(elevation), np.sin(azimuth) * np.cos(elevation), np.sin(elevation)]
    np.testing.assert_allclose(-camera.forward, towards, atol=1e-12)
    moved = camera.to_picture(camera.center + np.array([towards, camera.up, [0, 0, 1]]))
    np.testing.assert_allclose(moved[0], 0, atol=1e-12)
    np.testing.assert_allclose(moved[1], [0, 1 / camera.half_height], atol=1e-12)
    np.testing.assert_allclose(moved[2], [0, np.cos(elevation) / camera.half_height], atol=1e-12)


@pytest.mark.parametrize("eye", DIRECTIONS)
def test_numbers_stand_on_the_outline_of_the_box(eye):
    space = space_around(POINTS, SIZE, *eye)
    corners = np.stack(np.meshgrid(*zip(space.lower, space.upper, strict=True)), axis=-1).reshape(-1, 3)
    seen = space.camera.to_picture(corners)
    for axis in range(3):
        start, end = space.camera.to_picture(np.stack(space.edge(axis)))
        along = end - start
        beside = (seen - start) @ np.array([-along[1], along[0]])
        assert (beside > -1e-9).all() or (beside < 1e-9).all()


def test_ticks_are_round_and_inside():
    space = space_around(POINTS, SIZE, -58, 24)
    for axis in range(3):
        ticks = space.ticks(axis)
        assert len(ticks) >= 2
        assert (ticks >= space.lower[axis]).all() and (ticks <= space.upper[axis]).all()
        np.testing.assert_allclose(ticks / 0.25, np.round(ticks / 0.25), atol=1e-9)


def test_a_planar_set_has_a_legible_box():
    space = space_around(POINTS * [1, 1, 0], SIZE, -58, 24)
    span = space.upper - space.lower
    assert span[2] == pytest.approx(0.3 * span.max(), rel=0.05)
