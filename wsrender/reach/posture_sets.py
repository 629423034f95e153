"""All postures of poses: from a closed form where the arm has one, else those that a search finds."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from itertools import product
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from wsrender.documents.constraints import Constraints
from wsrender.documents.environment import Environment
from wsrender.documents.quantities import argument, positive
from wsrender.documents.sampling import Sobol
from wsrender.documents.target_lists import AXES, UNIT
from wsrender.engine import (
    CLOSED_MARGIN,
    Accuracy,
    closed_postures,
    configurations,
    open_wrist_postures,
    solve_inverse,
)
from wsrender.errors import InputError
from wsrender.keywords import keywords
from wsrender.notebook import mime_bundle
from wsrender.pipeline.constraints.constraint import Constraint
from wsrender.pipeline.pipeline import tip_pipeline
from wsrender.reach.admission import Admission
from wsrender.reach.closed_labels import ALONE, evidence
from wsrender.reach.inverse_solver import parts_of, that_matter
from wsrender.reach.nearly_closed_labels import NearlyClosedLabels
from wsrender.reach.posture_solver import EXACT, NEARLY_SINGULAR, SAME, TURN, PoseHolder
from wsrender.reach.self_motions import STEP, SelfMotion, self_motions
from wsrender.reach.starts import towards_limits
from wsrender.reach.targets import rotations, rows_of, with_axis
from wsrender.robot import as_robot
from wsrender.robot.constraints import constraints_for
from wsrender.robot.poses import position_and_quaternion
from wsrender.robots.closed_form import ClosedForm, NearlyClosedForm, OpenWristForm, families
from wsrender.robots.kinematics import Kinematics
from wsrender.short_repr import short_repr

STARTS = 512  # of the search for postures of a pose
NEAR = 1e-4  # slack within which a posture that seems outside limits or not there is looked at: folds, rounding
BATCH, REDUNDANT_BATCH = 1 << 13, 1 << 6  # poses whose postures, or those on self-motions, are held at a time
LARGEST_STEP = 0.2  # rad and reaches: longer steps could leave a curve for another
SWEPT = 128  # values of a free joint at which self-motions are looked for
MOST_OF_FAMILIES = 16  # postures of a pose that stand for families, whose members have no number
NEARLY = 1e-5  # m and rad: a try that ends so near is taken further
ROLL = "the turn about the free axis"
# What is assumed of the one equation that an arm without a wrist leaves, where postures are called complete.
ASSUMED = "complete where its terms beyond the fifth degree are less than the two before, as the wrist turns by 0.3 rad"
ANYHOW = Rotation.from_rotvec([0.9, -1.3, 0.4]).as_matrix()  # an orientation at which no free wrist stands in line


@dataclass(frozen=True, eq=False)
class Postures:
    """K postures of N poses; as an array they are their ``configurations`` (K, n) [rad or m].

    ``pose`` (K,) int: the pose, ascending, that each holds to 1e-9 m and rad, within the limits. ``windings`` (K,) int:
    how many configurations it stands for, which differ by whole turns of hinges; `wound` lists them. ``sigma_min``
    (K,): smallest singular value of the Jacobian, lengths over the reach. ``family`` (K,) bool: the arm can move from
    it while the tip stays, and a few such stand for all; ``doubtful`` (K,) bool: nearly singular. ``residual_m``,
    ``residual_rad`` (K,): to the pose. ``reasons`` (K,) text: the constraint that blocks it, "" of a free one.

    ``complete`` (N,) bool: by a closed form no other posture exists, or by what ``evidence`` says; else others were not
    found. ``least_turns``, ``most_turns`` (K, n) int: by how many whole turns hinges may be moved.
    ``curves``: the self-motion that each posture stands for, of arms with one joint more than the pose has freedoms and
    of families of one freedom; else None. Windings are then of the joints that stand still along it.
    """

    configurations: np.ndarray
    pose: np.ndarray
    windings: np.ndarray
    sigma_min: np.ndarray
    family: np.ndarray
    doubtful: np.ndarray
    residual_m: np.ndarray
    residual_rad: np.ndarray
    reasons: np.ndarray
    complete: np.ndarray
    evidence: str
    least_turns: np.ndarray
    most_turns: np.ndarray
    curves: tuple[SelfMotion | None, ...]

    __repr__ = short_repr
    _repr_mimebundle_ = mime_bundle

    def __len__(self) -> int:
        return len(self.configurations)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        return np.array(self.configurations, dtype=dtype)

    def __iter__(self) -> Iterator[np.ndarray]:
        return iter(self.configurations)

    def __getitem__(self, k: Any) -> np.ndarray:
        return self.configurations[k]

    @property
    def count(self) -> int:
        """Configurations of all postures, windings counted apart."""
        return int(self.windings.sum())

    def wound(self, k: int | None = None) -> Iterator[np.ndarray]:
        """The configurations (n,) [rad or m] of a posture by number, or of all, one after the other."""
        for row in range(len(self)) if k is None else [k]:
            yield from _wound(self.configurations[row], self.least_turns[row], self.most_turns[row])


class PostureSolver:
    """All postures of targets of one chain, of a ``kind``: "pose", "axis" or "position", any orientation.

    Axes are poses about whose ``free_axis`` the tip may turn: "x", "y" or "z", its own.
    ``curve_step``: between points of self-motions [rad or reaches]. ``starts``: of the search, for a pose of an arm
    without a closed form, or where that is in doubt; they depend on ``seed`` alone.
    """

    def __init__(
        self,
        chain: Kinematics,
        *,
        kind: str = "pose",
        free_axis: str = "z",
        starts: int = STARTS,
        curve_step: float = STEP,
        seed: int = 0,
        device: str = "auto",
        threads: int | None = None,
    ):
        self.whole, self.origin, self.kind, self.axis = chain, chain.origin, kind, AXES.index(free_axis)
        self.turned = with_axis(chain, self.axis)
        self.holder = PoseHolder(self.turned.relative_to(chain.origin), kind)
        part, kept = that_matter(self.turned, kind)
        self.form = ClosedForm.of(part, kind) or OpenWristForm.of(part, kind) or NearlyClosedForm.of(part, kind)
        self.idle = ~np.isin(np.arange(chain.n), kept)  # joints that turn as they like: in the middle of their range
        self._middle = (chain.lower_limits + chain.upper_limits) / 2
        self.starts, self.curve_step, self.seed = starts, curve_step, seed
        self.device, self.threads = device, threads

    @property
    def evidence(self) -> str:
        """What postures rest on."""
        search = f"search from {self.starts} starts a pose, sampled, not proven complete"
        if self.form:
            assumed = f", {ASSUMED}" if isinstance(self.form, OpenWristForm) else ""
            return f"{evidence(self.form)}{assumed}; where that is in doubt {search}"
        if not self.redundant:
            return search
        if (spare := len(self.holder.moving) - self.holder.freedoms) > 1:
            return f"{MOST_OF_FAMILIES} postures at most of families of {spare} freedoms, {search}"
        sweep = f"closed form at {SWEPT} values of {self.swept}, " if self.swept else ""
        return f"{sweep}self-motions in steps of {self.curve_step:g}, {search}"

    def solve(
        self,
        T: np.ndarray,
        progress: Callable[[int], None] | None = None,
        constraints: Sequence[Constraint] = (),
    ) -> Postures:
        """Of poses (N, 4, 4) in the world; ``progress``: called with the poses done."""
        parts = []
        if self.kind == "axis":
            T = T.copy()
            T[:, :3, :3] = np.roll(T[:, :3, :3], 2 - self.axis, axis=2)
        batch = REDUNDANT_BATCH if self.redundant else BATCH
        for first in range(0, max(len(T), 1), batch):
            parts.append(self._solve(T[first : first + batch], first))
            if progress:
                progress(min(first + batch, len(T)))
        found = Postures(**{f.name: _joined(f.name, parts) for f in fields(Postures)})
        if not constraints or not len(found):
            return found
        admission = Admission(self.whole, constraints, self.device, self.threads)
        names = np.array(["", *admission.names])
        curves = [
            curve and replace(curve, reasons=names[admission.rejected(curve.configurations)]) for curve in found.curves
        ]
        reasons = names[admission.rejected(found.configurations)]
        return replace(found, reasons=reasons, curves=tuple(curves))

    def _solve(self, T: np.ndarray, first: int) -> Postures:
        near, holder = T.copy(), self.holder
        near[:, :3, 3] -= self.origin
        pose, q, complete = self._closed(T, near) if self.form else self._swept_postures(T, near)
        for part in parts_of(np.flatnonzero(~complete), self.starts):
            more, found = self._searched(T, part)
            found, _ = holder.polished(found, near[more])
            order = np.lexsort([*np.round(found, 6).T[::-1], more])
            pose, q = np.concatenate([pose, more[order]]), np.concatenate([q, found[order]])
        order = np.argsort(pose, kind="stable")
        pose, q = pose[order], q[order]
        held = np.flatnonzero(holder.holds(holder.errors(q, near[pose])))
        kept = held[holder.distinct(pose[held], q[held], near)]
        pose, q = pose[kept], q[kept]
        family = np.full(len(q), self.redundant)
        at = np.flatnonzero((holder.sigma_min(q) < NEARLY_SINGULAR) & ~family)
        family[at] = holder.families(q[at], near[pose[at]])
        line = family & (holder.nullity(q) == 1)
        number = np.cumsum(family) - np.searchsorted(np.flatnonzero(family), np.searchsorted(pose, pose))
        few = ~line & (~family | (number <= MOST_OF_FAMILIES))
        curves = self_motions(holder, pose[line], q[line], near, self.curve_step)
        pose = np.concatenate([pose[few], [curve.pose for curve in curves]]).astype(int)
        q = np.concatenate([q[few], *(curve.configurations[[len(curve) // 2]] for curve in curves)])
        family = np.concatenate([family[few], np.ones(len(curves), bool)])
        least, most = holder.turns(q)
        least[:, self.idle] = most[:, self.idle] = 0
        for k, curve in enumerate(curves, int(few.sum())):
            moves = np.ptp(curve.configurations, axis=0) > SAME * holder.scale
            least[k, moves] = most[k, moves] = 0
        all_curves = [None] * int(few.sum()) + [replace(curve, pose=curve.pose + first) for curve in curves]
        order = np.argsort(pose, kind="stable")
        pose, q, least, most = pose[order], q[order], least[order], most[order]
        left, sigma = holder.errors(q, near[pose]), holder.sigma_min(q)
        return Postures(
            q,
            pose + first,
            (most - least + 1).prod(axis=1),
            sigma,
            family[order],
            sigma < NEARLY_SINGULAR,
            np.linalg.norm(left[:, :3], axis=1),
            np.linalg.norm(left[:, 3:], axis=1),
            np.full(len(q), ""),
            complete,
            self.evidence,
            least,
            most,
            tuple(all_curves[k] for k in order),
        )

    @cached_property
    def redundant(self) -> bool:
        """Whether more joints move than the pose has freedoms."""
        return len(self.holder.moving) > self.holder.freedoms

    @cached_property
    def swept(self) -> str | None:
        """What a closed form is known for wherever it stands, of an arm with one freedom more than is asked for.

        The first or last joint that moves, by name, or the turn about the free axis.
        """
        holder, chain = self.holder, self.turned
        if self.form or len(holder.moving) != holder.freedoms + 1:
            return None
        middle = chain.within(0.41)  # no closed form that is there in a special configuration alone
        for k in (int(holder.moving[-1]), int(holder.moving[0])):
            if isinstance(self._held(chain.joint_names[k], float(middle[k])).form, ClosedForm):
                return chain.joint_names[k]
        return ROLL if self.kind == "axis" and ClosedForm.of(chain) else None

    def _held(self, joint: str, value: float) -> "PostureSolver":
        arm = self.turned.held({joint: value})
        return PostureSolver(arm, kind=self.kind, device=self.device, threads=self.threads)

    def _swept_postures(self, T: np.ndarray, near: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """As `_closed`, at SWEPT values of what is `swept`; that there are no others is not known."""
        pose, q = [np.zeros(0, int)], [np.zeros((0, self.whole.n))]
        share = (np.arange(SWEPT if self.swept else 0) + 0.5) / SWEPT
        if self.swept == ROLL:
            solver = PostureSolver(self.turned, device=self.device, threads=self.threads)
            for turn in Rotation.from_rotvec(TURN * share[:, None] * [0, 0, 1]).as_matrix():
                rolled = [np.concatenate([each[..., :3] @ turn, each[..., 3:]], axis=2) for each in (T, near)]
                more, found, _ = solver._closed(*rolled)
                pose, q = [*pose, more], [*q, found]
        elif self.swept:
            k = self.whole.joint_names.index(self.swept)
            low, high = self.whole.lower_limits[k], self.whole.upper_limits[k]
            for value in low + share * (high - low):
                more, found, _ = self._held(self.swept, float(value))._closed(T, near)
                pose, q = [*pose, more], [*q, found]
        return np.concatenate(pose), np.concatenate(q), np.zeros(len(T), bool)

    def _closed(self, T: np.ndarray, near: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Pose, ascending, and configuration of a closed form's postures; and whether there are no others, (N,) bool.

        That is not known of singular poses, whose postures are more than their branches tell, but of families that are
        solved: of these postures at both ends of every curve, or on the loops.
        """
        if self.form is None:  # nor has an arm one that is held where it is special
            return np.zeros(0, int), np.zeros((0, self.whole.n)), np.zeros(len(T), bool)
        asked = T.copy()
        if self.kind == "position":
            asked[:, :3, :3] = ANYHOW
        execution = {"device": self.device, "threads": self.threads}
        form = self.form if isinstance(self.form, ClosedForm) else self.form.rest
        if isinstance(self.form, OpenWristForm):
            found = open_wrist_postures(self.form, asked, **execution)
        else:
            found = closed_postures(form, asked, keep=True, **execution)
        assert found.rows is not None
        near_limits = NEAR
        solved, doubtful = np.zeros(found.rows.shape[:2], bool), np.zeros(found.rows.shape[:2], bool)
        of, members = np.zeros(0, int), np.zeros((0, 12))
        if isinstance(self.form, OpenWristForm):
            doubtful[:] = found.flags[:, None] != 0
        elif isinstance(self.form, NearlyClosedForm):
            exact = Accuracy(EXACT, EXACT, self.holder.length / 2)
            margin = NearlyClosedLabels(self.form, exact, self.device, self.threads).nearby.margin
            doubtful = (found.rows[..., 13] >= -margin) & (found.rows[..., 13] * ALONE <= margin)
            near_limits = max(NEAR, margin)
        else:
            doubtful = np.abs(found.rows[..., 13]) <= CLOSED_MARGIN
            at = np.flatnonzero(doubtful.any(axis=1))
            curves = families(form, asked[at], found.rows[at], 0.0)
            solved[at] = curves.family & curves.told_apart & (curves.near <= EXACT)
            of, members = at[curves.pose], curves.rows
        pose, branch = np.nonzero((found.rows[..., 12] > -near_limits) & ~solved)
        q = np.tile(self._middle, (len(pose) + len(of), 1))
        q[:, ~self.idle] = form.configurations(np.concatenate([found.rows[pose, branch, :12], members]))
        q[: len(pose)], _ = self.holder.polished(q[: len(pose)], near[pose])
        doubtful &= ~solved
        doubtful[pose, branch] |= self.holder.sigma_min(q[: len(pose)]) < NEARLY_SINGULAR
        pose = np.append(pose, of)
        order = np.argsort(pose, kind="stable")
        return pose[order], q[order], doubtful.sum(axis=1) == 0

    def _searched(self, T: np.ndarray, at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Pose and configuration of what tries for poses ``at`` (P,) come to."""
        chain, columns = self.turned, {"position": [3], "axis": [3, 2], "pose": [3, 0, 1, 2]}[self.kind]
        targets = T[at][:, :3, columns].transpose(0, 2, 1).reshape(len(at), -1)
        anywhere = configurations(tip_pipeline(chain, Sobol(self.starts, seed=self.seed)))
        anywhere[1::2] = towards_limits(chain, anywhere[1::2])
        accuracy = Accuracy(NEARLY, NEARLY, self.holder.length / 2)
        tries = solve_inverse(
            chain,
            np.repeat(targets, self.starts, axis=0),
            np.tile(anywhere, (len(at), 1)),
            accuracy,
            device=self.device,
            threads=self.threads,
        )
        q = np.where(self.idle, self._middle, tries.q[tries.reached])
        return np.repeat(at, self.starts)[tries.reached], q


@keywords
def postures(
    robot: Any,
    position_m: Any,
    quat_wxyz: Any = None,
    *,
    free_axis: str | None = None,
    constraints: Constraints | Mapping[str, Any] | None = None,
    environment: Environment | Mapping[str, Any] | None = None,
    starts: int = STARTS,
    curve_step: float = STEP,
    seed: int = 0,
    device: str = "auto",
    threads: int | None = None,
) -> Postures:
    """All configurations of a pose ``position_m`` (3,) [m], ``quat_wxyz`` (4,) in the world, or of N, a row each.

    A single orientation is that of all positions; poses may be transforms (N, 4, 4) or (4, 4), too.
    ``robot`` is a Robot, a user-defined robot or what `load_robot` takes. Without ``quat_wxyz`` any orientation will
    do; with a ``free_axis`` "x", "y" or "z" of the tip it may turn about that as it likes. ``constraints`` and
    ``environment`` are those of a job document, or their parts of one: they say of each posture whether it is free.
    ``starts``: of the search for postures of a pose, where no closed form knows them all; ``curve_step``: between
    points of self-motions [rad or reaches].

    Raises InputError, DocumentError, ModelError.

    >>> held = ws.postures("ur5e", [0.4, 0.2, 0.3], [0, 1, 0, 0])
    >>> held.configurations.shape, held.complete.tolist()
    ((8, 6), [True])
    """
    subject = as_robot(robot)
    position_m, quat_wxyz = position_and_quaternion(position_m, quat_wxyz, ("position_m", "quat_wxyz"))
    T = poses_of(position_m, quat_wxyz)
    if free_axis is not None and (free_axis not in AXES or quat_wxyz is None):
        given = f"{free_axis!r} is not allowed; {', '.join(AXES)}, or None"
        raise InputError("free_axis", given if quat_wxyz is not None else "must not be given without quat_wxyz")
    choice = Constraints(**constraints) if isinstance(constraints, Mapping) else constraints
    around = Environment(**environment) if isinstance(environment, Mapping) else environment
    if argument("curve_step", positive, curve_step) > LARGEST_STEP:
        raise InputError("curve_step", f"{curve_step:g} is not allowed; {LARGEST_STEP:g} rad or reaches at most")
    solver = PostureSolver(
        subject.chain,
        **kind_of(quat_wxyz, free_axis),
        starts=starts,
        curve_step=curve_step,
        seed=seed,
        device=device,
        threads=threads,
    )
    return solver.solve(T, constraints=constraints_for(subject, choice, around))


def kind_of(quat_wxyz: Any, free_axis: str | None) -> dict[str, str]:
    """What a `PostureSolver` is asked for."""
    if quat_wxyz is None or free_axis is None:
        return {"kind": "position" if quat_wxyz is None else "pose"}
    return {"kind": "axis", "free_axis": free_axis}


def poses_of(position_m: Any, quat_wxyz: Any = None) -> np.ndarray:
    """Poses (N, 4, 4) of positions (N, 3) [m] and quaternions (N, 4) of unit length. Raises InputError."""
    position = rows_of(position_m, 3, "position_m")
    T = np.tile(np.eye(4), (len(position), 1, 1))
    T[:, :3, 3] = position
    if quat_wxyz is not None:
        quat = rows_of(quat_wxyz, 4, "quat_wxyz")
        quat = np.repeat(quat, len(position), axis=0) if len(quat) == 1 else quat
        if len(quat) != len(position):
            raise InputError("quat_wxyz", f"has {len(quat)} rows for {len(position)} of position_m")
        length = np.linalg.norm(quat, axis=1)
        if (off := np.abs(length - 1) > UNIT).any():
            row = int(np.argmax(off))
            raise InputError("quat_wxyz", f"row {row} has length {length[row]:.6g}; unit length is needed")
        T[:, :3, :3] = rotations(quat, len(position))
    return T


def _wound(q: np.ndarray, least: np.ndarray, most: np.ndarray) -> Iterator[np.ndarray]:
    """A configuration (n,) moved by all whole turns from ``least`` to ``most`` (n,), itself first."""
    for turns in product(*(sorted(range(a, b + 1), key=abs) for a, b in zip(least, most, strict=True))):
        yield q + TURN * np.array(turns)


def _joined(name: str, parts: Sequence[Postures]) -> Any:
    values = [getattr(part, name) for part in parts]
    if name == "curves":
        return tuple(curve for curves in values for curve in curves)
    return values[0] if name == "evidence" else np.concatenate(values)
