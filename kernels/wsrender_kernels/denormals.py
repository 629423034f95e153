"""Denormal numbers as zeros: one below 1e-38 (float32) would cost a CPU more than a hundred cycles.

They come up in small differences of small numbers, such as the last columns of J M^-1 or rotations by almost nothing.
"""

import warp as wp


@wp.func_native("""
#if defined(__x86_64__)
    unsigned int before = __builtin_ia32_stmxcsr();
    __builtin_ia32_ldmxcsr(before | 0x8040); // of results and of operands
    return before;
#else
    return 0;
#endif
""")
def denormals_to_zero() -> wp.uint32:
    """Switch this thread over; returns the mode before, for `restore_denormals`."""
    ...


@wp.func_native("""
#if defined(__x86_64__)
    __builtin_ia32_ldmxcsr(mode);
#endif
""")
def restore_denormals(mode: wp.uint32):
    """Give the thread its mode back."""
    ...
