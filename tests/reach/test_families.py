"""Families of singular poses, decided and listed by their ends: against curves traced along null vectors."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.reach.test_closed_labels import ACCURACY, solver
from tests.reference.arms_by_axes import chain_of, frame
from wsrender.reach import inverse_solver
from wsrender.reach.evidence import REACHABLE
from wsrender.reach.posture_sets import PostureSolver
from wsrender.reach.posture_solver import PoseHolder
from wsrender.reach.self_motions import near_curve, traced

SHOULDER, ELBOW, FOREARM = 0.15, 0.4, 0.45


def elbow_arm():
    """Axis 1 upright, 2 and 3 level beside it; the centre of an orthogonal wrist in their plane."""
    z, y, x = np.eye(3)[::-1]
    center = [SHOULDER + ELBOW + FOREARM, 0, 0]
    points = np.array([[0, 0, 0], [SHOULDER, 0, 0], [SHOULDER + ELBOW, 0, 0], center, center, center], float)
    ends = np.full(6, np.pi)
    return chain_of([z, y, y, x, y, x], points, frame(z, np.array([1.05, 0.02, 0.0])), -ends, ends)


def polar_arm():
    """Axis 1 upright, 2 and 3 level, beside it, crossing each other; the wrist turns about that point like a globe."""
    x, y, z = np.eye(3)
    aside = (x + z) / np.sqrt(2)
    center = [SHOULDER, 0, FOREARM]
    points = np.array([[0, 0, 0], [SHOULDER, 0, 0], [SHOULDER, 0, 0], center, center, center], float)
    ends = np.full(6, np.pi)
    return chain_of([z, y, x, aside, y, aside], points, frame(z, np.array([SHOULDER, 0.02, 0.6])), -ends, ends)


def library(name):
    return lambda: ws.load_robot(name).chain


def in_line(q):
    q[4] = 0.0


def in_line_the_other_way(q):
    q[4] = np.pi


def center_on_axis_1(q):
    """Of the elbow arm: the forearm leads back over the base."""
    over = (SHOULDER + ELBOW * np.cos(q[1])) / FOREARM
    if abs(over) > 1:
        q[1] = np.sign(q[1]) * np.arccos((0.9 * FOREARM - SHOULDER) / ELBOW)
        over = 0.9
    q[2] = np.arccos(-over) - q[1]


def center_on_axis_2(q):
    """Of the polar arm."""
    q[2] = np.pi / 2


CASES = {
    "ur5e, wrist": (library("ur5e"), in_line),
    "ur5e, wrist turned": (library("ur5e"), in_line_the_other_way),
    "puma560, wrist": (library("puma560"), in_line),
    "elbow arm, wrist turned": (elbow_arm, in_line_the_other_way),
    "elbow arm, axis 1": (elbow_arm, center_on_axis_1),
    "polar arm, axis 2": (polar_arm, center_on_axis_2),
}


def narrowed(case, random, count, beyond):
    """An arm with limits about a singular configuration, and ``count`` such (N, 6), some ``beyond`` the limits."""
    make, singular = CASES[case]
    chain, middle, half = make(), random.uniform(-np.pi, np.pi, 6), random.uniform(0.05, 1.2, 6)
    singular(middle)
    q = middle + random.uniform(-1, 1, (count, 6)) * half * beyond
    for row in q:
        singular(row)
    return replace(chain, lower_limits=middle - half, upper_limits=middle + half), q


def beyond_limits(arm, points):
    """How far points (P, 6) of a curve are outside the limits at least, below 0 where one is inside [rad]."""
    middle, half = (arm.lower_limits + arm.upper_limits) / 2, (arm.upper_limits - arm.lower_limits) / 2
    return (np.abs(np.remainder(points - middle + np.pi, 2 * np.pi) - np.pi) - half).max(axis=1).min()


def curves_of(arm, q):
    """Of each configuration (N, 6) the points of its self-motion, as if nothing limited it."""
    ends = {"lower_limits": np.full(6, -np.pi), "upper_limits": np.full(6, np.pi), "periodic": np.ones(6, bool)}
    free = replace(arm, **ends)
    return [points for points, _, _ in traced(PoseHolder(free, "pose"), q, free.poses(q), 0.05)]


@pytest.mark.parametrize("case", CASES)
def test_labels_of_singular_poses_need_no_search(case, monkeypatch):
    random, decided = np.random.default_rng(len(case)), []
    monkeypatch.setattr(inverse_solver, "_groups", lambda kind: iter(()))
    for _ in range(3):
        arm, q = narrowed(case, random, 24, 1.3)
        T = arm.poses(q)
        found = solver(arm).solve(T[:, :3, 3], T[:, :3, :3])
        beyond = np.array([beyond_limits(arm, points) for points in curves_of(arm, q)])
        assert (found.label[beyond < -1e-6] == REACHABLE).all()
        assert not (found.proven & (beyond < 0)).any()
        off = beyond > 0.1
        decided.append(np.stack([off, off & (found.label == REACHABLE), off & found.proven]))
        assert not (found.label[found.proven] == REACHABLE).any()
        back = arm.poses(found.q[found.label == REACHABLE])
        assert np.abs(back - T[found.label == REACHABLE]).max(initial=0) < 2 * ACCURACY["position_m"]
    off, elsewhere, proven = np.concatenate(decided, axis=1).sum(axis=1)
    assert off > 5 and proven > 0.85 * (off - elsewhere)  # others are on a fold of another branch, or close to one


@pytest.mark.parametrize("case", CASES)
def test_nothing_close_to_a_reached_member_is_proven_out_of_reach(case):
    """At limits, and beside families, by moves within the tolerances."""
    random = np.random.default_rng(1)
    for tolerance in (1e-4, 1e-5, 1e-7):
        for _ in range(2):
            arm, q = narrowed(case, random, 2000, 1.0)
            at_limit = random.random(q.shape) < 0.3
            for k in (0, 1, 3, 5):
                ends = np.where(random.random(len(q)) < 0.5, arm.lower_limits[k], arm.upper_limits[k])
                q[:, k] = np.where(at_limit[:, k], ends, q[:, k])
            for row in q:
                CASES[case][1](row)
            q = np.clip(
                q + random.choice([0, 1e-9, 1e-6, 1e-4], (len(q), 1)) * random.normal(size=q.shape),
                arm.lower_limits,
                arm.upper_limits,
            )
            T, closed = arm.poses(q), solver(arm, position_m=tolerance, angle_rad=tolerance).closed
            away, about = (random.normal(size=(len(T), 3)) for _ in range(2))
            away, about = (tolerance * v / np.linalg.norm(v, axis=1, keepdims=True) for v in (away, about))
            turned = Rotation.from_rotvec(about).as_matrix() @ T[:, :3, :3]
            assert not closed.unreachable(T[:, :3, 3] + away, turned).any()


@pytest.mark.parametrize("case", CASES)
def test_postures_give_families_whole_and_without_a_search(case, monkeypatch):
    """Every point of the traced curve that is within the limits is on a curve that is given."""
    random, whole, seen = np.random.default_rng(2), [], 0
    monkeypatch.setattr(PostureSolver, "_searched", lambda self, T, at: (np.zeros(0, int), np.zeros((0, 6))))
    for _ in range(2):
        arm, q = narrowed(case, random, 8, 1.2)
        found = PostureSolver(arm, device="cpu").solve(arm.poses(q))
        whole.append(found.complete)
        assert found.residual_m.max(initial=0) < 1e-9 and found.residual_rad.max(initial=0) < 1e-9
        for k, points in enumerate(curves_of(arm, q)):
            inside = [row for row in points if beyond_limits(arm, row[None]) < -1e-3]
            if not inside:
                continue
            own = [curve for curve in found.curves if curve and curve.pose == k]
            holder = PoseHolder(arm, "pose")
            off = [near_curve(holder, curve.configurations, curve.closed, np.array(inside)) for curve in own]
            assert np.min(off, axis=0).max() < 0.02
            assert found.family[found.pose == k].any()
            seen += 1
    assert seen > 3 and np.concatenate(whole).mean() > 0.85


def coaxial_arm():
    """A slide along axis 1, and a wrist of one axis about a point on it: singular everywhere."""
    rows = [{"limits_deg": [-170, 170]}, {"joint": "prismatic", "limits": [-0.1, 0.4]}]
    rows.append({"alpha_deg": -90, "theta_deg": -100, "limits_deg": [50, 75]})
    return ws.load_robot(ws.DHTable(convention="modified", rows=rows)).chain


def slide_between_parallel_axes():
    """Axes 1, 3 and 4 and the slide between them are parallel: singular everywhere."""
    rows = [{"limits_deg": [30, 310]}, {"a": 0.46, "joint": "prismatic", "limits": [-0.1, 0.3]}, {}]
    rows += [{"d": -0.17}, {"alpha_deg": 90}, {"alpha_deg": -90}]
    return ws.load_robot(ws.DHTable(convention="modified", rows=rows)).chain


@pytest.mark.parametrize("made", [coaxial_arm, slide_between_parallel_axes])
def test_postures_that_are_folds_of_a_family_are_searched_for(made):
    """Its ends are then known to the root of rounding alone: they are no postures, nor proof that there are none."""
    chain = made()
    lower, upper = (
        np.where(np.isfinite(x), x, y) for x, y in ((chain.lower_limits, -np.pi), (chain.upper_limits, np.pi))
    )
    q = np.random.default_rng(1).uniform(lower, upper, (6, chain.n))
    found = PostureSolver(chain, device="cpu").solve(chain.poses(q))
    assert set(found.pose) == set(range(6))
    assert not found.complete.any()
