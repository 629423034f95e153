"""Classes of arms with closed-form inverse kinematics, told by their axes."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.reference.arms_by_axes import (
    PARALLEL,
    RELATIONS,
    WRIST,
    axes_of,
    chain_of,
    direction,
    frame,
    random_arm,
    reversed_chain,
    slid_along_axes,
)
from tests.reference.redundant_arms import redundant_arm
from wsrender.reach.moving_joints import moving_joints
from wsrender.robots.closed_form import ClosedForm, FreeJointForm

LIBRARY = {
    "articulated": "spherical wrist, axes 1 and 2 intersecting",
    "cartesian": "spherical wrist, PPP arm",
    "cylindrical": "spherical wrist, RPP arm",
    "dvrk_mtm": "spherical wrist, axes 1 and 2 intersecting",
    "franka_panda": "ball search along joint 7 over a closed form (spherical shoulder, axes 6 and 5 intersecting)",
    "gao_6r": "spherical wrist, axes 2 and 3 parallel",
    "kuka_iiwa14": "ball search along joint 7 over a closed form (spherical shoulder, axes 6 and 5 intersecting)",
    "phantom_omni": "spherical wrist, axes 1 and 2 intersecting",
    "puma560": "spherical wrist, axes 1 and 2 intersecting",
    "scara": "shoulder of one axis, RPR arm",  # its slide lies across, not along, the hinges before it
    "slave_5r": "wrist of two axes, RRP arm",
    "spherical": "spherical wrist, RRP arm",
    "stanford_arm": "spherical wrist, RRP arm",
    "ur5e": "three parallel axes",
}


def class_of(chain):
    closed = ClosedForm.of(chain)
    return closed and closed.name


@pytest.mark.parametrize("name", LIBRARY)
def test_arms_of_the_library(name):
    assert ws.load_robot(name).closed_form == LIBRARY[name]


def named(kind):
    return kind if kind == PARALLEL else f"{WRIST}, {kind}"


@pytest.mark.parametrize("kind", [*RELATIONS, PARALLEL])
def test_the_class_is_in_the_axes_alone(kind):
    for seed in range(10):
        chain, random = random_arm(kind, seed), np.random.default_rng(seed)
        assert class_of(chain) == named(kind)
        assert class_of(slid_along_axes(chain, random.uniform(-1, 1, (6, 2)))) == named(kind)
        moved, tool = (frame(direction(random), random.uniform(-2, 2, 3)) for _ in range(2))
        T_joint = chain.T_joint.copy()
        T_joint[0] = moved @ T_joint[0]
        assert class_of(replace(chain, T_joint=T_joint, T_tip=chain.T_tip @ tool)) == named(kind)
        backwards = {"axes 1 and 2": "axes 6 and 5", "axes 2 and 3": "axes 5 and 4", WRIST: "spherical shoulder"}
        expected = named(kind)
        for word, other in backwards.items():
            expected = expected.replace(word, other)
        assert class_of(reversed_chain(chain)) == expected


def tilted(chain, joint, by):
    """The chain with one axis turned about a line across it, through its point."""
    h, o, T_tip = axes_of(chain)
    about = np.cross(h[joint], np.eye(3)[np.argmin(np.abs(h[joint]))])
    h[joint] = Rotation.from_rotvec(by * about / np.linalg.norm(about)).apply(h[joint])
    return chain_of(h, o, T_tip, chain.lower_limits, chain.upper_limits)


def shifted(chain, joint, by, beside):
    """The chain with one axis moved away from that of another joint."""
    h, o, T_tip = axes_of(chain)
    off = np.cross(h[joint], h[beside])
    o[joint] += by * off / np.linalg.norm(off)
    return chain_of(h, o, T_tip, chain.lower_limits, chain.upper_limits)


def test_an_axis_that_is_a_little_off_leaves_its_class():
    for seed in range(5):
        arm = random_arm(PARALLEL, seed)
        assert class_of(tilted(arm, 2, 1e-6)) is None
        assert class_of(tilted(arm, 2, 1e-9)) == PARALLEL
        assert class_of(shifted(arm, 5, 4e-6, beside=4)) is None
        for kind in RELATIONS:
            assert class_of(shifted(random_arm(kind, seed), 4, 4e-6, beside=5)) is None
        # Beside these classes the quartic of general arms would lose its digits.
        assert class_of(shifted(random_arm(RELATIONS[0], seed), 0, 4e-6, beside=1)) is None
        assert class_of(tilted(random_arm(RELATIONS[1], seed), 0, 4e-6)) is None
        for off in (
            tilted(random_arm(RELATIONS[2], seed), 2, 4e-6),
            shifted(random_arm(RELATIONS[3], seed), 2, 4e-6, beside=1),
        ):
            assert class_of(off) == named(RELATIONS[4])


@pytest.mark.parametrize(
    ("kinds", "relation"),
    [("RRP", 0), ("RRP", 1), ("RPP", 4), ("PRP", 2), ("PPR", 4), ("PRR", 2), ("PRR", 3), ("PPP", 4), ("RPR", 0)],
)
def test_slides_among_the_first_three(kinds, relation):
    chain = random_arm(RELATIONS[relation], 3, kinds)
    if kinds in ("PRP", "RPR"):  # the slide must lie across the second axis, the hinge across the slide
        h, o, T_tip = axes_of(chain)
        h[2] = np.cross(h[1], h[0]) / np.linalg.norm(np.cross(h[1], h[0]))
        chain = chain_of(h, o, T_tip, chain.lower_limits, chain.upper_limits, chain.joint_is_revolute)
    assert class_of(chain) == f"{WRIST}, {kinds} arm"


def test_a_hinge_and_a_slide_along_it_move_the_same_way_in_either_order():
    chain = random_arm(RELATIONS[4], 3, "RPR")
    h, o, T_tip = axes_of(chain)
    assert class_of(chain) is None
    h[:3] = h[0]
    chain = chain_of(h, o, T_tip, chain.lower_limits, chain.upper_limits, chain.joint_is_revolute)
    assert class_of(chain) == f"{WRIST}, PRR arm"


def test_held_joints_are_left_out():
    seven = ws.load_robot("kuka_iiwa14")
    assert ClosedForm.of(seven.chain) is None
    assert seven.held({seven.joint_names[2]: 0.4}).closed_form == "spherical wrist, axes 1 and 2 intersecting"
    assert seven.held({seven.joint_names[6]: 0.4}).closed_form is not None
    without_fifth = ClosedForm.of(moving_joints(seven.held({seven.joint_names[4]: 0.4}).chain, axis=True)[0], "axis")
    assert without_fifth.name == "spherical shoulder, axes 7 and 6 intersecting"
    assert ws.load_robot("ur5e").held({"wrist_3_joint": 1.0}).closed_form == "three parallel axes"


def test_arms_of_fewer_joints():
    row = ws.DHRow
    scara = [row(a=0.3, d=0.4), row(a=0.25, alpha_deg=180), row(joint="prismatic", limits=(0, 0.2)), row(d=0.05)]
    quill = [*scara[:2], row(), row(joint="prismatic", limits=(0, 0.2))]
    planar = [row(a=0.3), row(a=0.2), row(a=0.1)]
    for rows, name in ((scara, "SCARA"), (quill, "SCARA"), (planar, "planar arm")):
        table = ws.DHTable(convention="standard", rows=tuple(rows), name="arm")
        assert ws.load_robot(table).closed_form == name


def test_coupled_joints_and_arms_of_other_kinds_have_none():
    row = ws.DHRow
    offset_wrist = [row(alpha_deg=90, a=0.1, d=0.1 * k) for k in range(6)]
    assert ws.load_robot(ws.DHTable(convention="standard", rows=tuple(offset_wrist), name="arm")).closed_form is None
    chain = ws.load_robot("ur5e").chain
    assert class_of(replace(chain, joint_scale=np.array([1.0, 1, 1, 1, 1, 2]))) is None
    assert class_of(replace(chain, joint_source=np.array([0, 1, 2, 3, 4, 4]))) is None


def along(chain, kind="pose"):
    form = FreeJointForm.of(chain, kind)
    return form and form.name.removeprefix("ball search along ")


def test_searches_along_a_free_joint():
    """At either end, before two joints related so that one equation holds the third alone, and an orthogonal wrist."""
    for kind, told in zip(RELATIONS[:2], ("intersecting", "parallel"), strict=True):
        arm = redundant_arm(kind, 1)
        assert along(arm) == f"joint 1 over a closed form (spherical wrist, axes 2 and 3 {told})"
        assert along(reversed_chain(arm)) == f"joint 7 over a closed form (spherical shoulder, axes 6 and 5 {told})"
        assert along(shifted(arm, 5, 4e-6, beside=6)) is None
        assert along(tilted(arm, 5, 1e-6)) is None
        assert along(replace(arm, joint_scale=np.array([1.0, 1, 1, 1, 1, 1, 2]))) is None
        railed = replace(arm, joint_is_revolute=np.arange(7) > 0)
        assert along(railed) == along(arm)
        endless = np.where(np.arange(7) > 0, arm.upper_limits, np.inf)
        assert along(replace(railed, lower_limits=-endless, upper_limits=endless)) is None
        assert along(replace(arm, joint_is_revolute=np.arange(7) != 2)) is None
    for kind in RELATIONS[2:]:
        assert along(redundant_arm(kind, 1)) is None
    panda = ws.load_robot("franka_panda")
    assert along(panda.held({panda.joint_names[1]: 0.4}).chain) is None
    assert along(ws.load_robot("ur5e").chain) is None
    joint = along(replace(panda.held({panda.joint_names[6]: 0.4}).chain), "axis")
    assert joint == "the turn about the tip's axis over a closed form (spherical shoulder, axes 6 and 5 intersecting)"
