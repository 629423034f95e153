"""Two arms against each other: labels of pairs of configurations, and what is refused."""

import re

import mujoco
import numpy as np
import pytest

import wsrender as ws
from tests.collision.robots import drawn, random_text
from wsrender.collision.distance import Distances
from wsrender.documents.constraints import Apart
from wsrender.documents.placements import IN_DEGREES, placed
from wsrender.errors import DocumentError, InputError
from wsrender.reach.admission import Admission
from wsrender.robot.arms_collision import arms_apart
from wsrender.robot.collisions import solid_of
from wsrender.robot.constraints import constraints_for
from wsrender.robot.model_robot import transform_of
from wsrender.robots.library import find
from wsrender.robots.moving_base import MovingBase
from wsrender.robots.pairs import meet

AHEAD = ws.Transform(position_m=(0, 0, 0.15))  # of the flange
BESIDE = ws.Transform(position_m=(0.55, 0.1, 0.05), rpy_deg=(0, 0, 170))
NAMES = ("left", "right")


def two_ur5e(tool: ws.Transform | None = AHEAD):
    return ws.load_robot("ur5e", tool=tool), ws.load_robot("ur5e", tool=tool, placement=BESIDE)


def labels(robots, q, **choice) -> np.ndarray:
    apart = arms_apart(robots, NAMES, Apart(**choice))
    return Admission(apart.chain, (apart.constraint,)).rejected(apart.configurations(*q)) > 0


def test_labels_are_those_of_a_scene_with_both():
    """MuJoCo's contacts of two UR5e, as they are in their file, in one scene, at 20,000 pairs of configurations."""
    robots = two_ur5e()
    scene = mujoco.MjSpec()
    for name, robot in zip(NAMES, robots, strict=True):
        T, quat = robot.chain.T_world_base, np.zeros(4)
        mujoco.mju_mat2Quat(quat, T[:3, :3].ravel())
        scene.attach(
            mujoco.MjSpec.from_file(str(find("ur5e"))),
            frame=scene.worldbody.add_frame(pos=T[:3, 3], quat=quat),
            prefix=f"{name}/",
        )
    model = scene.compile()
    data, q = mujoco.MjData(model), [drawn(robot, 20_000, seed) for seed, robot in enumerate(robots)]
    at = [[model.joint(f"{side}/{name}").qposadr[0] for name in robots[0].joint_names] for side in NAMES]
    first = np.array([model.body(model.geom_bodyid[geom]).name.startswith("left/") for geom in range(model.ngeom)])
    found = np.zeros(len(q[0]), bool)
    for i in range(len(found)):
        data.qpos[at[0]], data.qpos[at[1]] = q[0][i], q[1][i]
        mujoco.mj_kinematics(model, data)
        mujoco.mj_collision(model, data)
        found[i] = (first[data.contact.geom[:, 0]] != first[data.contact.geom[:, 1]]).any()
    assert 0.05 < found.mean() < 0.5
    np.testing.assert_array_equal(labels(robots, q), found)


def test_labels_of_arms_whose_bases_move_are_those_of_arms_that_stand_there():
    """Of two Pandas on floors that slide and turn, beside arms placed there, and their bases by distances."""
    alone, random = [ws.load_robot("franka_panda", tool=AHEAD)] * 2, np.random.default_rng(2)
    stands = ws.Transform(position_m=(0.1, 0, 0.05), rpy_deg=(0, 10, 0)).matrix()
    ends = np.array([[0.4, 0.4, 0, 0, 0, 0.5], [0.3, 0, 0, 0.4, 0, 3.0]])  # which coordinates vary
    bases = [
        MovingBase(middle - end, middle + end, stands) for middle, end in zip(np.eye(6)[:2] * 0.3, ends, strict=True)
    ]
    apart = arms_apart(alone, NAMES, Apart(), bases=bases)
    together, found = Admission(apart.chain, (apart.constraint,)), []
    for seed in range(4):
        places = [base.lower + random.random(6) * (base.upper - base.lower) for base in bases]
        if seed == 0:  # one stands on the other
            places[0][:2] = places[1][:2]
        q = [drawn(robot, 400, 2 * seed + k) for k, robot in enumerate(alone)]
        T = [placed(np.array([place / IN_DEGREES]))[0] @ stands for place in places]
        robots = [robot.placed(transform_of(each) or ws.Transform()) for robot, each in zip(alone, T, strict=True)]
        values = [
            np.tile(base.configurations(place[None]), (400, 1)) for base, place in zip(bases, places, strict=True)
        ]
        own = together.rejected(apart.configurations(*map(np.hstack, zip(values, q, strict=True)))) > 0
        still = [[k for k, shape in enumerate(robot.bodies.shapes) if shape.frame < 0] for robot in robots]
        poses = [robot.bodies.poses(q[0][:1])[:, which] for robot, which in zip(robots, still, strict=True)]
        solids = [solid_of(robot.bodies.shapes[k]) for robot, which in zip(robots, still, strict=True) for k in which]
        beside = np.ndindex(len(still[0]), len(still[1]))
        far = [Distances(solids).between(i, len(still[0]) + k, poses[0][:, i], poses[1][:, k], 1.0) for i, k in beside]
        expected = labels(robots, q) | (np.min(far) < 0)
        found.append(expected.mean())
        np.testing.assert_array_equal(own, expected)
    assert max(found) == 1 and 0.05 < min(found) < 0.9


@pytest.mark.parametrize("margin_m", [0.0, 0.05])
def test_labels_of_random_arms_by_the_distances_of_their_shapes(margin_m):
    """Of slides and hinges, with any contact bits: by the poses that each robot says of its own shapes."""
    found, tested = [], 0
    for seed in (3, 4, 8):
        placed = ws.Transform(position_m=(0.4, 0.3, -0.2), rpy_deg=(20, 50, 80))
        robots = (
            ws.load_robot(random_text(seed, 4), tip="tip", tool=ws.Transform(position_m=(0, 0, 2))),
            ws.load_robot(random_text(seed + 20, 3), tip="tip", placement=placed),
        )
        q = [drawn(robot, 1500, seed) for robot in robots]
        shapes = [robot.bodies.shapes for robot in robots]
        poses = [robot.bodies.poses(each) for robot, each in zip(robots, q, strict=True)]
        distances = Distances([solid_of(shape) for own in shapes for shape in own])
        near = np.zeros(1500, bool)
        for i, a in enumerate(shapes[0]):
            for k, b in enumerate(shapes[1]):
                if max(a.frame, b.frame) >= 0:
                    far = distances.between(i, len(shapes[0]) + k, poses[0][:, i], poses[1][:, k], margin_m + 0.01)
                    near |= far < margin_m
                    tested += 1
        np.testing.assert_array_equal(labels(robots, q, margin_m=margin_m), near)
        found.append(near.mean())
    assert tested > 20 and max(found) > 0.1 and min(found) < 0.9


def with_bits(text: str, seed: int) -> str:
    """The same with other contact bits, and no boxes, in which MuJoCo misses some capsules."""
    random = np.random.default_rng(seed)
    text = re.sub(r'contype="1"', lambda _: f'contype="{random.integers(4)}"', text.replace('"box"', '"ellipsoid"'))
    return re.sub(r'conaffinity="1"', lambda _: f'conaffinity="{random.integers(1, 4)}"', text)


@pytest.mark.parametrize("seed", [3, 6])
def test_contact_bits_between_arms_and_with_a_scene_are_mujocos(seed, device):
    """Contacts in a model of both arms and what stands around, each compiled with bits of its own."""
    texts = [with_bits(random_text(each, 3), each) for each in (seed, seed + 20)]
    geom = '<geom type="sphere" size=".12" pos="{}" contype="{}" conaffinity="{}"/>'
    stones = (".45 .2 .1", 1, 0), ("-.45 .2 .1", 0, 2), (".1 -.5 .1", 2, 1), (".1 .5 -.2", 2, 0), (".2 0 .5", 1, 2)
    cell = "".join(geom.format(*each) for each in stones)
    cell = f"<mujoco><worldbody>{cell}</worldbody></mujoco>"
    T = {"position_m": (0.3, 0.2, -0.1), "quat_wxyz": (1, 0, 0, 0)}
    tool = ws.Transform(position_m=(0, 0, 2))
    robots = [
        ws.load_robot(text, tip="tip", tool=own, placement=placed)
        for text, own, placed in zip(texts, (tool, None), (None, ws.Transform(**T)), strict=True)
    ]
    spec = mujoco.MjSpec()
    for name, text, at in zip((*NAMES, "cell"), (*texts, cell), ((0, 0, 0), T["position_m"], (0, 0, 0)), strict=True):
        frame = spec.worldbody.add_frame(pos=at)
        spec.attach(mujoco.MjSpec.from_string(text), frame=frame, prefix=f"{name}/")
    model = spec.compile()
    model.geom_margin[:] = 0
    data, q = mujoco.MjData(model), [drawn(robot, 2000, seed + k) for k, robot in enumerate(robots)]
    names = [model.body(model.geom_bodyid[k]).name or model.geom(k).name for k in range(model.ngeom)]
    side = np.array([0 if name.startswith("left") else 1 if name.startswith("right") else 2 for name in names])
    met = np.ones((2000, 3, 3))
    for i in range(2000):
        data.qpos[:] = np.concatenate([q[0][i], q[1][i]])
        mujoco.mj_kinematics(model, data)
        mujoco.mj_collision(model, data)
        for contact in data.contact:
            a, b = sorted(side[contact.geom])
            met[i, a, b] = min(met[i, a, b], contact.dist)
    apart = arms_apart(robots, NAMES, Apart())
    shapes = [robot.bodies.shapes for robot in robots]
    assert any(not meet(a.bits, b.bits) for a in shapes[0] for b in shapes[1])
    expected = met[:, 0, 1]
    found = labels(robots, q)
    assert not ((found != (expected < 0)) & (np.abs(expected) > 1e-6)).any()
    assert len(apart.constraint.pairs) and found.any()
    around, blocked = ws.Environment([ws.Scene(mjcf=cell, name="cell")]), 0
    for k, robot in enumerate(robots):
        constraints, expected = constraints_for(robot, None, around), met[:, k, 2]
        found = Admission(robot.chain, constraints, device).rejected(q[k]) > 0
        assert not ((found != (expected < 0)) & (np.abs(expected) > 1e-6)).any()
        blocked += found.sum()
    assert 0 < blocked < 4000


def test_arms_whose_contact_bits_never_meet_are_refused():
    one, other = (f'<geom type="sphere" size=".1" contype="{bit}" conaffinity="{bit}"/>' for bit in (1, 2))
    arms = [
        ws.load_robot(
            f"<mujoco><worldbody><body><joint range='-1 1' limited='true'/>{geom}</body></worldbody></mujoco>"
        )
        for geom in (one, other)
    ]
    with pytest.raises(InputError, match=r"constraints\.arms_collision: would keep nothing apart: contype"):
        arms_apart(arms, NAMES, Apart())
    scene = ws.Scene(mjcf=f"<mujoco><worldbody>{other}</worldbody></mujoco>")
    with pytest.raises(InputError, match=r"constraints\.environment: would keep nothing apart: contype"):
        constraints_for(arms[0], None, ws.Environment([scene]))
    assert constraints_for(arms[0], None, ws.Environment([scene, ws.Sphere(radius_m=0.1, position_m=(9, 0, 0))]))


CROSSED = """<mujoco><compiler angle="radian"/><worldbody><body name="trunk">
  <geom name="trunk" type="sphere" size=".1"/>
  <body name="l"><inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/><joint name="l" axis="0 0 1" range="-1 1"/>
    <geom name="l" type="capsule" size=".02" fromto="0 0 0 .3 0 0"/><site name="l_tip" pos=".4 0 0"/></body>
  <body name="r" pos="0 .2 0"><inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>
    <joint name="r" axis="0 0 1" range="-1 1"/>
    <geom name="r" type="capsule" size=".02" fromto="0 0 0 .3 0 0"/><site name="r_tip" pos=".4 0 0"/></body>
</body></worldbody></mujoco>"""


def test_arms_of_one_model_against_each_other_alone():
    """The trunk of both is no shape of the other arm: the left capsule starts in it."""
    robots = [ws.load_robot(CROSSED, tip=f"{side}_tip") for side in "lr"]
    apart = arms_apart(robots, NAMES, Apart(), one_model=True).constraint
    assert [[apart.solids[k].name for k in pair] for pair in apart.pairs] == [["left/l", "right/r"]]
    q = np.array([[1.0, -1.0], [-1.0, 1.0], [0.0, 0.0], [0.5, 0.4]])
    elbow = [np.stack([0.3 * np.cos(q[:, k]), 0.3 * np.sin(q[:, k]) + 0.2 * k], axis=1) for k in (0, 1)]
    assert np.linalg.norm(elbow[0] - elbow[1], axis=1)[1] > 0.04
    both = arms_apart(robots, NAMES, Apart(), one_model=True)
    found = Admission(both.chain, (both.constraint,)).rejected(both.configurations(q[:, :1], q[:, 1:]))
    assert found.tolist() == [1, 0, 0, 0]
    with pytest.raises(InputError, match="both arms have the joints l"):
        arms_apart((robots[0], robots[0]), NAMES, Apart(), one_model=True)


@pytest.mark.parametrize(
    ("choice", "tool", "message"),
    [
        ({}, None, "would admit nothing: left/link5/1 and right/link5/1; .* meet wherever the tips do; give"),
        ({"margin_m": 0.31}, AHEAD, "left/link6/0 and right/link6/0 meet wherever .*exclude = "),
        ({"margin_m": 20}, AHEAD, "margin_m: must be at most the robots' size, 3.06 m, not 20"),
        ({"exclude": [["left/nothing", "right/link6"]]}, AHEAD, "exclude.0: no shape, and no body .* 'left/nothing'"),
    ],
    ids=["tips in shapes", "tips too near", "margin", "exclude"],
)
def test_refused(choice, tool, message):
    with pytest.raises(InputError, match=f"constraints.arms_collision.*{message}"):
        arms_apart(two_ur5e(tool), NAMES, Apart(**choice))


def test_height_fields_of_the_other_arm_are_refused():
    """They stand with a base, which moves in the chain of both."""
    text = random_text(3, 2).replace(
        "<worldbody>",
        """<asset><hfield name="hills" nrow="2" ncol="2"
        elevation="1 2 3 4" size="1 1 1 .1"/></asset><worldbody><body name="table" pos="0 0 -3"><geom name="ground"
        type="hfield" hfield="hills"/></body>""",
    )
    tool = ws.Transform(position_m=(0, 0, 2))
    robots = [ws.load_robot(each, tip="tip", tool=tool) for each in (text, random_text(23, 2))]
    with pytest.raises(InputError, match="exclude: must list all pairs of left/ground: arms keep"):
        arms_apart(robots, NAMES, Apart())
    bodies = dict.fromkeys(f"right/{shape.body}" for shape in robots[1].bodies.shapes)
    excluded = [["left/ground", body] for body in bodies]
    pairs = arms_apart(robots, NAMES, Apart.model_validate({"exclude": excluded})).constraint.pairs
    assert len(pairs) and 0 not in pairs


def test_what_meets_wherever_tips_do_may_be_excluded():
    wrists = [[f"left/{a}", f"right/{b}"] for a in ("link5", "link6") for b in ("link5", "link6")]
    assert len(arms_apart(two_ur5e(None), NAMES, Apart.model_validate({"exclude": wrists})).constraint.pairs) > 20


def test_jobs_of_one_arm_and_of_points_refuse_it():
    asked = {"constraints": {"arms_collision": True}}
    with pytest.raises(InputError, match="arms_collision: unknown constraint"):
        ws.execute({"analysis": "workspace", "robot": {"library": "ur5e"}, **asked})
    points = {"left": {"robot": "ur5e"}, "right": {"points": [[0, 0, 0]]}}
    with pytest.raises(DocumentError, match="constraints: must be null: points have no configurations"):
        ws.execute({"analysis": "collaborative_volume", **points, **asked})
