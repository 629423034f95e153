"""Elements of arrays by pointer.

An array of Warp has a stride known at run time only and counts negative indices from its end: ten operations for
an address, which the compiler cannot leave out. The sweep's arrays are contiguous, and no index is negative.
"""

from types import SimpleNamespace
from typing import Any

import warp as wp

from wsrender_kernels.factories import factory

_ATOMIC_POINTER = {wp.int32: "reinterpret_cast<int*>", wp.int64: "reinterpret_cast<long long*>"}


@wp.func_native("""
    alignas(64) char lowest[4096];
    asm volatile("" : : "r"(lowest));
""")
def align_scratch():
    """On the CPU, have the scratch of the kernel that calls this start with a cache line.

    A vector of floats asks for the alignment of a float, and half or all of its SIMD accesses lie across two lines. But
    the compiler lays the objects of a stack side by side, the ones it uses least per byte first: such a one, and all
    that follow in sizes of whole lines, begin where it asks for. Six indices on AVX2: 2.5 % faster.
    """
    ...


_PREFETCH = """
    const char* element = reinterpret_cast<const char*>(array.data + i);
    for (int line = 0; line < (int)sizeof(*array.data); line += 64) __builtin_prefetch(element + line, 1);
"""


@factory
def memory(dtype: Any) -> SimpleNamespace:
    """Device functions ``load(array, i) -> value`` and ``store(array, i, value)`` of contiguous arrays of a type.

    And, for the CPU, ``prefetch(array, i)``: an element that is written soon comes into the cache.
    """
    array_type = wp.array(dtype=dtype)

    @wp.func_native("return array.data[i];")
    def load(array: array_type, i: wp.int32) -> dtype: ...

    @wp.func_native("array.data[i] = value;")
    def store(array: array_type, i: wp.int32, value: dtype): ...

    @wp.func_native(_PREFETCH)
    def prefetch(array: array_type, i: wp.int32): ...

    return SimpleNamespace(load=load, store=store, prefetch=prefetch)


@factory
def cuda_atomics(dtype: Any) -> SimpleNamespace:
    """CUDA functions ``add(array, i, value)`` (64-bit integers) and ``raise_to(array, i, value)`` (signed integers)."""
    array_type = wp.array(dtype=dtype)

    @wp.func_native("atomicAdd(reinterpret_cast<unsigned long long*>(array.data) + i, (unsigned long long)value);")
    def add(array: array_type, i: wp.int32, value: dtype): ...

    @wp.func_native(f"atomicMax({_ATOMIC_POINTER[dtype]}(array.data) + i, value);")
    def raise_to(array: array_type, i: wp.int32, value: dtype): ...

    return SimpleNamespace(add=add, raise_to=raise_to)
