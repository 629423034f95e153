"""Denavit–Hartenberg tables of industrial arms, as others publish them, to compare library robots with.

Modified ones (Craig 1986) are of robotkinematicscatalogue 1.1.2, standard ones of ir-support-extra-robots 0.2.1 (both
on PyPI). Lengths in mm, angles in quarter turns; ``signs`` says which joints turn the other way, ``base`` adds a height
that a table leaves out. The last row's angle is the one that gives this library's tool, z out of the flange.
"""

from dataclasses import dataclass

import numpy as np

ABB, FANUC, KUKA = (1, 1, 1, 1, 1, 1), (1, 1, -1, -1, -1, -1), (-1, 1, 1, -1, 1, -1)  # Yaskawa's are FANUC's


@dataclass(frozen=True)
class PublishedTable:
    """Rows α, a, d, θ; ``modified``: α and a are of the joint before."""

    rows: tuple[tuple[float, float, float, float], ...]
    signs: tuple[int, ...]
    base: float = 0.0  # [mm]
    modified: bool = True

    def poses(self, q: np.ndarray) -> np.ndarray:
        """Poses (N, 4, 4) of the last frame at joint angles (N, 6) [rad], lengths in m."""
        T = np.tile(np.eye(4), (len(q), 1, 1))
        T[:, 2, 3] = self.base / 1000
        for k, (alpha, a, d, theta) in enumerate(self.rows):
            link, joint = _screw(0, alpha, a), _screw(2, theta * np.pi / 2 + self.signs[k] * q[:, k], d, quarters=False)
            T = T @ link @ joint if self.modified else T @ joint @ link
        return T


def _screw(axis: int, angle, shift: float, quarters: bool = True) -> np.ndarray:
    """Turns about an axis of the frame, and a shift along it [mm]."""
    angles = np.atleast_1d(np.asarray(angle, dtype=float) * (np.pi / 2 if quarters else 1.0))
    i, j = (axis + 1) % 3, (axis + 2) % 3
    T = np.tile(np.eye(4), (len(angles), 1, 1))
    T[:, i, i] = T[:, j, j] = np.cos(angles)
    T[:, j, i] = np.sin(angles)
    T[:, i, j] = -T[:, j, i]
    T[:, axis, 3] = shift / 1000
    return T


def _kuka(d1: float, a1: float, a2: float, a3: float, d4: float, d6: float) -> PublishedTable:
    rows = ((0, 0, d1, 0), (-1, a1, 0, 0), (0, a2, 0, -1), (-1, a3, d4, 0), (1, 0, 0, 0), (-1, 0, d6, 2))
    return PublishedTable(rows, KUKA)


def _upright(lengths: tuple[float, ...], signs: tuple[int, ...], base: float = 0.0) -> PublishedTable:
    """Of arms whose upper arm stands at zero: d1, a1, a2, a3, d4, d5, a5, d6, and how far the flange is turned."""
    d1, a1, a2, a3, d4, d5, a5, d6, turned = lengths
    rows = ((0, 0, d1, 0), (-1, a1, 0, -1), (0, a2, 0, 0), (-1, a3, d4, 0), (1, 0, d5, 0), (-1, a5, d6, turned))
    return PublishedTable(rows, signs, base)


def _ur(d1: float, a2: float, a3: float, d4: float, d5: float, d6: float) -> PublishedTable:
    """UR's own table, as the Robotics Toolbox for Python has it, from ROS's `base_link`, turned by 180° about z."""
    rows = ((1, 0, d1, 2), (0, -a2, 0, 0), (0, -a3, 0, 0), (1, 0, d4, 0), (-1, 0, d5, 0), (0, 0, d6, 0))
    return PublishedTable(rows, (1,) * 6, modified=False)


# Of the Robotics Toolbox for Python, after Layeghi 2017; its last frame is 0.75 mm inside the hand.
SAWYER = PublishedTable(
    (
        (-1, 81, 317, 0),
        (-1, 0, 192.5, -1),
        (-1, 0, 400, 0),
        (-1, 0, 168.5, 2),
        (-1, 0, 400, 0),
        (-1, 0, 136.3, 2),
        (0, 0, 133.75, 0),
    ),
    (1, 1, 1, -1, 1, 1, 1),
    modified=False,
)
# Of N. Ramezani Taghiabadi's PR2_kinematics.py, 2012: from the shoulder to the centre of the wrist.
PR2 = PublishedTable(
    (
        (-1, 100, 0, 0),
        (1, 0, 0, 1),
        (-1, 0, 400, 0),
        (1, 0, 0, 0),
        (-1, 0, 321, 0),
        (1, 0, 0, 0),
        (0, 0, 0, 0),
    ),
    (1, 1, 1, 1, 1, 1, 1),
    modified=False,
)

# UFACTORY's own, of the xArm 5 (xarm-5-lite.md of github.com/xArm-Developer/ufactory_doc_usermanual), whose offsets are
# the angles of the diagonals of its links.
UPPER_ARM, FOREARM = complex(53.5, 284.5), complex(77.5, 342.5)
UPPER_TURN, FORE_TURN = np.angle(UPPER_ARM) / (np.pi / 2), np.angle(FOREARM) / (np.pi / 2)
XARM5 = PublishedTable(
    (
        (-1, 0, 267, 0),
        (0, abs(UPPER_ARM), 0, -UPPER_TURN),
        (0, abs(FOREARM), 0, UPPER_TURN + FORE_TURN),
        (-1, 76, 0, -FORE_TURN),
        (0, 0, 97, 0),
    ),
    (1, 1, 1, 1, 1),
    modified=False,
)

TABLES: dict[str, PublishedTable] = {
    "abb_crb15000_5_95": _upright((265, 0, 444, 110, 470, 0, 80, 101, 2), ABB),
    "abb_irb1200_5_90": _upright((399, 0, 448, 42, 451, 0, 0, 82, 2), ABB, base=0.1),
    "abb_irb2600_12_165": _upright((445, 150, 700, 115, 795, 0, 0, 85, 2), ABB),
    "denso_vs060": PublishedTable(
        ((0, 0, 345, 0), (-1, 0, 0, -1), (0, 305, 0, -1), (-1, 10, 300, 0), (1, 0, 0, 0), (-1, 0, 70, 2)), ABB
    ),
    "doosan_a0509": PublishedTable(
        ((0, 0, 155.5, 0), (-1, 0, 0, -1), (0, 409, 0, -1), (-1, 0, 367, 0), (1, 0, 0, 0), (-1, 0, 124, 2)), ABB
    ),
    "kuka_kr10_r1100_sixx": _kuka(400, 25, 560, 35, 515, 80),
    "kuka_kr3_r540": _kuka(345, 20, 260, 20, 260, 75),
    "kuka_kr16_2": _kuka(675, 260, 680, -35, 670, 158),
    "kuka_kr6_r700_sixx": _kuka(400, 25, 315, 35, 365, 80),
    "mitsubishi_rv2fr": PublishedTable(
        ((0, 0, 295, 0), (-1, 0, 0, -1), (0, 230, 0, -1), (-1, 50, 270, 0), (1, 0, 0, 0), (-1, 0, 70, 2)), ABB
    ),
    "ur10": _ur(127.3, 612, 572.3, 163.941, 115.7, 92.2),
    "ur3": _ur(151.9, 243.65, 213.25, 112.35, 85.35, 81.9),
    "xarm5": XARM5,
    "yaskawa_gp12": _upright((0, 155, 614, 200, 640, 0, 0, 100, 0), FANUC, base=450),
    "yaskawa_gp4": _upright((0, 0, 260, 15, 290, 0, 0, 72, 0), FANUC, base=330),
    "yaskawa_hc20": _upright((380, 0, 820, 0, 880, 0, 0, 200, 0), FANUC),
    "yaskawa_gp7": _upright((0, 40, 445, 40, 440, 0, 0, 80, 0), FANUC, base=330),
    "yaskawa_hc10dtp": PublishedTable(
        ((1, 0, 275, 0), (0, 700, 0, 1), (1, 0, 0, 0), (1, 0, 500, 0), (-1, 0, 162, 0), (0, 0, 170, 0)),
        (1, -1, 1, -1, -1, -1),
        modified=False,
    ),
}
