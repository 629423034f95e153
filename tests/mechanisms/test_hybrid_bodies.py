"""Bodies of hybrid mechanisms: against the parallel one that stands where its serial joints bring it."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.mechanisms.mechanisms import SPEC, poses_of
from tests.mechanisms.test_serial_bodies import three_bars
from wsrender.documents.mechanism import StewartGough
from wsrender.mechanisms.hybrid import reached_by_any, variants
from wsrender.mechanisms.mechanism import mechanism_of
from wsrender.mechanisms.membership import poses_labelled
from wsrender.mechanisms.serial_search import MOST_SLOW, serial_search
from wsrender.reach.evidence import REACHABLE, UNREACHABLE
from wsrender.run import execute

POST = {"shape": "box", "name": "post", "size_m": [0.15, 0.15, 2], "position_m": [0.4, 0.25, 0.5]}
PLATE = {"shape": "box", "name": "plate", "size_m": [0.7, 0.3, 0.04], "position_m": [0.05, 0, 0.06]}
BODIES = {
    "link_radius_m": 0.02,
    "platform": {"items": [PLATE]},
    "platform_gap_m": 0.06,
    "environment": {"items": [POST]},
    "margin_m": 0.005,
}
HEXAPOD = {"library": "stewart_gough", "length_m": [0.45, 0.9], "bodies": BODIES}
TABLE = {"limits_deg": [-30, 40], "levels": 4}
SLIDE = {"type": "prismatic", "axis": [1, 0, 0], "limits_m": [0.0, 0.2], "levels": 3}
TURN = {"limits_deg": [-25, 25], "levels": 3}
LEVEL = np.eye(3)[None]


def points(count, seed=0):
    return np.random.default_rng(seed).uniform([-0.35, -0.35, 0.4], [0.45, 0.45, 0.75], (count, 3))


def turned(degrees):
    return Rotation.from_euler("z", degrees, degrees=True).as_matrix()


def standing(degrees, shift=0.0):
    """The hexapod without serial joints, turned and shifted with its base; what stands around does not move."""
    half = np.deg2rad(degrees) / 2
    placement = {"position_m": [shift, 0, 0], "quat_wxyz": [np.cos(half), 0, 0, np.sin(half)]}
    return mechanism_of(StewartGough(length_m=(0.45, 0.9), placement=placement, bodies=BODIES))


def reached(mechanism, positions, rotations):
    """Whether platform poses of the world are reached by a mechanism that stands somewhere."""
    poses = np.linalg.inv(mechanism.T_world_base) @ poses_of(positions, rotations)
    return poses_labelled(mechanism, poses, device="cpu")[0] == REACHABLE


def test_what_stands_around_is_not_carried():
    """A turntable and a slide before the hexapod: at every level as of one that stands there."""
    tried, table = points(400), {**TABLE, "levels": 2}
    found = variants(SPEC.validate_python({**HEXAPOD, "before": [{**SLIDE, "levels": 2}, table]}))
    assert len(found) == 4
    at_once = np.zeros(len(tried), bool)
    for variant, (shift, degrees) in zip(found, [(x, a) for x in (0.0, 0.2) for a in (-30, 40)], strict=True):
        expected = reached(standing(degrees, shift), tried, np.eye(3))
        np.testing.assert_array_equal(reached_by_any([variant], tried, LEVEL, device="cpu"), expected)
        at_once |= expected
        carried = reached(
            mechanism_of(SPEC.validate_python(HEXAPOD)), (tried - [shift, 0, 0]) @ turned(degrees), turned(-degrees)
        )
        assert (expected & ~carried).sum() + (carried & ~expected).sum() > 3  # it would be another, were it carried
    np.testing.assert_array_equal(reached_by_any(found, tried, LEVEL, device="cpu"), at_once)


@pytest.mark.parametrize("joint", [SLIDE, TURN])
def test_the_platforms_shapes_stay_with_the_platform(joint):
    """Joints after it move the tool; the plate stays where the legs hold it."""
    tried = points(250)
    found = variants(SPEC.validate_python({**HEXAPOD, "after": [{**joint, "levels": 2}]}))
    for variant, value in zip(found, joint.get("limits_m") or joint["limits_deg"], strict=True):
        shift, R = ([value, 0, 0], np.eye(3)) if joint is SLIDE else (np.zeros(3), turned(-value))
        expected = reached(standing(0), tried - shift, R)
        np.testing.assert_array_equal(reached_by_any([variant], tried, LEVEL, device="cpu"), expected)
        assert 15 < expected.sum() < 235


def test_a_deltas_platform_does_not_turn_with_its_tool():
    """A hinge after a delta turns the tool, not the plate that keeps apart from a post."""
    plate = {"shape": "box", "size_m": [0.5, 0.06, 0.04], "position_m": [0, 0, 0]}
    post = {"shape": "cylinder", "radius_m": 0.03, "length_m": 3, "position_m": [0.1, 0.1, 0]}
    bodies = {"link_radius_m": 0.01, "platform": {"items": [plate]}, "environment": {"items": [post]}}
    delta = {"library": "delta", "bodies": bodies}
    tried = np.random.default_rng(2).uniform([-0.3, -0.3, -0.8], [0.3, 0.3, -0.5], (150, 3))
    alone = reached_by_any(variants(SPEC.validate_python(delta)), tried, LEVEL, device="cpu")
    hinge = [{"limits_deg": [0, 90], "levels": 2}]
    for variant in variants(SPEC.validate_python({**delta, "after": hinge})):
        np.testing.assert_array_equal(reached_by_any([variant], tried, LEVEL, device="cpu"), alone)
    free = reached_by_any(variants(SPEC.validate_python({"library": "delta"})), tried, LEVEL, device="cpu")
    assert 5 < alone.sum() < free.sum() - 5


def test_shapes_that_a_base_carries_meet_what_stands_around():
    """The first links of legs that stand on the ground never move, on a lift they come to the ceiling."""
    pillar = '<geom name="pillar" type="cylinder" size=".02 .1" pos="0 0 -.2"/><body pos='
    legs = three_bars(
        {"environment": {"items": [{"shape": "half_space", "normal": [0, 0, 1], "point_m": [0, 0, -0.25]}]}}
    )
    for leg in legs["legs"]:
        leg["robot"]["mjcf"] = leg["robot"]["mjcf"].replace("<body pos=", pillar, 1)
    home = np.eye(4)[None]
    ground = mechanism_of(SPEC.validate_python(legs))
    assert poses_labelled(ground, home, device="cpu")[0] == [REACHABLE]  # pillars stand in the floor, for good
    lift = {"type": "prismatic", "limits_m": [0.0, 0.2], "levels": 3}
    labels = [
        poses_labelled(variant.mechanism, home, device="cpu")[0][0]
        for variant in variants(SPEC.validate_python({**legs, "before": [lift]}))
    ]
    assert labels == [
        UNREACHABLE,
        REACHABLE,
        REACHABLE,
    ]  # of pillars that end 0.05 m below the floor


def test_values_between_the_levels_are_searched():
    """Against the union of 361 levels: what one of them reaches is found, what none does is not."""
    spec = SPEC.validate_python({**HEXAPOD, "before": [TABLE]})
    tried = points(150, seed=1)
    search = serial_search(spec)
    assert search.slow and not search.proves
    labels = search.labels(tried, np.eye(3), device="cpu")
    dense = reached_by_any(
        variants(SPEC.validate_python({**HEXAPOD, "before": [{**TABLE, "levels": 361}]})), tried, LEVEL
    )
    levels = reached_by_any(variants(spec), tried, LEVEL)
    differ = (labels == REACHABLE) != dense
    assert differ.sum() <= 3 and (dense & ~levels).sum() >= 5  # the search finds more than its levels hold
    assert 20 < dense.sum() < 130
    level = reached(standing(0), tried, np.eye(3))
    assert (level & ~dense).sum() == 0


def test_a_pose_takes_few_tries_where_bodies_are_asked(monkeypatch):
    """One cell of a pose after the other, and no more once it is reached, or MOST_SLOW were tried."""
    asked = []

    def counting(mechanism, poses, **options):
        asked.append(len(poses))
        return poses_labelled(mechanism, poses, **options)

    monkeypatch.setattr("wsrender.mechanisms.serial_search.poses_labelled", counting)
    spec, middle = SPEC.validate_python({**HEXAPOD, "before": [TABLE]}), np.array([[0.0, 0.0, 0.55]])
    assert serial_search(spec).labels(middle, np.eye(3), device="cpu") == [REACHABLE] and sum(asked) <= 3
    asked.clear()
    ball = {"items": [{"shape": "sphere", "radius_m": 0.2, "position_m": [0, 0, 0.6]}]}
    full = SPEC.validate_python({**HEXAPOD, "before": [TABLE], "bodies": {**BODIES, "environment": ball}})
    assert serial_search(full).labels(middle, np.eye(3), device="cpu") == [UNREACHABLE]
    assert 8 <= sum(asked) <= 2 * MOST_SLOW
    asked.clear()
    serial_search(spec).labels(middle, np.eye(3), around_m=0.05, device="cpu")
    assert not asked  # proofs are of legs alone


def test_a_job_counts_what_collides_at_all_levels():
    job = {"analysis": "parallel_workspace", "voxel_size_m": 0.1, "device": "cpu", "refined_volume": None}
    before = {**HEXAPOD, "before": [{**TABLE, "levels": 2}]}
    result = execute({**job, "mechanism": before})
    samples = result.document["samples"]
    assert samples["admitted"] + samples["rejected"]["collision"] == samples["drawn"]
    each = []
    for degrees in (-30, 40):
        placement = {"position_m": [0, 0, 0], "rpy_deg": [0, 0, degrees]}
        alone = execute(
            {**job, "mechanism": {**HEXAPOD, "placement": placement}, "orientation": {"rpy_deg": [0, 0, -degrees]}}
        )
        each.append(alone.document["samples"])
    assert samples["drawn"] == sum(one["drawn"] for one in each)
    assert samples["rejected"]["collision"] == sum(one["rejected"]["collision"] for one in each) > 10
    assert result.skeleton is not None and result.volume.n_occupied


def test_a_refined_volume_of_a_hybrid_lies_between_that_of_one_level_and_that_without_bodies():
    common = {"voxel_size_m": 0.1, "refined_volume": 0.1, "device": "cpu"}
    narrow = {**HEXAPOD, "before": [{"limits_deg": [-20, 20], "levels": 2}]}
    hybrid, one = ws.parallel_workspace(narrow, **common), ws.parallel_workspace(HEXAPOD, **common)
    free = ws.parallel_workspace({**narrow, "bodies": None}, **common)
    (low, high), value = one.document["headline"]["ci95"], hybrid.document["headline"]["value"]
    assert low < value < free.document["headline"]["ci95"][1] and high < free.document["headline"]["value"]
    assert "serial_joints_sampled" in [notice["code"] for notice in hybrid.document["warnings"]]
