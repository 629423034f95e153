"""Energy of a rendered field: what a sampled loop can render, what a closed path does, and what a device can hold.

A loop of period T with zero-order hold renders a spring of stiffness K passively on a device of damping b if
b > K T / 2 (Colgate and Schenkel, *Passivity of a class of sampled-data systems*, 1997).
"""

import math
from dataclasses import dataclass

import numpy as np

from wsrender.documents.kinetostatics import HapticDevice
from wsrender.kinetostatics.force_fields import ForceField

POSTURES, LOOPS, STEPS = 256, 48, 60
STRAY = 0.01  # of the path's size, beyond which the tip does not follow it
HAND_SPEED = 0.1  # m/s, at which a person explores a surface
SHARE = 0.9  # of the stiffness bound that is rendered
VIRTUAL_SHARE = 0.5  # of the device's damping, which viscosity and injected damping may add together
FADE = 0.2  # of the bearable heat, before its end, over which the limit sinks from the peak to the continuous force


@dataclass(frozen=True)
class PathWork:
    """Energies [J] of a field along a path.

    ``work_j`` = ∫ F·dx of the force on the tip, with the torque of a wrench device; ``peak_j`` = ∫ F_peak ds.
    ``energy_j``: by how much the potential energy U rises, ``clipped_j`` = ∫ |(F before the clipping − F)·dx|,
    ``hidden_j`` = ∫ |F·dx + dU| with the force before the clipping: what damping near singular postures and
    self-motions of a redundant arm do. These are of the form "potential"; the other has no energy.
    """

    work_j: float
    peak_j: float
    energy_j: float = 0.0
    clipped_j: float = math.inf
    hidden_j: float = math.inf

    @property
    def bound_j(self) -> float:
        """What the work is at most, either way: all of the peak, or what U, clipping and damping can give."""
        return min(self.peak_j, abs(self.energy_j) + self.clipped_j + self.hidden_j)


@dataclass(frozen=True)
class LoopWork:
    """The largest net work [J] of the force on closed paths of the tip, among how many, and their length [m].

    ``bound_j`` [J] is the largest `PathWork.bound_j` of them, ``clipped`` the share of the paths on which a force of
    the form "potential" was clipped. ``damping_n_s_per_m`` dissipates as much on such a path at ``speed_m_per_s``.
    """

    work_j: float
    length_m: float
    paths: int
    bound_j: float = 0.0
    clipped: float = 0.0
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
    found = []
    for q in random_postures(field, loops, random):
        directions = field.kinematics.at(q).J[:3] @ random.normal(size=(field.chain.n, 2))  # where the tip can go
        path = loop_path(field, q, np.linalg.qr(directions)[0] * radius)
        found += [] if path is None else [path_work(field, path)]
    most = max((abs(each.work_j) for each in found), default=0.0)
    bound = max((each.bound_j for each in found), default=0.0)
    clipped = sum(0 < each.clipped_j < math.inf for each in found) / max(len(found), 1)
    return LoopWork(most, 2 * np.pi * radius, len(found), bound, clipped)


def loop_work(field: ForceField, q: np.ndarray, plane: np.ndarray) -> float | None:
    """∮ F·dx [J] on the ellipse x + plane (cos φ − 1, sin φ), see `loop_path`; None where the tip strays from it."""
    path = loop_path(field, q, plane)
    return None if path is None else path_work(field, path).work_j


def loop_path(field: ForceField, q: np.ndarray, plane: np.ndarray) -> np.ndarray | None:
    """Configurations (STEPS + 1, n) of the tip on the ellipse x + plane (cos φ − 1, sin φ), ``plane`` (3, 2) [m].

    From a configuration (n,); None where the tip strays from the path.
    """
    start, path = field.kinematics.at(q).position, [q]
    for angle in 2 * np.pi * np.arange(1, STEPS + 1) / STEPS:
        target = start + plane @ [np.cos(angle) - 1, np.sin(angle)]
        for _ in range(2):  # Newton steps: the second corrects the first
            posture = field.kinematics.at(q)
            q = q + field.inverse_jacobian(posture)[:, :3] @ (target - posture.position)
        if np.linalg.norm(field.kinematics.at(q).position - target) > STRAY * np.linalg.norm(plane):
            return None
        path.append(q)
    return np.array(path)


def path_work(field: ForceField, path: np.ndarray) -> PathWork:
    """Work and energies along a path of configurations (N, n), by the rule of the middle between two of them."""
    size, peak = 6 if field.is_wrench else 3, field.device.peak_force_n
    turning = np.array([1.0] * 3 + [field.length.length_m] * 3)[:size]
    work = length = clipped = hidden = 0.0
    energies = [field.evaluate(q).energy for q in path]
    for q, after, rise in zip(path[:-1], path[1:], np.diff(energies), strict=True):
        state = field.evaluate((q + after) / 2)
        moved = state.posture.J[:size] @ (after - q)
        done = float(np.concatenate([state.force, state.torque])[:size] @ moved)
        work, length = work + done, length + float(np.linalg.norm(moved * turning))
        clipped += abs(done) * state.clipped / peak
        hidden += abs(done * (1 + state.clipped / peak) + float(rise))
    if field.choice.form != "potential":
        return PathWork(work, peak * length)
    return PathWork(work, peak * length, energies[-1] - energies[0], clipped, hidden)


def random_postures(field: ForceField, count: int, random: np.random.Generator) -> np.ndarray:
    """Random configurations (count, n); in half of them one joint is within the ramp before a limit."""
    chain = field.chain
    q = random.uniform(chain.lower_limits, chain.upper_limits, (count, chain.n))
    for row in q[::2]:
        joint = random.integers(chain.n)
        depth = random.uniform() * min(field.joint_limits.margin[joint], chain.upper_limits[joint] - row[joint])
        row[joint] = chain.upper_limits[joint] - depth
    return q


class EnergyControl:
    """Between a field and a device; forces and motions are (3,), or (6,) with torque / L and L × rotation.

    The rendered force rises towards the field's no faster than K |Δx| per tick with K = 0.9 · 2 (b − B)/T, the
    stiffness that the device renders passively beside a virtual damping B = b/2 (Colgate and Schenkel 1997), and no
    faster than ``rise`` when it rests: after a pause it comes back smoothly.

    Energy is observed as in Hannaford and Ryu, *Time-domain passivity control of haptic interfaces*, 2002. What the
    device gives is stored, as far as the field can store it: up to its potential energy, nothing where it has no
    force. What it is given comes from there, or from what its own damping takes, b |Δx|²/T at least. Anything more was
    created, by sampling or by the normalised form, and is taken back by damping.
    """

    def __init__(self, device: HapticDevice, viscosity: float, rise: float):
        self._device, self._period = device, device.period_s
        virtual = VIRTUAL_SHARE * device.damping_n_s_per_m
        self.stiffness = SHARE * stiffness_bound(device, virtual)
        self._most = max(virtual - viscosity, 0.0)
        self._step = device.peak_force_n * self._period / rise
        self.most_created = 0.0
        self.reset(6 if device.kind == "wrench" else 3, 0.0)

    def reset(self, size: int, stored: float) -> None:
        """Start anew with no force, and with so much energy stored [J]."""
        self.rendered = np.zeros(size)
        self._stored = stored

    @property
    def created(self) -> float:
        """Energy that the loop has given and did not have [J]."""
        return max(-self._stored, 0.0)

    def observe(self, sent: np.ndarray, moved: np.ndarray, capacity: float) -> None:
        """Take in that the device moved while a force was held; ``capacity`` [J]: what the field can store there."""
        dissipated = self._device.damping_n_s_per_m * float(moved @ moved) / self._period
        self._stored = min(self._stored - float(sent @ moved) + dissipated, capacity)
        self.most_created = max(self.most_created, self.created)

    def approach(self, force: np.ndarray, moved: np.ndarray) -> np.ndarray:
        """The force towards the field's that the device can render, after it moved; it sinks at once."""
        before, size, wanted = self.rendered, math.sqrt(self.rendered @ self.rendered), math.sqrt(force @ force)
        if size > wanted:
            before = before * (wanted / size)
        change = force - before
        size, most = math.sqrt(change @ change), self.stiffness * math.sqrt(moved @ moved) + self._step
        self.rendered = force if size <= most else before + change * (most / size)
        return self.rendered

    def damping(self, force: np.ndarray, velocity: np.ndarray) -> float:
        """Damping [N s/m] to be added to a force while there is created energy to take back; 0 otherwise.

        As much as keeps the force from giving more, and what takes the rest back within a tick, as far as the device
        can render damping.
        """
        square = float(velocity @ velocity)
        if self.created == 0.0 or square == 0.0:
            return 0.0
        giving = max(float(force @ velocity), 0.0) / square
        return giving + min(self.created / (square * self._period), self._most)


class ThermalLimit:
    """Shortens forces so that the motors never get warmer than the continuous force F_c keeps them.

    Heat h [N²] follows the squared force, dh/dt = (F² − h)/τ, and must stay at or below F_c². The limit is F_peak while
    h ≤ 0.8 F_c² and sinks in squares to F_c at h = F_c², so that no step is felt. From cold the peak is held for
    −τ ln(1 − 0.8 F_c²/F_peak²), 0.39 τ/10 with the default device; afterwards F_c for ever.
    """

    def __init__(self, device: HapticDevice):
        self._peak, self._continuous = device.peak_force_n**2, device.continuous_force_n**2
        self._time = device.thermal_time_s
        self.heat = 0.0

    @property
    def limit(self) -> float:
        """Largest force [N] now."""
        share = min(max((self._continuous - self.heat) / (FADE * self._continuous), 0.0), 1.0)
        return math.sqrt(self._continuous + (self._peak - self._continuous) * share)

    def limited(self, force: np.ndarray, dt: float) -> np.ndarray:
        """The force (any length) [N] that is held for ``dt`` [s], shortened where it must be."""
        size, cooling = math.sqrt(force @ force), -math.expm1(-dt / self._time)
        # What the heat bears in this step, for steps that are long beside τ.
        bearable = math.sqrt(max(self._continuous - self.heat * (1 - cooling), 0.0) / cooling)
        most = min(self.limit, bearable)
        if size > most:
            force, size = force * (most / size), most
        self.heat += cooling * (size * size - self.heat)
        return force
