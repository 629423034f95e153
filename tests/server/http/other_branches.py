"""Small jobs whose result documents have what no golden one has: constraints, criteria, flat and empty workspaces."""

_PLANAR = {"dh": {"convention": "standard", "rows": [{"a": 0.5, "limits_deg": [-90, 90]}, {"a": 0.4}]}}
_ARM = {"library": "ur5e"}
_FLOOR = {"items": [{"shape": "half_space", "name": "floor", "point_m": [0, 0, -0.2]}]}
_KEPT = {"environment": _FLOOR, "constraints": {"self_collision": True}}
_HALF = {"region": {"half_space": {"point_m": [0, 0, 0.1], "normal": [0, 0, 1]}}}
_SOBOL = {"method": "sobol", "count": 1024}
_PAIR = [{"robot": _ARM, "sampling": _SOBOL}, {"robot": _ARM, "sampling": _SOBOL, "name": "other"}]
_SHIFTED = {"library": "ur5e", "placement": {"position_m": [0.5, 0, 0]}}
_TARGETS = [
    {"position_m": [0.4, 0.1, 0.3], "quat_wxyz": [0, 1, 0, 0]},
    {"position_m": [1.5, 0, 0], "quat_wxyz": [0, 1, 0, 0], "weight": 2},
]

JOBS = {
    "workspace": {
        "robot": _ARM,
        "sampling": _SOBOL,
        "indices": ["manipulability"],
        "refined_volume": 0.3,
        **_KEPT,
        "voxel_size_m": 0.3,
        "voxel_labels": True,
        "best_sample": "manipulability",
    },
    "indices_at": {"robot": _ARM, "configurations": [[0, -1.5, 1.5, 0, 1, 0], [0, 0, 3, 0, 0, 0]], **_KEPT},
    "reachability": {
        "robot": _ARM,
        "targets": _TARGETS,
        "criteria": [{"least_share": 0.5, "joint_margin_deg": 5}],
        **_KEPT,
    },
    "reachability of a volume": {
        "robot": _ARM,
        "targets": {"box": {"lower_m": [0.3, 0, 0.2], "upper_m": [0.4, 0.1, 0.3]}, "step_m": 0.05},
    },
    "postures": {"robot": _ARM, "position_m": [3, 0, 0], "quat_wxyz": [0, 1, 0, 0], "indices": ["manipulability"]},
    "capability": {"robot": _ARM, "voxel_size_m": 0.5, "directions": 4, **_KEPT},
    "shared_workspace": {
        "robots": [_PAIR[0], _PAIR[1] | {"robot": _SHIFTED}],
        "voxel_size_m": 0.3,
        **_KEPT,
        "refined_volume": 0.4,
        "indices": ["manipulability"],
    },
    "robot_comparison": {
        "robots": _PAIR,
        "voxel_size_m": 0.3,
        **_KEPT,
        "refined_volume": 0.4,
        "indices": ["manipulability", "clearance"],
    },
    "base_placement": {
        "robot": _ARM,
        "targets": _TARGETS,
        "over": {"x_m": [-0.5, 0.5, 0.25]},
        "criteria": [{"least_share": 0.5}],
        "constraints": {"torque": {"payload_kg": 1}},
    },
    "base_placement that serves none": {"robot": _ARM, "points_m": [[9, 0, 0]], "over": {"x_m": [-0.5, 0.5, 0.5]}},
    "inverse_reachability": {"robot": _ARM, "target": {"position_m": [9, 0, 0]}, "over": {"yaw_deg": [0, 90, 45]}},
    "collaborative_volume": {
        "left": {"robot": _ARM},
        "right": {"robot": _SHIFTED},
        "samples": 500,
        "seeds": 1,
        "cells": [4, 4, 4],
        "refined_volume": 0.5,
        **_KEPT,
    },
    "master_slave_mapping": {
        "master": {"robot": _ARM, "sampling": _SOBOL, "constraints": _HALF},
        "slave": {"points": [[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1], [0.1, 0.1, 0.1]]},
    },
    "kinetostatic_field": {"robot": _ARM, "sampling": _SOBOL, "voxel_size_m": 0.3, **_KEPT},
    "parallel_workspace": {
        "mechanism": {"library": "stewart_gough", "length_m": [0.5, 0.8]},
        "voxel_size_m": 0.1,
        "refined_volume": 0.3,
        "kind": "total_orientation",
        "orientations": {"tilt_deg": 10},
    },
    "parallel_workspace that is empty": {"mechanism": {"library": "six_pus", "link_m": 0.2}, "voxel_size_m": 0.2},
    "parallel_workspace of meshes": {"mechanism": {"library": "six_pus", "link_m": 2.5}, "method": "solids"},
    "five_bar": {
        "base_m": 1,
        "proximal_m": 1,
        "distal_m": 0.8,
        "voxel_size_m": 0.2,
        "joint_steps": 16,
        "points_m": [[5, 5]],
        "joint_angles_rad": [[0.3, 2.5], [3.1, 0]],
    },
    "planar_boundary": {"robot": _PLANAR, "sampling": {"method": "random", "count": 2000}, "cells": 200},
    "boundary_patches": {"robot": {"library": "cartesian"}, "cells": 12},
    "method_comparison": {
        "mechanism": {"library": "six_pus", "link_m": 0.2},
        "voxel_sizes_m": [0.4],
        "ball_subdivisions": [1],
    },
    "design_optimization": {
        "design": {
            "analysis": "parallel_workspace",
            "mechanism": {"library": "six_pus", "link_m": 2.5},
            "method": "exact",
        },
        "parameters": [{"name": "link", "pointers": "/mechanism/link_m", "bounds": [0.1, 2.6]}],
        "objectives": [{"value": "exact_inscribed_sphere"}, {"value": "exact_inscribed_cube"}],
        "search": {"method": "sweep", "steps": 3},
    },
    "design_optimization with faults": {
        "design": {
            "analysis": "workspace",
            "robot": _PLANAR,
            "sampling": _SOBOL,
            "task": ["x", "y"],
            "voxel_size_m": 0.1,
            "indices": ["manipulability"],
            "refined_volume": None,
        },
        "parameters": [{"name": "voxel", "pointers": "/voxel_size_m", "bounds": [1e-7, 0.2]}],
        "objectives": [{"value": "/volume_m3/occupied"}],
        "search": {"method": "sweep", "steps": 2},
    },
}


def job_of(name):
    """The job document of a name, which begins with its analysis."""
    return {"analysis": name.partition(" ")[0], **JOBS[name]}
