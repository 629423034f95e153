"""Compiler options of every kernel module."""

import platform

BLOCK_CPU = 1  # threads per block of a launch: kernels are compiled for a number, on CUDA for that of their options

# Whole registers on AVX-512, which clang would halve; a stack aligned to them, or most of what it holds lies across two
# cache lines, by the chance of an address; fused multiply-add; the lane loop's body inlined whole, however long, or it
# is not vectorised; instructions scheduled from both ends of a block and as if it were no loop, so that fewer wait for
# each other. The last two: clang neither names its values nor checks its own work, which takes time and changes no
# byte of the result.
CPU_FLAGS = (
    "-march=native -mstackrealign -mprefer-vector-width=512 -ffp-contract=fast -mllvm=-inline-threshold=100000"
    " -mllvm=-inline-cold-callsite-threshold=3000 -mllvm=-slp-recursion-max-depth=4"
    " -mllvm=-misched-prera-direction=bidirectional -mllvm=-misched-cyclicpath=false -mllvm=-misched-regpressure=false"
    " -discard-value-names -disable-llvm-verifier"
)
# By what they wait for alone, not so that few values live, and by the latencies and ports of Haswell, whatever the CPU
# at hand: clang's models of newer ones leave more waiting. Zen 5, six indices: 21 % faster in float32, 24 % in float64,
# twelve 9 and 19 %; Xeon (Emerald Rapids): 18, 10, 8 and 0 %. Instruction sets stay those of the CPU at hand.
if platform.machine() in ("x86_64", "AMD64"):
    CPU_FLAGS += " -tune-cpu haswell"


def _options(vectors: int) -> dict:
    """``vectors`` of lanes side by side."""
    flags = f"{CPU_FLAGS} -mllvm=-force-vector-interleave={vectors}"
    return {"enable_backward": False, "cpu_compiler_flags": flags}


# Two vectors, since one is a single chain of dependent operations.
MODULE_OPTIONS = _options(2)
# Of kernels for the CPU alone: with the number of threads that it is loaded for, Warp hashes a kernel once, not twice,
# which is a third of what loading it takes.
ON_CPU = {"block_dim": BLOCK_CPU}
SHORT_OPTIONS = {**MODULE_OPTIONS, **ON_CPU}
# An inertia matrix or rotations give one vector enough to do: compiled in two thirds to five sixths of the time. On Zen
# 5 sweeps with an inertia matrix are 15 to 31 % faster, rotations 5 % slower.
LONG_OPTIONS = {**_options(1), **ON_CPU}
CPU_OPTIONS = (MODULE_OPTIONS, LONG_OPTIONS)
# Division and square root of float32 to 2 units in the last place: a third faster.
CUDA_OPTIONS = {**MODULE_OPTIONS, "fast_math": True}
# Compiled in half of the time; where registers run out anyway 3 to 33 % faster (with rotations 5 to 9 % slower), else a
# fifth slower. Warp writes loops over outputs out: this level does not, and what they go through would lie in memory.
LONG_CUDA_OPTIONS = {**CUDA_OPTIONS, "optimization_level": 2, "max_unroll": 24}
