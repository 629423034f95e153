"""Accumulation of samples into voxel records and totals, in integers only: the result does not depend on the order.

A voxel record is a row of integers of the precision's width: the count in the first 64 bits, then one per extreme (a
maximum, or a minimum as the maximum of the complement) in `elementary.ordered` form. All start at `lowest`, the count
too, so that filling needs no pattern. Sums are 64-bit fixed point.
"""

from types import SimpleNamespace

import numpy as np
import warp as wp

from wsrender_kernels.elementary import bits_type
from wsrender_kernels.factories import factory


@factory
def lattice(real):
    """Struct with the lattice: voxel edge [m], first voxel and shape of a dense block or of a slab of it along x."""

    @wp.struct
    class Lattice:
        edge: real
        per_edge: real  # 1 / edge, rounded
        first_x: wp.int32
        first_y: wp.int32
        first_z: wp.int32
        size_x: wp.int32
        size_y: wp.int32
        size_z: wp.int32
        spare: wp.int32  # index after the last voxel: for positions outside the slab

    return Lattice


@factory
def voxels(real) -> SimpleNamespace:
    """Device functions ``cell(lattice, position) -> index of the voxel, or spare`` and ``quantized(value, scale)``."""
    Lattice = lattice(real)
    vec3 = wp.types.vector(3, real)
    # Adding 1.5 * 2^52 leaves the rounded integer in the low bits: AVX2 cannot convert doubles to 64-bit integers.
    MAGIC = wp.float64(1.5 * 2.0**52)
    MAGIC_BITS = wp.int64(0x4338000000000000)

    @wp.func
    def along(p: real, edge: real, per_edge: real, first: wp.int32):
        # p / edge correctly rounded (Markstein 1990; the remainder is a fused multiply-add), so that voxels agree with
        # floor(p / r) of any other program, whatever the division of the device.
        quotient = p * per_edge
        quotient = quotient + (p - quotient * edge) * per_edge
        return wp.int32(wp.floor(quotient)) - first

    @wp.func
    def cell(grid: Lattice, p: vec3):
        x = along(p[0], grid.edge, grid.per_edge, grid.first_x)
        y = along(p[1], grid.edge, grid.per_edge, grid.first_y)
        z = along(p[2], grid.edge, grid.per_edge, grid.first_z)
        y = wp.min(wp.max(y, 0), grid.size_y - 1)
        z = wp.min(wp.max(z, 0), grid.size_z - 1)
        # The arithmetic stays within 32 bits whatever x is.
        inside = wp.min(wp.max(x, 0), grid.size_x - 1)
        return wp.where(inside == x, (inside * grid.size_y + y) * grid.size_z + z, grid.spare)

    @wp.func
    def quantized32(value: real, scale: real):
        return wp.int32(wp.rint(value * scale))

    @wp.func
    def quantized64(value: real, scale: real):
        return wp.cast(value * scale + MAGIC, wp.int64) - MAGIC_BITS

    return SimpleNamespace(cell=cell, quantized=quantized32 if real is wp.float32 else quantized64)


QUANTUM_BITS = {wp.float32: 30, wp.float64: 50}  # a quantised value needs at most so many bits


def lowest(real) -> int:
    """Initial value of a record: minus the largest integer of the precision's width (the lowest has no C literal)."""
    return -int(np.iinfo(wp.dtype_to_numpy(bits_type(real))).max)


def decode_extreme(bits: np.ndarray, minimum: bool) -> np.ndarray:
    """Float values of extremes in `elementary.ordered` form (int32 -> float32, int64 -> float64)."""
    bits = ~bits if minimum else bits
    magnitude = np.iinfo(bits.dtype).max
    restored = np.where(bits < 0, bits ^ magnitude, bits)
    return restored.view(np.float32 if bits.dtype == np.int32 else np.float64)
