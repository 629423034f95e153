"""Refined volumes in result documents, and the labels of voxels."""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from wsrender.reachability.refined_volume import (
    Event,
    RefinedVolumes,
    VolumeEstimate,
    refined_volume,
    refined_volumes,
)
from wsrender.reachability.voxel_labels import counts, label_voxels
from wsrender.robots.chain import Chain
from wsrender.volume.volume_data import VolumeData

Progress = Callable[[int, int, str], None]
VOLUME, VOXELS = "refined volume", "labels of voxels"  # what is going on


@dataclass(frozen=True, eq=False)
class Refined:
    """The refined volume of one robot: its entry in the result document, and the labelled voxels."""

    entry: dict[str, Any]
    voxels: VolumeData


def refined(
    chain: Chain, tolerance: float, volume: VolumeData, seed: int, device: str, progress: Progress | None
) -> Refined:
    """The refined volume of a chain, and the labels of a workspace's ``volume``."""
    execution = {"seed": seed, "device": device}
    estimate, found = refined_volume(chain, tolerance, **execution, progress=_named(progress, VOLUME))
    labelled = label_voxels(chain, volume, **execution, progress=_named(progress, VOXELS))
    return Refined({**volume_entry(estimate, found, tolerance), "voxels": counts(labelled)}, labelled)


def refined_together(
    chains: Sequence[Chain], events: Mapping[str, Event], tolerance: float, device: str, progress: Progress | None
) -> np.ndarray:
    """Entries of volumes that so many of several placed chains reach, by event, as JSON text."""
    found = refined_volumes(chains, events, tolerance, device=device, progress=_named(progress, VOLUME))
    entries = {name: volume_entry(estimate, found, tolerance) for name, estimate in found.volumes.items()}
    return np.array(json.dumps(entries))


def volume_entry(estimate: VolumeEstimate, found: RefinedVolumes, tolerance: float) -> dict[str, Any]:
    """What the result document says of one volume [m³] with its 95 % interval."""
    return {
        "value": estimate.value,
        "ci95": [estimate.low, estimate.high],
        "tolerance": tolerance,
        "met": estimate.met,
        "undecided": 2 * estimate.undecided,
        "points": found.points,
        "position_tolerance_m": found.position_m,
        "false_negatives": [{"tested": f.tested, "missed": f.missed} for f in found.false_negatives],
    }


def _named(progress: Progress | None, message: str) -> Callable[[int, int], None] | None:
    return None if progress is None else lambda done, total: progress(done, total, message)
