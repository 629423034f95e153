"""Sets of postures against those of EAIK (Ostermeier, Külz, Althoff 2025) and ssik, where they are installed."""

import importlib
from dataclasses import replace

import numpy as np
import pytest

import wsrender as ws
from tests.engine.test_closed_form import anywhere, apart, postures
from tests.reference.arms_by_axes import PARALLEL, RELATIONS, axes_of, chain_of, random_arm
from wsrender.robots.closed_form import ClosedForm

MISSING = "{} is not installed: extra test-models"
SSIK_POSES = 500
POSES, SAME, NEARLY_SINGULAR = 1000, 1e-6, 1e-3
LIBRARY = ("ur5e", "puma560", "phantom_omni")
SSIK = {
    "abb.irb120_ik": "axes 1 and 2 intersecting",
    "abb.irb1600_ik": "axes 2 and 3 parallel",
    "fanuc.lrmate200id_ik": "axes 2 and 3 parallel",
    "kuka.kr210_r2700_ik": "axes 2 and 3 parallel",
    "kuka.kr6_r900_ik": "axes 2 and 3 parallel",
    "staubli.rx160_ik": "axes 2 and 3 parallel",
    "unimation.puma560_ik": "axes 1 and 2 intersecting",
    "universal_robots.ur5e_ik": "three parallel axes",
    "universal_robots.ur10e_ik": "three parallel axes",
    "dobot.cr5_ik": "three parallel axes",
}


def arms():
    yield from (ws.load_robot(name).chain for name in LIBRARY)
    for kind in (*RELATIONS[:4], PARALLEL):
        yield random_arm(kind, 5)


@pytest.mark.parametrize("number", range(len(LIBRARY) + 5))
def test_sets_are_those_of_eaik(number):
    HPRobot = pytest.importorskip("eaik.IK_HP", reason=MISSING.format("EAIK")).HPRobot
    chain = list(arms())[number]
    chain = replace(chain, lower_limits=np.full(6, -np.pi), upper_limits=np.full(6, np.pi))
    h, o, T_tip = axes_of(chain)
    T_tip = T_tip @ chain.T_tip_tool
    peer = HPRobot(h, np.diff(np.vstack([np.zeros(3), o, T_tip[:3, 3]]), axis=0))
    assert peer.hasKnownDecomposition()
    T = chain.poses(anywhere(chain, POSES))
    found, solutions, there = postures(chain, T)
    asked = T.copy()
    asked[:, :3, :3] = T[:, :3, :3] @ T_tip[:3, :3].T
    compared = 0
    for k in range(POSES):
        answer = peer.IK(asked[k])
        theirs = np.array([q for q, least in zip(answer.Q, answer.is_LS, strict=True) if not least])
        ours = solutions[k, there[k]]
        clear = found.rows[k, :, 12]
        if not len(theirs) or np.abs(clear).min() < NEARLY_SINGULAR or singular(chain, ours):
            continue
        assert all(apart(chain, q, ours).min() < SAME for q in theirs)
        assert all(apart(chain, q, theirs).min() < SAME for q in ours)
        compared += 1
    assert compared > 0.6 * POSES


def singular(chain, q):
    """Whether the smallest singular value of a Jacobian at configurations (N, n) is small."""
    return np.linalg.svd(chain.jacobians(q), compute_uv=False)[:, -1].min() < NEARLY_SINGULAR


def chain_of_ssik(module):
    """The arm that a module of ssik is made for, by the axes of its joints."""
    T, h, o = np.eye(4), [], []
    for left, axis, right in zip(module._JOINT_T_LEFTS, module._JOINT_AXES, module._JOINT_T_RIGHTS, strict=True):
        T = T @ left
        h.append(T[:3, :3] @ axis)
        o.append(T[:3, 3])
        T = T @ right
    return chain_of(h, o, T, *np.transpose(module._JOINT_LIMITS))


@pytest.mark.parametrize("name", SSIK)
def test_sets_are_those_of_ssik(name):
    pytest.importorskip("ssik", reason=MISSING.format("ssik"))
    module = importlib.import_module(f"ssik.prebuilt.{name}")
    limited = chain_of_ssik(module)
    assert ClosedForm.of(limited).name.endswith(SSIK[name])
    chain = replace(limited, lower_limits=np.full(6, -np.pi), upper_limits=np.full(6, np.pi))
    T = limited.poses(anywhere(limited, SSIK_POSES))
    assert T[0] == pytest.approx(module.fk(anywhere(limited, 1)[0]), abs=1e-9)
    _, solutions, there = postures(chain, T)
    within, _, _ = postures(limited, T)
    compared = 0
    for k in range(SSIK_POSES):
        ours = solutions[k, there[k]]
        if singular(chain, ours):
            continue
        free = module.solve(T[k], respect_limits=False, enumerate_windings=False, allow_rescue=False)
        theirs = np.array([found.q for found in free])
        assert all(apart(chain, q, ours).min() < SAME for q in theirs)
        assert all(apart(chain, q, theirs).min() < SAME for q in ours)
        if np.abs(within.rows[k, :, 12]).min() > NEARLY_SINGULAR:
            assert within.count[k] == len(module.solve(T[k], allow_rescue=False))
            compared += 1
    assert compared > 0.6 * SSIK_POSES
