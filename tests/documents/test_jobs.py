"""Job documents: defaults, normal form, canonical text, schema."""

import json
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wsrender.analyses.indices_at.job import IndicesAtJob
from wsrender.analyses.jobs import canonical_json, job_schema, parse_job
from wsrender.analyses.registry import job_classes
from wsrender.analyses.workspace.job import WorkspaceJob
from wsrender.documents.sampling import METHODS, BoundaryBiased, Converge, Grid, Random, Sobol
from wsrender.errors import DocumentError, InputError

UR5E = {"analysis": "workspace", "robot": {"library": "ur5e"}}

DESIGN_EXAMPLE = """
{"analysis": "workspace",
 "robot": {"library": "phantom_omni"},
 "base": null, "tip": "tool",
 "sampling": {"method": "grid", "per_joint": 60, "locked": {"joint4": 0.0, "joint5": 1.5708, "joint6": 0.0}},
 "indices": ["manipulability", "inverse_condition_number"],
 "task": "linear", "convention": "standard", "joint_limit_penalty": null,
 "voxel_size_m": 0.005, "voxel_statistics": ["count", "maximum"], "refined_volume": null,
 "keep_map": false, "max_samples": 10000000000,
 "precision": "float32", "device": "auto"}
"""


def test_example_of_the_design():
    job = parse_job(DESIGN_EXAMPLE)
    assert isinstance(job, WorkspaceJob)
    assert job.robot.library == "phantom_omni"
    assert job.sampling == Grid(60, locked={"joint4": 0.0, "joint5": 1.5708, "joint6": 0.0})
    assert job.indices == ("manipulability", "inverse_condition_number")
    assert job.voxel_size_m == 0.005


def test_defaults():
    job = parse_job(UR5E)
    assert (job.base, job.tip, job.indices, job.task) == (None, None, "kinematic", "linear")
    assert (job.sampling, job.convention, job.joint_limit_penalty) == (Sobol(2**24), "standard", None)
    assert (job.torque_scaling, job.inertia, job.characteristic_length_m) == (False, "kernel", 1.0)
    assert (job.voxel_size_m, job.voxel_statistics, job.refined_volume) == (None, None, 0.01)
    assert job.voxel_labels is False
    assert (job.keep_map, job.map_columns, job.max_samples) == (False, (), 10**10)
    assert (job.precision, job.device) == ("float32", "auto")


def test_indices_at_defaults_to_double_precision():
    job = parse_job({"analysis": "indices_at", "robot": "ur5e", "configurations": [[0, 1, 2, 3, 4, 5]]})
    assert isinstance(job, IndicesAtJob)
    assert job.precision == "float64"
    assert job.configurations == ((0.0, 1.0, 2.0, 3.0, 4.0, 5.0),)


def test_a_string_names_a_library_robot():
    assert parse_job({**UR5E, "robot": "ur5e"}) == parse_job(UR5E)


@pytest.mark.parametrize(
    ("given_as", "kept_as"),
    [
        ({"task": ["z", "x", "y"]}, {"task": "linear"}),
        ({"task": ["rz", "ry", "rx", "z", "y", "x"]}, {"task": "full"}),
        ({"task": ["rz", "y", "x"]}, {"task": ("x", "y", "rz")}),
        ({"joint_limit_penalty": True}, {"joint_limit_penalty": 10.0}),
        ({"joint_limit_penalty": False}, {"joint_limit_penalty": None}),
        ({"joint_limit_penalty": 3}, {"joint_limit_penalty": 3.0}),
        ({"voxel_statistics": ["mean"]}, {"voxel_statistics": ("count", "mean")}),
        ({"voxel_statistics": []}, {"voxel_statistics": ("count",)}),
        ({"max_samples": 1e6}, {"max_samples": 1_000_000}),
        (
            {"map_columns": ["orientation", "configuration"], "keep_map": True},
            {"map_columns": ("configuration", "orientation")},
        ),
        ({"indices": ["yoshikawa"]}, {"indices": ("yoshikawa",)}),
        ({"device": "cuda:3"}, {"device": "cuda:3"}),
    ],
)
def test_normal_form(given_as, kept_as):
    job = parse_job({**UR5E, **given_as})
    assert {name: getattr(job, name) for name in kept_as} == kept_as


def test_sampling_is_positional_in_python():
    assert Grid(15, locked={"joint6": 0.0}).locked == {"joint6": 0.0}
    assert Grid([3, 4]).per_joint == Grid(np.array([3, 4])).per_joint == (3, 4)
    assert (Random(10**15, 2**63 - 1).count, Random(5, seed=7).seed) == (10**15, 7)
    assert Sobol(np.int64(100), seed=1) == Sobol(count=100, seed=1)
    assert BoundaryBiased(1e6, locked={"a": np.float32(0.5)}).locked == {"a": 0.5}
    assert Converge("isotropy", 1e-3, by="workspace_mean").index == "isotropy"


def test_samplings_of_python_enter_documents():
    job = parse_job({**UR5E, "sampling": Random(100, seed=3)})
    assert job == parse_job({**UR5E, "sampling": {"method": "random", "count": 100, "seed": 3}})


@pytest.mark.parametrize("build", [lambda: Grid(0), lambda: Sobol("9"), lambda: WorkspaceJob(robot=5)])  # type: ignore[arg-type]
def test_python_constructors_raise_input_errors(build):
    with pytest.raises(InputError):
        build()


def test_a_parsed_job_passes_through():
    job = parse_job(UR5E)
    assert parse_job(job) is job
    assert pickle.loads(pickle.dumps(job)) == job


def test_jobs_are_frozen():
    with pytest.raises(ValueError, match="frozen"):
        parse_job(UR5E).task = "full"


def test_canonical_text_holds_every_default_and_returns_the_job():
    job = parse_job(UR5E)
    text = canonical_json(job)
    assert set(json.loads(text)) == set(WorkspaceJob.model_fields) - {"gravity_m_s2", "best_sample"}  # said where given
    assert list(json.loads(text)) == sorted(json.loads(text))
    assert parse_job(text) == job


SAMPLINGS = st.one_of(
    st.builds(Grid, st.integers(1, 50) | st.lists(st.integers(1, 9), min_size=1, max_size=6)),
    st.builds(Random, st.integers(1, 10**15), st.integers(0, 2**63 - 1)),
    st.builds(Converge, st.sampled_from(["isotropy", "manipulability"]), st.floats(1e-9, 1.0)),
)
DOCUMENTS = st.fixed_dictionaries(
    {"analysis": st.just("workspace"), "robot": st.sampled_from(["ur5e", "scara"])},
    optional={
        "sampling": SAMPLINGS,
        "task": st.lists(st.sampled_from(["x", "y", "z", "rx", "ry", "rz"]), min_size=1, unique=True),
        "voxel_size_m": st.none() | st.floats(1e-4, 1.0),
        "joint_limit_penalty": st.sampled_from([None, True, 10, 0.5]),
        "voxel_statistics": st.lists(st.sampled_from(["count", "mean", "minimum"]), unique=True),
        "characteristic_length_m": st.sampled_from([1, 1.0, 0.25]),
    },
)


@settings(derandomize=True, deadline=None)
@given(DOCUMENTS, DOCUMENTS)
def test_equal_jobs_and_only_they_have_equal_text(first, second):
    a, b = parse_job(first), parse_job(second)
    assert (a == b) == (canonical_json(a) == canonical_json(b))
    assert parse_job(canonical_json(a)) == a


def test_negative_zero_is_zero():
    documents = [{**UR5E, "sampling": {"method": "grid", "locked": {"j": zero}}} for zero in (0.0, -0.0, 0)]
    assert len({canonical_json(parse_job(document)) for document in documents}) == 1


def _properties(schema):
    models = [schema, *schema.get("$defs", {}).values()]
    return [(model.get("title"), name, p) for model in models for name, p in model.get("properties", {}).items()]


def test_schema_describes_every_field_and_shows_every_default():
    for title, name, field in _properties(job_schema()):
        assert field.get("description"), f"{title}.{name} has no description"
    fields = job_schema("workspace")["properties"]
    assert {name for name, field in fields.items() if "default" not in field} == {"robot"}
    assert fields["sampling"]["default"] == {"method": "sobol", "count": 2**24, "seed": 0, "locked": {}}


def test_fewer_samples_by_default_where_rows_are_kept_or_robots_are_several():
    assert parse_job({**UR5E, "keep_map": True}).sampling == Sobol(2**20)
    assert parse_job({**UR5E, "keep_map": True, "sampling": {"method": "grid"}}).sampling == Grid(15)
    shared = parse_job({"analysis": "shared_workspace", "robots": [{"robot": "ur5e"}, {"robot": "ur5e"}]})
    assert [arm.sampling for arm in shared.robots] == [Sobol(2**20)] * 2


def test_schema_covers_the_union_and_each_analysis():
    union = job_schema()
    assert set(union["discriminator"]["mapping"]) == set(job_classes())
    assert {"workspace", "indices_at", "shared_workspace"} < set(job_classes())
    assert METHODS == ("grid", "random", "sobol", "boundary", "converge")
    assert job_schema("indices_at")["title"] == "IndicesAtJob"
    with pytest.raises(InputError, match=r'must be one of "workspace", .*, not "nope"'):
        job_schema("nope")


def test_every_problem_is_listed():
    with pytest.raises(DocumentError) as caught:
        parse_job({"analysis": "workspace", "tipp": 1, "task": [], "sampling": {"method": "random", "seed": -1}})
    assert [field for field, _ in caught.value.problems] == [
        "robot", "task", "sampling.count", "sampling.seed", "tipp",
    ]  # fmt: skip
