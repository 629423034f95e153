"""Denavit–Hartenberg products written out with 4×4 matrices, float64."""

import numpy as np


def rotation_x(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1.0, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]])


def rotation_z(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1.0, 0], [0, 0, 0, 1]])


def translation(x, z):
    T = np.eye(4)
    T[0, 3], T[2, 3] = x, z
    return T


def step(convention, a, alpha, d, theta):
    """(4, 4) of one row: modified Rx Tx Rz Tz, standard Rz Tz Tx Rx."""
    link, joint = rotation_x(alpha) @ translation(a, 0.0), rotation_z(theta) @ translation(0.0, d)
    return link @ joint if convention == "modified" else joint @ link


def frames(table, q):
    """(n, 4, 4) DH frames of a wsrender DHTable in its base frame at configuration q (n,)."""
    T, found = np.eye(4), []
    for row, value in zip(table.rows, q, strict=True):
        turn, slide = (value, 0.0) if row.joint == "revolute" else (0.0, value)
        T = T @ step(table.convention, row.a, row.alpha, row.d + slide, row.theta + turn)
        found.append(T)
    return np.array(found)


def joint_axes(table, q):
    """Points (n, 3) and directions (n, 3) of the joint axes in the base frame."""
    moved = frames(table, q)
    if table.convention == "standard":
        moved = np.concatenate([np.eye(4)[None], moved[:-1]])
    return moved[:, :3, 3], moved[:, :3, 2]


def inertia_matrix(table, q):
    """(n, n) joint-space inertia of a DHTable with masses: Σ m JᵥᵀJᵥ + JωᵀR I RᵀJω, plus armature."""
    n = len(table.rows)
    moved = frames(table, q)
    points, axes = joint_axes(table, q)
    M = np.diag([row.armature for row in table.rows]).astype(float)
    for k, row in enumerate(table.rows):
        R = moved[k, :3, :3]
        center = moved[k, :3, 3] + R @ np.array(row.center_of_mass)
        J = np.zeros((6, n))
        for i in range(k + 1):
            if table.rows[i].joint == "revolute":
                J[:3, i], J[3:, i] = np.cross(axes[i], center - points[i]), axes[i]
            else:
                J[:3, i] = axes[i]
        I = R @ row.inertia_matrix() @ R.T  # noqa: E741
        M += (row.mass or 0.0) * J[:3].T @ J[:3] + J[3:].T @ I @ J[3:]
    return M
