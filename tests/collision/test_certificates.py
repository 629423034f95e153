"""Proofs, tables and covers against MuJoCo and random search; the folder of programs."""

import ast
import io
import shutil
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.collision.robots import drawn, random_text
from wsrender.collision import certificates as certified
from wsrender.collision import grids, levers, store
from wsrender.collision import program as programs
from wsrender.collision.certificates import FREE, HIT, MIXED, certificates
from wsrender.collision.covers import LEVELS, _segment_distances, covers, from_segment
from wsrender.collision.distance import Distances, frames_of
from wsrender.collision.solids import Solid
from wsrender.collision.supports import EDGE, PAD, supports
from wsrender.documents.constraints import Constraints
from wsrender.robot import collisions
from wsrender.robot.constraints import constraints_for

SIZE = np.array([0.11, 0.07, 0.05])
SOLIDS = {
    "box": Solid("box", "box", 0, np.eye(4), SIZE),
    "cylinder": Solid("cylinder", "cylinder", 0, np.eye(4), SIZE),
    "ellipsoid": Solid("ellipsoid", "ellipsoid", 0, np.eye(4), SIZE),
    "hull": Solid("hull", "hull", 0, np.eye(4), SIZE, np.random.default_rng(3).normal(size=(30, 3)) * SIZE),
    "capsule": Solid("capsule", "capsule", 0, np.eye(4), SIZE),
}
_ROUND = np.random.default_rng(4).normal(size=(900, 3))
_ROUND = _ROUND / np.linalg.norm(_ROUND, axis=1, keepdims=True) * SIZE
SOLIDS["hull of many corners"] = Solid("many", "hull", 0, np.eye(4), SIZE, _ROUND)


def inside(solid: Solid, points: np.ndarray) -> np.ndarray:
    """Which points (N, 3) the solid holds."""
    x, y, z = points.T
    match solid.kind:
        case "box":
            return (np.abs(points) <= solid.size).all(axis=1)
        case "cylinder":
            return (np.hypot(x, y) <= solid.size[0]) & (np.abs(z) <= solid.size[1])
        case "ellipsoid":
            return ((points / solid.size) ** 2).sum(axis=1) <= 1
        case "capsule":
            return from_segment(points, *solid.points) <= solid.size[0]
    from scipy.spatial import ConvexHull

    planes = ConvexHull(solid.points).equations
    found = (np.abs(points) <= np.abs(solid.points).max(axis=0)).all(axis=1)
    found[found] = (points[found] @ planes[:, :3].T + planes[:, 3] <= 0).all(axis=1)
    return found


@pytest.mark.parametrize("name", SOLIDS)
def test_covers_hold_the_solid_and_are_held_by_it(name):
    solid, (found,) = SOLIDS[name], covers([SOLIDS[name]])
    points = np.random.default_rng(0).uniform(-0.4, 0.4, (200_000, 3))
    within = inside(solid, points)
    assert len(found.outer) == len(found.inner) == (1 if found.exact else len(LEVELS))
    for outer, inner in zip(found.outer, found.inner, strict=True):
        around = np.any(
            [from_segment(points, a, b) <= r for a, b, r in zip(outer.a, outer.b, outer.radius, strict=True)], axis=0
        )
        core = np.any(
            [from_segment(points, a, b) <= r for a, b, r in zip(inner.a, inner.b, inner.radius, strict=True)], axis=0
        )
        assert (around | ~within).all()
        assert (within | ~core).all()
        assert core.any()


def test_covers_of_many_are_those_of_each():
    together = covers(list(SOLIDS.values()))
    for solid, found in zip(SOLIDS.values(), together, strict=True):
        (alone,) = covers([solid])
        for side in ("outer", "inner"):
            for one, other in zip(getattr(found, side), getattr(alone, side), strict=True):
                for numbers in ("a", "b", "radius"):
                    np.testing.assert_array_equal(getattr(one, numbers), getattr(other, numbers))


@pytest.mark.parametrize("name", SOLIDS)
def test_distances_are_cut_and_of_one_frame_as_of_many(name):
    """To the box, from far outside to deep inside of it."""
    solids = (SOLIDS["box"], SOLIDS[name])
    distances, random = Distances(solids), np.random.default_rng(6)
    T_a = ws.Transform(position_m=(0.1, 0.2, 0.3), rpy_deg=(10, 20, 30)).matrix()
    T_b = np.tile(np.eye(4), (400, 1, 1))
    T_b[:, :3, :3] = Rotation.random(400, rng=random).as_matrix()
    T_b[:, :3, 3] = T_a[:3, 3] + random.normal(size=(400, 3)) * random.uniform(0, 0.5, (400, 1))
    each = distances.between(0, 1, np.tile(T_a, (400, 1, 1)), T_b, 9.0)
    assert (each < -0.01).any()
    for limit in (9.0, 0.1, 1e-5):
        found = distances.between(0, 1, np.broadcast_to(T_a, (400, 4, 4)), T_b, limit)
        np.testing.assert_allclose(found, np.minimum(each, limit), rtol=0, atol=1e-7)
        assert (found == limit).any() == (limit < 9)


@pytest.mark.parametrize("seed", [2, 7, 9])
def test_what_is_proven_holds_at_random_configurations(seed, monkeypatch):
    monkeypatch.setattr(certified, "CELLS", 128)
    robot = ws.load_robot(random_text(seed, 4))
    (constraint,) = constraints_for(robot, Constraints(self_collision=True))
    pairs, chain, distances = constraint.own, constraint.chain, constraint.distances
    known = certificates(pairs, chain, distances)
    q = drawn(robot, 20_000)
    frames = frames_of(chain, q)

    def distance(number):
        a, b = pairs.pairs[number]
        T_a, T_b = (frames[:, pairs.solids[k].joint + 1] @ pairs.solids[k].T for k in (a, b))
        return distances.between(a, b, T_a, T_b, 2.0)

    assert known.never
    for number in known.never:
        assert (distance(number) > 0).all(), pairs.name(number)
    assert known.tables
    for table in known.tables:
        low, high = chain.lower_limits[list(table.coordinates)], chain.upper_limits[list(table.coordinates)]
        cells = ((q[:, list(table.coordinates)] - low) / (high - low) * table.labels.shape).astype(int)
        label = table.labels[tuple(np.minimum(cells, np.array(table.labels.shape) - 1).T)]
        found = distance(table.pair)
        assert (found[label == FREE] > 0).all()
        assert (found[label == HIT] < 0).all()
        assert 0 < (label == MIXED).mean() < 0.3
    numbers = (*known.never, *(table.pair for table in known.tables), *known.left)
    assert sorted(numbers) == list(range(len(pairs.pairs)))


@pytest.mark.parametrize("touches", [False, True])
def test_no_box_is_lost_where_a_pair_is_proven(touches, monkeypatch):
    """Solids come near each other at nine configurations, and touch at one of them, if at all."""
    monkeypatch.setattr(certified, "AT_A_TIME", 4)
    pair, random, found = object.__new__(certified._Pair), np.random.default_rng(8), []
    pair.coordinates, pair.rate, pair.low, pair.high = (0, 1, 2), np.ones(3), np.zeros(3), np.ones(3)
    for _ in range(20):
        places, least = random.random((9, 3)), np.full(9, 0.15)
        least[-1] -= 0.155 * touches

        def distance(values, limit, places=places, least=least):
            return np.minimum((np.linalg.norm(values[:, None] - places, axis=2) + least).min(axis=1), limit)

        monkeypatch.setattr(pair, "distance", distance, raising=False)
        found.append(pair.proven())
    assert set(found) == {MIXED if touches else FREE}


def test_programs_are_made_once(tmp_path, monkeypatch):
    monkeypatch.setenv(store.FOLDER, str(tmp_path))
    robot = ws.load_robot(random_text(1, 3))
    made = []
    monkeypatch.setattr(store, "program", lambda *args, own=store.program: made.append(1) or own(*args))

    def planned():
        store._LATEST.clear()
        (constraint,) = constraints_for(robot, Constraints(self_collision=True))
        return store.stored_program(constraint.own, constraint.chain, constraint.distances)

    first, again = planned(), planned()
    assert len(made) == 1
    assert np.array_equal(first.test_numbers, again.test_numbers)
    assert first.epsilon == again.epsilon
    store.put({}, tmp_path / "none")
    assert not (tmp_path / "none").exists()
    (path,) = (tmp_path / "collision").glob("*.npz")
    foreign = io.BytesIO()
    np.save(foreign, np.zeros(3))  # a single array is read without an error
    for left in (path.read_bytes()[:100], b"", foreign.getvalue()):  # as a full disk leaves it, a lost one
        path.write_bytes(left)
        made.clear()
        planned()
        assert len(made) == 1
    monkeypatch.setattr(store, "LIMIT_BYTES", 1)
    robot = ws.load_robot(random_text(3, 3))
    planned()
    assert len(list((tmp_path / "collision").glob("*.npz"))) == 1


def test_who_makes_the_same_program_is_waited_for(tmp_path, monkeypatch):
    monkeypatch.setenv(store.FOLDER, str(tmp_path))
    monkeypatch.setattr(store, "KEPT", 1)
    made, robots = [], [ws.load_robot(random_text(seed, 3)) for seed in (1, 3)]
    monkeypatch.setattr(store, "_LATEST", {})
    planned = [constraints_for(robot, Constraints(self_collision=True))[0] for robot in robots]
    for path in (tmp_path / "collision").glob("*.npz"):
        path.unlink()
    monkeypatch.setattr(store, "program", lambda *args, own=store.program: made.append(args[0].digest) or own(*args))

    def asked(number):
        store._LATEST.clear()  # as another process, which has its own
        each = planned[number % 2]
        return number % 2, store.stored_program(each.own, each.chain, each.distances)

    with ThreadPoolExecutor(8) as pool:
        found = list(pool.map(asked, range(24)))
    assert sorted(made) == sorted({each.own.digest for each in planned})
    for number, each in found:
        assert np.array_equal(each.solid_pairs, planned[number].own.pairs)


@pytest.mark.parametrize("kind", SOLIDS)
def test_balls_that_are_looked_up_hold_the_cover_and_lie_within_it(kind):
    """Whose capsules hold the solid, and lie within it; of a grid whose border is near, upper bounds end there."""
    solid, margin, epsilon, random = SOLIDS[kind], 0.01, 1e-5, np.random.default_rng(0)
    (own,), grid = covers([solid]), grids.DistanceGrid(np.zeros(3), 0.001, 1.0, np.zeros((1, 1, 1), np.uint32))
    T = ws.Transform(position_m=(0.1, 0.2, 0.3), rpy_deg=(10, 20, 30)).matrix()
    balls = grids.lookup(grid, 0, T, own, margin, epsilon).balls
    centers, (free, touch) = (balls[:, :3] - T[:3, 3]) @ T[:3, :3], balls[:, 3:].T * grid.quantum
    level, d = 0 if own.exact else grids.LEVEL, random.normal(size=(2000, 3))
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    for a, b, radius in zip(own.outer[level].a, own.outer[level].b, own.outer[level].radius, strict=True):
        points = a + random.random((2000, 1)) * (b - a) + radius * d
        away = np.linalg.norm(points[:, None] - centers, axis=2)
        assert (away - (free - margin - epsilon)).min(axis=1).max() < 1e-12
    within, inner = touch > 0, own.outer[0] if own.exact else own.inner[level]
    for center, radius in zip(centers[within], touch[within] - margin + epsilon, strict=True):
        depths = inner.radius - np.array(
            [from_segment(center[None], a, b)[0] for a, b in zip(inner.a, inner.b, strict=True)]
        )
        assert depths.max() == pytest.approx(radius, abs=1e-12)
    near = grids.lookup(replace(grid, pad=0.005), 0, T, own, margin, epsilon).balls
    assert (near[within, 4] * grid.quantum).tolist() == pytest.approx([0.005] * within.sum())


def imported(module: Path, found: set[Path]) -> set[Path]:
    """A module with all that it imports of this package."""
    if module not in found:
        found.add(module)
        for node in ast.walk(ast.parse(module.read_text())):
            if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("wsrender."):
                own = store.PACKAGE.parent.joinpath(*node.module.split("."))
                for path in (own.with_suffix(".py"), *(own / f"{each.name}.py" for each in node.names)):
                    if path.exists():
                        imported(path, found)
    return found


def test_a_program_belongs_to_the_sources_that_make_it(tmp_path, monkeypatch):
    """To every module that they import: a changed byte of any makes another."""
    makers = imported(store.PACKAGE / "collision" / "program.py", set())
    names = sorted(path.relative_to(store.PACKAGE) for path in makers)
    for name in names:
        (tmp_path / name).parent.mkdir(exist_ok=True)
        shutil.copy(store.PACKAGE / name, tmp_path / name)
    monkeypatch.setattr(store, "PACKAGE", tmp_path)
    hashed = store._sources.__wrapped__
    found = [hashed(), hashed()]
    for name in names:
        (tmp_path / name).write_bytes((tmp_path / name).read_bytes() + b"#")
        found.append(hashed())
    assert len(set(found)) == len(found) - 1 == len(names) + 1 > 10


def test_a_program_belongs_to_all_that_it_is_made_of(monkeypatch):
    robot = ws.load_robot(random_text(1, 3))
    (one,) = constraints_for(robot, Constraints(self_collision=True))
    solid = one.solids[0]
    others = [replace(one, margin_m=1e-6), replace(one, pairs=one.pairs[:-1]), replace(one, name="environment")]
    others.append(replace(one, solids=(replace(solid, size=solid.size + 1e-9), *one.solids[1:])))
    others.append(replace(one, solids=(replace(solid, T=solid.T + 1e-9), *one.solids[1:])))
    names = ("lower_limits", "upper_limits", "joint_scale", "joint_offset", "T_joint")
    others += [replace(one, chain=replace(one.chain, **{name: getattr(one.chain, name) + 1e-9})) for name in names]
    others.append(replace(one, chain=replace(one.chain, joint_is_revolute=~one.chain.joint_is_revolute)))
    others.append(replace(one, chain=replace(one.chain, joint_source=one.chain.joint_source[::-1])))
    ground = replace(solid, kind="surface", vertices=np.random.default_rng(0).random((9, 3)), faces=np.arange(9))
    for vertices, faces in (
        (ground.vertices, ground.faces),
        (ground.vertices[[0, 1, 2, 3, 5, 4, 6, 7, 8]], ground.faces),
    ):
        others.append(replace(one, solids=(replace(ground, vertices=vertices, faces=faces), *one.solids[1:])))
    others.append(replace(one, solids=(replace(ground, faces=ground.faces[::-1]), *one.solids[1:])))
    keys = {store._key(each.own, each.chain) for each in (one, *others)}
    assert len(keys) == 1 + len(others)
    assert len({one, *others}) == 1 + len(others) - 2  # limits change no label
    monkeypatch.setattr(store, "_sources", lambda: "others")
    assert store._key(one.own, one.chain) not in keys


def test_a_folder_that_cannot_be_written_costs_time_alone(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv(store.FOLDER, str(tmp_path / "file"))
    monkeypatch.setattr(store, "_LATEST", {})
    (constraint,) = constraints_for(ws.load_robot(random_text(1, 3)), Constraints(self_collision=True))
    assert len(store.stored_program(constraint.own, constraint.chain, constraint.distances).solid_pairs)


@pytest.mark.parametrize("seed", [2, 7, 9, 34])
def test_levers_are_no_shorter_than_what_random_configurations_have(seed):
    robot = ws.load_robot(random_text(seed, 5))
    bodies = robot.bodies
    chain, q, tight = bodies.chain, drawn(robot, 3000), []
    frames = frames_of(chain, q)
    for solid in map(collisions.solid_of, bodies.shapes):
        for joint in np.flatnonzero(chain.joint_is_revolute).tolist():
            T = np.linalg.inv(frames[:, joint + 1]) @ frames[:, solid.joint + 1] @ solid.T
            points = np.einsum("nij,pj->npi", T[:, :3, :3], solid.points) + T[:, None, :3, 3]
            found = float(np.hypot(points[..., 0], points[..., 1]).max()) + solid.radius
            between = range(min(solid.joint + 1, joint), max(solid.joint, joint) + 1)
            lever = levers._lever(chain, joint, solid, between)
            assert lever >= found - 1e-9
            tight.append(lever / found)
    assert min(tight) < 1.02


def test_rates_of_a_pair_are_its_own_beside_others():
    (constraint,) = constraints_for(ws.load_robot("so100"), Constraints(self_collision=True))
    together = levers.Levers(constraint.chain)
    for a, b in constraint.own.pairs:
        ends = constraint.solids[a], constraint.solids[b]
        assert together.rates(*ends) == levers.Levers(constraint.chain).rates(*ends)


def test_levels_are_chosen_as_of_all_configurations(monkeypatch):
    (constraint,) = constraints_for(ws.load_robot("so100"), Constraints(self_collision=True))
    made = dict(enumerate(covers(constraint.solids)))
    chosen = programs._Chosen(constraint.own, constraint.chain, made)
    numbers = range(len(constraint.pairs))
    found = [chosen.levels(k) for k in numbers]
    near = [chosen._near(*pair, 0.0).mean() for pair in constraint.own.pairs]
    monkeypatch.setattr(programs._Chosen, "_near", lambda *_: np.ones(programs.DRAWN, bool))
    assert found == [chosen.levels(k) for k in numbers]
    assert 0 < np.mean(near) < 0.9
    assert len(set(found)) > 3


@pytest.mark.parametrize("stretched", [(1, 1, 1), (8, 1, 0.2)])
def test_cells_of_directions_hold_the_farthest_points(stretched):
    """Of 200 points few are looked at in each cell, and the farthest is among them, at cells' borders too."""
    random = np.random.default_rng(0)
    points = random.normal(size=(200, 3))
    points *= stretched / np.linalg.norm(points, axis=1, keepdims=True)
    found = supports(points)
    directions = random.normal(size=(20_000, 3))
    directions[::2] /= np.abs(directions[::2]).max(axis=1, keepdims=True)
    directions[::2] = np.round(directions[::2] * EDGE / 2) * 2 / EDGE
    axis = np.abs(directions).argmax(axis=1)
    along, one, two = (directions[np.arange(len(axis)), (axis + k) % 3] for k in range(3))
    column, row = (np.clip((beside / np.abs(along) + 1) / 2 * EDGE, 0, EDGE - 1).astype(int) for beside in (one, two))
    cells = ((2 * axis + (along > 0)) * EDGE + column) * EDGE + row
    for cell, direction in zip(cells, directions, strict=True):
        height = points @ direction
        assert height[found[cell]].max() == height.max()
    assert np.mean([len(each) for each in found]) < 8


def test_few_points_are_of_all_directions():
    points = np.random.default_rng(0).normal(size=(PAD, 3))
    assert all((each == np.arange(PAD)).all() for each in supports(points))


def test_distances_of_many_segments_are_those_of_each():
    random = np.random.default_rng(4)
    a, b, points = random.normal(size=(20, 3)), random.normal(size=(20, 3)), random.normal(size=(50, 3))
    b[0] = a[0]  # no length
    points[0], points[1] = (a[1] + b[1]) / 2, b[2]
    each = [from_segment(points, *ends) for ends in zip(a, b, strict=True)]
    np.testing.assert_allclose(_segment_distances(points, a, b), each, rtol=0, atol=1e-7)


@pytest.mark.parametrize("name", ["ur5e", "scara", "so100"])
def test_steps_of_joints_make_their_frames(name):
    chain = ws.load_robot(name).chain
    q = np.random.default_rng(5).uniform(-1, 1, (10, chain.n))
    T = chain.T_world_base
    for joint, expected in enumerate(np.moveaxis(chain.frames(q)[:, :-1], 1, 0)):
        T = T @ chain.step(joint, q)
        np.testing.assert_allclose(T, expected, rtol=0, atol=1e-14)
