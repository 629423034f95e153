"""Masses and inertias on their way through MuJoCo's compiler, which refuses many that real models state.

Massless links get a negligible mass. An inertia that breaks the triangle inequality A + B ≥ C is compiled
as a negligible one, and the compiled model then receives the source's numbers: balancing it instead would
falsify the joint-space inertia.
"""

import warnings

import mujoco
import numpy as np

from wsrender.errors import ModelError
from wsrender.robots.model_warning import ModelWarning

NEGLIGIBLE = 1e-14  # [kg, kg m²] given to massless links; MuJoCo's own floor is mjMINVAL = 1e-15
MASSLESS = 1e-12  # [kg, kg m²] up to here a link counts as having no inertia
_ROUNDING = 1e-12  # relative; a violated inequality below it is decimal rounding


def compile_with_inertials(spec: mujoco.MjSpec, field: str) -> mujoco.MjModel:
    """The compiled model of ``spec`` with the masses [kg] and inertias [kg m²] that the source states.

    Raises ModelError for negative masses and inertias, and where MuJoCo refuses the model; gives one
    ModelWarning where inertias break the triangle inequality.
    """
    compiler = spec.compiler
    compiler.balanceinertia = False
    compiler.boundmass = _bound(compiler.boundmass)
    compiler.boundinertia = _bound(compiler.boundinertia)
    compiler.fusestatic = False
    restored = [] if _inferred_everywhere(spec) else _set_aside(spec, field)
    model = _compile(spec, field)
    for body, moments in restored:
        model.body_inertia[body.id] = moments
    if restored:
        mujoco.mj_setConst(model, mujoco.MjData(model))
    return model


def principal_moments(inertia: np.ndarray, field: str, where: str) -> tuple[np.ndarray, np.ndarray]:
    """Eigenvalues (3,) of a (3, 3) inertia and the rotation (3, 3) of its principal axes.

    Raises ModelError if one is negative beyond rounding.
    """
    moments, axes = np.linalg.eigh(inertia)
    if moments[0] < -1e-9 * np.abs(moments).max():
        raise ModelError(field, f"{where}: its inertia is not positive (principal moment {moments[0]:g})")
    axes[:, 2] *= np.sign(np.linalg.det(axes))
    return np.maximum(moments, 0.0), axes


def _bound(bound: float) -> float:
    return bound if bound > MASSLESS else NEGLIGIBLE


def _inferred_everywhere(spec: mujoco.MjSpec) -> bool:
    return spec.compiler.inertiafromgeom == mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_TRUE


def _set_aside(spec: mujoco.MjSpec, field: str) -> list[tuple[mujoco.MjsBody, np.ndarray]]:
    """Replaces the inertias that MuJoCo would refuse; returns the bodies with their true moments."""
    restored, broken = [], []
    for body in spec.bodies[1:]:
        if not body.explicitinertial:
            continue
        where = f"link {body.name or body.id!r}"
        if body.mass < 0.0:
            raise ModelError(field, f"{where}: its mass is {body.mass:g} kg; it must not be negative")
        moments = _moments(body, field, where)
        if _excess(moments) < 0.0:
            body.inertia = np.full(3, 10 * NEGLIGIBLE)
            restored.append((body, moments))
            if _excess(moments) < -_ROUNDING * moments.max():
                broken.append(body.name)
    if broken:
        warnings.warn(
            f"the inertia of {', '.join(broken)} breaks the triangle inequality, so that no real body has "
            "it; used as stated",
            ModelWarning,
            stacklevel=2,
        )
    return restored


def _moments(body: mujoco.MjsBody, field: str, where: str) -> np.ndarray:
    """Principal moments of a body; a full inertia that MuJoCo would refuse is made diagonal on the way."""
    if np.isnan(body.fullinertia[0]):
        moments = np.array(body.inertia)
        if moments.min() < 0.0:
            raise ModelError(field, f"{where}: its inertia is {moments.min():g}; it must not be negative")
        return moments
    xx, yy, zz, xy, xz, yz = body.fullinertia
    moments, axes = principal_moments(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]), field, where)
    if moments[0] < NEGLIGIBLE or _excess(moments) < 1e-9 * moments.max():
        body.fullinertia = [np.nan, 0, 0, 0, 0, 0]
        body.inertia = moments
        mujoco.mju_mat2Quat(body.iquat, axes.ravel())
    return moments


def _excess(moments: np.ndarray) -> float:
    """Sum of the two smaller moments less the largest: negative where MuJoCo refuses them."""
    low, middle, high = np.sort(moments)
    return low + middle - high


def _compile(spec: mujoco.MjSpec, field: str) -> mujoco.MjModel:
    try:
        return spec.compile()
    except (ValueError, RuntimeError, mujoco.FatalError) as error:
        raise ModelError(field, f"MuJoCo refuses the model: {' '.join(str(error).split())}") from error
