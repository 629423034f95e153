"""Many solids that stand: labels against MuJoCo's, and every bound of the cells by itself."""

from dataclasses import replace

import numpy as np
import pytest
from wsrender_kernels.collision_crowd import AT_ONCE, WITHIN

import wsrender as ws
from tests.collision.robots import drawn, nearest
from tests.collision.test_labels import SELF, labels, pipeline, wrong, wrong_at_the_boundary
from wsrender.collision.covers import LEVELS
from wsrender.collision.crowd import LEAST, NOTHING
from wsrender.collision.grids import QUANTA, ROUNDING
from wsrender.collision.segments import box_distance
from wsrender.collision.solids import BASE
from wsrender.collision.store import stored_program
from wsrender.documents.constraints import Constraints
from wsrender.engine import devices_of
from wsrender.engine.collision import Collisions, collisions_of
from wsrender.engine.drawn_configurations import device_space
from wsrender.engine.sweep_plan import SweepPlan
from wsrender.robot.constraints import constraints_for

KINDS = ("box", "sphere", "capsule", "cylinder", "ellipsoid", "mesh")
STONE = np.random.default_rng(0).normal(size=(30, 3))


def item(kind, random, reach, size):
    away = random.normal(size=3)
    away *= random.uniform(0.5, 1.1) * reach / np.linalg.norm(away)
    place = {"position_m": tuple(away.tolist()), "rpy_deg": tuple(random.uniform(-180, 180, 3).tolist())}
    a, b, c = size, 0.7 * size, 0.5 * size  # of one form, whose cover is made once
    if kind == "box":
        return ws.Box(size_m=(a, b, c), **place)
    if kind == "sphere":
        return ws.Sphere(radius_m=a / 2, position_m=place["position_m"])
    if kind == "ellipsoid":
        return ws.Ellipsoid(size_m=(a, b, c), **place)
    if kind == "mesh":
        return ws.ConvexMesh(vertices_m=tuple(map(tuple, (STONE * [a / 4, b / 4, c / 4]).tolist())), **place)
    return (ws.Capsule if kind == "capsule" else ws.Cylinder)(radius_m=a / 3, length_m=b, **place)


def many(robot, count, seed=0, size=0.15, kinds=KINDS):
    random = np.random.default_rng(seed)
    return ws.Environment([item(kinds[k % len(kinds)], random, robot.chain.reach, size) for k in range(count)])


def random_pairs(constraint, share, seed):
    """The constraint without a share of its pairs."""
    left = np.random.default_rng(seed).random(len(constraint.pairs)) > share
    return replace(constraint, pairs=constraint.pairs[left])


@pytest.mark.parametrize(
    ("count", "margin", "share", "precision"),
    [(36, 0.0, 0.0, "float32"), (LEAST, 0.03, 0.0, "float64"), (24, 0.02, 0.4, "float32")],
)
def test_labels_among_many_are_mujocos(count, margin, share, precision):
    robot = ws.load_robot("ur5e")
    around = Constraints(environment={"margin_m": margin})
    (constraint,) = constraints_for(robot, around, many(robot, count, count))
    constraint = random_pairs(constraint, share, count)
    assert len(stored_program(constraint.own, constraint.chain, constraint.distances).crowd_rows)
    q = drawn(robot, 1000)
    least = nearest(constraint, q) - margin
    assert 20 < (least < 0).sum() < 980
    assert not wrong(labels(robot, q, (constraint,), precision) > 0, least < 0, least).size


def test_labels_on_the_boundary_of_many():
    robot = ws.load_robot("ur5e")
    (constraint,) = constraints_for(robot, None, many(robot, 12, 5))
    assert not wrong_at_the_boundary(robot, constraint, 100, 8000, "cpu")


def test_the_same_labels_with_cells_and_without():
    robot = ws.load_robot("ur5e")
    constraints = constraints_for(robot, SELF, many(robot, 20, 1, 0.2 * robot.chain.reach))
    found, (with_cells, without) = both_ways(robot, constraints, 1 << 14)
    np.testing.assert_array_equal(*found)
    assert set(np.unique(found[0])) == {0, 1, 2}
    assert with_cells.decided[0] >= without.decided[0]  # by the filter


def test_boxes_are_decided_by_the_filter():
    """A box is its own cover: of links that are capsules nothing is open but within what float32 may be off."""
    robot = ws.load_robot("franka_panda")
    constraints = constraints_for(robot, None, many(robot, 40, 4, 0.2, ("box",)))
    found, (with_cells, without) = both_ways(robot, constraints, 1 << 14)
    np.testing.assert_array_equal(*found)
    assert 0.1 < (found[0] > 0).mean() < 0.9
    assert with_cells.decided[1:].sum() < 1e-3 * (1 << 14) < 1e-2 * without.decided[1:].sum()


def test_distances_of_segments_from_boxes():
    """Against as many points of each; axes along faces, points, and segments through the box among them."""
    random, size = np.random.default_rng(0), np.array([0.3, 0.2, 0.1])
    middle, half = random.normal(size=(2, 1000, 3)) * [[[0.5]], [[0.4]]]
    half[:300, 0] = half[:100, 1] = 0
    half[250:400] *= 1e-4
    half[400:420] = 0
    along = middle[:, None] + half[:, None] * np.linspace(-1, 1, 2001)[:, None]
    expected = np.linalg.norm(along - np.clip(along, -size, size), axis=2).min(axis=1)
    found, step = box_distance(middle, half, size), np.linalg.norm(half, axis=1) / 1000
    assert (found <= expected + 1e-12).all() and (found >= expected - step / 2 - 1e-12).all()
    away = expected > 0.1  # there a point half a step off is farther by no more than this
    assert (found >= expected - (step / 2) ** 2 / 0.2 - 1e-12)[away].all() and away.sum() > 500
    assert (found == 0).sum() > 50


def test_what_is_asked_first_is_near():
    """Of each set one that it has, of each ball its own row."""
    robot = ws.load_robot("ur5e")
    (constraint,) = constraints_for(robot, None, many(robot, 40, 6, kinds=("box", "sphere")))
    program = stored_program(constraint.own, constraint.chain, constraint.distances)
    sets, first = program.crowd_sets[1:], program.crowd_first[1:]  # the first set is empty
    words = sets[np.arange(len(sets)), first // 32]
    assert (words >> (first % 32).astype(np.uint32) & 1).all() and len(set(first)) > 20
    for row, (_, at, count) in enumerate(program.crowd_rows):
        assert (program.crowd_ball_rows[at : at + count] == row).all()


def test_the_kernel_holds_all_tests_of_a_pair():
    assert max(inner for _, inner in LEVELS) ** 2 == WITHIN


def both_ways(robot, constraints, count, change=lambda program: program):
    """Labels (N,) of random configurations by a program with cells, ``change``d, and by the same without."""
    each = pipeline(robot, ws.Random(count), constraints)
    (device,) = devices_of("cpu")
    space, shape = device_space(each.sampling, "float32", device), SweepPlan(each).shape
    made = collisions_of(each, shape, device, count)
    assert len(made.program.crowd_rows)
    plain = replace(made.program, crowd_rows=np.zeros((0, 3), np.int32), crowd_balls=np.zeros((0, 4), np.float32))
    own = [Collisions(each, made.pairs, program, shape, device, count) for program in (change(made.program), plain)]
    return [one.label(space, 0, count, count // 256).numpy()[:count].copy() for one in own], own


def test_every_cell_is_asked():
    """Without what one cell says, what it holds is missed; so are pairs that are left out of its set."""
    robot = ws.load_robot("ur5e")
    constraints = constraints_for(robot, None, many(robot, 12, 7, kinds=("box",)))

    def no_words(program):
        words = program.crowd_words.copy()
        near = np.flatnonzero((words & 0xFFFF).astype(np.uint16).view(np.int16) < NOTHING)
        words[near[:: len(near) // 2000]] |= np.uint32(NOTHING)
        words[near[:: len(near) // 2000]] &= np.uint32(0xFFFF7FFF)
        return replace(program, crowd_words=words)

    def no_sets(program):
        return replace(program, crowd_sets=program.crowd_sets & ~np.uint32(1))

    for change in (no_words, no_sets):
        (found, expected), _ = both_ways(robot, constraints, 1 << 14, change)
        missed = (found == 0) & (expected > 0)
        assert missed.any() and not ((found > 0) & (expected == 0)).any()


def test_bounds_are_the_largest_that_hold():
    """Each to a unit: distances of boxes from the middles of cells, less what is between these and the corners."""
    robot = ws.load_robot("ur5e")
    (constraint,) = constraints_for(
        robot, Constraints(environment={"margin_m": 0.01}), many(robot, 34, 9, kinds=("box",))
    )
    program = stored_program(constraint.own, constraint.chain, constraint.distances)
    shape, (*origin, cell) = program.crowd_shape, program.crowd_numbers.astype(float)
    at = np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), -1).reshape(-1, 3)
    middles, quantum = np.array(origin) + (at + 0.5) * cell, cell / QUANTA
    own = constraint.solids
    standing = sorted({int(a) for a, _ in own_pairs(constraint, program)})
    assert len(standing) > 32  # two words
    limit = np.ceil(program.crowd_balls[:, 3].max())
    words = program.crowd_words.ravel()
    low, sets = (words & 0xFFFF).astype(np.uint16).view(np.int16).astype(int), program.crowd_sets[words >> 16]
    least = np.full(len(at), np.inf)
    unsure = np.zeros(len(at), bool)
    for bit, solid in enumerate(standing):
        T = own[solid].T
        local = (middles - T[:3, 3]) @ T[:3, :3]
        away = np.linalg.norm(local - np.clip(local, -own[solid].size, own[solid].size), axis=1)
        bound = away / quantum - (np.sqrt(3) / 2 + ROUNDING) * QUANTA
        held = sets[:, bit // 32] >> (bit % 32) & 1
        clear = np.abs(bound - np.rint(bound)) > 1e-2  # origin and cell are rounded to float32
        np.testing.assert_array_equal(held[clear] == 1, np.floor(bound[clear]) <= limit)
        least, unsure = np.minimum(least, np.floor(bound)), unsure | ~clear
    expected = np.where(least <= limit, least, NOTHING)
    np.testing.assert_array_equal(low[~unsure], expected[~unsure])
    assert (np.abs(low - expected)[(low < NOTHING) & (expected < NOTHING)] <= 1).all() and unsure.mean() < 0.7


@pytest.mark.parametrize(("count", "crowd"), [(7, False), (8, True)])
def test_eight_solids_are_a_crowd(count, crowd):
    robot = ws.load_robot("ur5e")
    (constraint,) = constraints_for(robot, Constraints(environment=True), many(robot, count, 3, kinds=("box",)))
    program = stored_program(constraint.own, constraint.chain, constraint.distances)
    assert (len(program.crowd_rows) > 0) == crowd


def own_pairs(constraint, program):
    """The pairs of a program that are looked up."""
    return constraint.own.pairs[np.unique(program.crowd_pairs[program.crowd_pairs[:, 0] >= 0, 0])]


def test_balls_hold_the_solids_and_their_margins():
    robot, margin = ws.load_robot("ur5e"), 0.02
    (constraint,) = constraints_for(robot, Constraints(environment={"margin_m": margin}), many(robot, LEAST, 3))
    program = stored_program(constraint.own, constraint.chain, constraint.distances)
    moving, random = sorted({int(b) for _, b in own_pairs(constraint, program)}), np.random.default_rng(0)
    assert len(moving) == len(program.crowd_rows)
    quantum = program.crowd_numbers[3] / QUANTA
    for solid, (frame, first, count) in zip(moving, program.crowd_rows, strict=True):
        own, balls = constraint.solids[solid], program.crowd_balls[first : first + count].astype(float)
        assert own.joint - BASE == frame
        around = random.normal(size=(4000, 3))
        around /= np.linalg.norm(around, axis=1)[:, None]
        disc = around * [1, 1, 0] / np.linalg.norm(around[:, :2], axis=1)[:, None]
        along = own.points[0] + random.random((4000, 1)).round(1) * (own.points[-1] - own.points[0])
        points = along + own.radius * around + own.disc * disc
        away = np.linalg.norm((points @ own.T[:3, :3].T + own.T[:3, 3])[:, None] - balls[:, :3], axis=2)
        assert (away <= balls[:, 3] * quantum - margin - program.epsilon + 1e-6).any(axis=1).all()


ROD = """<mujoco><compiler angle="radian"/><worldbody><body><joint axis="0 1 1" range="-3 3" limited="true"/>
  <body><joint axis="0 0 1" range="-2 2" limited="true"/><joint axis="0 1 0" range="-2 2" limited="true"/>
  <site name="tip" pos="2 0 0"/>
  <geom type="capsule" fromto="0 0 0 2 0 0" size=".004"/><geom type="capsule" fromto="0 0 0 -1 0 0" size=".02"/>
  </body></body></worldbody></mujoco>"""


def test_a_long_rod_has_as_many_balls_as_the_kernel_holds():
    robot = ws.load_robot(ROD, tip="tip")
    constraints = constraints_for(robot, None, many(robot, 12, 2, 0.5, ("sphere", "capsule")))
    found, (with_cells, _) = both_ways(robot, constraints, 1 << 12)
    assert with_cells.program.crowd_rows[:, 2].max() == AT_ONCE
    np.testing.assert_array_equal(*found)
    assert 0.02 < (found[0] > 0).mean() < 0.98
    assert with_cells.decided[0] > 0.99 * (1 << 12)  # by covers that are the solids themselves


def test_a_rod_along_the_faces_of_boxes():
    """Slopes along a box's axes are 0, and places where the rod comes level with a face are nowhere."""
    text = """<mujoco><worldbody><body><joint type="slide" axis="1 0 0" range="-1 1" limited="true"/>
      <body><joint type="slide" axis="0 1 0" range="-1 1" limited="true"/><site name="tip" pos="0 0 .5"/>
      <geom type="capsule" fromto="0 0 -.5 0 0 .5" size=".03"/><geom type="sphere" pos="0 0 .7" size=".1"/>
      </body></body></worldbody></mujoco>"""
    robot, random = ws.load_robot(text, tip="tip"), np.random.default_rng(3)
    places = random.uniform(-1, 1, (24, 3))
    boxes = [ws.Box(size_m=(0.2, 0.1, 0.15), position_m=tuple(place.tolist())) for place in places]
    (constraint,) = constraints_for(robot, None, ws.Environment(boxes))
    q = drawn(robot, 3000)
    least = nearest(constraint, q)
    assert 200 < (least < 0).sum() < 2800
    assert not wrong(labels(robot, q, (constraint,)) > 0, least < 0, least).size
    assert not wrong_at_the_boundary(robot, constraint, 100, 4000, "cpu")
