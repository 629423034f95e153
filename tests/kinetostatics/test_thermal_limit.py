"""The continuous force: peak from cold, continuous for ever."""

import numpy as np
import pytest

from wsrender.documents.kinetostatics import HapticDevice
from wsrender.kinetostatics.passivity import ThermalLimit

DEVICE = HapticDevice()
PUSH = np.array([0.0, 0.0, 6.4])


def test_the_peak_is_held_for_the_stated_time_and_then_the_continuous_force():
    limit = ThermalLimit(DEVICE)
    forces = np.array([limit.limited(PUSH, 0.001)[2] for _ in range(20_000)])
    held = -10 * np.log(1 - 0.8 * 1.4**2 / 6.4**2)
    assert np.count_nonzero(forces == 6.4) * 0.001 == pytest.approx(held, rel=0.01)
    assert forces[-1] == pytest.approx(1.4, abs=1e-3)
    assert np.abs(np.diff(forces)).max() < 0.1  # nothing snaps


@pytest.mark.parametrize("dt", [0.001, 1.0, 30.0])
def test_the_heat_never_exceeds_that_of_the_continuous_force(dt):
    limit = ThermalLimit(DEVICE)
    heat = 0.0
    for _ in range(3000):
        force = limit.limited(PUSH, dt)
        heat += (1 - np.exp(-dt / 10)) * (force @ force - heat)
        assert heat <= 1.4**2 * (1 + 1e-12)


def test_it_recovers():
    limit = ThermalLimit(DEVICE)
    for _ in range(20_000):
        limit.limited(PUSH, 0.001)
    for _ in range(60):
        limit.limited(np.zeros(3), 1.0)
    assert limit.limited(PUSH, 0.001) == pytest.approx(PUSH)
