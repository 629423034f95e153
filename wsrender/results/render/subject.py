"""What there is to draw of one robot."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from wsrender.errors import InputError
from wsrender.results.drawing.faces import Faces
from wsrender.results.render.scene import DrawnSurface
from wsrender.robot import as_robot, link_shapes
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.volume_data import VolumeData, coarser

DENSE = 8  # samples per occupied voxel from which chance leaves hardly any gap
FEWEST_VOXELS = 24  # along the longest side
MOST_OCCUPIED = 200_000  # more make a picture slow, not finer


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
