"""The analysis ``master_slave_mapping``: a slave's workspace in its master's ([WSR] III.D)."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from wsrender.analyses.contract import Analysis, Draft, Settled, Tell
from wsrender.analyses.cost import DOCUMENT_BYTES, SEARCHED_BYTES, Asks, Cost, pictures_cost
from wsrender.analyses.execution import Execution
from wsrender.analyses.headline import no_headline
from wsrender.analyses.master_slave_mapping.job import (
    MOST_POINTS,
    Containment,
    MappedMechanism,
    MappedRobot,
    MappingSearch,
    MasterSlaveMappingJob,
)
from wsrender.analyses.partial_result import PartialResult
from wsrender.engine import sampled_positions
from wsrender.errors import InputError, ResourceError
from wsrender.geometry.alpha_shape import AlphaShape
from wsrender.geometry.surfaces import surface_entry
from wsrender.mapping import (
    OUT_OF_REACH,
    LinearMapping,
    MeasuredSet,
    ServedShape,
    ServedVoxels,
    VoxelSet,
    best_mapping,
    largest_factor,
    scale_curve,
)
from wsrender.mechanisms.hybrid import workspace_points
from wsrender.notices import Notice
from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.pipeline.pipeline import tip_pipeline
from wsrender.pipeline.sampling import plan_sampling
from wsrender.reach.served_positions import served_positions
from wsrender.robot import Robot
from wsrender.robot.constraints import constraints_of_job, samples_entry
from wsrender.robot.rejections import check_admitted
from wsrender.robots.array_files import Rows, listed_points, listed_provenance
from wsrender.robots.reachable_box import reachable_box
from wsrender.volume.lattice import block_around
from wsrender.volume.table import Table

SIDES = ("master", "slave")
POSITIONS = {"position": "m", "slave_position": "m"}
POINTS_PER_S = 1.2e4  # one CPU core, from the configuration to the end of an alpha shape
SHAPE_BYTES, POINT_BYTES = 3300.0, 350.0  # of a point: while its alpha shape is made, and beside
FILE_BYTES, FAILING_BYTES = 26.0, 45.0  # of a point; of the slave's, of which some fail
SEARCHED_PER_S = 3e3  # positions of rejected samples, of one core
REJECTED = 0.2  # the share of samples for whose positions the estimate expects a search
SURFACE_BYTES = 700.0  # of an alpha shape's ply and glb, by the square root of its points

Source = Robot | MappedMechanism | np.ndarray


class MasterSlaveMappingAnalysis(Analysis):
    """A planned ``master_slave_mapping`` job: one shard of all points."""

    job: MasterSlaveMappingJob

    def prepare(self, device: str, target: str) -> Settled:
        """Raises InputError for points that cannot be read, ResourceError for more points than shapes are made of."""
        counts = [_count(self.job, side, source) for side, source in enumerate(self.sources)]
        for name, count in zip(SIDES, counts, strict=True):
            if count > MOST_POINTS:
                raise ResourceError(name, f"has {count:.4g} points; at most {MOST_POINTS:.4g} are mapped")
        _ = self._voxels, self.constraints
        return Settled(device, target, ((0, sum(counts)),))

    @cached_property
    def sources(self) -> tuple[Source, Source]:
        """Of the master's and the slave's points."""
        robots = iter(self.robots)

        def source(name: str) -> Source:
            of = getattr(self.job, name)
            if name in self.listed:
                return self.listed[name].values
            return of if isinstance(of, MappedMechanism) else next(robots)

        master, slave = map(source, SIDES)
        return master, slave

    @cached_property
    def listed(self) -> dict[str, Rows]:
        """The points of the sides that are points; raises InputError."""
        return listed_points({name: getattr(self.job, name) for name in SIDES})

    @cached_property
    def constraints(self) -> dict[str, tuple[Constraint, ...]]:
        """What the configurations of each side must satisfy; raises InputError."""
        return {
            name: _constraints(getattr(self.job, name), of, name) for name, of in zip(SIDES, self.sources, strict=True)
        }

    @property
    def samples(self) -> int:
        """Points of both."""
        return self.shards[0][1]

    @property
    def cost(self) -> Cost:
        """Points, their bytes with those of the shapes and voxels, and seconds without the search."""
        points, each = float(self.samples), [_count(self.job, side, of) for side, of in enumerate(self.sources)]
        drawn, seconds = pictures_cost("mapping", *(["scales"] if self.job.search else []))
        files = DOCUMENT_BYTES + drawn + FILE_BYTES * points + FAILING_BYTES * each[1]
        files += sum(SURFACE_BYTES * np.sqrt(count) for count in each)
        shapes = SHAPE_BYTES * max(each) + POINT_BYTES * points
        asks = Asks("slave" if each[1] > each[0] else "master", "take fewer points")
        if self._voxels > shapes:
            asks = Asks("containment.voxel_size_m", voxel_size_m=self.job.containment.voxel_size_m)
        searched = sum(count for name, count in zip(SIDES, each, strict=True) if self.constraints[name])
        seconds += points / POINTS_PER_S + REJECTED * searched / SEARCHED_PER_S
        memory = max(shapes + self._voxels, SEARCHED_BYTES * bool(searched)) + self.program_bytes
        return Cost(points, memory, files, seconds, asks)

    @cached_property
    def _voxels(self) -> float:
        """Voxels of both workspaces, a byte each; InputError where they are too small to be numbered.

        Those of a mechanism are counted when its points are known.
        """
        sides = zip(SIDES, self.sources, strict=True)
        return float(sum(_voxels_of(self.job.containment, name, source) for name, source in sides))

    def compute(self, shard: int, execution: Execution, tell: Tell) -> PartialResult:
        """Points of both robots, the mapping of each offset, and the curve of the best.

        Under constraints the points are the decided ones, with ``master_reasons`` and ``slave_reasons``.
        """
        arrays, samples = dict[str, np.ndarray](), {}
        for side, name in enumerate(SIDES):
            found, samples[name] = self._points(side, execution.threads)
            arrays |= {f"{name}{end}": rows for end, rows in found.items()}
        space, own = (self._space(arrays, name) for name in SIDES)
        master, slave = (_served(arrays, name) for name in SIDES)
        given = [self._given(np.array(offset)) for offset in self.job.offsets_m]
        found = [self._found(space, master, slave, each) for each in given]
        mappings = [sought or own_scale for sought, own_scale in zip(found, given, strict=True)]
        tested = [_entry(mapping, space, own, slave, self.constraints["master"]) for mapping in mappings]
        # What the search found first; of it the largest that succeeds, else the one with most points inside.
        best = max(range(len(tested)), key=lambda k: (found[k] is not None, *_merit(tested[k])))
        about = {"best": best, "offsets": tested, "master_m3": space.volume_m3, "slave_m3": own.volume_m3}
        about["admission"] = {name: entry for name, entry in samples.items() if entry}
        if self.job.search is not None:
            curve = scale_curve(space, slave, _of_scale_one(mappings[best]), _scales(self.job.search))
            arrays |= {"scales": curve.factors, "inside": curve.inside}
            about["found"] = found[best] is not None
        tell(self.samples)
        return PartialResult(arrays, about)

    def result(self, partial: PartialResult, execution: Execution) -> Draft:
        """The best mapping, the others beside it, the points that fail, and the shapes."""
        about, master, slave = partial.facts, *(_served(partial.arrays, name) for name in SIDES)
        best = about["offsets"][about["best"]]
        mapping = LinearMapping(np.array(best["scale"]), self._rotation(), np.array(best["offset_m"]))
        mapped, space = mapping.apply(slave), self._space(partial.arrays, "master")
        inside = space.contains(mapped)
        if isinstance(space, ServedShape):
            shape = space.served()
        else:
            shape = space if isinstance(space, AlphaShape) else _shape(master, "master")
        meshes = {"master": shape.mesh(), "slave": _shape(mapped, "slave").mesh()}
        document = {
            "robots": [],
            **self.about_robots(),
            "sampling": {"samples": self.samples},
            **({"admission": about["admission"]} if about["admission"] else {}),
            "mapping": best,
            "offsets": about["offsets"],
            "volume_m3": {"master": about["master_m3"], "slave": about["slave_m3"], "mapped": best["volume_m3"]},
            "surfaces": {name: surface_entry(name, mesh) for name, mesh in meshes.items()},
        }
        if "scales" in partial.arrays:
            most = int(np.argmax(partial["inside"]))
            document["search"] = {
                "found": about["found"],
                "scale": [float(partial["scales"][0]), float(partial["scales"][-1])],
                "most_inside": float(partial["inside"][most]),
                "at_scale": float(partial["scales"][most]),
            }
        failing = {"position": mapped[~inside], "slave_position": slave[~inside]}
        if constraints := self.constraints["master"]:
            names = np.array([_reason(None), "", *map(_reason, constraints)])  # by number, from OUT_OF_REACH
            failing["reason"] = names[_reasons(space, mapped[~inside]) - OUT_OF_REACH]
        tables = {"failing": Table(failing, POSITIONS), "mapping": _points_table(master, mapped, inside)}
        if "scales" in partial.arrays:
            tables["scales"] = _curve_table(partial, about["slave_m3"])
        return Draft(
            document,
            no_headline("the volumes are of shapes around points, estimates without an interval"),
            _search_notices(self.job, about["found"]) if "scales" in partial.arrays else (),
            listed_provenance(self.listed),
            tables=tables,
            meshes=meshes,
        )

    def _points(self, side: int, threads: int | None) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
        """Points of a side, "" (N, 3) [m], and under constraints "_reasons" of each, and what became of its samples."""
        source, name = self.sources[side], SIDES[side]
        if isinstance(source, np.ndarray):
            return {"": source}, {}
        if isinstance(source, MappedMechanism):
            return {"": workspace_points(source.mechanism, source.count, device=self.device, threads=threads)}, {}
        pipeline = tip_pipeline(source.chain, _sampling(self.job, side), MOST_POINTS)
        if not (constraints := self.constraints[name]):
            return {"": sampled_positions(pipeline, self.device, threads=threads)}, {}
        found = served_positions(replace(pipeline, constraints=constraints), self.device, threads)
        samples = samples_entry(constraints, pipeline.sampling.count, found.rejected)
        try:
            check_admitted(samples, constraints)
        except InputError as error:
            raise error.within(name) from None
        blocked = {each.name: int((found.reasons == k).sum()) for k, each in enumerate(constraints, 1)}
        served = int((found.reasons == 0).sum())
        positions = {"served": served, "blocked": blocked, "undecided": found.undecided}
        return {"": found.position, "_reasons": found.reasons}, samples["samples"] | {"positions": positions}

    def _space(self, arrays: Mapping[str, np.ndarray], name: str) -> MeasuredSet:
        """The workspace of a side; under constraints what is served of it."""
        points, reasons, containment = arrays[name], arrays.get(f"{name}_reasons"), self.job.containment
        size = containment.voxel_size_m
        if reasons is None:
            return VoxelSet.of(points, size) if size else _shape(points, name, containment.alpha_m)
        if size:
            space = ServedVoxels.of(points, reasons, size)
        else:
            space = ServedShape(_shape(points, name, containment.alpha_m), reasons)
        if not space.holds_served:
            message = f"leave {int((reasons == 0).sum())} of {len(points)} positions, scattered among blocked ones"
            raise InputError(f"{name}.constraints", f"{message}: widen them, or take more samples")
        return space

    def _rotation(self) -> np.ndarray:
        return self.job.rotation.matrix()[:3, :3] if self.job.rotation else np.eye(3)

    def _given(self, offset: np.ndarray) -> LinearMapping:
        return LinearMapping(np.array(self.job.scale), self._rotation(), offset)

    def _found(
        self, space: MeasuredSet, master: np.ndarray, slave: np.ndarray, given: LinearMapping
    ) -> LinearMapping | None:
        """The largest mapping of the search; None where it finds none, or the job has none."""
        search = self.job.search
        if search is None:
            return None
        if search.uniform and search.offset_m is None:
            start = _of_scale_one(given)
            scale = largest_factor(space, slave, start, scale_curve(space, slave, start, _scales(search)))
            return None if scale is None else start.scaled(scale)
        return best_mapping(
            space,
            (master.min(axis=0), master.max(axis=0)),
            slave,
            _of_scale_one(given) if search.uniform else replace(given, scale=np.ones(3)),
            scale_bounds=search.scale,
            uniform=search.uniform,
            offset_bounds=search.offset_m,
            seed=search.seed,
        )


def _voxels_of(containment: Containment, name: str, source: Source) -> int:
    """Voxels of a workspace; 0 where there are none."""
    size = containment.voxel_size_m
    if size is None or isinstance(source, MappedMechanism):
        return 0
    if isinstance(source, np.ndarray):
        box = source.min(axis=0), source.max(axis=0)
    else:
        box = reachable_box(source.chain, source.chain.lower_limits, source.chain.upper_limits)
    try:
        return block_around(*box, size).size
    except InputError as error:
        raise type(error)("containment.voxel_size_m", f"{error.message} (for the {name})") from None


def _sampling(job: MasterSlaveMappingJob, side: int) -> Any:
    source = (job.master, job.slave)[side]
    assert isinstance(source, MappedRobot)
    return source.sampling


def _count(job: MasterSlaveMappingJob, side: int, source: Source) -> int:
    if isinstance(source, np.ndarray):
        return len(source)
    if isinstance(source, MappedMechanism):
        return source.count
    return plan_sampling(source.chain, _sampling(job, side)).count


def _constraints(side: Any, source: Source, name: str) -> tuple[Constraint, ...]:
    if not isinstance(source, Robot):
        return ()
    try:
        return constraints_of_job(side, source)
    except InputError as error:
        raise error.within(name) from None


def _shape(points: np.ndarray, name: str, alpha_m: float | None = None) -> AlphaShape:
    """The alpha shape of points (N, 3) [m] of a side, which errors name."""
    try:
        return AlphaShape.of(points, alpha_m)
    except InputError as error:
        raise (error.within(name) if error.field == "points" else error) from None


def _served(arrays: Mapping[str, np.ndarray], name: str) -> np.ndarray:
    """Points (N, 3) [m] of a side that count."""
    reasons = arrays.get(f"{name}_reasons")
    return arrays[name] if reasons is None else arrays[name][reasons == 0]


def _reasons(space: MeasuredSet, points: np.ndarray) -> np.ndarray:
    assert isinstance(space, ServedShape | ServedVoxels)
    return space.reason(points)


def _reason(constraint: Constraint | None) -> str:
    """Why a target fails: a constraint, or none that lets it through."""
    return "out of reach" if constraint is None else f"blocked by {constraint.name}"


def _entry(
    mapping: LinearMapping, space: MeasuredSet, own: MeasuredSet, slave: np.ndarray, constraints: Sequence[Constraint]
) -> dict[str, Any]:
    """What the result document says of one mapping.

    ``efficiency`` is the mapping efficiency of [WSR] III.D: volume of the mapped slave over that of the master. Under
    constraints of the master ``reasons`` counts the failing points by why they fail.
    """
    mapped = mapping.apply(slave)
    inside, reasons = space.contains(mapped), {}
    if constraints:
        found = _reasons(space, mapped)
        reasons = {_reason(None): found == OUT_OF_REACH}
        reasons |= {_reason(each): found == k for k, each in enumerate(constraints, 1)}
    volume = own.volume_m3 * mapping.volume_factor
    return {
        "scale": mapping.scale.tolist(),
        "offset_m": mapping.offset.tolist(),
        "succeeded": bool(inside.all()),
        "failing_points": int(np.count_nonzero(~inside)),
        **({"reasons": {name: int(rows.sum()) for name, rows in reasons.items()}} if reasons else {}),
        "inside": float(inside.mean()),
        "volume_m3": volume,
        "efficiency": volume / space.volume_m3,
    }


def _merit(entry: dict[str, Any]) -> tuple[bool, float]:
    return entry["succeeded"], entry["volume_m3"] if entry["succeeded"] else entry["inside"]


def _of_scale_one(mapping: LinearMapping) -> LinearMapping:
    """The mapping in its proportions, its scale 1: the geometric mean of the three."""
    return mapping.scaled(float(np.cbrt(1 / mapping.volume_factor)))


def _scales(search: MappingSearch) -> np.ndarray:
    return np.linspace(*search.scale, search.steps)


def _search_notices(job: MasterSlaveMappingJob, found: bool) -> Iterator[Notice]:
    """That nothing fits; that bounds of a job with a scale of its own were once factors on it."""
    if not found:
        yield Notice(
            "no_scale_fits",
            "no mapping with scales within the bounds lies in the master's workspace; shown is the job's own scale",
            "widen the bounds, or let the search move the offset",
            "search.scale",
        )
    if job.search is not None and any(scale != 1.0 for scale in job.scale):
        low, high = job.search.scale
        yield Notice(
            "scale_bounds",
            f"the search looked at scales of {low:g} … {high:g}; before version 0.2 its bounds were factors on the "
            "job's scale",
            "give the bounds of the scale itself",
            "search.scale",
        )


def _points_table(master: np.ndarray, mapped: np.ndarray, inside: np.ndarray) -> Table:
    """The points of both robots in the master's world: which are the slave's, and which lie in the master's space."""
    columns = {
        "position": np.concatenate([master, mapped]),
        "slave": np.arange(len(master) + len(mapped)) >= len(master),
        "inside": np.concatenate([np.ones(len(master), bool), inside]),
    }
    return Table(columns, POSITIONS)


def _curve_table(partial: PartialResult, slave_m3: float) -> Table:
    """Volume of the mapped slave against its scale (of three, the geometric mean), and where it is all inside."""
    scales, inside = partial["scales"], partial["inside"]
    volume = slave_m3 * scales**3
    columns = {
        "scale": scales,
        "volume": volume,
        "volume_inside": np.where(inside == 1.0, volume, np.nan),
        "share_inside": inside,
    }
    return Table(columns, {"volume": "m^3", "volume_inside": "m^3"})
