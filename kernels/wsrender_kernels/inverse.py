"""Inverse kinematics: damped least squares within joint limits, one start of one target after the other.

A try is a target and a start. Every step evaluates the chain at a trial configuration; if it is nearer to the target
it is kept, and from there a new Levenberg–Marquardt step is computed (Levenberg 1944; Marquardt 1963), else the step
is shortened. Joints that stand at a limit and would leave it take no part in a step (projected gradient; Bertsekas,
*Projected Newton methods*, 1982), so that a try ends at the target or at a nearest point that the limits allow.

On the CPU one task advances LANES tries together; a lane whose try has ended takes the next one, so that lanes never
wait for each other. On CUDA a thread takes one try. What becomes of a try depends on the try
alone.
"""

from types import SimpleNamespace

import warp as wp

from wsrender_kernels.factories import factory
from wsrender_kernels.kinematics import chain_type, kinematics
from wsrender_kernels.options import CUDA_OPTIONS, MODULE_OPTIONS

LANES = 64
TARGET_SIZES = {"position": 3, "axis": 6, "pose": 12}  # position; with the direction of the tip's z; with x, y and z
RUNNING, REACHED, STATIONARY = 0, 1, 2

# Damping relative to the mean square of the Jacobian's rows, and its change where a step gains more than GOOD, or less
# than POOR, of what it promised (Marquardt 1963). Far from a target that is out of reach the chain's curvature counts
# as much as its slope: a damping that relaxed at every gain would make every second step fail.
FIRST_DAMPING, LARGEST_DAMPING = 1e-3, 1e3
LEAST_DAMPING = {wp.float32: 1e-6, wp.float64: 1e-12}
GOOD, POOR, RELAX, STIFFEN, SHORTEN = 0.75, 0.25, 0.1, 10.0, 0.25
LARGEST_STEP = 1.0  # rad, or metres over the reach: linearised, a longer one means nothing
# A try has ended where the slope of the distance along any free joint is below so much of its largest possible value
# (where no other flatness is asked), or where a step has become shorter than rounding.
FLAT = {wp.float32: 1e-3, wp.float64: 3e-4}
FAR_AWAY = 1e30  # squared errors before the first step, which any trial improves
SHORTEST_STEP = {wp.float32: 1e-7, wp.float64: 1e-13}


@factory
def inverse_model(real, n: int, joints: int):
    """Struct with the numbers of a robot and of what counts as reached."""
    vec_n = wp.types.vector(n, real)

    @wp.struct
    class InverseModel:
        chain: chain_type(real, joints)  # kinematics.pack_kinematics
        lower: vec_n  # limits, infinite where a joint has none
        upper: vec_n
        scale: vec_n  # of each coordinate in a step: 1 rad, or a length [m]
        length: real  # that makes angles comparable to distances [m]
        position_2: real  # square of the largest distance that counts as reached [m²]
        rotation_2: real  # of 2 sqrt(2) sin(angle / 2)
        flat_2: real  # square of the slope at which a try has ended

    return InverseModel


@factory
def advance(real, n: int, sources: tuple[int, ...], plain: bool, kind: str) -> SimpleNamespace:
    """Device function that takes one step of a try.

    ``step(model, target, q, dq, distance², rotation², damping, expected)`` returns the last six anew, and a verdict:
    ``q`` is the best configuration so far and ``dq`` the step to try from it; ``distance²`` [m²] and ``rotation²``,
    8 sin²(angle / 2), are those at q; ``expected`` is the decrease of half their weighted sum that the linearised
    chain promises [m²]. ``target``: see TARGET_SIZES [m, 1].
    """
    kin = kinematics(real, n, sources, plain, True)
    forward, jacobian = kin.forward, kin.jacobian
    M = 3 if kind == "position" else 6
    target_type = wp.types.vector(TARGET_SIZES[kind], real)
    vec3, vec_n, vec_m = kin.vec3, kin.vec_n, wp.types.vector(M, real)
    mat_mn, mat_mm = wp.types.matrix((M, n), real), wp.types.matrix((M, M), real)
    Model = inverse_model(real, n, len(sources))
    POSE, AXIS = kind == "pose", kind == "axis"
    TWO, ZERO, HALF, ONE, QUARTER = real(2.0), real(0.0), real(0.5), real(1.0), real(0.25)
    RELAXED, STIFFENED, SHORTER = real(RELAX), real(STIFFEN), real(SHORTEN)
    MOST, LITTLE = real(GOOD), real(POOR)
    LEAST, LARGEST, MEAN = real(LEAST_DAMPING[real]), real(LARGEST_DAMPING), real(1.0 / M)
    SHORTEST, LONGEST = real(SHORTEST_STEP[real]), real(LARGEST_STEP)
    TINY = real(1e-30 if real is wp.float32 else 1e-200)
    GOING, AT_TARGET, AT_REST = wp.int32(RUNNING), wp.int32(REACHED), wp.int32(STATIONARY)

    @wp.func
    def damped_solution(A: mat_mm, b: vec_m):
        """Solve A x = b for a positive definite A by its factors L D Lᵀ."""
        L = mat_mm()
        inverse = vec_m()
        x = vec_m()
        for i in range(M):
            d = A[i, i]
            y = b[i]
            for j in range(i):
                a = A[i, j]
                for k in range(j):
                    a = a - L[i, k] * L[j, k]
                a = a * inverse[j]
                L[i, j] = a
                d = d - a * a
                y = y - a * x[j]
            inverse[i] = ONE / wp.sqrt(wp.max(d, TINY))
            x[i] = y * inverse[i]
        for i in range(wp.static(M - 1), -1, -1):
            x[i] = x[i] * inverse[i]
            for k in range(i):
                x[k] = x[k] - L[i, k] * x[i]
        return x

    @wp.func
    def step(
        model: Model,
        target: target_type,
        q: vec_n,
        dq: vec_n,
        distance_2: real,
        rotation_2: real,
        damping: real,
        expected: real,
    ):
        trial = vec_n()
        for i in range(n):
            trial[i] = wp.min(wp.max(q[i] + dq[i], model.lower[i]), model.upper[i])
        tip, x, y, z, frames = forward(model.chain, trial)
        J = jacobian(model.chain, frames)

        error = vec_m()
        distance = ZERO
        for r in range(3):
            error[r] = target[r] - tip[r]
            distance = distance + error[r] * error[r]
        rotation = ZERO
        if wp.static(POSE):
            tx = vec3(target[3], target[4], target[5])
            ty = vec3(target[6], target[7], target[8])
            tz = vec3(target[9], target[10], target[11])
            # sin(angle) about the axis: with the cost length² (1 - cos angle) its exact gradient. The cost comes from
            # differences, for the cosine of a small angle has lost it.
            turn = (wp.cross(x, tx) + wp.cross(y, ty) + wp.cross(z, tz)) * (HALF * model.length)
            rotation = wp.length_sq(x - tx) + wp.length_sq(y - ty) + wp.length_sq(z - tz)
            for r in range(3):
                error[wp.static(M - 3) + r] = turn[r]
        if wp.static(AXIS):
            tz = vec3(target[3], target[4], target[5])
            turn = wp.cross(z, tz) * model.length
            rotation = TWO * wp.length_sq(z - tz)
            for r in range(3):
                error[wp.static(M - 3) + r] = turn[r]
        weight = QUARTER * model.length * model.length
        gain = HALF * (distance_2 - distance) + weight * (rotation_2 - rotation)
        better = gain > ZERO

        # The rows of J in metres per unit step; joints at a limit that they would leave take no part.
        A = mat_mn()
        size = ZERO
        slope = ZERO
        slopes = vec_n()
        for i in range(n):
            down = ZERO
            if wp.static(AXIS):  # a turn about the axis itself changes nothing
                about = z[0] * J[3, i] + z[1] * J[4, i] + z[2] * J[5, i]
                for r in range(3):
                    J[3 + r, i] = J[3 + r, i] - z[r] * about
            for r in range(M):
                a = J[r, i] * model.scale[i]
                if r >= 3:
                    a = a * model.length
                A[r, i] = a
                size = size + a * a
                down = down + a * error[r]
            held = (trial[i] <= model.lower[i] and down < ZERO) or (trial[i] >= model.upper[i] and down > ZERO)
            free = wp.where(held, ZERO, ONE)
            slopes[i] = free * down
            slope = slope + free * down * down
            for r in range(M):
                A[r, i] = A[r, i] * free

        change = wp.where(gain > MOST * expected, RELAXED, wp.where(gain < LITTLE * expected, STIFFENED, ONE))
        new_damping = wp.min(wp.max(damping * change, LEAST), LARGEST)
        H = mat_mm()
        for r in range(M):
            for c in range(r):
                H[r, c] = wp.dot(A[r], A[c])
            H[r, r] = wp.dot(A[r], A[r]) + new_damping * MEAN * size + TINY
        solution = damped_solution(H, error)
        largest = ZERO
        along = ZERO
        new_dq = vec_n()
        for i in range(n):
            d = ZERO
            for r in range(M):
                d = d + A[r, i] * solution[r]
            largest = wp.max(largest, wp.abs(d))
            along = along + d * slopes[i]
            new_dq[i] = d * model.scale[i]
        shrink = LONGEST / wp.max(largest, LONGEST)

        length = ZERO
        new_q = vec_n()
        for i in range(n):
            new_q[i] = wp.where(better, trial[i], q[i])
            new_dq[i] = wp.where(better, new_dq[i] * shrink, dq[i] * SHORTER)
            length = wp.max(length, wp.abs(new_dq[i]))
        new_expected = wp.where(better, HALF * along * shrink, expected * SHORTER)
        at_target = better and distance <= model.position_2 and rotation <= model.rotation_2
        flat = better and slope <= model.flat_2 * size * (distance + weight * rotation)
        verdict = wp.where(flat or length < SHORTEST, AT_REST, GOING)
        verdict = wp.where(at_target, AT_TARGET, verdict)
        distance = wp.where(better, distance, distance_2)
        rotation = wp.where(better, rotation, rotation_2)
        return new_q, new_dq, distance, rotation, new_damping, new_expected, verdict

    return SimpleNamespace(step=step, target_type=target_type, vec_n=vec_n, Model=Model)


@factory
def inverse_kernel(real, n: int, sources: tuple[int, ...], plain: bool, kind: str, cuda: bool) -> wp.Kernel:
    """Kernel that takes every try to its end, or through ``steps`` steps.

    In: ``targets`` (T * count,), value r of try i at [r * count + i]; ``starts`` (n * count,) likewise; out: ``q``,
    squared errors ``distance`` and ``rotation`` (count,) there, and the ``verdict`` (count,).
    """
    return (_cuda_kernel if cuda else _cpu_kernel)(real, n, sources, plain, kind)


def _cpu_kernel(real, n: int, sources: tuple[int, ...], plain: bool, kind: str) -> wp.Kernel:
    device = advance(real, n, sources, plain, kind)
    step, target_type, vec_n, Model = device.step, device.target_type, device.vec_n, device.Model
    T, BLOCK = TARGET_SIZES[kind], LANES
    n_type, t_type = wp.types.vector(n * LANES, real), wp.types.vector(T * LANES, real)
    one_type, int_type = wp.types.vector(LANES, real), wp.types.vector(LANES, wp.int32)
    DAMPING, FAR, ZERO = real(FIRST_DAMPING), real(FAR_AWAY), real(0.0)
    GOING, IDLE = wp.int32(RUNNING), wp.int32(-1)

    @wp.kernel(module="unique", module_options=MODULE_OPTIONS, enable_backward=False)
    def inverse_cpu(
        # in
        model: Model,
        targets: wp.array(dtype=real),
        starts: wp.array(dtype=real),
        count: wp.int32,
        steps: wp.int32,
        # out
        q_out: wp.array(dtype=real),
        distance_out: wp.array(dtype=real),
        rotation_out: wp.array(dtype=real),
        verdict_out: wp.array(dtype=wp.int32),
    ):
        following = wp.int32(0)
        q = n_type()
        dq = n_type()
        target = t_type()
        distance = one_type()
        rotation = one_type()
        damping = one_type()
        expected = one_type()
        verdict = int_type()
        tries = int_type()
        ages = int_type()
        for lane in range(BLOCK):
            tries[lane] = IDLE
            ages[lane] = steps
        active = wp.int32(1)

        while active > 0:
            active = wp.int32(0)
            for lane in range(BLOCK):
                ended = verdict[lane] != GOING or ages[lane] >= steps
                if ended and tries[lane] >= 0:
                    at = tries[lane]
                    for i in range(n):
                        q_out[i * count + at] = q[i * BLOCK + lane]
                    distance_out[at] = distance[lane]
                    rotation_out[at] = rotation[lane]
                    verdict_out[at] = verdict[lane]
                    tries[lane] = IDLE
                if tries[lane] < 0 and following < count:
                    tries[lane] = following
                    ages[lane] = 0
                    for i in range(n):
                        q[i * BLOCK + lane] = starts[i * count + following]
                        dq[i * BLOCK + lane] = ZERO
                    for r in range(T):
                        target[r * BLOCK + lane] = targets[r * count + following]
                    distance[lane] = FAR
                    rotation[lane] = FAR
                    damping[lane] = DAMPING
                    expected[lane] = FAR
                    following += 1
                if tries[lane] >= 0:
                    active += 1

            for lane in range(BLOCK):
                lane_q = vec_n()
                lane_dq = vec_n()
                for i in range(n):
                    lane_q[i] = q[i * BLOCK + lane]
                    lane_dq[i] = dq[i * BLOCK + lane]
                lane_target = target_type()
                for r in range(T):
                    lane_target[r] = target[r * BLOCK + lane]
                new_q, new_dq, d, r2, new_damping, new_expected, new_verdict = step(
                    model, lane_target, lane_q, lane_dq, distance[lane], rotation[lane], damping[lane], expected[lane]
                )
                for i in range(n):
                    q[i * BLOCK + lane] = new_q[i]
                    dq[i * BLOCK + lane] = new_dq[i]
                distance[lane] = d
                rotation[lane] = r2
                damping[lane] = new_damping
                expected[lane] = new_expected
                verdict[lane] = new_verdict
                ages[lane] = ages[lane] + 1

    return inverse_cpu


def _cuda_kernel(real, n: int, sources: tuple[int, ...], plain: bool, kind: str) -> wp.Kernel:
    device = advance(real, n, sources, plain, kind)
    step, target_type, vec_n, Model = device.step, device.target_type, device.vec_n, device.Model
    T = TARGET_SIZES[kind]
    DAMPING, FAR, GOING = real(FIRST_DAMPING), real(FAR_AWAY), wp.int32(RUNNING)

    @wp.kernel(module="unique", module_options=CUDA_OPTIONS, enable_backward=False)
    def inverse_cuda(
        # in
        model: Model,
        targets: wp.array(dtype=real),
        starts: wp.array(dtype=real),
        count: wp.int32,
        steps: wp.int32,
        # out
        q_out: wp.array(dtype=real),
        distance_out: wp.array(dtype=real),
        rotation_out: wp.array(dtype=real),
        verdict_out: wp.array(dtype=wp.int32),
    ):
        at = wp.tid()
        q = vec_n()
        dq = vec_n()
        for i in range(n):
            q[i] = starts[i * count + at]
        target = target_type()
        for r in range(T):
            target[r] = targets[r * count + at]
        distance = real(FAR)
        rotation = real(FAR)
        damping = real(DAMPING)
        expected = real(FAR)
        verdict = wp.int32(GOING)
        taken = wp.int32(0)
        while verdict == GOING and taken < steps:
            q, dq, distance, rotation, damping, expected, verdict = step(
                model, target, q, dq, distance, rotation, damping, expected
            )
            taken += 1
        for i in range(n):
            q_out[i * count + at] = q[i]
        distance_out[at] = distance
        rotation_out[at] = rotation
        verdict_out[at] = verdict

    return inverse_cuda
