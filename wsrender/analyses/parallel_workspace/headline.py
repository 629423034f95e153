"""The one number that a ``parallel_workspace`` is asked for, and what a reader should know of it."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from wsrender.analyses.headline import headline, no_headline
from wsrender.analyses.parallel_workspace.lattice import FlatLattice
from wsrender.analyses.partial_result import PartialResult
from wsrender.analyses.volume_notices import tolerance_not_met
from wsrender.notices import Notice
from wsrender.volume.measure import NOT_ASKED
from wsrender.volume.volume_data import VolumeData

if TYPE_CHECKING:
    from wsrender.analyses.parallel_workspace.run import ParallelWorkspaceAnalysis

DIFFERS = 0.1  # relative: voxels that differ by more from what is refined mislead


def refined_of(partial: PartialResult) -> dict[str, Any] | None:
    """The refined volume, area or length; None where none was asked for."""
    return partial.facts.get("refined")


def workspace_headline(plan: "ParallelWorkspaceAnalysis", partial: PartialResult) -> dict[str, Any]:
    """The headline of a result: the refined measure, or why there is none."""
    if plan.job.kind == "orientation":
        return no_headline('only the orientation varies: "orientation_workspace" holds the share that is reached')
    refined = refined_of(partial)
    name, _ = plan.quantity
    if plan.unmeasured:
        return no_headline(plan.unmeasured, name)
    if refined is None:
        return no_headline(NOT_ASKED, name)
    return headline(name, refined["value"], refined["ci95"])


def notices(plan: "ParallelWorkspaceAnalysis", partial: PartialResult, volume: VolumeData | None) -> Iterator[Notice]:
    """What a reader of the numbers should know."""
    refined = refined_of(partial)
    if plan.search is not None:
        yield from _of_levels(plan, volume, refined)
        if refined is not None and not plan.search.proves:
            yield Notice(
                "serial_joints_sampled",
                "cones, bodies, distances of legs or serial legs are tried at many values of the serial joints, not "
                "searched: the refined volume may miss what is reached between them",
                field="refined_volume",
            )
    if refined is not None:
        yield from tolerance_not_met({**refined, "quantity": plan.quantity[0]})
    if plan.search is None and refined is not None and not isinstance(plan.block, FlatLattice):
        yield from _of_voxels(plan, volume, refined)


def _of_levels(
    plan: "ParallelWorkspaceAnalysis", volume: VolumeData | None, refined: dict[str, Any] | None
) -> Iterator[Notice]:
    levels = " x ".join(str(joint.levels) for joint in plan.search.joints) if plan.search else ""
    remedy = "give the serial joints more levels, or read the refined volume, which searches all their values"
    if refined is None:
        text = f"voxels are those reached at {levels} levels of the serial joints: between them more may be reached"
        yield Notice("serial_levels", text, remedy, "mechanism")
        return
    occupied = _occupied(plan, volume)
    if plan.job.kind == "constant_orientation" and occupied < refined["ci95"][0]:
        text = (
            f"the voxels reached at {levels} levels of the serial joints hold {occupied:.4g} m³, less than the refined "
            f"volume of {refined['value']:.4g} m³ (at least {refined['ci95'][0]:.4g})"
        )
        yield Notice("serial_levels", text, remedy, "mechanism")


def _of_voxels(
    plan: "ParallelWorkspaceAnalysis", volume: VolumeData | None, refined: dict[str, Any]
) -> Iterator[Notice]:
    occupied = _occupied(plan, volume)
    if plan.job.kind == "constant_orientation" and abs(occupied - refined["value"]) > DIFFERS * refined["value"]:
        yield Notice(
            "occupied_differs",
            f"the occupied voxels hold {occupied:.4g} m³, the workspace {refined['value']:.4g} m³",
            "read the refined volume, or choose smaller voxels",
            "voxel_size_m",
        )


def _occupied(plan: "ParallelWorkspaceAnalysis", volume: VolumeData | None) -> float:
    """What the occupied voxels hold [m³]."""
    return 0.0 if volume is None else float(np.count_nonzero(volume.voxels.count)) * volume.voxel_size_m**3
