"""Inverse kinematics in closed form, float64: every configuration within the limits that gives a pose.

Arms with a spherical wrist (Pieper 1968) and the UR family (Hawkins, *Analytic inverse kinematics for the Universal
Robots*, 2013). Solutions come as (N, S, n) with NaN where there is none.
"""

import numpy as np

from tests.reference.dh_product import step
from tests.reference.published_robots import dh_table


def shoulder_elbow(positions, *, offset=0.0, upper, elbow, lower, turned):
    """Joints 1 to 3 (N, 4, 3) of a vertical first axis and two parallel horizontal ones.

    ``offset``: of the arm's plane along its normal; ``upper``: distance of axes 2 and 3; (``elbow``, ``lower``): the
    point in the frame of joint 3; ``turned``: twist of joint 2 against joint 1, ±1 quarter.
    """
    x, y, z = positions.T
    found = []
    for side in (1.0, -1.0):
        u = side * np.sqrt(x**2 + y**2 - offset**2)
        # The plane's normal, y of frame 1, is turned with joint 2's axis.
        q1 = np.arctan2(y, x) - np.arctan2(-turned * offset, u)
        C = (u**2 + z**2 - upper**2 - elbow**2 - lower**2) / (2 * upper)
        for bend in (1.0, -1.0):
            q3 = np.arctan2(-lower, elbow) + bend * np.arccos(C / np.hypot(elbow, lower))
            px = upper + np.cos(q3) * elbow - np.sin(q3) * lower
            py = np.sin(q3) * elbow + np.cos(q3) * lower
            q2 = np.arctan2(turned * z, u) - np.arctan2(py, px)
            found.append(np.stack([q1, q2, q3], axis=1))
    return np.stack(found, axis=1)


def puma560_arm(positions):
    """Joints 1 to 3 (N, 4, 3) of the puma560 for wrist positions (N, 3)."""
    return shoulder_elbow(positions, offset=0.2435 - 0.0934, upper=0.4318, elbow=-0.0203, lower=-0.4331, turned=-1)


def articulated_arm(positions):
    """Joints 1 to 3 (N, 4, 3) of the articulated robot."""
    return shoulder_elbow(positions, upper=0.2, elbow=0.2, lower=0.0, turned=1)


def spherical_arm(positions):
    """Joints 1 to 3 (N, 2, 3) of the spherical robot: modified rows (0,0,0,v)(0,90,0,v)(0,-90,v,0)."""
    x, y, z = positions.T
    found = []
    for side in (1.0, -1.0):
        # The slide points along -sin(q2) in the plane of joint 1, and cos(q2) upwards.
        r = np.linalg.norm(positions, axis=1)
        q1 = np.arctan2(-side * y, -side * x)
        q2 = np.arctan2(side * np.hypot(x, y), z)
        found.append(np.stack([q1, q2, r], axis=1))
    return np.stack(found, axis=1)


def with_spherical_wrist(name, arm, rotations):
    """All configurations (N, 2 S, 6) whose wrist angles are the last three DH rows (·, α4, ·), (0,∓90,0), (0,±90,0)."""
    rows = dh_table(name).rows
    found = []
    for s in range(arm.shape[1]):
        R = np.tile(np.eye(3), (len(arm), 1, 1))
        for row, value in zip(rows[:3], arm[:, s].T, strict=True):
            R = R @ np.array([_turned(row, v) for v in value])
        # What is left: Rx(α4) Rz(q4) Rx(α5) Rz(q5) Rx(α6) Rz(q6) with α6 = -α5.
        W = _twist(rows[3].alpha).T @ R.transpose(0, 2, 1) @ rotations
        sign = np.sign(rows[4].alpha)
        for side in (1.0, -1.0):
            q5 = side * np.arctan2(np.hypot(W[:, 0, 2], W[:, 1, 2]), W[:, 2, 2])
            q4 = np.arctan2(-sign * side * W[:, 1, 2], -sign * side * W[:, 0, 2])
            q6 = np.arctan2(-sign * side * W[:, 2, 1], sign * side * W[:, 2, 0])
            found.append(np.column_stack([arm[:, s], q4, q5, q6]))
    return np.stack(found, axis=1)


def _twist(alpha):
    return step("modified", 0.0, alpha, 0.0, 0.0)[:3, :3]


def _turned(row, value):
    turn = value if row.joint == "revolute" else 0.0
    return step("modified", 0.0, row.alpha, 0.0, row.theta + turn)[:3, :3]


def ur5e(positions, rotations):
    """All configurations (N, 8, 6) of the ur5e."""
    rows = dh_table("ur5e").rows
    d1, a2, a3, d4, d5, d6 = rows[0].d, rows[1].a, rows[2].a, rows[3].d, rows[4].d, rows[5].d
    R, p = rotations, positions
    wrist = p - d6 * R[:, :, 2]
    found = []
    for shoulder in (1.0, -1.0):
        r = np.hypot(wrist[:, 0], wrist[:, 1])
        q1 = np.arctan2(wrist[:, 1], wrist[:, 0]) + shoulder * np.arccos(d4 / r) + np.pi / 2
        s1, c1 = np.sin(q1), np.cos(q1)
        for flip in (1.0, -1.0):
            q5 = flip * np.arccos((p[:, 0] * s1 - p[:, 1] * c1 - d4) / d6)
            s5 = np.sin(q5)
            q6 = np.arctan2((-R[:, 0, 1] * s1 + R[:, 1, 1] * c1) / s5, (R[:, 0, 0] * s1 - R[:, 1, 0] * c1) / s5)
            T = np.tile(np.eye(4), (len(p), 1, 1))
            T[:, :3, :3], T[:, :3, 3] = R, p
            T14 = _inverse(_standard(rows[0], q1)) @ T @ _inverse(_standard(rows[4], q5) @ _standard(rows[5], q6))
            p13 = (T14 @ np.array([0, -d4, 0, 1.0]))[:, :3]
            size = np.hypot(p13[:, 0], p13[:, 1])
            for elbow in (1.0, -1.0):
                q3 = elbow * np.arccos((size**2 - a2**2 - a3**2) / (2 * a2 * a3))
                q2 = np.arctan2(p13[:, 1], p13[:, 0]) - np.arctan2(a3 * np.sin(q3), a2 + a3 * np.cos(q3))
                T34 = _inverse(_standard(rows[1], q2) @ _standard(rows[2], q3)) @ T14
                q4 = np.arctan2(T34[:, 1, 0], T34[:, 0, 0])
                found.append(np.stack([q1, q2, q3, q4, q5, q6], axis=1))
    assert d1 and d5  # inside the products
    return np.stack(found, axis=1)


def _standard(row, values):
    at_zero, T = step("standard", row.a, row.alpha, row.d, row.theta), np.tile(np.eye(4), (len(values), 1, 1))
    T[:, 0, 0] = T[:, 1, 1] = np.cos(values)
    T[:, 1, 0] = np.sin(values)
    T[:, 0, 1] = -T[:, 1, 0]
    return T @ at_zero


def _inverse(T):
    return np.linalg.inv(T)


def within_limits(solutions, lower, upper, revolute):
    """Which solutions (N, S, n), or the same a whole number of turns away, lie within the limits (n,), (N, S) bool."""
    with np.errstate(invalid="ignore"):
        turns = np.where(revolute, np.ceil((lower - solutions) / (2 * np.pi)) * 2 * np.pi, 0.0)
        first = solutions + turns
        return ((first >= lower) & (first <= upper)).all(axis=2)
