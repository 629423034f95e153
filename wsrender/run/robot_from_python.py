"""The analyses of one robot from Python."""

from collections.abc import Sequence
from typing import Any

from wsrender.results.result import Result
from wsrender.robot import as_robot
from wsrender.run.from_python import arm_entry, execute_here, plain, sampling_entry
from wsrender.run.steps import Progress


def analyze(
    robot: Any,
    sampling: Any = None,
    indices: str | Sequence[str] = "kinematic",
    task: str | Sequence[str] = "linear",
    *,
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
    **fields: Any,
) -> Result:
    """Sample a robot's joint space: distribution map, volume data and global indices.

    ``robot`` is a Robot, a user-defined robot or what `load_robot` takes; ``sampling`` one of Grid, Random, Sobol,
    BoundaryBiased, Converge (default Sobol(2**24), with ``keep_map`` Sobol(2**20), of a user-defined robot
    Sobol(2**16)) or its part of a job document; ``fields`` are the other fields of the job document ``workspace``:
    refined_volume, voxel_labels, index_options, convention, joint_limit_penalty, characteristic_length_m,
    torque_scaling, inertia, voxel_size_m, voxel_statistics, keep_map, map_columns, max_samples, precision, device.
    ``progress``: True shows a bar on work of more than a second; or a function (done, total, message). ``threads`` and
    ``chunk_size`` change no bit of the result. Raises DocumentError, InputError, ModelError, ResourceError,
    NumericalError, NotConvergedError.
    """
    subject = as_robot(robot)
    document = {
        "analysis": "workspace",
        **arm_entry(subject),
        **sampling_entry(sampling, subject),
        "indices": indices if isinstance(indices, str) else list(indices),
        "task": task if isinstance(task, str) else list(task),
        **plain(fields),
    }
    return execute_here(document, subject, progress, threads, chunk_size)


def kinetostatic_field(
    robot: Any,
    sampling: Any = None,
    *,
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
    **fields: Any,
) -> Result:
    """The force field of a robot's limits and conditioning over its workspace, as a volume of vectors.

    ``robot`` is as in `analyze`; ``sampling`` one of Grid, Random, Sobol, BoundaryBiased (default Sobol(100000));
    ``fields`` are the other fields of the job document ``kinetostatic_field``: field (which forces act), voxel_size_m,
    device. ``threads`` and ``chunk_size`` change no bit of the result. `force_field` gives the forces of single
    configurations.

    Raises DocumentError, InputError, ModelError, ResourceError.
    """
    subject = as_robot(robot)
    document = {"analysis": "kinetostatic_field", **arm_entry(subject), **sampling_entry(sampling), **plain(fields)}
    return execute_here(document, subject, progress, threads, chunk_size)
