"""Robots of the library as a user would write them: Python classes with NumPy kinematics."""

import numpy as np

from tests.reference.published_robots import dh_table


class DHClass:
    """The first ``joints`` of a modified Denavit–Hartenberg table, many configurations at a time."""

    def __init__(self, name, joints=None):
        self.name, self.rows = f"{name} in Python", dh_table(name).rows[:joints]
        self.limits = [row.limits for row in self.rows]

    def forward_kinematics(self, q):
        T = np.tile(np.eye(4), (len(q), 1, 1))
        for row, value in zip(self.rows, q.T, strict=True):
            turned, slid = (0, value) if row.joint == "prismatic" else (value, 0)
            c, s, d = np.cos(row.theta + turned), np.sin(row.theta + turned), row.d + slid
            ca, sa = np.cos(row.alpha), np.sin(row.alpha)
            step = np.zeros((len(q), 4, 4))
            step[:, 0, 0], step[:, 0, 1], step[:, 0, 3] = c, -s, row.a
            step[:, 1, 0], step[:, 1, 1], step[:, 1, 2], step[:, 1, 3] = s * ca, c * ca, -sa, -sa * d
            step[:, 2, 0], step[:, 2, 1], step[:, 2, 2], step[:, 2, 3] = s * sa, c * sa, ca, ca * d
            step[:, 3, 3] = 1
            T = T @ step
        return T


class SphericalClass:
    """The first three joints of the library's spherical arm, in closed form, with their Jacobian."""

    limits = (np.radians((-45, 45)), np.radians((45, 135)), (0.2, 0.4))

    def forward_kinematics(self, q):
        (c1, c2), (s1, s2), zero = np.cos(q[:, :2].T), np.sin(q[:, :2].T), np.zeros(len(q))
        x, y, z = np.array([c1 * c2, s1 * c2, s2]), np.array([-s1, c1, zero]), np.array([-c1 * s2, -s1 * s2, c2])
        T = np.tile(np.eye(4), (len(q), 1, 1))
        T[:, :3] = np.stack([x, y, z, q[:, 2] * z], axis=2).transpose(1, 0, 2)
        return T

    def jacobian(self, q):
        T, d = self.forward_kinematics(q), q[:, 2:]
        x, y, z = T[:, :3, 0], T[:, :3, 1], T[:, :3, 2]
        J = np.zeros((len(q), 6, 3))
        J[:, 0, 0], J[:, 1, 0], J[:, 5, 0] = -T[:, 1, 3], T[:, 0, 3], 1
        J[:, :3, 1], J[:, 3:, 1] = -d * x, -y
        J[:, :3, 2] = z
        return J


class FourBar:
    """A point driven through a linkage that opens no farther than 60°: beyond its limits it has no pose."""

    limits = ((-np.pi / 3, np.pi / 3), (0.1, 0.4))

    def forward_kinematics(self, q):
        angle = np.arcsin(np.sin(q[:, 0]) / np.sin(np.radians(61)))
        angle[np.abs(q[:, 0]) > np.radians(61)] = np.nan
        T = np.tile(np.eye(4), (len(q), 1, 1))
        T[:, 0, 0], T[:, 0, 1], T[:, 0, 3] = np.cos(angle), -np.sin(angle), q[:, 1] * np.cos(angle)
        T[:, 1, 0], T[:, 1, 1], T[:, 1, 3] = np.sin(angle), np.cos(angle), q[:, 1] * np.sin(angle)
        return T
