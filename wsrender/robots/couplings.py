"""Joints that follow other joints: MJCF joint equalities and URDF mimic joints.

A coupling is MuJoCo's: y − y₀ = a₀ + a₁(x − x₀) + … + a₄(x − x₀)⁴, with y the follower, x the leader and
y₀, x₀ their values in ``qpos0``. All displacements below are these differences.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import mujoco
import numpy as np

from wsrender.errors import ModelError

_LONGEST_LINE = 64  # a follower of a follower of …


@dataclass(frozen=True)
class Coupling:
    """Displacement of a joint = polynomial (5 coefficients, a₀ first) of that of ``leader`` (None: of 0)."""

    leader: int | None
    coefficients: tuple[float, ...]

    @property
    def linear(self) -> bool:
        """Whether the displacement is a₀ + a₁ x."""
        return not any(self.coefficients[2:])


class Couplings:
    """The active joint couplings of a model; raises ModelError for cycles and for joints led twice."""

    def __init__(self, model: mujoco.MjModel, field: str):
        self._model, self._field = model, field
        self._by_follower: dict[int, Coupling] = {}
        for equality in np.flatnonzero((model.eq_type == mujoco.mjtEq.mjEQ_JOINT) & model.eq_active0):
            self._add(int(equality))
        for joint in self._by_follower:
            self._line(joint)

    def leader(self, joint: int) -> int | None:
        """The joint that decides over ``joint`` in the end: itself if free, None if it is held."""
        last = self._line(joint)[-1]
        return None if last in self._by_follower else last

    def linear(self, joint: int) -> tuple[float, float]:
        """(scale, offset) of the displacement of ``joint`` against that of its leader (of 0 if held).

        Raises ModelError where a coupling on the way is not linear.
        """
        scale, offset = 1.0, 0.0
        for coupling in self._couplings(joint):
            if not coupling.linear:
                raise ModelError(
                    self._field,
                    f"joint {self._name(joint)} follows another joint by a polynomial of higher degree; "
                    "only linear couplings are supported on the chain",
                )
            constant, slope = coupling.coefficients[:2]
            scale, offset = slope * scale, slope * offset + constant
        return scale, offset

    def reference_qpos(self, given: Mapping[int, float]) -> np.ndarray:
        """``qpos0`` with joints at values ``given`` [rad or m], and every follower where its leaders put it, (nq,)."""
        qpos, addresses = np.array(self._model.qpos0), self._model.jnt_qposadr
        for joint, value in given.items():
            qpos[addresses[joint]] = value
        for joint in self._by_follower:
            leader = self.leader(joint)
            at = None if leader is None else addresses[leader]
            displacement = 0.0 if at is None else qpos[at] - self._model.qpos0[at]
            for coupling in self._couplings(joint):
                displacement = np.polynomial.polynomial.polyval(displacement, coupling.coefficients)
            qpos[self._model.jnt_qposadr[joint]] += displacement
        return qpos

    def _couplings(self, joint: int) -> list[Coupling]:
        """The couplings from the deciding joint down to ``joint``."""
        line = self._line(joint)
        return [self._by_follower[follower] for follower in reversed(line) if follower in self._by_follower]

    def _line(self, joint: int) -> list[int]:
        """``joint``, its leader, the leader's leader, … to the last."""
        line = [joint]
        while (coupling := self._by_follower.get(line[-1])) is not None and coupling.leader is not None:
            if coupling.leader in line:
                raise ModelError(self._field, f"the couplings of joint {self._name(joint)} form a cycle")
            if len(line) == _LONGEST_LINE:
                raise ModelError(self._field, f"joint {self._name(joint)} follows too many joints in turn")
            line.append(coupling.leader)
        return line

    def _add(self, equality: int) -> None:
        follower, leader = int(self._model.eq_obj1id[equality]), int(self._model.eq_obj2id[equality])
        if follower in self._by_follower:
            raise ModelError(self._field, f"joint {self._name(follower)} follows two joints")
        coefficients = tuple(self._model.eq_data[equality, :5].tolist())
        self._by_follower[follower] = Coupling(leader if leader >= 0 else None, coefficients)

    def _name(self, joint: int) -> str:
        return repr(self._model.joint(joint).name)


def refuse_loops(model: mujoco.MjModel, carrier: np.ndarray, field: str) -> None:
    """Raises ModelError for an active equality that ties bodies carried by different joints of the chain.

    ``carrier`` (nbody,) numbers the chain joint that carries each body, −1 for the base. Loops among bodies
    carried by one joint (a gripper) are fine, and so are mocap bodies, which are no part of the mechanism.
    """
    kinds = mujoco.mjtEq
    for equality in np.flatnonzero(model.eq_active0):
        kind = mujoco.mjtEq(model.eq_type[equality])
        if kind == kinds.mjEQ_JOINT:
            continue
        if kind in (kinds.mjEQ_CONNECT, kinds.mjEQ_WELD):
            bodies = _tied_bodies(model, int(equality))
        elif kind == kinds.mjEQ_TENDON:
            bodies = _tendon_bodies(model, int(equality))
        else:
            continue  # flexible bodies move no rigid ones
        if any(model.body_mocapid[body] >= 0 for body in bodies):
            continue
        if len({int(carrier[body]) for body in bodies}) > 1:
            name = model.equality(int(equality)).name
            names = ", ".join(sorted({model.body(body).name or "(unnamed)" for body in bodies}))
            what = f"equality {name!r} ties" if name else "an equality ties"
            remedy = (
                "name a base and tip off the loop, or describe its legs to the analysis parallel_workspace or five_bar"
            )
            raise ModelError(field, f"{what} {names} into a closed loop with the chain, which is not serial: {remedy}")


def _tied_bodies(model: mujoco.MjModel, equality: int) -> list[int]:
    ids = [int(model.eq_obj1id[equality]), int(model.eq_obj2id[equality])]
    if model.eq_objtype[equality] == mujoco.mjtObj.mjOBJ_SITE:
        return [int(model.site_bodyid[site]) for site in ids]
    return [max(body, 0) for body in ids]


def _tendon_bodies(model: mujoco.MjModel, equality: int) -> list[int]:
    """Bodies that the tendons of an equality run over, with the parents of the joints they couple."""
    wraps, bodies = mujoco.mjtWrap, []
    for tendon in (model.eq_obj1id[equality], model.eq_obj2id[equality]):
        if tendon < 0:
            continue
        first = int(model.tendon_adr[tendon])
        for wrap in range(first, first + int(model.tendon_num[tendon])):
            kind, item = mujoco.mjtWrap(model.wrap_type[wrap]), int(model.wrap_objid[wrap])
            if kind == wraps.mjWRAP_JOINT:
                body = int(model.jnt_bodyid[item])
                bodies += [body, int(model.body_parentid[body])]
            elif kind == wraps.mjWRAP_SITE:
                bodies.append(int(model.site_bodyid[item]))
            elif kind in (wraps.mjWRAP_SPHERE, wraps.mjWRAP_CYLINDER):
                bodies.append(int(model.geom_bodyid[item]))
    return bodies
