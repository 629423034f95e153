"""The analysis ``inverse_reachability``: what is known of each base pose, a map of them, and voxels."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from wsrender.analyses.contract import Analysis, Draft, Settled, Tell
from wsrender.analyses.cost import WRITTEN_PER_S, Cost, pictures_cost, surface_bytes
from wsrender.analyses.execution import Execution
from wsrender.analyses.headline import no_headline
from wsrender.analyses.inverse_reachability.job import POSITIONS, InverseReachabilityJob
from wsrender.analyses.partial_result import PartialResult
from wsrender.analyses.placed_bases import UNITS, grid_of
from wsrender.analyses.registry import planned
from wsrender.documents.placements import COORDINATES, PlacementSpace
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData
from wsrender.volume.voxels import Voxels

UNREACHABLE, REACHABLE, UNDECIDED, BLOCKED = range(4)  # codes of labels; the k-th constraint blocks with BLOCKED + k
CELL_BYTES, VOXEL_BYTES, LABEL_BYTES = 20, 12, 4  # of a cell, a voxel and a label in files
MADE_BYTES = 14  # of a base pose while its maps are made
MEASURES = {1: "{:.4g} m", 2: "{:.4g} m²", 3: "{:.4g} m³"}  # of cells, by the number of their axes


@dataclass(frozen=True, kw_only=True)
class InverseReachabilitySettled(Settled):
    """With what the plan of its placements has settled."""

    placements: dict[str, Any]


class InverseReachabilityAnalysis(Analysis):
    """A planned ``inverse_reachability`` job: a ``base_placement`` plan of one target, whose samples are base poses."""

    settles = InverseReachabilitySettled
    job: InverseReachabilityJob
    settled: InverseReachabilitySettled

    def prepare(self, device: str, target: str) -> InverseReachabilitySettled:
        """Raises what planning of ``base_placement`` raises."""
        own = self.placements.settled
        shards, unit = ((0, self.placements.samples),), own.shard_unit
        return InverseReachabilitySettled(device, target, shards, unit, placements=self.placements.resolved())

    @cached_property
    def placements(self) -> Any:
        """The plan that decides the target from all base poses."""
        settled = getattr(self, "settled", None)
        return planned(self.job.placements, self.robot, resolved=settled and settled.placements)

    @property
    def effort(self) -> float:  # type: ignore[override]
        """A base pose's time in samples of a sweep."""
        return self.placements.effort

    @property
    def cost(self) -> Cost:
        """That of the placements, and of maps or voxels instead of a map of them."""
        own, over = self.placements.cost, self.job.over
        cells = float(np.prod([over.shape[COORDINATES.index(name)] for name in POSITIONS]))
        drawn, seconds = pictures_cost("slices", "arm_in_surface") if self._axes == 3 else pictures_cost("placements")
        spared, before = pictures_cost("placements")
        kept = VOXEL_BYTES * cells + surface_bytes(cells) if self._axes == 3 else CELL_BYTES * cells
        files = own.file_bytes + drawn - spared + kept - self.placements.told_bytes + LABEL_BYTES * over.count
        seconds += own.seconds - before + files / WRITTEN_PER_S
        return replace(own, memory_bytes=own.memory_bytes + MADE_BYTES * over.count, file_bytes=files, seconds=seconds)

    @property
    def _axes(self) -> int:
        """How many coordinates of the base's position are ranges."""
        return sum(name in self.job.over.ranges for name in POSITIONS)

    def compute(self, shard: int, execution: Execution, tell: Tell) -> PartialResult:
        """As `base_placement` computes a shard of one target."""
        own = self.shards[shard]
        plan = self.placements if self.placements.shards == [own] else self.placements.over(*own)
        return plan.compute(0, execution, tell)

    def merge(self, a: PartialResult, b: PartialResult) -> PartialResult:
        """The base poses of both, in their order."""
        return self.placements.merge(a, b)

    def unpacked(self, partial: PartialResult) -> Any:
        """What the plan of placements has packed."""
        return self.placements.unpacked(partial)

    def result(self, partial: PartialResult, execution: Execution) -> Draft:
        """The table ``bases``, over ranges of one or two lengths the table ``base_map``, over three voxels."""
        draft, over = self.placements.result(partial, execution), self.job.over
        names = list(self.placements.names)
        label = _codes(draft.tables["placements"], names)
        reached = (label == REACHABLE).reshape(-1, int(np.prod(over.shape[3:])))
        weights = orientation_weights(over)
        places, share = reached.sum(axis=1), reached @ weights
        counts = {"reachable": REACHABLE, "unreachable": UNREACHABLE, "undecided": UNDECIDED}
        labels = {name: int((label == code).sum()) for name, code in counts.items()}
        blocked = {name: int((label == BLOCKED + k).sum()) for k, name in enumerate(names)}
        about = draft.entries["placements"]
        entry = {
            "count": over.count,
            "shape": about["shape"],
            "orientations": len(weights),
            "labels": labels | ({"blocked": sum(blocked.values())} if names else {}),
            "reasons": {name: n for name, n in blocked.items() if n},
            "codes": ["unreachable", "reachable", "undecided", *(f"blocked_{name}" for name in names)],
            "positions": {"count": len(places), "reached": int((places > 0).sum()), "all": int(reached.all(1).sum())},
            "share": float(share.mean()),
            "alike": about["alike"],
            "evidence": about["evidence"],
        }
        columns = {name: column for name, column in draft.tables["placements"].columns.items() if name in over.ranges}
        grid = grid_of(over, over.ranges) if over.ranges else None
        tables = {"bases": Table(columns | {"label": label}, _units(over), grid)}
        undecided = (label == UNDECIDED).reshape(reached.shape).sum(axis=1)
        if self._axes in (1, 2):
            tables["base_map"] = self._map(places, share, undecided)
        volume = self._volume(places, share) if self._axes == 3 and places.any() else None
        best = draft.entries["best"]
        kept = () if best is None else (*COORDINATES, "T_world_base")
        entries = {"bases": entry, "best": None if best is None else {name: best[name] for name in kept}}
        target = draft.tables.get("targets")
        tables |= {} if target is None else {"target": target}
        return Draft(entries, self._headline(places), tables=tables, volume=volume, skeleton=draft.skeleton)

    def _map(self, places: np.ndarray, share: np.ndarray, undecided: np.ndarray) -> Table:
        """Of every position of the base how many orientations reach the target, what share, and how many are open."""
        axes = [name for name in POSITIONS if name in self.job.over.ranges]
        along = np.meshgrid(*(self.job.over.values(name) for name in axes), indexing="ij")
        columns = {name: values.ravel() for name, values in zip(axes, along, strict=True)}
        columns |= {"reachable": places, "share": share, "undecided": undecided}
        return Table(columns, _units(self.job.over), grid_of(self.job.over, axes))

    def _volume(self, places: np.ndarray, share: np.ndarray) -> VolumeData:
        """``count``: orientations that reach the target; "fraction" of "orientations": their share."""
        over, at = self.job.over, np.flatnonzero(places)
        edge = over.ranges["x_m"][2]
        first = np.array([round(over.ranges[name][0] / edge) for name in POSITIONS])
        cells = np.stack(np.unravel_index(at, over.shape[:3]), axis=1) + first
        statistics = {"fraction": {"orientations": share[at].astype(np.float32)}}
        start, voxels = Voxels.at_places(cells, places[at], statistics)
        return VolumeData.of_voxels(edge, start, voxels, {"orientations": "1"})

    def _headline(self, places: np.ndarray) -> dict[str, Any]:
        if not self._axes:
            return no_headline("the base stands in one place")
        steps = [self.job.over.ranges[name][2] for name in POSITIONS if name in self.job.over.ranges]
        whole = MEASURES[self._axes].format(float(np.prod(steps)) * int((places > 0).sum()))
        return no_headline(f"whole cells are counted, {whole} of positions of the base")


def _codes(placements: Table, names: list[str]) -> np.ndarray:
    """The code of the label of every base pose (P,) uint8."""
    found = np.zeros(len(placements), np.uint8)
    kinds = {"served": REACHABLE, "undecided": UNDECIDED} | {f"blocked_{n}": BLOCKED + k for k, n in enumerate(names)}
    for name, code in kinds.items():
        found[placements[f"{name}_bits"][:, 0] > 0] = code
    return found


def orientation_weights(over: PlacementSpace) -> np.ndarray:
    """Share of each orientation (M,), yaw first, roll last, of all rotations that the ranges hold; their sum is 1.

    Cells of roll, pitch and yaw hold rotations as the integral of |cos pitch| says.
    """
    pitch = over.values("pitch_deg")
    step = over.ranges["pitch_deg"][2] if "pitch_deg" in over.ranges else 180.0
    ends = np.stack([pitch - step / 2, pitch + step / 2]) / 180.0
    whole = np.round(ends)
    low, high = 2 * whole + np.sin(np.pi * (ends - whole))
    rolls, pitches, yaws = over.shape[3:]
    each = (high - low) / (high - low).sum() / (rolls * yaws)
    return np.broadcast_to(each[:, None], (rolls, pitches, yaws)).ravel()


def _units(over: PlacementSpace) -> dict[str, str]:
    return {name: UNITS[name] for name in over.ranges}
