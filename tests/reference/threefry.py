"""Threefry-4x32 in NumPy (Salmon, Moraes, Dror, Shaw, *Parallel random numbers: as easy as 1, 2, 3*, 2011)."""

import numpy as np

ROTATIONS = ((10, 26), (11, 21), (13, 27), (23, 5), (6, 20), (17, 11), (25, 10), (18, 20))
PARITY = 0x1BD11BDA


def threefry_4x32(counter, key, rounds):
    """Four uint32 words (N, 4) of counters (N, 4) under keys (N, 4)."""
    x = [np.asarray(counter, np.uint32)[..., i].copy() for i in range(4)]
    k = [np.asarray(key, np.uint32)[..., i] for i in range(4)]
    k.append(np.uint32(PARITY) ^ k[0] ^ k[1] ^ k[2] ^ k[3])
    x = [word + part for word, part in zip(x, k[:4], strict=True)]
    for r in range(rounds):
        first, second = ROTATIONS[r % 8]
        partner = 1 if r % 2 == 0 else 3
        x[0], x[partner] = mixed(x[0], x[partner], first)
        x[2], x[4 - partner] = mixed(x[2], x[4 - partner], second)
        if r % 4 == 3:
            injection = (r + 1) // 4
            x = [x[i] + k[(injection + i) % 5] for i in range(4)]
            x[3] = x[3] + np.uint32(injection)
    return np.stack(x, axis=-1)


def mixed(a, b, rotation):
    a = a + b
    b = (b << np.uint32(rotation)) | (b >> np.uint32(32 - rotation))
    return a, b ^ a
