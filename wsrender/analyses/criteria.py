"""Acceptance criteria: what labels of targets say of the shares that a job asks for."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from wsrender.documents.target_lists import Criterion
from wsrender.reach.targets import with_margin
from wsrender.robots.kinematics import Kinematics

FAIL, UNDECIDED, PASS = "fail", "undecided", "pass"
VERDICTS = (FAIL, UNDECIDED, PASS)  # the first that a criterion has is the job's
ROUNDING = 1e-12  # relative, of a share's sums of weights
_ROOM, _AND = {"joint_margin_deg": "°", "joint_margin_m": " m"}, " and "


def margins_of(criteria: Iterable[Criterion], chain: Kinematics) -> dict[int, Kinematics]:
    """The chain within the limits of each criterion, by number, that asks for a margin; raises InputError."""
    chains = {
        k: with_margin(chain, np.deg2rad(each.joint_margin_deg), each.joint_margin_m, f"criteria.{k}")
        for k, each in enumerate(criteria)
    }
    return {k: own for k, own in chains.items() if own is not chain}


def verdicts(criteria: Iterable[Criterion], weight: np.ndarray, labels: Sequence[np.ndarray]) -> dict[str, Any]:
    """The entries ``criteria`` and ``verdict`` of a job with criteria.

    ``weight`` (N,) of targets; ``labels``: by criterion (N,) text, "reachable" and "undecided" among them.
    """
    entries = []
    for each, own in zip(criteria, labels, strict=True):
        reached, open_ = own == "reachable", own == "undecided"
        found = {"reached": int(reached.sum()), "share": share_of(weight, reached)}
        found |= {"undecided_share": share_of(weight, open_)}
        entries.append(each.model_dump() | found | {"verdict": verdict(each.least_share, weight, reached, open_)})
    found = {entry["verdict"] for entry in entries}
    return {"criteria": entries, "verdict": next(v for v in VERDICTS if v in found)} if entries else {}


def share_of(weight: np.ndarray, which: np.ndarray) -> float:
    """Share of the weight (N,) that some (N,) bool have, its sums exact."""
    return math.fsum(weight[which]) / math.fsum(weight)


def verdict(least: float, weight: np.ndarray, reached: np.ndarray, undecided: np.ndarray) -> str:
    """What targets of a weight (N,) say of a least share: "pass", "fail", or "undecided" where undecided ones count."""
    enough = [share_of(weight, which) >= least * (1 - ROUNDING) for which in (reached, reached | undecided)]
    return PASS if enough[0] else UNDECIDED if enough[1] else FAIL


def facts_of_criteria(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """What a document says of each criterion, and its verdict, as lines of a summary."""
    for k, each in enumerate(document.get("criteria", ()), 1):
        room = [f"{each[name]:g}{unit}" for name, unit in _ROOM.items() if each[name]]
        asked = f"{_percent(each['least_share'])} reached{f' with {_AND.join(room)} to the limits' if room else ''}"
        open_ = f", {_percent(each['undecided_share'])} undecided" if each["undecided_share"] else ""
        yield f"criterion {k}", f"{each['verdict']}: {_percent(each['share'])}{open_}; {asked} needed"
    if "verdict" in document:
        yield "verdict", document["verdict"]


def fact_of_covered(entry: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """How much of a volume is covered, as a line of a summary, where an entry says it."""
    if found := entry.get("covered"):
        open_ = f", {_percent(found['undecided_share'])} undecided" if found["undecided_share"] else ""
        yield "covered", f"{_percent(found['share'])} of {found['volume_m3']:.4g} m³{open_}, {found['evidence']}"


def _percent(share: float) -> str:
    """To a digit more than round numbers, and never rounded up to what it does not reach."""
    return f"{math.floor(share * 1e4 + 1e-8) / 100:g} %"
