"""The voxel of a position is floor(p / r) as any other program computes it."""

import numpy as np
import pytest
import warp as wp
from wsrender_kernels.options import CUDA_OPTIONS, MODULE_OPTIONS
from wsrender_kernels.voxels import lattice, voxels

EDGES = (0.001, 0.02, 0.025, 0.1, 1 / 3, 0.7)


def cells_kernel(real, options):
    cell, vec3 = voxels(real).cell, wp.types.vector(3, real)
    Lattice = lattice(real)

    @wp.kernel(module="unique", module_options=options, enable_backward=False)
    def cells(grid: Lattice, x: wp.array(dtype=real), out: wp.array(dtype=wp.int32)):
        i = wp.tid()
        out[i] = cell(grid, vec3(x[i], real(0.0), real(0.0)))

    return cells


@pytest.mark.parametrize("real", [wp.float32, wp.float64], ids=["float32", "float64"])
def test_voxels_are_the_rounded_quotients_floor(real, device):
    number = wp.dtype_to_numpy(real)
    kernel = cells_kernel(real, CUDA_OPTIONS if device.startswith("cuda") else MODULE_OPTIONS)
    grid = lattice(real)()
    grid.first_x, grid.size_x, grid.size_y, grid.size_z, grid.spare = -(10**6), 2 * 10**6, 1, 1, 2 * 10**6
    rng = np.random.default_rng(0)
    for edge in map(number, EDGES):
        multiples = (np.arange(-900, 900) * edge).astype(number)
        near = [np.nextafter(multiples, number(side)) for side in (-np.inf, np.inf)]
        x = np.concatenate([multiples, *near, rng.uniform(-900 * edge, 900 * edge, 20_000).astype(number)])
        x = x[np.abs(x) >= np.finfo(number).tiny]  # fast division takes subnormal numbers for 0
        grid.edge, grid.per_edge = float(edge), float(1 / edge)
        out = wp.zeros(len(x), dtype=wp.int32, device=device)
        wp.launch(kernel, dim=len(x), inputs=[grid, wp.array(x, dtype=real, device=device), out], device=device)
        np.testing.assert_array_equal(out.numpy() - 10**6, np.floor(x / edge).astype(np.int32))
