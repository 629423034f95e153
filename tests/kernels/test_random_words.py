"""The counter-based generator against Random123's published known-answer vectors and its NumPy twin."""

import numpy as np
import pytest
import warp as wp
from wsrender_kernels.sampling import random_words, uniform, unit_of

from tests.reference.philox import philox_4x32

# Random123 (D. E. Shaw Research), kat_vectors: rounds, counter, key, result.
PI_COUNTER, PI_KEY = (0x243F6A88, 0x85A308D3, 0x13198A2E, 0x03707344), (0xA4093822, 0x299F31D0)
ZEROS, ONES = (0, 0, 0, 0), (0xFFFFFFFF,) * 4
KNOWN = [
    (7, ZEROS, ZEROS[:2], (0x5F6FB709, 0x0D893F64, 0x4F121F81, 0x4F730A48)),
    (7, ONES, ONES[:2], (0x5207DDC2, 0x45165E59, 0x4D8EE751, 0x8C52F662)),
    (7, PI_COUNTER, PI_KEY, (0x4DFCCABA, 0x190A87F0, 0xC47362BA, 0xB6B5242A)),
    (10, ZEROS, ZEROS[:2], (0x6627E8D5, 0xE169C58D, 0xBC57AC4C, 0x9B00DBD8)),
    (10, ONES, ONES[:2], (0x408F276D, 0x41C83B0E, 0xA20BC7C6, 0x6D5451FD)),
    (10, PI_COUNTER, PI_KEY, (0xD16CFE09, 0x94FDCCEB, 0x5001E420, 0x24126EA1)),
]


@pytest.mark.parametrize(("rounds", "counter", "key", "result"), KNOWN)
def test_the_twin_gives_the_published_answers(rounds, counter, key, result):
    assert tuple(philox_4x32([counter], [key], rounds)[0]) == result


def test_the_kernel_gives_the_words_of_the_twin(device):
    @wp.kernel(module="unique", enable_backward=False)
    def draw_words(given: wp.array2d(dtype=wp.uint32), out: wp.array2d(dtype=wp.uint32)):
        i = wp.tid()
        words = random_words(given[i, 0], given[i, 1], given[i, 2], given[i, 3], given[i, 4], given[i, 5])
        for w in range(4):
            out[i, w] = words[w]

    given = np.random.default_rng(3).integers(0, 2**32, (1000, 6), dtype=np.uint32)
    given[0], given[1] = 0, 0xFFFFFFFF
    out = wp.zeros((len(given), 4), dtype=wp.uint32, device=device)
    wp.launch(draw_words, len(given), [wp.array(given, dtype=wp.uint32, device=device)], [out], device=device)
    assert (out.numpy() == philox_4x32(given[:, :4], given[:, 4:], 7)).all()


def test_words_become_fractions_below_one(precision, device):
    real = {"float32": wp.float32, "float64": wp.float64}[precision]
    unit, in_units_of = uniform(real), unit_of(real)

    @wp.kernel(module="unique", enable_backward=False)
    def fractions(words: wp.array2d(dtype=wp.uint32), out: wp.array(dtype=real)):
        i = wp.tid()
        out[i] = unit(words[i, 0], words[i, 1]) * in_units_of

    words = np.random.default_rng(4).integers(0, 2**32, (1000, 2), dtype=np.uint32)
    words[:4] = [(0, 0), (0xFFFFFFFF, 0xFFFFFFFF), (0x80000000, 0), (0x7FFFFFFF, 0xFFFFFFFF)]
    out = wp.zeros(len(words), dtype=real, device=device)
    wp.launch(fractions, len(words), [wp.array(words, dtype=wp.uint32, device=device)], [out], device=device)
    bits = (words[:, 0].astype(object) << 32) | words[:, 1].astype(object)
    leading = 24 if precision == "float32" else 53
    exact = [float(b >> (64 - leading)) / 2.0**leading for b in bits]
    assert (out.numpy() == exact).all()
    assert out.numpy().max() < 1 and out.numpy()[0] == 0
