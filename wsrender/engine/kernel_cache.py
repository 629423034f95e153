"""Kernels ready to launch: compiled once, whatever number of processes needs them at the same time."""

import hashlib
from functools import cache
from pathlib import Path

import warp as wp
from filelock import FileLock
from wsrender_kernels.options import CPU_FLAGS

BLOCK_CPU, BLOCK_CUDA = 1, 256  # threads per block of wp.launch: kernels are compiled for a number


def loaded(kernel: wp.Kernel, *devices: wp.Device) -> wp.Kernel:
    """The kernel, compiled for devices or taken from Warp's cache; another process that compiles it is waited for."""
    for device in devices:
        _load(kernel, device.alias)
    return kernel


@cache
def _load(kernel: wp.Kernel, device: str) -> None:
    assert wp.config.kernel_cache_dir is not None  # set by wp.init
    folder = Path(wp.config.kernel_cache_dir)
    _keep_header(folder)
    with FileLock(folder / f"{kernel.module.name}.lock"):
        kernel.module.load(device, block_dim=BLOCK_CPU if device == "cpu" else BLOCK_CUDA)


@cache
def _keep_header(folder: Path) -> None:
    """Have Warp keep its precompiled C++ header beside the kernels; each thread that compiles would make it in 1.6 s.

    Clang writes the file whole or not at all, and refuses one made from other headers, for another processor or by
    another compiler: those have folders of their own.
    """
    try:  # Warp has no setting for it
        from warp._src.context import _get_cpu_target_hash, runtime
    except ImportError:
        return  # a later Warp, which compiles as it comes
    builtin = Path(wp.__file__).parent / "native" / "builtin.h"
    made_of = f"{builtin} {builtin.stat().st_mtime_ns} {_get_cpu_target_hash(CPU_FLAGS)}"
    kept = folder / f"header_{hashlib.sha256(made_of.encode()).hexdigest()[:16]}"

    def header_folder() -> str:
        kept.mkdir(parents=True, exist_ok=True)
        return str(kept)

    runtime.get_clang_pch_dir = header_folder
