"""Small matrices: right, and the same on every machine."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wsrender.robots.small_matrices import applied, principal_axes, product

NUMBERS = st.floats(-1e3, 1e3)
HASHES = """
import wsrender as ws
from wsrender.robots import library
row = ws.DHRow(a=.3, alpha=.4, d=.1, theta=.2, mass=2., center_of_mass=(.1, .02, .03),
                inertia=(.02, .03, .04, .001, .002, .003))
dh = ws.DHTable(convention="standard", rows=[row] * 3)
for robot in (*library.names(), dh):
    print(ws.load_robot(robot).chain.content_hash)
"""


@given(st.lists(NUMBERS, min_size=6, max_size=6), st.floats(-9, 0))
def test_principal_axes(numbers, exponent):
    xx, yy, zz, xy, xz, yz = np.array(numbers) * 10**exponent
    A = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    values, V = principal_axes(A)
    size = np.abs(A).max() or 1.0
    np.testing.assert_allclose(values / size, np.linalg.eigvalsh(A) / size, atol=4e-15)
    np.testing.assert_allclose(V.T @ V, np.eye(3), atol=2e-15)
    np.testing.assert_allclose((V * values) @ V.T / size, A / size, atol=4e-15)


@pytest.mark.parametrize("wrong", [np.nan, np.inf])
def test_principal_axes_of_no_numbers(wrong):
    with pytest.raises(np.linalg.LinAlgError):
        principal_axes(np.full((3, 3), wrong))


def test_products():
    A, B, C, x = (np.random.default_rng(0).normal(size=shape) for shape in ((5, 4, 3), (3, 2), (2, 6), (5, 3)))
    np.testing.assert_allclose(product(A, B, C), A @ B @ C, rtol=1e-13, atol=1e-13)
    np.testing.assert_allclose(applied(A, x), (A @ x[..., None])[..., 0], rtol=1e-13, atol=1e-13)


@pytest.mark.skipif(
    not Path("/proc/cpuinfo").exists() or "avx512f" not in Path("/proc/cpuinfo").read_text(),
    reason="needs a processor with AVX-512, for which OpenBLAS has other kernels",
)
def test_hashes_of_chains_are_those_of_other_machines():
    found = []
    for kind in ("Haswell", "SkylakeX"):
        environment = {**os.environ, "OPENBLAS_CORETYPE": kind}
        ran = subprocess.run([sys.executable, "-c", HASHES], env=environment, capture_output=True, timeout=120)
        assert ran.returncode == 0, ran.stderr.decode()
        found.append(ran.stdout.splitlines())
    assert found[0] == found[1] and len(found[0]) > 20
