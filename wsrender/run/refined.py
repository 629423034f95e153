"""Refined volumes in result documents, and the labels of voxels."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from wsrender.reachability.refined_volume import (
    POSITION_M,
    Event,
    RefinedVolumes,
    VolumeEstimate,
    refined_volume,
    refined_volumes,
)
from wsrender.reachability.voxel_labels import counts, label_voxels
from wsrender.robots.chain import Chain
from wsrender.volume.volume_data import VolumeData


def refined(
    chain: Chain, tolerance: float, volume: VolumeData, seed: int, device: str
) -> tuple[dict[str, Any], VolumeData]:
    """Entry of the result document, and the labelled voxels of a workspace's ``volume``."""
    estimate, found = refined_volume(chain, tolerance, seed=seed, device=device)
    labelled = label_voxels(chain, volume, seed=seed, device=device)
    return {**volume_entry(estimate, found, tolerance), "voxels": counts(labelled)}, labelled


def refined_together(
    chains: Sequence[Chain], events: Mapping[str, Event], tolerance: float, device: str, threads: int | None
) -> np.ndarray:
    """Entries of volumes that so many of several placed chains reach, by event, as JSON text."""
    found = refined_volumes(chains, events, tolerance, device=device, threads=threads)
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
        "position_tolerance_m": POSITION_M,
        "false_negatives": [{"tested": f.tested, "missed": f.missed} for f in found.false_negatives],
    }
