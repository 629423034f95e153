"""What there is to draw of one robot, and whether it is the one that a result is of."""

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from wsrender.errors import InputError
from wsrender.results.drawing.faces import Faces
from wsrender.results.render.scene import DrawnSurface
from wsrender.robot import Robot, as_robot, link_shapes, load_robot
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.volume_data import VolumeData, coarser

DENSE = 8  # samples per occupied voxel from which chance leaves hardly any gap
FEWEST_VOXELS = 24  # along the longest side
MOST_OCCUPIED = 200_000  # more make a picture slow, not finer
_POSES = ("T_world_base", "T_tip_tool")


@dataclass(frozen=True, eq=False)
class Subject:
    """A robot and its workspace; ``body`` holds the surfaces of its links, where they are known.

    ``faces`` is the surface of a workspace that is known without voxels; ``legs`` says how many of the first arms of
    ``skeleton`` belong together, as the legs of a mechanism do.
    """

    name: str
    samples: DistributionMap | None = None
    volume: VolumeData | None = None
    skeleton: np.ndarray | None = None
    body: list[DrawnSurface] = field(default_factory=list)
    faces: Faces | None = None
    legs: int = 1

    def with_robot(self, robot: Any, configuration: Any, sampling: Mapping[str, Any]) -> "Subject":
        """The subject with the links of its robot at a configuration [rad or m].

        Without a configuration: a quarter into the range of every joint but those that ``sampling``, of the result
        document, locks.
        """
        robot = as_robot(robot)
        if configuration is None:
            configuration = robot.chain.within(0.25)
            for name, value in (sampling.get("locked") or {}).items():
                configuration[list(robot.joint_names).index(name)] = value
        body = [DrawnSurface(shape.vertices, shape.faces, shape.color) for shape in link_shapes(robot, configuration)]
        return replace(self, skeleton=robot.skeleton(configuration), body=body, legs=1)

    @property
    def arm(self) -> np.ndarray | None:
        """Base, joints and tip in the configuration that is drawn, (L+2, 3) [m]."""
        return self.arms[0] if len(self.arms) else None

    @property
    def arms(self) -> np.ndarray:
        """The arm, or all legs of a mechanism, (A, L+2, 3) [m]; none where nothing is known."""
        return np.empty((0, 2, 3)) if self.skeleton is None else np.asarray(self.skeleton, float)[: self.legs]

    def cloud(self) -> DistributionMap:
        """Its samples; InputError where there are none."""
        if self.samples is None or len(self.samples) == 0:
            raise InputError("view", f"the result of {self.name} holds neither a map nor a sample of it")
        return self.samples

    def voxels(self) -> VolumeData:
        """Its volume data; InputError where there are none or all are empty."""
        if self.volume is None or not self.volume.n_occupied:
            raise InputError("view", f"the result of {self.name} holds no occupied voxel")
        return self.volume

    def dense_voxels(self) -> VolumeData:
        """Its volume data on voxels so large that gaps are gaps of the workspace, not between samples."""
        merged = volume = self.voxels()
        for factor in range(2, max(volume.shape) // FEWEST_VOXELS + 1):
            occupied = merged.n_occupied
            if merged.voxels.count.sum() >= DENSE * occupied and occupied <= MOST_OCCUPIED:
                break
            merged = coarser(volume, factor)
        return merged


def own_robot(robot: Any, entries: Sequence[Mapping[str, Any]]) -> tuple[int, Robot]:
    """Which of a result's robots this is, and the robot as it stood there.

    ``robot`` is what `wsrender.load_robot` takes (then base, tip and placement are those of the result), or a Robot;
    ``entries`` are the parts of the result document about each robot. Entries without hashes fit any robot. Raises
    InputError naming both for another arm, or for the same with another base, tip, tool or placement.
    """
    given = as_robot(robot)
    same = [k for k, entry in enumerate(entries) if _same_model(given, entry)]
    if not same:
        raise InputError("robot", _another(given, entries))
    for k in same:
        placed = _as_in_result(robot, entries[k]) if isinstance(robot, str | Path) else given
        if _same_frames(placed, entries[k]):
            return k, placed
    raise InputError("robot", _stands_elsewhere(given, entries[same[0]]))


def _same_model(robot: Robot, entry: Mapping[str, Any]) -> bool:
    if "model_hash" not in entry:
        return True
    return robot.model_hash == entry["model_hash"] or robot.chain.content_hash == entry.get("chain_hash")


def _as_in_result(robot: str | Path, entry: Mapping[str, Any]) -> Robot:
    base, tip = entry.get("base_frame"), entry.get("tip_frame")
    placement, tool = (np.array(entry[name]) if name in entry else None for name in _POSES)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the model: said when it was loaded to be compared
        return load_robot(robot, base=base, tip=tip, placement=placement, tool=tool)


def _same_frames(robot: Robot, entry: Mapping[str, Any]) -> bool:
    names = ("base_frame", "tip_frame")
    return all(getattr(robot, name) == entry.get(name, getattr(robot, name)) for name in names) and all(
        np.allclose(getattr(robot.chain, name), entry[name], rtol=0, atol=1e-9) for name in _POSES if name in entry
    )


def _another(robot: Robot, entries: Sequence[Mapping[str, Any]]) -> str:
    own = " and ".join(f"{entry.get('name', 'another')} (model {_short(entry)})" for entry in entries)
    mine = _short({"model_hash": robot.model_hash})
    return f"{robot.name} (model {mine}) is another arm than that of the result, {own}; give its model, or no robot"


def _stands_elsewhere(robot: Robot, entry: Mapping[str, Any]) -> str:
    frames = f"from {robot.base_frame} to {robot.tip_frame}"
    own = f"from {entry.get('base_frame')} to {entry.get('tip_frame')}"
    return (
        f"{robot.name} goes {frames} where it is placed; in the result, {entry.get('name')} goes {own}, with its own "
        "placement and tool; load it with the same base, tip, placement and tool"
    )


def _short(entry: Mapping[str, Any]) -> str:
    return str(entry.get("model_hash", "unknown"))[:8]
