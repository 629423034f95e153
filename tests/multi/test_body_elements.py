"""The body-elemental algorithm on two balls, against a cell-by-cell twin, and on cases with known answers."""

import numpy as np
import pytest

from wsrender.errors import InputError, ResourceError
from wsrender.multi import body_elements

LENS = 5 * np.pi / 12  # two unit balls at x = ±.5


def ball(center, count, seed):
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(count, 3))
    points *= (rng.random(count) ** (1 / 3) / np.linalg.norm(points, axis=1))[:, None]
    return points + np.array([center, 0, 0])


def test_two_balls():
    """DEFINITIONS 6: V₀ 1.5563 and V₃ 1.2279, ±.004, with 2e5 points each; biased both ways."""
    volumes = np.array([body_elements(ball(0.5, 200_000, s), ball(-0.5, 200_000, 9 + s)).volumes_m3 for s in range(3)])
    assert volumes.mean(axis=0)[[0, 3]] == pytest.approx([1.5563, 1.2279], abs=0.004)
    assert (np.diff(volumes, axis=1) < 0).all()
    assert volumes[:, 3].max() < LENS < volumes[:, 0].min()


def test_many_points_overshoot_and_few_fall_short():
    volumes = [body_elements(ball(0.5, n, 0), ball(-0.5, n, 1)).volumes_m3[3] for n in (20_000, 1_000_000)]
    assert volumes[0] < LENS < volumes[1]


@pytest.mark.parametrize("neighbours", [4, 6])
def test_every_cell_against_a_plain_loop(neighbours):
    left, right, cells = ball(0.5, 3000, 3), ball(-0.5, 3000, 4), (4, 5, 6)
    found = body_elements(left, right, cells, 2, neighbours)
    assert found.volumes_m3 == pytest.approx(plain_loop(left, right, cells, 2, neighbours), rel=1e-12)
    assert 0 < found.boundary.sum() < found.collaborative.sum()
    assert not (found.boundary & ~found.collaborative).any()


def plain_loop(left, right, cells, refinements, neighbours):
    low, high = left[:, 0].min(), right[:, 0].max()
    left, right = (p[(p[:, 0] >= low) & (p[:, 0] < high)] for p in (left, right))
    lower, upper = np.vstack([left, right]).min(axis=0), np.vstack([left, right]).max(axis=0)
    lower[0], upper[0] = low, high

    def occupied(points, shape):
        at = np.minimum(np.floor((points - lower) / (upper - lower) * shape).astype(int), np.array(shape) - 1)
        return set(map(tuple, at))

    def both(parts):
        shape = np.array(cells) * parts
        return occupied(left, shape) & occupied(right, shape)

    steps = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)][:neighbours]
    held = both(1)
    boundary = {c for c in held if any(tuple(np.add(c, s)) not in held for s in steps)}
    cell = np.prod((upper - lower) / cells)
    volumes = [len(held) * cell]
    for i in range(1, refinements + 1):
        kept = sum(tuple(np.array(c) // (i + 1)) in boundary for c in both(i + 1))
        volumes.append((len(held - boundary) + kept / (i + 1) ** 3) * cell)
    return volumes


def test_two_filled_boxes_share_their_common_part_exactly():
    """Points on a regular grid, finer than any cell: every refinement is exact."""
    grid = np.stack(np.meshgrid(*[np.linspace(0, 1, 81)] * 3), axis=-1).reshape(-1, 3)
    found = body_elements(grid + np.array([0.5, 0, 0]), grid, (10, 10, 10), 2)
    assert found.volumes_m3 == pytest.approx(np.full(3, 0.5))


def test_arms_that_do_not_meet_share_nothing():
    assert body_elements(ball(5, 100, 0), ball(-5, 100, 0)).volumes_m3.tolist() == [0, 0, 0, 0]
    apart = ball(0, 100, 0) + np.array([0, 9, 0])
    assert body_elements(apart, ball(0, 100, 1)).volumes_m3.tolist() == [0, 0, 0, 0]


@pytest.mark.parametrize(
    ("options", "kind", "message"),
    [
        ({"neighbours": 5}, InputError, "neighbours: 5 is not allowed; 4 .* or 6 is"),
        ({"cells": (0, 1, 1)}, InputError, r"cells: \[0, 1, 1\] is not allowed"),
        ({"refinements": -1}, InputError, "refinements: -1"),
        ({"cells": (1000, 1000, 1000), "refinements": 3}, ResourceError, "make 4000 × 4000 × 4000 cells"),
    ],
)
def test_options_that_are_not_allowed(options, kind, message):
    with pytest.raises(kind, match=message):
        body_elements(ball(0, 10, 0), ball(0, 10, 1), **options)
    with pytest.raises(InputError, match=r"right: has shape \(0, 3\)"):
        body_elements(ball(0, 10, 0), np.empty((0, 3)))
