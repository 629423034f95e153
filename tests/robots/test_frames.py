"""Choosing base and tip."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from wsrender import robots
from wsrender.errors import FrameNotFoundError, ModelError
from wsrender.robots.frames import inverse_of_rigid

LINKS = """<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>"""
TWO_ARMS = f"""<mujoco model="torso"><worldbody>
  <body name="pelvis"><freejoint name="root"/>{LINKS}
    <body name="chest" pos="0 0 .5"><joint name="waist" axis="0 0 1"/>{LINKS}<site name="neck" pos="0 0 .3"/>
      <body name="left" pos="0 .3 0"><joint name="left_shoulder" axis="0 1 0"/>{LINKS}
        <body name="left_hand" pos="0 0 -.5"><joint name="left_elbow" axis="0 1 0"/>{LINKS}</body></body>
      <body name="right" pos="0 -.3 0"><joint name="right_shoulder" axis="0 1 0"/>{LINKS}
        <body name="right_hand" pos="0 0 -.5"><joint name="right_elbow" axis="1 0 0"/>{LINKS}
          <site name="grip"/></body></body>
    </body></body></worldbody></mujoco>"""


def one_arm(end):
    return f"""<mujoco><worldbody><body name="stand"/><body name="upper"><joint/>{LINKS}
      <body name="lower" pos="1 0 0"><joint/>{LINKS}{end}</body></body></worldbody></mujoco>"""


@pytest.mark.parametrize(
    ("base", "tip", "joints"),
    [
        ("pelvis", "left_hand", ("waist", "left_shoulder", "left_elbow")),
        ("chest", "right_hand", ("right_shoulder", "right_elbow")),
        ("neck", "grip", ("right_shoulder", "right_elbow")),
        ("left", None, ("left_elbow",)),
    ],
)
def test_joints_between_base_and_tip(base, tip, joints):
    chain = robots.load_mjcf(TWO_ARMS, base=base, tip=tip).chain
    assert chain.joint_names == joints
    assert (chain.base_frame, chain.tip_frame) == (base, tip or "left_hand")


@pytest.mark.parametrize(
    ("end", "tip"),
    [
        ("", "lower"),
        ('<body name="flange" pos="1 0 0"><body name="plate"/></body>', "plate"),
        ('<body name="camera"/><body name="flange"><body name="tool0" pos="0 0 1"/></body>', "tool0"),
        ('<body name="camera"/><body name="flange"/><site name="tool"/>', "tool"),
    ],
)
def test_default_tip(end, tip):
    assert robots.load_mjcf(one_arm(end)).chain.tip_frame == tip


def test_loose_objects_are_no_tips():
    text = one_arm("").replace("</worldbody>", f'<body name="cube"><freejoint/>{LINKS}</body></worldbody>')
    assert robots.load_mjcf(text).chain.tip_frame == "lower"


def test_a_site_goes_before_the_body_of_its_name():
    chain = robots.load_mjcf(one_arm('<site name="lower" pos="0 0 3"/>'), tip="lower").chain
    assert chain.T_tip[:3, 3] == pytest.approx([0, 0, 3])


def test_a_tip_that_must_be_chosen_lists_the_choices_ends_first():
    with pytest.raises(FrameNotFoundError, match="tip: the model ends in 2 places; its tip must be named") as caught:
        robots.load_mjcf(TWO_ARMS, base="pelvis")
    assert caught.value.choices == ["grip", "left_hand", "right_hand", "neck", "chest", "left", "right"]


@pytest.mark.parametrize(
    ("base", "tip", "message"),
    [
        (
            "pelvis",
            "left_hnad",
            "tip: the model has no site, body or link 'left_hnad'; did you mean 'left_hand'",
        ),
        ("hips", "grip", "base: the model has no site, body or link 'hips'"),
        ("left", "grip", "'left' is not an ancestor of the tip 'grip'; choose one of: world, pelvis, chest"),
        ("grip", "left_hand", "base: 'grip' is not an ancestor of the tip 'left_hand'"),
    ],
)
def test_unknown_frames(base, tip, message):
    with pytest.raises(FrameNotFoundError, match=message):
        robots.load_mjcf(TWO_ARMS, base=base, tip=tip)


@pytest.mark.parametrize(
    ("base", "message"),
    [
        (None, "'root' is a free joint on the chain from 'world' to 'grip'.*name a base below it, such as 'pelvis'"),
        ("right_hand", "there is no joint between base 'right_hand' and tip 'grip'"),
    ],
)
def test_frames_with_no_chain_between(base, message):
    with pytest.raises(ModelError, match=message):
        robots.load_mjcf(TWO_ARMS, base=base, tip="grip")


def with_gripper(*joints, palm="hand"):
    """An arm whose joints have these names, each on a link of its own; the one before the last is ``palm``."""
    links = [f"link{k}" for k in range(len(joints) - 1)] + ["end"]
    links[-2] = palm
    bodies = "".join(
        f'<body name="{link}" pos=".1 0 0"><joint name="{joint}"/>{LINKS}'
        for link, joint in zip(links, joints, strict=True)
    )
    return f"<mujoco><worldbody>{bodies}{'</body>' * len(joints)}</worldbody></mujoco>"


@pytest.mark.parametrize("jaw", ["gripper", "jointGripper", "Jaw", "left_finger_joint", "claw"])
def test_a_jaw_taken_for_the_tip_is_noticed(jaw):
    text = with_gripper("shoulder", "wrist", jaw)
    with pytest.warns(robots.ModelWarning) as caught:
        robot = robots.load_mjcf(text)
    assert str(caught[0].message) == (
        f"the tip 'end', the only end of the model, is moved by {jaw} beyond wrist, the last joint of the arm; "
        "tip='hand' ends before the gripper"
    )
    assert [(notice.code, notice.field) for notice in robot.notices] == [("gripper_tip", "tip")]
    assert robots.load_mjcf(text, tip="hand").chain.joint_names == ("shoulder", "wrist")
    assert robots.load_mjcf(text, tip="end").notices == ()


def test_every_joint_of_a_gripper_is_named():
    with pytest.warns(
        robots.ModelWarning, match="is moved by gripper_rotation, gripper beyond elbow.*tip='link0' ends"
    ):
        robots.load_mjcf(with_gripper("elbow", "gripper_rotation", "gripper"))


@pytest.mark.parametrize(
    "text", [with_gripper("shoulder", "elbow", "wrist"), with_gripper("finger_0", "finger_1"), one_arm("")]
)
def test_arms_and_fingers_by_themselves_are_not_noticed(text):
    assert robots.load_mjcf(text).notices == ()


@pytest.mark.parametrize("palm", ["hand", "gripper", "Fixed_Jaw"])
def test_a_moving_jaw_is_known_by_its_link(palm):
    text = with_gripper("1", "2", "3", palm=palm).replace('"end"', '"Moving_Jaw"')
    with pytest.warns(robots.ModelWarning, match=f"is moved by 3 beyond 2.*tip={palm!r} ends"):
        robots.load_mjcf(text)


def test_rigid_motions_are_inverted_as_any_matrix_is():
    T = np.tile(np.eye(4), (50, 1, 1))
    T[:, :3, :3] = Rotation.random(50, rng=np.random.default_rng(0)).as_matrix()
    T[:, :3, 3] = np.random.default_rng(1).normal(size=(50, 3))
    np.testing.assert_allclose(inverse_of_rigid(T), np.linalg.inv(T), rtol=0, atol=1e-14)
