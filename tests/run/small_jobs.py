"""A small job of every analysis, in which inverse kinematics or a sweep runs wherever the analysis has one."""

SAMPLING = {"method": "sobol", "count": 2048}
GRID = {"method": "grid", "per_joint": [9, 8, 3, 7], "locked": {}}
SCARAS = [
    {"robot": {"library": "scara"}, "sampling": GRID},
    {"robot": {"library": "scara", "placement": {"position_m": [0.3, 0, 0]}}, "sampling": GRID},
]
SEVERAL = {"robots": SCARAS, "indices": ["manipulability"], "voxel_size_m": 0.05, "device": "cpu"}
THIN = {  # four joints, so that its boundary is found by inverse kinematics
    "convention": "standard",
    "name": "thin",
    "rows": [
        {"limits_deg": [-60, 60], "a": 0.3},
        {"limits_deg": [20, 150], "a": 0.2, "alpha_deg": 180},
        {"joint": "prismatic", "limits": [0.1, 0.1005]},
        {"joint": "prismatic", "limits": [0.1, 0.1005]},
    ],
}

SMALL_JOBS = {
    "workspace": {
        "analysis": "workspace",
        "robot": "scara",
        "sampling": GRID,
        "indices": ["manipulability"],
        "voxel_size_m": 0.1,
        "refined_volume": 0.2,
        "voxel_labels": True,
        "device": "cpu",
    },
    "indices_at": {
        "analysis": "indices_at",
        "robot": "scara",
        "configurations": [[0, 0, 0, 0]],
        "indices": ["manipulability"],
        "device": "cpu",
    },
    "reachability": {
        "analysis": "reachability",
        "robot": "scara",
        "points_m": [[0.2, 0.1, 0.0], [9.0, 0.0, 0.0]],
        "seed": 3,
        "device": "cpu",
    },
    "capability": {
        "analysis": "capability",
        "robot": "scara",
        "voxel_size_m": 0.2,
        "directions": 5,
        "angle_tolerance_rad": 0.5,
        "seed": 4,
        "device": "cpu",
    },
    "shared_workspace": {
        "analysis": "shared_workspace",
        **SEVERAL,
        "refined_volume": 0.2,
        "scan": {"robot": 1, "axis": "x", "values": [0.2]},
    },
    "robot_comparison": {"analysis": "robot_comparison", **SEVERAL, "refined_volume": 0.2},
    "collaborative_volume": {
        "analysis": "collaborative_volume",
        "left": {"robot": SCARAS[0]["robot"]},
        "right": {"robot": SCARAS[1]["robot"]},
        "samples": 1024,
        "seeds": 2,
        "seed": 5,
        "refined_volume": 0.2,
        "device": "cpu",
    },
    "master_slave_mapping": {
        "analysis": "master_slave_mapping",
        "master": {"robot": "spherical", "sampling": {"method": "sobol", "count": 256}},
        "slave": {"mechanism": "master_4dof", "count": 50},
        "offsets_m": [[0.3, 0, 0]],
        "device": "cpu",
    },
    "kinetostatic_field": {
        "analysis": "kinetostatic_field",
        "robot": "scara",
        "field": {"task": ["x", "y"], "boundary": {"cells": 16, "refined": True}},
        "sampling": {"method": "sobol", "count": 64},
        "voxel_size_m": 0.1,
        "device": "cpu",
    },
    "parallel_workspace": {
        "analysis": "parallel_workspace",
        "mechanism": {"library": "six_pus", "link_m": 2.5},
        "voxel_size_m": 0.2,
        "refined_volume": 0.2,
        "seed": 6,
        "device": "cpu",
    },
    "method_comparison": {
        "analysis": "method_comparison",
        "mechanism": "six_pus",
        "voxel_sizes_m": [0.2],
        "ball_subdivisions": [1],
        "device": "cpu",
    },
    "five_bar": {
        "analysis": "five_bar",
        "base_m": 1,
        "proximal_m": [1, 1.2],
        "distal_m": 0.8,
        "working_modes": ["+-"],
        "voxel_size_m": 0.2,
        "joint_steps": 20,
    },
    "planar_boundary": {
        "analysis": "planar_boundary",
        "robot": "scara",
        "sampling": {"method": "random", "count": 2048, "seed": 7, "locked": {"joint4": 0.0}},
        "cells": 20,
        "device": "cpu",
    },
    "boundary_patches": {"analysis": "boundary_patches", "robot": {"dh": THIN}, "cells": 8},
    "design_optimization": {
        "analysis": "design_optimization",
        "design": {
            "analysis": "workspace",
            "robot": {"library": "scara", "tool": {"position_m": [0, 0, 0]}},
            "sampling": SAMPLING,
            "voxel_size_m": 0.05,
            "refined_volume": 0.2,
            "device": "cpu",
        },
        "parameters": [{"name": "height", "pointers": ["/robot/tool/position_m/2"], "bounds": [0, 0.1]}],
        "objectives": [{"value": "/headline/value"}],
        "search": {"method": "sweep", "steps": 2},
    },
}
