"""The result of a ``parallel_workspace`` job."""

from typing import TYPE_CHECKING, Any

import numpy as np

from wsrender.analyses.contract import Draft
from wsrender.analyses.parallel_workspace.headline import notices, refined_of, workspace_headline
from wsrender.analyses.parallel_workspace.lattice import FlatLattice, quantity
from wsrender.analyses.parallel_workspace.singularities import singularities
from wsrender.analyses.partial_result import PartialResult
from wsrender.analyses.provenance import robot_entry
from wsrender.documents.options import TASK_ROWS
from wsrender.global_indices import voxel_volumes, workspace_mean
from wsrender.indices.index_catalogue import unit
from wsrender.indices.units import task_matrix
from wsrender.mechanisms.hybrid import Variant, from_middle, middle
from wsrender.mechanisms.inverse_kinematics import inverse_kinematics
from wsrender.mechanisms.jacobians import DETERMINANTS
from wsrender.mechanisms.keeping_apart import bodies_apart, stand
from wsrender.mechanisms.mechanism import Mechanism
from wsrender.mechanisms.membership import fault_at, in_base_frame, in_world
from wsrender.pipeline.sampling import subsample
from wsrender.robot.constraints import samples_entry
from wsrender.volume.distribution_map import DistributionMap
from wsrender.volume.lattice import LatticeBlock
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData
from wsrender.volume.voxels import Voxels

if TYPE_CHECKING:
    from wsrender.analyses.parallel_workspace.run import ParallelWorkspaceAnalysis

PICTURE_SAMPLES = 30_000
ON_FACE = 1e-9  # of a voxel: a plane on the faces between two layers lies in the upper one


def positions_result(plan: "ParallelWorkspaceAnalysis", partial: PartialResult) -> Draft:
    """Of the kinds whose positions vary."""
    job, found = plan.job, plan.counted(partial)
    volume = _volume(plan, partial, found)
    document = mechanism_entries(plan) | {
        "sampling": {
            "method": job.method,
            "samples": sum(count for _, count in plan.shards),
            "legs_evaluated": int(partial["asked"][0]),
            **_undecided(plan, int(partial["asked"][1])),
        },
        **_samples(plan, partial["asked"][2:]),
        "voxel_size_m": plan.block.voxel_size_m if plan.block else job.voxel_size_m,
        "volume_m3": _volumes(plan, partial, volume),
        "indices": _index_entries(plan, volume) if volume else {},
        "bounds_m": _bounds(volume),
    }
    if isinstance(plan.block, FlatLattice):
        document["flat"] = _flat_entry(plan.block, int(found.sum()), refined_of(partial))
    if volume is None:
        document["empty"] = plan.unmeasured or _reason(plan)
    tables = {}
    if volume and plan.names:
        document["conditioning"] = _conditioning_entry(volume)
    if volume and plan.names and plan.has_determinants:
        document["singularities"], tables["singularities"] = singularities(plan, partial, volume)
    return Draft(
        document,
        workspace_headline(plan, partial),
        notices(plan, partial, volume),
        volume=volume,
        sample=_sample(volume),
        skeleton=None if volume is None else skeleton_at(plan, _middle(plan, volume)),
        tables=tables,
    )


def orientation_result(plan: "ParallelWorkspaceAnalysis", partial: PartialResult) -> Draft:
    """Of the orientations at a point."""
    orientations, job, is_reached = plan.orientations, plan.job, partial["reached"]
    share = float(orientations.weights[is_reached].sum())
    columns = {name: orientations.angles[:, k] for k, name in enumerate(orientations.names)}
    table = Table(
        {**columns, "quat_wxyz": orientations.quat_wxyz, "reached": is_reached},
        dict.fromkeys(orientations.names, "rad"),
    )
    document = mechanism_entries(plan) | {
        "sampling": {
            "method": "grid",
            "samples": len(is_reached) * len(plan.variants),
            "levels": list(orientations.levels),
            **_undecided(plan, int(partial["undecided"].sum())),
        },
        **_samples(plan, partial["constrained"]),
        "orientation_workspace": {
            "position_m": list(job.position_m or ()),
            "orientations": len(is_reached),
            "reached": int(is_reached.sum()),
            "share": share,
            "share_of_ranges": float(partial["share"][0]),
            "share_of_ranges_ci95": partial["share"][1:].tolist(),
            "measure": "invariant measure of rotations over the ranges given",
        },
    }
    if not is_reached.any():
        document["empty"] = _reason(plan)
    skeleton = None
    if is_reached.any():  # the one that is turned least
        turns = np.trace(orientations.rotations, axis1=1, axis2=2)
        shown = int(np.where(is_reached, turns, -np.inf).argmax())
        skeleton = skeleton_at(plan, np.array(job.position_m), shown)
    return Draft(document, workspace_headline(plan, partial), tables={"orientations": table}, skeleton=skeleton)


def mechanism_entries(plan: "ParallelWorkspaceAnalysis") -> dict[str, Any]:
    """What the documents of all kinds and methods say of the mechanism."""
    return {
        "mechanism": mechanism_entry(plan.mechanism),
        "kind": plan.job.kind,
        "orientations": len(plan.orientations.rotations),
        "serial_configurations": len(plan.variants),
    }


def mechanism_entry(mechanism: Mechanism) -> dict[str, Any]:
    """Name, placement and legs of a mechanism, for the result document."""
    units = ["m" if kind in ("UPS", "PUS") else "rad" for kind in mechanism.kinds]
    rows = zip(
        mechanism.numbers, mechanism.kinds, mechanism.lower.tolist(), mechanism.upper.tolist(), units, strict=True
    )
    legs: dict[int, dict[str, Any]] = {
        number: {"type": kind, "lower": low, "upper": high, "unit": unit} for number, kind, low, high, unit in rows
    }
    for leg in mechanism.numeric:
        legs[leg.number] = {
            "type": "serial",
            "robot": robot_entry(leg.robot),
            "holds": "pose" if leg.holds_pose else "position",
            "actuated": np.array(leg.chain.joint_names)[leg.actuated].tolist(),
        }
    return {
        "name": mechanism.name,
        "T_world_base": mechanism.T_world_base.tolist(),
        "degrees_of_freedom": mechanism.degrees_of_freedom,
        "legs": [legs[number] for number in sorted(legs)],
    }


def _shares(plan: "ParallelWorkspaceAnalysis", partial: PartialResult) -> np.ndarray:
    """The share of the orientations reached per voxel, by their measure; exactly 1 where all are."""
    return partial["weights"] / plan.orientations.whole_weights.sum(dtype=np.int64)


def _volume(plan: "ParallelWorkspaceAnalysis", partial: PartialResult, found: np.ndarray) -> VolumeData | None:
    """``count``: poses reached (orientations, or serial configurations); None where nothing is reached.

    Cells of a plane or line that lie in one voxel are one: poses are added, the best values taken.
    """
    if plan.block is None or not found.any():
        return None
    at = _voxels_of(plan.block, partial["cells"][found])
    low = at.min(axis=0)
    nx, ny, nz = (int(size) for size in at.max(axis=0) - low + 1)
    cells, place = np.unique(np.ravel_multi_index(tuple((at - low).T), (nx, ny, nz)), return_inverse=True)

    def kept(values: np.ndarray) -> np.ndarray:
        best = np.full(len(cells), -np.inf)
        np.maximum.at(best, place, values[found])
        return best

    statistics: dict[str, dict[str, np.ndarray]] = {}
    units: dict[str, str] = {}
    if plan.names:
        values = {name: kept(partial[f"index_{name}"]) for name in (*plan.names, *plan.center_names)}
        statistics["maximum"] = {name: values[name] for name in plan.names}
        statistics["center"] = {name: values[name] for name in plan.center_names}
        matrix = task_matrix(plan.rows, plan.revolute)
        units = {n: unit(n, matrix) for n in plan.names} | dict.fromkeys(plan.center_names, "1")
        cranks = sum(plan.mechanism.revolute)
        if DETERMINANTS[1] in units and cranks:
            units[DETERMINANTS[1]] = f"m^{cranks}"  # a row of A has no unit, one of B that of its joint
    if plan.job.kind == "dexterous":
        statistics["fraction"] = {"orientations": kept(_shares(plan, partial))}
        units["orientations"] = "1"
    count = np.bincount(place, partial["orientations"][found], len(cells)).astype(np.int64)
    first = int(low[0]), int(low[1]), int(low[2])
    return VolumeData.of_voxels(plan.block.voxel_size_m, first, Voxels((nx, ny, nz), cells, count, statistics), units)


def _voxels_of(block: LatticeBlock, cells: np.ndarray) -> np.ndarray:
    """The voxels (V, 3) of the world's lattice in which cells (V,) of a block have their centres."""
    if not isinstance(block, FlatLattice):
        return np.stack(np.unravel_index(cells, block.shape), axis=1) + block.first_voxel
    at = block.centers(cells) / block.voxel_size_m
    return np.floor(at + ON_FACE).astype(np.int64)


def _volumes(plan: "ParallelWorkspaceAnalysis", partial: PartialResult, volume: VolumeData | None) -> dict[str, Any]:
    """Volumes [m³] by voxels, and the refined one if asked."""
    refined = None if isinstance(plan.block, FlatLattice) else refined_of(partial)
    if volume is None or isinstance(plan.block, FlatLattice):
        return {"occupied": 0.0, "inner": 0.0, "outer": 0.0, "refined": refined}
    found, voxel = voxel_volumes(volume), volume.voxel_size_m**3
    entry: dict[str, Any] = {"occupied": found.occupied, "inner": found.inner, "outer": found.outer}
    if plan.job.kind == "dexterous":
        shares = _shares(plan, partial)
        entry["dexterous"] = float((shares >= plan.job.dexterous_threshold).sum() * voxel)
        entry["all_orientations"] = float((partial["orientations"] == len(plan.orientations.rotations)).sum() * voxel)
    return entry | {"refined": refined}


def _flat_entry(block: FlatLattice, cells: int, refined: dict[str, Any] | None) -> dict[str, Any]:
    """Area or length of the cells reached, and refined, and where the plane or line lies in the world."""
    name, unit_of = quantity(block)
    return {
        "quantity": name,
        "unit": unit_of,
        "occupied": cells * block.voxel_size_m**block.dimension,
        "refined": refined,
        "origin_m": list(block.origin_m),
        "axes": [list(axis) for axis in block.axes[: block.dimension]],
    }


def _index_entries(plan: "ParallelWorkspaceAnalysis", volume: VolumeData) -> dict[str, Any]:
    return {
        name: {
            "maximum": float(np.nanmax(volume.voxels.statistics["maximum"][name])),
            "minimum": float(np.nanmin(volume.voxels.statistics["maximum"][name])),
            "workspace_mean": workspace_mean(volume, name),
            "unit": volume.units[name],
            "task": [TASK_ROWS[r] for r in plan.rows],
            **({"options": plan.options[name]} if name in plan.options else {}),
        }
        for name in plan.names
    }


def _conditioning_entry(volume: VolumeData) -> dict[str, Any]:
    """The least condition number (null: infinite everywhere) and the mean of 1/κ over the voxels, of A, B and J."""
    entry = {}
    for matrix in "ABJ":
        inverse = volume.voxels.statistics["center"][f"inverse_condition_number_{matrix}"]
        largest = float(inverse.max())
        entry[matrix] = {
            "least_condition_number": 1 / largest if largest > 0 else None,
            "mean_inverse": float(inverse.mean()),
        }
    return entry


def _bounds(volume: VolumeData | None) -> dict[str, list[float]]:
    """Outer faces of the occupied voxels [m]."""
    if volume is None:
        return {}
    lower = volume.origin_m
    return {"lower": lower.tolist(), "upper": (lower + np.array(volume.shape) * volume.voxel_size_m).tolist()}


def _reason(plan: "ParallelWorkspaceAnalysis") -> str:
    """Why nothing is reached."""
    if plan.block is None and plan.job.kind != "orientation":
        return "no position is within the reach of all legs and the region of the platform"
    if plan.job.kind == "orientation":
        position = np.array(plan.job.position_m)
    else:
        assert plan.block is not None
        position = (np.array(plan.block.first_voxel) + np.array(plan.block.shape) / 2) * plan.block.voxel_size_m
    if isinstance(plan.block, FlatLattice):
        position = plan.block.flat.in_world(position[None])[0]
    variant = middle(plan.variants)
    fault = fault_at(variant.mechanism, _pose(plan, variant, position))
    where = f"at {np.round(position, 6).tolist()} m" + (", serial joints half way," if len(plan.variants) > 1 else "")
    return f"no pose tested is reached; {where} {fault}"


def _pose(
    plan: "ParallelWorkspaceAnalysis", variant: Variant, position_world: np.ndarray, orientation: int = 0
) -> np.ndarray:
    """The platform there at one of the orientations, frame of the variant's base, (4, 4)."""
    pose = np.eye(4)
    pose[:3, :3] = variant.rotations(plan.orientations.rotations[[orientation]])[0]
    pose[:3, 3] = in_base_frame(variant.mechanism, position_world)
    return pose


def _middle(plan: "ParallelWorkspaceAnalysis", volume: VolumeData) -> np.ndarray:
    """The centre of the reached voxel that is nearest to their mean, or what is below it in the plane [m]."""
    cells = volume.voxels.at[:, volume.voxels.count == volume.voxels.count.max()].T
    nearest = cells[((cells - cells.mean(axis=0)) ** 2).sum(axis=1).argmin()]
    center = (nearest + volume.first_voxel + 0.5) * volume.voxel_size_m
    if not isinstance(plan.block, FlatLattice):
        return center
    flat = plan.block.flat
    cell = np.floor(flat.local(center[None]) / volume.voxel_size_m) + 0.5
    return flat.in_world(cell * volume.voxel_size_m)[0]


def skeleton_at(
    plan: "ParallelWorkspaceAnalysis", position_world: np.ndarray, orientation: int = 0
) -> np.ndarray | None:
    """Every leg from its base over its joints to the middle of the platform, (L, K, 3) [m]; None if not reached.

    At the mechanism's home, if it has one, else at the position, world, in one of the orientations; serial joints as
    near to the middle of their ranges as they can be.
    """
    for variant in from_middle(plan.variants):
        mechanism = variant.mechanism
        pose = _pose(plan, variant, position_world, orientation) if mechanism.home is None else mechanism.home
        if not fault_at(mechanism, pose):
            return in_world(mechanism, _legs_at(mechanism, pose))
    return None


def _legs_at(mechanism: Mechanism, pose: np.ndarray) -> np.ndarray:
    """The legs at a reached pose (4, 4), base frame, (L, K, 3) [m]; shorter ones stay at the platform's middle."""
    if mechanism.bodies:
        mechanism = next(each for each in mechanism.on_each_branch() if bodies_apart(each, pose[None])[0])
    legs = inverse_kinematics(mechanism, pose[None])
    lines = [np.stack(line) for line in zip(mechanism.base, legs.elbows[0], legs.joints[0], strict=True)]
    postures = stand(mechanism, pose[None]).q
    lines += [leg.robot.skeleton(q)[0] for leg, q in zip(mechanism.numeric, postures, strict=True)]
    longest = max(len(line) for line in lines) + 1
    return np.stack([np.vstack([line, np.tile(pose[:3, 3], (longest - len(line), 1))]) for line in lines])


def _undecided(plan: "ParallelWorkspaceAnalysis", poses: int) -> dict[str, int]:
    """Poses that count as not reached, for the numerical solution neither found nor excluded one."""
    return {"undecided": poses} if plan.mechanism.numeric else {}


def _samples(plan: "ParallelWorkspaceAnalysis", constrained: np.ndarray) -> dict[str, Any]:
    """Poses that the legs reach by themselves, and what constraints leave of them; nothing without constraints."""
    mechanism = plan.mechanism
    asked = (*mechanism.constraints, *([mechanism.bodies] if mechanism.bodies else []))
    return samples_entry(asked, int(constrained[0]), constrained[1:])


def _sample(volume: VolumeData | None) -> DistributionMap | None:
    """A fixed subsample of the voxels' centres with their values."""
    if volume is None:
        return None
    shown = subsample(volume.n_occupied, PICTURE_SAMPLES)
    kept = volume.voxels.statistics.get("maximum") or volume.voxels.statistics.get("fraction") or {}
    positions = (volume.voxels.at[:, shown].T + volume.first_voxel + 0.5) * volume.voxel_size_m
    return DistributionMap(positions, {name: values[shown] for name, values in kept.items()}, dict(volume.units))
