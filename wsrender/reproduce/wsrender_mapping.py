"""Master–slave mapping of WSRender: slave_5r in the workspace of master_4dof ([WSR] III.D)."""

from typing import Any

from wsrender.reproduce.row import Row
from wsrender.run import execute
from wsrender.run.steps import Progress

DEPTHS = (-0.65, -0.75, -0.85)  # of the slave's base below the master's [m]
POINTS, SAMPLES = 4_000, 1_500
CASE = "slave_5r in master_4dof"
UNSTATED = "the paper states no lengths of its master; here: the library's delta on a base that turns ±60°"
TOLERANCE = 0.01


def mapping(progress: Progress | None = None) -> list[Row]:
    """Volumes of both robots, and the largest scale at which the slave's workspace lies in the master's."""
    document: dict[str, Any] = {
        "analysis": "master_slave_mapping",
        "master": {"mechanism": "master_4dof", "count": POINTS},
        "slave": {"robot": {"library": "slave_5r"}, "sampling": {"method": "sobol", "count": SAMPLES}},
        "offsets_m": [[0.0, 0.0, depth] for depth in DEPTHS],
        "search": {"scale": [0.05, 2.0], "steps": 20},
    }
    found = execute(document, progress).document
    volumes, best = found["volume_m3"], found["mapping"]
    alpha = "alpha shape of sampled positions"
    rows = [
        _master(progress),
        Row(CASE, "volume of the master", "m³", volumes["master"], note=alpha),
        Row(CASE, "volume of the slave", "m³", volumes["slave"], note=f"{alpha}, which lie on a sphere of 0.3 m"),
    ]
    for entry in found["offsets"]:
        depth = f"slave's base at z = {entry['offset_m'][2]:g} m"
        note = "all points inside" if entry["succeeded"] else f"{entry['failing_points']} points outside"
        rows.append(Row(CASE, f"largest scale, {depth}", "1", entry["scale"][0], note=note))
    rows.append(Row(CASE, "mapped volume, best offset", "m³", best["volume_m3"]))
    rows.append(Row(CASE, "mapping efficiency, best offset", "1", best["efficiency"], note=UNSTATED))
    return rows


def _master(progress: Progress | None) -> Row:
    """The master's volume by inverse kinematics, beside which that of the alpha shape stands."""
    document = {
        "analysis": "parallel_workspace",
        "mechanism": "master_4dof",
        "voxel_size_m": 0.04,
        "refined_volume": TOLERANCE,
    }
    found = execute(document, progress).document["volume_m3"]["refined"]
    low, high = found["ci95"]
    note = "by inverse kinematics, base at 25 angles"
    return Row("master_4dof", "volume", "m³", found["value"], low=low, high=high, note=note)
