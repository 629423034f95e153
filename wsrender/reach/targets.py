"""Whether a robot reaches given targets, with what configuration, or why not."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from os import PathLike, fspath
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from wsrender.documents.constraints import Constraints
from wsrender.documents.environment import Environment
from wsrender.documents.quantities import argument, positive
from wsrender.documents.target_lists import AXES, TargetTable
from wsrender.engine import thread_count
from wsrender.errors import DocumentError, InputError
from wsrender.keywords import keywords
from wsrender.notebook import mime_bundle
from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.progress import RunProgress
from wsrender.reach.admissible_search import BLOCKED, Admissible, AdmissibleSearch
from wsrender.reach.admission import Admission
from wsrender.reach.closed_labels import evidence, rotations_of
from wsrender.reach.evidence import CLEARLY, LABELS, UNDECIDED, UNREACHABLE
from wsrender.reach.inverse_solver import InverseSolver, Solutions, closed_form_of
from wsrender.reach.target_list import TargetList, check_unit, target_list
from wsrender.robot import as_robot
from wsrender.robot.constraints import constraints_for
from wsrender.robot.poses import position_and_quaternion
from wsrender.robots.kinematics import Kinematics
from wsrender.short_repr import short_repr
from wsrender.tolerances import TOLERANCES

POSITION_TOLERANCE_M, ANGLE_TOLERANCE_RAD = 1e-5, 1e-5

JOINT_LIMITS, OUT_OF_REACH = "joint limits", "out of reach"
TOO_CLOSE, INCONCLUSIVE = "too close to the tolerance", "search not conclusive"
NAMES = LABELS | {BLOCKED: "blocked"}
POSITION, POSE = -2, -1  # what a target asks for
SHORT = 1e-6  # length below which quaternions say no rotation
MOST_KINDS = 100  # combinations of tolerances and free axes of a list, each of which sets up a search of its own


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

    __repr__ = short_repr
    _repr_mimebundle_ = mime_bundle


@keywords
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
    progress: Callable[[int], None] | bool | None = None,
    constraints: Constraints | Mapping[str, Any] | Sequence[Constraint] | None = None,
    environment: Environment | Mapping[str, Any] | None = None,
) -> Reachability:
    """Decide which ``points`` (N, 3) [m], or poses with ``orientations`` (N, 4) quat_wxyz, the end effector reaches.

    An orientation (4,) is that of all points; poses may be transforms (N, 4, 4) or (4, 4), too, and targets a table:
    its path or a `TargetTable`.

    ``robot`` is a Robot, a user-defined robot or what `load_robot` takes.
    Positions and orientations are in the world frame. Where the arm has a closed form it decides, but for targets
    near a boundary or a singular pose; those, and targets of other arms, are tried from many starts within the joint
    limits (`InverseSolver`); "unreachable" needs a proof or consistent evidence, else the label is "undecided". A label
    depends on its target and ``seed`` alone. ``characteristic_length_m`` makes an angle comparable to a distance
    while both shrink (default: half the reach). ``progress``: called with the targets decided; True shows a bar.
    ``constraints`` and ``environment`` are those of a job document, or their parts of one: they must admit the
    configurations.

    Raises InputError, DocumentError, ModelError.

    >>> found = ws.reachable("ur5e", [[0.4, 0.2, 0.3], [1.5, 0.0, 0.0]])
    >>> found.labels.tolist(), found.reasons.tolist()
    (['reachable', 'unreachable'], ['', 'out of reach'])
    """
    subject = as_robot(robot)
    choice = Constraints(**constraints) if isinstance(constraints, Mapping) else constraints
    around = Environment(**environment) if isinstance(environment, Mapping) else environment
    tolerances, options = _asked_of_all(position_tolerance_m, angle_tolerance_rad, characteristic_length_m)
    if isinstance(choice, Constraints | None):
        choice = constraints_for(subject, choice, around)
    elif around is not None:
        raise InputError("environment", "must not be given beside a sequence of constraints, which say their own")
    options |= {"seed": seed, "precision": precision, "device": device, "threads": threads, "constraints": choice}
    if isinstance(points, str | PathLike | TargetTable):
        if orientations is not None:
            raise InputError("orientations", "must not be given beside a table of targets, which says its own")
        table = points if isinstance(points, TargetTable) else _table(fspath(points))
        targets = target_list(table, "points")
        check_unit(targets, table, subject.chain.center, subject.chain.reach)
        decide, count = partial(reachable_targets, subject.chain, targets, tolerances, **options), len(targets)
    else:
        points, orientations = position_and_quaternion(points, orientations, ("points", "orientations"))
        position = rows_of(points, 3, "points")
        axes = None if orientations is None else rotations(orientations, len(position))
        decide, count = partial(_decided, subject.chain, position, axes, tolerances, **options), len(position)
    if progress is not True:
        return decide(progress=progress or None)
    with RunProgress() as bar:
        return decide(progress=lambda done: bar(done, count, "targets"))


@keywords
def reachable_labels(
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
) -> np.ndarray:
    """Labels alone of ``points`` (N, 3) [m], or poses with ``orientations`` (N, 4) quat_wxyz of any length but 0.

    An orientation (4,) is that of all points; poses may be transforms (N, 4, 4) or (4, 4), too. Returns (N,) int8:
    1 reachable, 0 unreachable, -1 undecided, which are those of `reachable` with the same options, by the same proofs,
    without configurations and reasons: much faster where the arm has a closed form. What that leaves open is searched
    as there. Contiguous arrays of float64 are read where they are.

    Raises InputError, ModelError.

    >>> ws.reachable_labels("ur5e", [[0.4, 0.2, 0.3], [1.5, 0.0, 0.0]]).tolist()
    [1, 0]
    """
    points, orientations = position_and_quaternion(points, orientations, ("points", "orientations"))
    chain, kind = as_robot(robot).chain, "position" if orientations is None else "pose"
    tolerances, options = _asked_of_all(position_tolerance_m, angle_tolerance_rad, characteristic_length_m)
    options |= {"seed": seed, "precision": precision, "device": device}
    position = rows_of(points, 3, "points")
    quat = None if orientations is None else quaternions(orientations, len(position))
    return _solver(chain, kind, tolerances, threads, **options).labels(position, quat)


def _asked_of_all(position_m: float, angle_rad: float, length_m: float | None) -> tuple[tuple[float, float], dict]:
    """Tolerances [m, rad], and options. Raises InputError."""
    tolerances = (
        argument("position_tolerance_m", positive, position_m),
        argument("angle_tolerance_rad", positive, angle_rad),
    )
    return tolerances, {"characteristic_length_m": length_m and argument("characteristic_length_m", positive, length_m)}


def _table(path: str) -> TargetTable:
    try:
        return TargetTable(path)
    except DocumentError as error:
        raise InputError("points", f"must be points or a table of targets, which {error.problems[0][1]}") from None


def reachable_targets(
    chain: Kinematics,
    targets: TargetList,
    tolerances: tuple[float, float] = (POSITION_TOLERANCE_M, ANGLE_TOLERANCE_RAD),
    *,
    progress: Callable[[int], None] | None = None,
    **options: Any,
) -> Reachability:
    """Decide targets of a list, those alike together; ``tolerances`` [m, rad] of those without their own.

    A label depends on its target alone, with the other ``options`` of `reachable`. Raises InputError.
    """
    parts, done, kinds = [], 0, kinds_of(chain, targets, tolerances)
    for each in kinds:
        tell = None if progress is None else lambda decided, before=done: progress(before + decided)
        asked = targets.position[each.at], each.orientation
        parts.append(_decided(each.chain, *asked, each.tolerances, held=chain, progress=tell, **options))
        done += len(each.at)
    if len(parts) == 1:
        return parts[0]
    back = np.argsort(np.concatenate([each.at for each in kinds]), kind="stable")
    columns: dict[str, Any] = {name: [getattr(part, name) for part in parts] for name in vars(parts[0])}
    known = {name: np.concatenate(values)[back] for name, values in columns.items() if values[0] is not None}
    return Reachability(**known)


@dataclass(frozen=True, eq=False)
class Kind:
    """Targets of a list that ask for the same, which are decided together.

    ``at`` (M,): which; ``name``: "position", "axis" or "pose", as `InverseSolver` has them; ``chain``: with the axis
    about which the tip may turn as its z; ``T_world_tip`` (M, 4, 4) of that tip; ``tolerances`` [m, rad].
    """

    at: np.ndarray
    name: str
    chain: Kinematics
    T_world_tip: np.ndarray
    tolerances: tuple[float, float]

    @property
    def orientation(self) -> np.ndarray | None:
        """What orientation they ask for, as `InverseSolver.solve` has it."""
        R = self.T_world_tip[:, :3, :3]
        return {"position": None, "axis": R[:, :, 2], "pose": R}[self.name]


def kinds_of(chain: Kinematics, targets: TargetList, tolerances: tuple[float, float]) -> list[Kind]:
    """Targets by what they ask for; ``tolerances`` [m, rad] of those without their own. Raises InputError."""
    own = np.where(np.isnan(targets.tolerances), tolerances, targets.tolerances)
    rows = np.column_stack([_asked(targets), own])
    kinds = rows[:1] if (rows == rows[0]).all() else np.unique(rows, axis=0)
    if len(kinds) > MOST_KINDS:
        message = f"have {len(kinds)} combinations of tolerances and free axes; allowed: {MOST_KINDS}"
        raise InputError("targets", message)
    return [_kind(chain, targets, int(asks), np.flatnonzero((rows == (asks, *tolerance)).all(axis=1)), tolerance)
            for asks, *tolerance in kinds.tolist()]  # fmt: skip


def _kind(chain: Kinematics, targets: TargetList, asks: int, at: np.ndarray, tolerance: list[float]) -> Kind:
    T, accuracy = np.tile(np.eye(4), (len(at), 1, 1)), (tolerance[0], tolerance[1])
    T[:, :3, 3] = targets.position[at]
    if asks == POSITION:
        return Kind(at, "position", chain, T, accuracy)
    T[:, :3, :3] = Rotation.from_quat(targets.quat_wxyz[at], scalar_first=True).as_matrix()
    if asks == POSE:
        return Kind(at, "pose", chain, T, accuracy)
    T[:, :3, :3] = np.roll(T[:, :3, :3], 2 - asks, axis=2)
    return Kind(at, "axis", with_axis(chain, asks), T, accuracy)


def with_axis(chain: Kinematics, axis: int) -> Kinematics:
    """The chain with an axis of its tip as z."""
    turn = np.eye(4)
    turn[:3, :3] = np.roll(np.eye(3), 2 - axis, axis=1)
    return chain if axis == 2 else chain.placed(T_tip_tool=chain.T_tip_tool @ turn)


def with_margin(chain: Kinematics, margin_rad: float, margin_m: float, field: str) -> Kinematics:
    """The chain within limits that keep a margin to its own; hinges without limits have none to keep.

    Raises InputError, naming the ``field``, where a joint has no such room.
    """
    margin = np.where(chain.periodic, 0.0, np.where(chain.revolute, margin_rad, margin_m))
    lower, upper = chain.lower_limits + margin, chain.upper_limits - margin
    if (narrow := (margin > 0) & (lower > upper)).any():
        k = int(np.argmax(narrow))
        end, unit = ("joint_margin_deg", "°") if chain.revolute[k] else ("joint_margin_m", " m")
        most = (chain.upper_limits[k] - chain.lower_limits[k]) / 2
        most = np.rad2deg(most) if chain.revolute[k] else most
        raise InputError(f"{field}.{end}", f"must be at most {most:.4g}{unit}: {chain.joint_names[k]} has no more room")
    return replace(chain, lower_limits=lower, upper_limits=upper) if margin.any() else chain


def _decided(
    chain: Kinematics,
    position: np.ndarray,
    axes: np.ndarray | None,
    tolerances: Sequence[float],
    *,
    device: str = "auto",
    threads: int | None = None,
    progress: Callable[[int], None] | None = None,
    constraints: Sequence[Constraint] = (),
    held: Kinematics | None = None,
    **options: Any,
) -> Reachability:
    """Targets of one kind; ``axes``: none, directions (N, 3) of the tip's z, or rotations (N, 3, 3).

    ``held``: the chain that the constraints are about, where it is not the same.
    """
    kind = "position" if axes is None else "axis" if axes.ndim == 2 else "pose"
    solver = _solver(chain, kind, tolerances, threads, device=device, **options)
    if constraints:
        search = AdmissibleSearch(solver, Admission(held or chain, constraints, device, threads))
        found = search.decide(position, axes, progress)
        reasons = admissible_reasons(search, found, position, axes)
    else:
        found = solver.solve(position, axes, progress)
        reasons = reasons_of(solver, found, position, axes)
    labels = np.array([NAMES[label] for label in found.label.tolist()], dtype="<U11")
    rejected = found.rejected if isinstance(found, Admissible) else None
    proven = found.proven & np.isin(found.label, (UNREACHABLE, BLOCKED))
    return Reachability(found.q, found.distance_m, found.angle_rad, labels, reasons, proven, rejected)


def _solver(chain: Kinematics, kind: str, tolerances: Sequence[float], threads: int | None, **options: Any):
    """The solver of options of `reachable`; the last are kept with what they found of the arm. Raises InputError."""
    return _kept_solver(chain, kind, tuple(tolerances), threads=thread_count(threads), **options)


@lru_cache(maxsize=4, typed=True)
def _kept_solver(
    chain: Kinematics,
    kind: str,
    tolerances: tuple[float, float],
    *,
    characteristic_length_m: float | None = None,
    precision: str = "float64",
    **options: Any,
) -> InverseSolver:
    check_tolerance(chain, tolerances[0], precision)
    near = {"position_m": tolerances[0], "angle_rad": tolerances[1], "length_m": characteristic_length_m}
    return InverseSolver(chain, kind=kind, precision=precision, **near, **options)


def evidence_of(chain: Kinematics, kind: str) -> str:
    """What decides targets of a kind: "closed form (…), margin …", and a search where that leaves them open."""
    form = closed_form_of(chain, kind)
    return evidence(form) if form else "search"


def evidence_of_targets(chain: Kinematics, targets: TargetList) -> str:
    """What decides targets, of each kind."""
    found = []
    for asks in np.unique(_asked(targets)).tolist():
        whole = asks in (POSITION, POSE)
        kind = "axis" if not whole else "pose" if asks == POSE else "position"
        found.append(evidence_of(chain if whole else with_axis(chain, asks), kind))
    return "; ".join(dict.fromkeys(found))


def _asked(targets: TargetList) -> np.ndarray:
    """What each target asks for, (N,) int64: POSITION, POSE, or the number of the axis of the tip that may turn."""
    axis = sum(k * (targets.free_axis == name) for k, name in enumerate(AXES))
    return np.where(targets.oriented, np.where(targets.free_axis == "", POSE, axis), POSITION)


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
    finite = np.isfinite(rows)
    if not finite.all():
        raise InputError(field, f"row {int(np.argmin(finite.all(axis=1)))} has a value that is not finite")
    return rows


def rotations(quat_wxyz: Any, count: int) -> np.ndarray:
    """Rotation matrices (N, 3, 3) of quaternions (N, 4) of any length but 0; InputError names ``orientations``."""
    return rotations_of(quaternions(quat_wxyz, count))


def quaternions(quat_wxyz: Any, count: int) -> np.ndarray:
    """Quaternions (N, 4) of any length but 0, a row each or one for all; InputError names ``orientations``."""
    quat = rows_of(quat_wxyz, 4, "orientations")
    quat = np.repeat(quat, count, axis=0) if len(quat) == 1 else quat
    if len(quat) != count:
        raise InputError("orientations", f"has {len(quat)} rows for {count} points")
    short = np.flatnonzero(np.abs(quat[:, 0]) < SHORT)  # few: no length of all is computed
    short = short[np.linalg.norm(quat[short], axis=1) < SHORT]
    if len(short):
        raise InputError("orientations", f"row {short[0]} has length 0: it says no rotation")
    return quat


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
