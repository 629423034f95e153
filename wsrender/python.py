"""The analyses from Python: a function for each, whose parameters are the fields of its job document.

Written by ``python -m tests.python_door.write`` from the job classes; change those. `runs` makes each function run.
"""

# Defaults are frozen:
# ruff: noqa: B008

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from wsrender.analyses.design_optimization.job import (
    DesignParameter,
    DifferentialEvolution,
    EvaluationsInFile,
    GridSweep,
    LinearConstraint,
    Objective,
    ParetoSearch,
)
from wsrender.analyses.master_slave_mapping.job import Containment, MappingSearch
from wsrender.analyses.two_arm_placement.job import ArmOnBase, HandOver
from wsrender.documents.array_files import ArrayFile
from wsrender.documents.constraints import ArmsConstraints, Constraints
from wsrender.documents.document import Document
from wsrender.documents.environment import Environment
from wsrender.documents.kinetostatics import ForceFieldChoice
from wsrender.documents.mechanism import Delta, LegsMechanism, Master4DOF, SixPUS, StewartGough
from wsrender.documents.options import AlphaShapeSurface, IsoSurface
from wsrender.documents.orientations import EulerRanges, TiltRanges
from wsrender.documents.placements import PlacementSpace, TableEdge
from wsrender.documents.sampling import BoundaryBiased, Sobol
from wsrender.documents.several_robots import PlacementScan
from wsrender.documents.target_lists import Criterion, Target, TargetTable, TargetVolume
from wsrender.documents.transform import Transform
from wsrender.run.from_python import runs

if TYPE_CHECKING:
    from wsrender.mechanisms.five_bar import FiveBar
    from wsrender.results.result import Result
    from wsrender.run.from_python import RobotLike, SamplingLike, SourceLike
    from wsrender.run.steps import Progress


@runs("workspace")
def analyze(
    robot: RobotLike,
    sampling: SamplingLike | None = Sobol(count=16_777_216),
    indices: Literal["kinematic", "dynamic", "all"] | list[str] | tuple[str, ...] | str = "kinematic",
    task: Literal["linear", "angular", "full"] | Sequence[Literal["x", "y", "z", "rx", "ry", "rz"]] = "linear",
    *,
    base: str | None = None,
    tip: str | None = None,
    constraints: Constraints | Mapping[str, Any] | None = None,
    environment: Environment | Mapping[str, Any] | None = None,
    gravity_m_s2: Sequence[float] | np.ndarray | None = None,
    index_options: Mapping[str, Mapping[str, bool | int | float | Sequence[float] | np.ndarray]] = {},
    characteristic_length_m: float = 1.0,
    convention: Literal["standard", "table_1", "wsrender_code"] = "standard",
    joint_limit_penalty: float | None = None,
    torque_scaling: bool = False,
    inertia: Literal["kernel", "mujoco"] = "kernel",
    precision: Literal["float32", "float64"] = "float32",
    device: str = "auto",
    voxel_size_m: float | None = None,
    voxel_statistics: Sequence[Literal["count", "maximum", "mean", "minimum"]] | None = None,
    refined_volume: float | None = 0.01,
    best_sample: str | None = None,
    voxel_labels: bool = False,
    surfaces: Sequence[
        Literal["marching_cubes", "convex_hull"] | AlphaShapeSurface | IsoSurface | Mapping[str, Any]
    ] = (),
    keep_map: bool = False,
    map_columns: Sequence[Literal["configuration", "orientation"]] = (),
    max_samples: int = 10_000_000_000,
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
) -> Result:
    """Sample the joint space of a robot: distribution map, volume data and global indices.

    A robot that is a Python class is sampled by Sobol(2**16) by default.

    ``robot``: A Robot, what `load_robot` takes, an object with limits and forward_kinematics, or its part of a job
        document.
    ``sampling``: How the joint space is sampled; by default 2^24 Sobol samples, with a map 2^20.
    ``indices``: Local indices: "kinematic", "dynamic", "all", the name of an index, or a list of names.
    ``task``: Rows of the Jacobian, in base axes: "linear", "angular", "full", or a list from x y z rx ry rz.
    ``base``: Body, link or site at which the chain starts; None: the world.
    ``tip``: Site, body or link at the end of the chain; None: the site "tool", or else the only end there is.
    ``constraints``: Which configurations are admitted; None: all.
    ``environment``: What stands around, which the robot's shapes do not enter; None: nothing.
    ``gravity_m_s2``: Gravity in the world, whatever the model says [m/s²]; None: 9.81 along -z.
    ``index_options``: Options of the indices that have any: {index: {option: value}}.
    ``characteristic_length_m``: Length that divides the linear rows of a task that mixes linear and angular rows [m].
    ``convention``: Which definition of the indices: the standard one, Table I of the WSRender paper, or its program.
    ``joint_limit_penalty``: K of the joint-limit penalisation [1]; None or False: off; True: 10.
    ``torque_scaling``: Whether dynamic indices scale every joint by its largest effort [N m or N].
    ``inertia``: What evaluates the joint-space inertia: the kernels, or MuJoCo itself.
    ``precision``: Floating-point type of the kernels.
    ``device``: Where the kernels run: "auto" (a GPU if there is one), "cpu", "cuda" or "cuda:N".
    ``voxel_size_m``: Edge of a voxel [m]; None: what holds 48 samples on average, at least a hundredth of the cube root
        of the workspace's convex-hull volume.
    ``voxel_statistics``: What is kept per voxel, from count, maximum, mean, minimum; count always is. None: what means
        something for the indices, count and maximum of the six.
    ``refined_volume``: Half width of the headline's 95 % interval, relative to it [1]: of the volume that inverse
        kinematics finds reachable, of a planar workspace the area, of a line the length; under constraints of what it
        finds free, beside what they block; None: none is computed.
    ``best_sample``: An index of the job: of every voxel the number of the sample with its largest value is kept, of
        equal ones the smallest; `configuration_of` has its configuration. None: none is kept.
    ``voxel_labels``: Whether every voxel is labelled reachable, unreachable or undecided by inverse kinematics; under
        constraints reachable in configurations that they admit, or blocked by one where others are found.
    ``surfaces``: Meshes of the workspace, each with its volume: "marching_cubes" of the voxels, "convex_hull" and
        {"alpha_shape": α in metres} of the picture's subsample, {"iso_surface": index, "fraction": μ} of the voxels.
        Where none is asked for, that of the voxels is among the files all the same.
    ``keep_map``: Whether the distribution map, one row per sample, is kept.
    ``map_columns``: More columns of the map: "configuration" [rad or m] and "orientation" (quat_wxyz).
    ``max_samples``: Largest number of samples that the job may take.
    ``progress``: True shows a bar on work of more than a second; or a function (done, total, message).
    ``threads``: Threads of the CPU; None: all cores. They change no bit of the result.
    ``chunk_size``: Samples of a launch; None: by memory. It changes no bit of the result.

    Raises DocumentError, InputError, ModelError, ResourceError, NumericalError, NotConvergedError.
    """
    ...


@runs("indices_at")
def indices_at(
    robot: RobotLike,
    configurations: Sequence[Sequence[float] | np.ndarray]
    | Sequence[float]
    | np.ndarray
    | str
    | ArrayFile
    | Mapping[str, Any],
    *,
    base: str | None = None,
    tip: str | None = None,
    constraints: Constraints | Mapping[str, Any] | None = None,
    environment: Environment | Mapping[str, Any] | None = None,
    gravity_m_s2: Sequence[float] | np.ndarray | None = None,
    indices: Literal["kinematic", "dynamic", "all"] | list[str] | tuple[str, ...] | str = "kinematic",
    index_options: Mapping[str, Mapping[str, bool | int | float | Sequence[float] | np.ndarray]] = {},
    task: Literal["linear", "angular", "full"] | Sequence[Literal["x", "y", "z", "rx", "ry", "rz"]] = "linear",
    characteristic_length_m: float = 1.0,
    convention: Literal["standard", "table_1", "wsrender_code"] = "standard",
    joint_limit_penalty: float | None = None,
    torque_scaling: bool = False,
    inertia: Literal["kernel", "mujoco"] = "kernel",
    precision: Literal["float32", "float64"] = "float64",
    device: str = "auto",
    polytopes: Sequence[Literal["velocity", "force", "acceleration"]] = (),
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
) -> Result:
    """Local indices at given configurations.

    `evaluate_indices` is the quick form, which gives arrays.

    ``robot``: A Robot, what `load_robot` takes, an object with limits and forward_kinematics, or its part of a job
        document.
    ``configurations``: Rows of joint values [rad or m], (N, n), one per joint from base to tip, or a single one, (n,);
        or a .npy, Parquet or CSV file of them, with columns in that order or named as the joints.
    ``base``: Body, link or site at which the chain starts; None: the world.
    ``tip``: Site, body or link at the end of the chain; None: the site "tool", or else the only end there is.
    ``constraints``: Which configurations are admitted; None: all.
    ``environment``: What stands around, which the robot's shapes do not enter; None: nothing.
    ``gravity_m_s2``: Gravity in the world, whatever the model says [m/s²]; None: 9.81 along -z.
    ``indices``: Local indices: "kinematic", "dynamic", "all", the name of an index, or a list of names.
    ``index_options``: Options of the indices that have any: {index: {option: value}}.
    ``task``: Rows of the Jacobian, in base axes: "linear", "angular", "full", or a list from x y z rx ry rz.
    ``characteristic_length_m``: Length that divides the linear rows of a task that mixes linear and angular rows [m].
    ``convention``: Which definition of the indices: the standard one, Table I of the WSRender paper, or its program.
    ``joint_limit_penalty``: K of the joint-limit penalisation [1]; None or False: off; True: 10.
    ``torque_scaling``: Whether dynamic indices scale every joint by its largest effort [N m or N].
    ``inertia``: What evaluates the joint-space inertia: the kernels, or MuJoCo itself.
    ``precision``: Floating-point type of the kernels.
    ``device``: Where the kernels run: "auto" (a GPU if there is one), "cpu", "cuda" or "cuda:N".
    ``polytopes``: Polytopes of the tip at each of at most 20 configurations, as meshes: "velocity", "force",
        "acceleration"; in the linear rows of the task, and in float64.
    ``progress``: True shows a bar on work of more than a second; or a function (done, total, message).
    ``threads``: Threads of the CPU; None: all cores. They change no bit of the result.
    ``chunk_size``: Samples of a launch; None: by memory. It changes no bit of the result.

    Raises DocumentError, InputError, ModelError, ResourceError, NumericalError, NotConvergedError.
    """
    ...


@runs("reachability")
def reachability(
    robot: RobotLike,
    points_m: Sequence[Sequence[float] | np.ndarray] | np.ndarray | None = None,
    quats_wxyz: Sequence[Sequence[float] | np.ndarray] | np.ndarray | None = None,
    *,
    base: str | None = None,
    tip: str | None = None,
    constraints: Constraints | Mapping[str, Any] | None = None,
    environment: Environment | Mapping[str, Any] | None = None,
    gravity_m_s2: Sequence[float] | np.ndarray | None = None,
    position_tolerance_m: float = 1e-05,
    angle_tolerance_rad: float = 1e-05,
    seed: int = 0,
    precision: Literal["float32", "float64"] = "float64",
    device: str = "auto",
    characteristic_length_m: float | None = None,
    targets: str | Sequence[Target | Mapping[str, Any]] | TargetTable | TargetVolume | Mapping[str, Any] | None = None,
    criteria: Sequence[Criterion | Mapping[str, Any]] = (),
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
) -> Result:
    """Which of given targets a robot reaches within its joint limits, by inverse kinematics from many starts.

    Under constraints a target is reachable where a configuration is admitted, and blocked where all were rejected.

    `reachable` is the quick form, which gives labels and arrays.

    ``robot``: A Robot, what `load_robot` takes, an object with limits and forward_kinematics, or its part of a job
        document.
    ``points_m``: Positions of the targets in the world frame, rows of x, y, z, or a single one [m]; None: targets are
        given.
    ``quats_wxyz``: Orientations of the targets, a quaternion w, x, y, z for each point, or one for all; None: any
        orientation will do.
    ``base``: Body, link or site at which the chain starts; None: the world.
    ``tip``: Site, body or link at the end of the chain; None: the site "tool", or else the only end there is.
    ``constraints``: Which configurations are admitted; None: all.
    ``environment``: What stands around, which the robot's shapes do not enter; None: nothing.
    ``gravity_m_s2``: Gravity in the world, whatever the model says [m/s²]; None: 9.81 along -z.
    ``position_tolerance_m``: Largest distance to a target that counts as reached [m].
    ``angle_tolerance_rad``: Largest angle to a target's orientation that counts as reached [rad].
    ``seed``: Seed of all that is drawn, such as the starts of searches.
    ``precision``: Floating-point type of the kernels.
    ``device``: Where the kernels run: "auto" (a GPU if there is one), "cpu", "cuda" or "cuda:N".
    ``characteristic_length_m``: Length that makes an angle comparable to a distance while both shrink [m]; None: half
        the reach.
    ``targets``: Instead of points_m and quats_wxyz: targets with names, weights, free axes and tolerances of their own,
        one by one, or as a table in a file, {"path": "holes.csv"}; or a volume to cover by points at a step.
    ``criteria``: What the targets must fulfil for the result to pass.
    ``progress``: True shows a bar on work of more than a second; or a function (done, total, message).
    ``threads``: Threads of the CPU; None: all cores. They change no bit of the result.
    ``chunk_size``: Samples of a launch; None: by memory. It changes no bit of the result.

    Raises DocumentError, InputError, ModelError, ResourceError, NumericalError, NotConvergedError.
    """
    ...


@runs("postures")
def all_postures(
    robot: RobotLike,
    position_m: Sequence[Sequence[float] | np.ndarray] | np.ndarray | None = None,
    *,
    base: str | None = None,
    tip: str | None = None,
    constraints: Constraints | Mapping[str, Any] | None = None,
    environment: Environment | Mapping[str, Any] | None = None,
    gravity_m_s2: Sequence[float] | np.ndarray | None = None,
    indices: Literal["kinematic", "dynamic", "all"] | list[str] | tuple[str, ...] | str = (),
    index_options: Mapping[str, Mapping[str, bool | int | float | Sequence[float] | np.ndarray]] = {},
    task: Literal["linear", "angular", "full"] | Sequence[Literal["x", "y", "z", "rx", "ry", "rz"]] = "linear",
    characteristic_length_m: float = 1.0,
    convention: Literal["standard", "table_1", "wsrender_code"] = "standard",
    joint_limit_penalty: float | None = None,
    torque_scaling: bool = False,
    inertia: Literal["kernel", "mujoco"] = "kernel",
    precision: Literal["float32", "float64"] = "float64",
    device: str = "auto",
    quat_wxyz: Sequence[Sequence[float] | np.ndarray] | np.ndarray | None = None,
    free_axis: Literal["x", "y", "z"] | None = None,
    targets: str | Sequence[Target | Mapping[str, Any]] | TargetTable | TargetVolume | Mapping[str, Any] | None = None,
    windings: int = 1,
    starts: int = 512,
    curve_step: float = 0.05,
    aspects: bool = False,
    seed: int = 0,
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
) -> Result:
    """All configurations of given poses: every posture, windings counted apart.

    Arms with a closed form give all there are; of others those that a search finds; of arms with a joint more than the
    pose has freedoms, curves of them. Constraints and environment say of each posture whether it is free.

    `postures` is the quick form, which gives arrays.

    ``robot``: A Robot, what `load_robot` takes, an object with limits and forward_kinematics, or its part of a job
        document.
    ``position_m``: Positions of the tip in the world frame, rows of x, y, z, or a single one [m]; None: targets are
        given.
    ``base``: Body, link or site at which the chain starts; None: the world.
    ``tip``: Site, body or link at the end of the chain; None: the site "tool", or else the only end there is.
    ``constraints``: Which configurations are admitted; None: all.
    ``environment``: What stands around, which the robot's shapes do not enter; None: nothing.
    ``gravity_m_s2``: Gravity in the world, whatever the model says [m/s²]; None: 9.81 along -z.
    ``indices``: Local indices of every configuration: "kinematic", "dynamic", "all", or a list of names; empty: none.
    ``index_options``: Options of the indices that have any: {index: {option: value}}.
    ``task``: Rows of the Jacobian, in base axes: "linear", "angular", "full", or a list from x y z rx ry rz.
    ``characteristic_length_m``: Length that divides the linear rows of a task that mixes linear and angular rows [m].
    ``convention``: Which definition of the indices: the standard one, Table I of the WSRender paper, or its program.
    ``joint_limit_penalty``: K of the joint-limit penalisation [1]; None or False: off; True: 10.
    ``torque_scaling``: Whether dynamic indices scale every joint by its largest effort [N m or N].
    ``inertia``: What evaluates the joint-space inertia: the kernels, or MuJoCo itself.
    ``precision``: Floating-point type of the indices; postures are computed in double.
    ``device``: Where the kernels run: "auto" (a GPU if there is one), "cpu", "cuda" or "cuda:N".
    ``quat_wxyz``: Orientations, a quaternion w, x, y, z of unit length for each position, or one for all; None: any
        orientation will do.
    ``free_axis``: Axis of the tip about which it may turn as it likes; None: none.
    ``targets``: Instead of position_m and quat_wxyz: targets one by one, or as a table in a file, {"path":
        "holes.csv"}, or a volume to cover. All say an orientation or none does, and one free axis serves all; their
        weights and tolerances change nothing, for postures are those of the pose itself.
    ``windings``: How many configurations of a posture are listed that differ by whole turns of hinges; all are counted.
    ``starts``: Starts of the search for postures of a pose, where no closed form knows them all.
    ``curve_step``: Between points of self-motions: largest change of a joint, about [rad, reaches].
    ``aspects``: Whether it is told which listed configurations of a pose connect without a singular one on the way.
    ``seed``: Seed of the starts.
    ``progress``: True shows a bar on work of more than a second; or a function (done, total, message).
    ``threads``: Threads of the CPU; None: all cores. They change no bit of the result.
    ``chunk_size``: Samples of a launch; None: by memory. It changes no bit of the result.

    Raises DocumentError, InputError, ModelError, ResourceError, NumericalError, NotConvergedError.
    """
    ...


@runs("capability")
def capability(
    robot: RobotLike,
    *,
    base: str | None = None,
    tip: str | None = None,
    constraints: Constraints | Mapping[str, Any] | None = None,
    environment: Environment | Mapping[str, Any] | None = None,
    gravity_m_s2: Sequence[float] | np.ndarray | None = None,
    position_tolerance_m: float = 1e-05,
    angle_tolerance_rad: float = 0.001,
    seed: int = 0,
    precision: Literal["float32", "float64"] = "float64",
    device: str = "auto",
    voxel_size_m: float | None = None,
    directions: int = 100,
    approach_axis: Literal["x", "y", "z", "-x", "-y", "-z"] = "z",
    rolls: int | None = None,
    dexterous_threshold: float = 1.0,
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
) -> Result:
    """Per voxel, the share of approach directions from which its centre is reached, by inverse kinematics.

    Targets are the centres, with the directions. Where the arm's positions fill no volume, as in a plane, the reachable
    point nearest to the centre stands for it. Under constraints a direction is reached where they admit a
    configuration, and blocked where they reject all.

    ``robot``: A Robot, what `load_robot` takes, an object with limits and forward_kinematics, or its part of a job
        document.
    ``base``: Body, link or site at which the chain starts; None: the world.
    ``tip``: Site, body or link at the end of the chain; None: the site "tool", or else the only end there is.
    ``constraints``: Which configurations are admitted; None: all.
    ``environment``: What stands around, which the robot's shapes do not enter; None: nothing.
    ``gravity_m_s2``: Gravity in the world, whatever the model says [m/s²]; None: 9.81 along -z.
    ``position_tolerance_m``: Largest distance to a target that counts as reached [m].
    ``angle_tolerance_rad``: Largest angle to a direction that counts as reached [rad].
    ``seed``: Seed of all that is drawn, such as the starts of searches.
    ``precision``: Floating-point type of the kernels.
    ``device``: Where the kernels run: "auto" (a GPU if there is one), "cpu", "cuda" or "cuda:N".
    ``voxel_size_m``: Edge of a voxel [m]; None: a twentieth of the cube root of the workspace's convex-hull volume.
    ``directions``: Number of approach directions, spread evenly over the sphere.
    ``approach_axis``: Axis of the tip frame that points along the direction; the turn about it is free.
    ``rolls``: In how many turns about every direction, spread evenly, postures are counted, of arms with a closed form;
        None: they are not.
    ``dexterous_threshold``: Least reachability index of the dexterous workspace [1].
    ``progress``: True shows a bar on work of more than a second; or a function (done, total, message).
    ``threads``: Threads of the CPU; None: all cores. They change no bit of the result.
    ``chunk_size``: Samples of a launch; None: by memory. It changes no bit of the result.

    Raises DocumentError, InputError, ModelError, ResourceError, NumericalError, NotConvergedError.
    """
    ...


@runs("shared_workspace")
def shared_workspace(
    robots: Sequence[RobotLike],
    sampling: SamplingLike | Sequence[SamplingLike | None] | None = None,
    *,
    constraints: ArmsConstraints | Mapping[str, Any] | None = None,
    environment: Environment | Mapping[str, Any] | None = None,
    gravity_m_s2: Sequence[float] | np.ndarray | None = None,
    indices: Literal["kinematic", "dynamic", "all"] | list[str] | tuple[str, ...] | str = "kinematic",
    index_options: Mapping[str, Mapping[str, bool | int | float | Sequence[float] | np.ndarray]] = {},
    task: Literal["linear", "angular", "full"] | Sequence[Literal["x", "y", "z", "rx", "ry", "rz"]] = "linear",
    characteristic_length_m: float = 1.0,
    convention: Literal["standard", "table_1", "wsrender_code"] = "standard",
    joint_limit_penalty: float | None = None,
    torque_scaling: bool = False,
    inertia: Literal["kernel", "mujoco"] = "kernel",
    precision: Literal["float32", "float64"] = "float32",
    device: str = "auto",
    voxel_size_m: float | None = None,
    max_samples: int = 10_000_000_000,
    refined_volume: float | None = 0.01,
    scan: PlacementScan | Mapping[str, Any] | None = None,
    names: Sequence[str | None] | None = None,
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
) -> Result:
    """What several robots reach together: union, shared volume, volume by number of robots, shared quality.

    ``robots``: The robots, placed by `load_robot(…, placement=…)`, each as one robot elsewhere, or its part of a job
        document; the arms of one model are loaded with other base and tip.
    ``sampling``: How joint spaces are sampled, one for all robots or a list of one for each; None: 2^20 Sobol samples,
        of a robot that is a Python class 2^16.
    ``constraints``: Which configurations of every robot are admitted, and in which two of them may be together; None:
        all.
    ``environment``: What stands around, which the robot's shapes do not enter; None: nothing.
    ``gravity_m_s2``: Gravity in the world, whatever the model says [m/s²]; None: 9.81 along -z.
    ``indices``: Local indices: "kinematic", "dynamic", "all", the name of an index, or a list of names.
    ``index_options``: Options of the indices that have any: {index: {option: value}}.
    ``task``: Rows of the Jacobian, in base axes: "linear", "angular", "full", or a list from x y z rx ry rz.
    ``characteristic_length_m``: Length that divides the linear rows of a task that mixes linear and angular rows [m].
    ``convention``: Which definition of the indices: the standard one, Table I of the WSRender paper, or its program.
    ``joint_limit_penalty``: K of the joint-limit penalisation [1]; None or False: off; True: 10.
    ``torque_scaling``: Whether dynamic indices scale every joint by its largest effort [N m or N].
    ``inertia``: What evaluates the joint-space inertia: the kernels, or MuJoCo itself.
    ``precision``: Floating-point type of the kernels.
    ``device``: Where the kernels run: "auto" (a GPU if there is one), "cpu", "cuda" or "cuda:N".
    ``voxel_size_m``: Edge of a voxel [m]; None: the smallest of those that the robots would have by themselves, but not
        so small that one of them is left with holes.
    ``max_samples``: Largest number of samples that each robot may take.
    ``refined_volume``: Relative tolerance of the refined volumes that any and that at least two robots reach [1], at
        every value of a scan too: by inverse kinematics, each with a 95 % interval; under constraints of what is free,
        beside what they block. None: none.
    ``scan``: A coordinate of a robot's placement to vary; gives shared volume against it. None: none.
    ``names``: What the result calls the robots; None: as their models.
    ``progress``: True shows a bar on work of more than a second; or a function (done, total, message).
    ``threads``: Threads of the CPU; None: all cores. They change no bit of the result.
    ``chunk_size``: Samples of a launch; None: by memory. It changes no bit of the result.

    Raises DocumentError, InputError, ModelError, ResourceError, NumericalError, NotConvergedError.
    """
    ...


@runs("robot_comparison")
def robot_comparison(
    robots: Sequence[RobotLike],
    sampling: SamplingLike | Sequence[SamplingLike | None] | None = None,
    *,
    constraints: Constraints | Mapping[str, Any] | None = None,
    environment: Environment | Mapping[str, Any] | None = None,
    gravity_m_s2: Sequence[float] | np.ndarray | None = None,
    indices: Literal["kinematic", "dynamic", "all"] | list[str] | tuple[str, ...] | str = "kinematic",
    index_options: Mapping[str, Mapping[str, bool | int | float | Sequence[float] | np.ndarray]] = {},
    task: Literal["linear", "angular", "full"] | Sequence[Literal["x", "y", "z", "rx", "ry", "rz"]] = "linear",
    characteristic_length_m: float = 1.0,
    convention: Literal["standard", "table_1", "wsrender_code"] = "standard",
    joint_limit_penalty: float | None = None,
    torque_scaling: bool = False,
    inertia: Literal["kernel", "mujoco"] = "kernel",
    precision: Literal["float32", "float64"] = "float32",
    device: str = "auto",
    voxel_size_m: float | None = None,
    max_samples: int = 10_000_000_000,
    refined_volume: float | None = 0.01,
    names: Sequence[str | None] | None = None,
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
) -> Result:
    """Several robots, or placements of one, side by side: same lattice, same scales, a table of differences.

    ``robots``: The robots, placed by `load_robot(…, placement=…)`, each as one robot elsewhere, or its part of a job
        document; the arms of one model are loaded with other base and tip.
    ``sampling``: How joint spaces are sampled, one for all robots or a list of one for each; None: 2^20 Sobol samples,
        of a robot that is a Python class 2^16.
    ``constraints``: Which configurations are admitted; None: all.
    ``environment``: What stands around, which the robot's shapes do not enter; None: nothing.
    ``gravity_m_s2``: Gravity in the world, whatever the model says [m/s²]; None: 9.81 along -z.
    ``indices``: Local indices: "kinematic", "dynamic", "all", the name of an index, or a list of names.
    ``index_options``: Options of the indices that have any: {index: {option: value}}.
    ``task``: Rows of the Jacobian, in base axes: "linear", "angular", "full", or a list from x y z rx ry rz.
    ``characteristic_length_m``: Length that divides the linear rows of a task that mixes linear and angular rows [m].
    ``convention``: Which definition of the indices: the standard one, Table I of the WSRender paper, or its program.
    ``joint_limit_penalty``: K of the joint-limit penalisation [1]; None or False: off; True: 10.
    ``torque_scaling``: Whether dynamic indices scale every joint by its largest effort [N m or N].
    ``inertia``: What evaluates the joint-space inertia: the kernels, or MuJoCo itself.
    ``precision``: Floating-point type of the kernels.
    ``device``: Where the kernels run: "auto" (a GPU if there is one), "cpu", "cuda" or "cuda:N".
    ``voxel_size_m``: Edge of a voxel [m]; None: the smallest of those that the robots would have by themselves, but not
        so small that one of them is left with holes.
    ``max_samples``: Largest number of samples that each robot may take.
    ``refined_volume``: Half width of the 95 % interval of each robot's volume, area or length by inverse kinematics,
        relative to it [1]; None: none is computed.
    ``names``: What the result calls the robots; None: as their models.
    ``progress``: True shows a bar on work of more than a second; or a function (done, total, message).
    ``threads``: Threads of the CPU; None: all cores. They change no bit of the result.
    ``chunk_size``: Samples of a launch; None: by memory. It changes no bit of the result.

    Raises DocumentError, InputError, ModelError, ResourceError, NumericalError, NotConvergedError.
    """
    ...


@runs("base_placement")
def base_placement(
    robot: RobotLike | None = None,
    points_m: Sequence[Sequence[float] | np.ndarray] | np.ndarray | None = None,
    quats_wxyz: Sequence[Sequence[float] | np.ndarray] | np.ndarray | None = None,
    *,
    base: str | None = None,
    tip: str | None = None,
    constraints: Constraints | Mapping[str, Any] | None = None,
    environment: Environment | Mapping[str, Any] | None = None,
    gravity_m_s2: Sequence[float] | np.ndarray | None = None,
    position_tolerance_m: float = 1e-05,
    angle_tolerance_rad: float = 1e-05,
    seed: int = 0,
    precision: Literal["float32", "float64"] = "float64",
    device: str = "auto",
    characteristic_length_m: float | None = None,
    targets: str | Sequence[Target | Mapping[str, Any]] | TargetTable | TargetVolume | Mapping[str, Any] | None = None,
    robots: Sequence[RobotLike] | None = None,
    weights: Sequence[float] | np.ndarray | None = None,
    over: PlacementSpace | Mapping[str, Any],
    mounting: Literal["floor", "wall", "ceiling"] | TableEdge | Mapping[str, Any] = "floor",
    index: str | list[str] | tuple[str, ...] | None = None,
    index_options: Mapping[str, Mapping[str, bool | int | float | Sequence[float] | np.ndarray]] = {},
    pareto: bool = False,
    refine: bool = True,
    use_symmetry: bool = True,
    criteria: Sequence[Criterion | Mapping[str, Any]] = (),
    names: Sequence[str | None] | None = None,
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
) -> Result:
    """Where the base of a robot stands best: which targets it serves from every placement of a space.

    A target is served from a placement where the robot reaches it, under constraints with a configuration that they
    admit. The best placement serves targets of the largest weight; of several it is the one whose least ``index`` over
    the targets is best, or without one that which stands farthest, in steps, from those that serve less. Targets,
    constraints and environment stand in the world. Of several ``robots`` each is placed by itself, and the result says
    which does best where.

    ``robot``: A Robot, what `load_robot` takes, an object with limits and forward_kinematics, or its part of a job
        document; None: robots are given.
    ``points_m``: Positions of the targets in the world frame, rows of x, y, z, or a single one [m]; None: targets are
        given.
    ``quats_wxyz``: Orientations of the targets, a quaternion w, x, y, z for each point, or one for all; None: any
        orientation will do.
    ``base``: Body, link or site at which the chain starts; None: the world.
    ``tip``: Site, body or link at the end of the chain; None: the site "tool", or else the only end there is.
    ``constraints``: Which configurations are admitted; None: all.
    ``environment``: What stands around, which the robot's shapes do not enter; None: nothing.
    ``gravity_m_s2``: Gravity in the world, whatever the model says [m/s²]; None: 9.81 along -z.
    ``position_tolerance_m``: Largest distance to a target that counts as reached [m].
    ``angle_tolerance_rad``: Largest angle to a target's orientation that counts as reached [rad].
    ``seed``: Seed of all that is drawn, such as the starts of searches.
    ``precision``: Floating-point type of the kernels.
    ``device``: Where the kernels run: "auto" (a GPU if there is one), "cpu", "cuda" or "cuda:N".
    ``characteristic_length_m``: Length that makes an angle comparable to a distance while both shrink [m]; None: half
        the reach.
    ``targets``: Instead of points_m and quats_wxyz: targets with names, weights, free axes and tolerances of their own,
        one by one, or as a table in a file, {"path": "holes.csv"}; or a volume to cover by points at a step.
    ``robots``: The robots, placed by `load_robot(…, placement=…)`, each as one robot elsewhere, or its part of a job
        document; the arms of one model are loaded with other base and tip; None: robot is given.
    ``weights``: What each of points_m counts; None: 1 each.
    ``over``: Where the base may stand. ``robot.placement`` is how it stands in the frame that is placed.
    ``mounting``: How the base is mounted in the frame that is placed, before ``robot.placement``: its z is that frame's
        z on the floor, its x on a wall, its -z under a ceiling; on the edge of a table as on the floor, and only near
        that edge.
    ``index``: Local index, as ``indices_at`` has them, whose least value over the targets that are served, each at its
        best posture, tells placements apart that serve as much; None: none. Of two, the objectives of ``pareto``, the
        first does.
    ``index_options``: Options of the index, if it has any: {index: {option: value}}.
    ``pareto``: Whether the Pareto set of two objectives is found, the weight served and the least ``index``: the
        placements that no other beats in one of them without being worse in the other. Of two indices these are the
        objectives, each at its own best postures, among the placements that serve the largest weight.
    ``refine``: Whether the best placement is refined between the cells, and its tolerance found.
    ``use_symmetry``: Whether targets are decided for one yaw alone where others change nothing but the first joint's
        value.
    ``criteria``: What the targets must fulfil from the best placement for the result to pass.
    ``names``: What the result calls the robots; None: as their models.
    ``progress``: True shows a bar on work of more than a second; or a function (done, total, message).
    ``threads``: Threads of the CPU; None: all cores. They change no bit of the result.
    ``chunk_size``: Samples of a launch; None: by memory. It changes no bit of the result.

    Raises DocumentError, InputError, ModelError, ResourceError, NumericalError, NotConvergedError.
    """
    ...


@runs("inverse_reachability")
def inverse_reachability(
    robot: RobotLike,
    target: Target | Mapping[str, Any],
    over: PlacementSpace | Mapping[str, Any],
    *,
    base: str | None = None,
    tip: str | None = None,
    constraints: Constraints | Mapping[str, Any] | None = None,
    environment: Environment | Mapping[str, Any] | None = None,
    gravity_m_s2: Sequence[float] | np.ndarray | None = None,
    position_tolerance_m: float = 1e-05,
    angle_tolerance_rad: float = 1e-05,
    seed: int = 0,
    precision: Literal["float32", "float64"] = "float64",
    device: str = "auto",
    characteristic_length_m: float | None = None,
    object_frame: Transform | Mapping[str, Any] | None = None,
    mounting: Literal["floor", "wall", "ceiling"] = "floor",
    use_symmetry: bool = True,
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
) -> Result:
    """From which base poses of a space a robot reaches one target: a map over x and y, or a volume over x, y and z.

    What ``base_placement`` decides of one target, kept base by base. Target, constraints and environment stand in the
    world.

    ``robot``: A Robot, what `load_robot` takes, an object with limits and forward_kinematics, or its part of a job
        document.
    ``target``: The pose of the tip, or point, that is to be reached.
    ``over``: Where the base may stand. ``robot.placement`` is how it stands in the frame that is placed. Of ranges in
        x, y and z the cells are voxels: of one step, which divides their lower ends.
    ``base``: Body, link or site at which the chain starts; None: the world.
    ``tip``: Site, body or link at the end of the chain; None: the site "tool", or else the only end there is.
    ``constraints``: Which configurations are admitted; None: all.
    ``environment``: What stands around, which the robot's shapes do not enter; None: nothing.
    ``gravity_m_s2``: Gravity in the world, whatever the model says [m/s²]; None: 9.81 along -z.
    ``position_tolerance_m``: Largest distance to a target that counts as reached [m].
    ``angle_tolerance_rad``: Largest angle to a target's orientation that counts as reached [rad].
    ``seed``: Seed of all that is drawn, such as the starts of searches.
    ``precision``: Floating-point type of the kernels.
    ``device``: Where the kernels run: "auto" (a GPU if there is one), "cpu", "cuda" or "cuda:N".
    ``characteristic_length_m``: Length that makes an angle comparable to a distance while both shrink [m]; None: half
        the reach.
    ``object_frame``: Frame in the world in which the target is given, such as that of a part; None: the world itself.
    ``mounting``: How the base is mounted in the frame that is placed, before ``robot.placement``: its z is that frame's
        z on the floor, its x on a wall, its -z under a ceiling.
    ``use_symmetry``: Whether one yaw alone is decided where others change nothing but the first joint's value.
    ``progress``: True shows a bar on work of more than a second; or a function (done, total, message).
    ``threads``: Threads of the CPU; None: all cores. They change no bit of the result.
    ``chunk_size``: Samples of a launch; None: by memory. It changes no bit of the result.

    Raises DocumentError, InputError, ModelError, ResourceError, NumericalError, NotConvergedError.
    """
    ...


@runs("two_arm_placement")
def two_arm_placement(
    points_m: Sequence[Sequence[float] | np.ndarray] | np.ndarray | None = None,
    quats_wxyz: Sequence[Sequence[float] | np.ndarray] | np.ndarray | None = None,
    *,
    constraints: ArmsConstraints | Mapping[str, Any] | None = None,
    environment: Environment | Mapping[str, Any] | None = None,
    gravity_m_s2: Sequence[float] | np.ndarray | None = None,
    position_tolerance_m: float = 1e-05,
    angle_tolerance_rad: float = 1e-05,
    seed: int = 0,
    precision: Literal["float32", "float64"] = "float64",
    device: str = "auto",
    characteristic_length_m: float | None = None,
    targets: str | Sequence[Target | Mapping[str, Any]] | TargetTable | TargetVolume | Mapping[str, Any] | None = None,
    first: ArmOnBase | Mapping[str, Any],
    second: ArmOnBase | Mapping[str, Any],
    hand_over: HandOver | Mapping[str, Any] | None = None,
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
) -> Result:
    """Which of two arms serves which targets, and where they stand so that one or the other serves most of them.

    Either base stands in one place or anywhere in a space. Of pairs of placements that serve the same weight that is
    best of which both arms serve most. At the targets the arms are taken to work in turn: nothing is said of collisions
    of one with the other. With ``hand_over`` pairs of placements from which there is a pose that both can hold at once
    come before those without, and of pairs that serve the same weight that is best which offers most of these poses.
    Targets, constraints, which either arm must satisfy, and environment stand in the world.

    ``points_m``: Positions of the targets in the world frame, rows of x, y, z, or a single one [m]; None: targets are
        given.
    ``quats_wxyz``: Orientations of the targets, a quaternion w, x, y, z for each point, or one for all; None: any
        orientation will do.
    ``constraints``: Which configurations of both arms are admitted, and which of a hand-over's they may be in together;
        None: all.
    ``environment``: What stands around, which the robot's shapes do not enter; None: nothing.
    ``gravity_m_s2``: Gravity in the world, whatever the model says [m/s²]; None: 9.81 along -z.
    ``position_tolerance_m``: Largest distance to a target that counts as reached [m].
    ``angle_tolerance_rad``: Largest angle to a target's orientation that counts as reached [rad].
    ``seed``: Seed of all that is drawn, such as the starts of searches.
    ``precision``: Floating-point type of the kernels.
    ``device``: Where the kernels run: "auto" (a GPU if there is one), "cpu", "cuda" or "cuda:N".
    ``characteristic_length_m``: Length that makes an angle comparable to a distance while both shrink [m]; None: half
        the reach.
    ``targets``: Instead of points_m and quats_wxyz: targets with names, weights, free axes and tolerances of their own,
        one by one, or as a table in a file, {"path": "holes.csv"}; or a volume to cover by points at a step.
    ``first``: One arm, and where it may stand.
    ``second``: The other.
    ``hand_over``: Poses at which the arms may hand something over; None: none is asked for.
    ``progress``: True shows a bar on work of more than a second; or a function (done, total, message).
    ``threads``: Threads of the CPU; None: all cores. They change no bit of the result.
    ``chunk_size``: Samples of a launch; None: by memory. It changes no bit of the result.

    Raises DocumentError, InputError, ModelError, ResourceError, NumericalError, NotConvergedError.
    """
    ...


@runs("collaborative_volume")
def collaborative_volume(
    left: SourceLike,
    right: SourceLike,
    *,
    constraints: ArmsConstraints | Mapping[str, Any] | None = None,
    environment: Environment | Mapping[str, Any] | None = None,
    gravity_m_s2: Sequence[float] | np.ndarray | None = None,
    samples: int = 200_000,
    seeds: int = 10,
    seed: int = 0,
    cells: Sequence[int] | np.ndarray = (20, 20, 20),
    refinements: int = 3,
    neighbours: Literal[4, 6] = 4,
    refined_volume: float | None = None,
    max_samples: int = 10_000_000_000,
    device: str = "auto",
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
) -> Result:
    """Volume that two arms reach together, by the body-elemental algorithm, and its true value beside it.

    ``left``: The arm whose smallest x begins the box: a Robot, what `load_robot` takes, points (N, 3) [m], or the part
        of a job document.
    ``right``: The arm whose largest x ends the box: a Robot, what `load_robot` takes, points (N, 3) [m], or the part of
        a job document.
    ``constraints``: Which configurations of both robots are admitted, and which of the true volume's they may be in
        together; None: all.
    ``environment``: What stands around, which the robot's shapes do not enter; None: nothing.
    ``gravity_m_s2``: Gravity in the world, whatever the model says [m/s²]; None: 9.81 along -z.
    ``samples``: Random configurations of each robot.
    ``seeds``: Runs, with the seeds seed, seed + 1, …; points give the same in each, so that one is enough for two sets.
    ``seed``: Seed of the first run.
    ``cells``: Cells of the box along x, y, z.
    ``refinements``: Refinements of the boundary cells, d: gives V₀ … V_d.
    ``neighbours``: Neighbours that make a boundary cell: 4 in its layer of constant z, or 6.
    ``refined_volume``: Relative tolerance of the true volume that both robots reach [1], by inverse kinematics: 0.01 if
        it is not given for two robots; under constraints of what is free. None: none.
    ``max_samples``: Largest number of configurations of all runs together.
    ``device``: Where the kernels run: "auto" (a GPU if there is one), "cpu", "cuda" or "cuda:N".
    ``progress``: True shows a bar on work of more than a second; or a function (done, total, message).
    ``threads``: Threads of the CPU; None: all cores. They change no bit of the result.
    ``chunk_size``: Samples of a launch; None: by memory. It changes no bit of the result.

    Raises DocumentError, InputError, ModelError, ResourceError, NumericalError, NotConvergedError.
    """
    ...


@runs("master_slave_mapping")
def master_slave_mapping(
    master: SourceLike,
    slave: SourceLike,
    *,
    scale: float | Sequence[float] | np.ndarray = (1.0, 1.0, 1.0),
    rotation: Transform | Mapping[str, Any] | None = None,
    offsets_m: Sequence[Sequence[float] | np.ndarray] | np.ndarray = ((0.0, 0.0, 0.0),),
    containment: Containment | Mapping[str, Any] = Containment(),
    search: MappingSearch | Mapping[str, Any] | None = None,
    device: str = "auto",
    sampling: SamplingLike | None = None,
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
) -> Result:
    """Whether a slave's workspace, scaled, turned and shifted, lies in its master's, and the largest that does.

    ``master``: The robot that is moved by hand: a Robot, what `load_robot` takes, points (N, 3) [m], or the part of a
        job document.
    ``slave``: The robot that follows: a Robot, what `load_robot` takes, points (N, 3) [m], or the part of a job
        document.
    ``scale``: S: scales along x, y, z of the master's world; one number stands for three.
    ``rotation``: R: rotation of the slave's points (its position_m must be 0); None: none.
    ``offsets_m``: Offsets [m], a list or a single one, that are compared: slave' = S R slave + offset.
    ``containment``: What decides whether a point lies in a workspace.
    ``search``: Search of the largest scale, and optionally offset; None: the mapping is only tested.
    ``device``: Where the kernels run: "auto" (a GPU if there is one), "cpu", "cuda" or "cuda:N".
    ``sampling``: How both joint spaces are sampled; None: 20,000 Sobol samples.
    ``progress``: True shows a bar on work of more than a second; or a function (done, total, message).
    ``threads``: Threads of the CPU; None: all cores. They change no bit of the result.
    ``chunk_size``: Samples of a launch; None: by memory. It changes no bit of the result.

    Raises DocumentError, InputError, ModelError, ResourceError, NumericalError, NotConvergedError.
    """
    ...


@runs("kinetostatic_field")
def kinetostatic_field(
    robot: RobotLike,
    sampling: SamplingLike | None = Sobol(count=100_000),
    *,
    base: str | None = None,
    tip: str | None = None,
    constraints: Constraints | Mapping[str, Any] | None = None,
    environment: Environment | Mapping[str, Any] | None = None,
    gravity_m_s2: Sequence[float] | np.ndarray | None = None,
    field: ForceFieldChoice | Mapping[str, Any] = ForceFieldChoice(),
    voxel_size_m: float | None = None,
    device: str = "auto",
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
) -> Result:
    """The force field of a robot's limits and conditioning over its workspace, as a volume of vectors.

    Under constraints a voxel's forces are those of admitted configurations; the passivity is that of the field itself,
    wherever a person leads it. The obstacles of the field push the tip, and reject nothing unless they stand in the
    ``environment`` too.

    `force_field` gives the forces of single configurations.

    ``robot``: A Robot, what `load_robot` takes, an object with limits and forward_kinematics, or its part of a job
        document.
    ``sampling``: Configurations at which the field is evaluated; a voxel holds the mean over those that reach it.
    ``base``: Body, link or site at which the chain starts; None: the world.
    ``tip``: Site, body or link at the end of the chain; None: the site "tool", or else the only end there is.
    ``constraints``: Which configurations are admitted; None: all.
    ``environment``: What stands around, which the robot's shapes do not enter; None: nothing.
    ``gravity_m_s2``: Gravity in the world, whatever the model says [m/s²]; None: 9.81 along -z.
    ``field``: Which forces act.
    ``voxel_size_m``: Edge of a voxel [m]; None: a twenty-fifth of the cube root of the workspace's convex-hull volume.
    ``device``: Where kernels run that find the workspace's boundary: "auto", "cpu", "cuda" or "cuda:N".
    ``progress``: True shows a bar on work of more than a second; or a function (done, total, message).
    ``threads``: Threads of the CPU; None: all cores. They change no bit of the result.
    ``chunk_size``: Samples of a launch; None: by memory. It changes no bit of the result.

    Raises DocumentError, InputError, ModelError, ResourceError, NumericalError, NotConvergedError.
    """
    ...


@runs("parallel_workspace")
def parallel_workspace(
    mechanism: str | StewartGough | SixPUS | Master4DOF | Delta | LegsMechanism | Mapping[str, Any],
    *,
    kind: Literal["constant_orientation", "orientation", "dexterous", "total_orientation"] = "constant_orientation",
    orientation: Transform | Mapping[str, Any] | None = None,
    position_m: Sequence[float] | np.ndarray | None = None,
    orientations: EulerRanges | TiltRanges | Mapping[str, Any] | None = None,
    method: Literal["grid", "grid_by_subsystem", "exact", "solids"] = "grid_by_subsystem",
    voxel_size_m: float | None = None,
    indices: Literal["kinematic", "dynamic", "all"] | list[str] | tuple[str, ...] | str = (),
    index_options: Mapping[str, Mapping[str, bool | int | float | Sequence[float] | np.ndarray]] = {},
    task: Literal["linear", "angular", "full"] | Sequence[Literal["x", "y", "z", "rx", "ry", "rz"]] | None = None,
    characteristic_length_m: float = 1.0,
    dexterous_threshold: float = 1.0,
    refined_volume: float | None = 0.01,
    seed: int = 0,
    max_poses: int = 10_000_000_000,
    precision: Literal["float32", "float64"] = "float64",
    device: str = "auto",
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
) -> Result:
    """Workspace of a parallel mechanism: the poses for which every leg has a solution within its limits.

    ``constant_orientation``: positions at one orientation; ``orientation``: orientations at one position;
    ``total_orientation``: positions at which all of a set of orientations are reached (Merlet 2006); ``dexterous``: the
    share of a set of orientations that is reached at each position.

    ``mechanism``: The mechanism; a string is a name of the library: stewart_gough, six_pus, delta, master_4dof.
    ``kind``: Which workspace.
    ``orientation``: Orientation of the platform in the base frame, without position_m; None: none. Of
        constant_orientation only.
    ``position_m``: Position of the platform in the world [m]. Of the kind orientation, which needs it.
    ``orientations``: Orientations in the base frame: {"euler_xyz_deg": …} or {"tilt_deg": …}. All kinds but
        constant_orientation.
    ``method``: "grid" asks every leg at every point, "grid_by_subsystem" the next subsystem of legs where the last ones
        reach: the same voxels, sooner. "exact" (faces, volume, topology) and "solids" (boolean operations on meshes)
        are for the constant orientation of mechanisms whose workspace only spheres bound: UPS legs, pairs of PUS legs.
    ``voxel_size_m``: Edge of a voxel [m]; None: a hundredth of the cube root of the workspace's volume, estimated.
    ``indices``: Local indices at the voxels' centres: "kinematic" or a list of names; []: none. Of
        constant_orientation. With serial joints the largest over their values, from the Jacobian of all joints.
    ``index_options``: Options of the indices that have any: {index: {option: value}}.
    ``task``: Rows of the Jacobian, in base axes: "linear", "angular", "full" or a list; None: "full", "linear" of a
        delta.
    ``characteristic_length_m``: Length that divides the linear rows where a task has angular ones too [m].
    ``dexterous_threshold``: Least share of the orientations that counts as dexterous [1].
    ``refined_volume``: Half width of the 95 % interval of the volume, relative to it [1], from random points; None: not
        computed. The default is 0.01 of a constant orientation by the methods "grid" and "grid_by_subsystem", else
        None. Serial joints are searched over all their values; the interval covers the steps of sets of orientations.
        In a plane it is that of the area, on a line of the length.
    ``seed``: Seed of the random points.
    ``max_poses``: Largest number of poses that the job may test.
    ``precision``: Floating-point type of the kernels.
    ``device``: Where the kernels run: "auto" (a GPU if there is one), "cpu", "cuda" or "cuda:N".
    ``progress``: True shows a bar on work of more than a second; or a function (done, total, message).
    ``threads``: Threads of the CPU; None: all cores. They change no bit of the result.
    ``chunk_size``: Samples of a launch; None: by memory. It changes no bit of the result.

    Raises DocumentError, InputError, ModelError, ResourceError, NumericalError, NotConvergedError.
    """
    ...


@runs("five_bar")
def five_bar(
    mechanism: FiveBar,
    *,
    working_modes: Sequence[Literal["++", "+-", "-+", "--"]] = ("++", "+-", "-+", "--"),
    voxel_size_m: float | None = None,
    joint_steps: int = 180,
    levels: Sequence[float] | np.ndarray = (1.25, 1.5, 2.0, 3.0, 5.0, 10.0),
    points_m: Sequence[Sequence[float] | np.ndarray] | np.ndarray | ArrayFile | Mapping[str, Any] = (),
    joint_angles_rad: Sequence[Sequence[float] | np.ndarray] | np.ndarray | ArrayFile | Mapping[str, Any] = (),
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
) -> Result:
    """Workspace, conditioning, singularities and aspects of a planar five-bar with two actuated base joints.

    ``mechanism``: The five-bar, with its lengths and limits.
    ``working_modes``: Signs of sin(θ3 − θ1) and sin(θ4 − θ2).
    ``voxel_size_m``: Edge of the cells of the Cartesian maps [m]; None: a 250th of the workspace's box.
    ``joint_steps``: Cells of the joint-space maps in a turn of an actuated joint.
    ``levels``: Condition numbers whose iso-curves are traced.
    ``points_m``: Points [x, y] whose postures in every working mode are given, with their indices, at most 10,000 [m];
        or a file of them, {"path": "points.csv"}.
    ``joint_angles_rad``: Pairs [θ1, θ2] whose postures in both assembly modes are given, with their indices, at most
        10,000 [rad]; or a file of them.
    ``progress``: True shows a bar on work of more than a second; or a function (done, total, message).
    ``threads``: Threads of the CPU; None: all cores. They change no bit of the result.
    ``chunk_size``: Samples of a launch; None: by memory. It changes no bit of the result.

    Raises DocumentError, InputError, ModelError, ResourceError, NumericalError, NotConvergedError.
    """
    ...


@runs("planar_boundary")
def planar_boundary(
    robot: RobotLike,
    sampling: SamplingLike | None = BoundaryBiased(count=400_000),
    *,
    base: str | None = None,
    tip: str | None = None,
    cells: int | None = None,
    line_tolerance_m2: float | None = None,
    arc_tolerance_m4: float | None = None,
    points_m: Sequence[Sequence[float] | np.ndarray] | np.ndarray | ArrayFile | Mapping[str, Any] = (),
    device: str = "auto",
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
) -> Result:
    """The boundary of the positions that a planar arm reaches: exact, as lines and arcs, and estimated from samples.

    The arm's end effector must stay in a plane: joints turn about its normal or slide within it, or are locked.

    ``robot``: A Robot, what `load_robot` takes, an object with limits and forward_kinematics, or its part of a job
        document.
    ``sampling``: Samples of the Monte Carlo boundary, N_m in number. Joints locked here are held for the exact boundary
        too.
    ``base``: Body, link or site at which the chain starts; None: the world.
    ``tip``: Site, body or link at the end of the chain; None: the site "tool", or else the only end there is.
    ``cells``: N_g: number of cells of the grid over the samples; None: 2500, as published, or the most that the samples
        fill, down to 110.
    ``line_tolerance_m2``: TOLL: largest mean squared distance of boundary cells from a line [m²]; None: by the cells'
        width.
    ``arc_tolerance_m4``: TOLA: largest mean of (r² − R²)² of boundary cells about an arc [m⁴]; None: by the cells'
        width.
    ``points_m``: Points to be found inside or outside, with the nearest point of the boundary: rows of two coordinates
        in the plane [m], x and y of the world for an arm that moves in that plane; or a file of them, {"path":
        "points.npy"}.
    ``device``: Where the samples are evaluated: "auto" (a GPU if there is one), "cpu", "cuda" or "cuda:N".
    ``progress``: True shows a bar on work of more than a second; or a function (done, total, message).
    ``threads``: Threads of the CPU; None: all cores. They change no bit of the result.
    ``chunk_size``: Samples of a launch; None: by memory. It changes no bit of the result.

    Raises DocumentError, InputError, ModelError, ResourceError, NumericalError, NotConvergedError.
    """
    ...


@runs("boundary_patches")
def boundary_patches(
    robot: RobotLike,
    *,
    base: str | None = None,
    tip: str | None = None,
    locked: Mapping[str, float] = {},
    cells: int = 64,
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
) -> Result:
    """The boundary surface of the positions that a spatial arm reaches, segmented in patches, with edges and corners.

    At least three joints must move the end effector's position; others, such as those of a wrist, may follow that do
    not, or are locked. With three, patches are found from the arm's critical sets, and each comes with the joints at
    their limits that generate it. With more, they are fitted to points of the boundary that inverse kinematics finds.
    Each is the plane, sphere, cylinder, cone or torus that it is to within the points' error, or else a free form.

    The result has tables ``patches``, ``edges``, ``corners`` and the mesh ``patches``; its document the volume. Patches
    of critical sets have the ``method`` "critical_set", fitted ones "fitted": primitives where the points are within
    ``fit_tolerance_m``, 2e-6 of the reach (single ones at edges within eight times that: ``residual_m`` says); free
    forms, with the nearest primitive, elsewhere. Free forms that touch smoothly are one patch; where primitives do the
    edge is known to a cell. Points that stay ``undecided`` count as outside. A ur5e takes some 12 s of CPU time.

    ``robot``: A Robot, what `load_robot` takes, an object with limits and forward_kinematics, or its part of a job
        document.
    ``base``: Body, link or site at which the chain starts; None: the world.
    ``tip``: Site, body or link at the end of the chain; None: the site "tool", or else the only end there is.
    ``locked``: Joints held at a value, by name [rad or m].
    ``cells``: Cells along the longest edge of the workspace's box, in which patches, edges and corners are looked for:
        what is smaller than a cell is not seen. Surfaces and curves of critical sets are exact whatever their number.
    ``progress``: True shows a bar on work of more than a second; or a function (done, total, message).
    ``threads``: Threads of the CPU; None: all cores. They change no bit of the result.
    ``chunk_size``: Samples of a launch; None: by memory. It changes no bit of the result.

    Raises DocumentError, InputError, ModelError, ResourceError, NumericalError, NotConvergedError.
    """
    ...


@runs("method_comparison")
def method_comparison(
    mechanism: str | StewartGough | SixPUS | Master4DOF | Delta | LegsMechanism | Mapping[str, Any],
    *,
    orientation: Transform | Mapping[str, Any] | None = None,
    voxel_sizes_m: Sequence[float] | np.ndarray | None = None,
    ball_subdivisions: Sequence[int] | np.ndarray = (2, 3, 4, 5),
    device: str = "auto",
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
) -> Result:
    """Volume, error and time of the four methods of Shah, Narayanan and Krovi (2010), over voxel and mesh sizes.

    ``mechanism``: A mechanism whose workspace only spheres bound: UPS legs, pairs of PUS legs.
    ``orientation``: Orientation of the platform in the base frame, without position_m; None: none.
    ``voxel_sizes_m``: Edges of the voxels of methods A and B [m]; None: a 5th, 10th, 20th and 40th of the volume's cube
        root.
    ``ball_subdivisions``: How often the edges of the icosahedra that stand for balls in method D are halved.
    ``device``: Where the kernels of methods A and B run: "auto" (a GPU if there is one), "cpu", "cuda" or "cuda:N".
    ``progress``: True shows a bar on work of more than a second; or a function (done, total, message).
    ``threads``: Threads of the CPU; None: all cores. They change no bit of the result.
    ``chunk_size``: Samples of a launch; None: by memory. It changes no bit of the result.

    Raises DocumentError, InputError, ModelError, ResourceError, NumericalError, NotConvergedError.
    """
    ...


@runs("design_optimization")
def design_optimization(
    design: Document | Mapping[str, Any],
    parameters: Sequence[DesignParameter | Mapping[str, Any]],
    objectives: Sequence[Objective | Mapping[str, Any]],
    *,
    constraints: Sequence[LinearConstraint | Mapping[str, Any]] = (),
    search: DifferentialEvolution | GridSweep | ParetoSearch | Mapping[str, Any] = DifferentialEvolution(),
    evaluations: EvaluationsInFile
    | Sequence[Sequence[float | None] | np.ndarray]
    | np.ndarray
    | Mapping[str, Any] = (),
    resume: Result | None = None,
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
) -> Result:
    """Find parameters of a robot or mechanism at which the result of another analysis is best.

    A Pareto search needs pymoo, or else MissingExtraError is raised.

    ``design``: The document of another analysis, of which some numbers vary.
    ``parameters``: The numbers that vary.
    ``objectives``: What is improved: one value, the weighted sum of several, or with the search "pareto" all of them.
    ``constraints``: Linear constraints on the parameters; a sweep leaves out designs that break one.
    ``search``: How designs are chosen.
    ``evaluations``: Designs that are known and not evaluated again, so that a search goes on where an earlier one
        ended: rows of parameters and values (None: none), or {"path": file.csv}, which is read if it exists and to
        which every design is added at once; local runs only.
    ``resume``: An earlier result, whose designs are not evaluated again; None: none.
    ``progress``: True shows a bar on work of more than a second; or a function (done, total, message).
    ``threads``: Threads of the CPU; None: all cores. They change no bit of the result.
    ``chunk_size``: Samples of a launch; None: by memory. It changes no bit of the result.

    Raises DocumentError, InputError, ModelError, ResourceError, NumericalError, NotConvergedError.
    """
    ...


workspace = analyze
