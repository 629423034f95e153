"""What a constrained run says of the samples that it rejects: the first ones, which pairs collide, and what is lost."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from scipy.special import gammaln

from wsrender.collision.distance import colliding
from wsrender.errors import InputError
from wsrender.pipeline.constraints.collision import labelling
from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.robot.constraints import samples_entry

COUNTED = 20_000  # samples of which it is asked which pairs collide
TRIED = 256  # configurations of which it is asked which pairs are too near in all
TWO_SIDED = 1.96  # standard deviations of a 95 % interval


def rejected_rows(
    constraints: Sequence[Constraint], rejected: np.ndarray, configurations: Callable[[np.ndarray], np.ndarray]
) -> dict[str, Any]:
    """The entries ``samples`` and ``rejections`` of N samples that are kept one by one.

    ``rejected`` (N,) int: the number, from 1, of the first constraint that rejects each, or 0; ``configurations`` takes
    numbers of samples (K,) to configurations (K, n) [rad or m]. The second has the first sample of each reason, and
    which pairs of shapes collide how often.
    """
    about = samples_entry(constraints, len(rejected), np.bincount(rejected, minlength=len(constraints) + 1)[1:])
    reasons, first = np.unique(rejected, return_index=True)
    first, rejecting = first[reasons > 0], [constraints[k - 1] for k in reasons[reasons > 0]]
    counted = np.arange(0, len(rejected), max(-(-len(rejected) // COUNTED), 1))
    pairs = colliding_pairs(constraints, configurations(counted), rejected[counted])
    return about | {"rejections": {"first": first_rejected(rejecting, first, configurations(first)), **pairs}}


def first_rejected(constraints: Sequence[Constraint], numbers: np.ndarray, q: np.ndarray) -> dict[str, Any]:
    """By reason the first sample that was rejected for it: its number, and its configuration [rad or m].

    ``numbers`` (K,) and ``q`` (K, n) are of the constraints that reject any, which ``constraints`` (K,) are.
    """
    return {
        each.name: {"sample": int(number), "configuration": row.tolist()}
        for each, number, row in zip(constraints, numbers, np.asarray(q, np.float64), strict=True)
    }


def colliding_pairs(constraints: Sequence[Constraint], q: np.ndarray, rejected: np.ndarray) -> dict[str, Any]:
    """How often each pair of shapes is too near, of at most COUNTED of the samples ``q`` (N, n), most often first.

    By MuJoCo, and whatever reason a sample was rejected for; ``rejected`` (N,): 0 where it was not. Nothing where no
    constraint keeps shapes apart.
    """
    apart = labelling(constraints)
    if not apart:
        return {}
    q, rejected = (rows[:: max(-(-len(q) // COUNTED), 1)] for rows in (q, rejected))
    found = []
    for each in apart:
        near = colliding(each.own, each.distances, each.chain, q[rejected > 0]).sum(axis=0)
        for (a, b), number in zip(each.own.pairs, near.tolist(), strict=True):
            names = [each.solids[k].name for k in (a, b)]
            found += [{"constraint": each.name, "shapes": names, "samples": number}] * (number > 0)
    found.sort(key=lambda pair: -pair["samples"])
    return {"pairs": {"counted": len(q), "colliding": found}}


def always_near(constraints: Sequence[Constraint]) -> list[tuple[str, list[str]]]:
    """Constraints and names of pairs of shapes that are too near in each of TRIED configurations, drawn at random."""
    found = []
    for each in labelling(constraints):
        low, high = each.chain.lower_limits, each.chain.upper_limits
        q = low + np.random.default_rng(0).random((TRIED, len(low))) * (high - low)
        near = colliding(each.own, each.distances, each.chain, q).all(axis=0)
        found += [(each.name, [each.solids[k].name for k in pair]) for pair in each.own.pairs[near]]
    return found


def check_admitted(samples: dict[str, Any], constraints: Sequence[Constraint]) -> None:
    """Raises InputError where ``constraints`` admit none of a `samples_entry`; it names pairs that always touch."""
    if not samples or samples["samples"]["admitted"]:
        return
    entry, near, remedies = samples["samples"], always_near(constraints), ["widen them"]
    for reason in dict.fromkeys(name for name, _ in near):
        pairs = [pair for name, pair in near if name == reason]
        remedies.append(f"constraints.{reason}.exclude = {pairs} lets what is too near in all {TRIED} tried at random")
    by = ", ".join(f"{name} {number}" for name, number in entry["rejected"].items() if number)
    message = f"admit none of {entry['drawn']} samples (rejected by {by}): {'; '.join(remedies)}"
    raise InputError("constraints", message)


def lost_voxels(
    drawn: np.ndarray, admitted: np.ndarray, samples: int, rejected: int, volume_m3: float
) -> dict[str, Any]:
    """Volume [m³] of the voxels that lost all their samples, beside the loss if as many were dropped at random.

    ``drawn``, ``admitted`` (V,) int64: samples of each voxel that holds any; of all ``samples`` so many are
    ``rejected``; ``volume_m3``: of a voxel. Random: the expectation over all choices of as many samples, and an
    interval that holds at least 95 % of them.
    """
    # Of C(N, R) choices of what is dropped, C(N - n, R - n) hold all n samples of a voxel.
    can = drawn <= rejected
    n, of = drawn[can].astype(np.float64), float(samples)
    log = gammaln(rejected + 1.0) - gammaln(rejected - n + 1.0) - gammaln(of + 1.0) + gammaln(of - n + 1.0)
    chance = np.exp(log)
    # Voxels compete for the dropped samples, so that the variance is at most that of independent ones.
    expected, deviation = float(chance.sum()), float(np.sqrt((chance * (1 - chance)).sum()))
    bounds = [max(expected - TWO_SIDED * deviation, 0.0), min(expected + TWO_SIDED * deviation, float(len(drawn)))]
    return {
        "drawn": len(drawn) * volume_m3,
        "lost": int((admitted == 0).sum()) * volume_m3,
        "lost_at_random": {"value": expected * volume_m3, "ci95": [bound * volume_m3 for bound in bounds]},
    }


def moved_means(values: np.ndarray, rejected: np.ndarray) -> dict[str, Any]:
    """Mean of values (N,) over all samples and over the admitted ones; and where it may be after a random drop."""
    kept = values[rejected == 0]
    if not len(kept):
        return {"drawn": float(values.mean()), "admitted": None, "at_random": None}
    mean, spread = float(values.mean()), float(values.std())
    half = TWO_SIDED * spread * np.sqrt((len(values) - len(kept)) / (max(len(values) - 1, 1) * len(kept)))
    ci95 = [float(mean - half), float(mean + half)]
    return {"drawn": mean, "admitted": float(kept.mean()), "at_random": {"value": mean, "ci95": ci95}}
