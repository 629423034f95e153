"""Home poses and screw axes of arms by Trossen Robotics, as their specifications have them.

github.com/TrossenRobotics/interbotix_xsarms_docs, ``docs/specifications``: at home every arm is stretched forward. The
pose is that of `ee_gripper_link`, between the fingers.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class PublishedScrews:
    """Where the end effector is at home (x, z), and the axes that turn about y (z, x); the last turns about x.

    All in m. ``gripper_m`` is how far `gripper_link` is behind the end effector, by the URDF.
    """

    home: tuple[float, float]
    about_y: tuple[tuple[float, float], ...]
    gripper_m: float
    rolls: bool = True

    def poses(self, q: np.ndarray) -> np.ndarray:
        """Poses (N, 4, 4) of `gripper_link` at joint angles (N, n) [rad]: a product of exponentials (Brockett 1984)."""
        x, z = self.home
        T = _turns(2, q[:, 0], (0.0, 0.0, 0.0))
        for k, (height, place) in enumerate(self.about_y, 1):
            T = T @ _turns(1, q[:, k], (place, 0.0, height))
        if self.rolls:
            T = T @ _turns(0, q[:, -1], (0.0, 0.0, z))
        home = np.eye(4)
        home[:3, 3] = x - self.gripper_m, 0.0, z
        return T @ home


def _turns(axis: int, angles: np.ndarray, point: tuple[float, float, float]) -> np.ndarray:
    """Turns (N, 4, 4) by angles (N,) [rad] about an axis of the frame through a point [m]."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    T = np.tile(np.eye(4), (len(angles), 1, 1))
    T[:, i, i] = T[:, j, j] = np.cos(angles)
    T[:, j, i] = np.sin(angles)
    T[:, i, j] = -T[:, j, i]
    T[:, :3, 3] = point - T[:, :3, :3] @ np.array(point)
    return T


SCREWS: dict[str, PublishedScrews] = {
    "pincherx100": PublishedScrews(
        (0.248575, 0.1931), ((0.0931, 0.0), (0.1931, 0.035), (0.1931, 0.135)), 0.113575, rolls=False
    ),
    "pincherx150": PublishedScrews((0.358575, 0.25457), ((0.10457, 0.0), (0.25457, 0.05), (0.25457, 0.2)), 0.093575),
    "reactorx150": PublishedScrews((0.358575, 0.25457), ((0.10457, 0.0), (0.25457, 0.05), (0.25457, 0.2)), 0.093575),
    "reactorx200": PublishedScrews((0.408575, 0.30457), ((0.10457, 0.0), (0.30457, 0.05), (0.30457, 0.25)), 0.093575),
    "viperx250": PublishedScrews((0.468575, 0.37705), ((0.12705, 0.0), (0.37705, 0.06), (0.37705, 0.31)), 0.093575),
    "viperx300": PublishedScrews((0.536494, 0.42705), ((0.12705, 0.0), (0.42705, 0.05955), (0.42705, 0.35955)), 0.1072),
    "widowx200": PublishedScrews((0.408575, 0.31065), ((0.11065, 0.0), (0.31065, 0.05), (0.31065, 0.25)), 0.093575),
    "widowx250": PublishedScrews(
        (0.458325, 0.36065), ((0.11065, 0.0), (0.36065, 0.04975), (0.36065, 0.29975)), 0.093575
    ),
}
