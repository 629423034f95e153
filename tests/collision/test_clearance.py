"""Clearance against MuJoCo's distances of every pair, and a closed form; its lower bound never lies above it."""

import numpy as np
import pytest

import wsrender as ws
from tests.collision.robots import drawn, random_text
from tests.collision.test_constraints_of_robots import ARM, arm
from tests.collision.test_labels import AROUND
from tests.golden.facts import bits_of
from wsrender.collision.distance import frames_of
from wsrender.documents.constraints import Constraints
from wsrender.errors import InputError
from wsrender.robot.collisions import clearance_of

NAMES = ["clearance", "clearance_lower_bound"]


def nearest(clearance, q, limit):
    """Least signed distance (N,) by MuJoCo over all pairs that may collide, each asked."""
    pairs, frames, least = clearance.pairs, frames_of(clearance.chain, q), np.full(len(q), limit)
    for number, (a, b) in enumerate(pairs.pairs):
        if number not in clearance.never:
            T_a, T_b = (frames[:, pairs.solids[k].joint + 1] @ pairs.solids[k].T for k in (a, b))
            least = np.minimum(least, clearance.distances.between(a, b, T_a, T_b, limit))
    return np.maximum(least, -limit)


@pytest.mark.parametrize("limit", [0.25, 0.02])
@pytest.mark.parametrize("seed", [0, 1, 2, 6, 7, 8])
def test_random_primitives_among_boxes_and_meshes(seed, limit):
    robot = ws.load_robot(random_text(seed, 2 + seed % 5))
    clearance, q = clearance_of(robot, None, AROUND), drawn(robot, 1_500)
    least, bound = clearance.least(q, limit), clearance.lower_bound(q, limit)
    assert np.array_equal(least, nearest(clearance, q, limit))
    assert (bound <= least).all() and (np.abs(bound) <= limit).all()
    assert least.min() < 0


def test_random_primitives_over_hilly_ground():
    """Whose pairs are bounded by lookups in its grid, those with the others by capsules."""
    heights = np.random.default_rng(0).uniform(0.05, 0.3, (5, 6)).tolist()
    ground = ws.HeightField(heights_m=heights, size_m=(0.8, 0.6), position_m=(0.1, 0.05, -0.1), rpy_deg=(0, 30, 0))
    robot = ws.load_robot(random_text(6, 4))
    clearance, q = clearance_of(robot, None, ws.Environment([ground])), drawn(robot, 150)
    assert 0 < len(clearance.lookups) < len(clearance.pairs.pairs)
    least, bound = clearance.least(q, 0.25), clearance.lower_bound(q, 0.25)
    assert np.array_equal(least, nearest(clearance, q, 0.25)) and (bound <= least).all()
    assert least.min() < 0 < bound.max()


def test_the_lower_bound_of_deep_solids_is_that_of_the_wholes():
    """What lies where the capsules around two parts of a box meet is not as deep in either as it is in the box."""
    block = ws.Environment([ws.Box(name="block", size_m=(1.2, 0.7, 0.7), position_m=(0.9, 0, 0))])
    robot = arm(base="")
    clearance, q = clearance_of(robot, None, block), drawn(robot, 2_000)
    least, bound = clearance.least(q, 1.0), clearance.lower_bound(q, 1.0)
    assert least.min() < -0.35 and (bound <= least).all()


@pytest.mark.parametrize("name", ["ur5e", "franka_panda", "kuka_iiwa14"])
def test_arms_of_capsules_have_their_clearance_as_bound(name):
    robot = ws.load_robot(name)
    clearance, q = clearance_of(robot, None, None), drawn(robot, 1_000)
    least, bound = clearance.least(q, 0.25), clearance.lower_bound(q, 0.25)
    assert np.array_equal(least, nearest(clearance, q, 0.25)) and (bound <= least).all()
    exact = all(solid.is_round for k, solid in enumerate(clearance.pairs.solids) if k in clearance.pairs.pairs)
    assert not exact or (least - bound).max() < 3e-6


def test_pairs_that_never_collide_say_nothing():
    """The Panda's first links stay a millimetre apart, whatever their joint does."""
    robot = ws.load_robot("franka_panda")
    clearance, q = clearance_of(robot, None, None), drawn(robot, 500)
    assert clearance.never
    pairs, frames = clearance.pairs, frames_of(clearance.chain, q)
    for number in clearance.never:
        a, b = pairs.pairs[number]
        T_a, T_b = (frames[:, pairs.solids[k].joint + 1] @ pairs.solids[k].T for k in (a, b))
        assert clearance.distances.between(a, b, T_a, T_b, 1.0).min() > 0


def test_a_ball_over_a_floor_is_as_far_as_the_closed_form_says(precision, device):
    """The ball of .05 m, .4 m beyond the second joint: .2 - .4 sin b - .05 above a floor at -.2 m, cut at .3."""
    b = np.linspace(-1, 1, 301)
    document = {
        "analysis": "indices_at",
        "robot": {"mjcf": ARM.format(world="", base="", one="")},
        "environment": {"items": [{"shape": "half_space", "name": "floor", "point_m": [0, 0, -0.2]}]},
        "configurations": np.column_stack([np.zeros(301), b]).tolist(),
        "indices": [*NAMES, "manipulability"],
        "index_options": {"clearance": {"limit_m": 0.3}},
        "task": ["x", "y"],
        **{"precision": precision, "device": device, "constraints": {"environment": False}},
    }
    asked = document | {"constraints": None}
    found, tolerance = ws.execute(asked).map.indices, 1e-6 if precision == "float32" else 1e-12
    expected = np.minimum(0.15 - 0.4 * np.sin(b), 0.3)
    free = expected >= 0  # of rejected rows no index is told
    assert found["clearance"][free] == pytest.approx(expected[free], abs=tolerance)
    assert np.isnan(found["clearance"][~free]).all() and not free.all()
    low = found["clearance_lower_bound"][free]
    assert low == pytest.approx(np.minimum(expected, 0.25)[free], abs=3e-6)
    assert not np.array_equal(found["manipulability"][free], found["clearance"][free])
    away = ws.execute(document).map.indices["clearance"]
    assert np.array_equal(away, np.full(301, 0.3, precision))  # the floor is only drawn, and nothing else can touch


@pytest.mark.parametrize("task", ["linear", "full"])
def test_voxels_hold_what_the_rows_do(task, precision, device):
    """Least, largest and mean by voxel, of admitted samples; and the same bits by chunks and threads."""
    asked = {
        "analysis": "workspace",
        "robot": {"library": "ur5e"},
        "constraints": {"self_collision": {"margin_m": 0.01}},
        "sampling": {"method": "sobol", "count": 3_000},
        **{"indices": ["manipulability", *NAMES], "task": task, "precision": precision, "device": device},
        **{"voxel_size_m": 0.2, "keep_map": True, "map_columns": ["configuration"], "refined_volume": None},
    }
    result = ws.execute(asked)
    robot, volume, rows = ws.load_robot("ur5e"), result.volume, result.map
    clearance = clearance_of(robot, Constraints(**asked["constraints"]), None)
    q = np.asarray(rows.configuration, np.float64)
    expected = {"clearance": clearance.least(q, 0.25), "clearance_lower_bound": clearance.lower_bound(q, 0.25)}
    assert expected["clearance"].min() >= 0.01
    cells = tuple((np.floor(rows.position / 0.2).astype(int) - volume.first_voxel).T)
    for name in NAMES:
        values = rows.indices[name]
        assert values == pytest.approx(expected[name], abs=1e-7)
        for statistic, reduce in (("minimum", np.minimum), ("maximum", np.maximum)):
            by_voxel = np.full(volume.shape, np.inf if statistic == "minimum" else -np.inf)
            reduce.at(by_voxel, cells, values)
            held = volume.occupied
            assert np.array_equal(volume.statistics[statistic][name][held], by_voxel[held].astype(precision))
        total = np.zeros(volume.shape)
        np.add.at(total, cells, values)
        mean = total[held] / volume.count[held]
        assert volume.statistics["mean"][name][held] == pytest.approx(mean, abs=1e-6)
    assert set(result.document["indices"]["clearance"]) >= {"minimum", "maximum", "unit"}
    if device == "cpu":
        assert bits_of(ws.execute(asked, threads=1, chunk_size=256)) == bits_of(result)


def test_what_constraints_exclude_and_do_not_ask_for_says_nothing():
    robot = ws.load_robot("ur5e")
    whole, drawn_only = clearance_of(robot, None, AROUND), clearance_of(robot, Constraints(environment=False), AROUND)
    own, unasked = clearance_of(robot, None, None), clearance_of(robot, Constraints(self_collision=False), None)
    assert len(whole.pairs.pairs) > len(own.pairs.pairs) == len(drawn_only.pairs.pairs) == len(unasked.pairs.pairs)
    names = [own.pairs.solids[k].name for k in own.pairs.pairs[0]]
    less = clearance_of(robot, Constraints(self_collision={"exclude": [names], "margin_m": 0.02}), None)
    assert len(less.pairs.pairs) == len(own.pairs.pairs) - 1 and less.pairs.margin(0) == 0


@pytest.mark.parametrize(
    ("job", "field", "message"),
    [
        ({"index_options": {"clearance": {"limit_m": 0}}}, "index_options.clearance.limit_m", "0.001 … 10 m, not 0"),
        ({"indices": ["dynamic_clearance"]}, "indices", "'clearance' is of shapes"),
    ],
)
def test_jobs_that_are_refused(job, field, message):
    with pytest.raises(InputError, match=message) as caught:
        ws.execute({"analysis": "workspace", "robot": {"library": "ur5e"}, "indices": ["clearance"]} | job)
    assert caught.value.field == field


def test_robots_without_shapes_and_mechanisms_are_refused():
    rows = [{"a": 0.3, "limits": [-1, 1]}] * 2
    with pytest.raises(InputError, match=r"indices: must not ask for clearance: .* has no shapes that may collide"):
        ws.evaluate_indices(ws.DHTable(convention="standard", rows=rows), [[0, 0]], ["clearance"])
    with pytest.raises(InputError, match="of the shapes of a serial arm"):
        ws.execute({"analysis": "parallel_workspace", "mechanism": "stewart_gough", "indices": NAMES})
