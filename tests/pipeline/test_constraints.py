"""Constraints in the sweep against their float64 twins, closed forms and a filter of the unconstrained samples."""

from dataclasses import replace

import numpy as np
import pytest
from wsrender_kernels.voxels import decode_extreme

import wsrender as ws
from wsrender.documents.constraints import Constraints
from wsrender.engine import SweepPlan, configurations, devices_of, evaluate_poses, merge, sweep
from wsrender.engine.rows import evaluate_samples
from wsrender.engine.sums import scales_of
from wsrender.errors import DocumentError, InputError
from wsrender.indices.index_catalogue import DYNAMIC, KINEMATIC
from wsrender.pipeline.constraints import registry
from wsrender.pipeline.constraints.constraint import Constraint, in_order
from wsrender.pipeline.constraints.leg_distance import LegDistance
from wsrender.pipeline.constraints.region import RegionConstraint
from wsrender.pipeline.constraints.registry import constraints_of
from wsrender.pipeline.evaluation import Evaluation
from wsrender.pipeline.pipeline import Pipeline
from wsrender.pipeline.sampling import plan_sampling
from wsrender.run import execute, finish, plan, run_shard
from wsrender.volume.lattice import LatticeBlock

SHAPES = {
    "box": {"lower_m": [-0.5, -0.6, 0.0], "upper_m": [0.8, 0.9, 1.0]},
    "sphere": {"center_m": [0.1, 0.0, 0.2], "radius_m": 0.7},
    "half_space": {"point_m": [0, 0, 0.1], "normal": [0.2, 0, 2]},
}
BLOCK = LatticeBlock(0.1, (-20, -20, -20), (40, 40, 40))
COUNT = 1 << 14
RECORDS = (
    (("manipulability",), frozenset({"maximum"})),
    (KINEMATIC, frozenset({"maximum"})),
    (KINEMATIC, frozenset({"maximum", "minimum", "mean"})),
    (KINEMATIC + DYNAMIC, frozenset({"maximum", "minimum"})),
)


@pytest.fixture
def added(monkeypatch):
    """Constraints that the test adds, and forgets."""
    monkeypatch.setattr(registry, "_ADDED", {})
    ws.register_constraint("elbow_up", lambda q, position, axes, least=0.0: q[2] + position[0] / 2 - least)
    ws.register_constraint("pointing_down", lambda q, position, axes, cosine=0.5: -axes[2][2] - cosine)


def swept(robot, names, constraints, sampling, precision, device, block=BLOCK, **options):
    each = Pipeline(
        Evaluation(robot.chain, names, (0, 1, 2) if names else ()),
        plan_sampling(robot.chain, sampling),
        constraints,
        block,
        frozenset({"maximum", "mean"}),
        bounds=(16.0,) * len(names),
        precision=precision,
        **options,
    )
    return each, sweep(each, 0, each.sampling.count, devices_of(device))


@pytest.mark.parametrize("shapes", (["box"], ["sphere"], ["half_space"], [*SHAPES]), ids="+".join)
@pytest.mark.parametrize("names", ((), ("manipulability", "isotropy")), ids=len)
def test_a_sweep_counts_what_the_twins_admit(shapes, names, precision, device, added):
    robot = ws.load_robot("ur5e", placement=ws.Transform(position_m=(0.2, 0.1, 0.0), rpy_deg=(0, 0, 30)))
    choice = {"region": {shape: SHAPES[shape] for shape in shapes}, "elbow_up": {"least": 0.2}, "pointing_down": True}
    constraints = constraints_of(Constraints(**choice))
    assert [each.name for each in constraints] == ["region", "elbow_up", "pointing_down"]
    each, found = swept(robot, names, constraints, ws.Sobol(COUNT), precision, device)
    q = configurations(each)
    poses = evaluate_poses(robot.chain, q, device="cpu")
    violated = np.array([constraint.host(q, poses) for constraint in constraints])
    first = np.where(violated.any(axis=0), violated.argmax(axis=0) + 1, 0)
    expected = np.bincount(first, minlength=4)
    near = 0 if precision == "float64" else 3  # samples at a border, which rounding decides
    assert np.abs(found.rejected - expected[1:]).max() <= near and 0 < found.admitted < COUNT
    assert abs(found.count.sum() - expected[0]) <= near and found.samples == COUNT
    admitted = poses[first == 0, :3, 3]
    np.testing.assert_allclose(found.maximum[:3] + each.origin, admitted.max(axis=0), atol=1e-4)
    np.testing.assert_allclose(found.minimum[:3] + each.origin, admitted.min(axis=0), atol=1e-4)


def test_values_are_those_of_admitted_samples_alone(device):
    robot = ws.load_robot("ur5e")
    region = RegionConstraint(half_space=((0, 0, 0.3), (0, 0, 1)))
    names = ("manipulability",)
    each, found = swept(robot, names, (region,), ws.Sobol(COUNT), "float64", device)
    rows = replace(each, kept_rows=frozenset())
    partial = sweep(rows, 0, COUNT, devices_of(device))
    table = np.concatenate([partial.rows[first] for first in sorted(partial.rows)], axis=1)
    admitted = table[-1] == 0
    np.testing.assert_array_equal(admitted, table[2] + each.origin[2] >= 0.3)
    values = table[3, admitted]
    assert found.maximum[3] == values.max() and found.minimum[3] == values.min()
    assert found.totals[0] == np.round(values * scales_of(each)[0]).astype(np.int64).sum() == found.sums.sum()


@pytest.mark.parametrize("names, statistics", RECORDS, ids=("4", "8", "16", "32"))
def test_voxels_hold_admitted_samples_alone(names, statistics, precision, device):
    """Records of several sizes in integers of the precision, by a table of the same samples."""
    robot = ws.load_robot("ur5e")
    region = RegionConstraint(half_space=((0, 0, 0.3), (0, 0, 1)))
    each = Pipeline(
        Evaluation(robot.chain, names, (0, 1, 2)),
        plan_sampling(robot.chain, ws.Random(4000)),  # no multiple of a block
        *((region,), BLOCK, statistics),
        bounds=(1e4,) * len(names),
        kept_rows=frozenset(),
        precision=precision,
    )
    found = sweep(each, 0, 4000, devices_of(device))
    table = np.concatenate([found.rows[first] for first in sorted(found.rows)], axis=1)
    cells = np.ravel_multi_index((np.floor((table[:3].T + each.origin) / 0.1).astype(int) + 20).T, BLOCK.shape)
    admitted = table[-1] == 0
    occupied, place = np.unique(cells[admitted], return_inverse=True)
    assert np.array_equal(found.cells, occupied) and np.array_equal(found.count, np.bincount(place))
    assert found.blocked_cells.tolist() == np.unique(cells[~admitted]).tolist()
    assert found.blocked[:, 0].tolist() == np.unique(cells[~admitted], return_counts=True)[1].tolist()
    values = table[3 : 3 + len(names), admitted]
    records = iter(np.split(found.records, found.records.shape[1] // len(names), axis=1))
    for name, largest, worst in (("maximum", np.maximum, -np.inf), ("minimum", np.minimum, np.inf)):
        if name in statistics:
            extreme = np.full((len(names), len(occupied)), worst)
            largest.at(extreme, (slice(None), place), values)
            assert np.array_equal(decode_extreme(next(records), name == "minimum"), extreme.T), name
    if "mean" in statistics:
        quanta = np.rint(values * scales_of(each)[:, None].astype(values.dtype)).astype(np.int64)
        sums = np.zeros((len(occupied), len(names)), np.int64)
        np.add.at(sums, place, quanta.T)
        assert np.array_equal(found.sums, sums)


@pytest.mark.parametrize("constraint", ("region", "elbow_up", "trailing"))
def test_a_grid_gives_the_same_with_and_without_its_structure(constraint, precision, device, added):
    robot = ws.load_robot("articulated")
    ws.register_constraint("trailing", lambda q, position, axes: q[1] - 0.1, keeps=frozenset({"base_joint"}))
    choice = {"region": {"sphere": {"radius_m": 0.3}}} if constraint == "region" else {constraint: True}
    constraints = constraints_of(Constraints(**choice))
    found = [
        swept(robot, ("manipulability",), constraints, ws.Grid(4), precision, device, collapse=collapse)
        for collapse in (True, False)
    ]
    (collapsed, a), (_direct, b) = found
    assert (SweepPlan(collapsed).structure.base_levels > 1) == (constraint == "trailing")
    assert (SweepPlan(collapsed).structure.weight > 1) == (constraint == "region")
    np.testing.assert_array_equal(a.rejected, b.rejected)
    np.testing.assert_array_equal(a.cells, b.cells)
    np.testing.assert_array_equal(a.count, b.count)
    assert 0 < a.admitted < a.samples == 4**6


def test_shards_and_files_keep_who_was_rejected():
    document = {
        "analysis": "workspace",
        "robot": "ur5e",
        "sampling": {"method": "sobol", "count": 4096},
        "constraints": {"region": {"box": SHAPES["box"]}},
        "refined_volume": None,
        "device": "cpu",
    }
    whole = plan(document)
    settled = whole.resolved()
    unit = settled["shard_unit"]
    settled["shards"] = [[0, 4 * unit], [4 * unit, 4096 - 4 * unit]]
    divided = plan(document, resolved=settled)
    parts = [divided.unpacked(run_shard(divided, k).packed()) for k in (1, 0)]
    assert merge(parts[0].sweep, parts[1].sweep).rejected.sum() > 0
    one = finish(whole, run_shard(whole, 0)).document
    two = finish(divided, divided.merge(*parts)).document
    assert one["samples"] == two["samples"] and one["indices"] == two["indices"]
    assert one["samples"]["admitted"] + one["samples"]["rejected"]["region"] == one["samples"]["drawn"] == 4096


def test_means_maps_and_pictures_hold_admitted_samples_alone():
    region = {"half_space": {"point_m": [0, 0, 0.2], "normal": [0, 0, 1]}}
    result = ws.analyze(
        "ur5e",
        ws.Sobol(1 << 14),
        constraints={"region": region},
        keep_map=True,
        refined_volume=None,
        precision="float64",
    )
    every = ws.analyze("ur5e", ws.Sobol(1 << 14), keep_map=True, refined_volume=None, precision="float64")
    above = every.map.position[:, 2] >= 0.2
    assert result.document["samples"]["admitted"] == len(result.map) == above.sum() == result.volume.count.sum()
    np.testing.assert_array_equal(result.map.position, every.map.position[above])
    assert result.sample.position[:, 2].min() >= 0.2
    values = every.map.indices["manipulability"][above]
    entry = result.document["indices"]["manipulability"]
    assert entry["joint_mean"] == pytest.approx(values.mean() / values.max(), rel=1e-6)
    assert entry["minimum"] == pytest.approx(values.min(), rel=1e-12)


def test_configurations_are_told_why_they_are_rejected(tmp_path, added):
    robot = ws.load_robot("ur5e")
    q = np.random.default_rng(0).uniform(-2, 2, (200, 6))
    document = {"analysis": "indices_at", "robot": "ur5e", "configurations": q.tolist(), "indices": ["isotropy"]}
    choice = {"region": {"half_space": {"point_m": [0, 0, 0.2]}}, "elbow_up": True}
    result = execute(document | {"constraints": choice})
    poses = robot.forward_kinematics(q)
    low, folded = poses[:, 2, 3] < 0.2, q[:, 2] + poses[:, 0, 3] / 2 < 0
    expected = np.where(low, "region", np.where(folded, "elbow_up", ""))
    np.testing.assert_array_equal(result.tables["admission"].columns["reason"], expected)
    values = result.map.indices["isotropy"]
    np.testing.assert_array_equal(np.isnan(values), expected != "")
    entry = result.document["indices"]["isotropy"]
    assert entry["maximum"] == np.nanmax(values) and entry["minimum"] == np.nanmin(values)
    low, folded = ((expected == name).sum() for name in ("region", "elbow_up"))
    told = f"admitted samples        {200 - low - folded} of 200; rejected by region {low}, elbow_up {folded}"
    assert told in result.summary()
    result.save(tmp_path / "out")
    assert ws.Result.load(tmp_path / "out").tables["admission"].columns["reason"].tolist() == expected.tolist()
    nowhere = {"region": {"sphere": {"center_m": [5, 5, 5], "radius_m": 0.1}}}
    none = execute(document | {"constraints": nowhere})
    assert none.document["indices"]["isotropy"]["maximum"] is None and none.document["samples"]["admitted"] == 0
    none.save(tmp_path / "none")


def test_all_are_constraints_and_asked_in_one_order(added):
    legs = LegDistance(0.1, ((0, 1),))
    (added_one,) = constraints_of(Constraints(elbow_up=True))
    each = (added_one, legs, RegionConstraint(ball=((0, 0, 0), 1)))
    assert all(isinstance(one, Constraint) and hash(one) == hash(replace(one)) for one in each)
    assert [one.name for one in in_order(each)] == ["region", "leg_distance", "elbow_up"]


def test_options_are_numbers_of_the_kernel_and_compile_nothing(added):
    robot = ws.load_robot("ur5e")
    shapes = []
    for least in (0.1, 0.9):
        constraints = constraints_of(Constraints(elbow_up={"least": least}))
        each, found = swept(robot, (), constraints, ws.Sobol(1024), "float32", "cpu")
        shapes.append((SweepPlan(each).shape, found.admitted))
    assert shapes[0][0] == shapes[1][0] and shapes[0][1] > shapes[1][1] > 0
    free = SweepPlan(replace(each, constraints=())).shape
    assert shapes[1][0] != free and free.constraints == () and free.limits == 0


@pytest.mark.parametrize(
    "choice, message",
    [
        (
            {"elbows": True},
            "constraints.elbows: unknown constraint; allowed: region, orientation, .*, elbow_up, pointing_down",
        ),
        ({"elbow_up": {"x": 1}}, "constraints.elbow_up.x: unknown option; allowed: least"),
        ({"region": {"sphere": {"center_m": [5, 5, 5], "radius_m": 0.1}}}, "admit none of 256 samples"),
    ],
)
def test_what_cannot_be_is_refused_when_a_job_is_planned(choice, message, added):
    with pytest.raises(InputError, match=message):
        ws.analyze("ur5e", ws.Sobol(256), constraints=choice, refined_volume=None)


@pytest.mark.parametrize(
    "choice, message",
    [
        ({"region": {}}, "constraints.region.box: must be given, or a sphere or a half_space"),
        ({"region": {"box": {"lower_m": [0, 0, 0], "upper_m": [0, 1, 1]}}}, "upper_m: must be above lower_m"),
        ({"region": {"half_space": {"normal": [0, 0, 0]}}}, "normal: must not have length 0"),
        ({"self_collision": 1}, "constraints.self_collision: must be true, false, null or an object, not 1"),
        ({"mine": "yes"}, "constraints.mine: must be true, false or numbers by option"),
    ],
)
def test_malformed_constraints(choice, message):
    with pytest.raises(DocumentError, match=message):
        ws.analyze("ur5e", constraints=choice)


@pytest.mark.parametrize(
    "name, function, message",
    [
        ("region", lambda q, p, a: q[0], "an identifier other than"),
        ("a b", lambda q, p, a: q[0], "an identifier other than"),
        ("odd", lambda q, p, a: np.sin(q[0]), "cannot be compiled"),
        ("odd", lambda q, p, a, text="x": q[0], "must have numbers as defaults"),
    ],
)
def test_what_cannot_be_added(name, function, message, added):
    with pytest.raises(InputError, match=message):
        ws.register_constraint(name, function)


def whole_powers(q, position, axes):
    x, y = position[0], position[1]
    return x**-3 / 50 + x**-2 / 20 + y**-1.0 / 10 + x**0 - y**2.0 - x**3 + 30 * (y**9 + x**10 + y**-9 / 1e9) - 0.5


def other_powers(q, position, axes):
    return position[0] ** 0.5 + position[1] ** -1.5 / 50 - 0.5


@pytest.mark.parametrize("function", [whole_powers, other_powers])
def test_powers_of_negative_numbers_are_those_of_numpy(function, precision, device, added):
    ws.register_constraint("powered", function)
    robot, (constraint,) = ws.load_robot("scara"), constraints_of(Constraints(powered=True))
    samples = plan_sampling(robot.chain, ws.Sobol(COUNT))
    each = Pipeline(Evaluation(robot.chain), samples, (constraint,), kept_rows=frozenset(), precision=precision)
    q = np.asarray(configurations(each), np.float64)
    poses = robot.forward_kinematics(q)
    with np.errstate(invalid="ignore"):
        margin = function(q.T, poses[:, :3, 3].T, None)
        host = constraint.host(q, poses)
    sure, admitted = ~(np.abs(margin) < 1e-3), margin >= 0
    assert 0.05 < admitted.mean() < 0.95
    assert ((evaluate_samples(each, device).rejected == 0) == admitted)[sure].all()
    assert ((host == 0) == admitted).all()


@pytest.mark.parametrize(
    "keeps, message",
    (
        (frozenset({"base"}), r"keeps: .* is not allowed; allowed: base_joint, trailing_joints"),
        ("base_joint", "keeps: must be a set of base_joint, trailing_joints, not 'base_joint'"),
    ),
)
def test_structures_that_a_constraint_may_keep(keeps, message, added):
    with pytest.raises(InputError, match=message):
        ws.register_constraint("mine", lambda q, position, axes: q[0], keeps=keeps)


class Crank:
    """A planar joint with a link of 0.5 m."""

    limits = ((-1.0, 2.0),)

    def forward_kinematics(self, q):
        T = np.tile(np.eye(4), (len(q), 1, 1))
        T[:, 0, 3], T[:, 1, 3] = 0.5 * np.cos(q[:, 0]), 0.5 * np.sin(q[:, 0])
        return T


def test_a_robot_of_a_class_stays_in_a_region_and_knows_no_expression(added):
    region = {"region": {"half_space": {"normal": [0, 1, 0]}}}
    options = {"task": ["x"], "refined_volume": None, "voxel_size_m": 0.01}
    result = ws.analyze(Crank(), ws.Grid(302), constraints=region, **options)
    assert result.document["samples"] == {"drawn": 302, "admitted": 201, "rejected": {"region": 101}}
    with pytest.raises(InputError, match=r"constraints\.elbow_up: is not available"):
        ws.analyze(Crank(), ws.Grid(301), constraints={"elbow_up": True}, **options)


FULL = np.pi / 2 * np.sqrt(2) * (0.4**3 - 0.2**3) / 3  # of the library's spherical arm, symmetric about z = 0 and y = 0
PLACED = ws.Transform(position_m=(1.0, 2.0, 3.0), rpy_deg=(0, 0, 90))


@pytest.mark.parametrize(
    "region, expected",
    [
        ({"sphere": {"center_m": [1, 2, 3], "radius_m": 0.3}}, FULL * (0.3**3 - 0.2**3) / (0.4**3 - 0.2**3)),
        ({"half_space": {"point_m": [1, 2, 3], "normal": [1, 0, 1]}}, FULL / 2),
        ({"box": {"lower_m": [1, -9, -9], "upper_m": [9, 9, 9]}, "half_space": {"point_m": [1, 2, 3]}}, FULL / 4),
    ],
    ids=("sphere", "half_space", "box and half_space"),
)
def test_the_headline_is_what_is_reached_in_the_region(region, expected):
    robot = ws.load_robot("spherical", placement=PLACED)  # symmetric about the world's planes x = 1 and z = 3
    result = ws.analyze(robot, ws.Sobol(1 << 18), constraints={"region": region}, refined_volume=0.02)
    headline = result.document["headline"]
    low, high = headline["ci95"]
    assert low <= expected <= high and headline["value"] == pytest.approx(expected, rel=0.02)
    assert result.document["global"]["structural_length_index"] is None
    assert [each["code"] for each in result.document["warnings"]] in ([], ["occupied_differs"])
    assert not any(each["code"] == "few_samples" for each in result.document["warnings"])


def test_nothing_is_reached_in_a_region_out_of_reach():
    from wsrender.reach.measure_refinement import refined_measure

    found = refined_measure(ws.load_robot("spherical").chain, 0.05, region=RegionConstraint(ball=((9, 9, 9), 0.1)))
    assert (found.value, found.ci95) == (0.0, (0.0, 0.0))


def test_headlines_are_of_what_is_free(added):
    """Of the two postures of a UR5e's elbow one is nearly always admitted."""
    result = ws.analyze("ur5e", ws.Sobol(1 << 12), constraints={"elbow_up": True}, refined_volume=0.02)
    volume, headline = result.document["volume_m3"], result.document["headline"]
    assert headline["ci95"] == volume["free"]["ci95"] and headline["value"] == pytest.approx(3.80, rel=0.03)
    assert list(volume["blocked"]["by"]) == ["elbow_up"] and volume["blocked"]["value"] < 0.03 * 3.80
    assert "free volume" in result.summary() and "blocked volume" in result.summary()


@pytest.mark.parametrize("shapes", (["box"], ["sphere"], ["half_space"], [*SHAPES]), ids="+".join)
def test_distances_to_a_region_are_no_larger_than_those_to_points_in_it(shapes):
    (region,) = constraints_of(Constraints(region={shape: SHAPES[shape] for shape in shapes}))
    points = np.random.default_rng(0).uniform(-1.5, 1.5, (4000, 3))
    inside, distance = region.holds(points), region.distance(points)
    np.testing.assert_array_equal(distance == 0, inside)
    apart = np.linalg.norm(points[:, None] - points[inside][None, :500], axis=-1).min(axis=1)
    assert (distance <= apart + 1e-12).all() and distance.max() > 0.5


@pytest.mark.parametrize("names", ((), ("manipulability",), ("dynamic_manipulability", "isotropy")), ids=len)
def test_a_collapsed_base_joint_asks_for_the_tip_in_the_world(names, precision, device, added):
    """A height and the direction of the tool from the base, on an arm whose base frame is raised and turned."""
    placement = ws.Transform(position_m=(0.3, -0.2, 0.7), rpy_deg=(0, 0, 40))
    robot = ws.load_robot("ur5e", placement=placement)
    keeps = frozenset({"base_joint"})
    ws.register_constraint("low", lambda q, position, axes, most=0.85: most - position[2], keeps=keeps)
    ws.register_constraint("out", out_of_axis, keeps=keeps)
    constraints = constraints_of(Constraints(low=True, out=True))
    collapsed, direct = (
        swept(robot, names, constraints, ws.Grid(5), precision, device, collapse=collapse) for collapse in (True, False)
    )
    assert SweepPlan(collapsed[0]).structure.base_levels == 5 and SweepPlan(direct[0]).structure.base_levels == 1
    np.testing.assert_array_equal(collapsed[1].rejected, direct[1].rejected)
    np.testing.assert_array_equal(collapsed[1].count, direct[1].count)
    q = configurations(direct[0])
    poses = evaluate_poses(robot.chain, q, device="cpu")
    low, out = (each.host(q, poses) for each in constraints)
    assert collapsed[1].rejected.tolist() == [low.sum(), (out & ~low).sum()] and (collapsed[1].rejected > 0).all()


def out_of_axis(q, position, axes):
    """Positive where the tip's z axis points away from the vertical axis through (0.3, -0.2)."""
    return (position[0] - 0.3) * axes[2][0] + (position[1] + 0.2) * axes[2][1] + 0.013


@pytest.mark.parametrize("sampling", (ws.Sobol(COUNT), ws.Grid(5)), ids=("sobol", "grid"))
def test_a_base_far_away_changes_no_answer(sampling, precision, device, added):
    """UTM coordinates: whole numbers, so that what the region says is the same to the bit."""
    away, found = np.array([456_000.0, 5_428_000.0, 110.0]), []
    ws.register_constraint("beside", lambda q, position, axes, x=0.0, z=0.0: position[0] - x + 0.1 * (position[2] - z))
    for shift in (np.zeros(3), away):
        robot = ws.load_robot("ur5e", placement=ws.Transform(position_m=tuple(shift)))
        box = {"lower_m": (shift - 0.5).tolist(), "upper_m": (shift + 0.75).tolist()}
        choice = {"region": {"box": box}, "beside": {"x": float(shift[0]), "z": float(shift[2])}}
        constraints = constraints_of(Constraints(**choice))
        block = LatticeBlock(0.125, tuple(int(8 * v) - 16 for v in shift), (32, 32, 32))
        found.append(swept(robot, ("manipulability",), constraints, sampling, precision, device, block=block)[1])
    near, far = found
    np.testing.assert_array_equal(near.rejected, far.rejected)
    np.testing.assert_array_equal(near.cells, far.cells)
    np.testing.assert_array_equal(near.count, far.count)
    assert (near.rejected > 0).all() and near.admitted > 0


@pytest.mark.parametrize("side", (1, -1))
def test_an_arm_in_the_plane_that_borders_a_region_stays_in_it(side, precision):
    """Of two links, in a plane askew in the world: rounding puts half of its positions beyond."""
    rows = [{"a": 0.4, "limits": [-np.pi, np.pi]}, {"a": 0.3, "limits": [-np.pi, np.pi]}]
    placement = ws.Transform(position_m=(0.31, -0.47, 0.59), rpy_deg=(37, -21, 13))
    robot = ws.load_robot(ws.DHTable(convention="standard", rows=rows), placement=placement)
    plane = {"point_m": [0.31, -0.47, 0.59], "normal": (side * placement.matrix()[:3, 2]).tolist()}
    options = {"constraints": {"region": {"half_space": plane}}, "precision": precision, "task": ["x", "y"]}
    result = ws.analyze(robot, ws.Sobol(1 << 14), **options, refined_volume=0.02)
    assert result.document["samples"] == {"drawn": 1 << 14, "admitted": 1 << 14, "rejected": {"region": 0}}
    low, high = result.document["headline"]["ci95"]
    assert low <= np.pi * (0.7**2 - 0.1**2) <= high and high - low < 0.05 * high
    q = np.random.default_rng(0).uniform(-3, 3, (1000, 2))
    (region,) = constraints_of(Constraints(region={"half_space": plane}))
    assert not region.host(q, robot.chain.poses(q)).any()


def test_the_interval_of_a_small_region_is_as_narrow_as_asked():
    """Few of the samples lie in it, and the solver's misses are not known better from so few."""
    robot = ws.load_robot("spherical", placement=PLACED)
    region = {"sphere": {"center_m": [1, 1.7, 3], "radius_m": 0.02}}
    result = ws.analyze(robot, ws.Sobol(1 << 18), constraints={"region": region}, refined_volume=0.02)
    measure = result.document["volume_m3"]["refined"]
    low, high = measure["ci95"]
    assert measure["met"]
    assert low <= 4 / 3 * np.pi * 0.02**3 <= high and high - low <= 0.04 * high
    assert measure["false_negatives"][0]["tested"] >= 4096


def test_converging_samples_of_which_none_is_admitted():
    choice = {"region": {"sphere": {"center_m": [5, 5, 5], "radius_m": 0.1}}}
    for by in ("joint_mean", "workspace_mean"):
        sampling = ws.Converge(start=3, step=1, by=by)
        with pytest.raises(InputError, match="constraints: admit none of 729 samples"):
            ws.analyze("spherical", sampling, constraints=choice, refined_volume=None)


def test_a_joint_that_the_robot_does_not_have(added):
    """Functions of long arms are added; of a short arm they are refused before it is swept."""
    ws.register_constraint("tenth", lambda q, position, axes: q[9] + 1)
    message = "constraints.tenth: takes a joint that this robot of 6 does not have"
    for document in (
        {"analysis": "workspace", "sampling": {"method": "sobol", "count": 1024}},
        {"analysis": "indices_at", "configurations": [[0.0] * 6]},
    ):
        with pytest.raises(InputError, match=message):
            plan({"robot": "ur5e", "constraints": {"tenth": True}, **document})


def test_the_arms_of_pictures_are_admitted_and_titles_say_by_what():
    region = {"region": {"box": {"lower_m": [-1, -1, 0.5], "upper_m": [0, 0, 1.2]}}}
    options = {"refined_volume": None, "indices": ["manipulability"], "device": "cpu"}
    result = ws.analyze("ur5e", ws.Sobol(1 << 13), constraints=region, **options)
    tips = result.skeleton[:, -1]
    assert len(tips) == 3 and (tips >= [-1, -1, 0.5]).all() and (tips <= [0, 0, 1.2]).all()
    assert result.plot.title == "ur5e · 8,192 samples (sobol) · admitted by region"


ALONE = {"position_m": [1.0, 2.0, 3.0], "rpy_deg": [0, 0, 90]}
HALF = {"region": {"half_space": {"point_m": [1, 2, 3], "normal": [1, 0, 1]}}}


def test_robots_that_share_a_workspace_share_its_region():
    """Twice the same arm: shared is what one reaches; of a moved one at each value what is left of it."""
    arm = {"robot": {"library": "spherical", "placement": ALONE}, "sampling": {"method": "sobol", "count": 1 << 16}}
    document = {"analysis": "shared_workspace", "robots": [arm] * 2, "constraints": HALF, "refined_volume": 0.02}
    scan = {"robot": 1, "axis": "x", "values": [1.0, 9.0]}
    result = execute(document | {"voxel_size_m": 0.02, "scan": scan})
    table = result.tables["scan"].columns
    np.testing.assert_allclose(table["any"], [FULL / 2, 3 * FULL / 2], rtol=0.05)
    np.testing.assert_allclose(table["shared"], [FULL / 2, 0], rtol=0.05)
    low, high = result.document["headline"]["ci95"]
    assert low <= FULL / 2 <= high and result.document["headline"]["value"] == pytest.approx(FULL / 2, rel=0.02)
    for robot in result.document["robots"]:
        assert robot["samples"]["admitted"] + robot["samples"]["rejected"]["region"] == 1 << 16
    assert result.volume.count.sum() < 2 << 16


def test_headlines_of_several_robots_are_of_what_is_free(added):
    robots = [{"robot": {"library": "spherical"}, "sampling": {"method": "sobol", "count": 4096}}] * 2
    for analysis in ("shared_workspace", "robot_comparison"):
        asked = {"constraints": {"elbow_up": {"least": 0.2}}, "refined_volume": 0.1}
        result = execute({"analysis": analysis, "robots": robots, **asked})
        first = result.document["robots"][0]
        assert first["samples"]["rejected"]["elbow_up"] > 0
        assert first["volume_m3"].get("blocked", {}).get("by", {}).keys() <= {"elbow_up"}
        if analysis == "shared_workspace":
            volume, headline = result.document["volume_m3"], result.document["headline"]
            low, high = headline["ci95"]
            assert headline["value"] == volume["free"]["value"] > 0 and list(volume["blocked"]["by"]) == ["elbow_up"]
        else:
            # Twice the same arm: both are free where one is.
            assert low <= first["headline"]["value"] == first["volume_m3"]["free"]["value"] <= high
