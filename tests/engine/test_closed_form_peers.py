"""Sets of postures against those of EAIK (Ostermeier, Külz, Althoff 2025) and ssik, where they are installed."""

import importlib
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.engine.test_closed_form import anywhere, apart, in_line, postures
from tests.reference.arms_by_axes import PARALLEL, RELATIONS, axes_of, chain_of, random_arm
from wsrender.engine import closed_postures, open_wrist_postures
from wsrender.reach import InverseSolver
from wsrender.reach.evidence import REACHABLE
from wsrender.robots.closed_form import ClosedForm, OpenWristForm

MISSING = "{} is not installed: extra test-models"
SSIK_POSES, OPEN_POSES = 500, 200
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

OPEN = (
    "agilex.piper_ik",
    "fanuc.crx10ia_ik",
    "fanuc.crx30ia_ik",
    "fanuc.crx5ia_ik",
    "kinova.jaco2_ik",
    "rokae.xmatecr7_ik",
    "rokae.xmatesr3_ik",
    "ufactory.xarm6_ik",
    "yaskawa.hc10_ik",
)


def arms():
    yield from (ws.load_robot(name).chain for name in LIBRARY)
    for kind in (*RELATIONS[:4], PARALLEL):
        yield random_arm(kind, 5)


def eaik_of(chain):
    """EAIK's solver of an arm, and the tip's pose (4, 4) whose orientation it leaves out."""
    HPRobot = pytest.importorskip("eaik.IK_HP", reason=MISSING.format("EAIK")).HPRobot
    h, o, T_tip = axes_of(chain)
    T_tip = T_tip @ chain.T_tip_tool
    peer = HPRobot(h, np.diff(np.vstack([np.zeros(3), o, T_tip[:3, 3]]), axis=0))
    assert peer.hasKnownDecomposition()
    return peer, T_tip


@pytest.mark.parametrize("number", range(len(LIBRARY) + 5))
def test_sets_are_those_of_eaik(number):
    chain = list(arms())[number]
    chain = replace(chain, lower_limits=np.full(6, -np.pi), upper_limits=np.full(6, np.pi))
    peer, T_tip = eaik_of(chain)
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


def module_of_ssik(name):
    """The module of ssik for an arm."""
    pytest.importorskip("ssik", reason=MISSING.format("ssik"))
    return importlib.import_module(f"ssik.prebuilt.{name}")


def chain_of_ssik(module):
    """The arm that a module of ssik is made for, by the axes of its joints."""
    T, h, o = np.eye(4), [], []
    for left, axis, right in zip(module._JOINT_T_LEFTS, module._JOINT_AXES, module._JOINT_T_RIGHTS, strict=True):
        T = T @ left
        h.append(T[:3, :3] @ axis)
        o.append(T[:3, 3])
        T = T @ right
    limits = [ends or (-np.pi, np.pi) for ends in module._JOINT_LIMITS]  # none: a hinge that turns for ever
    return chain_of(h, o, T, *np.transpose(limits))


@pytest.mark.parametrize("name", SSIK)
def test_sets_are_those_of_ssik(name):
    module = module_of_ssik(name)
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


@pytest.mark.parametrize("name", ("3e", "5", "5e", "7e", "10e", "12e", "15", "16e", "18", "20", "30"))
def test_wrists_in_line_of_ur_arms_are_not_called_unreachable(name):
    """Whose axes 4 and 5, of ten digits, are not quite at right angles; nor what is within the tolerances of them."""
    chain = chain_of_ssik(module_of_ssik(f"universal_robots.ur{name}_ik"))
    T, random = chain.poses(in_line(chain, 4000)), np.random.default_rng(0)
    found = closed_postures(ClosedForm.of(chain), T, device="cpu")
    assert not (found.slack < -found.margin).any()
    for tolerance in (1e-5, 1e-7):
        solver = InverseSolver(chain, kind="pose", device="cpu", position_m=tolerance, angle_rad=tolerance)
        turn = Rotation.from_rotvec(random.uniform(-0.5, 0.5, (len(T), 3)) * tolerance).as_matrix()
        position = T[:, :3, 3] + random.uniform(-0.5, 0.5, (len(T), 3)) * tolerance
        assert not solver.closed.unreachable(position, turn @ T[:, :3, :3]).any()
    solved = solver.solve(T[:20, :3, 3], T[:20, :3, :3])
    assert (solved.label == REACHABLE).all() and not solved.proven.any()


@pytest.mark.parametrize("name", OPEN)
def test_sets_of_open_arms_are_those_of_ssik(name):
    """Of poses made anywhere, joints turning freely; where ours is not flagged nothing is missing."""
    pytest.importorskip("ssik", reason=MISSING.format("ssik"))
    module = importlib.import_module(f"ssik.prebuilt.{name}")
    limited = chain_of_ssik(module)
    chain = replace(limited, lower_limits=np.full(6, -np.pi), upper_limits=np.full(6, np.pi))
    form = OpenWristForm.of(chain)
    T = limited.poses(anywhere(limited, OPEN_POSES))
    found = open_wrist_postures(form, T, device="cpu")
    solutions, compared = form.rest.configurations(found.rows[..., :12]), 0
    for k in np.flatnonzero(found.flags == 0):
        ours = solutions[k, found.rows[k, :, 12] > -found.margin]
        answer = module.solve(T[k], respect_limits=False, enumerate_windings=False, allow_rescue=False)
        theirs = np.reshape([each.q for each in answer], (-1, 6))
        theirs = theirs[np.abs(chain.poses(theirs) - T[k]).max(axis=(1, 2)) < 1e-8]  # near singular ones some do not
        near = SAME if not singular(chain, ours) else NEARLY_SINGULAR
        assert all(apart(chain, q, ours).min() < near for q in theirs)
        if near == SAME:  # theirs lacks some
            lacking = np.reshape([q for q in ours if apart(chain, q, theirs).min(initial=9) > near], (-1, 6))
            assert chain.poses(lacking) == pytest.approx(np.tile(T[k], (len(lacking), 1, 1)), abs=1e-8)
            compared += not len(lacking)
    assert compared > 0.9 * OPEN_POSES
