"""Energy of a rendered field: what stiffness a sampled loop can render, and what work a closed path does.

A loop of period T with zero-order hold renders a spring of stiffness K passively on a device of damping b if
b > K T / 2 (Colgate and Schenkel, *Passivity of a class of sampled-data systems*, 1997).
"""

from dataclasses import dataclass

import numpy as np

from wsrender.kinetostatics.force_field import ForceField
from wsrender.spec.kinetostatics import HapticDevice

POSTURES, LOOPS, STEPS = 256, 48, 60
STRAY = 0.01  # of the path's size, beyond which the tip does not follow it
HAND_SPEED = 0.1  # m/s, at which a person explores a surface


@dataclass(frozen=True)
class LoopWork:
    """The largest net work [J] of the force on closed paths of the tip, among how many, and their length [m].

    ``damping_n_s_per_m`` dissipates as much on such a path at ``speed_m_per_s``.
    """

    work_j: float
    length_m: float
    paths: int
    speed_m_per_s: float = HAND_SPEED

    @property
    def damping_n_s_per_m(self) -> float:
        """Work / (speed × length) [N s/m]."""
        return self.work_j / (self.speed_m_per_s * self.length_m)


def stiffness_bound(device: HapticDevice, virtual_damping: float = 0.0) -> float:
    """2 (b − B) / T [N/m]: the stiffness below which a loop with virtual damping B [N s/m] creates no energy."""
    return 2 * max(device.damping_n_s_per_m - virtual_damping, 0.0) / device.period_s


def stiffnesses(field: ForceField, postures: int = POSTURES, seed: int = 0) -> np.ndarray:
    """‖∂F/∂x‖ [N/m] at random postures (postures,), in half of which a joint stands in its ramp.

    Between them a field may be stiffer: at singular postures its force turns round within no distance.
    """
    rows = random_postures(field, postures, np.random.default_rng(seed))
    return np.array([np.linalg.norm(field.stiffness(q), 2) for q in rows])


def largest_loop_work(field: ForceField, loops: int = LOOPS, seed: int = 0) -> LoopWork:
    """Net work on random circles of the tip, q̇ = J⁺ ẋ along them, the larger of both senses.

    Zero for the form "potential" where it is not clipped at the device's peak and the joints of a redundant arm come
    back. Circles have a twentieth of the characteristic length or the reach as radius, whichever is less; those that
    the tip cannot follow are left out.
    """
    random = np.random.default_rng(seed)
    radius = 0.05 * min(field.length.length_m, field.chain.reach)
    works = []
    for q in random_postures(field, loops, random):
        directions = field.kinematics.at(q).J[:3] @ random.normal(size=(field.chain.n, 2))  # where the tip can go
        plane = np.linalg.qr(directions)[0]
        work = loop_work(field, q, plane * radius)
        works += [] if work is None else [abs(work)]
    return LoopWork(max(works, default=0.0), 2 * np.pi * radius, len(works))


def loop_work(field: ForceField, q: np.ndarray, plane: np.ndarray) -> float | None:
    """∮ F·dx [J] on the ellipse x + plane (cos φ − 1, sin φ), ``plane`` (3, 2) [m], from a configuration (n,).

    By the trapezoidal rule on what the tip really does; None where it strays from the path.
    """
    start = field.kinematics.at(q).position
    state, work = field.evaluate(q), 0.0
    for angle in 2 * np.pi * np.arange(1, STEPS + 1) / STEPS:
        target = start + plane @ [np.cos(angle) - 1, np.sin(angle)]
        for _ in range(2):  # Newton steps: the second corrects the first
            posture = field.kinematics.at(q)
            q = q + field.inverse_jacobian(posture)[:, :3] @ (target - posture.position)
        following = field.evaluate(q)
        if np.linalg.norm(following.posture.position - target) > STRAY * np.linalg.norm(plane):
            return None
        work += float((state.force + following.force) @ (following.posture.position - state.posture.position)) / 2
        state = following
    return work


def random_postures(field: ForceField, count: int, random: np.random.Generator) -> np.ndarray:
    """Random configurations (count, n); in half of them one joint is within the ramp before a limit."""
    chain = field.chain
    q = random.uniform(chain.lower_limits, chain.upper_limits, (count, chain.n))
    for row in q[::2]:
        joint = random.integers(chain.n)
        depth = random.uniform() * min(field.joint_limits.margin[joint], chain.upper_limits[joint] - row[joint])
        row[joint] = chain.upper_limits[joint] - depth
    return q
