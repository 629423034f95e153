"""Which poses a parallel mechanism reaches: positions of a lattice at several orientations, or poses given one by one.

On the CPU a task is a block of LANES poses and each leg a lane loop over its parts, which LLVM turns into SIMD; on CUDA
a thread takes a pose. Method A asks every leg at every pose; method B goes on to the next subsystem of legs only where
a pose of the part has survived ([SNK]). Both are one kernel, so that they give the same bits.
"""

from collections.abc import Callable
from dataclasses import dataclass

import warp as wp

from wsrender_kernels.factories import factory
from wsrender_kernels.legs import LEG_STRIDE, PLATFORM, PLATFORM_CONE, leg_solver
from wsrender_kernels.memory import memory
from wsrender_kernels.options import CUDA_OPTIONS, MODULE_OPTIONS
from wsrender_kernels.sampling import LANES
from wsrender_kernels.sweep import wide

# Legs unrolled: a leg that is picked while the kernel runs sends the whole struct through local memory.
UNROLLED = {**CUDA_OPTIONS, "max_unroll": LEG_STRIDE}
PART_LANES = 32  # poses of a part of the CPU's block, more than Warp unrolls: unrolled they are no vectors
TURNED_STRIDE = 6  # of a leg at an orientation: its platform joint and the axis of its cone, turned
ASKED_SLOTS = 1024  # in which CUDA threads count the legs that they evaluate
POSE_ROWS = 12  # of a pose: position, then the rows of the rotation


@dataclass(frozen=True)
class MembershipShape:
    """The compile-time part: precision, kinds of legs (of `legs.KINDS`), number of legs, whether any has a cone.

    ``distances``: Warp function of the ends of two links, as of `constraints`; None: legs may cross.
    """

    real: type
    kinds: tuple[str, ...]
    legs: int
    cones: bool
    distances: Callable | None = None
    limits: int = 0  # numbers of all constraints
    given: bool = False  # positions come from an array, not from the lattice


@factory
def mechanism_type(shape: MembershipShape):
    """Struct with the numbers of a mechanism; with constraints also ``limits``, theirs."""
    real, L = shape.real, shape.legs
    vec3 = wp.types.vector(3, real)

    class MechanismModel:
        legs: wp.types.matrix((L, LEG_STRIDE), real)  # legs.pack_legs
        ends: wp.types.vector(L, wp.int32)  # 1 where a leg is the last of its subsystem
        pairs: wp.types.vector(L * L, wp.int32)  # 1 where the distance of two legs counts
        lower: vec3  # of the platform's origin, base frame [m]
        upper: vec3
        axes: wp.types.matrix((3, 3), real)  # world -> base
        origin: vec3  # of the base in the world [m]

    if shape.limits:
        MechanismModel.__annotations__["limits"] = wp.types.vector(shape.limits, real)
    return wp.struct(MechanismModel)


@factory
def lattice_type(real):
    """Struct with a block of the lattice, z fastest: voxel edge [m], first voxel, shape."""

    @wp.struct
    class LatticeBlock:
        edge: real
        first_x: wp.int32
        first_y: wp.int32
        first_z: wp.int32
        size_y: wp.int32
        size_z: wp.int32

    return LatticeBlock


@factory
def lattice_kernel(shape: MembershipShape, cuda: bool) -> wp.Kernel:
    """At how many orientations the voxel centres of a range of a lattice block are reached, or given positions.

    ``points`` (3 * count,), where they are given: coordinate r of position i at [r * count + i], base frame; ``turned``
    (orientations * L * TURNED_STRIDE,), ``weights`` (orientations,); ``by_subsystem``: 1 for method B. Out: ``reached``
    (count,), the sum of their weights ``weighted`` (count,), and ``asked``, in parts the number of (pose, leg)
    pairs that were evaluated: one part per task on the CPU, ASKED_SLOTS, which start at 0, on CUDA; with constraints
    followed, part by part, by the number of poses that the legs reach, whatever constraints say of them. On the CPU
    ``found`` (tasks,) is above 0 where a place of the task's block is reached: only there ``reached`` and ``weighted``,
    of whole blocks, are written.
    """
    return (_lattice_cuda if cuda else _lattice_cpu)(shape)


@factory
def survivors_kernels() -> tuple[wp.Kernel, wp.Kernel]:
    """Two kernels with which only places that are reached go from a GPU to the host, in their order.

    The first says of each place whether it is, ``flags`` (count,) of 0 and 1. The second takes their running sum
    ``places`` and puts number and counts of every such place there into ``cells``, ``reached_out``, ``weighted_out``.
    """

    @wp.kernel(module="unique", module_options=CUDA_OPTIONS, enable_backward=False)
    def are_reached(
        # in
        reached: wp.array(dtype=wp.int32),
        # out
        flags: wp.array(dtype=wp.int32),
    ):
        i = wp.tid()
        flags[i] = wp.min(reached[i], 1)

    @wp.kernel(module="unique", module_options=CUDA_OPTIONS, enable_backward=False)
    def survivors(
        # in
        reached: wp.array(dtype=wp.int32),
        weighted: wp.array(dtype=wp.int32),
        places: wp.array(dtype=wp.int32),
        # out
        cells: wp.array(dtype=wp.int32),
        reached_out: wp.array(dtype=wp.int32),
        weighted_out: wp.array(dtype=wp.int32),
    ):
        i = wp.tid()
        if reached[i] > 0:
            place = places[i] - 1
            cells[place] = i
            reached_out[place] = reached[i]
            weighted_out[place] = weighted[i]

    return are_reached, survivors


@factory
def poses_kernel(shape: MembershipShape, cuda: bool) -> wp.Kernel:
    """Which given poses are reached: ``poses`` (POSE_ROWS * count,), row r of pose i at [r * count + i], base frame."""
    return (_poses_cuda if cuda else _poses_cpu)(shape)


@factory
def _parts(shape: MembershipShape):
    """Device functions ``leg_of(model, k)``, ``in_region(model, p)`` and ``place(model, grid, x, y, z) -> p``."""
    real = shape.real
    solver = leg_solver(real, shape.kinds, shape.cones)
    vec3, Model, Block = solver.vec3, mechanism_type(shape), lattice_type(real)
    HALF = real(0.5)

    @wp.func
    def leg_of(model: Model, k: wp.int32):
        return model.legs[k]

    @wp.func
    def in_region(model: Model, p: vec3):
        low = p[0] >= model.lower[0] and p[1] >= model.lower[1] and p[2] >= model.lower[2]
        high = p[0] <= model.upper[0] and p[1] <= model.upper[1] and p[2] <= model.upper[2]
        return wp.where(low and high, 1, 0)

    @wp.func
    def place(model: Model, grid: Block, x: real, y: real, z: real):
        """The centre of a voxel of the block, counted from its first, in the base frame [m]."""
        world = vec3(
            (real(grid.first_x) + x + HALF) * grid.edge,
            (real(grid.first_y) + y + HALF) * grid.edge,
            (real(grid.first_z) + z + HALF) * grid.edge,
        )
        return model.axes * (world - model.origin)

    return leg_of, in_region, place, solver


def _lattice_cpu(shape: MembershipShape) -> wp.Kernel:
    _leg_of, in_region, place, solver = _parts(shape)
    solve, distances, vec3 = solver.solve, shape.distances, solver.vec3
    real, Model, Block = shape.real, mechanism_type(shape), lattice_type(shape.real)
    L, BLOCK, BLOCK_64, STRIDE, DISTANCES = shape.legs, LANES, wp.int64(LANES), TURNED_STRIDE, bool(distances)
    GIVEN = shape.given
    lane_type, flags_type = wp.types.vector(LANES, real), wp.types.vector(LANES, wp.int32)
    PART, PARTS = PART_LANES, LANES // PART_LANES
    parts_type = wp.types.vector(PARTS, wp.int32)
    store = memory(wp.int32).store
    HALF, ONE = real(0.5), real(1.0)

    @wp.kernel(module="unique", module_options=MODULE_OPTIONS, enable_backward=False)
    def lattice_cpu(
        # in
        model: Model,
        grid: Block,
        points: wp.array(dtype=real),
        turned: wp.array(dtype=real),
        weights: wp.array(dtype=wp.int32),
        orientations: wp.int32,
        first: wp.int64,
        count: wp.int64,
        by_subsystem: wp.int32,
        # out
        reached: wp.array(dtype=wp.int32),
        weighted: wp.array(dtype=wp.int32),
        found: wp.array(dtype=wp.int32),
        asked: wp.array(dtype=wp.int32),
    ):
        task = wp.tid()
        start = first + wide(task * BLOCK)
        valid = wp.int32(wp.min(BLOCK_64, first + count - start))
        last = count - wp.int64(1)
        row = start / wp.int64(grid.size_z)
        x_start = row / wp.int64(grid.size_y)
        z_first = real(wp.int32(start - row * wp.int64(grid.size_z)))
        y_first = real(wp.int32(row - x_start * wp.int64(grid.size_y)))
        x_first = real(wp.int32(x_start))
        per_z = ONE / real(grid.size_z)
        per_y = ONE / real(grid.size_y)
        px = lane_type()
        py = lane_type()
        pz = lane_type()
        inside = flags_type()
        total = flags_type()
        weight_sum = flags_type()
        for lane in range(BLOCK):
            # Whole numbers that a float holds exactly: a division of integers would not vectorise.
            z = z_first + real(lane)
            rows = wp.floor((z + HALF) * per_z)
            y = y_first + rows
            layers = wp.floor((y + HALF) * per_y)
            p = place(model, grid, x_first + layers, y - layers * real(grid.size_y), z - rows * real(grid.size_z))
            if wp.static(GIVEN):
                given = wp.min(start + wp.int64(lane), last)
                p = vec3(points[given], points[count + given], points[wp.int64(2) * count + given])
            px[lane] = p[0]
            py[lane] = p[1]
            pz[lane] = p[2]
            inside[lane] = in_region(model, p) & wp.where(lane < valid, 1, 0)
        pairs = wp.int32(0)
        fitting = wp.int32(0)
        alive = flags_type()
        parts = parts_type()
        for o in range(orientations):
            for lane in range(BLOCK):
                alive[lane] = inside[lane]
            left = PARTS
            for part in range(PARTS):
                parts[part] = part
            k = wp.int32(0)
            while k < L and left > 0:
                leg = model.legs[k]
                at = (o * L + k) * STRIDE
                shift = vec3(turned[at], turned[at + 1], turned[at + 2])
                cone = vec3(turned[at + 3], turned[at + 4], turned[at + 5])
                for j in range(left):
                    first_lane = parts[j] * PART
                    for i in range(PART):
                        lane = first_lane + i
                        fits, _elbow = solve(leg, vec3(px[lane], py[lane], pz[lane]) + shift, cone)
                        alive[lane] = alive[lane] & fits
                    pairs += wp.min(wp.max(valid - first_lane, 0), PART)
                if by_subsystem > 0 and model.ends[k] > 0:
                    kept = wp.int32(0)
                    for j in range(left):
                        part = parts[j]
                        some = wp.int32(0)
                        for i in range(PART):
                            some = wp.max(some, alive[part * PART + i])
                        parts[kept] = part
                        kept += some
                    left = kept
                k += 1
            if wp.static(DISTANCES):
                for lane in range(BLOCK):
                    fitting += alive[lane]
                for pair in range(wp.static(L * L)):
                    if model.pairs[pair] > 0 and left > 0:
                        a = pair / L
                        b = pair - a * L
                        leg_a = model.legs[a]
                        leg_b = model.legs[b]
                        at = (o * L + a) * STRIDE
                        shift_a = vec3(turned[at], turned[at + 1], turned[at + 2])
                        cone_a = vec3(turned[at + 3], turned[at + 4], turned[at + 5])
                        at = (o * L + b) * STRIDE
                        shift_b = vec3(turned[at], turned[at + 1], turned[at + 2])
                        cone_b = vec3(turned[at + 3], turned[at + 4], turned[at + 5])
                        for j in range(left):
                            for i in range(PART):
                                lane = parts[j] * PART + i
                                end_a = vec3(px[lane], py[lane], pz[lane]) + shift_a
                                end_b = vec3(px[lane], py[lane], pz[lane]) + shift_b
                                _fits_a, elbow_a = solve(leg_a, end_a, cone_a)
                                _fits_b, elbow_b = solve(leg_b, end_b, cone_b)
                                answer = distances(model.limits, elbow_a, end_a, elbow_b, end_b)
                                alive[lane] = alive[lane] & wp.where(answer == 0, 1, 0)
            weight = weights[o]
            for lane in range(BLOCK):
                total[lane] = total[lane] + alive[lane]
                weight_sum[lane] = weight_sum[lane] + alive[lane] * weight
        most = wp.int32(0)
        for lane in range(BLOCK):
            most = wp.max(most, total[lane])
        found[task] = most
        if most > 0:
            for lane in range(BLOCK):
                store(reached, task * BLOCK + lane, total[lane])
                store(weighted, task * BLOCK + lane, weight_sum[lane])
        if wp.static(DISTANCES):
            asked[2 * task] = pairs
            asked[2 * task + 1] = fitting
        else:
            asked[task] = pairs

    return lattice_cpu


def _lattice_cuda(shape: MembershipShape) -> wp.Kernel:
    leg_of, in_region, place, solver = _parts(shape)
    solve, distances, vec3 = solver.solve, shape.distances, solver.vec3
    real, Model, Block = shape.real, mechanism_type(shape), lattice_type(shape.real)
    L, STRIDE, DISTANCES, GIVEN = shape.legs, TURNED_STRIDE, bool(distances), shape.given
    SLOTS = ASKED_SLOTS

    @wp.kernel(module="unique", module_options=UNROLLED, enable_backward=False)
    def lattice_cuda(
        # in
        model: Model,
        grid: Block,
        points: wp.array(dtype=real),
        turned: wp.array(dtype=real),
        weights: wp.array(dtype=wp.int32),
        orientations: wp.int32,
        first: wp.int64,
        count: wp.int64,
        by_subsystem: wp.int32,
        # out
        reached: wp.array(dtype=wp.int32),
        weighted: wp.array(dtype=wp.int32),
        asked: wp.array(dtype=wp.int32),
    ):
        i = wp.tid()
        at_voxel = first + wp.int64(i)
        row = at_voxel / wp.int64(grid.size_z)
        layer = row / wp.int64(grid.size_y)
        z = real(wp.int32(at_voxel - row * wp.int64(grid.size_z)))
        y = real(wp.int32(row - layer * wp.int64(grid.size_y)))
        p = place(model, grid, real(wp.int32(layer)), y, z)
        if wp.static(GIVEN):
            p = vec3(points[at_voxel], points[count + at_voxel], points[wp.int64(2) * count + at_voxel])
        inside = in_region(model, p)
        total = wp.int32(0)
        weight_sum = wp.int32(0)
        pairs = wp.int32(0)
        fitting = wp.int32(0)
        for o in range(orientations):
            alive = wp.int32(inside)
            for k in range(L):
                if alive > 0 or by_subsystem == 0:
                    at = (o * L + k) * STRIDE
                    shift = vec3(turned[at], turned[at + 1], turned[at + 2])
                    cone = vec3(turned[at + 3], turned[at + 4], turned[at + 5])
                    fits, _elbow = solve(leg_of(model, k), p + shift, cone)
                    alive = alive & fits
                    pairs += 1
            if wp.static(DISTANCES):
                fitting += alive
                for pair in range(wp.static(L * L)):
                    if model.pairs[pair] > 0 and alive > 0:
                        a = pair / L
                        b = pair - a * L
                        at = (o * L + a) * STRIDE
                        end_a = p + vec3(turned[at], turned[at + 1], turned[at + 2])
                        cone_a = vec3(turned[at + 3], turned[at + 4], turned[at + 5])
                        at = (o * L + b) * STRIDE
                        end_b = p + vec3(turned[at], turned[at + 1], turned[at + 2])
                        cone_b = vec3(turned[at + 3], turned[at + 4], turned[at + 5])
                        _fits_a, elbow_a = solve(leg_of(model, a), end_a, cone_a)
                        _fits_b, elbow_b = solve(leg_of(model, b), end_b, cone_b)
                        answer = distances(model.limits, elbow_a, end_a, elbow_b, end_b)
                        alive = alive & wp.where(answer == 0, 1, 0)
            total += alive
            weight_sum += alive * weights[o]
        reached[i] = total
        weighted[i] = weight_sum
        if wp.static(DISTANCES):
            wp.atomic_add(asked, 2 * (i % SLOTS), pairs)
            wp.atomic_add(asked, 2 * (i % SLOTS) + 1, fitting)
        else:
            wp.atomic_add(asked, i % SLOTS, pairs)

    return lattice_cuda


@factory
def _pose_test(shape: MembershipShape):
    """Device function ``reaches(model, p, R) -> 1 or 0`` of a pose in the base frame."""
    leg_of, in_region, _place, solver = _parts(shape)
    solve, distances, at, vec3 = solver.solve, shape.distances, solver.at, solver.vec3
    real, Model = shape.real, mechanism_type(shape)
    L, JOINT, CONE, DISTANCES = shape.legs, PLATFORM, PLATFORM_CONE, bool(distances)
    mat33 = wp.types.matrix((3, 3), real)

    @wp.func
    def reaches(model: Model, p: vec3, R: mat33):
        alive = in_region(model, p)
        for k in range(wp.static(L)):
            leg = leg_of(model, k)
            fits, _elbow = solve(leg, p + R * at(leg, JOINT), R * at(leg, CONE))
            alive = alive & fits
        if wp.static(DISTANCES):
            for pair in range(wp.static(L * L)):
                if model.pairs[pair] > 0:
                    leg_a = leg_of(model, pair / L)
                    leg_b = leg_of(model, pair % L)
                    end_a = p + R * at(leg_a, JOINT)
                    end_b = p + R * at(leg_b, JOINT)
                    _fits_a, elbow_a = solve(leg_a, end_a, R * at(leg_a, CONE))
                    _fits_b, elbow_b = solve(leg_b, end_b, R * at(leg_b, CONE))
                    answer = distances(model.limits, elbow_a, end_a, elbow_b, end_b)
                    alive = alive & wp.where(answer == 0, 1, 0)
        return alive

    return reaches, vec3, mat33


def _poses_cpu(shape: MembershipShape) -> wp.Kernel:
    reaches, vec3, mat33 = _pose_test(shape)
    real, Model, BLOCK = shape.real, mechanism_type(shape), LANES

    @wp.kernel(module="unique", module_options=MODULE_OPTIONS, enable_backward=False)
    def poses_cpu(
        # in
        model: Model,
        poses: wp.array(dtype=real),
        count: wp.int32,
        # out
        reached: wp.array(dtype=wp.int32),
    ):
        start = wp.tid() * BLOCK
        valid = wp.min(BLOCK, count - start)
        for lane in range(valid):
            i = start + lane
            R = mat33()
            for r in range(3):
                for c in range(3):
                    R[r, c] = poses[(3 + 3 * r + c) * count + i]
            reached[i] = reaches(model, vec3(poses[i], poses[count + i], poses[2 * count + i]), R)

    return poses_cpu


def _poses_cuda(shape: MembershipShape) -> wp.Kernel:
    reaches, vec3, mat33 = _pose_test(shape)
    real, Model = shape.real, mechanism_type(shape)

    @wp.kernel(module="unique", module_options=UNROLLED, enable_backward=False)
    def poses_cuda(
        # in
        model: Model,
        poses: wp.array(dtype=real),
        count: wp.int32,
        # out
        reached: wp.array(dtype=wp.int32),
    ):
        i = wp.tid()
        R = mat33()
        for r in range(3):
            for c in range(3):
                R[r, c] = poses[(3 + 3 * r + c) * count + i]
        reached[i] = reaches(model, vec3(poses[i], poses[count + i], poses[2 * count + i]), R)

    return poses_cuda
