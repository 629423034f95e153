"""The refined volume of a ``workspace`` job, and the labels of its voxels."""

from typing import Any

from wsrender.reachability.refined_volume import POSITION_M, RefinedVolumes, VolumeEstimate, refined_volume
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
