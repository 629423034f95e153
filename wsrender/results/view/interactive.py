"""Answers to what a person asks who looks at a result or a robot: the engine behind the viewer, whatever its home.

The requests are those of `wsrender.documents.view_requests`; `container.message` puts an answer into bytes.
"""

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import Field

from wsrender.documents.arm import at_path, models_in
from wsrender.documents.constraints import Constrained
from wsrender.documents.document import Document
from wsrender.documents.options import IndexChoices
from wsrender.documents.placements import COORDINATES, PlacementSpace, mounted, placed
from wsrender.documents.transform import Transform
from wsrender.documents.view_requests import (
    IndicesRequest,
    InverseRequest,
    PlacementRequest,
    PosturesRequest,
    VolumeRequest,
    VoxelRequest,
    read_request,
)
from wsrender.engine import configurations
from wsrender.errors import InputError
from wsrender.indices.units import pretty_unit
from wsrender.results.configurations import configuration_in
from wsrender.results.view.blobs import encoded, limits
from wsrender.results.view.looked_at import LookedAt
from wsrender.results.view.robots import arms_of, shown_job
from wsrender.results.view.volumes import x_fastest
from wsrender.results.view.words import said
from wsrender.robot import Robot, robot_of_spec
from wsrender.robot.live_volumes import LiveVolume, LiveVolumes
from wsrender.volume.volume_data import VolumeData, coarser

if TYPE_CHECKING:
    from wsrender.results.result import Result
    from wsrender.results.view.edited import Edited

MOST_SAMPLES, MOST_VOXELS = 1 << 26, 1 << 24  # of a volume that is computed while it is looked at
Answer = tuple[dict[str, Any], dict[str, bytes]]


class ReplacedError(Exception):
    """The answer is no longer wanted."""


class Choices(IndexChoices, Constrained, Document):
    """What a job says of indices, constraints and surroundings, whatever its analysis."""

    locked: dict[str, float] = Field(default={})
    """Joints that are held, by name [rad or m]."""

    @property
    def held_joints(self) -> Mapping[str, float]:
        """The same, as jobs call it."""
        return self.locked


class Interactive:
    """Answers requests about ``robots``, those of the ``job`` (a canonical document; empty: of none), and a ``result``.

    ``numbers``: the places of the robots among all those of the job; None: there are no others.
    What is costly is made when it is first asked for and kept: solvers and tables of constraints of the two robots that
    were last asked about, and the last volume of each.
    """

    def __init__(
        self,
        job: Mapping[str, Any],
        robots: Sequence[Robot],
        result: "Result | None" = None,
        *,
        numbers: Sequence[int] | None = None,
        device: str = "cpu",
        threads: int | None = None,
        most_samples: int = MOST_SAMPLES,
        most_voxels: int = MOST_VOXELS,
    ):
        self.job, self.robots, self.result = job, list(robots), result
        self.device, self.threads = device, threads
        self.most_samples, self.most_voxels = most_samples, most_voxels
        self._choices = [choices_of(job, number) for number in numbers or range(len(self.robots))]
        self._volumes: dict[int, LiveVolumes] = {}
        self._live: dict[str, LiveVolume] = {}
        self._looked_at: dict[Any, LookedAt] = {}
        self._coarser: tuple[str, int, VolumeData] | None = None

    @classmethod
    def of_result(cls, result: "Result", robots: Sequence[Robot] | None = None, **options: Any) -> "Interactive":
        """About a result and its robots, as they stand in its view; ``options`` as of the class.

        ``robots``: those of the result, where its job cannot load them.
        """
        arms = arms_of(result.document, result.tables, robots, [])
        standing = [arm.robot.changed(placement=arm.T_world_base) for arm in arms]
        job, numbers = shown_job(result.document) or {}, [arm.number for arm in arms]
        return cls(job, standing, result, numbers=numbers, **options)

    @classmethod
    def of_edited(cls, edited: "Edited", **options: Any) -> "Interactive":
        """About a robot that is edited, under what constrains it; ``options`` as of the class.

        Raises InputError where there is none, ModelError.
        """
        if edited.robot is None:
            raise InputError("robot", "must be given: it is what is asked about")
        return cls(edited.model_dump(mode="json"), [robot_of_spec(edited.robot, edited.base, edited.tip)], **options)

    def answer(self, request: Any, wanted: Callable[[], bool] = lambda: True) -> Answer:
        """The header of the answer, JSON values, and its blobs by name.

        ``wanted`` is asked now and then, and `ReplacedError` raised where it is no longer. Raises InputError,
        DocumentError among it, naming the field of the request, and what the engine raises.
        """
        asked = read_request(request)
        match asked:
            case VolumeRequest():
                return self._volume(asked, wanted)
            case VoxelRequest():
                return self._voxel(asked, wanted), {}
            case IndicesRequest():
                return self._at(asked).indices(asked.q), {}
            case InverseRequest():
                return self._at(asked).inverse(asked.position_m, asked.quat_wxyz, asked.near), {}
            case PosturesRequest():
                return self._at(asked).postures(asked.position_m, asked.quat_wxyz), {}
            case PlacementRequest():
                return self._placement(asked), {}

    def _number(self, asked: Any) -> int:
        if asked.robot >= len(self.robots):
            raise InputError("robot", f"there are {len(self.robots)} robots, counted from 0, not {asked.robot}")
        return asked.robot

    def _at(self, asked: IndicesRequest | InverseRequest | PosturesRequest) -> LookedAt:
        """The robot that is asked about, as it has been changed."""
        key = self._number(asked), asked.tool, asked.placement, *sorted(asked.limits.items())
        found = self._looked_at.pop(key, None)
        if found is None:
            robot = self.robots[asked.robot].changed(**_changes(asked))
            found = LookedAt(robot, self._choices[asked.robot], device=self.device, threads=self.threads)
        self._looked_at = dict([*self._looked_at.items()][-1:]) | {key: found}
        return found

    def _volume(self, asked: VolumeRequest, wanted: Callable[[], bool]) -> Answer:
        number, started = self._number(asked), time.perf_counter()
        if asked.samples > self.most_samples:
            raise InputError("samples", f"must be at most {self.most_samples}, not {asked.samples}")
        if number not in self._volumes:
            how = {"device": self.device, "threads": self.threads}
            self._volumes[number] = LiveVolumes(self.robots[number], self._choices[number], seed=_seed(self.job), **how)

        look = _looking(wanted)
        look(0)
        how = {"most_voxels": self.most_voxels, "progress": look, **_changes(asked)}
        try:
            choice = asked.index, asked.statistic, asked.samples, asked.voxel_size_m
            live = self._volumes[number].volume(*choice, **how)
        except InputError as error:
            raise error.at("index") if error.field == "indices" else error from None
        name = f"live_{number}"
        self._live[name] = live
        volume, blobs = packed(name, live, asked.statistic)
        occupied = len(live.voxels.cells)
        header = {
            "volume": volume,
            "samples": asked.samples,
            "volume_m3": occupied * live.block.voxel_size_m**3,
            "elapsed_s": time.perf_counter() - started,
        }
        return header, blobs

    def _voxel(self, asked: VoxelRequest, wanted: Callable[[], bool]) -> dict[str, Any]:
        live = self._live.get(asked.volume)
        if live is not None:
            block, units = live.block, dict.fromkeys(live.pipeline.evaluation.indices, live.unit)
            volume = VolumeData.of_voxels(block.voxel_size_m, block.first_voxel, live.voxels, units)
        else:
            volume = self._named(asked.volume)
            if asked.voxel_size_m is not None:
                volume = self._in_larger(asked.volume, volume, asked.voxel_size_m)
        if any(at >= size for at, size in zip(asked.cell, volume.shape, strict=True)):
            raise InputError("cell", f"{list(asked.cell)} lies beyond the volume's {list(volume.shape)} voxels")
        voxels = volume.voxels
        number = int(np.ravel_multi_index(asked.cell, volume.shape))
        at = int(np.searchsorted(voxels.cells, number))
        held = at < len(voxels.cells) and int(voxels.cells[at]) == number
        center = (np.add(volume.first_voxel, asked.cell) + 0.5) * volume.voxel_size_m
        return {
            "center_m": center.tolist(),
            "count": int(voxels.count[at]) if held else 0,
            "values": [*_values(volume, at)] if held else [],
            **(self._best(asked.volume, volume, at, number, wanted) if held else {"q": None, "sample": None}),
        }

    def _best(self, name: str, volume: VolumeData, at: int, number: int, wanted: Callable[[], bool]) -> dict[str, Any]:
        """Number and configuration of the best sample of an occupied voxel, where it is kept.

        Of a live volume samples are found when they are first asked for: to keep them would slow each sweep down.
        """
        if name in self._live:
            if self._live[name].best is None:
                self._live[name] = self._volumes[int(name.removeprefix("live_"))].with_best(
                    self._live[name], progress=_looking(wanted)
                )
            live = self._live[name]
            sample = int(live.best[np.searchsorted(live.voxels.cells, number)])  # type: ignore[index]
            (q,) = configurations(live.pipeline, np.array([sample]))
            return {"q": q.tolist(), "sample": str(sample)}
        if not volume.voxels.best or self.result is None:
            return {"q": None, "sample": None}
        (numbers,) = volume.voxels.best.values()
        sample = int(numbers[at])
        q = configuration_in(self.result.document, self.robots[0], sample).tolist() if self.robots else None
        return {"q": q, "sample": str(sample)}

    def _named(self, name: str) -> VolumeData:
        volumes: dict[str, VolumeData] = {}
        if self.result is not None:
            volumes = self.result.volumes
            if self.result.volume is not None:
                volumes = {"volume": self.result.volume} | volumes
        if name not in volumes:
            raise InputError("volume", f"there is no {name!r}; {', '.join([*volumes, *self._live]) or 'none'} is there")
        return volumes[name]

    def _in_larger(self, name: str, volume: VolumeData, size: float) -> VolumeData:
        """The volume in voxels of another edge [m]; the last is kept. Raises InputError unless that is a multiple."""
        factor = round(size / volume.voxel_size_m)
        if factor < 1 or abs(size / volume.voxel_size_m - factor) > 1e-9 * factor:
            message = f"must be a whole multiple of the volume's, {volume.voxel_size_m:g}, not {size:g}"
            raise InputError("voxel_size_m", message)
        if factor == 1:
            return volume
        if self._coarser is None or self._coarser[:2] != (name, factor):
            self._coarser = name, factor, coarser(volume, factor)
        return self._coarser[2]

    def _placement(self, asked: PlacementRequest) -> dict[str, Any]:
        """Where the robot stands that is best of a cell, and what the map says there."""
        tables = {} if self.result is None else self.result.tables
        maps = {name: table for name, table in tables.items() if table.grid and set(table.grid.axes) <= {*COORDINATES}}
        if asked.map not in maps or "over" not in self.job:
            raise InputError("map", f"there is no {asked.map!r}; {', '.join(maps) or 'no map of placements'} is there")
        table = maps[asked.map]
        shape = table.grid.shape if table.grid else ()
        if len(asked.cell) != len(shape) or any(at >= size for at, size in zip(asked.cell, shape, strict=True)):
            raise InputError("cell", f"{list(asked.cell)} lies beyond the map's {list(shape)} cells")
        row = int(np.ravel_multi_index(asked.cell, shape))
        over = PlacementSpace(**self.job["over"])
        chosen = {name: float(table[name][row]) for name in COORDINATES if name in table.columns}
        coordinates = [chosen.get(name, float(over.values(name)[0])) for name in COORDINATES]
        T = placed(np.array([coordinates]))[0] @ mounted(self.job.get("mounting", "floor"))
        if isinstance(stated := (self.job.get("robot") or {}).get("placement"), Mapping):
            T = T @ Transform(**stated).matrix()
        values = [
            _value(name, "value", table.units.get(name, "1"), column[row])
            for name, column in table.columns.items()
            if column.ndim == 1 and column.dtype.kind in "iufb" and name not in COORDINATES
        ]
        return {
            "T_world_base": T.ravel().tolist(),
            "at": dict(zip(COORDINATES, coordinates, strict=True)),
            "values": values,
        }


def choices_of(job: Mapping[str, Any], number: int) -> Choices:
    """What a canonical job document says of its robot by number; of one with the key ``robot``, of that."""
    paths = [path[:-1] for path, part in models_in(dict(job)) if path[-1] == "robot"]
    arm = at_path(job, paths[number]) if number < len(paths) else {}
    said = {**job, **arm}
    said.setdefault("locked", (said.get("sampling") or {}).get("locked"))
    given = {name: said[name] for name in Choices.model_fields if name in said and said[name] is not None}
    if not given.get("indices"):
        given.pop("indices", None)
    if constraints := given.get("constraints"):
        given["constraints"] = {name: each for name, each in constraints.items() if name != "arms_collision"}
    return Choices(**given)


def packed(name: str, live: LiveVolume, statistic: str) -> Answer:
    """The entry of a volume in a manifest, its values in bytes, and the blobs that it names."""
    voxels, block = live.voxels, live.block
    (index,) = live.pipeline.evaluation.indices
    counted = statistic == "count"
    values = voxels.count if counted else voxels.statistics[statistic][index]
    low, high = limits(values)
    cells, occupancy, channel = x_fastest(voxels), np.zeros(block.size, np.uint8), np.zeros(block.size, np.uint8)
    occupancy[cells], channel[cells] = 1, encoded(values, "uint8", low, high)
    blobs = {f"{name}/occupancy": occupancy.tobytes(), f"{name}/{statistic}": channel.tobytes()}
    data = {blob: {"blob": blob, "type": "uint8", "length": block.size, "compression": None} for blob in blobs}
    shown = {
        **_value("samples" if counted else index, statistic, "samples" if counted else live.unit, None),
        "minimum": low,
        "maximum": high,
        "data": data[f"{name}/{statistic}"],
    }
    del shown["value"]
    shown["label"] = said("samples") if counted else said(statistic, index)
    volume = {
        "name": name,
        "label": shown["label"],
        "shape": list(block.shape),
        "first_voxel": list(block.first_voxel),
        "voxel_size_m": block.voxel_size_m,
        "occupancy": data[f"{name}/occupancy"],
        "channels": [shown],
        "exact": False,
    }
    return volume, blobs


def _looking(wanted: Callable[[], bool]) -> Callable[[int], None]:
    """Progress that raises `ReplacedError` once an answer is no longer wanted."""

    def look(done: int) -> None:
        if not wanted():
            raise ReplacedError

    return look


def _changes(asked: Any) -> dict[str, Any]:
    """What has been changed of a robot, as `Robot.changed` takes it."""
    tool, placement = (None if T is None else np.reshape(T, (4, 4)) for T in (asked.tool, asked.placement))
    return {"limits": asked.limits, "tool": tool, "placement": placement}


def _seed(job: Mapping[str, Any]) -> int:
    return int((job.get("sampling") or {}).get("seed") or 0)


def _values(volume: VolumeData, at: int) -> Iterator[dict[str, Any]]:
    for statistic, by_index in volume.voxels.statistics.items():
        for name, values in by_index.items():
            yield _value(name, statistic, volume.units.get(name, "1"), values[at])
    for name, vectors in volume.voxels.vectors.items():
        for axis, value in zip("xyz", vectors[at], strict=True):
            yield _value(f"{name}_{axis}", "mean", volume.units.get(name, "1"), value)


def _value(name: str, statistic: str, unit: str, value: Any) -> dict[str, Any]:
    number = None if value is None or not np.isfinite(value) else float(value)
    return {
        "name": name,
        "statistic": statistic,
        "label": name.replace("_", " "),
        "unit": pretty_unit(unit),
        "value": number,
    }
