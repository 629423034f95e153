"""The analysis ``base_placement`` against all configurations in closed form, placement by placement."""

from functools import reduce

import numpy as np
import pytest
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.reference import closed_form_inverse as closed_form
from tests.reference.published_robots import dh_table
from tests.run.journeys import from_the_command_line
from wsrender.analyses.base_placement.result import PlacementMap
from wsrender.analyses.base_placement.run import PAIRS, PAIRS_MADE, PAIRS_ON_CUDA, PLACES_MADE
from wsrender.analyses.jobs import parse_job
from wsrender.documents.constraints import Apart, Constraints
from wsrender.documents.placements import COORDINATES, mounted, placed
from wsrender.robot.collisions import _kept_apart
from wsrender.robot.constraints import constraints_for
from wsrender.run import execute, plan, run_shard

DOWN = [0.0, 1.0, 0.0, 0.0]
POST = {"shape": "box", "name": "post", "size_m": [0.1, 0.1, 1.0], "position_m": [0.35, 0.3, 0.5]}
FLOOR = {"shape": "half_space", "name": "floor", "point_m": [0, 0, -0.05]}
RING = [[0.1 + 0.15 * np.cos(k), 0.15 * np.sin(k), 0.3] for k in range(6)]


def job(robot, points, quats=None, **fields):
    """A job document; a robot may be a table."""
    robot = robot if isinstance(robot, str | dict) else {"dh": robot.model_dump(mode="json", exclude_none=True)}
    targets = {"points_m": np.asarray(points).tolist()}
    targets |= {} if quats is None else {"quats_wxyz": np.asarray(quats).tolist()}
    return {"analysis": "base_placement", "robot": robot, "device": "cpu", "refine": False} | targets | fields


def labels_of(result):
    """Of every placement and target, (P, K) text: served, undecided, the constraint that blocks it, or unreachable."""
    table, count = result.tables["placements"], len(result.document["job"]["points_m"])
    found = np.full((len(table), count), "unreachable", dtype="<U20")
    for name, bits in table.columns.items():
        if name.endswith("_bits") and name != "proven_bits":
            mask = np.unpackbits(bits, axis=1, count=count, bitorder="little").astype(bool)
            assert (found[mask] == "unreachable").all()
            found[mask] = name.removesuffix("_bits").removeprefix("blocked_")
    return found


def bases_of(document):
    """Poses (P, 4, 4) of the bases of all placements."""
    parsed = parse_job(document)
    numbers = np.arange(parsed.over.count)
    own = np.eye(4) if parsed.robot.placement is None else parsed.robot.placement.matrix()
    return placed(parsed.over.coordinates(numbers)) @ mounted(parsed.mounting) @ own


def seen_from(bases, points, quats):
    """Positions (P, K, 3) and rotations (P, K, 3, 3) of targets in the frames of bases."""
    R, p = bases[:, None, :3, :3].swapaxes(-1, -2), bases[:, None, :3, 3]
    turned = Rotation.from_quat(quats, scalar_first=True).as_matrix()
    return (R @ (np.asarray(points) - p)[..., None])[..., 0], R @ turned


def solutions_of(name, positions, rotations):
    with np.errstate(invalid="ignore"):
        if name == "ur5e":
            return closed_form.ur5e(positions, rotations)
        return closed_form.with_spherical_wrist(name, closed_form.puma560_arm(positions), rotations)


SPACES = {
    "floor": {"over": {"x_m": [-0.9, 0.9, 0.3], "y_m": [-0.6, 0.6, 0.3], "yaw_deg": [0, 360, 60]}},
    "wall": {"mounting": "wall", "over": {"x_m": [-0.8, -0.2, 0.2], "z_m": [0, 0.9, 0.3], "yaw_deg": [-60, 60, 20]}},
    "tilted": {"over": {"y_m": [-0.8, 0.8, 0.4], "z_m": 0.1, "roll_deg": [0, 90, 30], "pitch_deg": [-40, 40, 40]}},
    "placed": {"mounting": "ceiling", "over": {"x_m": [-0.6, 0.6, 0.3], "z_m": 0.9, "yaw_deg": [0, 360, 45]}},
}


@pytest.mark.parametrize("space", SPACES)
@pytest.mark.parametrize("name", ["ur5e", "puma560"])
def test_labels_are_those_of_all_configurations(name, space):
    table, random = dh_table(name), np.random.default_rng(3)
    quats = np.concatenate([np.tile(DOWN, (6, 1)), Rotation.random(6, random_state=4).as_quat(scalar_first=True)])
    points = np.concatenate([RING, random.uniform([-0.3, -0.3, 0], [0.4, 0.3, 0.6], (6, 3))])
    document = job(table, points, quats, **SPACES[space])
    if space == "placed":
        document["robot"]["placement"] = {"position_m": [0.05, 0.02, 0.1], "rpy_deg": [5, 10, 15]}
    result = execute(document)
    robot, bases = ws.load_robot(table), bases_of(document)
    positions, rotations = seen_from(bases, points, quats)
    solutions = solutions_of(name, positions.reshape(-1, 3), rotations.reshape(-1, 3, 3))
    within = closed_form.within_limits(solutions, robot.lower_limits, robot.upper_limits, robot.chain.revolute)
    expected = np.where(within.any(axis=1), "served", "unreachable").reshape(len(bases), -1)
    found = labels_of(result)
    assert (found == expected).mean() == 1.0
    assert 0.05 < (expected == "served").mean() < 0.95
    about, served = result.document["placements"], (expected == "served").sum(axis=1)
    assert (result.tables["placements"]["served"] == served).all()
    assert about["labels"]["served"] == served.sum() and about["most_served"] == served.max()
    assert about["serving_all"] == (served == 12).sum() and about["labels"]["undecided"] == 0
    best = result.document["best"]
    assert best["served"] == served.max() == served[best["cell"]["placement"]]
    assert np.array(best["T_world_base"]) == pytest.approx(bases[best["cell"]["placement"]], abs=1e-12)


@pytest.mark.parametrize("blocked", [False, True])
def test_an_arm_of_seven_joints_is_searched_along_one(blocked):
    """As its targets are labelled one by one, seen from each base."""
    robot = ws.load_robot("franka_panda")
    quats = np.concatenate([np.tile(DOWN, (3, 1)), Rotation.random(5, random_state=4).as_quat(scalar_first=True)])
    points = np.random.default_rng(3).uniform([-0.4, -0.3, -0.3 * blocked], [0.4, 0.3, 0.5 - 0.4 * blocked], (8, 3))
    over = {"x_m": [-0.9, 0.9, 0.6], "y_m": [-0.6, 0.6, 0.6], "yaw_deg": [0, 360, 120]}
    lower = FLOOR | {"point_m": [0, 0, -0.1]}
    around = {"environment": {"items": [lower]}} if blocked else {}
    document = job("franka_panda", points, quats, over=over, **around)
    result, bases = execute(document), bases_of(document)
    positions, rotations = seen_from(bases, points, quats)
    turned = Rotation.from_matrix(rotations.reshape(-1, 3, 3)).as_quat(scalar_first=True)
    limits = constraints_for(robot, None, ws.Environment(items=[lower])) if blocked else ()
    expected = ws.reachable(robot, positions.reshape(-1, 3), turned, device="cpu", constraints=limits).labels
    names = {"reachable": "served", "blocked": "environment"}
    expected = np.array([names.get(label, label) for label in expected]).reshape(len(bases), -1)
    assert (labels_of(result) == expected).mean() > (0.98 if blocked else 0.9999)
    assert min((expected == label).mean() for label in ("served", "unreachable")) > 0.1
    assert ((expected == "environment").mean() > 0.02) == blocked


PROOFS = {
    "closed form": ("ur5e", True, {}),
    "all postures": ("ur5e", True, {"environment": {"items": [FLOOR | {"point_m": [0, 0, -0.1]}]}}),
    "ball search": ("franka_panda", True, {}),
    "search": ("franka_panda", False, {"environment": {"items": [FLOOR | {"point_m": [0, 0, -0.1]}]}}),
    "beyond the reach": ("scara", False, {}),
}


@pytest.mark.parametrize("case", PROOFS)
def test_what_is_proven_is_so_target_by_target_seen_from_each_base(case):
    name, poses, around = PROOFS[case]
    points = np.random.default_rng(3).uniform([-0.5, -0.3, -0.2], [0.5, 0.3, 0.4], (9, 3))
    points[:, 2] *= name != "scara"
    quats = np.tile(DOWN, (9, 1)) if poses else None
    document = job(name, points, quats, over={"x_m": [-1.2, 0.9, 0.3], "y_m": [-0.6, 0.6, 0.6]}, **around)
    result, bases, robot = execute(document), bases_of(document), ws.load_robot(name)
    positions, rotations = seen_from(bases, points, np.tile(DOWN, (9, 1)))
    turned = Rotation.from_matrix(rotations.reshape(-1, 3, 3)).as_quat(scalar_first=True) if poses else None
    limits = constraints_for(robot, None, ws.Environment(**around["environment"])) if around else ()
    expected = ws.reachable(robot, positions.reshape(-1, 3), turned, device="cpu", constraints=limits)
    bits = result.tables["placements"]["proven_bits"]
    found = np.unpackbits(bits, axis=1, count=9, bitorder="little").astype(bool)
    assert (found.ravel() == expected.proven).all()
    assert result.document["placements"]["proven"] == found.sum() and 0.05 < found.mean() < 0.98
    assert not (found & np.isin(labels_of(result), ("served", "undecided"))).any()
    assert (found & (labels_of(result) == "environment")).any() == (case == "all postures")


WITHIN = {"region": {"box": {"lower_m": [0.1, None, 0.0]}}}


@pytest.mark.parametrize("constraints", [{}, WITHIN])
@pytest.mark.parametrize("name", ["ur5e", "puma560", "franka_panda", "fanuc_crx10ia"])
def test_a_pose_has_one_label_and_one_proof_in_every_analysis(name, constraints):
    """Those of `reachability`: anywhere, with a joint at its limit, with a wrist that is straight, and far out."""
    robot, random = ws.load_robot(name), np.random.default_rng(5)
    low, high, each = robot.lower_limits, robot.upper_limits, 60 if name in ("ur5e", "puma560") else 15
    q = random.uniform(low, high, (4 * each, len(low)))
    rows, joint = np.arange(each, 2 * each), random.integers(0, len(low), each)
    q[rows, joint] = np.where(random.random(each) < 0.5, low[joint], high[joint])
    q[2 * each : 3 * each, 4] = 0.0
    where = {"x_m": 0.3, "y_m": -0.2, "z_m": 0.1, "yaw_deg": 40}
    there = robot.placed(ws.Transform(position_m=(0.3, -0.2, 0.1), rpy_deg=(0, 0, 40)))
    T = there.chain.poses(q)
    T[3 * each :, :3, 3] *= 1.15
    quats = Rotation.from_matrix(T[:, :3, :3]).as_quat(scalar_first=True)
    result = execute(job(name, T[:, :3, 3], quats, over=where, constraints=constraints or None))
    expected = ws.reachable(
        there, T[:, :3, 3], quats, device="cpu", constraints=constraints_for(there, Constraints(**constraints))
    )
    labels = np.where(expected.labels == "reachable", "served", expected.labels)
    labels = np.where(labels == "blocked", expected.reasons, labels)
    assert (labels_of(result)[0] == labels).all()
    proven = np.unpackbits(result.tables["placements"]["proven_bits"], count=len(q), bitorder="little")
    assert (proven == expected.proven).all() and 0 < proven.mean() < 1


def test_points_of_two_links():
    """Any orientation will do: an annulus, in a height that the slide reaches."""
    rows = [{"a": 0.4, "limits_deg": [-180, 180]}, {"a": 0.3, "limits_deg": [-180, 180]}]
    table = ws.DHTable(convention="standard", rows=rows)
    points = np.random.default_rng(0).uniform([-0.5, -0.5, 0], [0.5, 0.5, 0], (9, 3))
    document = job(table, points, over={"x_m": [-0.6, 0.6, 0.1], "y_m": [-0.6, 0.6, 0.15], "yaw_deg": [0, 90, 45]})
    far = np.linalg.norm(points - bases_of(document)[:, None, :3, 3], axis=2)
    expected = np.where((far > 0.1) & (far < 0.7), "served", "unreachable")
    near = np.minimum(np.abs(far - 0.1), np.abs(far - 0.7)) < 1e-4
    assert ((labels_of(execute(document)) == expected) | near).all() and near.mean() < 0.01


def test_what_blocks_is_what_stands_in_the_world():
    """Every posture of a Puma of capsules in closed form, with MuJoCo's distances of the robot placed there."""
    table = dh_table("puma560").model_copy(update={"link_radius": 0.04})
    over = {"x_m": [-0.6, 0.9, 0.5], "y_m": [-0.5, 0.5, 0.5], "yaw_deg": [-90, 90, 90]}
    points = np.concatenate([np.array(RING) + np.array([0, 0, up]) for up in (0, 0.2, -0.2)])
    quats, around = np.tile(DOWN, (18, 1)), {"items": [FLOOR, POST | {"size_m": [0.25, 0.25, 1.0]}]}
    document = job(table, points, quats, over=over, environment=around)
    found, bases = labels_of(execute(document)), bases_of(document)
    chosen = np.arange(len(bases))[1::4]
    expected = np.empty_like(found[chosen])
    for k, base in enumerate(bases[chosen]):
        robot = ws.load_robot(table, placement=base)
        (apart,) = _kept_apart(robot, None, Apart(), ws.Environment(around["items"]))
        positions, rotations = seen_from(base[None], points, quats)
        solutions = solutions_of("puma560", positions[0], rotations[0])
        inside = closed_form.within_limits(solutions, robot.lower_limits, robot.upper_limits, robot.chain.revolute)
        admitted = np.zeros(inside.shape, bool)
        admitted[inside] = apart.host(solutions[inside], np.zeros((0, 4, 4))) == 0
        expected[k] = np.select([admitted.any(axis=1), inside.any(axis=1)], ["served", "environment"], "unreachable")
    decided = found[chosen] != "undecided"
    assert (found[chosen] == expected)[decided].all() and decided.mean() > 0.99
    assert min((expected == name).sum() for name in ("served", "environment", "unreachable")) > 3


GUARDED = {"environment": {"items": [FLOOR, POST]}, "constraints": {"self_collision": True, "torque": True}}
TURNED = {"x_m": [-0.8, 0.8, 0.4], "y_m": [-0.4, 0.8, 0.4], "yaw_deg": [0, 360, 60]}


@pytest.mark.parametrize("guarded", [{}, GUARDED])
@pytest.mark.parametrize("kind", ["poses", "points"])
def test_symmetry_changes_nothing(kind, guarded):
    points = RING[:2] if kind == "points" else RING
    document = job("ur5e", points, None if kind == "points" else [DOWN] * 6, over=TURNED, **guarded)
    with_it, without = (execute(document | {"use_symmetry": use}) for use in (True, False))
    assert (with_it.document["placements"]["alike"], without.document["placements"]["alike"]) == (6, 1)
    assert (labels_of(with_it) == labels_of(without)).all()
    assert with_it.document["best"] == without.document["best"]


LIMITED = {"library": "ur5e", "limits_deg": {"joint1": [-170, 170]}}
LEANING = {"library": "ur5e", "placement": {"rpy_deg": [10, 0, 0]}}
ASIDE = {"library": "ur5e", "placement": {"position_m": [0.1, 0, 0]}}
REASONS = {
    "limits": (LIMITED, {}),
    "an axis that leans": (LEANING, {}),
    "an axis aside": (ASIDE, {}),
    "a wall": ("ur5e", {"mounting": "wall"}),
    "roll": ("ur5e", {"over": TURNED | {"roll_deg": [0, 20, 10]}}),
    "an index": ("ur5e", {"index": "joint_limit_margin"}),
}


@pytest.mark.parametrize("reason", REASONS)
def test_symmetry_is_used_only_where_it_is_exact(reason):
    robot, fields = REASONS[reason]
    assert plan(job(robot, RING, [DOWN] * 6, **({"over": TURNED} | fields)))._alike == 1
    assert plan(job("ur5e", RING, [DOWN] * 6, over=TURNED, mounting="ceiling"))._alike == 6


def test_the_best_placement_serves_the_largest_weight_far_from_the_edge():
    over = {"x_m": [-0.9, 0.9, 0.1], "y_m": [-0.9, 0.9, 0.1], "yaw_deg": [0, 360, 90]}
    points = [*RING, [1.6, 0.9, 0.3]]  # the last one cannot be served with the others
    light = execute(job("ur5e", points, [DOWN] * 7, over=over))
    heavy = execute(job("ur5e", points, [DOWN] * 7, over=over, weights=[1] * 6 + [100]))
    assert light.document["best"]["served"] == 6 and light.tables["targets"]["label"][-1] == "unreachable"
    served = labels_of(heavy) == "served"
    weight = served @ np.array([1] * 6 + [100])
    assert heavy.document["best"]["weight"] == weight.max() > 100
    assert heavy.tables["targets"]["label"][-1] == "reachable"
    # All eight cells around the best one serve as much.
    table = light.tables["placements"]
    best = light.document["best"]
    close = np.abs(table["x_m"] - best["x_m"]) < 0.15, np.abs(table["y_m"] - best["y_m"]) < 0.15
    assert (table["served"][close[0] & close[1]] == 6).all()


@pytest.mark.parametrize("index", [None, "joint_limit_margin"])
def test_sums_of_weights_that_only_rounding_tells_apart_are_one(index):
    """0.1 + 0.2 is more than 0.3 in floating point: of placements that serve either the innermost is best."""
    served = [[1, 1, 0], [0, 0, 1], [0, 0, 1], [1, 1, 0], [0, 0, 1], [1, 0, 0]]
    bits = {"served": np.packbits(served, axis=1, bitorder="little"), "undecided": np.zeros((6, 1), np.uint8)}
    parsed = parse_job(job("ur5e", RING[:3], over={"x_m": [0, 6, 1]}, weights=[0.1, 0.2, 0.3], index=index))
    score = plan(parsed).score
    found = PlacementMap(parsed, np.array(parsed.weights), bits, score, np.ones(6) if score else None)
    assert len(np.unique(found.weight[:5])) == 2 and found.best == 2


def test_a_whole_turn_goes_on_at_its_other_end():
    """All but the fourth yaw serve: of five around the end the middle one is best, of three before it the second."""
    for yaw, best in (([0, 360, 60], 0), ([0, 300, 50], 1)):
        parsed = parse_job(job("ur5e", RING[:1], over={"yaw_deg": yaw}))
        served = np.ones((parsed.over.count, 1), np.uint8)
        served[3] = 0
        bits = {"served": served, "undecided": np.zeros_like(served)}
        assert PlacementMap(parsed, np.ones(1), bits, None, None).best == best


@pytest.mark.parametrize("seed", range(6))
def test_the_best_placement_is_the_farthest_from_any_that_is_worse(seed):
    """Distances in steps from all that serve less, and from places beyond a range, turns of yaw beside each other."""
    parsed = parse_job(job("ur5e", RING[:1], over={"x_m": [0, 9, 1], "y_m": [0, 8, 1], "yaw_deg": [0, 360, 60]}))
    sizes = np.array(parsed.over.shape)[[0, 1, 5]]
    every = np.stack(np.meshgrid(*map(np.arange, sizes), indexing="ij"), axis=-1).reshape(-1, 3)
    middle = np.random.default_rng(seed).integers(0, sizes)
    away = np.abs(every - middle)
    away[:, 2] = np.minimum(away[:, 2], sizes[2] - away[:, 2])
    served = np.linalg.norm(away, axis=1) < (1.5, 2.4, 3.4)[seed % 3]
    bits = {"served": served.astype(np.uint8)[:, None], "undecided": np.zeros((len(served), 1), np.uint8)}
    around = np.stack(np.meshgrid(*(np.arange(-n, 2 * n) for n in sizes), indexing="ij"), axis=-1).reshape(-1, 3)
    inside = ((around[:, :2] >= 0) & (around[:, :2] < sizes[:2])).all(axis=1)
    worse = around[~inside | ~served[np.ravel_multi_index((around % sizes).T, sizes)]]
    depth = np.zeros(len(served))
    depth[served] = cKDTree(worse).query(every[served])[0]
    best = PlacementMap(parsed, np.ones(1), bits, None, None).best
    assert depth[best] == pytest.approx(depth.max()) and depth.max() >= 1


def test_placements_are_decided_few_at_a_time_or_all_at_once(monkeypatch):
    whole = plan(job("ur5e", RING, [DOWN] * 6, over=TURNED))
    assert whole._together > whole.job.over.count / whole._alike
    at_once = run_shard(whole, 0)["served"]
    monkeypatch.setattr("wsrender.analyses.base_placement.run.PAIRS", 18)
    assert whole._together == 3
    assert np.array_equal(run_shard(whole, 0)["served"], at_once)


def test_what_is_searched_tells_of_its_progress_and_a_gpu_gets_more_at_a_time(monkeypatch):
    free, guarded = (plan(job("ur5e", RING, [DOWN] * 6, over=TURNED, **fields)) for fields in ({}, GUARDED))
    assert guarded._together * guarded._alike * 6 <= PAIRS < (free._together + 1) * 6
    monkeypatch.setattr(type(free), "device", "cuda:0")
    assert guarded._together * guarded._alike * 6 <= PAIRS
    assert free._together == PLACES_MADE, "a GPU makes these bases"
    many, balls = (
        plan(job("ur5e", RING * 20, [DOWN] * 120, over=TURNED)),
        plan(job("franka_panda", RING, [DOWN] * 6, over=TURNED)),
    )
    assert many._together == PAIRS_MADE // 120 < PLACES_MADE
    assert balls._together == PAIRS_ON_CUDA // 6 > 3 * PAIRS // 6


def test_shards_hold_all_placements_that_are_alike():
    whole = plan(job("ur5e", RING, [DOWN] * 6, over=TURNED))
    divided = whole.settled_as(whole.division(1.0, 7))
    assert len(divided.shards) > 3 and all(first % (6 * whole._alike) == 0 for first, _ in divided.shards)
    parts = [run_shard(divided, shard) for shard in range(len(divided.shards))]
    served = [part["served"] for part in (run_shard(whole, 0), reduce(divided.merge, reversed(parts)))]
    assert np.array_equal(*served)


def test_the_targets_are_reached_from_the_best_placement():
    result = execute(job("ur5e", RING, [DOWN] * 6, over=TURNED, **GUARDED))
    robot = ws.load_robot("ur5e", placement=np.array(result.document["best"]["T_world_base"]))
    table = result.tables["targets"]
    q = np.stack([table[f"q_{name}"] for name in robot.joint_names], axis=1)
    assert (table["label"] == "reachable").all()
    pose = robot.forward_kinematics(q, device="cpu")
    assert np.abs(pose[:, :3, 3] - RING).max() < 1e-5 and np.abs(pose[:, 2, 2] + 1).max() < 1e-9
    parsed = parse_job(result.document["job"])
    for each in constraints_for(robot, parsed.constraints, parsed.environment):
        assert not each.host(q, pose).any()


def test_a_map_says_where_its_cells_are(tmp_path):
    document = job(
        "ur5e", RING, [DOWN] * 6, over={"x_m": [-1, 1, 0.25], "y_m": [-0.5, 0.5, 0.5], "yaw_deg": [0, 90, 45]}
    )
    result = from_the_command_line(document, tmp_path)
    cells = result.tables["placement_map"]
    assert (cells.grid.axes, cells.grid.origin, cells.grid.step) == (("x_m", "y_m"), (-1.0, -0.5), (0.25, 0.5))
    assert (cells.grid.shape, cells.grid.frame) == ((8, 2), "world")
    served = (labels_of(result) == "served").sum(axis=1).reshape(8, 2, 3)
    assert (cells["served"].reshape(8, 2) == served.max(axis=-1)).all()
    assert (cells["serving_all"].reshape(8, 2) == (served == 6).sum(axis=-1)).all()
    with np.load(tmp_path / "out" / "placement_map.npz") as file:
        assert file["served"].shape == (8, 2) and (file["served"] == served.max(axis=-1)).all()
        assert '"origin": [-1.0, -0.5]' in str(file["wsrender"])
    assert (tmp_path / "out" / "plots" / "placements.png").exists()
    figure = result.plot.placements()
    assert figure.axes[0].get_xlabel() == "x [m]"  # as pictures of volumes have it
    figure.draw_without_rendering()
    (legend,), (axes, _) = figure.legends, figure.axes
    assert len(legend.legend_handles) == 2 and not legend.get_window_extent().overlaps(axes.get_tightbbox())


def test_no_placement_serves_a_target():
    result = execute(job("ur5e", [[9, 9, 9]], over={"x_m": [0, 1, 0.5]}))
    assert result.document["best"] is None and "targets" not in result.tables
    assert result.document["headline"]["reason"] == "no placement serves a target"


def test_one_placement_alone():
    result = execute(job("ur5e", RING, [DOWN] * 6, over={"x_m": -0.4}, environment={"items": [FLOOR]}))
    assert result.document["placements"]["count"] == 1 and result.document["best"]["served"] == 6
    assert "placement_map" not in result.tables


REFUSED = {
    "over": ({"over": {"x_m": [0, 10, 0.001], "y_m": [0, 10, 0.001]}}, "not 10000 × 10000 = 100,000,000"),
    "over.x_m": ({"over": {"x_m": [0, 1]}}, "must be a number, or"),
    "weights": ({"weights": [1, 2]}, "must have as many numbers as points_m has rows, 6"),
    "mounting": ({"mounting": "wall", "over": {"roll_deg": 3}}, 'must be "floor" where over.roll_deg tilts'),
    "constraints.torque": (
        {"constraints": {"torque": True}, "over": {"pitch_deg": [0, 30, 10]}},
        "must not be given where over.pitch_deg is a range",
    ),
    "index_options": ({"index_options": {"clearance": {"limit_m": 1}}}, 'must not be given without "index"'),
}


@pytest.mark.parametrize("field", REFUSED)
def test_what_cannot_be_asked_is_refused(field):
    fields, message = REFUSED[field]
    with pytest.raises(ws.DocumentError) as refusal:
        parse_job(job("ur5e", RING, [DOWN] * 6, **({"over": {}} | fields)))
    assert [name for name, _ in refusal.value.problems] == [field] and message in refusal.value.problems[0][1]


def test_torque_sees_yaw_where_gravity_leans():
    document = job("ur5e", RING, over=TURNED, gravity_m_s2=[1, 0, -9.7])
    with pytest.raises(
        ws.DocumentError, match=r"constraints\.torque: must not be given where over\.yaw_deg is a range"
    ):
        parse_job(document | {"constraints": {"torque": True}})
    with pytest.raises(ws.InputError, match=r"index: must not be torque_margin where over\.yaw_deg is a range"):
        plan(document | {"index": "torque_margin"})


@pytest.mark.parametrize(
    ("index", "options", "message"),
    [
        ("speed", {}, "index: "),
        ("velocity_radius", {}, "velocity_limits"),
        (
            "force_radius",
            {"direction": [0, 0, 1]},
            r"index_options\.force_radius\.direction: must not be given where over",
        ),
    ],
)
def test_indices_that_cannot_be_asked_are_refused(index, options, message):
    robot = {"library": "ur5e", "velocity_limits": {}} if index == "velocity_radius" else "ur5e"
    with pytest.raises(ws.InputError, match=message):
        plan(job(robot, RING, over=TURNED, index=index, index_options={index: options} if options else {}))


def test_coordinates_stand_in_the_document():
    assert set(COORDINATES) <= execute(job("ur5e", RING, over={"x_m": -0.4})).document["best"].keys()


def best_values(name, bases, points, quats, value, robot):
    """Of every base and target the largest value of all configurations in closed form; NaN where there is none."""
    positions, rotations = seen_from(bases, points, quats)
    solutions = solutions_of(name, positions.reshape(-1, 3), rotations.reshape(-1, 3, 3))
    inside = closed_form.within_limits(solutions, robot.lower_limits, robot.upper_limits, robot.chain.revolute)
    values = np.full(inside.shape, -np.inf)
    values[inside] = value(solutions[inside])
    best = values.max(axis=1).reshape(len(bases), -1)
    return np.where(np.isfinite(best), best, np.nan)


def margin_of(robot):
    """The least share of a range between a joint and its limits, each as many turns off as is best."""
    low, high = robot.lower_limits, robot.upper_limits

    def margin(q):
        middle = (low + high) / 2
        off = np.abs(np.remainder(q - middle + np.pi, 2 * np.pi) - np.pi)
        return (0.5 - off / (high - low)).min(axis=1)

    return margin


def manipulability_of(robot):
    return lambda q: ws.evaluate_indices(robot, q, ["manipulability"], device="cpu")["manipulability"]


@pytest.mark.parametrize(("index", "value"), [("joint_limit_margin", margin_of), ("manipulability", manipulability_of)])
def test_the_score_is_the_least_of_the_best(index, value):
    over = {"x_m": [-1.25, 1.25, 0.5], "y_m": [-0.6, 0.6, 0.4], "yaw_deg": [0, 360, 120]}
    document = job("ur5e", RING, [DOWN] * 6, over=over, index=index)
    result, robot, bases = execute(document), ws.load_robot("ur5e"), bases_of(document)
    values = best_values("ur5e", bases, RING, [DOWN] * 6, value(robot), robot)
    none = np.isnan(values).all(axis=1)
    least = np.where(none, np.nan, np.nan_to_num(values, nan=np.inf).min(axis=1))
    assert result.tables["placements"][index] == pytest.approx(least, abs=1e-7, nan_ok=True)
    assert none.any() and not none.all()
    served, best = (~np.isnan(values)).sum(axis=1), result.document["best"]
    assert best[index] == pytest.approx(least[served == served.max()].max(), abs=1e-7)
    assert result.tables["targets"][index].min() == pytest.approx(best[index], abs=1e-9)


def test_smaller_compliance_is_better():
    options = {"tip_compliance": {"joint_stiffness": [1e4] * 6}}
    document = job("ur5e", RING, [DOWN] * 6, over=TURNED, index="tip_compliance", index_options=options)
    result = execute(document)
    table = result.tables["placements"]
    least = table["tip_compliance"][table["served"] == 6].min()
    assert result.document["best"]["tip_compliance"] == pytest.approx(least, rel=1e-8) and least > 0


REFINED = {"over": {"x_m": [-0.9, 0.9, 0.3], "y_m": [-0.6, 0.6, 0.3], "yaw_deg": [0, 360, 120]}, "refine": True}


@pytest.mark.parametrize("index", [None, "joint_limit_margin"])
def test_the_best_placement_is_no_worse_than_its_cell_and_tolerant(index):
    """Ten thousand placements inside the ball, and as many within the angle, serve all; beyond, closed forms do not."""
    document = job("ur5e", RING[::2], [DOWN] * 3, **REFINED, index=index)
    best, robot = execute(document).document["best"], ws.load_robot("ur5e")
    base, tolerance = np.array(best["T_world_base"]), best["tolerance"]
    coordinates = np.array([[best[name] for name in COORDINATES]])
    assert base == pytest.approx(placed(coordinates)[0], abs=1e-12)
    assert np.all(np.abs(coordinates[0, :2]) <= [0.9, 0.6]) and best["served"] == best["cell"]["served"] == 3
    if index:
        values = best_values("ur5e", base[None], RING[::2], [DOWN] * 3, margin_of(robot), robot)
        assert best[index] == pytest.approx(values.min(), abs=1e-7) and best[index] > best["cell"][index]
    random = np.random.default_rng(5)
    by = random.normal(size=(10_000, 3))
    by *= (random.random((10_000, 1)) ** (1 / 3)) / np.linalg.norm(by, axis=1, keepdims=True)

    def served(shift, turn, held=False):
        bases = np.tile(base, (len(by), 1, 1))
        bases[:, :3, 3] += shift * by
        bases[:, :3, :3] = Rotation.from_rotvec(turn * by).as_matrix() @ base[:3, :3]
        found = ~np.isnan(best_values("ur5e", bases, RING[::2], [DOWN] * 3, lambda q: q[:, 0], robot)).any(axis=1)
        if held and not found.all():  # from 1e-5 m and rad beyond, which with the elbow straight is a long way aside
            positions, rotations = seen_from(bases[~found], RING[::2], [DOWN] * 3)
            turned = Rotation.from_matrix(rotations.reshape(-1, 3, 3)).as_quat(scalar_first=True)
            labels = ws.reachable(robot, positions.reshape(-1, 3), turned, device="cpu").labels
            found[~found] = (labels == "reachable").reshape(-1, 3).all(axis=1)
        return found

    shift, turn = tolerance["translation_m"], tolerance["rotation_rad"]
    assert 1e-5 < shift < 0.5 and 1e-5 < turn < np.pi / 4
    assert served(shift, 0, held=True).all() and served(0, turn, held=True).all()
    assert not served(1.2 * shift, 0).all() and not served(0, 1.2 * turn).all()


def test_under_torque_limits_only_a_translation_is_tolerated():
    """Gravity would turn in the base's frame."""
    fields = {"over": {"x_m": -0.4}, "constraints": {"torque": True}, "refine": True}
    tolerance = execute(job("ur5e", RING[:1], [DOWN], **fields)).document["best"]["tolerance"]
    assert tolerance["rotation_rad"] is None and 0 < tolerance["translation_m"] < 1


def test_tolerance_among_what_stands_around():
    """MuJoCo's distances at every posture of a hundred placements inside."""
    table = dh_table("puma560").model_copy(update={"link_radius": 0.04})
    around = {"items": [POST]}
    document = job(table, RING[:3], [DOWN] * 3, over={"x_m": [-0.5, -0.1, 0.2]}, environment=around, refine=True)
    best = execute(document).document["best"]
    base, shift = np.array(best["T_world_base"]), best["tolerance"]["translation_m"]
    assert best["served"] == 3 and shift > 0.005
    by = np.random.default_rng(1).normal(size=(40, 3))
    for each in shift * by / np.linalg.norm(by, axis=1, keepdims=True):
        moved = base.copy()
        moved[:3, 3] += each
        robot = ws.load_robot(table, placement=moved)
        (apart,) = _kept_apart(robot, None, Apart(), ws.Environment(around["items"]))
        solutions = solutions_of("puma560", *(part[0] for part in seen_from(moved[None], RING[:3], [DOWN] * 3)))
        inside = closed_form.within_limits(solutions, robot.lower_limits, robot.upper_limits, robot.chain.revolute)
        admitted = np.zeros(inside.shape, bool)
        admitted[inside] = apart.host(solutions[inside], np.zeros((0, 4, 4))) == 0
        assert admitted.any(axis=1).all()
