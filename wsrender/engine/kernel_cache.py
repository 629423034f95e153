"""Kernels ready to launch: compiled once, whatever number of processes needs them at the same time."""

import hashlib
import os
import threading
from contextlib import suppress
from functools import cache
from pathlib import Path

import warp as wp
from filelock import FileLock
from wsrender_kernels.options import BLOCK_CPU, BLOCK_CUDA, CPU_FLAGS, CPU_OPTIONS

_loading = threading.Lock()  # LLVM's options are the process's: two compilations at a time could mix theirs


def loaded(kernel: wp.Kernel, *devices: wp.Device) -> wp.Kernel:
    """The kernel, compiled for devices or taken from Warp's cache; another process that compiles it is waited for."""
    for device in devices:
        _load(kernel, device.alias)
    return kernel


@cache
def _load(kernel: wp.Kernel, device: str) -> None:
    assert wp.config.kernel_cache_dir is not None  # set by wp.init
    folder = Path(wp.config.kernel_cache_dir)
    kept = _keep_header(folder)
    with _loading, FileLock(folder / f"{kernel.module.name}.lock"):
        kernel.module.load(device, block_dim=BLOCK_CPU if device == "cpu" else BLOCK_CUDA)
    if kept:
        _share_header(kept, kernel.module.options["cpu_compiler_flags"])


@cache
def _keep_header(folder: Path) -> Path | None:
    """Have Warp keep its precompiled C++ header beside the kernels; each thread that compiles would make it in 1.6 s.

    Clang writes the file whole or not at all, and refuses one made from other headers, for another processor or by
    another compiler: those have folders of their own. Returns that folder.
    """
    try:  # Warp has no setting for it
        from warp._src.context import _get_cpu_target_hash, runtime
    except ImportError:
        return None  # a later Warp, which compiles as it comes
    builtin = Path(wp.__file__).parent / "native" / "builtin.h"
    made_of = f"{builtin} {builtin.stat().st_mtime_ns} {_get_cpu_target_hash(CPU_FLAGS)}"
    kept = folder / f"header_{hashlib.sha256(made_of.encode()).hexdigest()[:16]}"

    def header_folder() -> str:
        kept.mkdir(parents=True, exist_ok=True)
        return str(kept)

    runtime.get_clang_pch_dir = header_folder
    return kept


def _share_header(kept: Path, flags: str) -> None:
    """Have kernels of other options use the header made with these.

    Warp names the file by all flags, but the optimizer's, which alone differ, change none of its bytes.
    """
    for made in kept.glob(f"*_f{_in_header_name(flags)}.pch"):
        for options in CPU_OPTIONS:
            name = made.name.replace(_in_header_name(flags), _in_header_name(options["cpu_compiler_flags"]))
            with suppress(OSError):  # there already, or no links on this file system: then another is made
                os.link(made, made.with_name(name))


@cache
def _in_header_name(flags: str) -> str:
    """Warp's digest of compiler flags: FNV-1a, each flag ended by a zero."""
    digest = 0xCBF29CE484222325
    for byte in "".join(f"{flag}\0" for flag in flags.split()).encode():
        digest = (digest ^ byte) * 0x100000001B3 % 2**64
    return f"{digest:016x}"
