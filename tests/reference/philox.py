"""Philox-4x32 in NumPy (Salmon, Moraes, Dror, Shaw, *Parallel random numbers: as easy as 1, 2, 3*, 2011)."""

import numpy as np

MULTIPLIERS = (0xD2511F53, 0xCD9E8D57)
KEY_STEPS = (0x9E3779B9, 0xBB67AE85)


def philox_4x32(counter, key, rounds):
    """Four uint32 words (N, 4) of counters (N, 4) under keys (N, 2)."""
    x = [np.asarray(counter, np.uint32)[..., i] for i in range(4)]
    k = [np.asarray(key, np.uint32)[..., i] for i in range(2)]
    for _ in range(rounds):
        high_0, low_0 = wide_product(x[0], MULTIPLIERS[0])
        high_1, low_1 = wide_product(x[2], MULTIPLIERS[1])
        x = [high_1 ^ x[1] ^ k[0], low_1, high_0 ^ x[3] ^ k[1], low_0]
        k = [word + np.uint32(step) for word, step in zip(k, KEY_STEPS, strict=True)]
    return np.stack(x, axis=-1)


def wide_product(word, multiplier):
    product = word.astype(np.uint64) * np.uint64(multiplier)
    return (product >> np.uint64(32)).astype(np.uint32), product.astype(np.uint32)
