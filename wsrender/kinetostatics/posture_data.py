"""What a picture of a posture shows: how near its joints are to their limits, and what the tip can do."""

from typing import Any

import numpy as np

from wsrender.kinetostatics.force_fields import ForceField
from wsrender.volume.table import Table

CUT = 10.0  # longest axis of a force ellipsoid over its shortest: at singular postures it is endless


def limit_nearness(field: ForceField, q: np.ndarray) -> np.ndarray:
    """Of every joint 0 in the middle of its range … 1 at a limit (n,); 0 for joints without limits."""
    chain = field.chain
    half = (chain.upper_limits - chain.lower_limits) / 2
    middle = (chain.upper_limits + chain.lower_limits) / 2
    share = np.abs(q - middle) / np.where(half > 0, half, np.inf)
    return np.where(chain.periodic, 0.0, np.minimum(share, 1.0))


def ellipsoids(J: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Axes (3, 3), one a row, and the radii (3,) of the velocity and the force ellipsoid of a linear Jacobian (3, n).

    Velocities J q̇ with |q̇| ≤ 1 have radii σ_k, forces F with |Jᵀ F| ≤ 1 radii 1/σ_k (Yoshikawa 1985), cut at ten times
    the shortest.
    """
    u, sigma, _ = np.linalg.svd(J)
    sigma = np.pad(sigma, (0, 3 - len(sigma)))
    shortest = 1 / sigma[0] if sigma[0] > 0 else 1.0
    return u.T, sigma, np.minimum(1 / np.maximum(sigma, 1e-300), CUT * shortest)


def posture_tables(field: ForceField, q: Any) -> dict[str, Table]:
    """Tables of one configuration (n,): ``posture``, a row per point of the skeleton, and ``ellipsoids``, one per axis.

    ``posture``: position [m] of base, joints and tip, the joint's name and nearness to its limit (of the base and the
    tip: none and 0). ``ellipsoids``: axis, velocity [m], force [1/m] radii, and the field's force [N] by components.
    """
    state, chain = field.evaluate(q), field.chain
    points = field.robot.skeleton(state.posture.q)[0]
    source = chain.joint_source
    names = ["", *(chain.joint_names[k] for k in source), ""]
    nearness = np.concatenate([[0.0], limit_nearness(field, state.posture.q)[source], [0.0]])
    axes, velocity, force = ellipsoids(state.posture.J[:3])
    return {
        "posture": Table({"position": points, "joint": np.array(names), "limit_nearness": nearness}, {"position": "m"}),
        "ellipsoids": Table(
            {"axis": axes, "velocity": velocity, "force": force, "rendered_force": state.force},
            {"velocity": "m", "force": "1/m", "rendered_force": "N"},
        ),
    }
