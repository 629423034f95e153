"""Payloads and reaches of library robots are those of a public list of arms, which others filled from data sheets.

github.com/mdicicco/robot_arm_data, ``data/robot_arm_data.csv``: payload [kg] and reach [m], as it has them.
"""

import pytest

from wsrender.robots import library

ROBOTS = {robot.name: robot for robot in library.describe()}
LISTED = {
    "abb_crb15000_5_95": (5, 0.95),
    "abb_irb120": (3, 0.58),
    "abb_yumi_left_arm": (0.5, 0.559),
    "abb_yumi_right_arm": (0.5, 0.559),
    "baxter_left_arm": (2.2, 1.21),
    "baxter_right_arm": (2.2, 1.21),
    "denso_vs060": (4, 0.605),
    "doosan_m1013": (10, 1.3),
    "fanuc_crx10ia": (10, 1.24),
    "fanuc_crx10ia_l": (10, 1.42),
    "fanuc_lrmate200id": (7, 0.717),  # as the ARC Mate 50iD, the same arm
    "franka_panda": (3, 0.859),
    "kinova_gen3": (None, 0.902),
    "kinova_gen3_6dof": (None, 0.891),
    "kinova_gen3_lite": (0.5, 0.76),
    "kinova_j2s6s200": (None, 0.984),
    "kuka_iiwa14": (14, 0.82),
    "kuka_iiwa7": (7, 0.8),
    "kuka_kr10_r1100_sixx": (10, 1.101),
    "kuka_kr16_2": (16, 1.61),
    "kuka_kr3_r540": (3, 0.541),
    "kuka_kr6_r700_sixx": (6, 0.7067),
    "kuka_kr6_r900_sixx": (6, 0.9015),
    "lite6": (None, 0.44),
    "pincherx100": (0.05, 0.3),
    "pincherx150": (0.05, 0.45),
    "pr2_left_arm": (1.8, None),
    "pr2_right_arm": (1.8, None),
    "reactorx150": (0.1, 0.45),
    "reactorx200": (0.15, 0.55),
    "sawyer": (4, 1.26),
    "unitree_z1": (None, 0.74),
    "ur10": (10, 1.3),
    "ur10e": (None, 1.3),  # 12.5 kg since 2021, the list has 10
    "ur16e": (16, 0.9),
    "ur20": (20, 1.75),
    "ur3": (3, 0.5),
    "ur3e": (3, 0.5),
    "ur5": (5, 0.85),
    "ur5e": (5, 0.85),
    "viperx250": (0.45, 0.65),
    "viperx300": (0.75, 0.75),
    "viperx300s": (0.75, 0.75),
    "widowx200": (0.2, 0.55),
    "widowx250": (0.25, 0.65),
    "widowx250s": (0.25, 0.65),
    "xarm6": (5, 0.7),
    "xarm7": (3.5, 0.7),
    "yaskawa_gp7": (7, 0.927),
    "yaskawa_hc10dtp": (10, 1.2),  # as the HC10DT
    "yaskawa_hc20": (20, 1.7),  # as the HC20XP
}
STATED_ELSEWHERE = {  # payload and reach, or the first alone; the list has no such arm, or not this number
    "abb_irb1200_5_90",  # both are in its name
    "abb_irb2600_12_165",  # both are in its name
    "doosan_a0509",  # Open Robot Database (github.com/joernmalzahn/OpenRobotDatabase)
    "doosan_m0609",  # Open Robot Database
    "fanuc_crx5ia",  # 5 kg are in its name; the reach, to the flange, follows from its lengths
    "franka_fr3",  # those of the Panda
    "kinova_gen3_6dof",  # 2 kg over the whole range, continuously: Open Robot Database; the list has 3
    "kinova_gen3",  # 4 kg in mid range, continuously: Kinova's user guide of the Gen3; the list has 3
    "talos_left_arm",  # 6 kg by an arm stretched out: Stasse et al., Humanoids 2017
    "unitree_g1_left_arm",  # 3 kg of the G1 EDU: data/humanoid_robot_data.csv of the same repository
    "unitree_g1_right_arm",
    "ur10e",  # 12.5 kg: UR's user manual
    "ur30",  # 30 kg are in its name
    "xarm5",  # UFACTORY's comparison of xArm 5, 6 and 7
    "yaskawa_gp12",  # Open Robot Database
    "yaskawa_gp4",  # 4 kg are in its name; the reach follows from its lengths
}


@pytest.mark.parametrize("name", LISTED)
def test_payload_and_reach_are_the_listed_ones(name):
    payload, reach = LISTED[name]
    if payload is not None:
        assert ROBOTS[name].payload_kg == payload
    if reach is not None:
        assert ROBOTS[name].reach_m == pytest.approx(reach, rel=0.01)


def test_every_payload_and_reach_is_listed_or_stated_elsewhere():
    said = {name for name, robot in ROBOTS.items() if robot.payload_kg is not None or robot.reach_m is not None}
    payloads = {name for name, robot in ROBOTS.items() if robot.payload_kg is not None}
    assert said == set(LISTED) | STATED_ELSEWHERE
    assert payloads == {name for name, (payload, _) in LISTED.items() if payload is not None} | STATED_ELSEWHERE
