"""A sampled loop that creates no energy: stiffness bounded, energy observed, what leaks dissipated."""

import math

import numpy as np

from wsrender.documents.kinetostatics import HapticDevice
from wsrender.kinetostatics.passivity import stiffness_bound

SHARE = 0.9  # of the stiffness bound that is rendered
VIRTUAL_SHARE = 0.5  # of the device's damping, which viscosity and injected damping may add together


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
