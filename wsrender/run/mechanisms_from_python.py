"""The analyses of parallel mechanisms from Python."""

from typing import Any

from wsrender.mechanisms.five_bar import FiveBar
from wsrender.results.result import Result
from wsrender.run.from_python import execute_here, plain
from wsrender.run.steps import Progress


def parallel_workspace(
    mechanism: Any,
    *,
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
    **fields: Any,
) -> Result:
    """Workspace of a parallel mechanism.

    ``mechanism`` is a name of the library (stewart_gough, six_pus, delta, master_4dof) or a document: {"library": name,
    …} with other parameters, or {"legs": […]}, serial ones among them. ``fields`` are the other fields of the job
    document ``parallel_workspace``: kind, orientation, position_m, orientations, method, voxel_size_m, indices,
    refined_volume … ``threads`` and ``chunk_size`` are those of `analyze`.

    Raises DocumentError, InputError, ModelError, ResourceError.
    """
    return execute_here(
        {"analysis": "parallel_workspace", "mechanism": mechanism, **plain(fields)}, None, progress, threads, chunk_size
    )


def five_bar(
    mechanism: FiveBar,
    *,
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
    **fields: Any,
) -> Result:
    """Workspace, conditioning, singular loci and aspects of a planar five-bar.

    ``fields`` are the other fields of the job document ``five_bar``: working_modes, voxel_size_m, joint_steps, levels,
    points_m, joint_angles_rad. ``threads`` and ``chunk_size`` are those of `analyze`.

    Raises DocumentError, InputError.
    """
    lengths = {name: getattr(mechanism, name) for name in ("base_m", "proximal_m", "distal_m", "limits_rad")}
    return execute_here({"analysis": "five_bar", **lengths, **plain(fields)}, [], progress, threads, chunk_size)


def method_comparison(
    mechanism: Any,
    *,
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
    **fields: Any,
) -> Result:
    """Volume, error and time of a constant-orientation workspace by four methods.

    ``mechanism`` as in `parallel_workspace`, bounded by spheres only. ``fields`` are the other fields of the job
    document ``method_comparison``: orientation, voxel_sizes_m, ball_subdivisions, device. ``threads`` and
    ``chunk_size`` are those of `analyze`.

    Raises DocumentError, InputError.
    """
    return execute_here(
        {"analysis": "method_comparison", "mechanism": mechanism, **plain(fields)}, [], progress, threads, chunk_size
    )
