"""Labels of collisions against MuJoCo's own: all equal, wherever its distance says anything."""

import mujoco
import numpy as np
import pytest

import wsrender as ws
from tests.collision.robots import collides, drawn, nearest, random_text
from wsrender.collision.solids import BASE
from wsrender.documents.constraints import Constraints
from wsrender.engine import configurations, devices_of, merge, sweep
from wsrender.engine.rows import evaluate_samples
from wsrender.pipeline.evaluation import Evaluation
from wsrender.pipeline.pipeline import Pipeline
from wsrender.pipeline.sampling import plan_sampling
from wsrender.robot.constraints import constraints_for
from wsrender.robots.library import names
from wsrender.volume.lattice import LatticeBlock

UNSURE = 1e-6  # [m]: MuJoCo's own tolerance
SELF = Constraints(self_collision=True)
STONE = np.random.default_rng(0).normal(size=(80, 3))
STONE *= [0.2, 0.1, 0.05] / np.linalg.norm(STONE, axis=1, keepdims=True)
AROUND = ws.Environment(
    [
        ws.HalfSpace(name="floor", point_m=(0, 0, -0.4)),
        ws.Box(name="table", size_m=(0.4, 0.3, 0.1), position_m=(0.3, 0.1, 0.1), rpy_deg=(10, 20, 30)),
        ws.Cylinder(name="post", radius_m=0.05, length_m=0.6, position_m=(-0.2, 0.3, 0.0)),
        ws.Mesh(name="wedge", vertices_m=((0, 0, 0), (0.2, 0, 0), (0, 0.3, 0), (0, 0, 0.2)), position_m=(0.1, -0.3, 0)),
        ws.Mesh(name="stone", vertices_m=tuple(map(tuple, STONE.tolist())), position_m=(0.3, -0.1, 0.3)),
    ]
)


def pipeline(robot, q, constraints, precision="float32"):
    sampling = plan_sampling(robot.chain, q)
    return Pipeline(Evaluation(robot.chain), sampling, constraints, kept_rows=frozenset(), precision=precision)


def labels(robot, q, constraints, precision="float32", device="cpu"):
    """Number of the constraint that rejects each configuration, by the kernels."""
    return evaluate_samples(pipeline(robot, q, constraints, precision), device).rejected


def wrong(found, expected, distance):
    """Configurations whose labels differ where MuJoCo's distance says which is right."""
    return np.flatnonzero((found != expected) & (np.abs(distance) > UNSURE))


@pytest.mark.parametrize("name", names())
def test_arms_of_the_library(name, device):
    robot = ws.load_robot(name)
    (constraint,) = constraints_for(robot, SELF)
    q = drawn(robot, 20_000)
    differ = np.flatnonzero((labels(robot, q, (constraint,), device=device) > 0) != collides(robot, q))
    assert (np.abs(nearest(constraint, q[differ])) <= UNSURE).all()


@pytest.mark.parametrize("seed", [0, 1, 2, 6, 7, 8, 11, 12])  # of others a pair always collides
def test_random_primitives_with_margins_and_surroundings(seed, device):
    random = np.random.default_rng(seed)
    robot = ws.load_robot(random_text(seed, int(random.integers(2, 7))), placement=ws.Transform(position_m=(0.1, 0, 0)))
    margins = (0.0, 0.0) if seed % 2 else (0.02, 0.01)
    apart = {"self_collision": {"margin_m": margins[0]}, "environment": {"margin_m": margins[1]}}
    constraints = constraints_for(robot, Constraints(**apart), AROUND)
    q, precision = drawn(robot, 6_000), ("float32", "float64")[seed % 2]
    found = labels(robot, q, constraints, precision, device)
    least = [nearest(each, q) - each.margin_m for each in constraints]
    expected = np.where(least[0] < 0, 1, np.where(least[1] < 0, 2, 0))
    assert not wrong(found, expected, np.min(np.abs(least), axis=0)).size
    assert [each.name for each in constraints] == ["environment", "self_collision"]


PALLETISER = """<mujoco><compiler angle="radian"/><worldbody><body name="post">
    <geom type="cylinder" size=".1 .2" pos=".1 0 -.15"/>
    <body name="arm" pos="0 0 .1"><joint name="a" axis="0 1 0" ref=".1" range="-1.5 1.5"/>
      <geom type="capsule" size=".03" fromto="0 0 0 0 0 .5"/>
      <body name="forearm" pos="0 0 .5"><joint name="b" axis="0 1 0" range="-2 2"/>
        <geom type="capsule" size=".03" fromto="-.1 0 0 .5 0 0"/><site name="tool" pos=".5 0 0"/></body></body>
    <body name="bar" pos="-.15 .04 .1"><joint name="p" axis="0 1 0"/>
      <geom type="capsule" size=".02" fromto="0 0 .05 0 0 .5"/>
      <body name="rod" pos="0 0 .5"><joint name="r" axis="0 1 .3"/>
        <geom type="capsule" size=".02" fromto="0 0 0 .3 0 0"/></body></body></body></worldbody>
  <equality><joint joint1="p" joint2="a" polycoef="0 1 0 0 0"/>
    <joint joint1="r" joint2="b" polycoef=".2 -.5 0 0 0"/></equality></mujoco>"""


def test_bars_beside_the_arm_that_follow_its_joints(device):
    robot, model = ws.load_robot(PALLETISER), mujoco.MjModel.from_xml_string(PALLETISER)
    (constraint,) = constraints_for(robot, SELF)
    q, data = drawn(robot, 4_000), mujoco.MjData(model)
    distance, bars = np.empty(len(q)), np.zeros(len(q), bool)
    for i, (a, b) in enumerate(q):
        data.qpos[:] = a, b, a - 0.1, 0.2 - 0.5 * b
        mujoco.mj_forward(model, data)
        distance[i] = min((contact.dist for contact in data.contact), default=1.0)
        bars[i] = any(contact.geom.max() > 2 for contact in data.contact)
    found = labels(robot, q, (constraint,), device=device) > 0
    assert not wrong(found, distance < 0, distance).size
    assert 200 < bars.sum() < found.sum() < 3_800


def test_configurations_on_the_boundary_of_every_pair(device):
    robot = ws.load_robot("ur5e")
    assert not wrong_at_the_boundary(robot, *constraints_for(robot, SELF), 2000, 40_000, device)


@pytest.mark.parametrize(
    "item",
    [
        ws.Capsule(radius_m=0.1, length_m=10, position_m=(0.5, 0, 0.3), rpy_deg=(13, 81, 37)),
        ws.Box(size_m=(1000, 1000, 0.1), position_m=(0, 0, -0.3), rpy_deg=(13, 21, 37)),
    ],
    ids=["pipe", "ramp"],
)
def test_configurations_on_the_boundary_of_what_is_far_larger_than_the_robot(item, device):
    robot = ws.load_robot("ur5e")
    assert not wrong_at_the_boundary(robot, *constraints_for(robot, None, ws.Environment([item])), 1000, 4_000, device)


def wrong_at_the_boundary(robot, constraint, count, among, device):
    """How many labels are wrong on both sides of the boundary, of ``count`` that lie between random ones, each."""
    q = drawn(robot, among)
    blocked = labels(robot, q, (constraint,)) > 0
    free, hit = q[~blocked][:count], q[blocked][:count]
    for _ in range(24):
        middle = (free + hit) / 2
        touching = nearest(constraint, middle) < 0
        free, hit = np.where(touching[:, None], free, middle), np.where(touching[:, None], middle, hit)
    steps = 10.0 ** np.random.default_rng(1).uniform(-7, -3.5, (len(free), 1))
    along, found = (free - hit) / np.linalg.norm(free - hit, axis=1, keepdims=True), 0
    for q in (free + steps * along, hit - steps * along):
        q = q.astype(np.float32).astype(np.float64)
        distance = nearest(constraint, q)
        found += wrong(labels(robot, q, (constraint,), device=device) > 0, distance < 0, distance).size
    return found


def test_configurations_beyond_the_limits():
    robot = ws.load_robot("franka_panda")
    (constraint,) = constraints_for(robot, SELF)
    q = np.random.default_rng(0).uniform(-4, 4, (2_000, robot.chain.n)).astype(np.float32).astype(np.float64)
    distance = nearest(constraint, q)
    assert not wrong(labels(robot, q, (constraint,)) > 0, distance < 0, distance).size


@pytest.mark.parametrize("sampling", [ws.Sobol(20_000), ws.Random(20_000, seed=3), ws.Grid(5)], ids=lambda s: s.method)
def test_sweeps_count_what_is_admitted(sampling, precision, device):
    robot = ws.load_robot("ur5e")
    constraints = constraints_for(robot, SELF, AROUND)
    block = LatticeBlock(0.1, (-20, -20, -20), (40, 40, 40))
    evaluation, samples = Evaluation(robot.chain, ("manipulability",), (0, 1, 2)), plan_sampling(robot.chain, sampling)
    each = Pipeline(
        evaluation, samples, constraints, block, frozenset({"maximum"}), bounds=(16.0,), precision=precision
    )
    partial = sweep(each, 0, samples.count, devices_of(device), chunk_size=4096)
    q = np.asarray(configurations(each), np.float64)
    blocked = labels(robot, q, constraints, precision, device)
    assert partial.rejected.tolist() == [(blocked == number).sum() for number in (1, 2)]
    assert partial.count.sum() == (blocked == 0).sum()


def test_chunks_threads_and_shards_change_no_bit():
    robot = ws.load_robot("ur5e")
    constraints = constraints_for(robot, SELF, AROUND)
    block = LatticeBlock(0.1, (-20, -20, -20), (40, 40, 40))
    evaluation, samples = (
        Evaluation(robot.chain, ("manipulability",), (0, 1, 2)),
        plan_sampling(robot.chain, ws.Sobol(30_000)),
    )
    each = Pipeline(evaluation, samples, constraints, block, frozenset({"maximum", "mean"}), bounds=(16.0,))
    cpu = devices_of("cpu")
    whole = sweep(each, 0, samples.count, cpu, threads=1)
    parts = [sweep(each, first, count, cpu, threads=2, chunk_size=1024) for first, count in ((0, 8192), (8192, 21808))]
    again = merge(*parts)
    for name in ("count", "maximum", "rejected", "earliest", "blocked_cells", "blocked"):
        assert np.array_equal(getattr(whole, name), getattr(again, name)), name


def test_a_grid_keeps_its_base_joint_where_nothing_stands_still():
    robot = ws.load_robot("ur5e")
    (constraint,) = constraints_for(robot, SELF)
    assert all(constraint.solids[k].joint != BASE for k in constraint.pairs.ravel())
    samples = plan_sampling(robot.chain, ws.Grid(6))
    evaluation, block = Evaluation(robot.chain), LatticeBlock(0.1, (-20, -20, -20), (40, 40, 40))
    found = [
        sweep(
            Pipeline(evaluation, samples, (constraint,), block, collapse=collapse), 0, samples.count, devices_of("cpu")
        )
        for collapse in (True, False)
    ]
    assert constraint.keeps == {"base_joint"}
    assert found[0].rejected.tolist() == found[1].rejected.tolist()
    assert np.array_equal(found[0].count, found[1].count)
