"""Indices of the whole chain against MuJoCo's bias forces, inertia matrices and Jacobians, and enumerated polytopes."""

from itertools import combinations, product

import mujoco
import numpy as np
import pytest
from scipy.optimize import linprog
from scipy.spatial import ConvexHull

import wsrender as ws
from tests.golden.facts import bits_of
from tests.pipeline.test_torque import ARM, PLACED, Bare, text_of
from tests.reference import mujoco_kinematics as by_mujoco
from wsrender.errors import InputError
from wsrender.robot.gravity import GRAVITY

WALL, CEILING = ws.Transform(rpy_deg=(0, 90, 0)), ws.Transform(rpy_deg=(180, 0, 30))
SLOPES = (("c", "lead", 1.5, 0.2), ("d", "lead", -2.0, 0.0))
SPEEDS = {
    "ur5e": [3.1, 3.0, 2.9, 3.2, 3.3, 3.4],
    "franka_panda": [2.2, 2.1, 2.3, 2.0, 2.6, 2.7, 2.5],
    "arm": [1, 0.3, 2],
}


class Case:
    """A robot with speeds, as MuJoCo alone knows it with a payload at ``at`` in the tip's frame."""

    def __init__(self, name, placement=PLACED, at=(0.03, 0.02, 0.1), payload=0.0, gravity=(1.0, 2.0, -9.0)):
        source, slopes = (ARM, SLOPES) if name == "arm" else (name, ())
        plain = ws.load_robot(source)
        speeds = dict(zip(plain.joint_names, SPEEDS[name], strict=True))
        self.robot = ws.load_robot(source, placement=placement, velocity_limits=speeds)
        self.efforts, self.at, self.gravity = self.robot.chain.efforts, np.array(at), gravity
        text = ARM if name == "arm" else text_of(name)
        self.bare = Bare(text, list(plain.joint_names), plain.tip_frame, payload or 1.0, self.at, slopes)
        self.axes = placement.matrix()[:3, :3]
        self.load = self.bare.model.body("payload").id
        self.carry(payload)

    def carry(self, payload):
        """Another mass at the same place."""
        self.bare.model.body_mass[self.load] = payload
        self.bare.model.body_inertia[self.load] = 0.0

    def configurations(self, count, seed=0):
        chain = self.robot.chain
        return np.random.default_rng(seed).uniform(chain.lower_limits, chain.upper_limits, (count, chain.n))

    def at_rest(self, row):
        """J (3, n) of the tip and of the load in base axes, M (n, n), g (n,)."""
        bare, model = self.bare, self.bare.model
        model.opt.gravity = self.axes.T @ self.gravity
        data, full = mujoco.MjData(model), bare.C @ row
        for follower, offset in bare.offsets.items():
            full[model.joint(follower).dofadr[0]] += offset
        data.qpos[:] = full
        mujoco.mj_fwdPosition(model, data)
        mujoco.mj_fwdVelocity(model, data)
        names = [model.joint(k).name for k in range(model.njnt)]
        M = bare.C.T @ by_mujoco.inertia_matrix(model, data, names) @ bare.C
        J, of_load = by_mujoco.jacobian(model, data, bare.tip, names)[:3] @ bare.C, np.zeros((3, model.nv))
        mujoco.mj_jacBodyCom(model, data, of_load, None, self.load)
        return J, of_load @ bare.C, M, bare.C.T @ data.qfrc_bias

    def values(self, q, name, precision, device, task="linear", **options):
        return self.all_values(q, {name: options}, precision, device, task)[name]

    def all_values(self, q, indices, precision, device, task="linear"):
        asked = {"indices": [*indices], "task": task, "gravity_m_s2": self.gravity}
        asked |= {"index_options": {name: options for name, options in indices.items() if options}}
        return ws.evaluate_indices(self.robot, q, **asked, precision=precision, device=device)


def corners(A, most, shift):
    """All images (2^n, m) of the corners of a box."""
    return shift + np.array(list(product(*([-1, 1],) * A.shape[1]))) * most @ A.T


def ball(A, most, shift):
    """Radius of the largest ball about 0 in the polytope, by the facets that its columns span and its corners alone."""
    points, rows = corners(A, most, shift), len(A)
    if np.linalg.matrix_rank(A) < rows:
        return 0.0
    normals = (
        [np.linalg.svd(A[:, list(k)].T)[2][-1] for k in combinations(range(A.shape[1]), rows - 1)]
        if rows > 1
        else [[1]]
    )
    along = points @ np.array(normals).T
    return max(min(along.max(axis=0).min(), -along.min(axis=0).max()), 0.0)


def close(found, expected, precision):
    """Equal to 1e-9, or to what single precision holds of the largest."""
    expected = np.array(expected)
    tolerance = 1e-9 if precision == "float64" else 2e-5
    np.testing.assert_allclose(found, expected, rtol=tolerance, atol=tolerance * np.abs(expected).max())


ROWS = {"linear": [0, 1, 2], "full": [0, 1, 2], ("x", "z"): [0, 2], ("y",): [1]}
CASES = [
    ("ur5e", "linear"),
    ("franka_panda", "full"),
    ("arm", "linear"),
    ("ur5e", ("x", "z")),
    ("franka_panda", ("y",)),
]


@pytest.mark.parametrize(("name", "task"), CASES)
def test_velocities_and_accelerations_are_those_of_enumerated_polytopes(name, task, precision, device):
    """The third opinion is Qhull's, of whole polytopes; it has six digits."""
    case, rows = Case(name), ROWS[task]
    q = case.configurations(1_000 if precision == "float64" else 200)
    speeds, (back, forth) = case.robot.chain.velocity_limits, np.abs(case.efforts)
    velocity, acceleration = [], []
    for row in q:
        J, _, M, g = case.at_rest(row)
        A = J[rows] @ np.linalg.inv(M)
        velocity.append((J[rows], speeds, np.zeros(len(rows))))
        acceleration.append((A, (back + forth) / 2, A @ ((forth - back) / 2 - g)))
    values = case.all_values(q, {"velocity_radius": {}, "acceleration_radius": {}}, precision, device, task)
    for found, polytopes in zip(values.values(), (velocity, acceleration), strict=True):
        close(found, [ball(*each) for each in polytopes], precision)
        if len(rows) == 3 and precision == "float64":
            hulls = [ConvexHull(corners(*each)).equations[:, -1] for each in polytopes[:50]]
            np.testing.assert_allclose(found[:50], [max(-offsets.max(), 0) for offsets in hulls], rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize("placement", [PLACED, WALL, CEILING], ids=["tilted", "wall", "ceiling"])
@pytest.mark.parametrize("name", ["ur5e", "arm"])
def test_payloads_are_held_to_the_last_gram(name, placement, precision, device):
    """What is told is held, and a millionth more is not: by MuJoCo's bias forces with that mass welded on."""
    case = Case(name, placement, gravity=(2.0, -3.0, -15.0) if name == "arm" and placement is PLACED else GRAVITY)
    q = case.configurations(200)
    found = case.values(q, "payload_capacity", precision, device, com_m=case.at, limit_kg=60)
    near, ended = (1e-9 if precision == "float64" else 1e-4), set()
    (back, forth), tell = np.abs(case.efforts), lambda g: np.minimum(back + g, forth - g).min()
    for row, mass in zip(q, found, strict=True):
        case.carry(mass)
        slack = tell(case.at_rest(row)[3])
        case.carry(0.0)
        ended.add("cut" if mass == 60 else "none" if mass == 0 else "some")
        expected = {60: slack > -near, 0: tell(case.at_rest(row)[3]) < near}
        assert expected.get(mass, abs(slack) < near * max(back.max(), forth.max())), (mass, slack)
    assert ended >= ({"some", "cut"} if name == "ur5e" else {"some"} if placement is not PLACED else {"some", "none"})


@pytest.mark.parametrize(("name", "task", "acceleration"), [("ur5e", "linear", 40.0), ("arm", "linear", 0.5)])
def test_payloads_that_accelerate_leave_the_ball_of_accelerations(name, task, acceleration, precision, device):
    """The ball of the laden arm, by corners, has the asked radius; the unladen arm's less where nothing is carried."""
    case, rows = Case(name), ROWS[task]
    q = case.configurations(200)
    (back, forth), found = np.abs(case.efforts), []
    options = {"com_m": case.at, "acceleration_m_s2": acceleration, "limit_kg": 25}
    masses = case.values(q, "payload_capacity", precision, device, task, **options)
    for row, mass in zip(q, masses, strict=True):
        case.carry(mass)
        _, J, M, g = case.at_rest(row)
        A = J[rows] @ np.linalg.inv(M)
        found.append(ball(A, (back + forth) / 2, A @ ((forth - back) / 2 - g)))
    tolerance, found = acceleration * (1e-7 if precision == "float64" else 1e-3), np.array(found)
    assert (found[masses == 0] < acceleration + tolerance).all()
    assert (found[masses == 25] > acceleration - tolerance).all()
    between = (masses > 0) & (masses < 25)
    np.testing.assert_allclose(found[between], acceleration, atol=tolerance)
    assert between.sum() > 20 and (masses == 0).any()


@pytest.mark.parametrize("index", ["velocity_radius", "acceleration_radius"])
def test_along_a_direction_it_is_what_linear_programs_find(index, precision, device):
    """One of the world, of the arm on its tilted base; and in a plane of the base that it lies in."""
    case, direction = Case("franka_panda"), np.array([1.0, -2.0, 0.5])
    (back, forth), q = np.abs(case.efforts), case.configurations(40)
    for task, along in (("linear", direction), (("x", "z"), case.axes @ [0.6, 0, -2.0])):
        rows, expected = ROWS[task], []
        for row in q:
            J, _, M, g = case.at_rest(row)
            A, low, high = J[rows], -case.robot.chain.velocity_limits, case.robot.chain.velocity_limits
            if index == "acceleration_radius":
                A, low, high = J[rows] @ np.linalg.inv(M), -back - g, forth - g
            d = (case.axes.T @ along / np.linalg.norm(along))[rows]
            bounds = [(0, None), *zip(low, high, strict=True)]
            found = linprog(
                [-1, *np.zeros(len(low))], A_eq=np.column_stack([d, -A]), b_eq=np.zeros(len(d)), bounds=bounds
            )
            expected.append(-found.fun)
        found = case.values(q, index, precision, device, task, direction=along)
        np.testing.assert_allclose(found, expected, rtol=1e-7 if precision == "float64" else 1e-4)


@pytest.mark.parametrize("index", ["velocity_radius", "force_radius", "acceleration_radius"])
def test_a_direction_may_have_any_length(index):
    case = Case("ur5e")
    q, along = case.configurations(3), np.array([1.0, -2.0, 0.5])
    expected = case.values(q, index, "float64", "cpu", direction=along)
    for length in (1e-300, 1e-7, 1e9, 1e300):
        found = case.values(q, index, "float64", "cpu", direction=length * along)
        np.testing.assert_allclose(found, expected, rtol=1e-12)


@pytest.mark.parametrize(("name", "task"), [("ur5e", "linear"), ("arm", "linear"), ("franka_panda", ("x", "z"))])
def test_forces_are_held_in_every_direction_and_no_larger_ones(name, task, precision, device):
    case, rows, random = Case(name), ROWS[task], np.random.default_rng(1)
    q, (back, forth) = case.configurations(100), np.abs(case.efforts)
    radii = case.values(q, "force_radius", precision, device, task)
    along = case.axes[:, rows] @ random.normal(size=len(rows))
    rays = case.values(q, "force_radius", precision, device, task, direction=along)
    near = (1e-9 if precision == "float64" else 1e-4) * max(back.max(), forth.max())
    for row, radius, ray in zip(q, radii, rays, strict=True):
        J, _, _, g = case.at_rest(row)
        J, d = J[rows], (case.axes.T @ along / np.linalg.norm(along))[rows]
        ways = np.array([*random.normal(size=(50, len(rows))), *J.T, *-J.T])
        ways = ways[np.abs(ways).max(axis=1) > 1e-9]
        ways /= np.linalg.norm(ways, axis=1)[:, None]
        taken = g + radius * ways @ J
        slack = np.minimum(forth - taken, back + taken).min()
        assert slack > -near if radius else np.minimum(forth - g, back + g).min() < near
        assert not 0 < radius < 1e4 or abs(slack) < near
        taken = g + ray * d @ J
        assert not 0 < ray < 1e4 or abs(np.minimum(forth - taken, back + taken).min()) < near
    assert (radii > 0).any() and (radii <= rays * (1 + 1e-6)).all()


@pytest.mark.parametrize(("name", "task"), [("ur5e", "linear"), ("arm", ("x", "z")), ("franka_panda", ("y",))])
def test_a_tip_gives_way_and_errs_by_eigenvalues(name, task, precision, device):
    case, rows = Case(name), ROWS[task]
    q, n = case.configurations(200), case.robot.chain.n
    stiffness, sigma = np.geomspace(1e3, 1e5, n), np.geomspace(1e-4, 1e-2, n)
    jacobians = [case.at_rest(row)[0][rows] for row in q]
    largest = [[np.linalg.eigvalsh(J @ np.diag(w) @ J.T)[-1] for J in jacobians] for w in (1 / stiffness, sigma**2)]
    asked = {"tip_compliance": {"joint_stiffness": stiffness}, "position_error": {"joint_sigma": sigma}}
    compliance, error = case.all_values(q, asked, precision, device, task).values()
    close(compliance, largest[0], precision)
    close(error, np.sqrt(largest[1]), precision)


@pytest.mark.parametrize(("name", "acceleration"), [("ur5e", 0.0), ("ur5e", 30.0), ("arm", 2.0)])
def test_torque_margins(name, acceleration, precision, device):
    case = Case(name, payload=7.0)
    q, (back, forth) = case.configurations(200), np.abs(case.efforts)
    torques, more = case.bare.efforts(q, case.axes.T @ case.gravity, acceleration)
    sides = ((forth - torques - more) / forth).min(axis=1), ((back + torques - more) / back).min(axis=1)
    expected = np.maximum(np.minimum(*sides), -1)
    asked = {"payload_kg": 7.0, "payload_com_m": case.at, "acceleration_m_s2": acceleration}
    close(case.values(q, "torque_margin", precision, device, **asked), expected, precision)
    assert acceleration == 0 or (expected == -1).any()


def test_margins_of_joint_limits(precision, device):
    """A hinge that turns for ever, a slide, and a joint that is locked count in nothing, as far as they do not."""
    rows = [{"a": 0.3}, {"joint": "prismatic", "limits": [-0.2, 0.6]}, {"a": 0.2, "limits": [-1, 3]}]
    robot = ws.load_robot(ws.DHTable(convention="standard", rows=rows))
    q = [[3.0, 0.0, 1.0], [0, 0.2, 2], [0, 0.2, 4], [0, 0.5, 1]]
    asked = {"precision": precision, "device": device}
    found = ws.evaluate_indices(robot, q, ["joint_limit_margin"], **asked)["joint_limit_margin"]
    np.testing.assert_allclose(found, [0.25, 0.25, 0.0, 0.125], atol=1e-6)
    locked = {"method": "grid", "per_joint": 3, "locked": {"joint2": 0.6, "joint3": 3.0}}
    job = {"analysis": "workspace", "robot": {"dh": {"convention": "standard", "rows": rows}}, "sampling": locked}
    job |= {"indices": ["joint_limit_margin"], "refined_volume": None, "task": ["x", "y"]}
    entry = ws.execute(job | asked).document["indices"]["joint_limit_margin"]
    assert entry["minimum"] == entry["maximum"] == 0.5


@pytest.mark.parametrize("constrained", [False, True])
def test_results_hold_extremes_means_and_the_share_that_is_cut(constrained, precision, device):
    """Of admitted samples, as the rows say; in voxels least, mean and largest; the same bits by chunks and threads."""
    names = {
        "torque_margin": {"payload_kg": 3.0},
        "payload_capacity": {"limit_kg": 25.0},
        "force_radius": {"limit_N": 150.0},
    }
    task = "full" if constrained else "linear"  # whose values are staged, and not
    half = {"region": {"half_space": {"point_m": [0, 0, 0.2]}}} if constrained else None
    job = {"analysis": "workspace", "robot": {"library": "ur5e"}, "sampling": {"method": "sobol", "count": 3_000}}
    job |= {"indices": ["manipulability", *names], "index_options": names, "constraints": half, "refined_volume": None}
    job |= {"precision": precision, "device": device, "voxel_size_m": 0.2, "keep_map": True, "task": task}
    result = ws.execute(job | {"map_columns": ["configuration"]})
    rows, entries, volume = result.map, result.document["indices"], result.volume
    again = ws.evaluate_indices("ur5e", rows.configuration, list(names), index_options=names, task=task)
    cells = tuple((np.floor(rows.position / 0.2).astype(int) - volume.first_voxel).T)
    for name, options in names.items():
        values, entry = rows.indices[name].astype(np.float64), entries[name]
        np.testing.assert_allclose(values, again[name], rtol=1e-4 if precision == "float32" else 1e-9)
        assert (entry["minimum"], entry["maximum"]) == (values.min(), values.max())
        assert entry["mean"] == pytest.approx(values.mean(), rel=1e-6)
        if name == "torque_margin":
            assert entry["joint_mean"] is entry["workspace_mean"] is None and "cut_share" not in entry
        else:
            cut = options.get("limit_kg", options.get("limit_N"))
            assert 0 < entry["cut_share"] == (values == cut).mean() < 1
        total = np.zeros(volume.shape)
        np.add.at(total, cells, values)
        held = volume.occupied
        assert volume.statistics["mean"][name][held] == pytest.approx(total[held] / volume.count[held], rel=1e-5)
        assert {"minimum", "mean", "maximum"} <= set(volume.statistics)
    if device == "cpu":
        assert bits_of(ws.execute(job, threads=1, chunk_size=256)) == bits_of(ws.execute(job, threads=2))
    q = rows.configuration[:500]
    listed = job | {"analysis": "indices_at", "configurations": q.tolist(), "constraints": None}
    for field in ("sampling", "voxel_size_m", "keep_map", "refined_volume"):
        del listed[field]
    found = ws.execute(listed).document["indices"]["payload_capacity"]
    assert found["cut_share"] == (again["payload_capacity"][:500] >= 25).mean()


@pytest.mark.parametrize(
    ("robot", "index", "options", "message"),
    [
        (
            "ur5e",
            "velocity_radius",
            {},
            r"indices: velocity_radius needs speeds, which ur5e lacks of joint1, .*robot.velo",
        ),
        (
            "stanford_arm",
            "force_radius",
            {},
            r"indices: force_radius needs torque limits, which stanford_arm lacks of joint1",
        ),
        ("scara", "torque_margin", {}, r"indices: torque_margin needs link inertias, which the model of scara"),
        ("ur5e", "force_radius", {"task": "angular"}, r"task: must have linear rows for force_radius"),
        ("ur5e", "force_radius", {"direction": [1, 2]}, r"index_options.force_radius.direction: must .*not \[1\.0, 2"),
        ("ur5e", "force_radius", {"direction": [0, 0, 0]}, r"direction: must have 3 numbers, not all 0, or none,"),
        (
            "ur5e",
            "force_radius",
            {"task": ["x"], "direction": [1, 1, 0]},
            r"direction: must lie within the task's linear",
        ),
        (
            "ur5e",
            "payload_capacity",
            {"task": ["x"], "acceleration_m_s2": 1},
            r"acceleration_m_s2: must be 0 .*not 1\.0$",
        ),
        ("ur5e", "payload_capacity", {"limit_kg": 0}, r"index_options.payload_capacity.limit_kg: must be"),
        ("ur5e", "tip_compliance", {}, r"joint_stiffness: must have 6 numbers greater than 0, of joint1, joint2"),
        ("ur5e", "position_error", {"joint_sigma": [1e300] * 6}, r"joint_sigma: must be 0 … 1e\+15 rad or m"),
        ("ur5e", "position_error", {"joint_sigma": [0] * 6}, r"joint_sigma: must have 6 numbers greater than 0"),
        (
            "ur5e",
            "dynamic_torque_margin",
            {},
            r"indices: unknown index 'dynamic_torque_margin'; 'torque_margin' is of no",
        ),
    ],
)
def test_what_a_robot_lacks_is_told_by_its_field(robot, index, options, message):
    task = {"task": options.pop("task")} if "task" in options else {}
    job = {"analysis": "indices_at", "robot": robot, "configurations": [[0.1] * ws.load_robot(robot).chain.n]}
    with pytest.raises((InputError, ws.MissingInertiaError), match=message):
        ws.execute(job | {"indices": [index], "index_options": {index: options} if options else {}} | task)


def test_directions_lie_in_the_task_but_for_rounding():
    asked = {"indices": ["force_radius"], "task": ["x"]}
    for aside, refused in ((1e-12, False), (1e-6, True)):
        options = {"index_options": {"force_radius": {"direction": [1, aside, 0]}}}
        if refused:
            with pytest.raises(InputError, match="must lie within the task's linear"):
                ws.evaluate_indices("ur5e", np.full(6, 0.1), **asked, **options)
        else:
            assert ws.evaluate_indices("ur5e", np.full(6, 0.1), **asked, **options)["force_radius"] > 0


def test_a_mass_beside_a_tip_that_stays_in_a_plane_may_leave_it():
    link = {"mass": 1.0, "center_of_mass": [-0.1, 0, 0.02], "inertia": [0.01] * 3, "effort_limit": 50.0}
    rows = [{"a": 0.5, "alpha": 1.5, **link}, {**link}]
    robot = ws.load_robot(ws.DHTable(convention="standard", rows=rows))
    asked = {"indices": ["payload_capacity"], "task": ["x", "y"]}
    for com in ([0, 0, 0.0], [0.1, 0, 0]):
        options = {"payload_capacity": {"com_m": com, "acceleration_m_s2": 0.1}}
        if any(com):
            with pytest.raises(InputError, match="where the mass moves out of the task"):
                ws.evaluate_indices(robot, [0.3, 0.2], **asked, index_options=options)
        else:
            ws.evaluate_indices(robot, [0.3, 0.2], **asked, index_options=options)


def test_arms_of_a_class_and_mechanisms_have_none():
    class Crank:
        limits = ((-1.0, 2.0),)

        def forward_kinematics(self, q):
            return np.tile(np.eye(4), (len(q), 1, 1))

    with pytest.raises(InputError, match=r"indices: joint_limit_margin is not available for a robot .* by a class"):
        ws.evaluate_indices(Crank(), [[0.0]], ["joint_limit_margin"])
    with pytest.raises(InputError, match="those of a serial arm"):
        ws.execute({"analysis": "parallel_workspace", "mechanism": "stewart_gough", "indices": ["force_radius"]})
