"""The counter-based generator against Random123's published known-answer vectors and its NumPy twin."""

import numpy as np
import pytest
import warp as wp
from wsrender_kernels.sampling import threefry, uniform

from tests.reference.threefry import threefry_4x32

# Random123 (D. E. Shaw Research), kat_vectors: rounds, counter, key, result.
PI_COUNTER = (0x243F6A88, 0x85A308D3, 0x13198A2E, 0x03707344)
PI_KEY = (0xA4093822, 0x299F31D0, 0x082EFA98, 0xEC4E6C89)
ZEROS, ONES = (0, 0, 0, 0), (0xFFFFFFFF,) * 4
KNOWN = [
    (13, ZEROS, ZEROS, (0x531C7E4F, 0x39491EE5, 0x2C855A92, 0x3D6ABF9A)),
    (13, ONES, ONES, (0xC4189358, 0x1C9CC83A, 0xD5881C67, 0x6A0A89E0)),
    (13, PI_COUNTER, PI_KEY, (0x4AA71D8F, 0x734738C2, 0x431FC6A8, 0xAE6DEBF1)),
    (20, ZEROS, ZEROS, (0x9C6CA96A, 0xE17EAE66, 0xFC10ECD4, 0x5256A7D8)),
    (20, ONES, ONES, (0x2A881696, 0x57012287, 0xF6C7446E, 0xA16A6732)),
    (20, PI_COUNTER, PI_KEY, (0x59CD1DBB, 0xB8879579, 0x86B5D00C, 0xAC8B6D84)),
]


@pytest.mark.parametrize(("rounds", "counter", "key", "result"), KNOWN)
def test_the_twin_gives_the_published_answers(rounds, counter, key, result):
    assert tuple(threefry_4x32([counter], [key], rounds)[0]) == result


def test_the_kernel_gives_the_words_of_the_twin(device):
    random_words = threefry()

    @wp.kernel(module="unique", enable_backward=False)
    def draw_words(given: wp.array2d(dtype=wp.uint32), out: wp.array2d(dtype=wp.uint32)):
        i = wp.tid()
        a, b, c, d = random_words(given[i, 0], given[i, 1], given[i, 2], given[i, 3], given[i, 4], given[i, 5])
        out[i, 0] = a
        out[i, 1] = b
        out[i, 2] = c
        out[i, 3] = d

    given = np.random.default_rng(3).integers(0, 2**32, (1000, 6), dtype=np.uint32)
    given[0], given[1] = 0, 0xFFFFFFFF
    out = wp.zeros((len(given), 4), dtype=wp.uint32, device=device)
    wp.launch(draw_words, len(given), [wp.array(given, dtype=wp.uint32, device=device)], [out], device=device)
    key = np.pad(given[:, 4:], ((0, 0), (0, 2)))
    assert (out.numpy() == threefry_4x32(given[:, :4], key, 13)).all()


def test_words_become_fractions_below_one(precision, device):
    real = {"float32": wp.float32, "float64": wp.float64}[precision]
    unit = uniform(real)

    @wp.kernel(module="unique", enable_backward=False)
    def fractions(words: wp.array2d(dtype=wp.uint32), out: wp.array(dtype=real)):
        i = wp.tid()
        out[i] = unit(words[i, 0], words[i, 1])

    words = np.random.default_rng(4).integers(0, 2**32, (1000, 2), dtype=np.uint32)
    words[:4] = [(0, 0), (0xFFFFFFFF, 0xFFFFFFFF), (0x80000000, 0), (0x7FFFFFFF, 0xFFFFFFFF)]
    out = wp.zeros(len(words), dtype=real, device=device)
    wp.launch(fractions, len(words), [wp.array(words, dtype=wp.uint32, device=device)], [out], device=device)
    bits = (words[:, 0].astype(object) << 32) | words[:, 1].astype(object)
    leading = 24 if precision == "float32" else 53
    exact = [float(b >> (64 - leading)) / 2.0**leading for b in bits]
    assert (out.numpy() == exact).all()
    assert out.numpy().max() < 1 and out.numpy()[0] == 0
