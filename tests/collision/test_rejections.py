"""What results say of rejected samples: where they lie, the first ones, pairs that collide, and losses by chance."""

from collections import Counter
from concurrent.futures import ThreadPoolExecutor

import mujoco
import numpy as np
import pytest

import wsrender as ws
from tests.collision.robots import drawn
from tests.collision.test_labels import AROUND, SELF, labels
from wsrender.collision.distance import colliding
from wsrender.documents.constraints import Constraints
from wsrender.engine import SweepPlan, configurations, devices_of, evaluated_of, merge, sweep
from wsrender.engine.sweep_plan import Accumulator
from wsrender.errors import InputError
from wsrender.pipeline.evaluation import Evaluation
from wsrender.pipeline.pipeline import Pipeline
from wsrender.pipeline.sampling import plan_sampling
from wsrender.robot.constraints import constraints_for
from wsrender.robot.rejections import colliding_pairs, lost_voxels, moved_means
from wsrender.volume.lattice import LatticeBlock

BLOCK = LatticeBlock(0.1, (-20, -20, -20), (40, 40, 40))
NEAR = Constraints(self_collision=True, region={"sphere": {"position_m": [0, 0, 0], "radius_m": 0.6}})


@pytest.mark.parametrize("indices", [(), ("manipulability",)])
@pytest.mark.parametrize("sampling", [ws.Sobol(20_000), ws.Grid(5)], ids=lambda s: s.method)
def test_voxels_and_first_samples_are_those_of_the_rows(sampling, indices, precision, device):
    robot = ws.load_robot("ur5e")
    constraints, samples = constraints_for(robot, NEAR, AROUND), plan_sampling(robot.chain, sampling)
    each = Pipeline(
        Evaluation(robot.chain, indices, (0, 1, 2)) if indices else Evaluation(robot.chain),
        *(samples, constraints, BLOCK),
        kept_rows=frozenset(),
        bounds=(16.0,) if indices else None,
        precision=precision,
    )
    partial = sweep(each, 0, samples.count, devices_of(device), chunk_size=4096)
    rows = evaluated_of(each, partial)
    assert [each.name for each in constraints] == ["region", "environment", "self_collision"]
    q = np.asarray(configurations(each))
    assert np.array_equal(rows.rejected, labels(robot, q, constraints, precision, device))
    assert partial.earliest.tolist() == [np.flatnonzero(rows.rejected == k)[0] for k in (1, 2, 3)]
    cells = np.ravel_multi_index((np.floor(rows.position / 0.1).astype(int) + 20).T, BLOCK.shape)
    for k in (1, 2, 3):
        expected = np.bincount(cells[rows.rejected == k], minlength=BLOCK.size)
        found = np.zeros(BLOCK.size, int)
        found[partial.blocked_cells] = partial.blocked[:, k - 1]
        assert np.array_equal(found, expected)


def test_a_grid_that_is_collapsed_counts_all_that_it_stands_for():
    """The base joint of an arm over nothing, and last joints where the tip is all that is asked."""
    robot, found = ws.load_robot("ur5e"), []
    (region,) = constraints_for(robot, Constraints(region={"box": {"lower_m": [None, None, 0.1]}}))
    (self_collision,) = constraints_for(robot, SELF)
    for constraint, grid in ((self_collision, ws.Grid(6)), (region, ws.Grid((3, 4, 4, 3, 2, 7)))):
        samples = plan_sampling(robot.chain, grid)
        for collapse in (True, False):
            each = Pipeline(Evaluation(robot.chain), samples, (constraint,), BLOCK, collapse=collapse)
            found.append(sweep(each, 0, samples.count, devices_of("cpu")))
        a, b = found[-2:]
        assert a.earliest.tolist() == b.earliest.tolist() and a.rejected.sum() == a.blocked.sum() > 0
        for name in ("blocked_cells", "blocked", "cells", "count"):
            assert np.array_equal(getattr(a, name), getattr(b, name)), name


def test_what_threads_have_counted_adds_up_in_any_order():
    robot = ws.load_robot("scara")
    constraints = constraints_for(robot, Constraints(region={"box": {"lower_m": [None, 0.1, None]}}))
    samples, (cpu,) = plan_sampling(robot.chain, ws.Sobol(8_192)), devices_of("cpu")
    plan = SweepPlan(Pipeline(Evaluation(robot.chain), samples, constraints, BLOCK))
    whole = sweep(plan.pipeline, 0, samples.count, [cpu])
    ranges = ((0, 2_048), (2_048, 6_144))
    for order in (ranges, ranges[::-1]):
        own, other = (Accumulator(plan, plan.shape, BLOCK, cpu, 8_192) for _ in order)
        own.add(*order[0])
        other.add(*order[1])
        parts = [sweep(plan.pipeline, *part, [cpu]) for part in order]
        with ThreadPoolExecutor(1) as pool:
            own.absorb(other, pool)
        for found in (own.partial(), merge(*parts)):
            for name in ("rejected", "earliest", "blocked_cells", "blocked"):
                assert np.array_equal(getattr(found, name), getattr(whole, name)), name


def test_a_constraint_that_rejects_nothing_has_no_first_sample():
    robot = ws.load_robot("scara")
    everywhere = {"region": {"box": {"lower_m": [-9, -9, -9]}}}
    result = ws.analyze(robot, ws.Sobol(512), constraints=everywhere, refined_volume=None)
    rejections = result.document["rejections"]
    assert rejections["first"] == {} and "pairs" not in rejections and rejections["volume_m3"]["lost"] == 0
    assert rejections["volume_m3"]["lost_at_random"] == {"value": 0.0, "ci95": [0.0, 0.0]}


def touching(robot, q):
    """How often MuJoCo's own pipeline reports a contact between two shapes, by their names."""
    bodies = robot.bodies
    model, data = bodies.model, mujoco.MjData(bodies.model)
    model.geom_margin[:] = 0
    name_of, found = {shape.geom: shape.name for shape in bodies.shapes}, Counter()
    for qpos in bodies.qpos(q):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        mujoco.mj_collision(model, data)
        near = [c for c in data.contact[: data.ncon] if c.dist < 0 and {c.geom1, c.geom2} <= set(name_of)]
        found.update({frozenset((name_of[c.geom1], name_of[c.geom2])) for c in near})
    return found


@pytest.mark.parametrize("name", ["ur5e", "franka_panda"])
def test_pairs_that_collide_are_those_of_mujoco(name):
    robot = ws.load_robot(name)
    constraints, q = constraints_for(robot, SELF), drawn(robot, 3_000)
    found = colliding_pairs(constraints, q, labels(robot, q, constraints))["pairs"]
    counts = {frozenset(pair["shapes"]): pair["samples"] for pair in found["colliding"]}
    assert counts == touching(robot, q) and found["counted"] == len(q)
    assert list(counts.values()) == sorted(counts.values(), reverse=True)


def test_pairs_count_whatever_a_sample_is_rejected_for(monkeypatch):
    """Of an arm whose every sample is out of the region; and of a stated part of many samples."""
    robot = ws.load_robot("ur5e")
    apart = constraints_for(robot, SELF, AROUND)
    q = drawn(robot, 2_000)
    some = colliding_pairs(apart, q, labels(robot, q, apart))
    assert colliding_pairs(apart, q, np.ones(len(q), int)) == some
    assert {pair["constraint"] for pair in some["pairs"]["colliding"]} == {"environment", "self_collision"}
    monkeypatch.setattr("wsrender.robot.rejections.COUNTED", 300)
    part = colliding_pairs(apart, q, np.ones(len(q), int))["pairs"]
    assert part == colliding_pairs(apart, q[::7], np.ones(286, int))["pairs"] and part["counted"] == 286


def test_losses_at_random_are_those_of_samples_that_are_dropped_at_random():
    random = np.random.default_rng(0)
    cell = np.sort(random.geometric(0.03, 4_000))
    counts = np.bincount(cell)[np.bincount(cell) > 0]
    kept = np.full(len(counts), 1)
    kept[:3] = 0
    entry = lost_voxels(counts, kept, 4_000, 2_900, 0.5)
    lost = []
    for _ in range(1_500):
        left = np.bincount(random.permutation(cell)[:1_100], minlength=cell.max() + 1)
        lost.append(0.5 * (len(counts) - np.count_nonzero(left)))
    expected, (low, high) = entry["lost_at_random"]["value"], entry["lost_at_random"]["ci95"]
    assert abs(np.mean(lost) - expected) < 4 * np.std(lost) / np.sqrt(len(lost))
    assert np.mean((lost >= np.array(low)) & (lost <= np.array(high))) >= 0.95
    assert high - low < 2 * (np.percentile(lost, 97.5) - np.percentile(lost, 2.5))
    assert entry["drawn"] == 0.5 * len(counts) and entry["lost"] == 1.5


@pytest.mark.parametrize("rejected", [0, 1_000])
def test_losses_of_none_and_of_all_samples(rejected):
    counts = np.array([1, 9, 990])
    entry = lost_voxels(counts, counts, 1_000, rejected, 1.0)["lost_at_random"]
    assert entry["value"] == pytest.approx(3.0 if rejected else 0.0, abs=1e-9)


def test_means_of_an_index_beside_those_after_a_random_drop():
    random = np.random.default_rng(1)
    values = random.exponential(size=5_000)
    entry = moved_means(values, np.where(values > 1.5, 2, 0))
    assert entry["drawn"] == values.mean() and entry["admitted"] == values[values <= 1.5].mean()
    kept = int((values <= 1.5).sum())
    means = np.array([random.permutation(values)[:kept].mean() for _ in range(2_000)])
    low, high = entry["at_random"]["ci95"]
    assert np.mean((means >= low) & (means <= high)) == pytest.approx(0.95, abs=0.02)
    assert moved_means(values, np.ones(5_000))["admitted"] is None


def test_a_job_says_what_it_rejects(tmp_path):
    around = ws.Environment([ws.HalfSpace(name="floor", point_m=(0, 0, -0.003))])
    asked = {"environment": around, "constraints": {"self_collision": True}, "refined_volume": None}
    result = ws.analyze("ur5e", ws.Sobol(30_000), indices=["manipulability"], voxel_size_m=0.1, **asked)
    robot, (samples, rejections) = ws.load_robot("ur5e"), map(result.document.get, ("samples", "rejections"))
    constraints = constraints_for(robot, SELF, around)
    for number, (name, first) in enumerate(rejections["first"].items(), 1):
        found = labels(robot, np.array([first["configuration"]]), constraints)
        assert found.tolist() == [number] and name == constraints[number - 1].name and first["sample"] < 100
    assert list(rejections["first"]) == ["environment", "self_collision"]
    admission = result.volumes["admission"].voxels
    of = {name: values for by in admission.statistics.values() for name, values in by.items()}
    assert admission.count.sum() == 30_000 and of["admitted"].sum() == samples["admitted"]
    assert {name: of[name].sum() for name in samples["rejected"]} == samples["rejected"]
    assert np.array_equal(of["admitted_samples"], of["admitted"] / admission.count)
    assert result.volume.n_occupied == np.count_nonzero(of["admitted"])
    lost = rejections["volume_m3"]
    assert lost["drawn"] - lost["lost"] == pytest.approx(result.document["volume_m3"]["occupied"])
    below = result.volumes["admission"].centers(2) < -0.1
    assert np.nanmax(result.volumes["admission"].statistics["samples"]["environment"][:, :, below]) > 0
    assert not np.nan_to_num(result.volumes["admission"].statistics["samples"]["admitted"])[:, :, below].any()
    summary = result.summary()
    assert "colliding pairs" in summary and "dropped at random" in summary and "over the admitted samples" in summary
    result.save(tmp_path / "out", ("vti",))
    again = ws.Result.load(tmp_path / "out").volumes["admission"]
    assert np.array_equal(again.count, result.volumes["admission"].count)
    text = (tmp_path / "out" / "admission.vti").read_bytes()
    names = "count", *(f"{by}_{name}" for by, each in admission.statistics.items() for name in each)
    assert len(names) == 5 and all(f'Name="{name}"'.encode() in text for name in names)
    means = rejections["means"]["indices"]["manipulability"]
    assert means["admitted"] == pytest.approx(result.sample.indices["manipulability"].mean())


def test_rows_say_what_they_are_rejected_for():
    robot, q = ws.load_robot("ur5e"), drawn(ws.load_robot("ur5e"), 400)
    result = ws.indices_at(robot, q, constraints={"self_collision": True})
    (first,) = result.document["rejections"]["first"].values()
    reasons = np.array(result.tables["admission"]["reason"])
    assert first["sample"] == np.flatnonzero(reasons)[0] and first["configuration"] == q[first["sample"]].tolist()
    found = result.document["rejections"]["pairs"]["colliding"]
    assert {frozenset(pair["shapes"]): pair["samples"] for pair in found} == touching(robot, q)


def test_each_of_several_robots_says_what_it_rejects():
    arm = {"robot": {"library": "ur5e"}, "sampling": {"method": "sobol", "count": 2048}}
    job = {"analysis": "robot_comparison", "robots": [arm | {"name": name} for name in ("left", "right")]}
    result = ws.execute(job | {"constraints": {"self_collision": True}, "refined_volume": None, "voxel_size_m": 0.2})
    assert all("self_collision" in robot["rejections"]["first"] for robot in result.document["robots"])


def nested(links, span):
    """A ball on the base, and another at the end of links as long as ``span`` together, no longer than both radii."""
    body = '<geom name="hand" type="sphere" size="0.1"/><site name="tip"/>'
    for k in range(links):
        place = f'<inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/><joint name="j{k}" axis="0 1 0" range="-1 1"/>'
        body = f'<body name="b{k}">{place}<body pos="{span / links} 0 0">{body}</body></body>'
    base = f'<body name="base"><geom name="foot" type="sphere" size="0.1"/>{body}</body>'
    return f'<mujoco><compiler angle="radian" autolimits="true"/><worldbody>{base}</worldbody></mujoco>'


def test_pairs_that_touch_always_without_a_proof_are_named():
    robot = ws.load_robot(nested(4, 0.19999), tip="tip")
    with pytest.raises(InputError, match=r"rejected by self_collision 64.*exclude = \[\['foot', 'hand'\]\] lets"):
        ws.analyze(robot, ws.Sobol(64), constraints={"self_collision": True}, refined_volume=None)


def test_pairs_nearer_than_a_margin_are_counted_though_they_do_not_touch():
    robot = ws.load_robot(nested(2, 0.25), tip="tip")
    (constraint,) = constraints_for(robot, Constraints(self_collision={"margin_m": 0.03}))
    q = drawn(robot, 200)
    near = colliding(constraint.own, constraint.distances, constraint.chain, q)[:, 0]
    assert (near == (0.25 * np.cos(q[:, 1] / 2) < 0.2 + 0.03)).all() and 0 < near.sum() < len(q)
