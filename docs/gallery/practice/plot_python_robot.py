"""
Can a robot be a Python class?
==============================

Limits and a forward kinematics are enough: here a positioner that lifts as it turns, like a screw.
"""

import numpy as np

import wsrender as ws


class Screw:
    """A turn about z which also lifts, a slide outwards, and a slide upwards."""

    limits = np.array([[-3.0, 3.0], [0.2, 0.6], [0.0, 0.3]])

    def forward_kinematics(self, q):
        """Poses (N, 4, 4) of configurations (N, 3)."""
        poses = np.tile(np.eye(4), (len(q), 1, 1))
        cosine, sine = np.cos(q[:, 0]), np.sin(q[:, 0])
        poses[:, 0, 0], poses[:, 0, 1], poses[:, 1, 0], poses[:, 1, 1] = cosine, -sine, sine, cosine
        poses[:, 0, 3], poses[:, 1, 3], poses[:, 2, 3] = q[:, 1] * cosine, q[:, 1] * sine, 0.1 * q[:, 0] + q[:, 2]
        return poses


result = ws.analyze(Screw(), ws.Grid(40), ["manipulability"], refined_volume=None, device="cpu")
print(result.summary())

# Picture: The sampled positions: a helical ramp of some thickness, brighter far from its axis.
result.plot.scatter()
