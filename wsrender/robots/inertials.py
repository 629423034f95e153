"""Masses and inertias on their way through MuJoCo's compiler, which refuses many that real models state.

Massless links get a negligible mass. An inertia that breaks the triangle inequality A + B ≥ C is compiled
as a negligible one, and the compiled model then receives the source's numbers: balancing it instead would
falsify the joint-space inertia.
"""

import mujoco
import numpy as np

from wsrender.errors import ModelError
from wsrender.notices import Notice
from wsrender.robots.compiled_model import MUJOCO_ERRORS, quiet, refusal
from wsrender.robots.small_matrices import principal_axes

NEGLIGIBLE = 1e-14  # [kg, kg m²] given to massless links; MuJoCo's own floor is mjMINVAL = 1e-15
MASSLESS = 1e-12  # [kg, kg m²] up to here a link counts as having no inertia
_SEMIDEFINITE = 1e-9  # relative; negative moments below it are decimal rounding of zero
_ROUNDING = 1e-12  # relative; a violated inequality below it is decimal rounding


def compile_with_inertials(
    spec: mujoco.MjSpec, field: str
) -> tuple[mujoco.MjModel, dict[int, str], tuple[Notice, ...]]:
    """The compiled model of ``spec`` with the masses [kg] and inertias [kg m²] that the source states.

    Also returns, by body, the inertias that are not positive definite though no number of theirs is
    negative: they matter only to a chain that carries them; and a notice where inertias break the triangle
    inequality. A full inertia is about the axes of ``iquat``. Raises ModelError for negative masses and moments, and
    where MuJoCo refuses the model.
    """
    compiler = spec.compiler
    compiler.balanceinertia = False
    compiler.boundmass = _bound(compiler.boundmass)
    compiler.boundinertia = _bound(compiler.boundinertia)
    compiler.fusestatic = False
    stated = [] if _inferred_everywhere(spec) else [b for b in spec.bodies[1:] if b.explicitinertial]
    moments = [(body, _moments(body, field)) for body in stated]
    faults = [(body, _fault(body, m)) for body, m in moments if m.min() < 0.0]
    restored = [(body, m) for body, m in moments if _excess(m) < 0.0 and m.min() >= 0.0]
    for body, _ in faults + restored:
        body.inertia = np.full(3, 10 * NEGLIGIBLE)
    with quiet():
        model = _compile(spec, field)
        for body, m in restored:
            model.body_inertia[body.id] = m
        if restored:
            mujoco.mj_setConst(model, mujoco.MjData(model))
    broken = _broken([body.name for body, m in restored if _excess(m) < -_ROUNDING * m.max()])
    return model, {body.id: fault for body, fault in faults}, broken


def _bound(bound: float) -> float:
    return bound if bound > MASSLESS else NEGLIGIBLE


def _inferred_everywhere(spec: mujoco.MjSpec) -> bool:
    return spec.compiler.inertiafromgeom == mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_TRUE


def _moments(body: mujoco.MjsBody, field: str) -> np.ndarray:
    """Principal moments of a body (3,), of which a full inertia leaves its axes in ``iquat``."""
    where = f"link {body.name!r}"
    if body.mass < 0.0:
        raise ModelError(field, f"{where}: its mass is {body.mass:g} kg; it must not be negative")
    full = not np.isnan(body.fullinertia[0])
    diagonal = np.array(body.fullinertia[:3] if full else body.inertia)
    if diagonal.min() < -NEGLIGIBLE:
        raise ModelError(field, f"{where}: its inertia is {diagonal.min():g}; it must not be negative")
    if not full:
        return np.maximum(diagonal, 0.0)
    xx, yy, zz, xy, xz, yz = body.fullinertia
    moments, axes = principal_axes([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    if moments.min() >= -max(_SEMIDEFINITE * moments.max(), NEGLIGIBLE):
        moments = np.maximum(moments, 0.0)
    body.fullinertia = [np.nan, 0.0, 0.0, 0.0, 0.0, 0.0]
    body.inertia, body.iquat = moments, _turned(body.iquat, axes)
    return moments


def _turned(quat_wxyz: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """The orientation ``quat_wxyz`` followed by the turn to principal axes (3, 3), columns of any sign."""
    axes = axes * [1.0, 1.0, np.sign(np.linalg.det(axes))]
    principal, turned = np.empty(4), np.empty(4)
    mujoco.mju_mat2Quat(principal, axes.ravel())
    mujoco.mju_mulQuat(turned, quat_wxyz, principal)
    return turned


def _fault(body: mujoco.MjsBody, moments: np.ndarray) -> str:
    return f"link {body.name!r}: its inertia is not positive (principal moment {moments.min():g} kg m²)"


def _broken(names: list[str]) -> tuple[Notice, ...]:
    if not names:
        return ()
    message = f"the inertia of {', '.join(names)} breaks the triangle inequality, so that no real body has it"
    return (Notice("inertia_impossible", message, "used as stated"),)


def _excess(moments: np.ndarray) -> float:
    """Sum of the two smaller moments less the largest: negative where MuJoCo refuses them."""
    low, middle, high = np.sort(moments)
    return low + middle - high


def _compile(spec: mujoco.MjSpec, field: str) -> mujoco.MjModel:
    try:
        return spec.compile()
    except MUJOCO_ERRORS as error:
        raise refusal(error, field) from error
