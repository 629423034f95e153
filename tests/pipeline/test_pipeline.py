"""A pipeline is a value that prints itself; all four entrances of the engine give what it says."""

from dataclasses import fields, replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from wsrender.documents.constraints import Constraints
from wsrender.engine import configurations, devices_of, evaluate_poses, evaluate_samples, sampled_positions, sweep
from wsrender.engine.sums import scales_of
from wsrender.pipeline.constraints.region import RegionConstraint
from wsrender.pipeline.constraints.registry import constraints_of
from wsrender.pipeline.evaluation import Evaluation
from wsrender.pipeline.pipeline import Pipeline, tip_pipeline
from wsrender.pipeline.sampling import plan_sampling
from wsrender.robot import as_robot
from wsrender.run import plan
from wsrender.volume.lattice import LatticeBlock

JOB = {
    "analysis": "workspace",
    "robot": {"library": "ur5e"},
    "sampling": {"method": "sobol", "count": 1000000, "seed": 3},
    "constraints": {"region": {"sphere": {"radius_m": 0.8}}},
    "indices": ["manipulability", "isotropy"],
    "index_options": {},
    "voxel_size_m": 0.02,
    "device": "cpu",
    "refined_volume": None,
}
Q = np.random.default_rng(5).uniform(-1.0, 1.0, (300, 6))
ABOVE = RegionConstraint(half_space=((0.0, 0.0, 0.6), (0.0, 0.0, 1.0)))


def planned(**changes):
    return plan({**JOB, **changes}).pipeline


def with_joint(k, by):
    """The chain of a UR5e with the frame of a joint moved."""
    chain = ws.load_robot("ur5e").chain
    frames = chain.T_joint.copy()
    frames[k, 0, 3] += by
    return replace(chain, T_joint=frames)


def test_equal_jobs_make_equal_pipelines():
    first, second = planned(), planned()
    assert first is not second and first == second and hash(first) == hash(second)
    assert len({first, second, planned(voxel_size_m=0.03)}) == 2


@pytest.mark.parametrize(
    "change",
    [
        {"sampling": {"method": "sobol", "count": 1000000, "seed": 4}},
        {"sampling": {"method": "sobol", "count": 1000000, "seed": 3, "locked": {"joint6": 0.1}}},
        {"robot": {"library": "ur5e", "placement": {"position_m": [0.0, 0.0, 1e-9]}}},
        {"constraints": {"region": {"sphere": {"radius_m": 0.81}}}},
        {"indices": ["isotropy", "manipulability"]},
        {"task": "angular"},
        {"voxel_statistics": ["count", "mean"]},
        {"keep_map": True},
        {"precision": "float64"},
    ],
    ids=lambda each: next(iter(each)),
)
def test_whatever_differs_makes_another(change):
    assert planned(**change) != planned()


OTHER = {str: "other", bool: True, int: 7, float: 0.5, type(None): 0.25, tuple: ("other",), dict: {"isotropy": {}}}


def test_no_field_is_left_out():
    """Each replaced, of the pipeline and of what it is made of."""
    pipeline = tip_pipeline(ws.load_robot("ur5e").chain, ws.Sobol(100))
    for part in (pipeline, pipeline.evaluation, pipeline.sampling):
        for field in fields(part):
            value = getattr(part, field.name)
            if type(value) in OTHER:
                other = not value if value is True or value is False else OTHER[type(value)]
            elif isinstance(value, np.ndarray):
                other = value + value.dtype.type(1)
            elif isinstance(value, frozenset):
                other = frozenset({"minimum"})
            else:
                continue  # a part of its own
            assert replace(part, **{field.name: other}) != part, field.name


def test_arms_are_compared_by_their_numbers_and_classes_by_themselves():
    chain = ws.load_robot("ur5e").chain
    assert chain == ws.load_robot("ur5e").chain != with_joint(2, 1e-12)
    assert len({chain, with_joint(2, 0.0), with_joint(2, 1e-12)}) == 2

    class Slide:
        limits = ((0.0, 1.0),)

        def forward_kinematics(self, q):
            T = np.tile(np.eye(4), (len(q), 1, 1))
            T[:, 0, 3] = q[:, 0]
            return T

    one, other = as_robot(Slide()).chain, as_robot(Slide()).chain
    assert one.content_hash == other.content_hash  # of the numbers alone
    assert one == replace(one) != other


def test_given_configurations_are_compared_by_value():
    chain = ws.load_robot("ur5e").chain
    moved = Q.copy()
    moved[-1, -1] += 1e-15
    assert tip_pipeline(chain, Q) == tip_pipeline(chain, Q.copy()) != tip_pipeline(chain, moved)


@pytest.mark.parametrize(
    "changes, text",
    [
        ({}, "sobol 1e6 → ur5e → region → manipulability, isotropy → voxels 20 mm (count, maximum)"),
        (
            {"constraints": None, "voxel_statistics": ["count", "mean", "maximum"], "voxel_size_m": 0.0125},
            "sobol 1e6 → ur5e → manipulability, isotropy → voxels 12.5 mm (count, maximum, mean)",
        ),
        (
            {"sampling": {"method": "grid", "per_joint": 7}, "keep_map": True, "voxel_statistics": ["count"]},
            "grid 7^6 → ur5e → region → manipulability, isotropy → voxels 20 mm (count) and rows",
        ),
        (
            {"sampling": {"method": "grid", "per_joint": [1, 2, 3, 4, 5, 6]}, "keep_map": True,
             "map_columns": ["orientation", "configuration"]},
            "grid 1 × 2 × 3 × 4 × 5 × 6 → ur5e → region → manipulability, isotropy → voxels 20 mm (count, maximum) "
            "and rows (configuration, orientation)",
        ),
    ],
)  # fmt: skip
def test_it_prints_its_stages(changes, text):
    assert str(planned(**changes)) == text == repr(planned(**changes))


def test_the_parts_of_its_text():
    chain = ws.load_robot("ur5e").chain
    both = (*constraints_of(Constraints(region={"sphere": {"radius_m": 0.8}})), replace(ABOVE, name="table"))
    assert str(replace(tip_pipeline(chain, Q), constraints=both)) == "given 300 → ur5e → region ∧ table → position"
    texts = {1: "1", 999: "999", 1000: "1e3", 4096: "4096", 1_500_000: "1.5e6", 1 << 24: "16777216"}
    for count, text in texts.items():
        assert str(plan_sampling(chain, ws.Random(count))) == f"random {text}"


def test_a_planned_workspace_prints_its_pipeline():
    whole = plan(JOB)
    assert repr(whole) == f"workspace: {whole.pipeline}"


# entrances


@pytest.mark.parametrize("sampling", (ws.Sobol(3000, seed=3), ws.Random(3000), ws.BoundaryBiased(3000), ws.Grid(4)))
def test_all_entrances_agree(sampling, precision):
    """Drawn configurations, rows and positions there, positions of the samples, and a sweep that counts them."""
    robot = ws.load_robot("ur5e", placement=ws.Transform(position_m=(0.3, -0.2, 0.5), rpy_deg=(0, 10, 40)))
    names = ("manipulability", "isotropy")
    pipeline = Pipeline(
        Evaluation(robot.chain, names, (0, 1, 2)),
        plan_sampling(robot.chain, sampling),
        (ABOVE,),
        LatticeBlock(0.1, (-20, -20, -20), (40, 40, 40)),
        frozenset({"maximum", "mean"}),
        bounds=(1.0, 1.01),
        precision=precision,
    )
    q = configurations(pipeline)
    at = evaluate_samples(pipeline.at(q))
    near = 1e-12 if precision == "float64" else 2e-6
    np.testing.assert_allclose(at.position, evaluate_poses(robot.chain, q, device="cpu")[:, :3, 3], atol=near)
    np.testing.assert_allclose(sampled_positions(pipeline), at.position, atol=near)
    swept = sweep(pipeline, 0, pipeline.sampling.count, devices_of("cpu"))
    admitted = at.rejected == 0
    assert 0 < admitted.sum() < len(q)
    assert abs(swept.admitted - admitted.sum()) <= (0 if precision == "float64" else 2)
    high = np.concatenate([at.position[admitted].max(axis=0), at.values[:, admitted].max(axis=1)])
    np.testing.assert_allclose(swept.maximum[:5], high, atol=100 * near)
    np.testing.assert_allclose(
        swept.totals / scales_of(pipeline), at.values[:, admitted].sum(axis=1), rtol=1e-3 if near > 1e-9 else 1e-9
    )


def test_rows_keep_what_they_are_asked_for(precision):
    chain = ws.load_robot("ur5e").chain
    kept = frozenset({"configuration", "orientation"})
    evaluation = Evaluation(chain, ("manipulability",), (0, 1, 2))
    pipeline = Pipeline(evaluation, plan_sampling(chain, ws.Sobol(700)), (ABOVE,), kept_rows=kept, precision=precision)
    rows, q = evaluate_samples(pipeline), configurations(pipeline)
    np.testing.assert_array_equal(rows.q, q)
    turned = Rotation.from_quat(rows.quat_wxyz, scalar_first=True).as_matrix()
    np.testing.assert_allclose(turned, chain.poses(q)[:, :3, :3], atol=1e-12 if precision == "float64" else 1e-5)
    assert evaluate_samples(pipeline.at(q)).q is None and rows.rejected.any()


def test_a_range_of_samples_is_drawn_alone():
    pipeline = tip_pipeline(ws.load_robot("scara").chain, ws.Sobol(500, seed=1))
    whole, some = configurations(pipeline), np.array([400, 3, 3])
    assert whole.shape == (500, 4) and (configurations(pipeline, some) == whole[some]).all()


@pytest.mark.parametrize("precision, largest", [("float32", 30), ("float64", 50)])
def test_scales_are_the_largest_powers_of_two_that_bounds_and_samples_allow(precision, largest):
    chain = ws.load_robot("scara").chain
    bounds = (1.0, 0.75, 3.0, 4.0, np.nextafter(4.0, 5), np.nextafter(4.0, 3), 1e-9, 1e9)
    for count in (1, 1000, 2**32, 2**40):
        pipeline = replace(tip_pipeline(chain, ws.Random(count)), bounds=bounds, precision=precision)
        bits = min(largest, 62 - (count - 1).bit_length())
        scales = scales_of(pipeline)
        assert (scales * np.array(bounds) <= 2.0**bits).all() and (2 * scales * np.array(bounds) > 2.0**bits).all()
    assert (scales_of(replace(pipeline, bounds=None, evaluation=Evaluation(chain, ("isotropy",)))) == [0.0]).all()
