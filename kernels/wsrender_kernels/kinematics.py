"""Forward kinematics and geometric Jacobian of a chain.

The chain is packed so that each joint costs one rotation about x, a translation and one rotation about z: the
constant rotation between two joint axes is Rz(phi) Rx(alpha) Rz(psi), whose z rotations merge with the motions
before and after it. Unlike Denavit–Hartenberg parameters this is well conditioned for parallel axes too.
"""

from functools import cache
from types import SimpleNamespace

import numpy as np
import warp as wp

from wsrender_kernels.elementary import elementary

JOINT_STRIDE = 10  # cos α, sin α, translation xyz, cos ψ, sin ψ, angle per q, slide per q, slide at q = 0
FRAME_STRIDE = 24  # base axes x, y, z and origin; tip origin and axes x, y, z


def pack_kinematics(T_base, T_joint, T_tip, revolute, scale, offset) -> np.ndarray:
    """Chain constants as the flat float64 array that the device functions read.

    ``T_base`` (4, 4): base in the world; ``T_joint`` (L, 4, 4), ``T_tip`` (4, 4): as in a Chain; joint i moves by
    ``scale[i] * q + offset[i]``, an angle where ``revolute[i]``. Returns shape (L * JOINT_STRIDE + FRAME_STRIDE,).
    """
    split = [_split_rotation(T[:3, :3]) for T in T_joint]
    before = [phi for phi, _, _ in split] + [0.0]
    rows = []
    base = T_base @ _rotation_z(before[0])
    for i, (phi, alpha, psi) in enumerate(split):
        position = _rotation_z(-phi)[:3, :3] @ T_joint[i, :3, 3]
        angle = psi + before[i + 1] + (offset[i] if revolute[i] else 0.0)
        rows += [np.cos(alpha), np.sin(alpha), *position, np.cos(angle), np.sin(angle)]
        rows += [scale[i], 0.0, 0.0] if revolute[i] else [0.0, scale[i], offset[i]]
    frames = [*base[:3, :3].T.ravel(), *base[:3, 3], *T_tip[:3, 3], *T_tip[:3, :3].T.ravel()]
    return np.array(rows + frames)


def device_joint_frames(T_joint) -> np.ndarray:
    """Rotations (L, 3, 3) from the Chain's joint frames to those of ``forward``, which absorb the next Rz(phi)."""
    following = [_split_rotation(T[:3, :3])[0] for T in T_joint[1:]] + [0.0]
    return np.array([_rotation_z(-phi)[:3, :3] for phi in following])


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


@cache
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


@cache
def kinematics(real, n: int, sources: tuple[int, ...]) -> SimpleNamespace:
    """Device functions for a chain whose joint i is driven by coordinate ``sources[i]`` of ``n``.

    ``forward(chain, q) -> tip, x, y, z, levers, X, Y, Z``: tip position and axes in the world; for every joint frame
    after its motion, (L, 3) each, its axes in the world and the tip's position in it [m]. ``jacobian(chain, levers, X,
    Y, Z)`` is (6, n), rows linear then angular at the tip in world axes, as MuJoCo's mj_jacSite.

    The tip's position is accumulated from the tip to the base: the levers of the last joints, which move the least
    inertia, then err by their own small length times epsilon and not by the arm's.
    """
    L = len(sources)
    SOURCE = wp.types.vector(L, wp.int32)(*sources)
    STRIDE = JOINT_STRIDE
    vec3 = wp.types.vector(3, real)
    vec_n, vec_l = wp.types.vector(n, real), wp.types.vector(L, real)
    axes_type = wp.types.matrix((L, 3), real)
    jacobian_type = wp.types.matrix((6, n), real)
    sincos = elementary(real).sincos

    @wp.func
    def forward(chain: wp.array(dtype=real), q: vec_n):
        b = L * STRIDE
        x = vec3(chain[b], chain[b + 1], chain[b + 2])
        y = vec3(chain[b + 3], chain[b + 4], chain[b + 5])
        z = vec3(chain[b + 6], chain[b + 7], chain[b + 8])
        X = axes_type()
        Y = axes_type()
        Z = axes_type()
        sines = vec_l()
        cosines = vec_l()
        for i in range(L):
            a = i * STRIDE
            tilted = y * chain[a] + z * chain[a + 1]
            z = z * chain[a] - y * chain[a + 1]
            s, c = sincos(q[SOURCE[i]] * chain[a + 7])
            sine = s * chain[a + 5] + c * chain[a + 6]
            cosine = c * chain[a + 5] - s * chain[a + 6]
            y = tilted * cosine - x * sine
            x = x * cosine + tilted * sine
            sines[i] = sine
            cosines[i] = cosine
            X[i] = x
            Y[i] = y
            Z[i] = z
        t = b + 12
        levers = axes_type()
        r = vec3(chain[t], chain[t + 1], chain[t + 2])
        for back in range(L):
            i = L - 1 - back
            a = i * STRIDE
            levers[i] = r
            rx = cosines[i] * r[0] - sines[i] * r[1]
            ry = sines[i] * r[0] + cosines[i] * r[1]
            rz = r[2] + (q[SOURCE[i]] * chain[a + 8] + chain[a + 9])
            r = vec3(
                chain[a + 2] + rx,
                chain[a + 3] + (chain[a] * ry - chain[a + 1] * rz),
                chain[a + 4] + (chain[a + 1] * ry + chain[a] * rz),
            )
        tip = vec3()
        for k in range(3):
            tip[k] = chain[b + 9 + k] + (chain[b + k] * r[0] + chain[b + 3 + k] * r[1] + chain[b + 6 + k] * r[2])
        tip_x = x * chain[t + 3] + y * chain[t + 4] + z * chain[t + 5]
        tip_y = x * chain[t + 6] + y * chain[t + 7] + z * chain[t + 8]
        tip_z = x * chain[t + 9] + y * chain[t + 10] + z * chain[t + 11]
        return tip, tip_x, tip_y, tip_z, levers, X, Y, Z

    @wp.func
    def jacobian(chain: wp.array(dtype=real), levers: axes_type, X: axes_type, Y: axes_type, Z: axes_type):
        J = jacobian_type()
        for i in range(L):
            per_angle = chain[i * STRIDE + 7]
            per_slide = chain[i * STRIDE + 8]
            z = Z[i]
            # z x lever, exactly 0 for a tip on the axis.
            linear = (Y[i] * levers[i, 0] - X[i] * levers[i, 1]) * per_angle + z * per_slide
            for r in range(3):
                J[r, SOURCE[i]] += linear[r]
                J[3 + r, SOURCE[i]] += z[r] * per_angle
        return J

    return SimpleNamespace(forward=forward, jacobian=jacobian, vec3=vec3, vec_n=vec_n, jacobian_type=jacobian_type)
