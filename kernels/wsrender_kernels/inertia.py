"""Joint-space inertia matrix by the composite rigid body method.

Featherstone, *Rigid Body Dynamics Algorithms*, 2008, chapter 6.

Composite inertias are taken about each joint's own origin in world axes: about the base, float32 would lose the
small inertias of the last links.
"""

from functools import cache
from types import SimpleNamespace

import numpy as np
import warp as wp

from wsrender_kernels.kinematics import JOINT_STRIDE, device_joint_frames, kinematics

BODY_STRIDE = 11  # mass, first moment xyz, inertia about the joint origin xx yy zz xy xz yz, armature


def pack_inertia(T_joint, mass, center_of_mass, inertia, armature) -> np.ndarray:
    """Body constants as a flat float64 array, shape (L * BODY_STRIDE,).

    ``mass`` (L,), ``center_of_mass`` (L, 3), ``inertia`` (L, 3, 3) about the centre of mass, ``armature`` (L,), in
    the joint frames (``T_joint``, (L, 4, 4)) of the Chain.
    """
    rows = []
    frames = device_joint_frames(T_joint)
    for m, c, inertia_c, a, R in zip(mass, center_of_mass, inertia, armature, frames, strict=True):
        c = R @ c
        about_origin = R @ inertia_c @ R.T + m * (c @ c * np.eye(3) - np.outer(c, c))
        (xx, xy, xz), (_, yy, yz), (_, _, zz) = about_origin
        rows += [m, *(m * c), xx, yy, zz, xy, xz, yz, a]
    return np.array(rows)


@cache
def inertia(real, n: int, sources: tuple[int, ...]) -> SimpleNamespace:
    """Device functions ``inertia_matrix(chain, bodies, levers, X, Y, Z) -> (n, n)`` and ``solve(M, A) -> A M^-1``."""
    L = len(sources)
    SOURCE = wp.types.vector(L, wp.int32)(*sources)
    CHAIN = JOINT_STRIDE
    BODY = BODY_STRIDE
    kin = kinematics(real, n, sources)
    vec3 = kin.vec3
    mat33 = wp.types.matrix((3, 3), real)
    axes_type = wp.types.matrix((L, 3), real)
    joint_inertia_type = wp.types.matrix((n, n), real)
    ZERO, ONE, TWO = real(0.0), real(1.0), real(2.0)

    @wp.func
    def rotated(R: mat33, bodies: wp.array(dtype=real), b: wp.int32):
        xx = bodies[b + 4]
        yy = bodies[b + 5]
        zz = bodies[b + 6]
        xy = bodies[b + 7]
        xz = bodies[b + 8]
        yz = bodies[b + 9]
        local = mat33(xx, xy, xz, xy, yy, yz, xz, yz, zz)
        return R * local * wp.transpose(R)

    @wp.func
    def shifted(about: mat33, m: real, h: vec3, d: vec3):
        # Parallel axis theorem for a first moment h about the old origin, which lies at d from the new one.
        s = m * wp.dot(d, d) + TWO * wp.dot(h, d)
        out = mat33()
        for r in range(3):
            for c in range(3):
                out[r, c] = about[r, c] - m * d[r] * d[c] - h[r] * d[c] - d[r] * h[c]
            out[r, r] += s
        return out

    @wp.func
    def inertia_matrix(
        chain: wp.array(dtype=real),
        bodies: wp.array(dtype=real),
        levers: axes_type,
        X: axes_type,
        Y: axes_type,
        Z: axes_type,
    ):
        M = joint_inertia_type()
        to_tip = axes_type()
        for i in range(L):
            to_tip[i] = X[i] * levers[i, 0] + Y[i] * levers[i, 1] + Z[i] * levers[i, 2]
        m = ZERO
        h = vec3()
        composite = mat33()
        for back in range(L):
            i = L - 1 - back
            b = i * BODY
            x = X[i]
            y = Y[i]
            z = Z[i]
            o = to_tip[i]
            if back > 0:
                d = o - to_tip[wp.min(i + 1, L - 1)]
                composite = shifted(composite, m, h, d)
                h = h + d * m
            R = mat33(x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2])
            composite = composite + rotated(R, bodies, b)
            h = h + x * bodies[b + 1] + y * bodies[b + 2] + z * bodies[b + 3]
            m = m + bodies[b]
            angle = chain[i * CHAIN + 7]
            slide = chain[i * CHAIN + 8]
            momentum = wp.cross(z, h) * angle + z * (m * slide)
            moment = (composite * z) * angle + wp.cross(h, z) * slide
            for j in range(i + 1):
                zj = Z[j]
                value = (
                    wp.dot(zj, moment + wp.cross(to_tip[j] - o, momentum)) * chain[j * CHAIN + 7]
                    + wp.dot(zj, momentum) * chain[j * CHAIN + 8]
                )
                M[SOURCE[i], SOURCE[j]] += value
                if j != i:
                    M[SOURCE[j], SOURCE[i]] += value
            scale = angle + slide
            M[SOURCE[i], SOURCE[i]] += bodies[b + 10] * scale * scale
        return M

    @cache
    def solve(m_rows: int):
        rows_type = wp.types.matrix((m_rows, n), real)

        @wp.func
        def solve_rows(M: joint_inertia_type, A: rows_type):
            # L D L^T of M in place, then the rows of A M^-1, M being symmetric.
            F = M
            for j in range(n):
                for k in range(j):
                    F[j, j] -= F[j, k] * F[j, k] * F[k, k]
                inverse = ONE / F[j, j]
                for i in range(j + 1, n):
                    for k in range(j):
                        F[i, j] -= F[i, k] * F[j, k] * F[k, k]
                    F[i, j] *= inverse
            out = A
            for r in range(m_rows):
                for i in range(n):
                    for k in range(i):
                        out[r, i] -= F[i, k] * out[r, k]
                for i in range(n):
                    out[r, i] /= F[i, i]
                for back in range(n):
                    for k in range(n - back, n):
                        out[r, n - 1 - back] -= F[k, n - 1 - back] * out[r, k]
            return out

        return solve_rows

    return SimpleNamespace(inertia_matrix=inertia_matrix, solve=solve, joint_inertia_type=joint_inertia_type)
