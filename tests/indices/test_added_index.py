"""An index that is added in one place works wherever the catalogue's do; its bound, options and structures count."""

import numpy as np
import pytest

import wsrender as ws
from tests.indices.added import ANISOTROPY, WEIGHTED, register, twins
from tests.reference import local_indices
from tests.reference.voxel_accumulation import accumulated
from tests.run.simple_robots import PlanarClass, planar_arm
from wsrender import run
from wsrender.analyses.jobs import parse_job
from wsrender.engine import SweepPlan
from wsrender.engine.sums import scales_of
from wsrender.errors import InputError, NumericalError
from wsrender.indices.index_catalogue import (
    DYNAMIC,
    KINEMATIC,
    catalogue,
    default_statistics,
    find,
    is_dynamic,
    resolve,
)
from wsrender.robot import as_robot
from wsrender.robot.indices import evaluation_of_job

pytestmark = pytest.mark.usefixtures("catalogue_as_shipped")
NAMES = ["anisotropy", "weighted"]
OPTIONS = {"weighted": {"weight": 2.0, "squared": True}}
PLANAR = {"task": ["x", "y"], "precision": "float64", "device": "cpu"}
VOXELS = {"voxel_size_m": 0.05, "refined_volume": None, "voxel_statistics": ["maximum", "mean"]}
MEAN = 2.0**-30  # of the bound: fixed-point sums


def planned(names, **fields):
    document = {"analysis": "workspace", "robot": {"library": "cylindrical"}, "voxel_size_m": 0.1, "indices": names}
    return run.plan(document | {"sampling": {"method": "grid", "per_joint": 3}, "device": "cpu", **fields})


def test_values_voxels_and_means_are_those_of_numpy():
    register(ANISOTROPY), register(WEIGHTED)
    arm = planar_arm()
    result = ws.analyze(
        arm, ws.Random(3000, seed=2), NAMES, index_options=OPTIONS, keep_map=True, map_columns=["configuration"],
        **VOXELS, **PLANAR,
    )  # fmt: skip
    J = arm.jacobian(result.map.configuration, device="cpu")[:, :2]
    expected = twins(J, weight=2.0, squared=True)
    cells = accumulated(result.map.position, [expected[name] for name in NAMES], 0.05)
    at = np.array(list(cells)) - result.volume.first_voxel
    for k, name in enumerate(NAMES):
        assert result.map.indices[name] == pytest.approx(expected[name], abs=1e-12)
        statistics = {kind: result.volume.statistics[kind][name][tuple(at.T)] for kind in ("maximum", "mean")}
        rows = [values[k] for values in cells.values()]
        assert statistics["maximum"] == pytest.approx(np.array([row.max() for row in rows]), abs=1e-12)
        assert statistics["mean"] == pytest.approx(np.array([row.mean() for row in rows]), abs=40 * MEAN)
        entry = result.document["indices"][name]
        assert entry["maximum"] == pytest.approx(expected[name].max(), abs=1e-12)
        assert entry["joint_mean"] == pytest.approx(expected[name].mean() / expected[name].max(), rel=1e-6)
    assert result.document["choices"]["index_options"] == OPTIONS
    assert result.document["job"]["index_options"] == OPTIONS
    assert [result.document["indices"][name]["unit"] for name in NAMES] == ["1", "m"]


def test_values_at_configurations_with_options_and_their_defaults():
    register(WEIGHTED)
    arm, q = planar_arm(), np.array([[0.1, 0.4], [2.0, 1.5]])
    J = arm.jacobian(q, device="cpu")[:, :2]
    for options in ({}, {"weight": 3}, {"squared": True}):
        found = ws.evaluate_indices(arm, q, ["weighted"], ["x", "y"], index_options={"weighted": options}, device="cpu")
        assert found["weighted"] == pytest.approx(twins(J, **options)["weighted"], abs=1e-12), options
    document = {"analysis": "indices_at", "robot": {"library": "scara"}, "configurations": [[0.1, 1.0, 0.3, 0.0]]}
    choices = ws.execute(document | {"indices": ["weighted"], "device": "cpu"}).document["choices"]
    assert choices["index_options"] == {"weighted": {"weight": 0.5, "squared": False}}


def test_indices_of_a_mechanism_take_options():
    register(WEIGHTED)
    options = {"indices": ["weighted", "minimum_singular_value"], "refined_volume": None, "voxel_size_m": 0.15}
    one, two = (
        ws.parallel_workspace("delta", index_options={"weighted": {"weight": weight}}, **options) for weight in (0, 1)
    )
    values = [result.volume.statistics["maximum"] for result in (one, two)]
    occupied = one.volume.count > 0
    difference = (values[1]["weighted"] - values[0]["weighted"])[occupied]
    assert occupied.any() and difference == pytest.approx(values[0]["minimum_singular_value"][occupied], rel=1e-12)
    assert two.document["indices"]["weighted"]["options"]["weight"] == 1.0


def test_groups_name_the_six_whatever_is_added():
    register(ANISOTROPY), register(WEIGHTED)
    assert set(NAMES) < set(catalogue())
    assert resolve("kinematic", True) == KINEMATIC == local_indices.NAMES
    assert resolve("dynamic", True) == DYNAMIC == tuple(f"dynamic_{name}" for name in local_indices.NAMES)
    assert resolve("all", True) == KINEMATIC + DYNAMIC
    assert planned("kinematic").pipeline.evaluation.indices == local_indices.NAMES


def test_every_index_of_the_catalogue_says_what_it_is():
    given = [index for index in catalogue().values() if index.given]
    assert [index.name for index in given] == ["clearance", "clearance_lower_bound"]
    assert all(not index.surviving(False) and index.unit == "m" for index in given)
    assert all({"minimum", "mean", "maximum"} < set(index.voxel_statistics) for index in given)
    joints = [index for index in catalogue().values() if index.of_chain]
    assert [index.name for index in joints] == [
        *("joint_limit_margin", "torque_margin", "payload_capacity", "velocity_radius"),
        *("force_radius", "acceleration_radius", "tip_compliance", "position_error"),
    ]
    assert all(index.unit and not index.surviving(False) and not index.has_dynamic_form for index in joints)
    for index in (each for each in catalogue().values() if each not in (*given, *joints)):
        assert index.symbol and index.source and index.unit and index.needs == ("sigma",), index.name
        assert index.bound is not None and index.surviving(False) == {"base_joint", "trailing_joints"}
        assert index.surviving(True) == {"base_joint"} and index.voxel_statistics == ("count", "maximum")


# bounds


@pytest.mark.parametrize("name", local_indices.NAMES)
def test_bounds_of_the_six_hold_and_are_reached(name):
    """Of three slides at right angles, whose singular values are 1, the bound is the value and its margin."""
    plan = run.plan({"analysis": "workspace", "robot": {"library": "ur5e"}, "indices": [name], "device": "cpu"})
    rng = np.random.default_rng(0)
    values = ws.evaluate_indices("ur5e", rng.uniform(-np.pi, np.pi, (2000, 6)), [name], device="cpu")[name]
    assert values.max() <= plan.pipeline.bounds[0]
    slides = planned([name], robot={"library": "cartesian"})
    (reached,) = ws.evaluate_indices("cartesian", np.full(6, 0.25), [name], device="cpu").values()
    assert slides.pipeline.bounds[0] == pytest.approx(1.01 * reached[0], rel=1e-12)


def test_a_bound_decides_the_scale_of_the_sums():
    register(ANISOTROPY), register(WEIGHTED)
    puma = {"robot": {"library": "puma560"}}
    plan = planned([*NAMES, "dynamic_anisotropy"], index_options={"weighted": {"weight": 3}}, **puma)
    bounds, scales = plan.pipeline.bounds, scales_of(plan.pipeline)
    first = planned(["weighted"], index_options={"weighted": {"weight": 0}}, **puma)
    assert bounds[0] == bounds[2] == pytest.approx(1.01)  # a number holds for the dynamic variant too
    assert bounds[1] == pytest.approx(4 * first.pipeline.bounds[0]) and scales[1] == scales_of(first.pipeline)[0] / 4


def test_a_bound_of_the_norm_is_asked_only_where_the_norm_is_known():
    asked = []
    register(WEIGHTED, bound=lambda norm, m, n, **options: asked.append((norm, m, n)) or 100.0)
    assert planned(["weighted"]).pipeline.bounds[0] == 101.0 and asked
    asked.clear()
    planned(["weighted"], convention="table_1"), planned(["dynamic_weighted"], robot={"library": "puma560"})
    assert asked == []


def test_without_a_bound_twice_the_maximum_of_the_first_pass():
    register(ANISOTROPY, bound=None)
    found = planned(["anisotropy"], robot={"library": "phantom_omni"}, sampling={"method": "sobol", "count": 2**16})
    result = run.execute(found.job.model_dump(mode="json") | {"refined_volume": None, "precision": "float64"})
    assert found.pipeline.bounds[0] == pytest.approx(2 * result.document["indices"]["anisotropy"]["maximum"], rel=1e-12)


@pytest.mark.parametrize("wrong", [0.5, lambda norm, m, n: 0.5])
def test_a_wrong_bound_fails_the_job_and_says_what_to_do(wrong):
    register(ANISOTROPY, bound=wrong)
    with pytest.raises(NumericalError, match=r"anisotropy reaches .* beyond 0.505, the bound of its entry .* or None"):
        ws.analyze(planar_arm(), ws.Grid(30), ["anisotropy"], **VOXELS, **PLANAR)


def test_a_bound_is_not_loosened():
    register(ANISOTROPY)
    options = {"task": ["x", "y"], "precision": "float64", "device": "cpu"}
    sampling = ws.Random(500, seed=1)
    result = ws.analyze(planar_arm(), sampling, ["anisotropy"], **VOXELS, **options)
    largest = result.document["indices"]["anisotropy"]["maximum"]
    register(ANISOTROPY, bound=largest / 1.009)
    assert ws.analyze(planar_arm(), sampling, ["anisotropy"], **VOXELS, **options).document["indices"]
    register(ANISOTROPY, bound=largest / 1.011)
    with pytest.raises(NumericalError, match="beyond"):
        ws.analyze(planar_arm(), sampling, ["anisotropy"], **VOXELS, **options)


def test_values_beyond_the_first_pass_are_told_apart_from_a_wrong_bound():
    """Where the index has no bound, the entry's is not blamed."""
    register(ANISOTROPY, function=lambda s, m, n: 1.0 / (s[-1] + 1e-12), bound=None)  # a spike at the arm's end
    with pytest.raises(
        NumericalError, match=r"what its values over the first pass allow: .* register the index with a"
    ):
        ws.analyze(planar_arm(), ws.Grid(30), ["anisotropy"], **VOXELS, **PLANAR)


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), -1.0])
def test_a_bound_that_is_none_is_refused(bad):
    register(ANISOTROPY, bound=lambda norm, m, n: bad)
    with pytest.raises(InputError, match="indices: the bound of anisotropy is"):
        planned(["anisotropy"])
    with pytest.raises(InputError, match="bound: of anisotropy must be greater than 0 and finite"):
        register(ANISOTROPY, bound=bad)


# needs, structure, statistics


def test_the_structure_of_a_grid_that_an_index_survives():
    found = {}
    for survives in (None, frozenset({"base_joint"}), frozenset()):
        register(ANISOTROPY, survives=survives)
        plan = SweepPlan(planned(["anisotropy"]).pipeline)
        found[survives] = (plan.structure.base_levels, plan.structure.weight, plan.sampling_path)
    assert list(found.values()) == [(3, 27, "collapsed"), (3, 1, "collapsed"), (1, 1, "direct")]
    assert SweepPlan(planned(["anisotropy", "manipulability"]).pipeline).sampling_path == "direct"  # one is enough


def test_maxima_are_the_same_whatever_survives():
    volumes = []
    for survives in (None, frozenset()):
        register(ANISOTROPY, survives=survives)
        plan = planned(["anisotropy"], precision="float64", refined_volume=None)
        volumes.append(run.execute(plan.job.model_dump(mode="json")).volume.statistics["maximum"]["anisotropy"])
    assert np.nanmax(np.abs(volumes[0] - volumes[1])) < 1e-13


def test_an_index_of_the_accelerations_alone():
    register(ANISOTROPY, needs=("dynamic_sigma",))
    assert is_dynamic("anisotropy") and find("anisotropy").surviving(True) == {"base_joint"}
    with pytest.raises(InputError, match="anisotropy needs link inertias"):
        resolve(["anisotropy"], has_inertia=False)
    with pytest.raises(InputError, match="'anisotropy' is of the accelerations already"):
        find("dynamic_anisotropy")
    q = np.array([[0.1, -1.0, 1.2, 0.3, 0.7, 0.2]])
    own = ws.evaluate_indices("ur5e", q, ["anisotropy"], device="cpu")["anisotropy"]
    register(ANISOTROPY)
    both = ws.evaluate_indices("ur5e", q, ["anisotropy", "dynamic_anisotropy"], device="cpu")
    assert own == pytest.approx(both["dynamic_anisotropy"], rel=1e-12) and own != pytest.approx(both["anisotropy"])


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"needs": ("gravity",)},
            "needs: anisotropy needs gravity, which the engine does not supply; it does sigma or",
        ),
        ({"needs": ("sigma", "clearance")}, "needs: anisotropy needs clearance, which"),
        (
            {"needs": ("speed",)},
            "needs: 'speed' is not allowed; sigma, dynamic_sigma, configuration, frames, jacobian,",
        ),
        ({"needs": ()}, "needs: anisotropy must need one of sigma, dynamic_sigma, not 0"),
        ({"needs": ("sigma", "dynamic_sigma")}, "needs: anisotropy must need one of .* not 2"),
        ({"bound": "large"}, "bound: of anisotropy must be a number, a function or None, not 'large'"),
        ({"bound": True}, "bound: of anisotropy must be a number"),
        ({"bound": 0}, "bound: of anisotropy must be greater than 0"),
        ({"survives": frozenset({"all"})}, "survives: 'all' is not allowed; base_joint, trailing_joints are"),
        ({"voxel_statistics": ("median",)}, "voxel_statistics: 'median' is not allowed; count, maximum, mean, minimum"),
        ({"options": (ws.Option("a", 1.0), ws.Option("a", 2.0))}, "options: anisotropy has two of one name: a, a"),
        ({"options": (ws.Option("a", 1.0),)}, "function: anisotropy cannot be compiled"),
    ],
)
def test_entries_that_cannot_be_used(changes, message):
    with pytest.raises(InputError, match=message):
        register(ANISOTROPY, **changes)
    assert "anisotropy" not in catalogue()


def test_the_voxel_statistics_of_an_index_are_kept_by_default():
    register(ANISOTROPY, voxel_statistics=("minimum", "mean"))
    assert default_statistics(["manipulability"]) == ("count", "maximum")
    assert default_statistics(["anisotropy", "manipulability"]) == ("count", "maximum", "mean", "minimum")
    result = ws.analyze(planar_arm(), ws.Random(500), ["anisotropy"], voxel_size_m=0.1, refined_volume=None, **PLANAR)
    assert set(result.volume.statistics) == {"mean", "minimum"}
    assert result.document["job"]["voxel_statistics"] == ["count", "mean", "minimum"]  # as they were settled
    asked = ws.analyze(planar_arm(), ws.Random(500), ["anisotropy"], **VOXELS, **PLANAR)
    assert set(asked.volume.statistics) == {"maximum", "mean"}


# options


@pytest.mark.parametrize(
    ("options", "field", "message"),
    [
        ({"weighted": {"weight": 5}}, "index_options.weighted.weight", "must be 0 … 4, not 5"),
        ({"weighted": {"weight": True}}, "index_options.weighted.weight", "must be a number, not true"),
        ({"weighted": {"weight": [1.0]}}, "index_options.weighted.weight", r"must be a number, not \[1.0\]"),
        ({"weighted": {"squared": 1}}, "index_options.weighted.squared", "must be true or false, not 1"),
        ({"weighted": {"wait": 1}}, "index_options.weighted.wait", "is not an option .* allowed: weight, squared"),
        ({"manipulability": {"a": 1}}, "index_options.manipulability.a", "is not an option .* it has none"),
        ({"isotropy": {}}, "index_options.isotropy", "is not among the job's indices: weighted, manipulability"),
        ({"wighted": {}}, "index_options.wighted", "unknown index 'wighted' .did you mean 'weighted'"),
        ({"yoshikawa": {}, "manipulability": {}}, "index_options.manipulability", "gives options of .* twice"),
    ],
)
def test_options_that_are_not_allowed(options, field, message):
    register(WEIGHTED)
    with pytest.raises(InputError, match=message) as caught:
        planned(["weighted", "yoshikawa"], index_options=options)
    assert caught.value.field == field


@pytest.mark.parametrize(
    ("options", "field", "message"),
    [
        ([], "index_options", r"must be an object, not \[\]"),
        ({"weighted": 3}, "index_options.weighted", "must be an object, not 3"),
        ({"weighted": {"weight": "3"}}, "index_options.weighted.weight", "must be a number, true, false or a list"),
        ({"weighted": {"weight": None}}, "index_options.weighted.weight", "must be a number, true, false or a list"),
        ({"weighted": {"weight": float("nan")}}, "index_options.weighted.weight", "must be a number, true, false or"),
    ],
)
def test_options_that_are_malformed(options, field, message):
    with pytest.raises(InputError, match=message) as caught:
        parse_job({"analysis": "workspace", "robot": "ur5e", "index_options": options})
    assert [path for path, _ in caught.value.problems] == [field]


@pytest.mark.parametrize(
    ("kind", "more", "given", "kept"),
    [
        ("integer", {"default": 1}, 3, 3),
        ("integer", {"default": 1}, 3.0, 3),
        ("numbers", {"default": (0.0, 0.0, 0.0), "length": 3}, [0, 0.5, 1], (0.0, 0.5, 1.0)),
        ("numbers", {"default": ()}, [1], (1.0,)),
        ("integer", {"default": 1}, 2.5, "must be a whole number, not 2.5"),
        ("numbers", {"default": (0.0,), "length": 1}, [1, 2], r"must have 1 numbers, not \[1, 2\]"),
        ("numbers", {"default": (0.0,), "range": (0.0, np.inf), "unit": "kg"}, [-1], "must be at least 0 kg"),
        ("number", {"default": 0.0, "range": (-np.inf, 1.0)}, 2, "must be at most 1, not 2"),
    ],
)
def test_kinds_of_options(kind, more, given, kept):
    option = ws.Option("x", kind=kind, **more)
    if isinstance(kept, str):
        with pytest.raises(ValueError, match=kept):
            option.value(given)
    else:
        assert option.value(given) == kept and type(option.value(given)) is type(kept)


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"default": 5.0, "range": (0.0, 4.0)}, "options: the default of x must be 0 … 4, not 5.0"),
        (
            {"default": 1.0, "kind": "text"},
            "options: 'text' of x is not allowed; number, integer, boolean, numbers are",
        ),
        ({"name": "two words", "default": 1.0}, "options: 'two words' is not allowed; an identifier is"),
    ],
)
def test_options_that_cannot_be_declared(fields, message):
    with pytest.raises(InputError, match=message):
        ws.Option(**{"name": "x", **fields})


def test_options_of_a_robot_of_ones_own_and_of_several_robots():
    register(WEIGHTED)
    job = parse_job({"analysis": "workspace", "robot": "ur5e", "indices": ["weighted"], "index_options": OPTIONS})
    assert evaluation_of_job(job, as_robot(PlanarClass())).options == OPTIONS
    document = {"analysis": "robot_comparison", "robots": [{"robot": "scara"}, {"robot": "scara", "name": "two"}]}
    fields = {"indices": ["weighted"], "index_options": {"weighted": {"weight": 9}}, "device": "cpu"}
    with pytest.raises(InputError, match=r"index_options.weighted.weight: must be 0 … 4"):
        run.plan(document | fields)
    assert job.model_dump(mode="json")["index_options"] == OPTIONS
