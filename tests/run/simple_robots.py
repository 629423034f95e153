"""Robots whose workspaces and indices have closed forms."""

import numpy as np

import wsrender as ws

PLANAR = {"task": ["x", "y"], "indices": ["manipulability", "inverse_condition_number"], "device": "cpu"}
"""Options of a planar analysis; one kernel shape for all tests that use them."""


def planar_arm(l1=0.5, l2=0.4, **row):
    """2R arm; the elbow bends one way only, so that every point has one posture."""
    rows = [ws.DHRow(a=l1, limits_deg=(-180, 180)), ws.DHRow(a=l2, limits_deg=(0, 150), **row)]
    return ws.load_robot(ws.DHTable(convention="standard", rows=rows, name="planar"))


def gantry(x=(0.005, 0.295), y=(0.005, 0.395), z=(0.005, 0.195), **placing):
    """Three slides along z, -y and x of the base."""
    rows = [
        ws.DHRow(joint="prismatic", limits=z),
        ws.DHRow(joint="prismatic", alpha_deg=90, theta_deg=90, limits=y),
        ws.DHRow(joint="prismatic", alpha_deg=90, limits=x),
    ]
    return ws.load_robot(ws.DHTable(convention="modified", rows=rows, name="gantry"), **placing)


class PlanarClass:
    """The planar arm as a user would write it, Jacobian left to finite differences."""

    limits = ((-np.pi, np.pi), (0.0, np.radians(150)))
    lengths = (0.5, 0.4)

    def forward_kinematics(self, q):
        shoulder, elbow = q[:, 0], q[:, 0] + q[:, 1]
        T = np.tile(np.eye(4), (len(q), 1, 1))
        T[:, 0, 0], T[:, 0, 1] = np.cos(elbow), -np.sin(elbow)
        T[:, 1, 0], T[:, 1, 1] = np.sin(elbow), np.cos(elbow)
        T[:, 0, 3] = self.lengths[0] * np.cos(shoulder) + self.lengths[1] * np.cos(elbow)
        T[:, 1, 3] = self.lengths[0] * np.sin(shoulder) + self.lengths[1] * np.sin(elbow)
        return T


class PlanarClassWithMasses(PlanarClass):
    """The same with its own Jacobian and point masses m1, m2 at the ends of the links."""

    name = "planar with masses"
    joint_names = ("shoulder", "elbow")
    masses = (2.0, 1.0)

    def jacobian(self, q):
        (l1, l2), shoulder, elbow = self.lengths, q[:, 0], q[:, 0] + q[:, 1]
        J = np.zeros((len(q), 6, 2))
        J[:, 0, 1], J[:, 1, 1] = -l2 * np.sin(elbow), l2 * np.cos(elbow)
        J[:, 0, 0], J[:, 1, 0] = J[:, 0, 1] - l1 * np.sin(shoulder), J[:, 1, 1] + l1 * np.cos(shoulder)
        J[:, 5] = 1
        return J

    def inertia_matrix(self, q):
        (l1, l2), (m1, m2), c = self.lengths, self.masses, np.cos(q[:, 1])
        M = np.empty((len(q), 2, 2))
        M[:, 0, 0] = (m1 + m2) * l1**2 + m2 * l2**2 + 2 * m2 * l1 * l2 * c
        M[:, 0, 1] = M[:, 1, 0] = m2 * l2**2 + m2 * l1 * l2 * c
        M[:, 1, 1] = m2 * l2**2
        return M


def planar_arm_with_masses():
    """The library's way to say PlanarClassWithMasses."""
    rows = [
        ws.DHRow(a=0.5, limits_deg=(-180, 180), mass=2.0),
        ws.DHRow(a=0.4, limits_deg=(0, 150), mass=1.0),
    ]
    return ws.load_robot(ws.DHTable(convention="standard", rows=rows, name="planar"))
