"""Industrial arms reach as far as their makers say, measured as they measure it: a number that no URDF repeats."""

import mujoco
import numpy as np
import pytest
from scipy.optimize import minimize

from wsrender.robots import library

# Body and point in it [m] whose greatest distance from the first axis is the reach: the wrist's centre unless said.
POINTS = {
    "abb_crb15000_5_95": ("link4", (0.47, 0.0, 0.08)),  # axis 6 over axis 5, the wrist not turned
    "abb_irb120": ("link5", (0.0, 0.0, 0.0)),
    "abb_irb1200_5_90": ("link5", (0.0, 0.0, 0.0)),
    "denso_vs060": ("link5", (0.0, 0.0, 0.0)),
    "doosan_a0509": ("link_6", (0.0, 0.0, 0.0)),  # the flange
    "doosan_m0609": ("link_6", (0.0, 0.0, 0.0)),  # the flange
    "doosan_m1013": ("link_6", (0.0, 0.0, 0.0)),  # the flange
    "fanuc_crx10ia": ("link3", (0.7, -0.15, 0.0)),  # the flange, the wrist stretched
    "fanuc_crx10ia_l": ("link3", (0.7, -0.15, 0.0)),  # the flange, the wrist stretched
    "fanuc_crx5ia": ("link3", (0.575, -0.13, 0.0)),  # the flange, the wrist stretched
    "fanuc_lrmate200id": ("link5", (0.0, 0.0, 0.0)),
    "kuka_kr10_r1100_sixx": ("link5", (0.0, 0.0, 0.0)),
    "kuka_kr16_2": ("link5", (0.0, 0.0, 0.0)),
    "kuka_kr3_r540": ("link5", (0.0, 0.0, 0.0)),
    "kuka_kr6_r700_sixx": ("link5", (0.0, 0.0, 0.0)),
    "kuka_kr6_r900_sixx": ("link5", (0.0, 0.0, 0.0)),
    "yaskawa_gp12": ("link_5_b", (0.0, 0.0, 0.0)),
    "yaskawa_gp4": ("link_5_b", (0.0, 0.0, 0.0)),
    "yaskawa_gp7": ("link5", (0.0, 0.0, 0.0)),
    "yaskawa_hc10dtp": ("link4", (0.0, 0.0, 0.0)),
    "yaskawa_hc20": ("link_5_b", (0.0, 0.0, 0.0)),
}


@pytest.mark.parametrize("name", POINTS)
def test_the_reach_is_the_makers_to_a_millimetre(name):
    model = mujoco.MjModel.from_xml_path(str(library.find(name)))
    data, (body, point) = mujoco.MjData(model), POINTS[name]

    def nearness(q):
        data.qpos[:] = np.concatenate([[0.0], q])
        mujoco.mj_kinematics(model, data)
        x, y, _ = data.body(body).xpos + data.body(body).xmat.reshape(3, 3) @ point
        return -np.hypot(x, y)

    ranges, generator = model.jnt_range[1:], np.random.default_rng(1)
    tries = [minimize(nearness, q, bounds=ranges).fun for q in generator.uniform(*ranges.T, (8, len(ranges)))]
    said = next(robot.reach_m for robot in library.describe() if robot.name == name)
    assert -min(tries) == pytest.approx(said, abs=1e-3)
