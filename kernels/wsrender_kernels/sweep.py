"""The fused kernel: configuration -> kinematics -> [inertia] -> singular values -> indices -> voxels and totals.

On the CPU a task is a block of LANES samples: a lane loop with a compile-time trip count, which LLVM turns into SIMD,
fills one scratch row per output; short loops then reduce and scatter them. On CUDA a thread takes one sample after
the other from the same device functions. Outputs of a sample, in this order: tip position (3), indices (K), largest
and smallest singular value of the task (2), then, where asked, configuration (n) and tip orientation (w x y z).
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from types import SimpleNamespace
from typing import Any

import warp as wp

from wsrender_kernels.elementary import bits_type, elementary
from wsrender_kernels.inertia import inertia
from wsrender_kernels.kinematics import kinematics, orientation
from wsrender_kernels.model import model_arrays
from wsrender_kernels.options import MODULE_OPTIONS
from wsrender_kernels.sampling import LANES, sample_space, sampling
from wsrender_kernels.spectrum import spectrum
from wsrender_kernels.voxels import lattice, lowest, voxels


@wp.func
def wide(i: wp.int32):
    """The index as int64: a cast in place would change the type of an unrolled loop's variable."""
    return wp.int64(i)


@dataclass(frozen=True)
class Shape:
    """The compile-time part of a sweep: with equal shapes, a thousand robots share one kernel."""

    real: type  # wp.float32 or wp.float64
    n: int  # coordinates
    sources: tuple[int, ...]  # coordinate that drives each joint
    method: str  # of sampling
    rows: tuple[int, ...]  # task rows of the Jacobian
    convention: str
    indices: Callable  # Warp function (kinematic spectrum, dynamic spectrum) -> (K,)
    n_indices: int
    dynamic: bool = False  # whether any index is dynamic
    given_jacobian: bool = False  # tip position and Jacobian are inputs (user-defined robots)
    given_inertia: bool = False  # M(q) is an input (MuJoCo's own)
    penalty: bool = False  # joint-limit penalisation
    torque_scaling: bool = False
    voxels: bool = True
    maximum: bool = True  # per voxel
    minimum: bool = False
    sums: bool = False  # per voxel; totals over all samples are always kept
    keep_rows: bool = False
    keep_configuration: bool = False
    keep_orientation: bool = False

    @property
    def n_outputs(self) -> int:
        """Values per sample in the scratch rows and in ``rows_out``."""
        return 5 + self.n_indices + self.n * self.keep_configuration + 4 * self.keep_orientation

    @property
    def record_size(self) -> int:
        """Integers per voxel record."""
        return 1 + self.n_indices * (self.maximum + self.minimum)

    @property
    def bytes_per_voxel(self) -> int:
        """Bytes of one voxel's record and its 64-bit sums."""
        return self.record_size * (4 if self.real is wp.float32 else 8) + 8 * self.n_indices * self.sums


@cache
def _state(shape: Shape) -> SimpleNamespace:
    """Device function ``(model, q, at, stride) -> tip, tip axes (3 x 3), J, M`` from the chain or from given arrays."""
    real, n = shape.real, shape.n
    kin = kinematics(real, n, shape.sources)
    forward, jacobian, jacobian_type = kin.forward, kin.jacobian, kin.jacobian_type
    dyn = inertia(real, n, shape.sources)
    inertia_matrix, inertia_type = dyn.inertia_matrix, dyn.joint_inertia_type
    Model = model_arrays(real)
    vec3, vec_n, mat33 = kin.vec3, kin.vec_n, wp.types.matrix((3, 3), real)

    @wp.func
    def no_inertia(model: Model, at: wp.int64, stride: wp.int64):
        return inertia_type()

    @wp.func
    def given_inertia(model: Model, at: wp.int64, stride: wp.int64):
        M = inertia_type()
        for r in range(n):
            for c in range(n):
                M[r, c] = model.inertia_given[wide(r * n + c) * stride + at]
        return M

    read_inertia = given_inertia if shape.dynamic and shape.given_inertia else no_inertia

    @wp.func
    def from_arrays(model: Model, q: vec_n, at: wp.int64, stride: wp.int64):
        tip = vec3()
        J = jacobian_type()
        for r in range(3):
            tip[r] = model.position_given[wide(r) * stride + at]
        for r in range(6):
            for c in range(n):
                J[r, c] = model.jacobian_given[wide(r * n + c) * stride + at]
        return tip, mat33(), J, read_inertia(model, at, stride)

    @wp.func
    def from_chain(model: Model, q: vec_n, at: wp.int64, stride: wp.int64):
        tip, x, y, z, levers, X, Y, Z = forward(model.chain, q)
        J = jacobian(model.chain, levers, X, Y, Z)
        return tip, wp.matrix_from_cols(x, y, z), J, read_inertia(model, at, stride)

    @wp.func
    def with_inertia(model: Model, q: vec_n, at: wp.int64, stride: wp.int64):
        tip, x, y, z, levers, X, Y, Z = forward(model.chain, q)
        J = jacobian(model.chain, levers, X, Y, Z)
        M = inertia_matrix(model.chain, model.bodies, levers, X, Y, Z)
        return tip, wp.matrix_from_cols(x, y, z), J, M

    if shape.given_jacobian:
        return from_arrays
    return with_inertia if shape.dynamic and not shape.given_inertia else from_chain


@cache
def _outputs(shape: Shape):
    """Device function ``evaluate(model, space, block, first, lane) -> outputs`` of one sample."""
    real, n = shape.real, shape.n
    draw = sampling(real, n, shape.method).draw
    state = _state(shape)
    spectra = spectrum(real, n, shape.rows, shape.convention, shape.penalty, shape.torque_scaling)
    penalized, kinematic = spectra.penalized, spectra.kinematic
    dynamic_spectrum = spectra.dynamic if shape.dynamic else spectra.absent
    indices = shape.indices
    Model, Space = model_arrays(real), sample_space(real)
    output_type = wp.types.vector(shape.n_outputs, real)
    to_quaternion = orientation(real)
    K = shape.n_indices
    LARGEST = 1 if shape.convention == "wsrender_code" else 0
    CONFIGURATION = 5 + K
    ORIENTATION = CONFIGURATION + n * shape.keep_configuration
    KEEP_CONFIGURATION, KEEP_ORIENTATION = shape.keep_configuration, shape.keep_orientation

    @wp.func
    def evaluate(model: Model, space: Space, block: Any, first: wp.int64, lane: wp.int32):
        q = draw(space, block, first, lane)
        tip, axes, J, M = state(model, q, first - space.given_first + wp.int64(lane), space.given_stride)
        J = penalized(model, q, J)
        sigma = kinematic(model, J)
        values = indices(sigma, dynamic_spectrum(model, J, M, sigma))
        out = output_type()
        for r in range(3):
            out[r] = tip[r]
        for k in range(K):
            out[3 + k] = values[k]
        out[3 + K] = sigma[LARGEST]
        out[4 + K] = sigma[len(sigma) - 1]
        if wp.static(KEEP_CONFIGURATION):
            for i in range(n):
                out[CONFIGURATION + i] = q[i]
        if wp.static(KEEP_ORIENTATION):
            quat = to_quaternion(axes)
            for i in range(4):
                out[ORIENTATION + i] = quat[i]
        return out

    return evaluate


@cache
def sweep_kernel(shape: Shape, cuda: bool) -> wp.Kernel:
    """The kernel of a shape for the CPU (one task per block) or CUDA (one task per thread)."""
    return _cuda_kernel(shape) if cuda else _cpu_kernel(shape)


def _cpu_kernel(shape: Shape) -> wp.Kernel:
    real, K = shape.real, shape.n_indices
    prepare, evaluate = sampling(real, shape.n, shape.method).prepare, _outputs(shape)
    ordered = elementary(real).ordered
    cell, quantized = voxels(real).cell, voxels(real).quantized
    Model, Space, Lattice, bits = model_arrays(real), sample_space(real), lattice(real), bits_type(real)
    vec3 = wp.types.vector(3, real)
    N_OUTPUTS = shape.n_outputs
    VOXELS, MAXIMUM, MINIMUM, SUMS, ROWS = shape.voxels, shape.maximum, shape.minimum, shape.sums, shape.keep_rows
    FIRST_MINIMUM = 1 + K * shape.maximum
    LOWEST = bits(lowest(real))
    BLOCK, BLOCK_64, K_64, RECORD_64 = LANES, wp.int64(LANES), wp.int64(K), wp.int64(shape.record_size)

    @wp.kernel(module="unique", module_options=MODULE_OPTIONS, enable_backward=False)
    def sweep_cpu(
        # in
        model: Model,
        space: Space,
        grid: Lattice,
        first: wp.int64,
        count: wp.int64,
        scales: wp.array(dtype=real),
        reduced: wp.int32,
        # scratch, one row of LANES per output and one value
        scratch: wp.array(dtype=real),
        cells: wp.array(dtype=wp.int32),
        # out
        extremes: wp.array(dtype=bits),
        totals: wp.array(dtype=wp.int64),
        records: wp.array(dtype=bits),
        sums: wp.array(dtype=wp.int64),
        rows_out: wp.array(dtype=real),
        rows_stride: wp.int64,
    ):
        task = wp.tid()
        start = first + wide(task * BLOCK)
        valid = wp.int32(wp.min(BLOCK_64, first + count - start))
        block = prepare(space, start)

        for lane in range(BLOCK):
            # The lanes past the end repeat the last sample: harmless in extremes, masked in counts and sums.
            out = evaluate(model, space, block, start, wp.min(lane, valid - 1))
            for r in range(N_OUTPUTS):
                scratch[r * BLOCK + lane] = out[r]
            if wp.static(VOXELS):
                cells[lane] = cell(grid, vec3(out[0], out[1], out[2]))

        for r in range(reduced):
            largest = LOWEST
            smallest = LOWEST
            for lane in range(BLOCK):
                key = ordered(scratch[r * BLOCK + lane])
                largest = wp.max(largest, key)
                smallest = wp.max(smallest, ~key)
            extremes[2 * r] = wp.max(extremes[2 * r], largest)
            extremes[2 * r + 1] = wp.max(extremes[2 * r + 1], smallest)

        for k in range(K):
            total = wp.int64(0)
            for lane in range(BLOCK):
                total += wp.where(lane < valid, quantized(scratch[(3 + k) * BLOCK + lane], scales[k]), wp.int64(0))
            totals[k] = totals[k] + total

        if wp.static(VOXELS):
            # Touch all target records first: their cache misses then overlap, twice as fast as one after the other.
            touched = bits(0)
            for lane in range(BLOCK):
                touched += records[wp.int64(cells[lane]) * RECORD_64]
            scratch[N_OUTPUTS * BLOCK] = real(touched)
            for lane in range(valid):
                voxel = wp.int64(cells[lane])
                at = voxel * RECORD_64
                records[at] = records[at] + bits(1)
                for k in range(K):
                    if wp.static(MAXIMUM):
                        slot = at + wide(1 + k)
                        records[slot] = wp.max(records[slot], ordered(scratch[(3 + k) * BLOCK + lane]))
                    if wp.static(MINIMUM):
                        slot = at + wide(FIRST_MINIMUM + k)
                        records[slot] = wp.max(records[slot], ~ordered(scratch[(3 + k) * BLOCK + lane]))
                    if wp.static(SUMS):
                        slot = voxel * K_64 + wide(k)
                        sums[slot] = sums[slot] + quantized(scratch[(3 + k) * BLOCK + lane], scales[k])

        if wp.static(ROWS):
            for r in range(N_OUTPUTS):
                target = wide(r) * rows_stride + wide(task * BLOCK)
                for lane in range(valid):
                    rows_out[target + wide(lane)] = scratch[r * BLOCK + lane]

    return sweep_cpu


def _cuda_kernel(shape: Shape) -> wp.Kernel:
    """Threads stride through the chunk and keep their totals in registers, so that few atomics meet on one address."""
    real, K = shape.real, shape.n_indices
    prepare, evaluate = sampling(real, shape.n, shape.method).prepare, _outputs(shape)
    ordered = elementary(real).ordered
    cell, quantized = voxels(real).cell, voxels(real).quantized
    Model, Space, Lattice, bits = model_arrays(real), sample_space(real), lattice(real), bits_type(real)
    vec3 = wp.types.vector(3, real)
    REDUCED = 5 + K
    extremes_type, totals_type = wp.types.vector(2 * REDUCED, bits), wp.types.vector(K, wp.int64)
    N_OUTPUTS, RECORD = shape.n_outputs, shape.record_size
    VOXELS, MAXIMUM, MINIMUM, SUMS, ROWS = shape.voxels, shape.maximum, shape.minimum, shape.sums, shape.keep_rows
    FIRST_MINIMUM = 1 + K * shape.maximum
    LOWEST = bits(lowest(real))
    LANE_MASK, K_64 = wp.int64(LANES - 1), wp.int64(K)

    @wp.kernel(module="unique", module_options=MODULE_OPTIONS, enable_backward=False, grid_stride=False)
    def sweep_cuda(
        # in
        model: Model,
        space: Space,
        grid: Lattice,
        first: wp.int64,
        count: wp.int64,
        scales: wp.array(dtype=real),
        threads: wp.int64,
        # out
        extremes: wp.array(dtype=bits),
        totals: wp.array(dtype=wp.int64),
        records: wp.array(dtype=bits),
        sums: wp.array(dtype=wp.int64),
        rows_out: wp.array(dtype=real),
        rows_stride: wp.int64,
    ):
        thread = wp.tid()
        largest = extremes_type()
        total = totals_type()
        for r in range(2 * REDUCED):
            largest[r] = LOWEST
        offset = wp.int64(thread)
        while offset < count:
            index = first + offset
            start = index - (index & LANE_MASK)
            block = prepare(space, start)
            out = evaluate(model, space, block, start, wp.int32(index & LANE_MASK))
            for r in range(REDUCED):
                key = ordered(out[r])
                largest[2 * r] = wp.max(largest[2 * r], key)
                largest[2 * r + 1] = wp.max(largest[2 * r + 1], ~key)
            for k in range(K):
                total[k] += quantized(out[3 + k], scales[k])
            if wp.static(VOXELS):
                voxel = wp.int64(cell(grid, vec3(out[0], out[1], out[2])))
                at = voxel * wp.int64(RECORD)
                wp.atomic_add(records, at, bits(1))
                for k in range(K):
                    if wp.static(MAXIMUM):
                        wp.atomic_max(records, at + wide(1 + k), ordered(out[3 + k]))
                    if wp.static(MINIMUM):
                        wp.atomic_max(records, at + wide(FIRST_MINIMUM + k), ~ordered(out[3 + k]))
                    if wp.static(SUMS):
                        wp.atomic_add(sums, voxel * K_64 + wide(k), quantized(out[3 + k], scales[k]))
            if wp.static(ROWS):
                for r in range(N_OUTPUTS):
                    rows_out[wide(r) * rows_stride + offset] = out[r]
            offset += threads
        if wp.int64(thread) < count:
            for r in range(2 * REDUCED):
                wp.atomic_max(extremes, r, largest[r])
            for k in range(K):
                wp.atomic_add(totals, k, total[k])

    return sweep_cuda
