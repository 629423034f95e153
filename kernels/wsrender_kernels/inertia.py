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
from wsrender_kernels.kinematics import (
    JOINT_STRIDE,
    chain_type,
    device_joint_frames,
    device_positions,
    frames_type,
    turns,
)
from wsrender_kernels.matrices import followed_by, written_out

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
def inertia(real, n: int, sources: tuple[int, ...], plain: bool) -> SimpleNamespace:
    """Device functions ``inertia_matrix(chain, bodies, frames) -> (n, n)`` and ``solve(m)``: (M, A (m, n)) -> A M^-1.

    ``frames`` and ``plain`` as in `kinematics`. M[i, j] is the momentum of all beyond joint i, at its unit velocity,
    along the velocity of joint j. These meet in the frame of the middle joint, or of j where that is nearer to i.
    """
    L = len(sources)
    LAST = L - 1
    MIDDLE = LAST // 2
    SOURCE = wp.types.vector(L, wp.int32)(*sources)
    CHAIN = JOINT_STRIDE
    BODY = BODY_STRIDE
    vec3, vec6 = wp.types.vector(3, real), wp.types.vector(6, real)
    sixes_type, joints_type = wp.types.matrix((L, 6), real), wp.types.matrix((L, L), real)
    sym3 = wp.types.vector(6, real)  # xx yy zz xy xz yz
    joint_inertia_type = wp.types.matrix((n, n), real)
    ZERO, ONE, TWO = real(0.0), real(1.0), real(2.0)
    Chain, Bodies, Frames = chain_type(real, L), wp.types.vector(L * BODY_STRIDE, real), frames_type(real, L)
    turned_x, turned_z = turns(real).turned_x, turns(real).turned_z
    PLAIN = plain

    @wp.func
    def inertia_turned_z(S: sym3, c: real, s: real):
        xx = c * S[0] - s * S[3]
        xy = c * S[3] - s * S[1]
        yx = s * S[0] + c * S[3]
        yy = s * S[3] + c * S[1]
        return sym3(c * xx - s * xy, s * yx + c * yy, S[2], s * xx + c * xy, c * S[4] - s * S[5], s * S[4] + c * S[5])

    @wp.func
    def with_first_moment(S: sym3, h: vec3, d: vec3):
        # Parallel axis theorem: the old origin lies at d from the new one, h is the first moment about the old.
        return sym3(
            S[0] + h[1] * (TWO * d[1]) + h[2] * (TWO * d[2]),
            S[1] + h[0] * (TWO * d[0]) + h[2] * (TWO * d[2]),
            S[2] + h[0] * (TWO * d[0]) + h[1] * (TWO * d[1]),
            S[3] - h[0] * d[1] - h[1] * d[0],
            S[4] - h[0] * d[2] - h[2] * d[0],
            S[5] - h[1] * d[2] - h[2] * d[1],
        )

    @wp.func
    def beyond(chain: Chain, bodies: Bodies, frames: Frames, i: int, S: sym3, h: vec3):
        """Inertia and first moment of all beyond a joint, about its origin, in axes before its motion."""
        c = frames.cosines[i]
        s = frames.sines[i]
        T = inertia_turned_z(S, c, s)
        g = vec3(c * h[0] - s * h[1], s * h[0] + c * h[1], h[2])
        if wp.static(not PLAIN):
            slide = frames.slides[i]
            m = bodies[i * BODY]
            along = slide * (m * slide + TWO * g[2])
            T[0] += along
            T[1] += along
            T[4] -= slide * g[0]
            T[5] -= slide * g[1]
            g[2] += m * slide
        return T, g

    @wp.func
    def with_link(chain: Chain, bodies: Bodies, i: int, S: sym3, h: vec3):
        """The same in the frame of joint i - 1, with its link."""
        c = chain[i * CHAIN]
        s = chain[i * CHAIN + 1]
        b = (i - 1) * BODY
        g = vec3(h[0], c * h[1] - s * h[2], s * h[1] + c * h[2])
        # By squares, exact for right angles: the moment about the axis of a slender link stays apart from the others.
        # The link comes first: with it, every product is part of a multiply-add.
        cc = c * c
        ss = s * s
        cs = c * s
        T = sym3(
            bodies[b + 4] + S[0],
            bodies[b + 5] + cc * S[1] + ss * S[2] - (cs + cs) * S[5],
            bodies[b + 6] + ss * S[1] + cc * S[2] + (cs + cs) * S[5],
            bodies[b + 7] + c * S[3] - s * S[4],
            bodies[b + 8] + s * S[3] + c * S[4],
            bodies[b + 9] + cs * (S[1] - S[2]) + (cc - ss) * S[5],
        )
        T = with_first_moment(T, g, vec3(chain[i * CHAIN + 2], chain[i * CHAIN + 3], chain[i * CHAIN + 4]))
        return T, g + vec3(bodies[b + 1], bodies[b + 2], bodies[b + 3])

    @wp.func
    def with_moment(chain: Chain, i: int, f: vec6, sign: real):
        """A momentum and its moment about the origin of joint i - 1 instead of that of i; with -1 the other way."""
        x = sign * chain[i * CHAIN + 2]
        y = sign * chain[i * CHAIN + 3]
        z = sign * chain[i * CHAIN + 4]
        return vec6(
            f[0], f[1], f[2], f[3] + y * f[2] - z * f[1], f[4] + z * f[0] - x * f[2], f[5] + x * f[1] - y * f[0]
        )

    @wp.func
    def momentum(chain: Chain, bodies: Bodies, i: int, S: sym3, h: vec3):
        """Momentum at unit velocity of the joint, and its moment about the joint's origin."""
        f = vec6(-h[1], h[0], ZERO, S[4], S[5], S[2])
        if wp.static(not PLAIN):
            slide = chain[i * CHAIN + 9]
            f = f * chain[i * CHAIN + 8]
            f[2] = bodies[i * BODY] * slide
            f[3] += h[1] * slide
            f[4] -= h[0] * slide
        return f

    @wp.func
    def momentum_before(chain: Chain, bodies: Bodies, i: int, S: sym3, h: vec3):
        """That of joint i, from inertia and first moment before its motion, in the frame of joint i - 1."""
        f = momentum(chain, bodies, i, S, h)
        c = chain[i * CHAIN]
        s = chain[i * CHAIN + 1]
        if wp.static(PLAIN):
            f = vec6(f[0], c * f[1], s * f[1], f[3], c * f[4] - s * f[5], s * f[4] + c * f[5])
        else:
            f = turned_x(f, c, s)
        return with_moment(chain, i, f, ONE)

    @wp.func
    def carried(chain: Chain, frames: Frames, i: int, f: vec6):
        """A momentum from the frame of joint i to that of i - 1."""
        g = turned_z(f, frames.cosines[i], frames.sines[i])
        if wp.static(not PLAIN):
            g[3] -= frames.slides[i] * g[1]
            g[4] += frames.slides[i] * g[0]
        return with_moment(chain, i, turned_x(g, chain[i * CHAIN], chain[i * CHAIN + 1]), ONE)

    @wp.func
    def velocity_after(chain: Chain, frames: Frames, i: int, v: vec6):
        """An angular velocity and the linear one of the origin, from the frame of joint i - 1 to that of i."""
        w = turned_x(with_moment(chain, i, v, -ONE), chain[i * CHAIN], -chain[i * CHAIN + 1])
        if wp.static(not PLAIN):
            w[3] += frames.slides[i] * w[1]
            w[4] -= frames.slides[i] * w[0]
        return turned_z(w, frames.cosines[i], -frames.sines[i])

    @wp.func
    def velocity(chain: Chain, frames: Frames, i: int):
        """Of joint i - 1 at unit speed, in the frame of joint i."""
        a = i * CHAIN
        c = chain[a]
        s = chain[a + 1]
        v = vec6(ZERO, s, c, -chain[a + 3], c * chain[a + 2], -s * chain[a + 2])
        if wp.static(not PLAIN):
            angle = chain[a - CHAIN + 8]
            slide = chain[a - CHAIN + 9]
            v = v * angle
            v[3] += frames.slides[i] * v[1]
            v[4] += s * slide
            v[5] += c * slide
        # The first component before the turn is 0.
        cosine = frames.cosines[i]
        sine = frames.sines[i]
        return vec6(sine * v[1], cosine * v[1], v[2], cosine * v[3] + sine * v[4], cosine * v[4] - sine * v[3], v[5])

    @wp.func
    def along_axis(chain: Chain, i: int, f: vec6):
        """Of a momentum in the frame of joint i, the part that its unit velocity takes."""
        value = f[5]
        if wp.static(not PLAIN):
            value = value * chain[i * CHAIN + 8] + f[2] * chain[i * CHAIN + 9]
        return value

    @wp.func
    def diagonal(chain: Chain, bodies: Bodies, i: int, S: sym3):
        value = S[2] + bodies[i * BODY + 10]
        if wp.static(not PLAIN):
            angle = chain[i * CHAIN + 8]
            slide = chain[i * CHAIN + 9]
            value = S[2] * angle * angle + bodies[i * BODY] * slide * slide
            value += bodies[i * BODY + 10] * (angle + slide) * (angle + slide)
        return value

    def towards_base(start: int, stop: int, end: int):
        """Device function from the frame of joint start to that of stop, with the momenta from there to end."""
        LATEST = end - 1

        @wp.func
        def there(chain: Chain, bodies: Bodies, frames: Frames, S: sym3, h: vec3, momenta: sixes_type, G: joints_type):
            for i in range(start, stop, -1):
                for k in range(i, LATEST):
                    momenta[k + 1] = carried(chain, frames, i, momenta[k + 1])
                S, h = beyond(chain, bodies, frames, i, S, h)
                momenta[i] = momentum_before(chain, bodies, i, S, h)
                S, h = with_link(chain, bodies, i, S, h)
                G[i - 1, i - 1] = diagonal(chain, bodies, i - 1, S)
                for k in range(i, end):
                    G[k, i - 1] = along_axis(chain, i - 1, momenta[k])
            return S, h, momenta, G

        return there

    to_middle, from_middle = towards_base(LAST, MIDDLE, L), towards_base(MIDDLE, 0, MIDDLE)

    @wp.func
    def of_own_coordinates(G: joints_type):
        M = G
        for k in range(L):
            for j in range(k):
                M[j, k] = G[k, j]
        return M

    @wp.func
    def of_shared_coordinates(G: joints_type):
        M = joint_inertia_type()
        for k in range(L):
            M[SOURCE[k], SOURCE[k]] += G[k, k]
            for j in range(k):
                M[SOURCE[k], SOURCE[j]] += G[k, j]
                M[SOURCE[j], SOURCE[k]] += G[k, j]
        return M

    in_coordinates = of_own_coordinates if sources == tuple(range(n)) else of_shared_coordinates

    @wp.func
    def inertia_matrix(chain: Chain, bodies: Bodies, frames: Frames):
        b = LAST * BODY
        h = vec3(bodies[b + 1], bodies[b + 2], bodies[b + 3])
        S = sym3(bodies[b + 4], bodies[b + 5], bodies[b + 6], bodies[b + 7], bodies[b + 8], bodies[b + 9])
        G = joints_type()  # lower triangle
        G[LAST, LAST] = diagonal(chain, bodies, LAST, S)
        S, h, momenta, G = to_middle(chain, bodies, frames, S, h, sixes_type(), G)
        momenta[MIDDLE] = momentum(chain, bodies, MIDDLE, S, h)
        velocities = sixes_type()
        for i in range(MIDDLE):
            for j in range(i):
                velocities[j] = velocity_after(chain, frames, i + 1, velocities[j])
            velocities[i] = velocity(chain, frames, i + 1)
        for j in range(MIDDLE):
            v = velocities[j]
            v = vec6(v[3], v[4], v[5], v[0], v[1], v[2])
            for k in range(MIDDLE, L):
                G[k, j] = wp.dot(momenta[k], v)
        S, h, momenta, G = from_middle(chain, bodies, frames, S, h, momenta, G)
        return in_coordinates(G)

    @factory
    def solve(m_rows: int):
        rows_type = wp.types.matrix((m_rows, n), real)

        @wp.func_native(_solve_rows_in_cpp(real, n, m_rows))
        def solve_rows(M: joint_inertia_type, A: rows_type) -> rows_type: ...

        return solve_rows

    return SimpleNamespace(inertia_matrix=inertia_matrix, solve=solve, joint_inertia_type=joint_inertia_type)


def _solve_rows_in_cpp(real, n: int, m_rows: int) -> str:
    """(M, A) -> X = A M^-1 written out (see `matrices`): L D L^T of M, then the rows of A M^-1, M being symmetric.

    ``LD`` is L D, ``L`` without its diagonal of ones, ``P`` 1 / D.
    """
    lines = []
    for i in range(n):
        for j in range(i):
            less = followed_by("-", (f"LD{i}_{k} * L{j}_{k}" for k in range(j)))
            lines.append(f"const R LD{i}_{j} = M.data[{i}][{j}]{less};")
            lines.append(f"const R L{i}_{j} = LD{i}_{j} * P{j};")
        less = followed_by("-", (f"L{i}_{j} * LD{i}_{j}" for j in range(i)))
        lines.append(f"const R P{i} = R(1) / (M.data[{i}][{i}]{less});")
    for r in range(m_rows):
        for i in range(n):
            less = followed_by("-", (f"x{r}_{k} * L{i}_{k}" for k in range(i)))
            lines.append(f"R x{r}_{i} = A.data[{r}][{i}]{less};")
        lines += [f"x{r}_{i} *= P{i};" for i in range(n)]
        for i in reversed(range(n)):
            less = followed_by("-", (f"x{r}_{k} * L{k}_{i}" for k in reversed(range(i + 1, n))))
            lines.append(f"X.data[{r}][{i}] = x{r}_{i} = x{r}_{i}{less};")
    return written_out(real, f"wp::mat_t<{m_rows}, {n}, R> X;", *lines, "return X;")
