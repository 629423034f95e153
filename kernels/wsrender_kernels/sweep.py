"""The fused kernel: configuration -> kinematics -> [inertia] -> singular values -> indices -> voxels and totals.

On the CPU a task is a block of LANES samples: a lane loop with a compile-time trip count, which LLVM turns into SIMD,
or several where singular values take rotations (`_staged_lanes`), fill one scratch row per output; short loops then
reduce and scatter them. On CUDA a thread takes one sample after the other from the same device functions. Outputs of a
sample, in this order: tip position (3), indices (K), largest and smallest singular value of the task (2; none of a
sweep without indices, which takes no Jacobian), then, where asked, configuration (n) and tip orientation (w x y z).

The functions that hold most of a kernel are inlined by order: 2 to 5 % less to compile on the CPU, the same code on
both.
"""

from collections.abc import Callable
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import warp as wp

from wsrender_kernels.constraints import OfChain
from wsrender_kernels.denormals import denormals_to_zero, restore_denormals
from wsrender_kernels.elementary import bits_type, elementary
from wsrender_kernels.factories import factory
from wsrender_kernels.inertia import inertia
from wsrender_kernels.kinematics import kinematics, orientation
from wsrender_kernels.memory import align_scratch, cuda_atomics, memory
from wsrender_kernels.model import model_type
from wsrender_kernels.options import CUDA_OPTIONS, LONG_CUDA_OPTIONS, LONG_OPTIONS, SHORT_OPTIONS
from wsrender_kernels.rotations import singular_values_of_lanes
from wsrender_kernels.sampling import LANES, base_levels, blocks, grid_level, sample_space, sampling
from wsrender_kernels.singular_values import singular_values
from wsrender_kernels.spectrum import in_base_axes, spectrum
from wsrender_kernels.voxels import lattice, lowest, voxels

# Threads per block on CUDA. Small blocks fill a multiprocessor better where a thread needs 128 to 168 registers (twelve
# indices and voxels in float32: 16 % faster on an H200); float64, which needs all, is up to 9 % slower so.
BLOCK_CUDA = {wp.float32: 128, wp.float64: 256}
# Of a CUDA thread at most, so that a multiprocessor runs 16 warps at a time: float64 sweeps without inertia matrix,
# rotations and penalisation, which would take up to 183, are 7 to 36 % faster. With these float64 needs more and would
# be slower, float32 with an inertia matrix too; without one it takes no more than that, or little.
REGISTERS_CUDA = 128
TOTAL_SLOTS = 64  # parts in which CUDA threads add totals: on one address they would wait for each other
PART_LANES = 32  # of a block at a time, for rotations: their matrices stay in the first cache; more than Warp unrolls


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
    plain: bool  # every joint is revolute and turns by its own coordinate: see `kinematics`
    method: str  # of sampling
    rows: tuple[int, ...]  # task rows of the Jacobian
    convention: str
    indices: Callable | None  # Warp function (kinematic spectrum, dynamic spectrum) -> (K,); None: positions alone
    n_indices: int
    dynamic: bool = False  # whether any index is dynamic
    given_jacobian: bool = False  # tip position and Jacobian are inputs (user-defined robots)
    given_inertia: bool = False  # M(q) is an input (MuJoCo's own)
    given_values: tuple[int, ...] = ()  # indices whose values are inputs
    penalty: bool = False  # joint-limit penalisation
    torque_scaling: bool = False
    base_levels: bool = False  # whether a sample stands for every level of the base joint
    shared: int = 0  # on the CPU, leading coordinates of a grid that a block's samples share
    voxels: bool = True
    maximum: bool = True  # per voxel
    minimum: bool = False
    sums: bool = False  # per voxel; totals over all samples are always kept
    keep_rows: bool = False
    keep_configuration: bool = False
    keep_orientation: bool = False
    # Warp functions (limits, q, tip, axes) -> 0 admitted | 1 violated, those of the whole chain (model, q, tip, axes),
    # or the label of samples that are rejected
    constraints: tuple[Callable | OfChain | int, ...] = ()
    limits: int = 0  # numbers of all constraints, and then of the indices of the chain
    chain_values: tuple[tuple[int, Callable], ...] = ()  # indices (model, q) -> value, by their places
    cuts: tuple[int, ...] = ()  # places of indices whose values are counted that are cut
    best: int | None = None  # place of the index of whose maximum a voxel keeps the sample

    @property
    def world_axes(self) -> bool:
        """Whether more depends on the axes of J than its singular values, which are the same in any frame.

        ``wsrender_code`` reproduces the rounding of the program's determinant, in its axes.
        """
        tip_axes = self.keep_orientation or not all(isinstance(each, int) for each in self.constraints)
        return tip_axes or in_base_axes(self.rows) or self.convention == "wsrender_code"

    @property
    def labelled(self) -> bool:
        """Whether other kernels have labelled the samples: see `collision`."""
        return any(isinstance(each, int) for each in self.constraints)

    @property
    def many_rows(self) -> bool:
        """Whether singular values of more than three rows are taken, by rotations."""
        return len(self.rows) > 3 or self.convention == "wsrender_code"

    @property
    def long(self) -> bool:
        """Whether the compiler for an H200, optimizing all it can, takes some 6 s or more."""
        return self.dynamic and len(self.sources) > 9

    @property
    def n_outputs(self) -> int:
        """Values that a sample is evaluated to; with constraints the last is the number of what rejects it, or 0."""
        kept = self.n * self.keep_configuration + 4 * self.keep_orientation
        return self.reduced + kept + bool(self.constraints)

    @property
    def reduced(self) -> int:
        """Outputs whose extremes are kept: tip position, indices, largest and smallest singular value."""
        return 3 + self.n_indices + self.singular_values

    @property
    def singular_values(self) -> int:
        """Outputs that are singular values: two of a sweep with indices."""
        return 2 if self.n_indices else 0

    @property
    def n_rows(self) -> int:
        """Rows of a kept map: all outputs but the singular values."""
        return self.n_outputs - self.singular_values

    @property
    def interleaved(self) -> bool:
        """Whether kept rows lie sample by sample, as those who ask for positions alone want them."""
        return not self.n_indices

    @property
    def record_size(self) -> int:
        """Integers per voxel record: a power of two, so that no record lies across two cache lines."""
        return _power_of_two(self.count_size + self.extremes)

    @property
    def n_totals(self) -> int:
        """Totals of all samples: sums of the indices, samples rejected by constraint, values that are cut."""
        return self.n_indices + len(self.constraints) + len(self.cuts)

    @property
    def count_size(self) -> int:
        """Integers of a record that hold the 64-bit count."""
        return 2 if self.real is wp.float32 else 1

    @property
    def extremes(self) -> int:
        """Extremes kept per voxel."""
        return self.n_indices * (self.maximum + self.minimum)

    @property
    def sums_size(self) -> int:
        """64-bit integers per voxel for its sums, padded likewise; 0 where none are kept."""
        return _power_of_two(self.n_indices) if self.sums and self.n_indices else 0

    @property
    def bytes_per_voxel(self) -> int:
        """Bytes of one voxel's record, its 64-bit sums, and its rejected samples by constraint."""
        kept = self.sums_size + len(self.constraints) + (self.best is not None)
        return self.record_size * (4 if self.real is wp.float32 else 8) + 8 * kept


def _power_of_two(size: int) -> int:
    return 1 << (size - 1).bit_length()


def _model(shape: Shape):
    """Struct type of the robot's numbers."""
    given = bool(shape.given_values)
    return model_type(shape.real, shape.n, len(shape.sources), shape.limits, shape.labelled, given)


@factory
def _given_values(shape: Shape):
    """Device function ``(model, space, sample, found) -> found`` with the values that are inputs."""
    found_type, Space = wp.types.vector(shape.n_indices + 2, shape.real), sample_space(shape.real, shape.n)
    Model, GIVEN = _model(shape), len(shape.given_values)
    INDEX = wp.types.vector(max(GIVEN, 1), wp.int32)(*shape.given_values)

    @wp.func
    def unchanged(model: Model, space: Space, sample: wp.int64, found: found_type):
        return found

    @wp.func
    def given_values(model: Model, space: Space, sample: wp.int64, found: found_type):
        for g in range(GIVEN):
            found[INDEX[g]] = model.values_given[wide(g) * space.given_stride + sample - space.given_first]
        return found

    return given_values if GIVEN else unchanged


@factory
def _chain_values(shape: Shape):
    """Device functions of indices of the chain: ``(model, q, out) -> out`` with their values, and ``kept(out, found)``.

    The second takes them over what stands in their places among the indices of singular values.
    """
    real, output_type = shape.real, wp.types.vector(shape.n_outputs, shape.real)
    vec_n, found_type = wp.types.vector(shape.n, real), wp.types.vector(shape.n_indices + 2, real)
    COUNT = len(shape.chain_values)
    PLACES = wp.types.vector(max(COUNT, 1), wp.int32)(*(place for place, _ in shape.chain_values))

    @wp.func
    def with_none(model: Any, q: vec_n, out: output_type):
        return out

    with_values = with_none
    for place, value in shape.chain_values:
        with_values = _with_value(value, 3 + place, with_values, vec_n, output_type)

    @wp.func
    def kept(out: output_type, found: found_type):
        for g in range(COUNT):
            found[PLACES[g]] = out[3 + PLACES[g]]
        return found

    return with_values, kept


def _with_value(value: Any, place: int, others: Any, vec_n: Any, output_type: Any):
    """The same with one index more."""

    @wp.func
    def with_value(model: Any, q: vec_n, out: output_type):
        more = others(model, q, out)
        more[place] = value(model, q)
        return more

    return with_value


@factory
def _state(shape: Shape) -> SimpleNamespace:
    """Device function ``(model, q, at, stride) -> tip, tip axes (3 x 3), J, M`` from the chain or from given arrays.

    With ``base_levels`` the tip's place in the first joint's frame stands for the tip: see `kinematics.moved_base`.
    """
    real, n = shape.real, shape.n
    kin = kinematics(real, n, shape.sources, shape.plain, shape.world_axes)
    forward, jacobian, jacobian_type = kin.forward, kin.jacobian, kin.jacobian_type
    dyn = inertia(real, n, shape.sources, shape.plain)
    inertia_matrix, inertia_type = dyn.inertia_matrix, dyn.joint_inertia_type
    Model = _model(shape)
    vec3, vec_n, mat33 = kin.vec3, kin.vec_n, wp.types.matrix((3, 3), real)
    BASE_LEVELS = shape.base_levels

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

    @wp.func(inline=True)
    def from_chain(model: Model, q: vec_n, at: wp.int64, stride: wp.int64):
        tip, x, y, z, frames = forward(model.chain, q)
        if wp.static(BASE_LEVELS):
            tip = frames.levers[0]
        J = jacobian(model.chain, frames)
        return tip, wp.matrix_from_cols(x, y, z), J, read_inertia(model, at, stride)

    @wp.func(inline=True)
    def with_inertia(model: Model, q: vec_n, at: wp.int64, stride: wp.int64):
        tip, x, y, z, frames = forward(model.chain, q)
        if wp.static(BASE_LEVELS):
            tip = frames.levers[0]
        J = jacobian(model.chain, frames)
        M = inertia_matrix(model.chain, model.bodies, frames)
        return tip, wp.matrix_from_cols(x, y, z), J, M

    if shape.given_jacobian:
        return from_arrays
    return with_inertia if shape.dynamic and not shape.given_inertia else from_chain


@factory
def _around_values(shape: Shape) -> SimpleNamespace:
    """Device functions before and after the singular values of a sample.

    ``matrices(model, space, block, first, lane) -> out, A, B, volume``: outputs but the indices, and what `spectrum`
    takes singular values of; ``indices_of(volume, sigma of A, sigma of B)`` -> the other outputs.
    """
    real, n = shape.real, shape.n
    draw = sampling(real, n, shape.method, shape.shared).draw
    state = _state(shape)
    spectra = _spectra(shape)
    penalized, volume_of = spectra.penalized, spectra.volume
    kinematic_matrix, dynamic_matrix = spectra.kinematic_matrix, spectra.dynamic_matrix
    kinematic, dynamic = spectra.kinematic, spectra.dynamic
    kinematic_type, dynamic_type = (
        wp.types.vector(rows, real) for rows, _columns in (spectra.kinematic_shape, spectra.dynamic_shape)
    )
    indices = shape.indices
    Model, Space = _model(shape), sample_space(real, n)
    output_type, found_type = wp.types.vector(shape.n_outputs, real), wp.types.vector(shape.n_indices + 2, real)
    to_quaternion = orientation(real)
    K, rejection, CONSTRAINED, REASON = shape.n_indices, _rejection(shape), bool(shape.constraints), shape.n_outputs - 1
    LARGEST = 1 if shape.convention == "wsrender_code" else 0
    CONFIGURATION = shape.reduced
    ORIENTATION = CONFIGURATION + n * shape.keep_configuration
    KEEP_CONFIGURATION, KEEP_ORIENTATION = shape.keep_configuration, shape.keep_orientation
    (with_values, _), VALUED = _chain_values(shape), bool(shape.chain_values)

    @wp.func(inline=True)
    def matrices(model: Model, space: Space, block: Any, first: wp.int64, lane: wp.int32):
        q = draw(space, block, first, lane)
        tip, axes, J, M = state(model, q, first - space.given_first + wp.int64(lane), space.given_stride)
        out = output_type()
        for r in range(3):
            out[r] = tip[r]
        if wp.static(KEEP_CONFIGURATION):
            for i in range(n):
                out[CONFIGURATION + i] = q[i]
        if wp.static(KEEP_ORIENTATION):
            quat = to_quaternion(axes)
            for i in range(4):
                out[ORIENTATION + i] = quat[i]
        if wp.static(CONSTRAINED):
            out[REASON] = real(rejection(model, q, tip, axes, first + wp.int64(lane)))
        if wp.static(VALUED):
            out = with_values(model, q, out)
        J = penalized(model, q, J)
        return out, kinematic_matrix(model, J), dynamic_matrix(model, J, M), volume_of(J)

    @wp.func
    def indices_of(volume: real, sigma_a: kinematic_type, sigma_b: dynamic_type):
        sigma = kinematic(volume, sigma_a)
        values = indices(sigma, dynamic(sigma, sigma_b))
        found = found_type()
        for k in range(K):
            found[k] = values[k]
        found[K] = sigma[LARGEST]
        found[wp.static(K + 1)] = sigma[len(sigma) - 1]
        return found

    return SimpleNamespace(matrices=matrices, indices_of=indices_of)


@factory
def _rejection(shape: Shape):
    """Device function ``(model, q, tip, axes, sample) -> number`` of the first violated constraint, from 1; else 0.

    With ``base_levels`` its ``tip`` is the lever, as of `_state`; the constraints are given the tip in the world.
    """
    real, n = shape.real, shape.n
    moved_base = kinematics(real, n, shape.sources, shape.plain, shape.world_axes).moved_base
    vec3, mat33, vec_n = wp.types.vector(3, real), wp.types.matrix((3, 3), real), wp.types.vector(n, real)

    @wp.func
    def none(model: Any, q: vec_n, tip: vec3, axes: mat33, sample: wp.int64):
        return wp.int32(0)

    rejection = none
    for number, constraint in reversed(list(enumerate(shape.constraints, 1))):
        if isinstance(constraint, OfChain):
            rejection = _first_of_chain(constraint.function, number, rejection, vec_n, vec3, mat33)
        else:
            first_of = _first_label if isinstance(constraint, int) else _first_of
            rejection = first_of(constraint, number, rejection, vec_n, vec3, mat33)
    in_world = rejection

    @wp.func
    def of_lever(model: Any, q: vec_n, lever: vec3, axes: mat33, sample: wp.int64):
        return in_world(model, q, moved_base(model.chain, q[0], lever), axes, sample)

    return of_lever if shape.base_levels and shape.constraints else rejection


def _first_of(constraint: Any, number: int, following: Any, vec_n: Any, vec3: Any, mat33: Any):
    """Device function as `_rejection`, of one constraint before others."""

    @wp.func
    def first_of(model: Any, q: vec_n, tip: vec3, axes: mat33, sample: wp.int64):
        rejected = following(model, q, tip, axes, sample)
        return wp.where(constraint(model.limits, q, tip, axes) == 0, rejected, number)

    return first_of


def _first_of_chain(constraint: Any, number: int, following: Any, vec_n: Any, vec3: Any, mat33: Any):
    """The same of a constraint that asks for the chain: its frames are those of the sample, which compilers see."""

    @wp.func
    def first_of_chain(model: Any, q: vec_n, tip: vec3, axes: mat33, sample: wp.int64):
        rejected = following(model, q, tip, axes, sample)
        return wp.where(constraint(model, q, tip, axes) == 0, rejected, number)

    return first_of_chain


def _first_label(label: int, number: int, following: Any, vec_n: Any, vec3: Any, mat33: Any):
    """The same of a constraint that has labelled the samples that it rejects."""
    load, LABEL = memory(wp.uint8).load, wp.uint8(label)

    @wp.func
    def first_label(model: Any, q: vec_n, tip: vec3, axes: mat33, sample: wp.int64):
        rejected = following(model, q, tip, axes, sample)
        at = wp.int32(sample - model.first_label)
        return wp.where(load(model.labels, at) == LABEL, number, rejected)

    return first_label


@factory
def _positions(shape: Shape):
    """Device function ``(model, space, block, first, lane) -> outputs`` of a sample without indices."""
    real, n = shape.real, shape.n
    draw = sampling(real, n, shape.method, shape.shared).draw
    kin = kinematics(real, n, shape.sources, shape.plain, shape.world_axes)
    forward, vec3 = kin.forward, kin.vec3
    Model, Space = _model(shape), sample_space(real, n)
    output_type, to_quaternion = wp.types.vector(shape.n_outputs, real), orientation(real)
    mat33 = wp.types.matrix((3, 3), real)
    BASE_LEVELS, GIVEN = shape.base_levels, shape.given_jacobian
    rejection, CONSTRAINED, REASON = _rejection(shape), bool(shape.constraints), shape.n_outputs - 1
    CONFIGURATION = shape.reduced
    ORIENTATION = CONFIGURATION + n * shape.keep_configuration
    KEEP_CONFIGURATION, KEEP_ORIENTATION = shape.keep_configuration, shape.keep_orientation

    @wp.func(inline=True)
    def positions(model: Model, space: Space, block: Any, first: wp.int64, lane: wp.int32):
        q = draw(space, block, first, lane)
        tip = vec3()
        axes = mat33()
        out = output_type()
        if wp.static(GIVEN):
            at = first - space.given_first + wp.int64(lane)
            for r in range(3):
                tip[r] = model.position_given[wide(r) * space.given_stride + at]
        else:
            tip, x, y, z, frames = forward(model.chain, q)
            if wp.static(BASE_LEVELS):
                tip = frames.levers[0]
            axes = wp.matrix_from_cols(x, y, z)
        if wp.static(KEEP_ORIENTATION):
            quat = to_quaternion(axes)
            for i in range(4):
                out[ORIENTATION + i] = quat[i]
        if wp.static(CONSTRAINED):
            out[REASON] = real(rejection(model, q, tip, axes, first + wp.int64(lane)))
        for r in range(3):
            out[r] = tip[r]
        if wp.static(KEEP_CONFIGURATION):
            for i in range(n):
                out[CONFIGURATION + i] = q[i]
        return out

    return positions


@factory
def _evaluation(shape: Shape):
    """Device function ``(model, space, block, first, lane) -> outputs`` of a sample."""
    if not shape.n_indices:
        return _positions(shape)
    real, spectra, around = shape.real, _spectra(shape), _around_values(shape)
    matrices, indices_of = around.matrices, around.indices_of
    # Rotations are long: one function that A and B call compiles in little more than half the time.
    CALLED = shape.many_rows and shape.dynamic
    kinematic_values = singular_values(real, *spectra.kinematic_shape, shape.penalty or CALLED, not CALLED)
    dynamic_values = singular_values(real, *spectra.dynamic_shape, True, not CALLED)
    Model, Space = (
        _model(shape),
        sample_space(real, shape.n),
    )
    FOUND, GIVEN, given_values = shape.n_indices + 2, bool(shape.given_values), _given_values(shape)
    (_, kept), VALUED = _chain_values(shape), bool(shape.chain_values)

    @wp.func(inline=True)
    def evaluate(model: Model, space: Space, block: Any, first: wp.int64, lane: wp.int32):
        out, A, B, volume = matrices(model, space, block, first, lane)
        found = indices_of(volume, kinematic_values(A), dynamic_values(B))
        if wp.static(GIVEN):
            found = given_values(model, space, first + wp.int64(lane), found)
        if wp.static(VALUED):
            found = kept(out, found)
        for k in range(FOUND):
            out[3 + k] = found[k]
        return out

    return evaluate


def _spectra(shape: Shape) -> SimpleNamespace:
    return spectrum(
        shape.real, shape.n, shape.rows, shape.convention, shape.dynamic, shape.penalty, shape.torque_scaling
    )


def _staged_lanes(shape: Shape):
    """Device function ``(model, space, block, first, valid) -> outputs`` of a block, one row of LANES per output.

    In stages, for singular values of many rotations: in a single lane loop they would take long to compile. Those of A
    and of B are taken side by side, by one code: of two columns of lanes, or one.
    """
    real, spectra, around = shape.real, _spectra(shape), _around_values(shape)
    matrices, indices_of = around.matrices, around.indices_of
    (ROWS_A, COLUMNS), (ROWS_B, COLUMNS_B) = spectra.kinematic_shape, spectra.dynamic_shape
    # A B of one number is none, one of fewer columns than A has zeros for the others.
    DYNAMIC = ROWS_B == ROWS_A
    SIDE_BY_SIDE = PART_LANES * (2 if DYNAMIC else 1)
    values_of_lanes = singular_values_of_lanes(real, ROWS_A, COLUMNS, shape.penalty or DYNAMIC, SIDE_BY_SIDE)
    Model, Space = (
        _model(shape),
        sample_space(real, shape.n),
    )
    values_type, numbers_type = wp.types.vector(shape.n_outputs * LANES, real), wp.types.vector(PART_LANES, real)
    lanes_type = wp.types.vector(ROWS_A * COLUMNS * SIDE_BY_SIDE, real)
    sigma_a_type, sigma_b_type = wp.types.vector(ROWS_A, real), wp.types.vector(ROWS_B, real)
    N_OUTPUTS, FOUND, BLOCK, PART = shape.n_outputs, shape.n_indices + 2, LANES, PART_LANES
    GIVEN, given_values = bool(shape.given_values), _given_values(shape)
    VALUED, VALUES = bool(shape.chain_values), len(shape.chain_values)
    PLACES = wp.types.vector(max(VALUES, 1), wp.int32)(*(place for place, _ in shape.chain_values))

    @wp.func(inline=True)
    def staged_lanes(model: Model, space: Space, block: Any, first: wp.int64, valid: wp.int32):
        values = values_type()
        lanes = lanes_type()
        volumes = numbers_type()
        part = wp.int32(0)
        while part < BLOCK:
            for lane in range(PART):
                out, A, B, volume = matrices(model, space, block, first, wp.min(part + lane, valid - 1))
                at = part + lane
                for r in range(N_OUTPUTS):
                    values[at] = out[r]
                    at += BLOCK
                volumes[lane] = volume
                at = lane
                for r in range(ROWS_A):
                    for c in range(COLUMNS):
                        lanes[at] = A[r, c]
                        at += SIDE_BY_SIDE
                if wp.static(DYNAMIC):
                    for r in range(ROWS_A):
                        at = r * wp.static(COLUMNS * SIDE_BY_SIDE) + (PART + lane)
                        for c in range(COLUMNS_B):
                            lanes[at] = B[r, c]
                            at += SIDE_BY_SIDE
            sigma = values_of_lanes(lanes)
            for lane in range(PART):
                sigma_a = sigma_a_type()
                sigma_b = sigma_b_type()
                place = lane
                for r in range(ROWS_A):
                    sigma_a[r] = sigma[place]
                    if wp.static(DYNAMIC):
                        sigma_b[r] = sigma[place + PART]
                    place += SIDE_BY_SIDE
                found = indices_of(volumes[lane], sigma_a, sigma_b)
                if wp.static(GIVEN):
                    found = given_values(model, space, first + wp.int64(wp.min(part + lane, valid - 1)), found)
                if wp.static(VALUED):
                    for g in range(VALUES):
                        found[PLACES[g]] = values[(3 + PLACES[g]) * BLOCK + (part + lane)]
                place = part + lane  # added up in another order, clang does not see that it is no negative index
                for k in range(FOUND):
                    values[(3 + k) * BLOCK + place] = found[k]
            part += PART
        return values

    return staged_lanes


def record_type_of(shape: Shape):
    """Vector type of a voxel's record."""
    return wp.types.vector(shape.record_size, bits_type(shape.real))


def sums_type_of(shape: Shape):
    """Vector type of a voxel's sums."""
    return wp.types.vector(max(shape.sums_size, 1), wp.int64)


@factory
def outputs_type(shape: Shape):
    """Struct with what a sweep adds to: extremes and totals of all samples, voxel records and sums, rows.

    ``extremes`` (2 R,) of the R reduced outputs: largest value and largest complement; ``totals`` (TOTAL_SLOTS * (K +
    C + X),): fixed-point sums of the indices, scaled by ``scales`` (K,), how many samples each of the C constraints
    rejects, and how many values of the X indices that are ``cut`` reach ``cuts`` (X,), in parts; ``records``, ``sums``:
    one vector per voxel;
    ``rows_out`` (n_rows * rows_stride,): row r of the chunk's sample s at [r * rows_stride + s], interleaved ones at
    [s * n_rows + r]. With constraints also ``rejections`` (voxels * C,): samples of a voxel that each rejects; and
    ``earliest`` (C,): the number of the first sample that each does. ``best`` (voxels,): the number of the sample with
    a voxel's maximum of one index, the smallest among equals; that of evaluated sample e at level l of the base joint
    is l ``level_stride`` + e ``weight``. On CUDA a value and a number exceed one atomic operation: the kernel finds
    maxima first, and numbers when it runs once more as the ``second``, by the same code, thus the same bits.
    """
    real, bits = shape.real, bits_type(shape.real)
    record_type, sums_type = record_type_of(shape), sums_type_of(shape)

    class Outputs:
        scales: wp.array(dtype=real)
        extremes: wp.array(dtype=bits)
        totals: wp.array(dtype=wp.int64)
        records: wp.array(dtype=record_type)
        sums: wp.array(dtype=sums_type)
        rows_out: wp.array(dtype=real)
        rows_stride: wp.int64

    if shape.cuts:
        Outputs.__annotations__["cuts"] = wp.array(dtype=real)
    if shape.best is not None:
        Outputs.__annotations__ |= {"best": wp.array(dtype=wp.int64), "second": wp.int32}
        Outputs.__annotations__ |= {"level_stride": wp.int64, "weight": wp.int64}
    if shape.constraints:
        Outputs.__annotations__["earliest"] = wp.array(dtype=wp.int64)
        if shape.voxels:
            Outputs.__annotations__["rejections"] = wp.array(dtype=wp.int64)
    return wp.struct(Outputs)


@factory
def sweep_kernel(shape: Shape, cuda: bool) -> wp.Kernel:
    """The kernel of a shape for the CPU (one task per block) or CUDA (threads that stride through the chunk)."""
    return _cuda_kernel(shape) if cuda else _cpu_kernel(shape)


def _cpu_kernel(shape: Shape) -> wp.Kernel:
    real, K = shape.real, shape.n_indices
    prepare = sampling(real, shape.n, shape.method).prepare
    evaluate = None if shape.many_rows else _evaluation(shape)
    staged_lanes = _staged_lanes(shape) if shape.many_rows else None
    block_of = blocks(real, shape.n, shape.shared)
    ordered = elementary(real).ordered
    cell, quantized = voxels(real).cell, voxels(real).quantized
    Model, Space = (
        _model(shape),
        sample_space(real, shape.n),
    )
    Lattice, Outputs, bits = lattice(real), outputs_type(shape), bits_type(real)
    vec3, Base, at_level = wp.types.vector(3, real), base_levels(real), grid_level(real)
    moved_base = kinematics(real, shape.n, shape.sources, shape.plain, shape.world_axes).moved_base
    record_type, sums_type = record_type_of(shape), sums_type_of(shape)
    N_OUTPUTS, N_ROWS, REDUCED, RECORD = shape.n_outputs, shape.n_rows, shape.reduced, shape.record_size
    INTERLEAVED = shape.keep_rows and shape.interleaved
    OUTPUT = _output_of_row(shape)
    VOXELS, SUMS, BASE_LEVELS = shape.voxels, shape.sums_size > 0, shape.base_levels
    ROWS = shape.keep_rows and not shape.interleaved
    STAGED = shape.many_rows
    CONSTRAINTS, CONSTRAINED = len(shape.constraints), bool(shape.constraints)
    REASON = (shape.n_outputs - 1) * LANES
    CUTS, CUT_TOTALS = len(shape.cuts), K + len(shape.constraints)
    CUT_ROWS = wp.types.vector(max(CUTS, 1), wp.int32)(*((3 + place) * LANES for place in shape.cuts))
    ADMITTED = real(0.0)
    LOWEST = bits(lowest(real))
    LOWEST_ROW = REDUCED * LANES
    LEAST_SUM = wp.int64(-(2**62) - 2**61)
    NARROW, HALF, LOWER_HALF, FROM_UPPER = real is wp.float32, bits(15), bits(2**15 - 1), wp.int64(2**15)
    KEY_ROW, KEY_MASK = _record_keys(shape)
    BEST, BEST_SLOT = shape.best is not None, shape.count_size + (shape.best or 0)
    # The compiler interleaves as many rows at once; an index that is masked by LAST is not negative, as it sees.
    PART, PARTS = min(RECORD, 8), -(-RECORD // 8)
    BLOCK, LAST = LANES, LANES - 1
    load_record, store_record = memory(record_type).load, memory(record_type).store
    load_sums, store_sums = memory(sums_type).load, memory(sums_type).store
    load_count, store_count = memory(wp.int64).load, memory(wp.int64).store
    prefetch_record, prefetch_sums = memory(record_type).prefetch, memory(sums_type).prefetch
    prefetch_count = memory(wp.int64).prefetch
    # Scratch in rows of LANES. Vectors on the stack: of an array, neither the stride nor what else points to it is
    # known when the kernel is compiled, and the lane loop would be compiled twice, without SIMD the second time.
    values_type = wp.types.vector(N_OUTPUTS * LANES, real)
    keys_type = wp.types.vector((REDUCED + 1) * LANES, bits)
    quanta_type = wp.types.vector(max(K, 1) * LANES, bits)
    cells_type = wp.types.vector(LANES, wp.int32)
    samples_type = wp.types.vector(RECORD * LANES, bits)
    levers_type = wp.types.vector(3 * LANES, real)

    options = LONG_OPTIONS if shape.dynamic or shape.many_rows else SHORT_OPTIONS

    @wp.kernel(module="unique", module_options=options, enable_backward=False)
    def sweep_cpu(
        # in
        model: Model,
        space: Space,
        base: Base,
        grid: Lattice,
        first: wp.int64,
        count: wp.int64,
        # out
        to: Outputs,
    ):
        align_scratch()
        mode = denormals_to_zero()
        start, valid = block_of(space, first, count, wp.tid())
        block = prepare(space, start)
        values = values_type()
        keys = keys_type()
        quanta = quanta_type()
        cells = cells_type()
        levers = levers_type()
        if wp.static(CONSTRAINED):
            counts = cells_type()  # of rejected samples; admitted ones count in the spare voxel
            order = cells_type()
            samples = samples_type()

        if wp.static(STAGED):
            values = staged_lanes(model, space, block, start, valid)
        else:
            for lane in range(BLOCK):
                # The lanes past the end repeat the last sample: harmless in extremes, masked in counts and sums.
                out = evaluate(model, space, block, start, wp.min(lane, valid - 1))
                for r in range(N_OUTPUTS):
                    values[r * BLOCK + lane] = out[r]
        if wp.static(BASE_LEVELS):
            for r in range(3):
                for lane in range(BLOCK):
                    levers[r * BLOCK + lane] = values[r * BLOCK + lane]

        levels = wp.int32(1)
        if wp.static(BASE_LEVELS):
            levels = base.levels
        for level in range(levels):
            if wp.static(BASE_LEVELS):
                angle = at_level(base.lower, base.upper, base.step, level, base.levels)
                for lane in range(BLOCK):
                    lever = vec3(levers[lane], levers[BLOCK + lane], levers[2 * BLOCK + lane])
                    tip = moved_base(model.chain, angle, lever)
                    for r in range(3):
                        values[r * BLOCK + lane] = tip[r]
            if wp.static(VOXELS):
                for lane in range(BLOCK):
                    cells[lane] = cell(grid, vec3(values[lane], values[BLOCK + lane], values[2 * BLOCK + lane]))
                    if wp.static(CONSTRAINED):
                        reason = wp.int32(values[REASON + lane])
                        counts[lane] = wp.where(reason > 0, cells[lane], grid.spare) * CONSTRAINTS
                        counts[lane] += wp.max(reason - 1, 0)
                        cells[lane] = wp.where(reason > 0, grid.spare, cells[lane])

            # While, or Warp would write the loops over outputs out, and their lane loops as often.
            r = wp.int32(0)
            while r < REDUCED:
                largest = LOWEST
                smallest = ~LOWEST
                row = r * BLOCK
                for lane in range(BLOCK):
                    key = ordered(values[row + lane])
                    keys[row + lane] = key
                    if wp.static(CONSTRAINED):
                        admitted = values[REASON + lane] == ADMITTED
                        largest = wp.max(largest, wp.where(admitted, key, LOWEST))
                        smallest = wp.min(smallest, wp.where(admitted, key, ~LOWEST))
                    else:
                        largest = wp.max(largest, key)
                        smallest = wp.min(smallest, key)
                to.extremes[2 * r] = wp.max(to.extremes[2 * r], largest)
                to.extremes[2 * r + 1] = wp.max(to.extremes[2 * r + 1], ~smallest)
                r += 1

            k = wp.int32(0)
            while k < K:
                # Sums of 256 quanta of 30 bits need 38: two halves stay in the SIMD lanes of 32, one of 64 would not.
                upper = bits(0)
                lower = bits(0)
                scale = to.scales[k]
                row = (3 + k) * BLOCK
                target = k * BLOCK
                for lane in range(BLOCK):
                    quantum = quantized(values[row + lane], scale)
                    if wp.static(CONSTRAINED):
                        quantum = wp.where(values[REASON + lane] == ADMITTED, quantum, bits(0))
                    quanta[target + lane] = quantum
                    if wp.static(NARROW):
                        upper += quantum >> HALF
                        lower += quantum & LOWER_HALF
                    else:
                        lower += quantum
                repeated = wide(BLOCK - valid) * wp.int64(quantized(values[row + valid - 1], scale))
                if wp.static(CONSTRAINED):
                    repeated = wide(BLOCK - valid) * wp.int64(quanta[target + valid - 1])
                to.totals[k] = to.totals[k] + wp.int64(upper) * FROM_UPPER + wp.int64(lower) - repeated
                k += 1

            if wp.static(CONSTRAINED):
                for c in range(CONSTRAINTS):
                    rejected = wp.int32(0)
                    earliest = wp.int32(BLOCK)
                    for lane in range(BLOCK):
                        of_this = values[REASON + lane] == real(c + 1) and lane < valid
                        rejected += wp.where(of_this, 1, 0)
                        earliest = wp.min(earliest, wp.where(of_this, lane, BLOCK))
                    to.totals[K + c] = to.totals[K + c] + wp.int64(rejected)
                    if rejected > 0:
                        to.earliest[c] = wp.min(to.earliest[c], start + wp.int64(earliest))

            if wp.static(CUTS > 0):
                for x in range(CUTS):
                    cut = wp.int32(0)
                    for lane in range(BLOCK):
                        reaches = values[CUT_ROWS[x] + lane] >= to.cuts[x] and lane < valid
                        if wp.static(CONSTRAINED):
                            reaches = reaches and values[REASON + lane] == ADMITTED
                        cut += wp.where(reaches, 1, 0)
                    to.totals[CUT_TOTALS + x] = to.totals[CUT_TOTALS + x] + wp.int64(cut)

            if wp.static(VOXELS):
                # Touch all target records first: their cache misses then overlap, which halves the time.
                if wp.static(CONSTRAINED):
                    for lane in range(BLOCK):
                        prefetch_record(to.records, cells[lane])
                        if wp.static(SUMS):
                            prefetch_sums(to.sums, cells[lane])
                        prefetch_count(to.rejections, counts[lane])
                    for lane in range(BLOCK):
                        keys[LOWEST_ROW + lane] = LOWEST
                    # Sample by sample, as records are: to gather each by itself takes longer.
                    for part in range(PARTS):
                        for lane in range(BLOCK):
                            for k in range(PART):
                                key = keys[KEY_ROW[part * PART + k] * BLOCK + lane] ^ KEY_MASK[part * PART + k]
                                samples[(part * BLOCK + lane) * PART + k] = key
                else:
                    largest_count = LOWEST
                    smallest_sum = wp.int64(0)
                    for lane in range(BLOCK):
                        largest_count = wp.max(largest_count, load_record(to.records, cells[lane])[0])
                        if wp.static(SUMS):
                            smallest_sum = wp.min(smallest_sum, load_sums(to.sums, cells[lane])[0])
                    # Neither is ever true (a count has no such value, a sum fewer bits), but the compiler does not
                    # know: it would drop the loop above.
                    lowest_key = wp.where(largest_count == ~LOWEST or smallest_sum < LEAST_SUM, ~LOWEST, LOWEST)
                    for lane in range(BLOCK):
                        keys[LOWEST_ROW + lane] = lowest_key
                ends = valid
                if wp.static(CONSTRAINED):
                    # Admitted ones from the front, rejected ones from the back: branches would often be mispredicted.
                    ends = wp.int32(0)
                    begins = valid
                    for lane in range(valid):
                        order[ends & LAST] = lane
                        order[(begins - 1) & LAST] = lane
                        step = wp.where(values[REASON + (lane & LAST)] == ADMITTED, 1, 0)
                        ends += step
                        begins += step - 1
                    for place in range(ends, valid):
                        counter = counts[order[place & LAST] & LAST]
                        store_count(to.rejections, counter, load_count(to.rejections, counter) + wp.int64(1))
                for place in range(ends):
                    lane = place
                    if wp.static(CONSTRAINED):
                        lane = order[place & LAST] & LAST
                    voxel = cells[lane]
                    # Every slot is read and compared alike, count and padding against LOWEST: one SIMD operation.
                    sample = record_type()
                    for k in range(RECORD):
                        if wp.static(CONSTRAINED):
                            sample[k] = samples[(k // PART * BLOCK + lane) * PART + k % PART]
                        else:
                            sample[k] = keys[KEY_ROW[k] * BLOCK + lane] ^ KEY_MASK[k]
                    record = load_record(to.records, voxel)
                    if wp.static(BEST):
                        number = wide(level) * to.level_stride + (start + wide(lane)) * to.weight
                        highest = record[BEST_SLOT]
                        key = sample[BEST_SLOT]
                        if key > highest or (key == highest and number < load_count(to.best, voxel)):
                            store_count(to.best, voxel, number)
                    for k in range(RECORD):
                        record[k] = wp.max(record[k], sample[k])
                    record[0] += bits(1)  # no carry: see FOLD_AFTER of the engine
                    store_record(to.records, voxel, record)
                    if wp.static(SUMS):
                        addend = sums_type()
                        for k in range(K):
                            addend[k] = wp.int64(quanta[k * BLOCK + lane])
                        store_sums(to.sums, voxel, load_sums(to.sums, voxel) + addend)

        if wp.static(INTERLEAVED):
            for lane in range(valid):
                at_sample = (start - first + wide(lane)) * wide(N_ROWS)
                for row in range(N_ROWS):
                    to.rows_out[at_sample + wide(row)] = values[row * BLOCK + lane]
        if wp.static(ROWS):
            for row in range(N_ROWS):
                r = OUTPUT[row]
                at = wide(row) * to.rows_stride + (start - first)
                for lane in range(valid):
                    to.rows_out[at + wide(lane)] = values[r * BLOCK + lane]
        restore_denormals(mode)

    return sweep_cpu


def _output_of_row(shape: Shape):
    """Of every kept row its output: the singular values come after the indices."""
    values = shape.reduced - shape.singular_values
    outputs = [r for r in range(shape.n_outputs) if not values <= r < shape.reduced]
    return wp.types.vector(shape.n_rows, wp.int32)(*outputs)


def _record_keys(shape: Shape):
    """Of every slot of a record: its row among the ordered values, and what complements it (minima)."""
    K, lowest_row = shape.n_indices, shape.reduced
    rows, masks = [lowest_row] * shape.count_size, [0] * shape.count_size
    for kept, mask in ((shape.maximum, 0), (shape.minimum, -1)):
        rows += [3 + k for k in range(K) if kept]
        masks += [mask] * (K * kept)
    padding = shape.record_size - len(rows)
    rows, masks = rows + [lowest_row] * padding, masks + [0] * padding
    size = shape.record_size
    return wp.types.vector(size, wp.int32)(*rows), wp.types.vector(size, bits_type(shape.real))(*masks)


def _cuda_kernel(shape: Shape) -> wp.Kernel:
    """Threads stride through the chunk and keep their totals in registers, so that few atomics meet on one address."""
    real, K = shape.real, shape.n_indices
    prepare, evaluate = sampling(real, shape.n, shape.method).prepare, _evaluation(shape)
    ordered = elementary(real).ordered
    cell, quantized = voxels(real).cell, voxels(real).quantized
    Model, Space = (
        _model(shape),
        sample_space(real, shape.n),
    )
    Lattice, Outputs, bits = lattice(real), outputs_type(shape), bits_type(real)
    vec3, Base, at_level = wp.types.vector(3, real), base_levels(real), grid_level(real)
    moved_base = kinematics(real, shape.n, shape.sources, shape.plain, shape.world_axes).moved_base
    REDUCED, OUTPUT = shape.reduced, _output_of_row(shape)
    CONSTRAINTS, CONSTRAINED, REASON = len(shape.constraints), bool(shape.constraints), shape.n_outputs - 1
    TOTALS, CUTS, CUT_TOTALS = shape.n_totals, len(shape.cuts), K + CONSTRAINTS
    CUT_OUTPUTS = wp.types.vector(max(CUTS, 1), wp.int32)(*(3 + place for place in shape.cuts))
    ADMITTED = real(0.0)
    extremes_type, totals_type = wp.types.vector(REDUCED, bits), wp.types.vector(max(TOTALS, 1), wp.int64)
    earliest_type, LAST = wp.types.vector(max(CONSTRAINTS, 1), wp.int64), wp.int64(2**63 - 1)
    N_ROWS, RECORD, SUMS_SIZE = shape.n_rows, shape.record_size, shape.sums_size
    INTERLEAVED = shape.keep_rows and shape.interleaved
    VOXELS, MAXIMUM, MINIMUM, SUMS = shape.voxels, shape.maximum, shape.minimum, shape.sums_size > 0
    ROWS = shape.keep_rows and not shape.interleaved
    BASE_LEVELS = shape.base_levels
    FIRST_MAXIMUM, FIRST_MINIMUM = shape.count_size, shape.count_size + K * shape.maximum
    LOWEST = bits(lowest(real))
    LANE_MASK = wp.int64(LANES - 1)
    COUNT = shape.record_size // shape.count_size
    BEST, BEST_OUTPUT, BEST_SLOT = shape.best is not None, 3 + (shape.best or 0), FIRST_MAXIMUM + (shape.best or 0)
    add, raise_to = cuda_atomics(wp.int64).add, cuda_atomics(bits).raise_to
    store_row, load_record = memory(real).store, memory(record_type_of(shape)).load

    options = {**(LONG_CUDA_OPTIONS if shape.long else CUDA_OPTIONS), "block_dim": BLOCK_CUDA[real]}
    few = real is wp.float64 and not (shape.dynamic or shape.many_rows or shape.penalty)

    @wp.kernel(
        module="unique",
        module_options=options,
        enable_backward=False,
        grid_stride=False,
        cuda_max_registers=REGISTERS_CUDA if few else None,
    )
    def sweep_cuda(
        # in
        model: Model,
        space: Space,
        base: Base,
        grid: Lattice,
        first: wp.int64,
        count: wp.int64,
        threads: wp.int64,
        # out
        to: Outputs,
        # the memory of to.records, as 64-bit counts and integer by integer, and of to.sums
        counts: wp.array(dtype=wp.int64),
        records: wp.array(dtype=bits),
        sums: wp.array(dtype=wp.int64),
    ):
        thread = wp.tid()
        one = wp.int64(1)
        if wp.static(BEST):
            one -= wp.int64(to.second)  # what has been counted is not counted again
        largest = extremes_type()
        smallest = extremes_type()
        total = totals_type()
        for r in range(REDUCED):
            largest[r] = LOWEST
            smallest[r] = ~LOWEST
        if wp.static(CONSTRAINED):
            earliest = earliest_type()
            for c in range(CONSTRAINTS):
                earliest[c] = LAST
        offset = wp.int64(thread)
        while offset < count:
            index = first + offset
            start = index - (index & LANE_MASK)
            block = prepare(space, start)
            out = evaluate(model, space, block, start, wp.int32(index & LANE_MASK))
            lever = vec3(out[0], out[1], out[2])
            levels = wp.int32(1)
            if wp.static(BASE_LEVELS):
                levels = base.levels
            for level in range(levels):
                if wp.static(BASE_LEVELS):
                    angle = at_level(base.lower, base.upper, base.step, level, base.levels)
                    tip = moved_base(model.chain, angle, lever)
                    for r in range(3):
                        out[r] = tip[r]
                if wp.static(CONSTRAINED):
                    admitted = out[REASON] == ADMITTED
                    for c in range(CONSTRAINTS):
                        of_this = out[REASON] == real(c + 1)
                        total[K + c] += wp.where(of_this, wp.int64(1), wp.int64(0))
                        earliest[c] = wp.min(earliest[c], wp.where(of_this, index, LAST))
                for r in range(REDUCED):
                    key = ordered(out[r])
                    if wp.static(CONSTRAINED):
                        largest[r] = wp.max(largest[r], wp.where(admitted, key, LOWEST))
                        smallest[r] = wp.min(smallest[r], wp.where(admitted, key, ~LOWEST))
                    else:
                        largest[r] = wp.max(largest[r], key)
                        smallest[r] = wp.min(smallest[r], key)
                for k in range(K):
                    quantum = wp.int64(quantized(out[3 + k], to.scales[k]))
                    if wp.static(CONSTRAINED):
                        quantum = wp.where(admitted, quantum, wp.int64(0))
                    total[k] += quantum
                for x in range(CUTS):
                    reaches = out[CUT_OUTPUTS[x]] >= to.cuts[x]
                    if wp.static(CONSTRAINED):
                        reaches = reaches and admitted
                    total[CUT_TOTALS + x] += wp.where(reaches, wp.int64(1), wp.int64(0))
                if wp.static(VOXELS):
                    voxel = cell(grid, vec3(out[0], out[1], out[2]))
                    if wp.static(CONSTRAINED):  # noqa: SIM102
                        if not admitted:
                            add(to.rejections, voxel * CONSTRAINTS + wp.int32(out[REASON]) - 1, one)
                            voxel = grid.spare
                    if voxel != grid.spare:
                        at = voxel * RECORD
                        add(counts, voxel * COUNT, one)
                        # Extremes only grow: a value that an old reading already covers needs no atomic operation.
                        seen = load_record(to.records, voxel)
                        if wp.static(BEST):  # noqa: SIM102
                            if to.second != 0 and ordered(out[BEST_OUTPUT]) == seen[BEST_SLOT]:
                                wp.atomic_min(to.best, voxel, wide(level) * to.level_stride + index * to.weight)
                        for k in range(K):
                            key = ordered(out[3 + k])
                            if wp.static(MAXIMUM):  # noqa: SIM102 - compiled out before seen is indexed
                                if key > seen[FIRST_MAXIMUM + k]:
                                    raise_to(records, at + FIRST_MAXIMUM + k, key)
                            if wp.static(MINIMUM):  # noqa: SIM102
                                if ~key > seen[FIRST_MINIMUM + k]:
                                    raise_to(records, at + FIRST_MINIMUM + k, ~key)
                            if wp.static(SUMS):
                                quantum = wp.int64(quantized(out[3 + k], to.scales[k]))
                                add(sums, voxel * SUMS_SIZE + k, one * quantum)
            if wp.static(ROWS):
                for row in range(N_ROWS):
                    at_row = row * wp.int32(to.rows_stride) + wp.int32(offset)
                    store_row(to.rows_out, at_row, out[OUTPUT[row]])
            if wp.static(INTERLEAVED):
                for row in range(N_ROWS):
                    store_row(to.rows_out, wp.int32(offset) * N_ROWS + row, out[row])
            offset += threads
        if wp.int64(thread) < count:
            for r in range(REDUCED):
                if largest[r] > to.extremes[2 * r]:
                    wp.atomic_max(to.extremes, 2 * r, largest[r])
                if ~smallest[r] > to.extremes[2 * r + 1]:
                    wp.atomic_max(to.extremes, 2 * r + 1, ~smallest[r])
            slot = (thread % TOTAL_SLOTS) * TOTALS
            for k in range(TOTALS):
                wp.atomic_add(to.totals, slot + k, one * total[k])
            if wp.static(CONSTRAINED):
                for c in range(CONSTRAINTS):
                    wp.atomic_min(to.earliest, c, earliest[c])

    return sweep_cuda
