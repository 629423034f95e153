"""Reachable volumes against exact ones (DEFINITIONS section 6), single robots and pairs."""

import numpy as np
import pytest

import wsrender as ws
from tests.run.simple_robots import gantry, planar_arm
from wsrender.reachability import Event, refined_volume, refined_volumes

SPHERICAL = np.pi / 2 * np.sqrt(2) * (0.4**3 - 0.2**3) / 3
EXACT = {  # m³, and what the value itself may be off
    "articulated": (0.03348, 5e-6),
    "spherical": (SPHERICAL, 0.0),
    "gao_6r": (0.403721, 0.0005 * 0.403721),
}


@pytest.mark.parametrize("name", EXACT)
def test_exact_volumes(name):
    exact, rounding = EXACT[name]
    estimate, found = refined_volume(ws.load_robot(name).chain, 0.005)
    assert estimate.met
    assert estimate.low - rounding <= exact <= estimate.high + rounding
    assert estimate.high - estimate.low <= 2 * 0.005 * estimate.value
    (tried,) = found.false_negatives
    assert tried.tested > 1000
    assert tried.rate < 1e-3


def test_interval_holds_the_volume_whatever_the_seed():
    chain = ws.load_robot("spherical").chain
    estimates = [refined_volume(chain, 0.02, seed=seed)[0] for seed in range(6)]
    assert sum(e.low <= SPHERICAL <= e.high for e in estimates) >= 5
    assert len({e.value for e in estimates}) == 6


def test_pair_of_articulated_arms():
    pair = [ws.load_robot("articulated", placement=ws.Transform(position_m=(x, 0, 0.4))).chain for x in (0.1, -0.1)]
    events = {"any": Event(1, 2), "all": Event(2, 2), "exactly_1": Event(1, 1, precise=False)}
    volumes = refined_volumes(pair, events, 0.01).volumes
    for name, exact in {"any": 0.0542, "all": 0.0128}.items():
        assert volumes[name].low - 5e-5 <= exact <= volumes[name].high + 5e-5  # published to 1e-4
        assert volumes[name].met
    assert volumes["exactly_1"].value == pytest.approx(volumes["any"].value - volumes["all"].value)


def test_a_box():
    estimate, _ = refined_volume(gantry().chain, 0.01)
    exact = 0.29 * 0.39 * 0.19
    assert estimate.low <= exact <= estimate.high


@pytest.mark.parametrize(
    "chain", [planar_arm().chain, ws.load_robot("slave_5r").chain], ids=["in a plane", "on a sphere"]
)
def test_planes_and_surfaces_have_no_volume(chain):
    estimate, found = refined_volume(chain, 0.01)
    assert (estimate.value, estimate.low, estimate.high) == (0.0, 0.0, 0.0)
    assert found.points == 0


def test_same_seed_same_estimate_whatever_the_threads():
    chain = ws.load_robot("spherical").chain
    first, second = (refined_volume(chain, 0.02, seed=5, threads=threads)[0] for threads in (1, 2))
    assert first == second
