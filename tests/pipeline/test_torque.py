"""The constraint on torques against MuJoCo's own bias forces, inertia matrices and Jacobians."""

import json
from pathlib import Path

import mujoco
import numpy as np
import pytest

import wsrender as ws
from tests.reference import mujoco_kinematics as by_mujoco
from wsrender import cli
from wsrender.documents.constraints import Constraints
from wsrender.engine import SweepPlan, configurations, devices_of, sweep
from wsrender.errors import DocumentError, InputError
from wsrender.pipeline.evaluation import Evaluation
from wsrender.pipeline.pipeline import Pipeline
from wsrender.pipeline.sampling import plan_sampling
from wsrender.robot.constraints import LINEAR, constraints_for
from wsrender.robot.gravity import GRAVITY

MODELS = Path(__file__).parents[2] / "mjcf"
COUNT = 1024
PLACED = ws.Transform(position_m=(0.2, 0.1, 0.0), rpy_deg=(20, -35, 70))
NEAR = {"float32": 1e-4, "float64": 1e-9}  # margin at which rounding decides

# A turn, a slide and two turns, of which the last two follow a joint on another branch, which weighs too. What they
# take is by C transposed the leader's: -20 … 20, 1.5 (-4 … 3) and -2 (-1 … 2.5).
EFFORTS = [[-9, -19, -20 - 6 - 5], [14, 23, 20 + 4.5 + 2]]
ARM = """<mujoco><compiler angle="radian"/><worldbody>
  <body name="L" pos="0 0.3 0"><joint name="lead" axis="0 1 0.3" range="-1 1" actuatorfrcrange="-20 20"/>
    <geom size=".1" pos=".2 0 0" mass="3"/></body>
  <body name="A"><joint name="a" axis="0 0 1" range="-1 1" actuatorfrcrange="-9 14"/>
    <geom size=".1" pos=".2 0 0" mass="2"/>
  <body name="B" pos=".4 0 0"><joint name="b" type="slide" axis="0 1 1" range="-.2 .2" actuatorfrcrange="-19 23"
      armature=".2"/><geom size=".1" pos=".2 0 0" mass="1"/>
  <body name="C" pos=".1 0 0"><joint name="c" axis="0 1 0.2" range="-3 3" actuatorfrcrange="-4 3"/>
    <geom size=".1" pos=".1 .1 0" mass=".7"/>
  <body name="D" pos=".3 0 0"><joint name="d" axis="1 0 0" range="-3 3" armature=".1" actuatorfrcrange="-1 2.5"/>
    <geom size=".1" pos="0 .2 0" mass=".5"/><site name="tool" pos="0 .1 .1" euler="0.3 0 0.2"/>
  </body></body></body></body></worldbody>
  <equality><joint joint1="c" joint2="lead" polycoef="0.2 1.5 0 0 0"/>
    <joint joint1="d" joint2="lead" polycoef="0 -2 0 0 0"/></equality></mujoco>"""


class Bare:
    """A model of MuJoCo's alone, with a payload at the tip; ``slopes``: of followers, by name, the leader and slope."""

    def __init__(self, text, joints, tip, payload, at, slopes=(), inertia=(1e-12, 1e-12, 1e-12)):
        spec = mujoco.MjSpec.from_string(text)
        site = spec.site(tip)
        R = np.zeros(9)
        mujoco.mju_quat2Mat(R, spec.compile().site(tip).quat)
        place = spec.compile().site(tip).pos + R.reshape(3, 3) @ at
        if payload:
            held = site.parent.add_body(
                name="payload", pos=place, quat=spec.compile().site(tip).quat, mass=payload, ipos=[0, 0, 0]
            )
            held.explicitinertial, held.inertia = True, inertia
        self.model, self.tip = spec.compile(), tip
        self.C = np.zeros((self.model.nv, len(joints)))
        for k, joint in enumerate(joints):
            self.C[self.model.joint(joint).dofadr[0], k] = 1
        for follower, leader, slope, _ in slopes:
            self.C[self.model.joint(follower).dofadr[0], joints.index(leader)] = slope
        self.offsets = {follower: offset for follower, _, _, offset in slopes}

    def efforts(self, q, gravity, acceleration=0.0, axes=LINEAR):
        """τ at rest (N, n), and what is added while the tip accelerates along ``axes`` of the base."""
        model, found = self.model, []
        model.opt.gravity = gravity
        data = mujoco.MjData(model)
        for row in q:
            full = self.C @ row
            for follower, offset in self.offsets.items():
                full[model.joint(follower).dofadr[0]] += offset
            data.qpos[:], data.qvel[:] = full, 0
            mujoco.mj_fwdPosition(model, data)
            mujoco.mj_fwdVelocity(model, data)
            more = np.zeros(len(q[0]))
            if acceleration:
                names = [model.joint(k).name for k in range(model.njnt)]
                M = self.C.T @ by_mujoco.inertia_matrix(model, data, names) @ self.C
                J = by_mujoco.jacobian(model, data, self.tip, names)[list(axes)] @ self.C
                held = J.T @ np.linalg.inv(J @ np.linalg.inv(M) @ J.T)
                more = acceleration * np.linalg.norm(held, axis=1)
            found.append((self.C.T @ data.qfrc_bias, more))
        return np.array(found).swapaxes(0, 1)


def text_of(name):
    return (MODELS / name / f"{name}.xml").read_text(encoding="utf-8")


def labels(robot, choice, precision, device, names=(), rows=LINEAR, **asked):
    """The configurations of a sweep, which of them it rejects, and the constraint."""
    asked = constraints_for(robot, Constraints(torque=choice), rows=rows, precision=precision, **asked)
    pipeline = Pipeline(
        Evaluation(robot.chain, names, rows if names else ()),
        plan_sampling(robot.chain, ws.Sobol(COUNT)),
        asked,
        kept_rows=frozenset(),
        precision=precision,
    )
    found = sweep(pipeline, 0, COUNT, devices_of(device))
    rows = np.concatenate([found.rows[first] for first in sorted(found.rows)], axis=1)
    assert found.rejected.tolist() == [np.count_nonzero(rows[-1])]
    return configurations(pipeline), rows[-1] != 0, asked[0]


def agree(q, rejected, twin, efforts, precision):
    """The kernel's labels and the twin's margins are those of the efforts."""
    (torques, more), (back, forth) = efforts, twin.chain.efforts
    margin = np.minimum(((forth - torques - more) / forth).min(axis=1), ((torques - more - back) / -back).min(axis=1))
    np.testing.assert_allclose(twin.margin(q), np.maximum(margin, -1), atol=1e-8)
    sure = np.abs(margin) > NEAR[precision]
    np.testing.assert_array_equal(rejected[sure], (margin < 0)[sure])
    assert sure.mean() > 0.99 and 0.02 * COUNT < rejected.sum() < 0.98 * COUNT


@pytest.mark.parametrize("names", ((), ("manipulability",), ("dynamic_manipulability",)), ids="".join)
@pytest.mark.parametrize(("name", "payload"), (("ur5e", 20.0), ("franka_panda", 9.0)))
def test_at_rest_labels_are_those_of_bias_forces(name, payload, names, precision, device):
    robot = ws.load_robot(name, placement=PLACED)
    at, gravity = (0.02, -0.05, 0.1), (1.0, 2.0, -9.0)
    choice = {"payload_kg": payload, "payload_com_m": at}
    q, rejected, twin = labels(robot, choice, precision, device, names=names, gravity=gravity)
    bare = Bare(text_of(name), list(robot.joint_names), robot.tip_frame, payload, np.array(at))
    turned = PLACED.matrix()[:3, :3].T @ gravity
    agree(q, rejected, twin, bare.efforts(q, turned), precision)


@pytest.mark.parametrize("rows", ((0, 1, 2), (0, 2), (1,)), ids=str)
@pytest.mark.parametrize(("payload", "acceleration"), ((6.0, 15.0), (0.0, 60.0)))
def test_labels_of_an_acceleration(payload, acceleration, rows, precision, device):
    """Along all directions, those of a plane or of a line of the base; the payload is in the inertia too."""
    robot = ws.load_robot("ur5e", placement=PLACED)
    choice = {"payload_kg": payload, "payload_com_m": (0.1, 0, 0.1), "acceleration_m_s2": acceleration}
    choice |= {"payload_inertia_kg_m2": (0.9, 0.5, 0.6)} if payload else {}
    q, rejected, twin = labels(robot, choice, precision, device, rows=rows)
    at, inertia = np.array([0.1, 0, 0.1]), (0.9, 0.5, 0.6)
    bare = Bare(text_of("ur5e"), list(robot.joint_names), robot.tip_frame, payload, at, inertia=inertia)
    gravity = PLACED.matrix()[:3, :3].T @ GRAVITY
    agree(q, rejected, twin, bare.efforts(q, gravity, acceleration, rows), precision)


@pytest.mark.parametrize("acceleration", (0.0, 2.0))
def test_slides_followers_and_what_moves_on_another_branch(acceleration, precision, device):
    robot = ws.load_robot(ARM)
    np.testing.assert_allclose(robot.chain.efforts, EFFORTS)
    assert robot.joint_names == ("a", "b", "lead") and robot.chain.geometry.with_branches is not None
    gravity, at = (3.0, -2.0, -8.0), (0.03, 0.02, -0.1)
    choice = {"payload_kg": 0.8, "payload_com_m": at, "acceleration_m_s2": acceleration}
    q, rejected, twin = labels(robot, choice, precision, device, gravity=gravity)
    slopes = (("c", "lead", 1.5, 0.2), ("d", "lead", -2.0, 0.0))
    bare = Bare(ARM, ["a", "b", "lead"], "tool", 0.8, np.array(at), slopes)
    agree(q, rejected, twin, bare.efforts(q, gravity, acceleration), precision)


def test_a_singular_posture_holds_no_acceleration(precision, device):
    """A planar arm that is stretched or folded, on a floor that carries its weight."""
    rows = [{"a": 0.4, "mass": 1.0, "effort_limit": 50.0}, {"a": 0.3, "mass": 1.0, "effort_limit": 50.0}]
    robot = ws.load_robot(ws.DHTable(convention="standard", rows=[r | {"limits": [-3.2, 3.2]} for r in rows]))
    q = np.array([[0.3, 0.0], [0.3, 1.5], [-2.0, np.pi], [0.3, -1.5]])
    found = {}
    for acceleration in (0.0, 1.0):
        choice = {"torque": {"acceleration_m_s2": acceleration}}
        options = {"robot": robot, "configurations": q, "task": ["x", "y"], "indices": ["manipulability"]}
        result = ws.indices_at(**options, constraints=choice, precision=precision, device=device)
        found[acceleration] = result.tables["admission"].columns["reason"].tolist()
    assert found == {0.0: [""] * 4, 1.0: ["torque", "", "torque", ""]}
    choice = Constraints(torque={"acceleration_m_s2": 1.0})
    (twin,) = constraints_for(robot, choice, rows=(0, 1))
    np.testing.assert_array_equal(twin.margin(q) == -1, [True, False, True, False])


def test_gravity_of_the_job_by_every_door(tmp_path):
    """On the moon a UR5e holds more; the command line and a job of two robots say the same."""
    job = {
        "analysis": "workspace",
        "robot": {"library": "ur5e"},
        "sampling": {"method": "sobol", "count": COUNT},
        "constraints": {"torque": {"payload_kg": 25.0}},
        "refined_volume": 0.3,
        "device": "cpu",
    }
    rejected = {}
    for name, gravity in (("earth", None), ("same", GRAVITY), ("moon", (0, 0, -1.62)), ("none", (0, 0, 0))):
        result = ws.execute(job | {"gravity_m_s2": gravity})
        rejected[name] = result.document["samples"]["rejected"]["torque"]
        assert result.document["headline"]["value"] > 0
        assert result.document["job"].get("gravity_m_s2") == (None if gravity is None else list(gravity))
    assert rejected["earth"] == rejected["same"] > rejected["moon"] == rejected["none"] == 0
    robot = ws.load_robot("ur5e")
    q, _, twin = labels(robot, job["constraints"]["torque"], "float64", "cpu")
    assert twin.host(q, None).sum() == rejected["earth"]
    (tmp_path / "job.json").write_text(json.dumps(job))
    with pytest.raises(SystemExit) as ended:
        cli.main(["run", str(tmp_path / "job.json"), "-o", str(tmp_path / "out")])
    assert ended.value.code == 0
    saved = ws.Result.load(tmp_path / "out").document
    assert saved["samples"]["rejected"] == {"torque": rejected["earth"]}
    arm = {"robot": job["robot"], "sampling": job["sampling"]}
    for analysis in ("shared_workspace", "robot_comparison"):
        two = {"analysis": analysis, "robots": [arm, arm], "constraints": job["constraints"], "device": "cpu"}
        for gravity, expected in ((None, rejected["earth"]), ((0, 0, -1.62), 0)):
            result = ws.execute(two | {"gravity_m_s2": gravity})
            for each in result.document["robots"]:
                assert each["samples"]["rejected"] == {"torque": expected}


def test_targets_are_reached_under_the_gravity_of_the_job():
    """A stretched arm that cannot be held on earth is held on the moon."""
    tip = ws.load_robot("ur5e").forward_kinematics([0.1, -0.05, 0.1, 0.2, 0.1, 0.0])[0, :3, 3]
    job = {"analysis": "reachability", "robot": {"library": "ur5e"}, "points_m": [tip.tolist()]}
    job |= {"constraints": {"torque": {"payload_kg": 40.0}}, "device": "cpu"}
    labels = [
        ws.execute(job | {"gravity_m_s2": g}).tables["targets"].columns["label"][0] for g in (None, (0, 0, -1.62))
    ]
    assert labels[0] != "reachable" == labels[1]


def test_payloads_are_numbers_of_the_kernel():
    robot = ws.load_robot("ur5e")
    shapes = []
    for choice in (True, {"payload_kg": 3, "payload_com_m": [0, 0, 0.1]}, {"acceleration_m_s2": 2}):
        asked = constraints_for(robot, Constraints(torque=choice))
        sampling = plan_sampling(robot.chain, ws.Sobol(1024))
        shapes.append(SweepPlan(Pipeline(Evaluation(robot.chain), sampling, asked)).shape)
    assert shapes[0] == shapes[1] != shapes[2]
    assert constraints_for(robot, Constraints(torque=False)) == constraints_for(robot, Constraints()) == ()


@pytest.mark.parametrize(
    ("stated", "asks", "noted"),
    [
        ("0 0 -1.62", {"constraints": {"torque": True}}, True),
        ("0 0 -1.62", {"constraints": {"torque": True}, "gravity_m_s2": [0, 0, -1.62]}, False),
        ("0 0 -1.62", {}, False),
        ("0 0 -9.81", {"constraints": {"torque": True}}, False),
    ],
)
def test_a_model_of_another_gravity_is_noted(stated, asks, noted):
    text = ARM.replace("<worldbody>", f'<option gravity="{stated}"/><worldbody>')
    job = {"analysis": "indices_at", "robot": {"mjcf": text}, "configurations": [[0, 0, 0]], "device": "cpu"}
    found = [each for each in ws.execute(job | asks).document["warnings"] if each["code"] == "gravity"]
    assert [each["field"] for each in found] == ["gravity_m_s2"] * noted
    assert all("[0.0, 0.0, -1.62]" in each["message"] for each in found)


class Crank:
    limits = ((-1.0, 2.0),)

    def forward_kinematics(self, q):
        return np.tile(np.eye(4), (len(q), 1, 1))


LINK = {"a": 0.4, "limits": [-3, 3]}


@pytest.mark.parametrize(
    ("robot", "choice", "options", "message"),
    [
        (Crank(), True, {}, r"constraints\.torque: is not available .* a class"),
        ([LINK | {"effort_limit": 5.0}], True, {}, r"constraints\.torque: .* lacks masses or inertias"),
        ([LINK | {"mass": 1.0}], {"payload_kg": 1}, {}, r"constraints\.torque: .* lacks torque limits of joint1 "),
        ("ur5e", {"acceleration_m_s2": 1}, {"task": "angular"}, r"torque\.acceleration_m_s2: must be 0 with a task"),
    ],
)
def test_what_cannot_be_is_refused_when_a_job_is_planned(robot, choice, options, message):
    if isinstance(robot, list):
        robot = ws.load_robot(ws.DHTable(convention="standard", rows=robot))
    with pytest.raises(InputError, match=message):
        ws.analyze(robot, ws.Sobol(256), constraints={"torque": choice}, refined_volume=None, **options)


@pytest.mark.parametrize(
    ("choice", "message"),
    [
        ({"payload_kg": -1}, r"constraints.torque.payload_kg: must be .*0"),
        ({"payload_com_m": [0, 0]}, r"constraints.torque.payload_com_m: must be a list of 3"),
        ({"acceleration_m_s2": -1}, r"constraints.torque.acceleration_m_s2: must be .*0"),
        ({"payload": 1}, r"constraints.torque.payload: "),
        ({"payload_inertia_kg_m2": [1, 1, 1]}, r"payload_inertia_kg_m2: must not be given without .payload_kg"),
        (
            {"payload_kg": 1, "payload_inertia_kg_m2": [1, -1, 1]},
            r"payload_inertia_kg_m2: .* negative principal",
        ),
    ],
)
def test_malformed_torques(choice, message):
    with pytest.raises(DocumentError, match=message):
        ws.analyze("ur5e", constraints={"torque": choice})
