"""Indices of users of q, J, M, g, limits and frames: device code against MuJoCo and the host, wherever indices go."""

import numpy as np
import pytest

import wsrender as ws
from tests.indices.test_chain_indices import Case
from wsrender.errors import InputError, MissingInertiaError
from wsrender.indices.index_catalogue import find
from wsrender.pipeline.constraints import registry
from wsrender.run import plan

pytestmark = pytest.mark.usefixtures("catalogue_as_shipped")
GRAVITY = (1.0, 2.0, -9.0)


def everything(q, J, M, g, limits, frames, position, axes, weight):
    """Of all that there is something that no symmetry hides."""
    first = q[1] * limits.upper[2] + J[0][1] * J[4][2] + weight * M[1][2] - g[1] / limits.effort[1]
    return first + frames[2].position[2] * frames[1].axes[0][1] + position[0] * axes[1][2] - limits.lower[0]


def without_frames(q, J, M, g, limits, position, axes, weight):
    """Of an arm with joints that follow one on another branch, of which a function takes no frames."""
    first = q[1] * limits.upper[2] + J[0][1] * J[4][2] + weight * M[1][2] - g[1] / limits.effort[1]
    return first + position[0] * axes[1][2] - limits.lower[0]


def added(name="mine", function=everything, **fields):
    return ws.register_index(name, function, unit="1", **fields)


@pytest.mark.parametrize("name", ["ur5e", "franka_panda", "arm"])
def test_values_are_those_of_mujoco(name, precision, device):
    """J, M and g are MuJoCo's, frames and poses those of the host; on a tilted base, in another gravity."""
    case = Case(name)
    added(function=without_frames if name == "arm" else everything, options=[ws.Option("weight", 2.0)])
    q, chain, R = case.configurations(100), case.robot.chain, case.axes
    frames, T = chain.frames(q), case.robot.forward_kinematics(q, device="cpu")
    J = case.robot.jacobian(q, device="cpu")
    for weight in (2.0, -0.5):
        expected = []
        for k, row in enumerate(q):
            base, _, M, g = case.at_rest(row)
            assert J[k, :3] == pytest.approx(R @ base, abs=1e-9)
            value = row[1] * chain.upper_limits[2] + (R @ base)[0, 1] * J[k, 4, 2] + weight * M[1, 2]
            value += T[k, 0, 3] * T[k, 2, 1] - chain.lower_limits[0]
            value += 0.0 if name == "arm" else frames[k, 2, 2, 3] * frames[k, 1, 1, 0]
            expected.append(value - g[1] / case.robot.chain.effort_limits[1])
        found = case.values(q, "mine", precision, device, weight=weight)
        tolerance = 1e-9 if precision == "float64" else 3e-5
        np.testing.assert_allclose(found, expected, atol=tolerance * np.abs(expected).max())


def test_what_it_needs_is_what_it_takes():
    takes = {
        "a": (lambda q: q[0], {"configuration"}),
        "b": (lambda J, limits: J[0][0] * limits.lower[0], {"jacobian", "limits"}),
        "c": (lambda g, M, q: g[0] + M[0][0] * q[0], {"gravity", "inertia", "configuration"}),
        "d": (lambda frames: frames[0].position[2], {"frames"}),
        "e": (lambda sigma, m, n: sigma[0], {"sigma"}),
        "f": (lambda s, m, n: s[0], {"sigma"}),
    }
    for name, (function, needs) in takes.items():
        assert set(added(name, function).needs) == needs
        assert find(name).of_chain == (needs != {"sigma"}) == (not find(name).has_dynamic_form)
    with pytest.raises(InputError, match="unknown index 'dynamic_a'"):
        find("dynamic_a")


def test_kinematic_jobs_are_what_they_were():
    """An index of the chain beside others changes no bit of theirs, and none is computed that is not asked for."""
    added("spin", lambda q, J: q[0] + J[0][0])
    q = ws.load_robot("ur5e").lower_limits * np.linspace(-0.9, 0.9, 10)[:, None]
    six = ws.evaluate_indices("ur5e", q, "kinematic", device="cpu")
    more = ws.evaluate_indices("ur5e", q, [*six, "spin"], device="cpu")
    for name, values in six.items():
        assert np.array_equal(values, more[name]), name
    assert more["spin"] == pytest.approx(q[:, 0] + ws.load_robot("ur5e").jacobian(q, device="cpu")[:, 0, 0])
    job = {"analysis": "indices_at", "robot": "ur5e", "configurations": q.tolist(), "device": "cpu"}
    assert not plan(job).pipeline.evaluation.of_chain


def test_voxels_means_and_options_of_a_map():
    added("load", lambda g, limits, scale: ws.math.sqrt(g[1] * g[1]) / limits.effort[1] * scale,
          range=(0, np.inf), options=[ws.Option("scale", 1.0, range=(0, 10))],
          voxel_statistics=("count", "maximum", "mean"))  # fmt: skip
    result = ws.analyze(
        "ur5e", ws.Sobol(4000), indices=["load"], index_options={"load": {"scale": 3}}, gravity_m_s2=GRAVITY,
        keep_map=True, map_columns=["configuration"], voxel_size_m=0.2, refined_volume=None, precision="float64",
        device="cpu",
    )  # fmt: skip
    case = ws.load_robot("ur5e")
    q, values = result.map.configuration, result.map.indices["load"]
    expected = ws.evaluate_indices(
        case, q, ["load"], index_options={"load": {"scale": 3}}, gravity_m_s2=GRAVITY, device="cpu"
    )
    assert values == pytest.approx(expected["load"], rel=1e-9) and values.min() >= 0
    entry = result.document["indices"]["load"]
    assert (entry["maximum"], entry["minimum"]) == (pytest.approx(values.max()), pytest.approx(values.min()))
    statistics = result.volume.statistics
    assert np.nanmax(statistics["maximum"]["load"]) == pytest.approx(values.max())
    assert entry["mean"] == pytest.approx(values.mean(), rel=1e-6)


def test_it_knows_no_symmetry_of_a_grid():
    """The first joint's value changes it, so that no level of it stands for another."""
    added("first", lambda q: q[0])
    grid = ws.Grid(per_joint=4)
    result = ws.analyze("ur5e", grid, indices=["first"], voxel_size_m=0.3, refined_volume=None, device="cpu")
    limit = ws.load_robot("ur5e").upper_limits[0]
    entry = result.document["indices"]["first"]
    assert (entry["minimum"], entry["maximum"]) == (pytest.approx(-limit), pytest.approx(limit))


def test_positions_of_a_far_base_keep_their_digits():
    added("height", lambda position: position[0] - 5e5)
    near, far = (ws.load_robot("scara", placement=ws.Transform(position_m=(x, 0, 0))) for x in (0, 5e5))
    q = np.random.default_rng(0).uniform(near.lower_limits, near.upper_limits, (20, 4))
    found = ws.evaluate_indices(far, q, ["height"], precision="float32", device="cpu")["height"]
    assert found == pytest.approx(near.forward_kinematics(q, device="cpu")[:, 0, 3], abs=1e-6)


@pytest.mark.parametrize(
    ("function", "fields", "message"),
    [
        (lambda q, speed: q[0], {}, "function: mine .*takes speed, which is no option of it; a function of q"),
        (lambda q: np.sin(q[0]), {}, "function: mine cannot be compiled"),
        (lambda q: q[0] if q[0] > 0 else 0, {}, "function: mine cannot be compiled: .*branch"),
        (lambda q, o: q[0], {"options": [ws.Option("o", True, kind="boolean")]}, "o of mine is of kind boolean"),
        (lambda q, o: q[0], {"options": [ws.Option("o", (1,), kind="numbers")]}, "o of mine is of kind numbers"),
        (lambda sigma, m, n: sigma[0], {"needs": ("gravity",)}, "needs gravity, which the engine does not supply"),
    ],
)  # fmt: skip
def test_wrong_functions(function, fields, message):
    with pytest.raises(InputError, match=message):
        added(function=function, **fields)


def test_what_a_robot_lacks_is_named():
    added("tenth", lambda q: q[9])
    added("heavy", lambda M: M[0][0])
    with pytest.raises(InputError, match="indices: tenth takes a joint that ur5e, with 6, does not have"):
        ws.evaluate_indices("ur5e", [0] * 6, ["tenth"])
    bare = ws.load_robot(ws.DHTable(convention="standard", rows=[{"a": 0.4}]))
    added("elbow", lambda frames: frames[1].position[2])
    with pytest.raises(InputError, match=r"elbow takes frames, and joints of .* follow a joint on another branch"):
        ws.evaluate_indices(Case("arm").robot, [0, 0, 0], ["elbow"])
    with pytest.raises(MissingInertiaError, match="heavy needs link inertias"):
        ws.evaluate_indices(bare, [0.1], ["heavy"])
    job = {"analysis": "parallel_workspace", "mechanism": "stewart_gough", "indices": ["heavy"], "voxel_size_m": 0.1}
    with pytest.raises(InputError, match="indices of joints and what they hold: they are those of a serial arm"):
        ws.execute(job | {"device": "cpu"})


def test_constraints_take_the_inertia_too(monkeypatch):
    monkeypatch.setattr(registry, "_ADDED", {})  # what the test adds is forgotten
    ws.register_constraint("light", lambda q, position, axes, M, most=1.0: most - M[0][0])
    q = np.random.default_rng(1).uniform(-2, 2, (200, 6))
    M = ws.load_robot("ur5e").mujoco_inertia(q)[:, 0, 0]
    most = float(np.median(M))
    job = {"analysis": "indices_at", "robot": "ur5e", "configurations": q.tolist(), "device": "cpu"}
    found = ws.execute(job | {"constraints": {"light": {"most": most}}}).tables["admission"]["reason"]
    clear = np.abs(M - most) > 1e-6
    assert np.array_equal((found == "")[clear], (most >= M)[clear])
