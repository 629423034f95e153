"""The analysis ``two_arm_placement``: what two arms serve together from every pair of placements."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from wsrender.analyses.composed import Composed, Part, PartialParts, part_of
from wsrender.analyses.contract import Draft, Settled
from wsrender.analyses.cost import (
    DOCUMENT_BYTES,
    NOTHING,
    SEARCHED_BYTES,
    SEARCHED_PER_S,
    Cost,
    in_turn,
    pictures_cost,
)
from wsrender.analyses.execution import Execution
from wsrender.analyses.headline import no_headline
from wsrender.analyses.registry import planned
from wsrender.analyses.two_arm_placement.hand_over import LABELS as OF_POSES
from wsrender.analyses.two_arm_placement.hand_over import PLACES, SOLVED, TOGETHER, HandOvers, HandOversOf, Held
from wsrender.analyses.two_arm_placement.job import SIDES, TwoArmPlacementJob
from wsrender.documents.placements import COORDINATES, IN_DEGREES, PlacementSpace, placed
from wsrender.errors import InputError
from wsrender.reach.inverse_solver import closed_form_of
from wsrender.robot.model_robot import transform_of
from wsrender.robots.closed_form import ClosedForm
from wsrender.volume.table import Table

if TYPE_CHECKING:
    from wsrender.robot.arms_collision import ArmsApart

BLOCK = 1 << 22  # pairs of placements whose weights are computed at a time
PARTNER_BYTES = 16  # of a placement in files: what it serves with one of the other arm, and which
PAIRS_PER_S, BLOCK_BYTES, ROW_BYTES = 5e7, 40, 40  # of one core; of a pair meanwhile, and of a placement in tables
# Of hand-overs: of a pair of placements beside its bits, of a pose in a table, of a pair and a pose while it is
# decided, of a pose while its configurations are held, and of a pair and a pose while they are compared; seconds of a
# pose; what one core decides.
PAIR_BYTES, POSE_BYTES, COMPARED_BYTES, HELD_BYTES, APART_BYTES = 24.0, 110.0, 2.0, 4000.0, 5000.0
POSE_S, SOLVED_PER_S, APART_PER_S = 2e-4, 4e5, 2e5
# Seconds of the samples from which an arm's configurations are searched, and bytes of those that stay for the other.
SAMPLED_S, SAMPLED_BYTES = 0.7, 1.1e8
OFFERED = 0.5  # share of poses that pairs of placements hold, about
DIGITS = 9  # of weights, relative to that of all targets, to which they are told apart
LABELS = (*SIDES, "both", "none", "undecided")


@dataclass(frozen=True, kw_only=True)
class TwoArmSettled(Settled):
    """With what the plan of each arm's placements has settled."""

    placements: tuple[dict[str, Any], ...]


class TwoArmPlacementAnalysis(Composed):
    """A planned ``two_arm_placement`` job: a ``base_placement`` plan of each arm, one after the other."""

    settles = TwoArmSettled
    job: TwoArmPlacementJob
    settled: TwoArmSettled

    @property
    def effort(self) -> float:  # type: ignore[override]
        """A pair's of a placement and a target, of the arm that takes longer."""
        return max(plan.effort for plan in self.plans)

    def prepare(self, device: str, target: str) -> TwoArmSettled:
        """Raises what planning of ``base_placement`` raises, and `arms_apart`."""
        _ = self.apart
        shards = ((0, sum(plan.samples for plan in self.plans)),)
        return TwoArmSettled(device, target, shards, placements=tuple(plan.resolved() for plan in self.plans))

    @cached_property
    def plans(self) -> list[Any]:
        """The plan of the placements of each arm for the targets, then for the poses of a hand-over."""
        settled, count = getattr(self, "settled", None), len(SIDES) * (2 if self.job.hand_over else 1)
        return [self._plan(k, settled and settled.placements[k]) for k in range(count)]

    def _plan(self, k: int, resolved: dict[str, Any] | None) -> Any:
        at_hand_over, arm = divmod(k, len(SIDES))
        side = SIDES[arm]
        try:
            job = self.job.placements(side, at_hand_over=bool(at_hand_over))
            return planned(job, self.robots[arm], resolved=resolved)
        except InputError as error:
            raise (error.within(side) if error.field in ("over", "mounting", "base", "tip") else error) from None

    @property
    def parts(self) -> list[Part]:
        """The arms."""
        return [part_of(plan) for plan in self.plans]

    @property
    def cost(self) -> Cost:
        """Of both arms, and of the pairs of their placements."""
        both = in_turn(plan.cost for plan in self.plans[: len(SIDES)])
        counts = [getattr(self.job, side).over.count for side in SIDES]
        pairs, K = float(np.prod(counts)), len(self.plans[0].targets)
        memory = both.memory_bytes + ROW_BYTES * sum(counts) + BLOCK_BYTES * min(pairs, BLOCK) + 8.0 * K * sum(counts)
        (spared, before), (drawn, seconds) = pictures_cost("placements", "robot"), pictures_cost("targets")
        files = both.file_bytes - 2 * spared - DOCUMENT_BYTES + drawn + PARTNER_BYTES * sum(counts)
        seconds += both.seconds - 2 * before + pairs / PAIRS_PER_S
        asks = replace(both.asks, field="first.over")
        samples = sum(plan.samples for plan in self.plans)
        hand_over = self._hand_over_cost if self.job.hand_over else NOTHING
        memory, files = memory + hand_over.memory_bytes, files + hand_over.file_bytes
        return Cost(samples, memory, files, seconds + hand_over.seconds, asks)

    @property
    def _hand_over_cost(self) -> Cost:
        """Of what pairs of placements offer, beside all else: bits of poses, and configurations that keep apart."""
        plans = self.plans[len(SIDES) :]
        counts, H = [getattr(self.job, side).over.count for side in SIDES], len(plans[0].targets)
        pairs, joints = float(np.prod(counts)), sum(robot.chain.n for robot in self.robots)
        (_, before), (drawn, _) = pictures_cost("placements", "robot"), pictures_cost("arm")
        together = min(H, max(8, SOLVED // min(max(counts), PLACES)))
        rows, table = pairs * (PAIR_BYTES + H / 8), H * (POSE_BYTES + 8.0 * joints)
        decided = COMPARED_BYTES * min(pairs, PLACES**2) * together
        memory = sum(plan.kept_bytes for plan in plans) + rows + pairs * H / 8 + table
        closed = [isinstance(closed_form_of(robot.chain, "pose"), ClosedForm) for robot in self.robots]
        searched = closed.count(False)
        solved = SEARCHED_BYTES + (searched - 1) * SAMPLED_BYTES if searched else 0.0
        memory += max(decided, HELD_BYTES * min(H, TOGETHER), solved)
        seconds = sum(plan.cost.seconds - before for plan in plans) + POSE_S * H + SAMPLED_S * searched
        if self.apart:
            held = pairs * H * OFFERED
            memory += self.program_bytes + APART_BYTES * min(held, TOGETHER)
            seconds += held / APART_PER_S
            rates = [SOLVED_PER_S if own else SEARCHED_PER_S for own in closed]
            seconds += sum(count * H / rate for count, rate in zip(counts, rates, strict=True))
        return Cost(0, memory, rows + table + drawn, seconds)

    def result(self, partial: PartialParts, execution: Execution) -> Draft:
        """The tables ``first`` and ``second`` of placements, and ``targets`` as the best pair of them serves these."""
        tables, about, hand_overs = {}, {}, self._hand_overs(partial, execution)
        for k, (side, plan) in enumerate(zip(SIDES, self.plans, strict=False)):
            draft = plan.result(partial.parts[k], execution)
            tables[side], about[side] = draft.tables["placements"], draft.entries["placements"]
        targets = self.plans[0].targets
        served, open_ = (
            [_bits(tables[side], name, len(targets)) for side in SIDES] for name in ("served", "undecided")
        )
        offered, open_poses = hand_overs.offered() if hand_overs else (None, None)
        offers = None if offered is None else np.bitwise_count(offered).sum(axis=2, dtype=np.int64)
        found = best_pairs(served[0], served[1], targets.weight, offers)
        best = found.pair
        left, right = served[0][best[0]], served[1][best[1]]
        unsure = open_[0][best[0]] | open_[1][best[1]]
        label = np.select([left & right, left, right, unsure], ["both", *SIDES, "undecided"], "none")
        total = float(targets.weight.sum())
        entry = {
            "count": len(targets),
            **{name: int((label == name).sum()) for name in LABELS},
            "share": {name: float(targets.weight[label == name].sum()) / total for name in LABELS},
        }
        pairs = {
            "count": len(served[0]) * len(served[1]),
            "most_weight": found.most,
            "serving_all": found.serving_all,
        }
        entries = {
            "targets": entry,
            "pairs": pairs,
            "best": {side: self._place(k, best[k], served[k][best[k]]) for k, side in enumerate(SIDES)},
            "placements": about,
        }
        for k, side in enumerate(SIDES):
            tables[side] = _with_partners(tables[side], found.weight[k], found.partner[k])
        columns = targets.columns(self.job.targets is not None)
        tables["targets"] = Table(columns | {"label": label}, {"position": "m"})
        skeleton = None
        if hand_overs and offered is not None and offers is not None and open_poses is not None:
            there = hand_overs.of_pair(best)
            entries["hand_over"] = self._about_hand_over(there, offered, offers)
            tables["hand_over_pairs"] = _table_of_pairs(offered, offers, open_poses)
            tables["hand_overs"] = self._table_of_poses(there)
            skeleton = self._skeletons(entries["best"], there)
        headline = no_headline("targets are counted")
        return Draft(entries, headline, provenance=targets.provenance, tables=tables, skeleton=skeleton)

    @cached_property
    def apart(self) -> "ArmsApart | None":
        """What keeps the arms apart at a hand-over, wherever they stand; raises InputError."""
        choice = self.job.constraints
        if not (choice and choice.arms_collision):
            return None
        from wsrender.robot.arms_collision import arms_apart

        bases = [plan.base for plan in self.plans[: len(SIDES)]]
        return arms_apart(self.robots, SIDES, choice.arms_collision, bases=bases)

    def _hand_overs(self, partial: PartialParts, execution: Execution) -> HandOvers | None:
        """What is known of the poses of a hand-over, of every placement of either arm."""
        if not self.job.hand_over:
            return None
        arms = []
        for k, plan in enumerate(self.plans[len(SIDES) :], len(SIDES)):
            bits, count = partial.parts[k], len(plan.targets)
            served, undecided = (_unpacked(bits[name], count) for name in ("served", "undecided"))
            over = self._over(k)
            coordinates = over.coordinates(np.arange(over.count))
            search = plan.solving(execution.threads)
            arms.append(Held(served, undecided, search, coordinates * IN_DEGREES, placed(coordinates)))
        return HandOvers(arms, self.apart, self.device, execution.threads)

    def _about_hand_over(self, there: HandOversOf, offered: np.ndarray, offers: np.ndarray) -> dict[str, Any]:
        """How many poses pairs of placements offer, and of the best pair the pose with the largest margin."""
        position, quat = self._poses
        some = np.bitwise_or.reduce(offered.reshape(-1, offered.shape[2]), axis=0)
        about = {
            "poses": len(position),
            "offered": int(np.bitwise_count(some).sum()),
            "pairs": int((offers > 0).sum()),
            "most": int(offers.max()),
            "of_best_pair": {name: int((there.label == k).sum()) for k, name in enumerate(OF_POSES)},
        }
        if not np.isfinite(there.margin).any():
            return about | {"best": None}
        k = int(np.nanargmax(there.margin))
        best = {"pose": k, "position_m": position[k].tolist(), "quat_wxyz": quat[k].tolist()}
        best |= {f"q_{side}": q[k].tolist() for side, q in zip(SIDES, there.q, strict=True)}
        return about | {"best": best | {"joint_limit_margin": float(there.margin[k])}}

    def _table_of_poses(self, there: HandOversOf) -> Table:
        """A row for each pose: what the best pair of placements makes of it, and the best configurations of both."""
        position, quat = self._poses
        columns = {"position": position, "quat_wxyz": quat, "label": np.array(OF_POSES)[there.label]}
        columns["joint_limit_margin"], units = there.margin, {"position": "m", "joint_limit_margin": "1"}
        for side, robot, q in zip(SIDES, self.robots, there.q, strict=True):
            names = [f"q_{side}_{name}" for name in robot.joint_names]
            columns |= dict(zip(names, q.T, strict=True))
            units |= {each: "rad" if hinge else "m" for each, hinge in zip(names, robot.chain.revolute, strict=True)}
        return Table(columns, units)

    def _skeletons(self, best: dict[str, Any], there: HandOversOf) -> np.ndarray | None:
        """Both arms at the best hand-over, (2, L, 3) [m]: the shorter one repeats its tip."""
        if not np.isfinite(there.margin).any():
            return None
        k, arms = int(np.nanargmax(there.margin)), []
        for robot, place, q in zip(self.robots, best.values(), there.q, strict=True):
            where = transform_of(np.array(place["T_world_base"]))
            assert where
            arms.append(robot.placed(where).skeleton(q[k])[0])
        longest = max(map(len, arms))
        return np.stack([np.concatenate([arm, np.repeat(arm[-1:], longest - len(arm), axis=0)]) for arm in arms])

    @property
    def _poses(self) -> tuple[np.ndarray, np.ndarray]:
        """Positions (N, 3) [m] and quaternions (N, 4) of the first arm's tip at hand-overs."""
        targets = self.plans[len(SIDES)].targets
        return targets.position, targets.quat_wxyz

    def _over(self, k: int) -> PlacementSpace:
        """Where the arm of plan ``k`` may stand."""
        return getattr(self.job, SIDES[k % len(SIDES)]).over

    def _place(self, k: int, number: int, served: np.ndarray) -> dict[str, Any]:
        """Where an arm stands, and how many targets it serves there."""
        coordinates = getattr(self.job, SIDES[k]).over.coordinates(np.array([number]))
        T = placed(coordinates)[0] @ self.plans[k].base.T_frame_base
        entry = {"placement": number, **dict(zip(COORDINATES, coordinates[0].tolist(), strict=True))}
        return entry | {"served": int(served.sum()), "T_world_base": T.tolist()}


@dataclass(frozen=True, eq=False)
class BestPairs:
    """Of every placement of either arm the largest ``weight`` that is served with one of the other, its ``partner``.

    ``pair``: the best of all, by number, and ``most``, what it serves; ``serving_all``: how many pairs serve every
    target.
    """

    weight: tuple[np.ndarray, np.ndarray]
    partner: tuple[np.ndarray, np.ndarray]
    pair: tuple[int, int]
    most: float
    serving_all: int


def best_pairs(left: np.ndarray, right: np.ndarray, weight: np.ndarray, offers: np.ndarray | None = None) -> BestPairs:
    """Of targets that placements of two arms serve, (P, K) and (Q, K) bool, which weigh ``weight`` (K,).

    Of pairs that serve as much that is best of which both arms serve most, then the first. With ``offers`` (P, Q), how
    many hand-overs pairs offer, those that offer none come last, and of pairs that serve as much that is best which
    offers most.
    """
    total = float(weight.sum())
    own = [served @ weight for served in (left, right)]
    best = [np.full(len(served), -1.0) for served in (left, right)]
    score, partner = best, [np.zeros(len(served), np.int64) for served in (left, right)]
    count, step = 0, max(1, BLOCK // len(right))
    for first in range(0, len(left), step):
        rows = slice(first, first + step)
        both = (left[rows] * weight) @ right.T.astype(np.float64)
        either = np.round((own[0][rows, None] + own[1] - both) / total, DIGITS)
        count += int((either == 1.0).sum())
        further = both / total if offers is None else offers[rows] / max(1, offers.max())
        values = either * 4 + np.round(further, DIGITS) * 10.0**-DIGITS
        values += 0.0 if offers is None else 8 * (offers[rows] > 0)
        partner[0][rows], score[0][rows] = values.argmax(axis=1), values.max(axis=1)
        better = (most := values.max(axis=0)) > score[1]
        partner[1][better], score[1][better] = first + values.argmax(axis=0)[better], most[better]
    at = int(score[0].argmax())
    found = [
        (own[0] + own[1][partner[0]] - ((left & right[partner[0]]) @ weight)),
        (own[1] + own[0][partner[1]] - ((right & left[partner[1]]) @ weight)),
    ]
    pair, most = (at, int(partner[0][at])), float(found[0][at])
    return BestPairs((found[0], found[1]), (partner[0], partner[1]), pair, most, count)


def _bits(table: Table, name: str, count: int) -> np.ndarray:
    return _unpacked(table[f"{name}_bits"], count)


def _unpacked(bits: np.ndarray, count: int) -> np.ndarray:
    return np.unpackbits(bits, axis=1, count=count, bitorder="little").astype(bool)


def _table_of_pairs(offered: np.ndarray, offers: np.ndarray, undecided: np.ndarray) -> Table:
    """A row for each pair of placements that offers a hand-over: which and how many, and how many are undecided."""
    first, second = at = np.nonzero(offers)
    columns = {"first": first, "second": second, "poses": offers[at], "undecided": undecided[at]}
    return Table(columns | {"poses_bits": offered[at]}, {})


def _with_partners(table: Table, weight: np.ndarray, partner: np.ndarray) -> Table:
    return replace(table, columns=table.columns | {"weight_together": weight, "partner": partner})
