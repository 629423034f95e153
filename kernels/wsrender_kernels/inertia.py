"""Joint-space inertia matrix by the composite rigid body method.

Featherstone, *Rigid Body Dynamics Algorithms*, 2008, chapter 6.

Composite inertias are taken about each joint's own origin, in its own frame: about the base, float32 would lose the
small inertias of the last links. Passing to the frame before costs a rotation about z, a slide along it, a rotation
about x and a shift whose constant part is packed with the links.
"""

from types import SimpleNamespace

import numpy as np
import warp as wp

from wsrender_kernels.factories import factory
from wsrender_kernels.kinematics import JOINT_STRIDE, chain_type, device_joint_frames, device_positions, kinematics

# Mass of the joint's link and all after it; of these, as if at the next joint's origin, with the link: first moment
# xyz and inertia xx yy zz xy xz yz about the joint's origin; armature.
BODY_STRIDE = 11


def pack_inertia(T_joint, mass, center_of_mass, inertia, armature) -> np.ndarray:
    """Body constants as a flat float64 array, shape (L * BODY_STRIDE,).

    ``mass`` (L,), ``center_of_mass`` (L, 3), ``inertia`` (L, 3, 3) about the centre of mass, ``armature`` (L,), in
    the joint frames (``T_joint``, (L, 4, 4)) of the Chain.
    """
    L = len(mass)
    frames, positions = device_joint_frames(T_joint), device_positions(T_joint)
    rows = []
    for i, R in enumerate(frames):
        after = float(np.sum(mass[i + 1 :]))
        p = positions[i + 1] if i + 1 < L else np.zeros(3)
        c = R @ center_of_mass[i]
        about_origin = R @ inertia[i] @ R.T + _of_point(mass[i], c) + _of_point(after, p)
        (xx, xy, xz), (_, yy, yz), (_, _, zz) = about_origin
        rows += [after + mass[i], *(mass[i] * c + after * p), xx, yy, zz, xy, xz, yz, armature[i]]
    return np.array(rows)


def _of_point(mass: float, at: np.ndarray) -> np.ndarray:
    return mass * (at @ at * np.eye(3) - np.outer(at, at))


@factory
def inertia(real, n: int, sources: tuple[int, ...], plain: bool, world: bool) -> SimpleNamespace:
    """Device functions ``inertia_matrix(chain, bodies, frames) -> (n, n)`` and ``solve(m)``: (M, A (m, n)) -> A M^-1.

    ``frames``, ``plain`` and ``world`` as in `kinematics`.
    """
    L = len(sources)
    LAST = L - 1
    SOURCE = wp.types.vector(L, wp.int32)(*sources)
    CHAIN = JOINT_STRIDE
    BODY = BODY_STRIDE
    kin = kinematics(real, n, sources, plain, world)
    vec3, Frames = kin.vec3, kin.Frames
    axes_type = wp.types.matrix((L, 3), real)
    sym3 = wp.types.vector(6, real)  # xx yy zz xy xz yz
    joint_inertia_type = wp.types.matrix((n, n), real)
    ONE, TWO = real(1.0), real(2.0)
    Chain, Bodies = chain_type(real, L), wp.types.vector(L * BODY_STRIDE, real)
    PLAIN, WORLD = plain, world

    @wp.func
    def turned_z(S: sym3, c: real, s: real):
        cc = c * c
        ss = s * s
        cs = c * s
        twice = TWO * cs * S[3]
        return sym3(
            cc * S[0] + ss * S[1] - twice,
            ss * S[0] + cc * S[1] + twice,
            S[2],
            cs * (S[0] - S[1]) + (cc - ss) * S[3],
            c * S[4] - s * S[5],
            s * S[4] + c * S[5],
        )

    @wp.func
    def turned_x(S: sym3, c: real, s: real):
        cc = c * c
        ss = s * s
        cs = c * s
        twice = TWO * cs * S[5]
        return sym3(
            S[0],
            cc * S[1] + ss * S[2] - twice,
            ss * S[1] + cc * S[2] + twice,
            c * S[3] - s * S[4],
            s * S[3] + c * S[4],
            cs * (S[1] - S[2]) + (cc - ss) * S[5],
        )

    @wp.func
    def with_first_moment(S: sym3, h: vec3, d: vec3):
        # Parallel axis theorem: the old origin lies at d from the new one, h is the first moment about the old.
        x = TWO * h[0] * d[0]
        y = TWO * h[1] * d[1]
        z = TWO * h[2] * d[2]
        return sym3(
            S[0] + (y + z),
            S[1] + (x + z),
            S[2] + (x + y),
            S[3] - h[0] * d[1] - h[1] * d[0],
            S[4] - h[0] * d[2] - h[2] * d[0],
            S[5] - h[1] * d[2] - h[2] * d[1],
        )

    @wp.func
    def inertia_matrix(chain: Chain, bodies: Bodies, frames: Frames):
        M = joint_inertia_type()
        links = axes_type()  # from each joint's origin to the next
        for i in range(LAST):
            a = (i + 1) * CHAIN
            links[i] = frames.X[i] * chain[a + 2] + frames.Y[i] * chain[a + 3] + frames.Z[i] * chain[a + 4]
            if wp.static(not WORLD):  # noqa: SIM102 - Warp takes static conditions by themselves
                if i == 0:  # its axes are those of the frame
                    links[i] = vec3(chain[a + 2], chain[a + 3], chain[a + 4])
            if wp.static(not PLAIN):
                links[i] = links[i] + frames.Z[i + 1] * frames.slides[i + 1]
        h = vec3()
        composite = sym3()
        for i in range(LAST, -1, -1):
            b = i * BODY
            if i < LAST:
                a = (i + 1) * CHAIN
                c = frames.cosines[i + 1]
                s = frames.sines[i + 1]
                p = vec3(chain[a + 2], chain[a + 3], chain[a + 4])
                composite = turned_z(composite, c, s)
                h = vec3(c * h[0] - s * h[1], s * h[0] + c * h[1], h[2])
                if wp.static(not PLAIN):
                    slide = frames.slides[i + 1]
                    m = bodies[b + BODY]
                    along = slide * (m * slide + TWO * h[2])
                    composite[0] += along
                    composite[1] += along
                    composite[4] -= slide * h[0]
                    composite[5] -= slide * h[1]
                    h[2] += m * slide
                composite = turned_x(composite, chain[a], chain[a + 1])
                h = vec3(h[0], chain[a] * h[1] - chain[a + 1] * h[2], chain[a + 1] * h[1] + chain[a] * h[2])
                composite = with_first_moment(composite, h, p)
            h = h + vec3(bodies[b + 1], bodies[b + 2], bodies[b + 3])
            for k in range(6):
                composite[k] += bodies[b + 4 + k]
            # Momentum and its moment about the joint's origin, of everything beyond it, at unit joint velocity.
            x = frames.X[i]
            y = frames.Y[i]
            z = frames.Z[i]
            momentum = y * h[0] - x * h[1]
            moment = x * composite[4] + y * composite[5] + z * composite[2]
            diagonal = composite[2] + bodies[b + 10]
            if wp.static(not PLAIN):
                angle = chain[i * CHAIN + 8]
                slide = chain[i * CHAIN + 9]
                m = bodies[b]
                moment = moment * angle + (x * h[1] - y * h[0]) * slide
                momentum = momentum * angle + z * (m * slide)
                diagonal = composite[2] * angle * angle + m * slide * slide
                diagonal += bodies[b + 10] * (angle + slide) * (angle + slide)
            M[SOURCE[i], SOURCE[i]] += diagonal
            for before in range(i):
                j = i - 1 - before
                moment = moment + wp.cross(links[j], momentum)
                value = wp.dot(frames.Z[j], moment)
                if wp.static(not WORLD):  # noqa: SIM102
                    if j == 0:
                        value = moment[2]
                if wp.static(not PLAIN):
                    value = value * chain[j * CHAIN + 8] + wp.dot(frames.Z[j], momentum) * chain[j * CHAIN + 9]
                M[SOURCE[i], SOURCE[j]] += value
                M[SOURCE[j], SOURCE[i]] += value
        return M

    @factory
    def solve(m_rows: int):
        rows_type = wp.types.matrix((m_rows, n), real)
        vec_n = wp.types.vector(n, real)

        @wp.func
        def solve_rows(M: joint_inertia_type, A: rows_type):
            # L D L^T of M, then the rows of A M^-1, M being symmetric.
            F = joint_inertia_type()
            D = vec_n()
            inverse = vec_n()
            for i in range(n):
                scaled = vec_n()  # row i of F D
                D[i] = M[i, i]
                for j in range(i):
                    scaled[j] = M[i, j]
                    for k in range(j):
                        scaled[j] -= scaled[k] * F[j, k]
                    F[i, j] = scaled[j] * inverse[j]
                    D[i] -= F[i, j] * scaled[j]
                inverse[i] = ONE / D[i]
            out = A
            for r in range(m_rows):
                for i in range(n):
                    for k in range(i):
                        out[r, i] -= F[i, k] * out[r, k]
                for i in range(n):
                    out[r, i] *= inverse[i]
                for i in range(wp.static(n - 1), 0, -1):
                    for k in range(i):
                        out[r, k] -= F[i, k] * out[r, i]
            return out

        return solve_rows

    return SimpleNamespace(inertia_matrix=inertia_matrix, solve=solve, joint_inertia_type=joint_inertia_type)
