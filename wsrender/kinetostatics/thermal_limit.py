"""The force that a device can hold over time: a first-order model of its motors' temperature."""

import math

import numpy as np

from wsrender.documents.kinetostatics import HapticDevice

FADE = 0.2  # of the bearable heat, before its end, over which the limit sinks from the peak to the continuous force


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
