import numpy as np
import pytest

from tests.mechanisms.mechanisms import known_ups, mechanism, poses_of, random_rotations, ups
from wsrender.errors import InputError
from wsrender.mechanisms.ball_region import ball_region
from wsrender.mechanisms.inverse_kinematics import inverse_kinematics

EDGE = 0.05


def voxel_volume(region, lower, upper) -> float:
    """Volume by centres of voxels of the lattice, as methods A and B count it."""
    axes = [np.arange(round(low / EDGE), round(high / EDGE)) for low, high in zip(lower, upper, strict=True)]
    cells = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    return region.contains((cells + 0.5) * EDGE).sum() * EDGE**3


@pytest.mark.parametrize(
    ("document", "exact"),
    [
        ("six_pus", 0.717344315),
        ({"library": "six_pus", "link_m": 2.5}, 0.963565768),
        ({"library": "six_pus", "platform_m": 2, "link_m": 2.25}, 1.317761291),
        (known_ups(), 5.352588701),
        (ups([[0, 0, 0]] * 6, [[0, 0, 0]] * 6, [1.0, 1.5]), 9.948376737),
    ],
)
def test_known_volumes(document, exact):
    """[SNK]'s mechanisms; values of DEFINITIONS section 9, to the half per cent of a lattice of 0.05 m."""
    region = ball_region(mechanism(document), np.eye(3))
    assert voxel_volume(region, [-2, -2, -2], [2, 2, 3.5]) == pytest.approx(exact, rel=5e-3)


def test_parts_of_the_known_six_pus():
    region = ball_region(mechanism("six_pus"), np.eye(3))
    assert region.inside_radii.tolist() == [2.5, 2.5, 2.7, 2.7, 2.6, 2.6] == region.outside_radii.tolist()
    # A_1 = n_1 L / (2 sqrt 3), n_1 = -y, u_1 = x, platform joint at n_1 l / sqrt 3; s = -a, a and -b, b.
    height = -5 / (2 * np.sqrt(3)) + 1.5 / np.sqrt(3)
    np.testing.assert_allclose(region.inside_centres[:2], [[-0.5, height, 0], [0.5, height, 0]], atol=1e-15)
    np.testing.assert_allclose(region.outside_centres[:2], [[-2.25, height, 0], [2.25, height, 0]], atol=1e-15)
    assert region.lower[2] == 0 and np.isinf(region.upper).all()


@pytest.mark.parametrize("document", ["stewart_gough", {"library": "six_pus", "slide_m": [0.0, 2.0]}, known_ups()])
def test_a_region_is_what_inverse_kinematics_says(document):
    """At random orientations: the region's points and those where every leg has a solution are the same."""
    mech, random = mechanism(document), np.random.default_rng(5)
    reach = np.abs(mech.base).max() + mech.upper.max() + mech.link.max()
    for rotation in random_rotations(random, 4):
        points = random.uniform(-reach, reach, (20_000, 3))
        expected = inverse_kinematics(mech, poses_of(points, rotation)).feasible
        np.testing.assert_array_equal(ball_region(mech, rotation).contains(points), expected)


def test_a_shell_without_a_hole_has_no_outside_ball():
    region = ball_region(mechanism(ups([[0, 0, 0]], [[0, 0, 0]], [0, 1])), np.eye(3))
    assert region.outside_centres.shape == (0, 3) and region.inside_radii.tolist() == [1.0]


@pytest.mark.parametrize(
    ("document", "words"),
    [
        ("delta", "is a delta leg"),
        (
            {"legs": [{"type": "PUS", "base_m": [0, 0, 0], "platform_m": [0, 0, 0], "axis": [1, 0, 0],
                       "slide_m": [0, 1], "link_m": 1}]},
            "is a PUS leg",
        ),
        ({"library": "stewart_gough", "minimum_leg_distance_m": 0.1}, "not only spheres"),
        (
            {"legs": [{"type": "UPS", "base_m": [0, 0, 0], "platform_m": [0, 0, 0], "length_m": [1, 2],
                       "base_cone": {"axis": [0, 0, 1], "half_angle_deg": 30}}]},
            "must have no cone",
        ),
    ],
)  # fmt: skip
def test_other_boundaries_are_refused(document, words):
    with pytest.raises(InputError, match=words):
        ball_region(mechanism(document), np.eye(3))


def test_pairs_on_one_side_are_no_pair():
    """Two sliders of one rail whose ranges overlap do not bound by balls alone."""
    leg = {"type": "PUS", "base_m": [0, 0, 0], "platform_m": [0, 0, 0], "axis": [1, 0, 0], "link_m": 2}
    legs = [{**leg, "slide_m": [-2, 1], "branch": "minus"}, {**leg, "slide_m": [0, 2], "branch": "plus"}]
    with pytest.raises(InputError, match="is a PUS leg"):
        ball_region(mechanism({"legs": legs}), np.eye(3))


def test_a_leg_that_hardly_moves_has_no_region():
    """A range of 1e-9 of the length was an empty workspace, in silence."""
    region = ball_region(mechanism(ups([[0, 0, 0]], [[0, 0, 0]], [1.0, 1.0 + 1e-7])), np.eye(3))
    assert region.outside_radii.tolist() == [1.0]
    with pytest.raises(InputError, match="must have limits 1e-08 m apart or more, not 1e-09 m") as caught:
        ball_region(mechanism(ups([[0, 0, 0]], [[0, 0, 0]], [1.0, 1.0 + 1e-9])), np.eye(3))
    assert caught.value.field == "legs.0"
