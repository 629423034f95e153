"""Workspace analysis of robotic manipulators: where an arm can reach, and how well it moves there.

``import wsrender`` loads nothing heavy: every public name is imported when it is first used.
"""

from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

from wsrender.errors import (
    AccessError,
    DocumentError,
    FrameNotFoundError,
    InputError,
    JobFailedError,
    MissingExtraError,
    MissingInertiaError,
    ModelError,
    NotConvergedError,
    NotFoundError,
    NumericalError,
    QuotaError,
    RenderError,
    ResourceError,
    ServerConnectionError,
    ServerError,
    WaitTimeoutError,
    WsrenderError,
)
from wsrender.version import __version__

if TYPE_CHECKING:
    from wsrender import run
    from wsrender.client import AsyncClient, Client
    from wsrender.documents.array_files import ArrayFile
    from wsrender.documents.environment import (
        Box,
        Capsule,
        ConvexMesh,
        Cylinder,
        Ellipsoid,
        Environment,
        HalfSpace,
        HeightField,
        Mesh,
        OtherRobot,
        Scene,
        Sphere,
    )
    from wsrender.documents.robot import DHRow, DHTable, MountJoint, Transform
    from wsrender.documents.sampling import BoundaryBiased, Converge, Grid, Random, Sobol
    from wsrender.documents.target_lists import Criterion, Target, TargetTable, TargetVolume
    from wsrender.geometry.planar.exact_boundary import exact_boundary
    from wsrender.geometry.polytopes import Polytope, polytope
    from wsrender.indices import Index, Option, math, register_index
    from wsrender.kinetostatics import ForceField, force_field
    from wsrender.mechanisms.five_bar import FiveBar
    from wsrender.pipeline.constraints.expression import ExpressionConstraint
    from wsrender.pipeline.constraints.registry import register_constraint
    from wsrender.python import (
        all_postures,
        analyze,
        base_placement,
        boundary_patches,
        capability,
        collaborative_volume,
        design_optimization,
        five_bar,
        indices_at,
        inverse_reachability,
        kinetostatic_field,
        master_slave_mapping,
        method_comparison,
        parallel_workspace,
        planar_boundary,
        reachability,
        robot_comparison,
        shared_workspace,
        two_arm_placement,
        workspace,
    )
    from wsrender.reach import Postures, Reachability, postures, reachable, reachable_labels
    from wsrender.results.configurations import configuration_of
    from wsrender.results.export.formats import Format, register_format
    from wsrender.results.presentation import Picture, register_picture
    from wsrender.results.result import Result
    from wsrender.robot import Robot, evaluate_indices, load_robot
    from wsrender.run import execute

__all__ = [
    "AccessError",
    "ArrayFile",
    "AsyncClient",
    "BoundaryBiased",
    "Box",
    "Capsule",
    "Client",
    "Converge",
    "ConvexMesh",
    "Criterion",
    "Cylinder",
    "DHRow",
    "DHTable",
    "DocumentError",
    "Ellipsoid",
    "Environment",
    "ExpressionConstraint",
    "FiveBar",
    "ForceField",
    "Format",
    "FrameNotFoundError",
    "Grid",
    "HalfSpace",
    "HeightField",
    "Index",
    "InputError",
    "JobFailedError",
    "Mesh",
    "MissingExtraError",
    "MissingInertiaError",
    "ModelError",
    "MountJoint",
    "NotConvergedError",
    "NotFoundError",
    "NumericalError",
    "Option",
    "OtherRobot",
    "Picture",
    "Polytope",
    "Postures",
    "QuotaError",
    "Random",
    "Reachability",
    "RenderError",
    "ResourceError",
    "Result",
    "Robot",
    "Scene",
    "ServerConnectionError",
    "ServerError",
    "Sobol",
    "Sphere",
    "Target",
    "TargetTable",
    "TargetVolume",
    "Transform",
    "WaitTimeoutError",
    "WsrenderError",
    "__version__",
    "all_postures",
    "analyze",
    "base_placement",
    "boundary_patches",
    "capability",
    "collaborative_volume",
    "configuration_of",
    "design_optimization",
    "evaluate_indices",
    "exact_boundary",
    "execute",
    "five_bar",
    "force_field",
    "indices_at",
    "inverse_reachability",
    "kinetostatic_field",
    "load_robot",
    "master_slave_mapping",
    "math",
    "method_comparison",
    "parallel_workspace",
    "planar_boundary",
    "polytope",
    "postures",
    "reachability",
    "reachable",
    "reachable_labels",
    "register_constraint",
    "register_format",
    "register_index",
    "register_picture",
    "robot_comparison",
    "run",
    "shared_workspace",
    "two_arm_placement",
    "workspace",
]

_NAMES_OF_MODULE = {
    "wsrender.client": ("AsyncClient", "Client"),
    "wsrender.results.export.formats": ("Format", "register_format"),
    "wsrender.results.presentation": ("Picture", "register_picture"),
    "wsrender.indices": ("Index", "Option", "register_index"),
    "wsrender.kinetostatics": ("ForceField", "force_field"),
    "wsrender.mechanisms.five_bar": ("FiveBar",),
    "wsrender.geometry.planar.exact_boundary": ("exact_boundary",),
    "wsrender.geometry.polytopes": ("Polytope", "polytope"),
    "wsrender.pipeline.constraints.expression": ("ExpressionConstraint",),
    "wsrender.pipeline.constraints.registry": ("register_constraint",),
    "wsrender.python": (
        "all_postures",
        "analyze",
        "base_placement",
        "boundary_patches",
        "capability",
        "collaborative_volume",
        "design_optimization",
        "five_bar",
        "indices_at",
        "inverse_reachability",
        "kinetostatic_field",
        "master_slave_mapping",
        "method_comparison",
        "parallel_workspace",
        "planar_boundary",
        "reachability",
        "robot_comparison",
        "shared_workspace",
        "two_arm_placement",
        "workspace",
    ),
    "wsrender.reach": ("Postures", "Reachability", "postures", "reachable", "reachable_labels"),
    "wsrender.results.configurations": ("configuration_of",),
    "wsrender.results.result": ("Result",),
    "wsrender.robot": ("Robot", "evaluate_indices", "load_robot"),
    "wsrender.run": ("execute",),
    "wsrender.documents.environment": (
        "Box",
        "Capsule",
        "ConvexMesh",
        "Cylinder",
        "Ellipsoid",
        "Environment",
        "HalfSpace",
        "HeightField",
        "Mesh",
        "OtherRobot",
        "Scene",
        "Sphere",
    ),
    "wsrender.documents.robot": ("DHRow", "DHTable", "MountJoint", "Transform"),
    "wsrender.documents.sampling": ("BoundaryBiased", "Converge", "Grid", "Random", "Sobol"),
    "wsrender.documents.array_files": ("ArrayFile",),
    "wsrender.documents.target_lists": ("Criterion", "Target", "TargetTable", "TargetVolume"),
}
_MODULE_OF_NAME = {name: module for module, names in _NAMES_OF_MODULE.items() for name in names}
_MODULES = {"math": "wsrender.indices.math", "run": "wsrender.run"}


def _public(name: str) -> Any:
    """Import a public name when it is first used; raises MissingExtraError where its extra is missing."""
    if name in _MODULES:
        value = _imported(_MODULES[name])
    elif name in _MODULE_OF_NAME:
        value = getattr(_imported(_MODULE_OF_NAME[name]), name)
    else:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    globals()[name] = value
    return value


if not TYPE_CHECKING:  # a type checker would believe that every name is there
    __getattr__ = _public


def _imported(module: str) -> ModuleType:
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        if error.name is None or error.name.startswith("wsrender"):
            raise
        raise MissingExtraError(error.name, "engine") from None


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
