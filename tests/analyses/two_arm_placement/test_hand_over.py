"""Hand-overs of two planar arms beside every pair of their placements and postures, by closed forms and segments."""

import numpy as np
import pytest

import wsrender as ws
from wsrender.analyses.two_arm_placement import hand_over
from wsrender.analyses.two_arm_placement.job import spread_rotations
from wsrender.analyses.two_arm_placement.run import best_pairs
from wsrender.run import execute, plan

LENGTHS = {"first": (0.4, 0.3, 0.1), "second": (0.35, 0.25, 0.15)}
LIMIT, RADIUS, GAP = np.deg2rad(170), 0.03, 0.08  # joints' ends; the links'; what is between the tips
OVER = {"first": {"x_m": [-0.4, 0.2, 0.2], "y_m": 0.05}, "second": {"x_m": [0.3, 0.9, 0.3], "y_m": [-0.3, 0.3, 0.3]}}
PLACES = {
    "first": [(x, 0.05) for x in (-0.3, -0.1, 0.1)],
    "second": [(x, y) for x in (0.45, 0.75) for y in (-0.15, 0.15)],
}
RANDOM = np.random.default_rng(3)
POINTS, TURNS = RANDOM.uniform([-0.2, -0.4], [0.6, 0.4], (21, 2)), RANDOM.uniform(-np.pi, np.pi, 21)
TARGETS = [[0.1, 0.1, 0.0], [0.5, -0.2, 0.0]]


def arm(side):
    rows = [{"a": length, "limits_deg": [-170, 170]} for length in LENGTHS[side]]
    return {
        "robot": {"dh": {"convention": "standard", "rows": rows, "link_radius": RADIUS}},
        "over": OVER[side],
    }


def job(**fields):
    quats = np.stack([np.cos(TURNS / 2), 0 * TURNS, 0 * TURNS, np.sin(TURNS / 2)], axis=1)
    poses = {"points_m": np.pad(POINTS, ((0, 0), (0, 1))).tolist(), "quats_wxyz": quats.tolist()}
    poses |= {"second_in_first": {"position_m": [GAP, 0, 0], "rpy_deg": [0, 0, 180]}}
    arms = {side: arm(side) for side in LENGTHS}
    asked = {"analysis": "two_arm_placement", "points_m": TARGETS, "hand_over": poses, "device": "cpu"}
    return asked | arms | fields


def wrapped(angle):
    return (angle + np.pi) % (2 * np.pi) - np.pi


def postures(side, place, pose):
    """Configurations (up to 2, 3) of an arm at a pose of its own tip, x, y and angle, within the limits."""
    (a, b, c), turn = LENGTHS[side], pose[2]
    x, y = pose[:2] - c * np.array([np.cos(turn), np.sin(turn)]) - place
    cosine = (x * x + y * y - a * a - b * b) / (2 * a * b)
    assert abs(abs(cosine) - 1) > 1e-6
    found = []
    for sign in (1, -1) if abs(cosine) < 1 else ():
        q2 = sign * np.arccos(cosine)
        q1 = np.arctan2(y, x) - np.arctan2(b * np.sin(q2), a + b * np.cos(q2))
        q = wrapped(np.array([q1, q2, turn - q1 - q2]))
        assert np.abs(np.abs(q) - LIMIT).min() > 1e-6
        found += [q] if np.abs(q).max() < LIMIT else []
    return found


def of_second(pose):
    return np.array([*(pose[:2] + GAP * np.array([np.cos(pose[2]), np.sin(pose[2])])), pose[2] + np.pi])


def links(side, place, q):
    """Segments (3, 2, 2) of an arm."""
    turn = np.cumsum(q)
    steps = np.array(LENGTHS[side])[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    ends = np.vstack([place, place + np.cumsum(steps, axis=0)])
    return np.stack([ends[:-1], ends[1:]], axis=1)


def between(s, t):
    """Distance of two segments in the plane, by their crossing and their ends."""
    (a, b), (c, d) = s, t

    def side(p, q, r):
        return np.sign(np.round((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]), 12))

    if side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0:
        return 0.0

    def of_point(p, q, r):
        along = np.clip((p - q) @ (r - q) / ((r - q) @ (r - q)), 0, 1)
        return np.linalg.norm(p - q - along * (r - q))

    return min(of_point(a, c, d), of_point(b, c, d), of_point(c, a, b), of_point(d, a, b))


def room(q):
    return ((LIMIT - np.abs(q)) / (2 * LIMIT)).min()


def expected(apart):
    """Of every pair of placements and pose the largest lesser margin (P, Q, H) of both, -1 where there is none."""
    found = np.full((3, 4, len(POINTS)), -1.0)
    for (i, k, h), _ in np.ndenumerate(found):
        pose, places = np.array([*POINTS[h], TURNS[h]]), (PLACES["first"][i], PLACES["second"][k])
        for q_a in postures("first", places[0], pose):
            for q_b in postures("second", places[1], of_second(pose)):
                pairs = [(s, t) for s in links("first", places[0], q_a) for t in links("second", places[1], q_b)]
                if not apart or min(between(*each) for each in pairs) > 2 * RADIUS:
                    found[i, k, h] = max(found[i, k, h], min(room(q_a), room(q_b)))
    return found


@pytest.mark.parametrize("apart", [False, True])
def test_every_pair_of_placements_and_pose(apart, monkeypatch):
    for name, few in {"PLACES": 2, "SOLVED": 16, "TOGETHER": 5, "ROUND": 1}.items():
        monkeypatch.setattr(hand_over, name, few)  # several parts of all
    result = execute(job(constraints={"arms_collision": True} if apart else None))
    found, table = expected(apart), result.tables["hand_over_pairs"]
    bits = np.zeros(found.shape, bool)
    unpacked = np.unpackbits(table["poses_bits"], axis=1, count=len(POINTS), bitorder="little").astype(bool)
    bits[table["first"], table["second"]] = unpacked
    assert (bits == (found >= 0)).all() and 20 < bits.sum() < 0.6 * bits.size
    assert (table["poses"] == unpacked.sum(axis=1)).all() and (table["poses"] > 0).all()
    assert not table["undecided"].any()
    if apart:
        assert bits.sum() < (expected(False) >= 0).sum() - 5
    about, best = result.document["hand_over"], result.document["best"]
    assert about["pairs"] == len(table) and about["most"] == bits.sum(axis=2).max()
    assert (about["poses"], about["offered"]) == (len(POINTS), bits.any(axis=(0, 1)).sum())
    i, k = (best[side]["placement"] for side in LENGTHS)
    own = found[i, k]
    poses = result.tables["hand_overs"]
    assert (own >= 0).tolist() == (poses["label"] == "free").tolist()
    assert poses["joint_limit_margin"][own >= 0] == pytest.approx(own[own >= 0], abs=1e-4)
    assert np.isnan(poses["joint_limit_margin"][own < 0]).all()
    alone = expected(False)[i, k] >= 0
    assert (poses["label"][alone & (own < 0)] == "blocked").all() and (poses["label"][~alone] == "none").all()
    assert about["of_best_pair"]["free"] == (own >= 0).sum() and about["best"]["pose"] == own.argmax()
    assert about["best"]["joint_limit_margin"] == pytest.approx(own.max(), abs=1e-4)
    pose = np.array([*POINTS[own.argmax()], TURNS[own.argmax()]])
    for side, place, at in (("first", PLACES["first"][i], pose), ("second", PLACES["second"][k], of_second(pose))):
        q = about["best"][f"q_{side}"]
        assert min(np.abs(q - each).max() for each in postures(side, place, at)) < 1e-3
        assert result.skeleton[0 if side == "first" else 1, -1, :2] == pytest.approx(at[:2], abs=2e-5)


def test_the_best_pair_offers_a_hand_over_then_serves_most_then_offers_most():
    result = execute(job())
    offers = (expected(False) >= 0).sum(axis=2)

    def served(side, place):
        return [bool(np.hypot(*(np.array(p[:2]) - place)) < sum(LENGTHS[side])) for p in TARGETS]

    order = []
    for i, a in enumerate(PLACES["first"]):
        for k, b in enumerate(PLACES["second"]):
            either = np.array(served("first", a)) | served("second", b)
            order.append((-int(offers[i, k] > 0), -either.sum(), -offers[i, k], i, k))
    best = result.document["best"]
    assert min(order)[3:] == (best["first"]["placement"], best["second"]["placement"])
    assert result.document["pairs"]["most_weight"] == -min(order)[1]


def test_pairs_that_offer_no_hand_over_come_last():
    """Whatever they serve; of those that serve as much the one that offers most, not the one that serves most twice."""
    left, right = np.array([[1, 1, 1], [1, 0, 0]], bool), np.array([[1, 1, 1], [0, 1, 0], [1, 1, 0]], bool)
    found = best_pairs(left, right, np.ones(3), np.array([[0, 0, 0], [0, 3, 2]]))
    assert found.pair == (1, 1) and found.most == 2 and found.partner[0].tolist() == [0, 1]
    assert found.partner[1].tolist() == [0, 1, 1] and found.serving_all == 4


def test_orientations_of_a_volume_are_spread():
    """Each cell's centre with every orientation, the second's tip seen in the first's."""
    volume = {"box": {"lower_m": [0, 0, 0], "upper_m": [0.2, 0.1, 0.1]}, "step_m": 0.1}
    turned = {"volume": volume, "orientations": 40, "second_in_first": {"position_m": [0, 0, 0.1]}}
    own = plan(job(hand_over=turned))
    position, quat = own.plans[2].targets.position, own.plans[2].targets.quat_wxyz
    assert position[:40] == pytest.approx(np.tile([0.05, 0.05, 0.05], (40, 1))) and len(position) == 80
    w, x, y, z = quat[:40].T
    ahead = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z], axis=1)
    assert own.plans[3].targets.position[:40] == pytest.approx(position[:40] + 0.1 * ahead)
    assert np.linalg.norm(quat, axis=1) == pytest.approx(1.0)
    # Rotations at random are up to 70 degrees from one of 40 that are spread, and 81 to 92 from one of 40 at random.
    anywhere = np.random.default_rng(0).normal(size=(20_000, 4))
    anywhere /= np.linalg.norm(anywhere, axis=1)[:, None]
    assert np.rad2deg(2 * np.arccos(np.abs(anywhere @ spread_rotations(40).T).max(axis=1))).max() < 75


@pytest.mark.parametrize(
    ("change", "field", "message"),
    [
        ({"hand_over": {}}, "hand_over.points_m", "must be given"),
        ({"hand_over": {"points_m": [[0, 0, 0]], "quats_wxyz": [[0, 0, 0, 0]]}}, "hand_over.quats_wxyz", "length 0"),
        ({"hand_over": {"points_m": [[0, 0, 0]] * 200, "orientations": 1000}}, "hand_over.orientations", "200,000"),
        ({"hand_over": None, "constraints": {"arms_collision": True}}, "constraints.arms_collision", "hand_over"),
        ({"first": arm("first") | {"over": {"x_m": [0, 1, 1e-6]}}}, "first.over", "at most 1,000,000 pairs"),
    ],
)
def test_bad_jobs_are_refused_by_name(change, field, message):
    with pytest.raises((ws.DocumentError, ws.InputError), match=f"{field}.*{message}"):
        plan(job() | change)
