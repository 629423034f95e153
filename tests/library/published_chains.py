"""Chains of bodies, as models of others have them, to compare library robots with.

Of MuJoCo Menagerie (github.com/google-deepmind/mujoco_menagerie), of robosuite 1.5.2 (PyPI), and of models by makers:
places of bodies in the body before, and turns (w, x, y, z). Multiples of 45° among them, of which a source has six
digits, or writes 1.571 for a right angle, are made exact here.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

Body = tuple[tuple[float, float, float], tuple[float, float, float, float]]
UPRIGHT = (1.0, 0.0, 0.0, 0.0)
ENTRIES = np.array([-1.0, -np.sqrt(0.5), 0.0, np.sqrt(0.5), 1.0])  # of turns by multiples of 45°
NEAR = 5e-4  # how far those are from them as sources round them


@dataclass(frozen=True)
class PublishedChain:
    """Bodies, each of which turns about an axis of its own: z, unless ``axes`` has a letter for each. Lengths in m.

    ``base`` is where the first one is placed, ``tool`` a place in the last one.
    """

    bodies: tuple[Body, ...]
    tool: Body = ((0.0, 0.0, 0.0), UPRIGHT)
    base: Body = ((0.0, 0.0, 0.0), UPRIGHT)
    axes: str = ""
    zeros: tuple[float, ...] = ()  # angles of the source where the library's are zero [rad], where zeros differ

    def poses(self, q: np.ndarray) -> np.ndarray:
        """Poses (N, 4, 4) of the tool at joint angles (N, n) [rad]."""
        T, q = np.tile(_pose(*self.base), (len(q), 1, 1)), q + np.array(self.zeros or 0.0)
        for body, axis, angles in zip(self.bodies, self.axes or "z" * len(self.bodies), q.T, strict=True):
            turn = np.tile(np.eye(4), (len(q), 1, 1))
            turn[:, :3, :3] = Rotation.from_euler(axis, angles[:, None]).as_matrix()
            T = T @ _pose(*body) @ turn
        return T @ _pose(*self.tool)


def _pose(place: tuple[float, ...], turn: tuple[float, ...]) -> np.ndarray:
    T = np.eye(4)
    R = Rotation.from_quat(turn, scalar_first=True).as_matrix()
    exact = ENTRIES[np.abs(R[..., None] - ENTRIES).argmin(axis=-1)]
    T[:3, :3] = exact if np.abs(R - exact).max() < NEAR else R
    T[:3, 3] = place
    return T


def _baxter(side: int) -> PublishedChain:
    """robosuite's: 1 the left arm, -1 the right one."""
    shoulder, roll, bend = (0.707107, -0.707107, 0, 0), (0.5, 0.5, 0.5, 0.5), (0.5, -0.5, -0.5, -0.5)
    return PublishedChain(
        (
            ((0.055695, 0, 0.011038), UPRIGHT),
            ((0.069, 0, 0.27035), shoulder),
            ((0.102, 0, 0), roll),
            ((0.069, 0, 0.26242), bend),
            ((0.10359, 0, 0), roll),
            ((0.01, 0, 0.2707), bend),
            ((0.115975, 0, 0), roll),
        ),
        ((0, 0, 0.11355), UPRIGHT),
        ((0.024645, side * 0.219645, 0.118588), (0.923879, 0, 0, side * 0.382684)),
    )


def _g1(side: int) -> PublishedChain:
    """Menagerie's: 1 the left arm, -1 the right one, whose shoulder is 0.01 mm nearer."""
    return PublishedChain(
        (
            (
                (0.0039563, 0.10022 if side == 1 else -0.10021, 0.24778),
                (0.990264, side * 0.139201, 1.38722e-05, -side * 9.86868e-05),
            ),
            ((0, side * 0.038, -0.013831), (0.990268, -side * 0.139172, 0, 0)),
            ((0, side * 0.00624, -0.1032), UPRIGHT),
            ((0.015783, 0, -0.080518), UPRIGHT),
            ((0.1, side * 0.00188791, -0.01), UPRIGHT),
            ((0.038, 0, 0), UPRIGHT),
            ((0.046, 0, 0), UPRIGHT),
        ),
        axes="yxzyxyz",
    )


CHAINS: dict[str, PublishedChain] = {
    "doosan_m1013": PublishedChain(
        (
            ((0, 0, 0.1525), UPRIGHT),
            ((0, 0.0345, 0), (0.499898, -0.500102, -0.5, -0.5)),
            ((0.62, 0, 0), (0.707035, 0, 0, 0.707179)),
            ((0, -0.559, 0), (0.707035, 0.707179, 0, 0)),
            ((0, 0, 0), (0.707035, -0.707179, 0, 0)),
            ((0, -0.121, 0), (0.707035, 0.707179, 0, 0)),
        )
    ),
    "kinova_gen3_6dof": PublishedChain(  # GEN3-6DOF_NO-VISION_URDF_ARM_V01.urdf, which Kinova exported from CAD
        (
            ((0, 0, 0.15643), (0, 1, 0, 0)),
            ((0, 0.005375, -0.12838), (1, 1, 0, 0)),
            ((0, -0.41, 0), (0, 1, 0, 0)),
            ((0, 0.20843, -0.006375), (1, 1, 0, 0)),
            ((0, -0.00017505, -0.10593), (1, -1, 0, 0)),
            ((0, 0.10593, -0.00017505), (1, 1, 0, 0)),
        ),
        ((0, 0, -0.061525), (0, 0, 1, 0)),
    ),
    "lite6": PublishedChain(
        (
            ((0, 0, 0.2435), UPRIGHT),
            ((0, 0, 0), (-1, 1, 1, 1)),
            ((0.2002, 0, 0), (-2.59734e-06, -0.707105, -0.707108, -2.59735e-06)),
            ((0.087, -0.22761, 0), (0.707105, 0.707108, 0, 0)),
            ((0, 0, 0), (1, 1, 0, 0)),
            ((0, 0.0625, 0), (1, -1, 0, 0)),
        )
    ),
    "baxter_left_arm": _baxter(1),
    "baxter_right_arm": _baxter(-1),
    "so100": PublishedChain(
        (
            ((0, -0.0452, 0.0165), (0.707105, 0.707108, 0, 0)),
            ((0, 0.1025, 0.0306), (1, 1, 0, 0)),
            ((0, 0.11257, 0.028), (1, -1, 0, 0)),
            ((0, 0.0052, 0.1349), (1, -1, 0, 0)),
            ((0, -0.0601, 0), (1, 0, 1, 0)),
        ),
        axes="yxxxy",
        zeros=(0, -1.8 - np.pi / 2, np.pi, -1 + np.pi / 2, 0),
    ),
    "so101": PublishedChain(  # Simulation/SO101/so101_new_calib.xml by TheRobotStudio, out of Onshape
        (
            ((0.0388353, -8.97657e-09, 0.0624), (0, 0, -1, 0)),
            ((-0.0303992, -0.0182778, -0.0542), (0.5, -0.5, -0.5, -0.5)),
            ((-0.11257, -0.028, 0), (0.707107, 0, 0, 0.707107)),
            ((-0.1349, 0.0052, 0), (0.707107, 0, 0, -0.707107)),
            ((0, -0.0611, 0.0181), (0.0172091, -0.0172091, 0.706897, 0.706897)),
        )
    ),
    "unitree_g1_left_arm": _g1(1),
    "unitree_g1_right_arm": _g1(-1),
}
