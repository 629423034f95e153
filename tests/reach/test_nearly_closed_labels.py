"""Chains that miss a class of closed forms by little, against forward kinematics and the numerical solver."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.engine.test_closed_form import anywhere, apart, near_limits
from tests.reference.arms_by_axes import PARALLEL, RELATIONS, axes_of, chain_of, random_arm, reversed_chain
from tests.reference.redundant_arms import with_limits
from wsrender.engine import Accuracy
from wsrender.reach import InverseSolver
from wsrender.reach.evidence import REACHABLE, UNDECIDED, UNREACHABLE
from wsrender.reach.nearly_closed_labels import NearlyClosedLabels
from wsrender.reach.placements import PlacedAdmission, Placements
from wsrender.reach.posture_sets import PostureSolver
from wsrender.robots.closed_form import ClosedForm, NearlyClosedForm, form_of
from wsrender.robots.moving_base import MovingBase

KINDS = (RELATIONS[0], *RELATIONS[2:4], PARALLEL)
ARMS = [(kind, back) for kind in KINDS for back in (False, True)]
EXACT = Accuracy(1e-9, 1e-9, 0.5)


def off(chain, turn=2e-6, move=1e-6, seed=1):
    """The chain with its axes turned [rad] and moved [m] by about so much, any way."""
    h, o, T_tip = axes_of(chain)
    random = np.random.default_rng(seed)
    h = h + turn * random.normal(size=h.shape) / 2
    h /= np.linalg.norm(h, axis=1, keepdims=True)
    return chain_of(h, o + move * random.normal(size=o.shape) / 2, T_tip, chain.lower_limits, chain.upper_limits)


def nearly(kind, back, seed=5):
    chain = off(random_arm(kind, seed))
    return reversed_chain(chain) if back else chain


@pytest.mark.parametrize(("kind", "back"), ARMS)
def test_poses_of_the_chain_beside_differ_by_no_more_than_is_said(kind, back):
    for seed in range(4):
        chain = nearly(kind, back, seed)
        form = NearlyClosedForm.of(chain)
        q = np.random.default_rng(seed).uniform(-np.pi, np.pi, (2000, 6))
        here, there = chain.poses(q), form.rest.chain.poses(q)
        moved = np.linalg.norm((here - there)[:, :3, 3], axis=1).max()
        turned = Rotation.from_matrix(here[:, :3, :3] @ there[:, :3, :3].transpose(0, 2, 1)).magnitude().max()
        assert form.off_m / 10 < moved < form.off_m
        assert form.off_rad / 10 < turned < form.off_rad or form.off_rad < 1e-11
        assert (
            form.rest.name
            == ClosedForm.of(reversed_chain(random_arm(kind, seed)) if back else random_arm(kind, seed)).name
        )


@pytest.mark.parametrize(("kind", "back"), ARMS)
def test_made_poses_are_reached_and_what_is_called_unreachable_no_posture_reaches(kind, back):
    chain = nearly(kind, back)
    solver, searching = InverseSolver(chain, kind="pose"), InverseSolver(chain, kind="pose")
    searching.closed = None
    assert isinstance(solver.closed, NearlyClosedLabels)
    for q in (anywhere(chain, 1000), near_limits(chain, 1000)):
        T = chain.poses(q)
        found = solver.solve(T[:, :3, 3], T[:, :3, :3])
        assert (found.label == REACHABLE).mean() > 0.999 and not found.proven.any()
        at = found.label == REACHABLE
        assert chain.poses(found.q[at]) == pytest.approx(T[at], abs=1e-5)
    free = with_limits(chain, np.full(6, -np.pi), np.full(6, np.pi))
    T = free.poses(anywhere(free, 2000))
    found, expected = (each.solve(T[:, :3, 3], T[:, :3, :3]) for each in (solver, searching))
    assert found.proven.sum() > 100 and not (found.proven & (expected.label == REACHABLE)).any()
    assert not ((expected.label == REACHABLE) & (found.label != REACHABLE)).any()


def test_without_what_the_chains_differ_by_reached_poses_would_be_called_unreachable():
    chain = nearly(PARALLEL, False)
    form, T = NearlyClosedForm.of(chain), chain.poses(near_limits(chain, 4000))
    asked = T[:, :3, 3], T[:, :3, :3]
    assert not NearlyClosedLabels(form, EXACT, "cpu", None).unreachable(*asked).any()
    assert NearlyClosedLabels(replace(form, off_m=0.0, off_rad=0.0), EXACT, "cpu", None).unreachable(*asked).any()


def test_all_doors_say_the_same_and_never_that_a_target_is_reached():
    chain = nearly(RELATIONS[2], False)
    free = with_limits(chain, np.full(6, -np.pi), np.full(6, np.pi))
    T = free.poses(anywhere(free, 500))
    labels = NearlyClosedLabels(NearlyClosedForm.of(chain), EXACT, "cpu", None)
    found = labels.labels(T[:, :3, 3], T[:, :3, :3])
    assert set(found) == {UNDECIDED, UNREACHABLE}
    quat = Rotation.from_matrix(T[:, :3, :3]).as_quat(scalar_first=True)
    assert (labels.labels_by_quaternions(T[:, :3, 3], quat) == found).all()
    assert (labels.labels_from(T[:250], np.eye(4)[None]) == found[:250]).all()
    assert (labels.labels_from(np.eye(4)[None], T) == found).all()


@pytest.mark.parametrize(("kind", "back"), ARMS)
def test_sets_hold_what_made_the_pose_and_all_that_a_search_finds(kind, back):
    chain = nearly(kind, back)
    solver, q = PostureSolver(chain, device="cpu"), anywhere(chain, 200)
    T = chain.poses(q)
    found = solver.solve(T)
    nearest = np.full(len(q), np.inf)
    np.minimum.at(nearest, found.pose, apart(chain, q[found.pose], found.configurations))
    assert (nearest < 1e-6).all() and found.complete.mean() > 0.6
    assert max(found.residual_m.max(), found.residual_rad.max()) <= 1e-9
    searching = PostureSolver(chain, device="cpu")
    searching.form = None
    some = np.flatnonzero(found.complete)[:20]
    others = searching.solve(T[some])
    for pose, other in zip(some[others.pose], others.configurations, strict=True):
        assert apart(chain, found.configurations[found.pose == pose], other).min() < 1e-6


def test_which_chains_are_nearly_closed():
    exact = random_arm(PARALLEL, 0)
    assert isinstance(form_of(exact), ClosedForm)
    assert isinstance(form_of(off(exact)), NearlyClosedForm)
    assert form_of(off(exact, turn=1e-4)) is None


def ur(off):
    """A table of a UR's kind, its axes off by [m, and some of that in degrees]."""
    rows = [
        (3 * off, 90, 0.09),
        (-0.425, off, 0),
        (-0.392, -off, 0.11),
        (2 * off, 90, 0.1),
        (off, -90, 0.09),
        (0, 0, 0.08),
    ]
    rows = [ws.DHRow(a=a, alpha_deg=alpha, d=d, theta_deg=0, limits_deg=(-350, 350)) for a, alpha, d in rows]
    return ws.load_robot(ws.DHTable(convention="standard", name="calibrated", rows=tuple(rows)))


def test_a_calibrated_robot():
    robot, exact = ur(1e-6), ur(0)
    assert exact.closed_form == "three parallel axes"
    assert robot.closed_form.startswith("three parallel axes, but for ")
    at = [0.4, 0.2, 0.3], [0.5, 0.5, -0.5, 0.5]
    found = ws.reachable(robot, [at[0], [0.95, 0.0, 0.0]], orientations=[at[1]] * 2)
    assert found.labels.tolist() == ["reachable", "unreachable"] and found.proven.tolist() == [False, True]
    held, expected = ws.postures(robot, *at), ws.postures(exact, *at)
    assert len(held) == len(expected) == 8 and held.complete.all() and held.count == expected.count
    assert "three parallel axes, but for" in held.evidence


def test_configurations_from_placements_reach_the_pose_itself():
    """They are tried from those of the arm nearby, which are not taken to be all."""
    chain = nearly(RELATIONS[0], False)
    own = InverseSolver(chain, kind="pose", position_m=1e-7, angle_rad=1e-7)
    assert isinstance(own.closed, NearlyClosedLabels)
    T = chain.poses(chain.within(0.3 + 0.4 * np.random.default_rng(1).random((20, chain.n))))
    base = MovingBase(np.zeros(6), np.zeros(6), chain.T_world_base)
    search = Placements(own, base, T, PlacedAdmission(chain, ()))
    q, ok, every = search.solutions(np.arange(20), np.zeros((1, 6)), np.eye(4)[None])
    pose, _ = np.nonzero(ok)
    assert ok.any(axis=1).all() and not every.any()
    assert np.abs(chain.poses(q[ok]) - T[pose]).max() < 1e-6
