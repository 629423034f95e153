"""Kernels ready to launch: compiled once, whatever number of processes needs them at the same time."""

import hashlib
import os
import threading
from contextlib import suppress
from functools import cache
from pathlib import Path

import warp as wp
from filelock import FileLock
from wsrender_kernels.options import BLOCK_CPU, CPU_FLAGS, CPU_OPTIONS

_loading = threading.Lock()  # LLVM's options are the process's: two compilations at a time could mix theirs


def loaded(kernel: wp.Kernel, *devices: wp.Device) -> wp.Kernel:
    """The kernel, compiled for devices or taken from Warp's cache; another process that compiles it is waited for."""
    for device in devices:
        _load(kernel, device.alias)
    return kernel


def launch(kernel: wp.Kernel, dim: int, inputs: list, outputs: list, device: wp.Device) -> None:
    """Launch a `loaded` kernel, with as many threads per block as it is compiled for."""
    block = _threads_per_block(kernel, device.alias)
    wp.launch(kernel, dim=dim, inputs=inputs, outputs=outputs, device=device, block_dim=block)


@cache
def _load(kernel: wp.Kernel, device: str) -> None:
    assert wp.config.kernel_cache_dir is not None  # set by wp.init
    folder = Path(wp.config.kernel_cache_dir)
    kept = _keep_header(folder)
    with _loading, FileLock(folder / f"{kernel.module.name}.lock"):
        kernel.module.load(device, block_dim=_threads_per_block(kernel, device))
    if kept:
        _share_header(kept, kernel.module.options["cpu_compiler_flags"])


def _threads_per_block(kernel: wp.Kernel, device: str) -> int:
    return BLOCK_CPU if device == "cpu" else kernel.module.options["block_dim"]


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
