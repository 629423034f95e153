"""The scrambled Sobol sequence: SciPy's direction numbers, and the net properties that scrambling keeps."""

import numpy as np
import pytest
from scipy.stats import qmc
from wsrender_kernels.sampling import SOBOL_BITS

import wsrender as ws
from wsrender.engine import configurations
from wsrender.pipeline.pipeline import tip_pipeline
from wsrender.pipeline.sampling import scrambled_sobol, sobol_directions

CHAIN = ws.load_robot("ur5e").chain


def fractions(count, seed, first=0):
    pipeline = tip_pipeline(CHAIN, ws.Sobol(2**40, seed=seed))
    q = configurations(pipeline, np.arange(first, first + count))
    return (q - CHAIN.lower_limits) / (CHAIN.upper_limits - CHAIN.lower_limits)


@pytest.mark.parametrize("dimensions", [1, 2, 7, 16])
def test_unscrambled_points_are_scipys(dimensions):
    """Joe and Kuo's direction numbers, in Gray-code order."""
    directions = sobol_directions(dimensions)
    points = np.zeros((512, dimensions), np.uint64)
    for i in range(1, 512):
        bit = (i & -i).bit_length() - 1
        points[i] = points[i - 1] ^ directions[:, bit]
    expected = qmc.Sobol(dimensions, scramble=False, bits=30).random(512)
    assert (points.astype(np.float64) * 2.0**-64 == expected).all()


@pytest.mark.parametrize("seed", [0, 1, 2**63 - 1])
@pytest.mark.parametrize("power", [0, 3, 8, 12])
def test_every_elementary_interval_has_one_point(seed, power):
    """2^k consecutive points from a multiple of 2^k: one in each interval of length 2^-k, in every dimension."""
    count = 2**power
    for first in (0, 5 * count, 2**33):
        cells = np.sort(np.floor(fractions(count, seed, first) * count), axis=0)
        assert (cells == np.arange(count)[:, None]).all()


def test_two_dimensional_nets():
    """The first two dimensions are a (0, m, 2)-net: every dyadic box of volume 2^-m holds one point."""
    m = 10
    u = fractions(2**m, seed=4)
    for k in range(m + 1):
        cell = np.floor(u[:, 0] * 2**k) * 2 ** (m - k) + np.floor(u[:, 1] * 2 ** (m - k))
        assert len(np.unique(cell)) == 2**m


def test_discrepancy_is_scipys():
    ours = np.mean([qmc.discrepancy(fractions(1024, seed)) for seed in range(8)])
    theirs = np.mean([qmc.discrepancy(qmc.Sobol(6, rng=seed).random(1024)) for seed in range(8)])
    random = qmc.discrepancy(np.random.default_rng(0).random((1024, 6)))
    assert ours < 1.2 * theirs and ours < 0.2 * random


def test_scrambling_depends_on_the_seed_and_skips_locked_joints():
    free = np.array([True, False, True])
    directions, shift = scrambled_sobol(free, 1)
    others, other_shift = scrambled_sobol(free, 2)
    assert (directions[1] == 0).all() and shift[1] == 0
    assert (directions[free] != others[free]).any() and (shift[free] != other_shift[free]).all()
    # Unit triangular scrambling keeps the leading bit of every direction number.
    leading = np.array([int(d).bit_length() for d in directions[0]])
    assert (leading == 64 - np.arange(len(leading))).all()


def test_host_and_kernels_agree_on_the_number_of_bits():
    assert sobol_directions(1).shape[1] == SOBOL_BITS
