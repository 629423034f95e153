"""Whether a robot reaches given targets, with what configuration, or why not."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from wsrender.documents.quantities import argument, positive
from wsrender.errors import InputError
from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.reach.admissible_search import BLOCKED, Admissible, AdmissibleSearch
from wsrender.reach.admission import Admission
from wsrender.reach.closed_labels import evidence
from wsrender.reach.evidence import CLEARLY, LABELS, UNDECIDED, UNREACHABLE
from wsrender.reach.inverse_solver import InverseSolver, Solutions, closed_form_of
from wsrender.robot import as_robot
from wsrender.robots.kinematics import Kinematics
from wsrender.tolerances import TOLERANCES

POSITION_TOLERANCE_M, ANGLE_TOLERANCE_RAD = 1e-5, 1e-5

JOINT_LIMITS, OUT_OF_REACH = "joint limits", "out of reach"
TOO_CLOSE, INCONCLUSIVE = "too close to the tolerance", "search not conclusive"
NAMES = LABELS | {BLOCKED: "blocked"}


@dataclass(frozen=True, eq=False)
class Reachability:
    """What inverse kinematics found of N targets.

    ``configurations`` (N, n) [rad or m]: those that reach the target, or come nearest (where it is proven that none
    does, nearer than those about them); joints that do not matter stand in the middle of their range. ``residual_m``,
    ``residual_rad`` (N,): what is left to the target; 0 rad where no orientation was asked. ``labels`` (N,):
    "reachable", "unreachable" or "undecided". ``reasons`` (N,): of unreachable targets "out of reach" (no
    configuration, limits or not) or "joint limits" (hinges without limits would reach it, or come nearest with a slide
    at its end); of undecided ones "too close to the tolerance" or "search not conclusive"; else "".

    Under C constraints a label may be "blocked" too, by the constraint that is its reason: configurations that reach
    the target were found, and all were rejected, ``rejected`` (N, C) int32 by each first; None without constraints.
    Those of ``configurations`` that reach a target are then admitted, of blocked targets they are not.

    ``proven`` (N,) bool: that a target is unreachable, or blocked, is proven: by a closed form, up to its margin, or
    since it lies outside what holds every position; else it is the search's evidence.
    """

    configurations: np.ndarray
    residual_m: np.ndarray
    residual_rad: np.ndarray
    labels: np.ndarray
    reasons: np.ndarray
    proven: np.ndarray
    rejected: np.ndarray | None = None


def reachable(
    robot: Any,
    points: Any,
    orientations: Any = None,
    *,
    position_tolerance_m: float = POSITION_TOLERANCE_M,
    angle_tolerance_rad: float = ANGLE_TOLERANCE_RAD,
    characteristic_length_m: float | None = None,
    seed: int = 0,
    precision: str = "float64",
    device: str = "auto",
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
    constraints: Sequence[Constraint] = (),
) -> Reachability:
    """Decide which ``points`` (N, 3) [m], or poses with ``orientations`` (N, 4) quat_wxyz, the end effector reaches.

    ``robot`` is a Robot, a user-defined robot or what `load_robot` takes.
    Positions and orientations are in the world frame. Where the arm has a closed form it decides, but for targets
    near a boundary or a singular pose; those, and targets of other arms, are tried from many starts within the joint
    limits (`InverseSolver`); "unreachable" needs a proof or consistent evidence, else the label is "undecided". A label
    depends on its target and ``seed`` alone. ``characteristic_length_m`` makes an angle comparable to a distance
    while both shrink (default: half the reach). ``progress``: called with the targets decided. ``constraints``: those
    of `wsrender.robot.constraints.constraints_for`, which must admit the configurations.

    Raises InputError, ModelError.
    """
    subject = as_robot(robot)
    position = rows_of(points, 3, "points")
    axes = None if orientations is None else rotations(orientations, len(position))
    position_tolerance_m = argument("position_tolerance_m", positive, position_tolerance_m)
    check_tolerance(subject.chain, position_tolerance_m, precision)
    solver = InverseSolver(
        subject.chain,
        kind="position" if axes is None else "pose",
        position_m=position_tolerance_m,
        angle_rad=argument("angle_tolerance_rad", positive, angle_tolerance_rad),
        length_m=characteristic_length_m and argument("characteristic_length_m", positive, characteristic_length_m),
        seed=seed,
        precision=precision,
        device=device,
        threads=threads,
    )
    if constraints:
        search = AdmissibleSearch(solver, Admission(subject.chain, constraints, device, threads))
        found = search.decide(position, axes, progress)
        reasons = admissible_reasons(search, found, position, axes)
    else:
        found = solver.solve(position, axes, progress)
        reasons = reasons_of(solver, found, position, axes)
    labels = np.array([NAMES[label] for label in found.label.tolist()], dtype="<U11")
    rejected = found.rejected if isinstance(found, Admissible) else None
    proven = found.proven & np.isin(found.label, (UNREACHABLE, BLOCKED))
    return Reachability(found.q, found.distance_m, found.angle_rad, labels, reasons, proven, rejected)


def evidence_of(chain: Kinematics, with_orientation: bool) -> str:
    """What decides targets of a chain: "closed form (…), margin …", and a search where that leaves them open."""
    form = closed_form_of(chain, "pose" if with_orientation else "position")
    return evidence(form) if form else "search"


def check_tolerance(chain: Kinematics, position_tolerance_m: float, precision: str) -> None:
    """InputError where a distance is below what a precision can tell."""
    least = 2 * TOLERANCES[precision].position(chain.reach)
    if not position_tolerance_m >= least:
        raise InputError(
            "position_tolerance_m", f"{position_tolerance_m:g} is not allowed; {precision} tells {least:.1g} m or more"
        )


def rows_of(values: Any, width: int, field: str) -> np.ndarray:
    """Finite numbers of shape (N, width); a single row may be given as (width,). InputError names ``field``."""
    try:
        rows = np.atleast_2d(np.asarray(values, np.float64))
    except (TypeError, ValueError) as error:
        raise InputError(field, f"is not an array of numbers: {error}") from error
    if rows.ndim != 2 or rows.shape[1] != width:
        raise InputError(field, f"has shape {np.shape(values)}; (N, {width}) is needed")
    finite = np.isfinite(rows).all(axis=1)
    if not finite.all():
        raise InputError(field, f"row {int(np.argmin(finite))} has a value that is not finite")
    return rows


def rotations(quat_wxyz: Any, count: int) -> np.ndarray:
    """Rotation matrices (N, 3, 3) of quaternions (N, 4) of any length but 0; InputError names ``orientations``."""
    quat = rows_of(quat_wxyz, 4, "orientations")
    if len(quat) != count:
        raise InputError("orientations", f"has {len(quat)} rows for {count} points")
    length = np.linalg.norm(quat, axis=1)
    if (length < 1e-6).any():
        raise InputError("orientations", f"row {int(np.argmin(length))} has length 0: it says no rotation")
    return Rotation.from_quat(quat, scalar_first=True).as_matrix()


def reasons_of(
    solver: InverseSolver, found: Solutions | Admissible, position: np.ndarray, axes: np.ndarray | None = None
) -> np.ndarray:
    """Why targets are not reachable, as in `Reachability`, (N,) text."""
    reasons = np.full(len(position), "", dtype="<U26")
    undecided, missed = found.label == UNDECIDED, found.label == UNREACHABLE
    accuracy = solver.accuracy
    close = (found.distance_m <= CLEARLY * accuracy.position_m) & (found.angle_rad <= CLEARLY * accuracy.angle_rad)
    reasons[undecided] = np.where(close[undecided], TOO_CLOSE, INCONCLUSIVE)
    held = solver.held_by_limits(found.q[missed], position[missed], None if axes is None else axes[missed])
    reasons[missed] = np.where(held, JOINT_LIMITS, OUT_OF_REACH)
    return reasons


def admissible_reasons(
    search: AdmissibleSearch, found: Admissible, position: np.ndarray, axes: np.ndarray | None = None
) -> np.ndarray:
    """Why targets are not free, as in `Reachability`, (N,) text: of blocked ones the constraint."""
    names = np.array(["", *search.admission.names])
    reasons = reasons_of(search.solver, found, position, axes).astype(f"<U{max(26, *map(len, names))}")
    reasons[(found.label == UNDECIDED) & found.rejected.any(axis=1)] = INCONCLUSIVE
    blocked = found.label == BLOCKED
    reasons[blocked] = names[found.reason[blocked]]
    return reasons
