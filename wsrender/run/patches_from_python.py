"""Boundaries of spatial arms from Python."""

from typing import Any

from wsrender.result import Result
from wsrender.run.from_python import arm_entry, as_subject, execute_here, plain
from wsrender.run.steps import Progress


def boundary_patches(robot: Any, *, progress: Progress | bool | None = None, **fields: Any) -> Result:
    """The boundary surface of what a spatial arm reaches, in patches such as planes, spheres and tori.

    ``robot`` is a Robot or what `load_robot` takes. ``fields`` are the other fields of the job document
    ``boundary_patches``: ``locked`` (joints held, by name), ``cells``. The result has tables ``patches``, ``edges``,
    ``corners`` and the mesh ``patches``; its document the volume.

    Raises ModelError where not three joints move the end effector through a volume; DocumentError, InputError.
    """
    subject = as_subject(robot)
    return execute_here({"analysis": "boundary_patches", **arm_entry(subject), **plain(fields)}, subject, progress)
