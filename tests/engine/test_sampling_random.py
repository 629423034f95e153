"""Random and boundary-biased samples: pure functions of the index, with the distributions they claim."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

import wsrender as ws
from tests.reference.philox import philox_4x32
from wsrender.engine import configurations
from wsrender.pipeline.pipeline import tip_pipeline
from wsrender.tolerances import SMALLEST_P_VALUE, epsilon

COUNT = 40_000
CHAIN = ws.load_robot("ur5e").chain


def fractions(method, seed, count=COUNT, precision="float64", first=0):
    """Samples as fractions of the limits, (count, n)."""
    pipeline = replace(tip_pipeline(CHAIN, method(2**40, seed=seed)), precision=precision)
    q = configurations(pipeline, np.arange(first, first + count)).astype(np.float64)
    return (q - CHAIN.lower_limits) / (CHAIN.upper_limits - CHAIN.lower_limits)


def twin(seed, index, n=6):
    """The uniforms of samples with these indices: bits of Philox's words as 42-bit fractions, (N, n)."""
    key = np.tile(np.array([seed & 0xFFFFFFFF, seed >> 32], np.uint32), (len(index), 1))
    zero = np.zeros_like(index)

    def bits(part):
        columns = []
        for group in range(-(-n // 6)):
            counter = np.stack([index & 0xFFFFFFFF, index >> 32, zero + group, zero + part], 1)
            w = philox_4x32(counter, key, 7).astype(np.uint64)
            columns += [
                *(w >> 11).T,
                (w[:, 0] % 2**11) * 2**10 + w[:, 1] % 2**10,
                (w[:, 2] % 2**11) * 2**10 + w[:, 3] % 2**10,
            ]
        return np.array(columns[:n]).T

    return (bits(0) << 21 | bits(1)) * 2.0**-42


@pytest.mark.parametrize("seed", [0, 1, 2**32 + 5, 2**63 - 1])
@pytest.mark.parametrize("name", ["scara", "ur5e", "franka_panda"])
def test_random_samples_are_those_of_the_numpy_twin(name, seed):
    index = np.array([0, 1, 255, 256, 257, 1000, 2**32 - 1, 2**32, 2**32 + 1, 2**39 + 77])
    chain = ws.load_robot(name).chain
    pipeline = tip_pipeline(chain, ws.Random(2**40, seed=seed))
    expected = chain.lower_limits + twin(seed, index, chain.n) * (chain.upper_limits - chain.lower_limits)
    assert np.abs(configurations(pipeline, index) - expected).max() <= 4 * epsilon("float64") * 2 * np.pi


@pytest.mark.parametrize(("method", "steepest"), [(ws.Random, 1.0), (ws.BoundaryBiased, np.pi / 2)])
def test_float32_samples_are_the_rounded_float64_ones(method, steepest):
    single, double = fractions(method, 7, precision="float32"), fractions(method, 7)
    # Of 42 random bits float32 keeps 21, then rounds twice at the width of the interval.
    assert np.abs(single - double).max() <= steepest * 2.0**-21 + 2 * epsilon("float32")


def test_random_samples_are_uniform_and_independent():
    u = fractions(ws.Random, 12)
    assert u.min() >= 0 and u.max() < 1
    for column in u.T:
        assert stats.kstest(column, "uniform").pvalue > SMALLEST_P_VALUE
        counts, _ = np.histogram(column, 200, (0, 1))
        assert stats.chisquare(counts).pvalue > SMALLEST_P_VALUE
    for i in range(6):
        for j in range(i):
            counts, _, _ = np.histogram2d(u[:, i], u[:, j], 20, ((0, 1), (0, 1)))
            assert stats.chisquare(counts.ravel()).pvalue > SMALLEST_P_VALUE
    serial = np.corrcoef(np.concatenate([u[:-1], u[1:]], axis=1).T) - np.eye(12)
    assert np.abs(serial).max() < 5 / np.sqrt(COUNT)


def test_seeds_give_unrelated_samples():
    a, b = fractions(ws.Random, 1), fractions(ws.Random, 2)
    assert np.abs(np.corrcoef(a.T, b.T)[:6, 6:]).max() < 5 / np.sqrt(COUNT)


def test_boundary_samples_are_beta_distributed(precision):
    u = fractions(ws.BoundaryBiased, 3, precision=precision)
    assert u.min() >= -epsilon(precision) and u.max() <= 1 + epsilon(precision)
    for column in u.T:
        assert stats.kstest(np.clip(column, 0, 1), stats.beta(0.5, 0.5).cdf).pvalue > SMALLEST_P_VALUE


@pytest.mark.parametrize("method", [ws.Random, ws.BoundaryBiased, ws.Sobol])
def test_a_sample_is_a_function_of_its_index(method, precision):
    pipeline = tip_pipeline(CHAIN, method(2**40, seed=5, locked={CHAIN.joint_names[2]: 0.5}))
    pipeline = replace(pipeline, precision=precision)
    for first in (0, 2**32 - 500, 2**39):
        whole = configurations(pipeline, np.arange(first, first + 1000))
        order = np.random.default_rng(0).permutation(1000)[:257]
        assert (configurations(pipeline, first + order) == whole[order]).all()
        assert (whole[:, 2] == 0.5).all()
        assert np.ptp(whole[:, 0]) > 0.99 * (CHAIN.upper_limits[0] - CHAIN.lower_limits[0])


@pytest.mark.parametrize("count", [1, 31, 255, 256, 257, 1000])
def test_awkward_sizes_are_prefixes(count):
    assert (fractions(ws.Random, 9, count) == fractions(ws.Random, 9, 1000)[:count]).all()
