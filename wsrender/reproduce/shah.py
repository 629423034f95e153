"""The 6-PUS of Shah, Narayanan, Krovi: CAD-enhanced workspace optimization for parallel manipulators, 2010 ([SNK])."""

import time
from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np

from wsrender.analyses.jobs import parse_job
from wsrender.mechanisms.ball_region import BallRegion, ball_region
from wsrender.mechanisms.exact import exact_volumes
from wsrender.mechanisms.mechanism import mechanism_of
from wsrender.reproduce.row import Row
from wsrender.run import execute
from wsrender.run.steps import Progress

DESIGN: dict[str, Any] = {"library": "six_pus", "platform_m": 1.5, "link_m": [2.5, 2.7, 2.6]}
TILT_DEG = [30.0, 20.0, 0.0]
GRID_M = 0.05
# Exact volumes [m³] known from two independent computations, to nine decimals.
EXACT, EXACT_ALIKE, EXACT_OPTIMUM, EXACT_BETTER = 0.717344315, 0.963565768, 1.262423473, 1.317761291
BOUNDS = {"x": (-0.875, 0.797), "y": (-0.918, 0.775), "z": (1.333, 2.420)}
METHODS = {  # of the paper: ours, its seconds
    "A": ("grid", 29.241),
    "B": ("grid_by_subsystem", 0.878),
    "C": ("exact", 0.731),
    "D": ("solids", None),
}
SWEEP_SECONDS, SWEEP_RANGE = 42.5, (0.4, 1.26)
STEPS = np.linspace(0.0, 2.0, 21)  # of the platform's side from 1 m, of all links from 2.3 m
OURS = f"grid of {GRID_M:g} m"
NUMBERED = "links 2.6/2.7/2.5: the paper numbers the subsystems two ways"
MEASURED = "measured now, kernels loaded; published: the authors' computer of 2010"
NO_OPTIMUM = "not an optimum: l = 2 with all links 2.25, within the same bounds, is larger"


def shah(progress: Progress | None = None) -> list[Row]:
    """Volumes by four methods with their times, exact bounds and topology, the sweep of 441 designs, the optimum."""
    run = partial(_run, progress)
    return [*_methods(run), *_volumes(run), *_boundary(run), *_sweep(), *_optimum(run)]


def _run(progress: Progress | None, mechanism: dict[str, Any], method: str, **fields: Any) -> dict[str, Any]:
    """The result document of a constant-orientation workspace."""
    size = {} if method in ("exact", "solids") else {"voxel_size_m": GRID_M}
    document = {"analysis": "parallel_workspace", "mechanism": mechanism, "method": method, "device": "cpu"}
    return execute({**document, **size, **fields}, progress).document


def _volume(found: dict[str, Any], method: str) -> float:
    return found["volume_m3"]["occupied" if method.startswith("grid") else method]


def _methods(run: Any) -> Iterator[Row]:
    """The paper's volume and Table 4; each method runs twice, the second is timed."""
    found = {name: [run(DESIGN, method) for _ in range(2)][1] for name, (method, _) in METHODS.items()}
    for name, (method, _) in METHODS.items():
        note = OURS if method.startswith("grid") else ""
        yield Row(f"method {name}", "volume", "m³", _volume(found[name], method), 0.717, EXACT, note=note)
    for name, (_, seconds) in METHODS.items():
        yield Row(f"method {name}", "time", "s", found[name]["timing_s"]["sweep"], seconds, note=MEASURED)


def _volumes(run: Any) -> Iterator[Row]:
    tilted = run(DESIGN, "exact", orientation={"euler_xyz_deg": TILT_DEG})
    yield Row("turned (30, 20, 0)°", "volume", "m³", _volume(tilted, "exact"), 0.126, note="R = Rx Ry Rz")
    for link, published, exact in ((2.5, 0.964, EXACT_ALIKE), (2.7, 0.842, None)):
        found = run({**DESIGN, "link_m": link}, "exact")
        yield Row(f"all links {link}", "volume", "m³", _volume(found, "exact"), published, exact)


def _boundary(run: Any) -> Iterator[Row]:
    found = run(DESIGN, "exact")
    for name, exact in (("vertices", 18), ("edges", 27), ("faces", 11)):
        yield Row("exact boundary", name, "1", float(found["topology"][name]), exact=float(exact))
    bounds = run({**DESIGN, "link_m": [2.6, 2.7, 2.5]}, "exact")["bounds_m"]
    for axis, published in BOUNDS.items():
        for side, value in zip(("lower", "upper"), published, strict=True):
            at = bounds[side]["xyz".index(axis)]
            yield Row("exact boundary", f"{side} {axis}", "m", at, value, note=NUMBERED)


def _sweep() -> Iterator[Row]:
    """Platform side 1 … 3 m by links of 2.3 … 4.3 m, in steps of 0.1 m, z ≥ 0."""
    designs = [(1.0 + side, 2.3 + link) for side in STEPS for link in STEPS]
    started = time.perf_counter()
    volumes = exact_volumes([_region(side, link) for side, link in designs]).volume
    seconds = time.perf_counter() - started
    case = f"{len(designs)} designs, exactly"
    for name, value, published in zip(("least", "largest"), (volumes.min(), volumes.max()), SWEEP_RANGE, strict=True):
        side, link = designs[int(np.flatnonzero(volumes == value)[0])]
        note = f"at l = {side:.1f} m, links {link:.1f} m"
        yield Row(case, f"{name} volume", "m³", float(value), published, note=note)
    yield Row(case, "time", "s", seconds, SWEEP_SECONDS, note=MEASURED)


def _region(side: float, link: float) -> BallRegion:
    job = parse_job({"analysis": "parallel_workspace", "mechanism": {**DESIGN, "platform_m": side, "link_m": link}})
    return ball_region(mechanism_of(job.mechanism), np.eye(3))


def _optimum(run: Any) -> Iterator[Row]:
    theirs = run({**DESIGN, "platform_m": 1.809, "link_m": [2.256, 2.255, 2.250]}, "exact")
    yield Row("their optimum", "volume", "m³", _volume(theirs, "exact"), 1.264, EXACT_OPTIMUM, note=NO_OPTIMUM)
    better = run({**DESIGN, "platform_m": 2.0, "link_m": 2.25}, "exact")
    note = "links at their lower bound"
    yield Row("l = 2, all links 2.25", "volume", "m³", _volume(better, "exact"), None, EXACT_BETTER, note=note)
