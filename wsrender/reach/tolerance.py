"""How far something may move in any direction: the largest ball in which nothing fails."""

from collections.abc import Callable

import numpy as np

ROUNDS, QUIET = 24, 3  # at most, and those without a failure in a row that end the search
SECTIONS, PARTS = 5, 8  # a failure is followed inwards to an eighth of its way five times
NEAREST, TURNS = 8, (0.3, 0.1, 0.03, 0.01)
NOTHING = 1e-4  # share of the largest radius that is as good as none
SAFE = 0.995  # of the radius of the nearest failure that was found


def largest_ball(holds: Callable[[np.ndarray], np.ndarray], largest: float, count: int, seed: int = 0) -> float:
    """Radius of a ball about 0 in three dimensions in which ``holds`` (N, 3) -> (N,) bool, at most ``largest``.

    By trial: points all over the ball, ``count`` a round, and the nearest failures followed along their rays inwards
    and to rays beside them, until rounds pass without one. A bound from above of the true radius, but for SAFE.
    """
    random, radius, quiet = np.random.default_rng(seed), largest, 0
    for _ in range(ROUNDS):
        found = _failures(holds, radius * _in_ball(random, count))
        for turn in TURNS if len(found) else ():
            near = found[np.argsort(np.linalg.norm(found, axis=1), kind="stable")[:NEAREST]]
            beside = near[random.integers(len(near), size=count // 4)]
            length = np.linalg.norm(beside, axis=1, keepdims=True)
            beside = beside + turn * length * random.normal(size=beside.shape)
            beside *= length / np.maximum(np.linalg.norm(beside, axis=1, keepdims=True), 1e-300)
            found = np.concatenate([found, _failures(holds, beside)])
        quiet = 0 if len(found) else quiet + 1
        radius = min(radius, np.linalg.norm(found, axis=1).min(initial=radius))
        if quiet == QUIET or radius < NOTHING * largest:
            break
    return float(SAFE * radius)


def _in_ball(random: np.random.Generator, count: int) -> np.ndarray:
    """Points in the unit ball, half of them in its outer shell."""
    direction = random.normal(size=(count, 3))
    length = random.random(count) ** np.where(np.arange(count) % 2, 1 / 3, 1 / 30)
    return direction / np.linalg.norm(direction, axis=1, keepdims=True) * length[:, None]


def _failures(holds: Callable[[np.ndarray], np.ndarray], points: np.ndarray) -> np.ndarray:
    """Where ``holds`` fails at some of the points, the nearest of them moved inwards as far as it does, (F, 3)."""
    failing = points[~holds(points)]
    far = failing[np.argsort(np.linalg.norm(failing, axis=1), kind="stable")[:NEAREST]]
    inner, share = np.zeros_like(far), (np.arange(1, PARTS) / PARTS)[:, None]
    for _ in range(SECTIONS if len(far) else 0):
        between = inner[:, None] + share * (far - inner)[:, None]
        good = holds(between.reshape(-1, 3)).reshape(between.shape[:2])
        first = np.where(good.all(axis=1), PARTS, np.argmin(good, axis=1) + 1)[:, None] / PARTS  # that fails
        inner, far = inner + (first - 1 / PARTS) * (far - inner), inner + first * (far - inner)
    return far
