"""Global values of a sweep: means, volumes, isotropy, structural length ([WSR] eq. 6; Waldron 1979)."""

from dataclasses import dataclass

import numpy as np

from wsrender.engine import Partial
from wsrender.engine.sums import scales_of
from wsrender.pipeline.pipeline import Pipeline
from wsrender.robots.chain import Chain
from wsrender.robots.dh import structural_length
from wsrender.volume.volume_data import VolumeData
from wsrender.volume.voxels import inner_and_outer_counts


def plain_means(pipeline: Pipeline, partial: Partial) -> np.ndarray:
    """Mean of each index over admitted samples, (K,)."""
    return partial.totals / scales_of(pipeline) / max(partial.admitted, 1)


def joint_means(pipeline: Pipeline, partial: Partial) -> np.ndarray:
    """Mean over admitted samples of index / maximum, (K,); 0 where the maximum is 0."""
    mean = plain_means(pipeline, partial)
    return _divided(mean, partial.maximum[3 : 3 + len(mean)].astype(np.float64))


def workspace_mean(volume: VolumeData, name: str) -> float | None:
    """Mean over occupied voxels of voxel value / largest voxel value: its maximum, else its mean.

    None where neither statistic was kept.
    """
    for statistic in ("maximum", "mean"):
        if statistic in volume.voxels.statistics:
            values = volume.voxels.statistics[statistic][name][volume.voxels.count > 0].astype(np.float64)
            return float(_divided(values.mean(), values.max())) if len(values) else None
    return None


def _divided(values, largest):
    largest = np.asarray(largest, np.float64)
    return np.where(largest > 0, values / np.where(largest > 0, largest, 1.0), 0.0)


@dataclass(frozen=True)
class VoxelVolumes:
    """Volumes [m³] of a voxel set: occupied; inner (all 26 neighbours occupied); outer (and all neighbours)."""

    occupied: float
    inner: float
    outer: float


def voxel_volumes(volume: VolumeData) -> VoxelVolumes:
    """Estimates of the reachable volume from occupied voxels; inner and outer are no rigorous bounds."""
    voxel = volume.voxel_size_m**3
    counts = volume.n_occupied, *inner_and_outer_counts(volume.voxels)
    return VoxelVolumes(*(count * voxel for count in counts))


def global_isotropy(partial: Partial) -> float:
    """Smallest over largest singular value of the task matrix over all samples."""
    largest = float(partial.maximum[-2])
    return float(partial.minimum[-1]) / largest if largest > 0 else 0.0


def structural_length_index(chain: Chain, volume_m3: float) -> float | None:
    """Length sum over the cube root of the workspace volume; None where the volume is 0.

    What lies between the base frame and a first joint many reaches away is no link but a placement.
    """
    chain = chain.placed(np.eye(4))
    return structural_length(chain.relative_to(chain.origin)) / float(np.cbrt(volume_m3)) if volume_m3 > 0 else None
