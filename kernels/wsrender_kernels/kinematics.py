"""Forward kinematics and geometric Jacobian of a chain.

The chain is packed so that each joint costs one rotation about x, a translation and one rotation about z: the
constant rotation between two joint axes is Rz(phi) Rx(alpha) Rz(psi), whose z rotations merge with the motions
before and after it. Unlike Denavit–Hartenberg parameters this is well conditioned for parallel axes too.
"""

from types import SimpleNamespace

import numpy as np
import warp as wp

from wsrender_kernels.elementary import elementary
from wsrender_kernels.factories import factory
from wsrender_kernels.matrices import transpose

# cos α, sin α, translation xyz, offset (its rest, that in quarter turns, whole quarters), angle per q, slide per q,
# slide at q = 0
JOINT_STRIDE = 11
FRAME_STRIDE = 24  # base axes x, y, z and origin; tip origin and axes x, y, z


def pack_kinematics(T_base, T_joint, T_tip, revolute, scale, offset) -> np.ndarray:
    """Chain constants as the flat float64 array that the device functions read.

    ``T_base`` (4, 4): base in the world; ``T_joint`` (L, 4, 4), ``T_tip`` (4, 4): as in a Chain; joint i moves by
    ``scale[i] * q + offset[i]``, an angle where ``revolute[i]``. Returns shape (L * JOINT_STRIDE + FRAME_STRIDE,).
    """
    split = [_split_rotation(T[:3, :3]) for T in T_joint]
    before = [phi for phi, _, _ in split] + [0.0]
    positions = device_positions(T_joint)
    rows = []
    base = T_base @ _rotation_z(before[0])
    for i, (_phi, alpha, psi) in enumerate(split):
        angle = psi + before[i + 1] + (offset[i] if revolute[i] else 0.0)
        quarters = np.round(angle * 2 / np.pi)
        rest = angle - quarters * np.pi / 2
        rows += [np.cos(alpha), np.sin(alpha), *positions[i], rest, rest * 2 / np.pi, quarters % 4]
        rows += [scale[i], 0.0, 0.0] if revolute[i] else [0.0, scale[i], offset[i]]
    frames = [*base[:3, :3].T.ravel(), *base[:3, 3], *T_tip[:3, 3], *T_tip[:3, :3].T.ravel()]
    return np.array(rows + frames)


def device_joint_frames(T_joint) -> np.ndarray:
    """Rotations (L, 3, 3) from the Chain's joint frames to those of ``forward``, which absorb the next Rz(phi)."""
    following = [_split_rotation(T[:3, :3])[0] for T in T_joint[1:]] + [0.0]
    return np.array([_rotation_z(-phi)[:3, :3] for phi in following])


def device_positions(T_joint) -> np.ndarray:
    """Origins (L, 3) of the joints in the frame of ``forward`` before each."""
    return np.array([_rotation_z(-_split_rotation(T[:3, :3])[0])[:3, :3] @ T[:3, 3] for T in T_joint])


def _split_rotation(R: np.ndarray) -> tuple[float, float, float]:
    """(phi, alpha, psi) with R = Rz(phi) Rx(alpha) Rz(psi); phi = 0 where the axes are parallel."""
    sine = np.hypot(R[0, 2], R[1, 2])
    phi = np.arctan2(R[0, 2], -R[1, 2]) if sine > 0 else 0.0
    alpha = np.arctan2(sine, R[2, 2])
    # psi from what is left: for nearly parallel axes phi is noise, and their sum must still be right.
    c, s = np.cos(alpha), np.sin(alpha)
    rest = np.array([[1, 0, 0], [0, c, s], [0, -s, c]]) @ _rotation_z(-phi)[:3, :3] @ R
    return phi, alpha, np.arctan2(rest[1, 0], rest[0, 0])


def _rotation_z(angle: float) -> np.ndarray:
    T = np.eye(4)
    T[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    return T


@factory
def chain_type(real, joints: int):
    """Vector type of `pack_kinematics`."""
    return wp.types.vector(joints * JOINT_STRIDE + FRAME_STRIDE, real)


@factory
def frames_type(real, joints: int):
    """Struct of what a configuration gives for every joint.

    (joints, 3) each: its axis ``Z`` and, before its motion, its axes x and y in the world; the tip's position in its
    frame after its motion (``levers``) [m]. (joints,) each: ``sines``, ``cosines`` and ``slides`` [m] of the motion.
    """
    axes_type, vec_l = wp.types.matrix((joints, 3), real), wp.types.vector(joints, real)

    @wp.struct
    class Frames:
        Z: axes_type
        x_before: axes_type
        y_before: axes_type
        levers: axes_type
        sines: vec_l
        cosines: vec_l
        slides: vec_l

    return Frames


@factory
def turns(real) -> SimpleNamespace:
    """Device functions ``turned_x(v, cosine, sine)`` and ``turned_z``: two vectors, one after the other, turned."""
    vec6 = wp.types.vector(6, real)

    @wp.func
    def turned_x(v: vec6, c: real, s: real):
        return vec6(v[0], c * v[1] - s * v[2], s * v[1] + c * v[2], v[3], c * v[4] - s * v[5], s * v[4] + c * v[5])

    @wp.func
    def turned_z(v: vec6, c: real, s: real):
        return vec6(c * v[0] - s * v[1], s * v[0] + c * v[1], v[2], c * v[3] - s * v[4], s * v[3] + c * v[4], v[5])

    return SimpleNamespace(turned_x=turned_x, turned_z=turned_z)


@factory
def orientation(real):
    """Device function R (3, 3) -> unit quaternion w x y z with w >= 0, by the largest component (Shepperd 1978)."""
    mat33, vec4 = wp.types.matrix((3, 3), real), wp.types.vector(4, real)
    ONE, ZERO = real(1.0), real(0.0)

    @wp.func
    def to_quaternion(R: mat33):
        w = ONE + R[0, 0] + R[1, 1] + R[2, 2]
        x = ONE + R[0, 0] - R[1, 1] - R[2, 2]
        y = ONE - R[0, 0] + R[1, 1] - R[2, 2]
        z = ONE - R[0, 0] - R[1, 1] + R[2, 2]
        a = R[2, 1] - R[1, 2]
        b = R[0, 2] - R[2, 0]
        c = R[1, 0] - R[0, 1]
        d = R[1, 0] + R[0, 1]
        e = R[0, 2] + R[2, 0]
        f = R[2, 1] + R[1, 2]
        largest = wp.max(wp.max(w, x), wp.max(y, z))
        quat = vec4(c, e, f, z)
        if largest == w:
            quat = vec4(w, a, b, c)
        elif largest == x:
            quat = vec4(a, x, d, e)
        elif largest == y:
            quat = vec4(b, d, y, f)
        quat = quat * (ONE / wp.sqrt(wp.dot(quat, quat)))
        if quat[0] < ZERO:
            quat = -quat
        return quat

    return to_quaternion


@factory
def kinematics(real, n: int, sources: tuple[int, ...], plain: bool, world: bool) -> SimpleNamespace:
    """Device functions for a chain whose joint i is driven by coordinate ``sources[i]`` of ``n``.

    ``plain``: every joint is revolute and turns by its own coordinate, so that scales and slides need no arithmetic.
    ``forward(chain, q) -> tip, x, y, z, frames`` gives the tip's position and axes in the world; ``frames`` as in
    `frames_type`. ``jacobian(chain, frames)`` is (6, n), rows linear then angular at the tip in world axes, as MuJoCo's
    mj_jacSite. ``moved_base(chain, value, levers[0])`` is the tip for another value of the first joint, bit for bit.

    ``world`` false: for singular values, which no choice of axes changes. J is then in the axes of the middle joint,
    the nearest to all others. The tip's position is in the world all the same; axes are left at zero.

    The tip's position is accumulated from the tip to the base: the levers of the last joints, which move the least
    inertia, then err by their own small length times epsilon and not by the arm's.
    """
    L = len(sources)
    SOURCE = wp.types.vector(L, wp.int32)(*sources)
    STRIDE, B = JOINT_STRIDE, L * JOINT_STRIDE
    vec3 = wp.types.vector(3, real)
    vec_n = wp.types.vector(n, real)
    jacobian_type = wp.types.matrix((6, n), real)
    vec6, columns_type = wp.types.vector(6, real), wp.types.matrix((L, 6), real)
    sincos = elementary(real).sincos_from
    Chain, Frames = chain_type(real, L), frames_type(real, L)
    turned_x, turned_z = turns(real).turned_x, turns(real).turned_z
    PLAIN = plain
    MIDDLE = (L - 1) // 2
    ZERO, ONE = real(0.0), real(1.0)

    @wp.func
    def motion(chain: Chain, i: int, value: real):
        a = i * STRIDE
        slide = real(0.0)
        angle = value
        if wp.static(not PLAIN):
            slide = value * chain[a + 9] + chain[a + 10]
            angle = value * chain[a + 8]
        sine, cosine = sincos(angle, chain[a + 5], chain[a + 6], chain[a + 7])
        return sine, cosine, slide

    @wp.func
    def before(chain: Chain, i: int, sine: real, cosine: real, slide: real, r: vec3):
        a = i * STRIDE
        rx = cosine * r[0] - sine * r[1]
        ry = sine * r[0] + cosine * r[1]
        rz = r[2]
        if wp.static(not PLAIN):
            rz = rz + slide
        return vec3(
            chain[a + 2] + rx,
            chain[a + 3] + chain[a] * ry - chain[a + 1] * rz,
            chain[a + 4] + chain[a + 1] * ry + chain[a] * rz,
        )

    @wp.func
    def in_world(chain: Chain, r: vec3):
        tip = vec3()
        for k in range(3):
            tip[k] = chain[B + 9 + k] + chain[B + k] * r[0] + chain[B + 3 + k] * r[1] + chain[B + 6 + k] * r[2]
        return tip

    @wp.func
    def moved_base(chain: Chain, value: real, lever: vec3):
        sine, cosine, slide = motion(chain, 0, value)
        return in_world(chain, before(chain, 0, sine, cosine, slide, lever))

    @wp.func
    def with_axes(chain: Chain, frames: Frames):
        """The frames with their axes in the world, and those of the tip."""
        x = vec3(chain[B], chain[B + 1], chain[B + 2])
        y = vec3(chain[B + 3], chain[B + 4], chain[B + 5])
        z = vec3(chain[B + 6], chain[B + 7], chain[B + 8])
        for i in range(L):
            a = i * STRIDE
            tilted = y * chain[a] + z * chain[a + 1]
            z = z * chain[a] - y * chain[a + 1]
            sine = frames.sines[i]
            cosine = frames.cosines[i]
            frames.x_before[i] = x
            frames.y_before[i] = tilted
            y = tilted * cosine - x * sine
            x = x * cosine + tilted * sine
            frames.Z[i] = z
        t = B + 15
        tip_x = x * chain[t] + y * chain[t + 1] + z * chain[t + 2]
        tip_y = x * chain[t + 3] + y * chain[t + 4] + z * chain[t + 5]
        tip_z = x * chain[t + 6] + y * chain[t + 7] + z * chain[t + 8]
        return frames, tip_x, tip_y, tip_z

    @wp.func
    def without_axes(chain: Chain, frames: Frames):
        return frames, vec3(), vec3(), vec3()

    axes_of = with_axes if world else without_axes

    @wp.func
    def forward(chain: Chain, q: vec_n):
        frames = Frames()
        for i in range(L):
            sine, cosine, slide = motion(chain, i, q[SOURCE[i]])
            frames.sines[i] = sine
            frames.cosines[i] = cosine
            frames.slides[i] = slide
        t = B + 12
        r = vec3(chain[t], chain[t + 1], chain[t + 2])
        for back in range(L):
            i = L - 1 - back
            frames.levers[i] = r
            r = before(chain, i, frames.sines[i], frames.cosines[i], frames.slides[i], r)
        frames, x, y, z = axes_of(chain, frames)
        return in_world(chain, r), x, y, z, frames

    @wp.func
    def turned_lever(frames: Frames, i: int):
        """Where the tip is, x and y, before the joint's motion, about its axis."""
        x = frames.levers[i, 0]
        y = frames.levers[i, 1]
        return frames.cosines[i] * x - frames.sines[i] * y, frames.sines[i] * x + frames.cosines[i] * y

    @wp.func
    def column(chain: Chain, i: int, x: real, y: real, c: real, s: real):
        """Column of a joint with the tip at x, y from its axis z, turned about x: z x lever, and z."""
        linear = vec3(-y, c * x, s * x)
        angular = vec3(ZERO, -s, c)
        if wp.static(not PLAIN):
            linear = linear * chain[i * STRIDE + 8] + angular * chain[i * STRIDE + 9]
            angular = angular * chain[i * STRIDE + 8]
        return vec6(linear[0], linear[1], linear[2], angular[0], angular[1], angular[2])

    @wp.func
    def columns_in_the_middle(chain: Chain, frames: Frames):
        # Columns have zeros in the frames of their own joints; from there they are taken to the middle joint's, those
        # of the joints after it and before it independently of each other.
        columns = columns_type()
        for i in range(wp.static(L - 1), MIDDLE, -1):
            ca = chain[i * STRIDE]
            sa = chain[i * STRIDE + 1]
            for k in range(i, L):
                columns[k] = turned_x(turned_z(columns[k], frames.cosines[i], frames.sines[i]), ca, sa)
            x, y = turned_lever(frames, i)
            columns[i] = column(chain, i, x, y, ca, sa)
        for i in range(MIDDLE):
            ca = chain[(i + 1) * STRIDE]
            sa = -chain[(i + 1) * STRIDE + 1]
            cosine = frames.cosines[i + 1]
            sine = -frames.sines[i + 1]
            for k in range(i):
                columns[k] = turned_z(turned_x(columns[k], ca, sa), cosine, sine)
            columns[i] = turned_z(column(chain, i, frames.levers[i, 0], frames.levers[i, 1], ca, sa), cosine, sine)
        columns[MIDDLE] = column(chain, MIDDLE, frames.levers[MIDDLE, 0], frames.levers[MIDDLE, 1], ONE, ZERO)
        return columns

    @wp.func
    def columns_in_the_world(chain: Chain, frames: Frames):
        # z x lever is exactly 0 for a tip on the axis; in axes before the motion, which the last joint's need not be
        # turned for.
        columns = columns_type()
        for i in range(L):
            x, y = turned_lever(frames, i)
            z = frames.Z[i]
            linear = frames.y_before[i] * x - frames.x_before[i] * y
            if wp.static(not PLAIN):
                linear = linear * chain[i * STRIDE + 8] + z * chain[i * STRIDE + 9]
                z = z * chain[i * STRIDE + 8]
            for r in range(3):
                columns[i, r] = linear[r]
                columns[i, 3 + r] = z[r]
        return columns

    columns_of = columns_in_the_world if world else columns_in_the_middle

    @wp.func
    def of_shared_coordinates(columns: columns_type):
        J = jacobian_type()
        for i in range(L):
            for r in range(6):
                J[r, SOURCE[i]] += columns[i, r]
        return J

    in_coordinates = transpose(real, L, 6) if sources == tuple(range(n)) else of_shared_coordinates

    @wp.func
    def jacobian(chain: Chain, frames: Frames):
        return in_coordinates(columns_of(chain, frames))

    return SimpleNamespace(
        forward=forward,
        jacobian=jacobian,
        moved_base=moved_base,
        vec3=vec3,
        vec_n=vec_n,
        jacobian_type=jacobian_type,
    )
