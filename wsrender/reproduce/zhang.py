"""WSRender run again ([WSR]): Zhang, Cursi, Yang, IEEE RA-L 4(4), 2019.

Tables III and VI, and the master–slave mapping of slave_5r in the workspace of master_4dof (III.D).
"""

import math
import re
from typing import Any

import numpy as np

from wsrender.geometry.alpha_shape import AlphaShape
from wsrender.indices.index_catalogue import DYNAMIC, KINEMATIC
from wsrender.multi import reached_by
from wsrender.reproduce.row import Row
from wsrender.robots import library
from wsrender.run import execute
from wsrender.run.steps import Progress
from wsrender.volume.volume_data import VolumeData

PER_JOINT = 60  # samples of each of the first three joints; the wrist is held at mid-range
TOLERANCE = 0.005  # of refined volumes, relative

# Table III as printed, three digits. The limits for ever finer grids are known for the Phantom Omni only.
OMNI = (0.553, 0.524, 0.525, 0.855, 0.273, 0.860)
OMNI_LIMITS = (0.5587, 0.5251, 0.5262, 0.8648, None, 0.8702)
PUMA = (0.053, 0.029, 0.036, 0.605, 0.634, 0.655)
STANFORD = (0.061, 0.070, 0.072, 0.619, 0.592, 0.722)
ROUNDING = "±3e-4: the program's determinant is not exactly 0 where the elbow is straight"
NOISE = "rounding noise in the paper: the wrist is singular in every sample"
STANFORD_NOTE = "cannot be run: the published inertias are not physical (link 5, three centres of mass)"

# Table VI as printed: volumes of alpha shapes [m³], ratio; and what is exact, by closed-form inverse kinematics.
PAIRS: dict[str, dict[str, Any]] = {
    "articulated": {"published": (0.0606, 0.0139, 0.229), "exact": (0.05419, 0.01276), "alone": 0.0334749},
    "spherical": {
        "published": (0.0646, 0.0204, 0.316),
        "exact": (0.063155, 0.019779),
        "alone": math.pi / 2 * math.sqrt(2) * (0.4**3 - 0.2**3) / 3,
    },
}
PLACEMENTS: dict[str, dict[str, Any]] = {  # [WSR] Table V; its two rows are swapped in print
    "articulated": {"position_m": [0.1, 0.0, 0.4]},
    "spherical": {"position_m": [0.1, 0.4, 0.0], "rpy_deg": [0.0, 0.0, 90.0]},
}
DEPTHS = (-0.65, -0.75, -0.85)  # of the slave's base below the master's [m]
POINTS, SAMPLES = 4_000, 1_500
CASE = "slave_5r in master_4dof"
UNSTATED = "the paper states no lengths of its master; here: the library's delta on a base that turns ±60°"
MAPPING_TOLERANCE = 0.01


def table_3(progress: Progress | None = None) -> list[Row]:
    """Global indices G1–G6 of the Phantom Omni and G7–G12 of the Puma 560, by the convention of the program."""
    omni = _means({"library": "phantom_omni"}, math.pi / 2, KINEMATIC, progress)
    puma = _means({"mjcf": _puma()}, 0.0, DYNAMIC, progress)
    rows = []
    for k, name in enumerate(KINEMATIC):
        note = ROUNDING if name in ("order_independent_manipulability", "isotropy") else ""
        rows.append(_row("phantom_omni", k + 1, name, omni[name], OMNI[k], OMNI_LIMITS[k], note))
    for k, name in enumerate(DYNAMIC):
        note = "" if k == 4 else NOISE
        rows.append(_row("puma560", k + 7, name, puma[name], PUMA[k], None, note))
    for k, name in enumerate(DYNAMIC):
        rows.append(_row("stanford_arm", k + 7, name, None, STANFORD[k], None, STANFORD_NOTE))
    return rows


def _row(case: str, number: int, name: str, value: float | None, published: float, limit: float | None, note: str):
    return Row(case, f"G{number} {name}", "1", value, published, limit, note=note)


def _puma() -> str:
    """The library's Puma 560 with the joint limits of the paper, ±180°."""
    return re.sub(r'range="[^"]*"', 'range="-180 180"', library.find("puma560").read_text(encoding="utf-8"))


def _means(
    robot: dict[str, str], wrist: float, indices: tuple[str, ...], progress: Progress | None
) -> dict[str, float]:
    """``joint_mean`` of each index over the paper's grid."""
    document = {
        "analysis": "workspace",
        "robot": robot,
        "sampling": _grid(wrist),
        "indices": list(indices),
        "convention": "wsrender_code",
        "precision": "float64",
        "device": "cpu",
        "voxel_size_m": 0.05,
        "refined_volume": None,
    }
    return execute(document, progress).global_indices["joint_mean"]


def _grid(wrist: float) -> dict[str, Any]:
    return {"method": "grid", "per_joint": PER_JOINT, "locked": {"joint4": 0.0, "joint5": wrist, "joint6": 0.0}}


def table_6(progress: Progress | None = None) -> list[Row]:
    """Volumes that two articulated and two spherical arms reach, alone, together and both."""
    return [row for robot in PAIRS for row in _pair(robot, progress)]


def _pair(robot: str, progress: Progress | None) -> list[Row]:
    document = {
        "analysis": "shared_workspace",
        "robots": [_placed(robot, sign) for sign in (1, -1)],
        "indices": ["manipulability"],
        "voxel_size_m": 0.01,
        "refined_volume": TOLERANCE,
    }
    result = execute(document, progress)
    volumes, known, rows = result.document["volume_m3"], PAIRS[robot], []
    refined, shapes = volumes["refined"], _alpha_shapes(result.volume)
    for k, (name, symbol) in enumerate((("any", "V_a"), ("shared", "V_s"))):
        published, exact, shape = known["published"][k], known["exact"][k], shapes[name]
        note = f"of the centres of the voxels, α = {shape.alpha_m:.3g} m; the paper states neither points nor α"
        rows.append(Row(robot, f"{symbol}, alpha shape", "m³", shape.volume_m3, published, exact, note=note))
        rows.append(Row(robot, f"{symbol}, voxels", "m³", volumes[name], None, exact, note="of 0.01 m"))
        rows.append(_refined(robot, f"{symbol}, refined", refined[name], exact))
    exact_ratio = known["exact"][1] / known["exact"][0]
    found = {
        "alpha shape": {name: shape.volume_m3 for name, shape in shapes.items()},
        "voxels": volumes,
        "refined": {name: entry["value"] for name, entry in refined.items()},
    }
    for name, values in found.items():
        published = known["published"][2] if name == "alpha shape" else None
        rows.append(Row(robot, f"R = V_s/V_a, {name}", "1", values["shared"] / values["any"], published, exact_ratio))
    return [*rows, _alone(robot, progress)]


def _alpha_shapes(shared: VolumeData | None) -> dict[str, AlphaShape]:
    """Of the centres of the voxels that any arm and that both reach."""
    assert shared is not None
    reached = {"any": shared, "shared": reached_by(shared, 2)}
    cells = {name: np.argwhere(volume.occupied) + shared.first_voxel for name, volume in reached.items()}
    return {name: AlphaShape.of((each + 0.5) * shared.voxel_size_m) for name, each in cells.items()}


def _alone(robot: str, progress: Progress | None) -> Row:
    """The volume of one arm, whose exact value is known for both."""
    document = {
        "analysis": "workspace",
        "robot": {"library": robot},
        "sampling": _grid(math.pi / 2),
        "indices": ["manipulability"],
        "voxel_size_m": 0.01,
        "refined_volume": TOLERANCE,
    }
    refined = execute(document, progress).document["volume_m3"]["refined"]
    return _refined(robot, "one arm, refined", refined, PAIRS[robot]["alone"])


def _refined(robot: str, quantity: str, found: dict[str, Any], exact: float) -> Row:
    low, high = found["ci95"]
    return Row(robot, quantity, "m³", found["value"], None, exact, low, high, "by inverse kinematics")


def _placed(robot: str, sign: int) -> dict[str, Any]:
    placement = dict(PLACEMENTS[robot])
    x, y, z = placement["position_m"]
    placement["position_m"] = [sign * x, y, z]
    return {"robot": {"library": robot, "placement": placement}, "sampling": _grid(math.pi / 2)}


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
        "refined_volume": MAPPING_TOLERANCE,
    }
    found = execute(document, progress).document["volume_m3"]["refined"]
    low, high = found["ci95"]
    note = "by inverse kinematics, base at 25 angles"
    return Row("master_4dof", "volume", "m³", found["value"], low=low, high=high, note=note)
