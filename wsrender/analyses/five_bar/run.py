"""The analysis ``five_bar``: workspace, conditioning, singularities and aspects of a planar five-bar ([CB])."""

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np

from wsrender.analyses.contract import Analysis, Draft, Settled, Tell
from wsrender.analyses.cost import DOCUMENT_BYTES, WRITTEN_PER_S, Asks, Cost, pictures_cost
from wsrender.analyses.execution import Execution
from wsrender.analyses.five_bar.job import MOST_ROWS, FiveBarJob
from wsrender.analyses.five_bar.presentation import MODE_VOLUMES
from wsrender.analyses.headline import headline, no_headline
from wsrender.analyses.partial_result import PartialResult
from wsrender.analyses.partial_tables import tables_of, with_tables
from wsrender.documents.point_sets import PLANE_HEADERS
from wsrender.errors import InputError
from wsrender.mechanisms.five_bar import ASSEMBLY_MODES, FiveBar
from wsrender.mechanisms.five_bar.aspects import Aspect, aspects
from wsrender.mechanisms.five_bar.condition_numbers import conditioning
from wsrender.mechanisms.five_bar.isotropy import (
    QUANTITIES,
    PlaneLattice,
    cartesian_map,
    isotropic_points,
    joint_axis,
    joint_map,
    plane_bounds,
    plane_lattice,
)
from wsrender.mechanisms.five_bar.loci import LocusPiece, end_point, pieces, postures, type_2_curves
from wsrender.mechanisms.five_bar.mechanism import wrapped
from wsrender.mechanisms.five_bar.region import ArcRegion, workspace
from wsrender.mechanisms.five_bar.tables import (
    INDICES,
    boundary_table,
    iso_table,
    joint_table,
    loci_table,
    outlines_table,
    postures_table,
)
from wsrender.robots.array_files import Rows, listed_provenance, rows_in
from wsrender.volume.lattice import round_to_digits
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData

CELLS_ACROSS = 250  # of the default Cartesian maps
CELLS_PER_S, CURVES_S = 2e5, 0.4  # of maps, and seconds of the curves, one CPU core
CELL_BYTES = 150.0  # of a cell of a map while it is made
# Of a cell in the files; of the curves, and of iso-curves by the square root of the number of cells.
CELL_FILE_BYTES, CURVE_BYTES, ISO_BYTES = 55.0, 1.75e6, 5.7e3
BY_CELLS = Asks("voxel_size_m", "choose larger cells")
HEADERS = {"points_m": PLANE_HEADERS, "joint_angles_rad": (("theta1", "theta2"), ("theta1_rad", "theta2_rad"))}
UNITS = {"det_a": "m^2", "det_b": "m^4"}
SAME_AREA = 1e-9  # of areas: rounding


class FiveBarAnalysis(Analysis):
    """A planned ``five_bar`` job: one shard of all cells of the maps."""

    job: FiveBarJob

    def prepare(self, device: str, target: str) -> Settled:
        """Settles the cells of the maps. Raises InputError for a file of points that cannot be read."""
        _ = self.asked
        return Settled(device, target, ((0, self._cells + self._joint_cells),))

    @cached_property
    def five_bar(self) -> FiveBar:
        """The mechanism."""
        return FiveBar(self.job.base_m, self.job.proximal_m, self.job.distal_m, self.job.limits_rad)

    @cached_property
    def lattice(self) -> PlaneLattice:
        """Of the Cartesian maps."""
        lower, upper = plane_bounds(self.five_bar)
        cell = self.job.voxel_size_m or round_to_digits(float((upper - lower).max()) / CELLS_ACROSS, 2)
        return plane_lattice(self.five_bar, cell)

    @cached_property
    def asked(self) -> dict[str, Rows]:
        """Points (N, 2) [m] and angles (N, 2) [rad] that are asked, by field; raises InputError."""
        found = {name: rows_in(getattr(self.job, name), headers, name) for name, headers in HEADERS.items()}
        for name, rows in found.items():
            if len(rows.values) > MOST_ROWS:
                raise InputError(name, f"must hold at most {MOST_ROWS} rows, not {len(rows.values)}")
        return found

    @property
    def _cells(self) -> int:
        return len(self.job.working_modes) * self.lattice.shape[0] * self.lattice.shape[1]

    @property
    def _joint_cells(self) -> int:
        first, second = (len(joint_axis(self.five_bar, leg, self.job.joint_steps)) for leg in (0, 1))
        return 2 * first * second

    @property
    def cost(self) -> Cost:
        """Cells of the maps, their bytes, and seconds."""
        cells = float(self._cells + self._joint_cells)
        drawn, seconds = pictures_cost(*["map"] * 7)
        files = DOCUMENT_BYTES + drawn + CURVE_BYTES + CELL_FILE_BYTES * cells + ISO_BYTES * np.sqrt(cells)
        seconds += cells / CELLS_PER_S + CURVES_S + files / WRITTEN_PER_S
        return Cost(cells, CELL_BYTES * cells, float(files), float(seconds), BY_CELLS)

    def compute(self, shard: int, execution: Execution, tell: Tell) -> PartialResult:
        """Boundary, loci, aspects, maps and iso-curves of every working mode."""
        five_bar, modes = self.five_bar, self.job.working_modes
        regions = {mode: workspace(five_bar, mode) for mode in modes}
        type_2 = [piece for curve in type_2_curves(five_bar) for piece in pieces(curve)]
        found = [each for mode in modes for each in aspects(five_bar, mode, regions[mode], _of_mode(type_2, mode))]
        maps: dict[str, dict[str, np.ndarray]] = {}
        for done, mode in enumerate(modes, 1):
            values = cartesian_map(five_bar, mode, self.lattice)
            maps[mode] = {name: getattr(values, name).reshape(self.lattice.shape) for name in QUANTITIES}
            tell(done * self._cells // len(modes))
        tables = {
            "boundary_arcs": boundary_table(regions),
            "loci": loci_table(five_bar, regions, type_2),
            "iso_curves": iso_table(five_bar, self.lattice, maps, self.job.levels),
            "aspect_outlines": outlines_table(found),
            "drawn_postures": self._drawn_postures(maps),
            "joint_space": joint_table(joint_map(five_bar, self.job.joint_steps)),
        }
        tell(self._cells + self._joint_cells)
        points, angles = self._rows("points_m"), self._rows("joint_angles_rad")
        about = {
            "workspaces": [_workspace_entry(mode, region) for mode, region in regions.items()],
            "aspects": [_aspect_entry(each) for each in found],
            "kappa": [_least_kappas(mode, values) for mode, values in maps.items()],
            "isotropic_points": [entry for mode in modes for entry in self._isotropic_entries(mode)],
            "points": [entry for point in points for entry in self._point_entries(point)],
            "assemblies": [entry for theta in angles for entry in self._assembly_entries(theta)],
        }
        arrays = {f"map {m} {name}": array for m, values in maps.items() for name, array in values.items()}
        return with_tables(PartialResult(arrays, {"about": about}), tables)

    def result(self, partial: PartialResult, execution: Execution) -> Draft:
        """Areas, aspects, least condition numbers, and the tables and maps behind the pictures."""
        about, job = partial.facts["about"], self.job
        document = {
            "robot": {
                "name": _name(job),
                "base_m": job.base_m,
                "proximal_m": list(job.proximal_m),
                "distal_m": list(job.distal_m),
                "limits_rad": [None if limits is None else list(limits) for limits in job.limits_rad],
            },
            "sampling": {"samples": self._cells + self._joint_cells, "method": "lattices"},
            "voxel_size_m": self.lattice.cell_m,
            **about,
        }
        volumes = {MODE_VOLUMES[mode]: self._volume(partial, mode) for mode in job.working_modes if self._cells}
        headline = _headline([each["area_m2"] for each in about["workspaces"]])
        origin = listed_provenance(self.asked)
        return Draft(document, headline, provenance=origin, tables=tables_of(partial), volumes=volumes)

    def _rows(self, name: str) -> list[list[float]]:
        return self.asked[name].values.tolist()

    def _volume(self, partial: PartialResult, mode: str) -> VolumeData:
        """The maps of a working mode as one layer of the lattice; "value" is that at the centre of a voxel."""
        values = {name: array[:, :, None] for name, array in _parts(partial, f"map {mode} ").items()}
        count = (~np.isnan(values["inverse_kappa_a"])).astype(np.int64)
        first = (*self.lattice.first, 0)
        return VolumeData(self.lattice.cell_m, first, count, {"value": values}, UNITS)

    def _drawn_postures(self, maps: dict[str, dict[str, np.ndarray]]) -> Table:
        """In each working mode the posture of the lattice with the least κ(J): the one that pictures draw."""
        angles = np.full((len(maps), 4), np.nan)
        for row, (mode, values) in enumerate(maps.items()):
            found = values["inverse_kappa_j"].ravel()
            if not np.isnan(found).all():
                best = self.lattice.points()[np.nanargmax(found)]
                angles[row] = self.five_bar.inverse_kinematics(best, mode)[0]
        return postures_table(self.five_bar, list(maps), angles)

    def _isotropic_entries(self, mode: str) -> list[dict[str, Any]]:
        angles = isotropic_points(self.five_bar, mode)
        points = end_point(self.five_bar, angles)
        return [
            {"working_mode": mode, "position_m": point.tolist(), "angles_rad": row.tolist()}
            for point, row in zip(points, wrapped(angles), strict=True)
        ]

    def _point_entries(self, point: Sequence[float]) -> list[dict[str, Any]]:
        """A point in every working mode."""
        return [
            {"position_m": list(point), "working_mode": mode, **self._posture_entry(angles)}
            for mode in self.job.working_modes
            for angles in self.five_bar.inverse_kinematics(point, mode)
        ]

    def _assembly_entries(self, theta: Sequence[float]) -> list[dict[str, Any]]:
        """Actuated angles in both assembly modes."""
        entries = []
        for mode in ASSEMBLY_MODES:
            position = self.five_bar.forward_kinematics(theta, mode)
            angles = postures(self.five_bar, np.array([theta]), position)[0]
            entries.append({"theta_rad": list(theta), "assembly_mode": mode, **self._posture_entry(angles)})
            entries[-1]["position_m"] = None if np.isnan(position).any() else position[0].tolist()
        return entries

    def _posture_entry(self, angles: np.ndarray) -> dict[str, Any]:
        """Reachability, angles and indices of a posture; what has no finite value is null."""
        found = conditioning(self.five_bar, angles)
        reached = not np.isnan(angles).any()
        values = {name: float(getattr(found, name)[0]) for name in INDICES}
        kappas = {f"kappa_{k}": 1 / v if (v := values[f"inverse_kappa_{k}"]) > 0 else None for k in "abj"}
        manipulability = values["manipulability"] if np.isfinite(values["manipulability"]) else None
        entry = {"reachable": reached, "angles_rad": angles.tolist() if reached else None, **kappas}
        return entry | {"manipulability_m2": manipulability}


def _headline(areas: list[float]) -> dict[str, Any]:
    """The exact area, where it is that of every working mode."""
    if not areas or np.ptp(areas) > SAME_AREA * max(areas):
        return no_headline("each working mode has an area of its own, under workspaces", "area")
    return headline("area", areas[0], (areas[0], areas[0]))


def _name(job: FiveBarJob) -> str:
    """Name with L0, L1, L2, both legs' where they differ."""
    pairs = (f"{left:g}" if left == right else f"{left:g}/{right:g}" for left, right in (job.proximal_m, job.distal_m))
    return f"five_bar ({', '.join([f'{job.base_m:g}', *pairs])})"


def _of_mode(found: Sequence[LocusPiece], mode: str) -> list[LocusPiece]:
    return [piece for piece in found if piece.working_mode == mode]


def _parts(partial: PartialResult, prefix: str) -> dict[str, np.ndarray]:
    return {name.removeprefix(prefix): array for name, array in partial.arrays.items() if name.startswith(prefix)}


def _workspace_entry(mode: str, region: ArcRegion) -> dict[str, Any]:
    return {
        "working_mode": mode,
        "area_m2": region.area_m2,
        "perimeter_m": region.perimeter_m,
        "arcs": sum(len(loop) for loop in region.loops),
        "loops": len(region.loops),
    }


def _aspect_entry(aspect: Aspect) -> dict[str, Any]:
    return {
        "working_mode": aspect.working_mode,
        "assembly_mode": aspect.assembly_mode,
        "area_m2": aspect.area_m2,
        "area_error_m2": aspect.area_error_m2,
        "holes": len(aspect.loops) - 1,
    }


def _least_kappas(mode: str, values: dict[str, np.ndarray]) -> dict[str, Any]:
    """Least κ of A, B and J on the lattice, and the mean of 1/κ over the cells reached; null where none is."""
    entry: dict[str, Any] = {"working_mode": mode}
    for matrix in "abj":
        found = values[f"inverse_kappa_{matrix}"]
        known = found[~np.isnan(found)]
        entry[f"least_kappa_{matrix}"] = float(1 / known.max()) if known.size and known.max() > 0 else None
        entry[f"mean_inverse_kappa_{matrix}"] = float(known.mean()) if known.size else None
    return entry
