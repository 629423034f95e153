"""Malformed job documents, each with the field and the message that it must give."""

import json

import pytest

from wsrender.analyses.jobs import parse_job
from wsrender.analyses.registry import job_classes
from wsrender.documents.quantities import quoted
from wsrender.documents.reading import LARGEST_DOCUMENT
from wsrender.errors import DocumentError

NAN, INF = float("nan"), float("inf")
WORKSPACE = {"analysis": "workspace", "robot": {"library": "ur5e"}}
INDICES_AT = {"analysis": "indices_at", "robot": {"library": "ur5e"}}


def job(**fields):
    return {**WORKSPACE, **fields}


def at(**fields):
    return {**INDICES_AT, **fields}


def to(**fields):
    return {"analysis": "reachability", "robot": {"library": "ur5e"}, "points_m": [[0, 0, 1]], **fields}


def approach(**fields):
    return {"analysis": "capability", "robot": {"library": "ur5e"}, **fields}


def methods(**fields):
    return {"analysis": "method_comparison", "mechanism": "six_pus", **fields}


def design(**fields):
    return {
        "analysis": "design_optimization",
        "design": {"analysis": "parallel_workspace", "mechanism": "six_pus"},
        "parameters": [{"name": "side", "pointers": ["/mechanism/platform_m"], "bounds": [1, 3]}],
        "objectives": [{"value": "exact_volume"}],
        **fields,
    }


def side(**fields):
    return design(parameters=[{"name": "side", "pointers": ["/mechanism/platform_m"], "bounds": [1, 3], **fields}])


def felt(**fields):
    return {"analysis": "kinetostatic_field", "robot": {"library": "ur5e"}, "field": fields}


SERIAL = {"legs": [{"type": "serial", "robot": "ur5e"}]}


def legs(**fields):
    return {"analysis": "parallel_workspace", "mechanism": "six_pus", **fields}


def five_bar(**fields):
    return {"analysis": "five_bar", "base_m": 6, "proximal_m": 8, "distal_m": 5, **fields}


def planar(**fields):
    return {"analysis": "planar_boundary", "robot": {"library": "scara"}, **fields}


def patched(**fields):
    return {"analysis": "boundary_patches", "robot": {"library": "articulated"}, **fields}


def sampled(**fields):
    return job(sampling={"method": "grid", **fields})


def drawn(**fields):
    return job(sampling={"method": "random", **fields})


def converged(**fields):
    return job(sampling={"method": "converge", **fields})


def nested(depth):
    document = []
    for _ in range(depth):
        document = [document]
    return document


CODE = {"convention": "wsrender_code", "precision": "float64"}
METHODS = 'must be one of "grid", "random", "sobol", "boundary", "converge"'
TASKS = 'must be "linear", "angular", "full" or a list of rows from x y z rx ry rz'
GROUPS = 'must be "kinematic", "dynamic", "all", the name of an index, or a list of such names'

MALFORMED = [
    # the document as a whole
    ("", "document", "is not JSON: Expecting value (line 1, column 1)"),
    ("{", "document", "is not JSON: Expecting property name enclosed in double quotes"),
    ('{"analysis": "workspace",}', "document", "is not JSON"),
    ("[1, 2]", "document", "must be an object, not list"),
    (b"\xff\xfe{}", "document", "must be UTF-8 text; byte 0 is not"),
    ('{"a": NaN}', "document", "must hold finite numbers only, not NaN"),
    ('{"a": -Infinity}', "document", "must hold finite numbers only, not -Infinity"),
    ('{"analysis": "workspace", "analysis": "x"}', "analysis", "must be given only once in its object"),
    ("[" * 100_000, "document", "must not be nested deeper than 32 levels"),
    (job(robot=nested(40)), "document", "must not be nested deeper than 32 levels"),
    ('"' + "x" * LARGEST_DOCUMENT + '"', "document", f"must have at most {LARGEST_DOCUMENT} bytes"),
    ('{"a": ' + "1" * 5000 + "}", "document", "is not JSON: Exceeds the limit"),
    (42, "document", "must be an object, not int"),
    # the analysis
    ({}, "analysis", f"must be one of {quoted(job_classes())}; it is required"),
    ({"analysis": "worksapce"}, "analysis", f'must be one of {quoted(job_classes())}, not "worksapce"'),
    ({"analysis": ["workspace"]}, "analysis", 'not ["workspace"]'),
    # the robot
    ({"analysis": "workspace"}, "robot", "is required"),
    (job(robot=5), "robot", "must be an object, not 5"),
    (job(robot=None), "robot", "must be an object, not null"),
    (job(robot={}), "robot.library", "is required, or another source of the robot"),
    (job(robot={"libary": "ur5e"}), "robot.libary", "did you mean library?"),
    (job(robot=""), "robot.library", "must not be empty"),
    # unknown and wrong fields
    (job(tipp="tool"), "tipp", "is not a known field; did you mean tip?"),
    (at(configurations=[[0]], voxel_size_m=0.1), "voxel_size_m", "is not a known field; allowed: format, robot"),
    (at(configurations=[[0]], sampling={"method": "grid"}), "sampling", "is not a known field"),
    (job(base=""), "base", "must not be empty"),
    (job(tip=3), "tip", "must be a string, not 3"),
    (job(tip="\ud800"), "tip", "must be valid Unicode text"),
    # sampling
    (
        job(sampling=15),
        "sampling",
        'must be an object, such as {"method": "sobol", "count": 1000000}, in Python ws.Sobol',
    ),
    (job(sampling="grid"), "sampling", 'must be an object, not "grid"'),
    (job(sampling={}), "sampling.method", f"{METHODS}; it is required"),
    (job(sampling={"method": "gird"}), "sampling.method", f'{METHODS}, not "gird"'),
    (sampled(per_joint=0), "sampling.per_joint", "must lie between 1 and 1000000000000000, not 0"),
    (sampled(per_joint=10**16), "sampling.per_joint", "must lie between 1 and 1000000000000000"),
    (sampled(per_joint=True), "sampling.per_joint", "must be a whole number, not true"),
    (sampled(per_joint="15"), "sampling.per_joint", 'or a list with one per joint, not "15"'),
    (sampled(per_joint=1.5), "sampling.per_joint", "must be a whole number, not 1.5"),
    (sampled(per_joint=[]), "sampling.per_joint", "must not be an empty list"),
    (sampled(per_joint=[3, 0]), "sampling.per_joint", "not [3, 0]"),
    (sampled(count=3), "sampling.count", "is not a known field; allowed: locked, method, per_joint"),
    (sampled(locked={"joint6": NAN}), "sampling.locked.joint6", "must be a finite number, not NaN"),
    (sampled(locked={"joint6": "0"}), "sampling.locked.joint6", 'must be a number, not "0"'),
    (sampled(locked={"joint6": False}), "sampling.locked.joint6", "must be a number, not false"),
    (sampled(locked=[0.0]), "sampling.locked", "must be an object, not [0.0]"),
    (drawn(), "sampling.count", "is required"),
    (drawn(count=-1), "sampling.count", "must be at least 1, not -1"),
    (drawn(count=10**15 + 1), "sampling.count", "must be at most 1000000000000000, not 1000000000000001"),
    (drawn(count=9, seed=-1), "sampling.seed", "must be at least 0, not -1"),
    (drawn(count=9, seed=2**63), "sampling.seed", "must be at most 9223372036854775807"),
    (converged(tolerance=0), "sampling.tolerance", "must be greater than 0, not 0"),
    (converged(by="mean"), "sampling.by", 'must be "joint_mean" or "workspace_mean", not "mean"'),
    (converged(step=0), "sampling.step", "must be at least 1, not 0"),
    (converged(index=""), "sampling.index", "must not be empty"),
    # indices and task
    (job(indices=""), "indices", f'{GROUPS}, not ""'),
    (job(indices=[]), "indices", "must not be empty, not []"),
    (job(indices=[1]), "indices", f"{GROUPS}, not [1]"),
    (job(indices=None), "indices", f"{GROUPS}, not null"),
    (job(indices=["isotropy", "isotropy"]), "indices", 'must not repeat "isotropy"'),
    (job(task="linea"), "task", f'{TASKS}, not "linea"'),
    (job(task=[]), "task", "must not be empty"),
    (job(task=["x", "x"]), "task", 'must not repeat "x"'),
    (job(task=["x", "w"]), "task", TASKS + ', not ["x", "w"]'),
    (job(task=[["x"]]), "task", TASKS + ', not [["x"]]'),
    (job(characteristic_length_m=0), "characteristic_length_m", "must be greater than 0"),
    (job(characteristic_length_m=INF), "characteristic_length_m", "must be a finite number, not Infinity"),
    (job(convention="std"), "convention", 'must be "standard", "table_1" or "wsrender_code", not "std"'),
    (job(joint_limit_penalty=0), "joint_limit_penalty", "must be 0.001 … 1e6 (the K of the penalisation)"),
    (job(joint_limit_penalty=5e-324), "joint_limit_penalty", "must be 0.001 … 1e6 (the K of the penalisation)"),
    (job(joint_limit_penalty="10"), "joint_limit_penalty", 'must be a number, not "10"'),
    (job(torque_scaling=1), "torque_scaling", "must be true or false, not 1"),
    (job(inertia="mj"), "inertia", 'must be "kernel" or "mujoco", not "mj"'),
    # targets
    (to(points_m=[]), "points_m", "must have at least 1 item"),
    (to(points_m=None), "points_m", 'must be given, or else "targets": one of the two'),
    (to(points_m=[[0, 1]]), "points_m", "must hold rows of 3 numbers; row 0 has 2"),
    (to(points_m=[[0, 1, "2"]]), "points_m", "must be a number"),
    (to(quats_wxyz=[[1, 0, 0, 0], [1, 0, 0, 0]]), "quats_wxyz", "must have as many rows as points_m, 1, not 2"),
    (to(quats_wxyz=[[0, 0, 0, 0]]), "quats_wxyz", "must not have length 0: row 0 says no rotation"),
    (to(angle_tolerance_rad=0), "angle_tolerance_rad", "must be greater than 0, not 0"),
    (approach(directions=0), "directions", "must be at least 1, not 0"),
    (approach(directions=10_001), "directions", "must be at most 10000, not 10001"),
    (approach(approach_axis="w"), "approach_axis", 'must be "x", "y", "z", "-x", "-y" or "-z", not "w"'),
    (approach(dexterous_threshold=1.5), "dexterous_threshold", "must be at most 1"),
    # force fields
    (felt(form="soft"), "field.form", 'must be "normalised" or "potential", not "soft"'),
    (felt(haptic_device={"kind": "gripper"}), "field.haptic_device.kind", 'must be "force" or "wrench", not "gripper"'),
    (
        felt(haptic_device={"continuous_force_n": 9}),
        "field.haptic_device.continuous_force_n",
        "at most peak_force_n, 6.4",
    ),
    (felt(haptic_device={"period_s": 1}), "field.haptic_device.period_s", "must be at most 0.1, not 1"),
    (felt(characteristic_length={"method": "given"}), "field.characteristic_length.length_m", "must be given with"),
    (felt(characteristic_length={"length_m": 1}), "field.characteristic_length.length_m", "and with no other"),
    (felt(joint_limits={"margin_rad": 0}), "field.joint_limits.margin_rad", "must be greater than 0, not 0"),
    (
        felt(conditioning={"condition_threshold": 4}),
        "field.conditioning.condition_threshold",
        "must be above 1 / inverse_condition_on, 5",
    ),
    (felt(boundary={"cells": 2}), "field.boundary.cells", "must be at least 16, not 2"),
    (
        felt(obstacles={"items": [{"shape": "cone"}]}),
        "field.obstacles.items.0.shape",
        'must be one of "half_space", "box", "sphere"',
    ),
    (felt(obstacles={"items": []}), "field.obstacles.items", "must have at least 1 items"),
    (
        felt(obstacles={"items": [{"shape": "mesh", "vertices_m": [[0, 0, 0]]}]}),
        "field.obstacles.items.0.vertices_m",
        "must be a list of 4 … 10000 points [x, y, z]",
    ),
    (
        {"analysis": "kinetostatic_field", "robot": "ur5e", "sampling": {"method": "converge"}},
        "sampling",
        'must not be "converge"',
    ),
    # methods
    (methods(voxel_sizes_m=[]), "voxel_sizes_m", "must not be empty"),
    (methods(voxel_sizes_m=[0.1, 0]), "voxel_sizes_m.1", "must be greater than 0"),
    (methods(ball_subdivisions=[9]), "ball_subdivisions", "must be a list of whole numbers 1 … 7"),
    (methods(ball_subdivisions=[3, 3]), "ball_subdivisions", 'must not repeat "3"'),
    (methods(orientation={"position_m": [0, 0, 1]}), "orientation", "must not shift"),
    # designs
    (design(design={"analysis": "workspace"}), "design.robot", "is required"),
    (design(design=design()), "design", "must be another analysis than design_optimization"),
    (design(design={"analysis": "walk"}), "design.analysis", "must be one of"),
    (design(parameters=[]), "parameters", "must have at least 1 items"),
    (side(bounds=[3, 1]), "parameters.0.bounds", "must be [low, high], low below high"),
    (side(name="a b"), "parameters.0.name", "must have 1 to 64 letters"),
    (side(pointers=[]), "parameters.0.pointers", "must be a JSON pointer, or a list of them"),
    (side(pointers=["mechanism"]), "parameters.0.pointers", 'must start with "/"'),
    (
        side(pointers=["/mechanism/size"]),
        "parameters.0.pointers.0",
        'points to nothing: /mechanism has no "size"; it has',
    ),
    (side(pointers=["/mechanism/library"]), "parameters.0.pointers.0", "must point to a number"),
    (side(pointers=["/mechanism/link_m/0"] * 2), "parameters.0.pointers.1", "must not point where another"),
    (design(objectives=[]), "objectives", "must have at least 1 items"),
    (design(objectives=[{"value": "volume"}]), "objectives.0.value", "or a JSON pointer into the result document"),
    (design(objectives=[{"value": "/side"}, {"value": "/side"}]), "objectives", "must be different values"),
    (design(objectives=[{"value": "exact_volume", "goal": "least"}]), "objectives.0.goal", 'must be "maximize" or'),
    (design(objectives=[{"value": "exact_volume", "weight": 0}]), "objectives.0.weight", "must be greater than 0"),
    (
        design(
            design={"analysis": "workspace", "robot": "ur5e"},
            parameters=[{"name": "size", "pointers": ["/max_samples"], "bounds": [1, 3]}],
        ),
        "objectives.0.value",
        'is of the analysis parallel_workspace, kind "constant_orientation"',
    ),
    (
        design(constraints=[{"coefficients": {"link": 1}, "lower": 0}]),
        "constraints.0.coefficients",
        'must name parameters, "side", not "link"',
    ),
    (design(constraints=[{"coefficients": {"side": 1}}]), "constraints.0.lower", 'must be given, or "upper", or both'),
    (
        design(constraints=[{"coefficients": {"side": 1}, "lower": 2, "upper": 1}]),
        "constraints.0.upper",
        "at least lower",
    ),
    (design(search={"method": "luck"}), "search.method", 'must be one of "differential_evolution", "sweep", "pareto"'),
    (design(search={"method": "sweep", "steps": 0}), "search.steps", "must be a whole number of at least 1"),
    (design(search={"method": "sweep", "steps": [3, 3]}), "search.steps", "must be one number, or 1"),
    (design(search={"method": "pareto"}), "search", 'must not be "pareto" with one objective'),
    (design(search={"method": "sweep", "steps": 1_000_000_0}), "search.steps", "must be a whole number"),
    (design(evaluations=[[1.0]]), "evaluations", "must be rows of 2"),
    (design(evaluations=[[None, 1.0]]), "evaluations", "must be rows of 2"),
    # planar boundaries
    (planar(cells=0), "cells", "must be at least 1, not 0"),
    (planar(cells=2.5), "cells", "must be a whole number, not 2.5"),
    (planar(line_tolerance_m2=0), "line_tolerance_m2", "must be greater than 0, not 0"),
    (planar(arc_tolerance_m4="1"), "arc_tolerance_m4", 'must be a number, not "1"'),
    (planar(points_m=[[0, 0, 0]]), "points_m", "must hold rows of 2 numbers; row 0 has 3"),
    (planar(points_m=[[0, NAN]]), "points_m", "must be a finite number"),
    (planar(sampling={"method": "converge"}), "sampling", 'must not be "converge"'),
    (planar(locked={"joint4": 0}), "locked", "is not a known field"),
    # boundary patches
    (patched(cells=4), "cells", "must be at least 8, not 4"),
    (patched(cells=500), "cells", "must be at most 256, not 500"),
    (patched(cells="many"), "cells", "must be a whole number"),
    (patched(locked={"joint4": "0"}), "locked.joint4", "must be a number"),
    (patched(locked={"joint4": NAN}), "locked.joint4", "must be a finite number"),
    (patched(sampling={"method": "sobol"}), "sampling", "is not a known field"),
    # voxels, map, execution
    (job(voxel_size_m=0), "voxel_size_m", "must be greater than 0"),
    (job(voxel_size_m=-0.01), "voxel_size_m", "must be greater than 0, not -0.01"),
    (job(voxel_size_m=1e300), "voxel_size_m", "must be at most 1000000.0, not 1e+300"),
    (job(voxel_size_m="1 mm"), "voxel_size_m", 'must be a number, not "1 mm"'),
    (
        '{"analysis": "workspace", "robot": "a", "voxel_size_m": 1e999}',
        "voxel_size_m",
        "must be a finite number",
    ),
    (job(voxel_statistics=["median"]), "voxel_statistics", "must be a list of items from count maximum"),
    (job(voxel_statistics="count"), "voxel_statistics", 'must be a list, not "count"'),
    (job(voxel_statistics=["mean", "mean"]), "voxel_statistics", 'must not repeat "mean"'),
    (job(refined_volume=0), "refined_volume", "must be at least 0.0001, not 0"),
    (job(keep_map="yes"), "keep_map", 'must be true or false, not "yes"'),
    (job(map_columns=["speed"], keep_map=True), "map_columns", "items from configuration orientation"),
    (job(map_columns=["orientation"]), "map_columns", 'must be empty unless "keep_map" is true'),
    (job(max_samples=0), "max_samples", "must be at least 1, not 0"),
    (job(precision="float16"), "precision", 'must be "float32" or "float64", not "float16"'),
    (job(device="gpu"), "device", 'must be "auto", "cpu", "cuda" or "cuda:N", not "gpu"'),
    (job(device="cuda:x"), "device", 'not "cuda:x"'),
    # fields that do not go together
    (job(convention="wsrender_code"), "precision", 'must be "float64" with the convention "wsrender_code"'),
    (job(**CODE, task="angular"), "task", 'must be left at "linear"'),
    (job(**CODE, indices="all", torque_scaling=True), "torque_scaling", "must be false with the convention"),
    (job(torque_scaling=True), "torque_scaling", "must be false with kinematic indices"),
    # configurations
    (at(configurations=3), "configurations", "must be a list, not 3"),
    (at(configurations=[[0, 1], [0]]), "configurations", "must hold rows of one length"),
    (at(configurations=[[0, "1"]]), "configurations", "must be a number"),
    (at(configurations=[[0, NAN]]), "configurations", "must be a finite number"),
    # the five-bar
    ({"analysis": "five_bar", "proximal_m": 8, "distal_m": 5}, "base_m", "is required"),
    (five_bar(base_m=0), "base_m", "must be greater than 0, not 0"),
    (five_bar(base_m=1e-9), "base_m", "within 1/10000 of the longest link"),
    (five_bar(distal_m=1e7), "base_m", "must lie within 1e-06 … 1e+06 m"),
    (five_bar(proximal_m=[8, 0]), "proximal_m", "must be a number above 0, or a list of two: left and right"),
    (five_bar(distal_m=[5, 5, 5]), "distal_m", "must be a number above 0, or a list of two"),
    (five_bar(limits_rad=[[0, 1]]), "limits_rad", "must be a list of two: [low, high] or null"),
    (
        five_bar(limits_rad=[[1, 0], None]),
        "limits_rad",
        "must be [low, high] for each leg, high 0.001 rad to a turn above low",
    ),
    (five_bar(limits_rad=[None, [0, 7]]), "limits_rad", "to a turn above low"),
    (five_bar(working_modes=["+"]), "working_modes", 'must be a list of items from "++", "+-", "-+", "--"'),
    (five_bar(working_modes=[]), "working_modes", "must not be empty"),
    (five_bar(levels=[1]), "levels", "must be a list of at most 50 different numbers above 1"),
    (five_bar(voxel_size_m=1e-4), "voxel_size_m", "must be at least 0.026 for links of these lengths"),
    (five_bar(joint_steps=4), "joint_steps", "must be at least 8, not 4"),
    (five_bar(points_m=[[1, 2, 3]]), "points_m", "must hold rows of 2 numbers; row 0 has 3"),
    (
        five_bar(points_m=[[1, 2]] * 10_001),
        "points_m",
        "must be a list of at most 10000 pairs of numbers, not of 10001",
    ),
    (five_bar(joint_angles_rad=[[NAN, 0]]), "joint_angles_rad", "must be a finite number"),
    (five_bar(robot="ur5e"), "robot", "is not a known field"),
    # parallel mechanisms
    ({"analysis": "parallel_workspace"}, "mechanism", "is required"),
    (legs(mechanism="seven_pus"), "mechanism", 'one of "stewart_gough", "six_pus", "delta", "master_4dof", not'),
    (legs(mechanism={"library": "six_pus", "link_m": -1}), "mechanism.link_m", "must be a number above 0"),
    (legs(indices=""), "indices", f'{GROUPS}, not ""'),
    (legs(indices=[1]), "indices", f"{GROUPS}, not [1]"),
    (legs(kind="reachable"), "kind", 'must be "constant_orientation", "orientation", "dexterous" or'),
    (legs(kind="dexterous"), "orientations", 'must be given with kind "dexterous"'),
    (legs(kind="orientation", orientations={"tilt_deg": 3}), "position_m", "must be given"),
    (legs(position_m=[0, 0, 1]), "position_m", 'must be null with kind "constant_orientation"'),
    (legs(orientations={"tilt_deg": 3}), "orientations", 'must be null with kind "constant_orientation"'),
    (legs(kind="dexterous", orientations={"tilt_deg": 0}), "orientations.tilt_deg", "must be greater than 0"),
    (legs(kind="dexterous", orientations={}), "orientations", 'either "euler_xyz_deg" or "tilt_deg"'),
    (
        legs(kind="dexterous", orientations={"euler_xyz_deg": [[3, -3], [0, 0], [0, 0]]}),
        "orientations.euler_xyz_deg.0",
        "lower not above upper",
    ),
    (
        legs(kind="dexterous", orientations={"euler_xyz_deg": [[-9, 9]] * 3, "per_angle": 1000}),
        "orientations",
        "at most 1e+07 are tested",
    ),
    (
        legs(kind="dexterous", orientations={"tilt_deg": 9}, indices="kinematic"),
        "indices",
        "an index belongs to one pose",
    ),
    (legs(orientation={"position_m": [0, 0, 1]}), "orientation", "must not shift"),
    (legs(method="exact", voxel_size_m=0.1), "voxel_size_m", 'must not be given with the method "exact"'),
    (legs(method="solids", kind="dexterous", orientations={"tilt_deg": 9}), "method", 'with kind "dexterous"'),
    (legs(method="guess"), "method", 'must be "grid"'),
    (legs(method="exact", mechanism=SERIAL), "method", "has no known boundary"),
    (legs(method="solids", mechanism=SERIAL), "method", 'must be "grid" or "grid_by_subsystem" with legs of the type'),
    ({"analysis": "method_comparison", "mechanism": SERIAL}, "mechanism", 'must have no legs of the type "serial"'),
    (
        {"analysis": "master_slave_mapping", "master": {"mechanism": SERIAL}, "slave": {"points": [[0, 0, 0]]}},
        "master.mechanism",
        'must have no legs of the type "serial"',
    ),
    (legs(dexterous_threshold=0), "dexterous_threshold", "must be greater than 0"),
]


@pytest.mark.parametrize(("document", "field", "message"), MALFORMED, ids=range(len(MALFORMED)))
def test_malformed_document_names_field_value_and_what_is_allowed(document, field, message):
    with pytest.raises(DocumentError) as caught:
        parse_job(document)
    assert caught.value.problems[0][0] == field
    assert message in caught.value.problems[0][1]


def test_a_list_is_not_called_too_short_where_its_items_are_wrong():
    with pytest.raises(DocumentError) as caught:
        parse_job(side(bounds=[1]))
    assert [field for field, _ in caught.value.problems] == ["parameters.0.bounds"]


@pytest.mark.parametrize("document", [row[0] for row in MALFORMED if isinstance(row[0], dict) and row[1] != "document"])
def test_text_and_dict_give_the_same_problems(document):
    text = json.dumps(document)
    if "NaN" in text or "Infinity" in text:
        expected = [("document", "must hold finite numbers only")]
    else:
        with pytest.raises(DocumentError) as caught:
            parse_job(document)
        expected = caught.value.problems
    with pytest.raises(DocumentError) as from_text:
        parse_job(text)
    assert from_text.value.problems[0][0] == expected[0][0]
    assert from_text.value.problems[0][1].startswith(expected[0][1])
