"""Random configurations of a chain, with the awkward ones that uniform sampling never meets."""

import numpy as np


def random_postures(chain, count, seed=0):
    """(count, n) configurations within the limits, float64 holding float32 values.

    A fifth each: uniform; with joints at their limits; with joints next to their limits; with joints at multiples of
    90°, where wrists and elbows are singular; and with joints 1e-9 … 1e-1 from there. Rounded to float32, so that
    both precisions and the reference see the same configuration.
    """
    generator = np.random.default_rng(seed)
    lower, upper = chain.lower_limits, chain.upper_limits
    q = generator.uniform(lower, upper, (count, chain.n))
    kind = np.arange(count)[:, None] % 5
    chosen = generator.random(q.shape) < 0.6
    limit = np.where(generator.random(q.shape) < 0.5, lower, upper)
    inward = np.where(limit == lower, 1.0, -1.0) * 10.0 ** generator.uniform(-9, -2, q.shape)
    quarter = np.where(chain.revolute, np.round(q / (np.pi / 2)) * (np.pi / 2), q)
    nearly = quarter + 10.0 ** generator.uniform(-9, -1, q.shape) * generator.choice([-1, 1], q.shape)
    q = np.where(chosen & (kind == 1), limit, q)
    q = np.where(chosen & (kind == 2), limit + inward, q)
    q = np.where(chosen & (kind == 3), quarter, q)
    q = np.where(chosen & (kind == 4), nearly, q)
    return np.clip(q, lower, upper).astype(np.float32).astype(np.float64)
