"""Boundaries of spatial arms from Python."""

from typing import Any

from wsrender.results.result import Result
from wsrender.robot import as_robot
from wsrender.run.from_python import arm_entry, execute_here, plain
from wsrender.run.steps import Progress


def boundary_patches(
    robot: Any,
    *,
    progress: Progress | bool | None = None,
    threads: int | None = None,
    chunk_size: int | None = None,
    **fields: Any,
) -> Result:
    """The boundary surface of what a spatial arm reaches, in patches such as planes, spheres and tori.

    ``robot`` is a Robot or what `load_robot` takes. ``fields`` are the other fields of the job document
    ``boundary_patches``: ``locked`` (joints held, by name), ``cells``. The result has tables ``patches``, ``edges``,
    ``corners`` and the mesh ``patches``; its document the volume.

    Where three joints move the end effector patches are those of its critical sets (``method`` "critical_set"). Where
    more do they are fitted to points found by inverse kinematics ("fitted"): primitives where the points are within
    ``fit_tolerance_m``, 2e-6 of the reach (single ones at edges within eight times that: ``residual_m`` says); free
    forms, with the nearest primitive, elsewhere. Free forms that touch smoothly are one patch; where primitives do the
    edge is known to a cell. Points that stay ``undecided`` count as outside. A ur5e takes some 12 s of CPU time.
    ``threads`` and ``chunk_size`` are those of `analyze`.

    Raises ModelError where the joints do not move the end effector through a volume; DocumentError, InputError.
    """
    subject = as_robot(robot)
    return execute_here(
        {"analysis": "boundary_patches", **arm_entry(subject), **plain(fields)}, subject, progress, threads, chunk_size
    )
