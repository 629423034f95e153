"""Denormal numbers are zeros where a kernel asks for it, and for nobody else."""

import platform

import numpy as np
import pytest
import warp as wp
from wsrender_kernels.denormals import denormals_to_zero, restore_denormals
from wsrender_kernels.options import MODULE_OPTIONS


@wp.kernel(module="unique", module_options=MODULE_OPTIONS, enable_backward=False)
def products(x: wp.array(dtype=wp.float32), out: wp.array(dtype=wp.float32)):
    out[0] = x[0] * x[1]
    mode = denormals_to_zero()
    out[1] = x[2] * x[3]
    out[2] = x[4] * x[5]
    restore_denormals(mode)
    out[3] = x[6] * x[7]


@pytest.mark.skipif(platform.machine() not in ("x86_64", "AMD64"), reason="the mode is that of x86 processors")
def test_denormals_are_zeros_in_between():
    small, denormal = np.float32(1e-20), np.float32(1e-40)
    x = wp.array(np.array([small, small, small, small, denormal, 8, denormal, 8], np.float32), device="cpu")
    out = wp.zeros(4, dtype=wp.float32, device="cpu")
    wp.launch(products, 1, [x], [out], device="cpu")
    assert (out.numpy() == np.array([small * small, 0, 0, 8 * denormal], np.float32)).all()
    assert np.float32(1e-30) * np.float32(1e-10) > 0
