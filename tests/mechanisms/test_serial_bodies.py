"""Serial legs whose shapes keep apart, against contacts of MuJoCo's own models of the mechanism in every posture."""

from dataclasses import replace
from itertools import product
from pathlib import Path

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.mechanisms.mechanisms import mechanism
from tests.mechanisms.serial_legs import mjcf
from tests.mechanisms.test_bodies import at, random_poses
from wsrender.errors import DocumentError, InputError, ResourceError
from wsrender.mechanisms.inverse_kinematics import inverse_kinematics
from wsrender.mechanisms.jacobians import jacobians
from wsrender.mechanisms.keeping_apart import stand
from wsrender.mechanisms.membership import fault_at, poses_labelled
from wsrender.reach.evidence import REACHABLE, UNDECIDED, UNREACHABLE

BASES, CORNERS = [[-0.5, -0.3], [0.5, -0.3], [0.0, 0.55]], [[-0.1, -0.06], [0.1, -0.06], [0.0, 0.12]]
LINKS, PARTS = (0.4, 0.35), ("upper", "lower", "hand")
POST = {"shape": "cylinder", "name": "post", "radius_m": 0.05, "length_m": 0.4, "position_m": [0.12, 0.28, 0.0]}
TRAY = {"shape": "box", "name": "tray", "size_m": [0.3, 0.16, 0.03], "position_m": [0.0, 0.02, 0.0]}


def bar(base, corner) -> dict:
    """A planar leg of three hinges about z, its links capsules and a hand, that holds the platform's pose."""
    first, second = LINKS
    body = (
        f'<body pos="{base[0]} {base[1]} 0"><joint name="a" axis="0 0 1" range="-3.1 3.1"/>'
        f'<geom name="upper" type="capsule" size=".02" fromto="0 0 0 {first} 0 0"/>'
        f'<body pos="{first} 0 0"><joint name="b" axis="0 0 1" range="-3.1 3.1"/>'
        f'<geom name="lower" type="capsule" size=".02" fromto="0 0 0 {second - 0.02} 0 0"/>'
        f'<body pos="{second} 0 0"><joint name="c" axis="0 0 1" range="-3.1 3.1"/>'
        '<geom name="hand" size=".03"/><site name="tool"/></body></body></body>'
    )
    attachment = {"position_m": [*corner, 0.0]}
    robot = {"mjcf": mjcf(body)}
    return {"type": "serial", "robot": robot, "attachment": attachment, "holds": "pose", "actuated": ["a"]}


ALL = {"platform": {"items": [TRAY]}, "environment": {"items": [POST]}}


def three_bars(bodies, **fields) -> dict:
    return {"legs": [bar(b, c) for b, c in zip(BASES, CORNERS, strict=True)], "bodies": bodies, **fields}


def elbows(base, corner, pose):
    """Both configurations (3,) of a planar leg that holds a pose, by the law of cosines; none out of reach."""
    (l1, l2), turn = LINKS, np.arctan2(pose[1, 0], pose[0, 0])
    away = (pose @ [*corner, 0, 1])[:2] - base
    cosine = (away @ away - l1**2 - l2**2) / (2 * l1 * l2)
    found = []
    for b in (np.arccos(cosine), -np.arccos(cosine)) if abs(cosine) <= 1 else ():
        a = np.arctan2(away[1], away[0]) - np.arctan2(l2 * np.sin(b), l1 + l2 * np.cos(b))
        a, c = (np.remainder(angle + np.pi, 2 * np.pi) - np.pi for angle in (a, turn - a - b))
        if max(abs(a), abs(b), abs(c)) <= 3.1:
            found.append(np.array([a, b, c]))
    return found


def from_text(text):
    return lambda: mujoco.MjSpec.from_string(text)


def placed(T):
    return {"pos": T[:3, 3], "quat": Rotation.from_matrix(T[:3, :3]).as_quat(scalar_first=True)}


def whole(legs, holder, add_platform, add_around=lambda world: None, jointed=False):
    """A model of ``legs`` "0/" …, each (spec, place, T_platform_tip); the platform is a child of one's tip."""
    spec = mujoco.MjSpec()
    for k, (leg, T, _) in enumerate(legs):
        spec.attach(leg(), prefix=f"{k}/", frame=spec.worldbody.add_frame(**placed(T)))
    site, T_platform_tip = spec.site(f"{holder}/tool"), legs[holder][2]
    T_body_site = np.eye(4)
    T_body_site[:3, :3], T_body_site[:3, 3] = Rotation.from_quat(site.quat, scalar_first=True).as_matrix(), site.pos
    platform = site.parent.add_body(name="platform", **placed(T_body_site @ np.linalg.inv(T_platform_tip)))
    if jointed:
        platform.add_joint(type=mujoco.mjtJoint.mjJNT_BALL, pos=T_platform_tip[:3, 3])
    add_platform(platform)
    add_around(spec.worldbody)
    return spec.compile()


def contacts(model, qpos):
    """Pairs of geoms in contact by name, by MuJoCo's collision pass, and where the platform stands (4, 4)."""
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    mujoco.mj_collision(model, data)
    pairs = [data.contact[i].geom for i in range(data.ncon) if data.contact[i].dist < 0]
    T = at(data.body("platform").xpos)
    T[:3, :3] = data.body("platform").xmat.reshape(3, 3)
    names = [model.geom(k).name or model.body(model.geom_bodyid[k]).name for k in range(model.ngeom)]
    return {frozenset(names[k] for k in pair) for pair in pairs}, T


def not_of_others(pairs, holder):
    """Without those of the tray and legs other than the holder, to which it isn't fixed in this model."""
    return {p for p in pairs if "tray" not in p or all(name[:2] in ("tr", "po", f"{holder}/") for name in p)}


def add_tray(body):
    body.add_geom(name="tray", type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.15, 0.08, 0.015], pos=TRAY["position_m"])


def add_post(body):
    body.add_geom(name="post", type=mujoco.mjtGeom.mjGEOM_CYLINDER, size=[0.05, 0.2, 0], pos=POST["position_m"])


def reached(mech, poses):
    """Those that all legs reach by themselves."""
    return poses[poses_labelled(replace(mech, bodies=None), poses, device="cpu")[0] == REACHABLE]


def test_three_planar_legs_with_a_tray_beside_a_post():
    """Blocked are poses in all eight postures of which MuJoCo has contacts, with the tray fixed to each leg in turn."""
    mech, rng = mechanism(three_bars(ALL)), np.random.default_rng(3)
    poses = np.tile(np.eye(4), (600, 1, 1))
    poses[:, :2, 3] = rng.uniform(-0.3, 0.35, (600, 2))
    turns = Rotation.from_rotvec(rng.uniform(-0.9, 0.9, 600)[:, None] * [0, 0, 1])
    poses[:, :3, :3] = turns.as_matrix()
    poses = reached(mech, poses)[:160]
    legs = [
        (from_text(leg["robot"]["mjcf"]), np.eye(4), leg["attachment"]["position_m"])
        for leg in three_bars(None)["legs"]
    ]
    legs = [(spec, T, at(corner)) for spec, T, corner in legs]
    models = [whole(legs, holder, add_tray, add_post) for holder in range(3)]
    free, met_anywhere, stands = np.zeros(len(poses), bool), set(), stand(mech, poses)
    for n, pose in enumerate(poses):
        each = [elbows(np.array(b), c, pose) for b, c in zip(BASES, CORNERS, strict=True)]
        chosen = [q[n] for q in stands.q]
        for q in (*product(*each), chosen):
            met = set()
            for holder, model in enumerate(models):
                found, T = contacts(model, np.concatenate(q))
                np.testing.assert_allclose(T, pose, atol=1e-5)
                met |= not_of_others(found, holder)
            met_anywhere |= met
            free[n] |= not met
            assert q is not chosen or bool(met) != (stands.label[n] == REACHABLE)
    kinds = {frozenset(name.split("/")[-1] for name in pair) for pair in met_anywhere}
    wanted = (("tray", "upper"), ("post", "lower"), ("tray", "post"), ("lower",), ("hand", "upper"))
    assert {frozenset(pair) for pair in wanted} <= kinds
    assert not {frozenset(pair) for pair in (("tray", "lower"), ("tray", "hand"))} & kinds
    labels = poses_labelled(mech, poses, device="cpu")[0]
    np.testing.assert_array_equal(labels, np.where(free, REACHABLE, UNREACHABLE))  # closed forms know all postures
    assert 30 < free.sum() < len(poses) - 30


def test_a_leg_keeps_apart_from_itself():
    """Folded so far that its hand stands in its upper link, by contacts of its model in either posture."""
    leg = bar(BASES[0], [0, 0])
    mech, rng = mechanism({"legs": [leg], "bodies": {}}), np.random.default_rng(1)
    poses = np.tile(np.eye(4), (300, 1, 1))
    poses[:, :2, 3] = BASES[0] + rng.uniform(-0.15, 0.15, (300, 2))
    model = whole([(from_text(leg["robot"]["mjcf"]), np.eye(4), np.eye(4))], 0, lambda body: None)
    each = [elbows(np.array(BASES[0]), [0, 0], pose) for pose in poses]
    free = np.array([any(not contacts(model, q)[0] for q in postures) for postures in each])
    labels = poses_labelled(mech, poses, device="cpu")[0]
    np.testing.assert_array_equal(labels == REACHABLE, free)
    assert (np.array(list(map(len, each))) > 0)[~free].sum() > 20 < free.sum()


def crank(azimuth):
    out = np.array([np.cos(azimuth), np.sin(azimuth), 0])
    return {
        "type": "RUS", "base_m": 0.3 * out, "platform_m": 0.15 * out, "axis": [-out[1], out[0], 0], "zero": out,
        "crank_m": 0.25, "link_m": 0.5, "angle_deg": [-170, 170], "branch": "minus",
    }  # fmt: skip


BALL = {"shape": "sphere", "name": "ball", "radius_m": 0.09, "position_m": [0.02, 0.02, -0.12]}
STONE = {"shape": "box", "name": "stone", "size_m": [0.2, 0.1, 0.2], "position_m": [0.0, 0.45, 0.1]}
SWING = (
    '<body pos="0 .3 0"><joint name="crank" axis="-1 0 0" range="-2.9 2.9"/>'
    '<geom name="crank" type="capsule" size=".02" fromto="0 0 0 0 .25 0"/>'
    '<body pos="0 .25 0"><joint name="a" axis="-1 0 0" range="-3 3"/><joint name="b" axis="0 0 1" range="-1.5 1.5"/>'
    '<geom name="link" type="capsule" size=".02" fromto="0 .05 0 0 .5 0"/>'
    '<site name="tool" pos="0 .5 0"/></body></body>'
)


def test_a_leg_that_holds_a_spherical_joint_beside_two_in_closed_form():
    """The links and cranks of these as capsules that MuJoCo moves freely; all postures of the serial leg, by search."""
    serial = {"type": "serial", "robot": {"mjcf": mjcf(SWING)}, "attachment": {"position_m": [0, 0.15, 0]}}
    bodies = {"link_radius_m": 0.02, "platform": {"items": [BALL]}, "environment": {"items": [STONE]}}
    cranks = [crank(np.deg2rad(azimuth)) for azimuth in (210, 330)]
    mech = mechanism({"legs": [cranks[0], serial, cranks[1]], "bodies": bodies})
    poses = reached(mech, random_poses(3000, [-0.3, -0.3, 0.0], [0.3, 0.3, 0.6], 0.8, seed=5))[:120]
    robot, seen = mech.numeric[0].robot, set()
    free = np.zeros(len(poses), bool)

    def add_ball(body):
        body.add_geom(name="ball", type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[0.09, 0, 0], pos=BALL["position_m"])

    for n, pose in enumerate(poses):
        closed = inverse_kinematics(mech, pose[None])

        def add_legs(world, closed=closed):
            world.add_geom(name="stone", type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.1, 0.05, 0.1], pos=STONE["position_m"])
            for k in range(2):
                base, elbow, joint = mech.base[k], closed.elbows[0, k], closed.joints[0, k]
                for part, ends in (("crank", (base, elbow)), ("link", (elbow, joint))):
                    body = world.add_body(name=f"{part} {k}")
                    body.add_freejoint()
                    body.add_geom(
                        name=f"{part} {k}", type=mujoco.mjtGeom.mjGEOM_CAPSULE, size=[0.02, 0, 0], fromto=np.ravel(ends)
                    )

        legs = [(from_text(mjcf(SWING)), np.eye(4), at([0, 0.15, 0]))]
        model = whole(legs, 0, add_ball, add_legs, jointed=True)
        for q in ws.postures(robot, (pose @ [0, 0.15, 0, 1])[:3]):
            qpos = model.qpos0.copy()
            qpos[:3] = q
            R = contacts(model, qpos)[1][:3, :3].T @ pose[:3, :3]
            qpos[3:7] = Rotation.from_matrix(R).as_quat(scalar_first=True)
            found, T = contacts(model, qpos)
            np.testing.assert_allclose(T, pose, atol=1e-5)
            own = [{f"crank {k}", f"link {k}"} for k in range(2)]
            at_platform = [{"ball", f"link {k}"} for k in range(2)]  # without a gap they may touch what it carries
            met = {pair for pair in found if pair not in [*own, *at_platform]}
            seen |= {frozenset(name.split("/")[-1].split(" ")[0] for name in pair) for pair in met}
            free[n] |= not met
    wanted = (("link", "stone"), ("crank", "stone"), ("ball", "crank"), ("link",), ("crank", "link"), ("ball", "stone"))
    assert {frozenset(pair) for pair in wanted} <= seen and frozenset(("ball", "link")) not in seen
    labels = poses_labelled(mech, poses, device="cpu")[0]
    np.testing.assert_array_equal(labels == REACHABLE, free)
    assert 20 < free.sum() < len(poses) - 20
    # Of the serial leg the crank alone keeps apart from the ball, as in MuJoCo's own model.
    (leg,) = mech.bodies.serial
    assert [leg.solids[k].name for k, _ in leg.platform] == ["leg 2/crank"]
    legs = [(from_text(mjcf(SWING)), np.eye(4), at([0, 0.15, 0]))]
    large = whole(legs, 0, lambda body: body.add_geom(name="ball", size=[0.6, 0, 0]), jointed=True)
    assert contacts(large, large.qpos0)[0] == {frozenset(("ball", "0/crank"))}


def two_arms(**fields):
    """A tray in the hands of two library arms that face each other."""
    legs = [
        {
            "type": "serial",
            "robot": {"library": "puma560", "placement": {"position_m": [x, 0, 0], "rpy_deg": [0, 0, yaw]}},
            "attachment": {"position_m": [np.sign(x) * 0.215, 0, 0], "rpy_deg": [0, -150 * np.sign(x), 0]},
            "holds": "pose",
            "actuated": ["joint1", "joint2", "joint3"],
        }
        for x, yaw in ((-0.3, 0), (0.3, 180))
    ]
    return {"legs": legs, **fields}


def test_two_library_arms_with_a_tray():
    """Over all pairs of postures, with MuJoCo's contacts of models in which the tray is fixed to either arm."""
    mech = mechanism(two_arms(bodies={"platform": {"items": [TRAY]}}))
    poses = reached(mech, random_poses(1500, [-0.2, -0.5, -0.2], [0.2, 0.5, 0.7], 0.6, seed=2))[:40]
    text = (Path(__file__).parents[2] / "mjcf/puma560/puma560.xml").read_text()
    legs = [(from_text(text), leg.chain.T_world_base, leg.T_platform_tip) for leg in mech.numeric]
    models, free = [whole(legs, holder, add_tray) for holder in range(2)], np.zeros(len(poses), bool)
    for n, pose in enumerate(poses):
        each = [list(ws.postures(leg.robot, leg.targets(pose[None]))) for leg in mech.numeric]
        for q in product(*each):
            met = set()
            for holder, model in enumerate(models):
                found, T = contacts(model, np.concatenate(q))
                np.testing.assert_allclose(T, pose, atol=1e-5)
                met |= not_of_others(found, holder)
            free[n] |= not met
    labels = poses_labelled(mech, poses, device="cpu")[0]
    np.testing.assert_array_equal(labels, np.where(free, REACHABLE, UNREACHABLE))
    assert 5 < free.sum() < len(poses) - 5


def test_a_posture_that_stands_for_many_is_not_all_of_them():
    """Of a Puma's wrist that is straight, axes 4 and 6 in one line, only their sum is told: a pose is not complete."""
    leg = mechanism(two_arms(bodies={"platform": {"items": [TRAY]}})).numeric[0]
    q = np.array([[0.2, -0.8, 0.5, 0.3, 0.7, -0.4], [0.2, -0.8, 0.5, 0.3, 0.0, -0.4]])
    poses = leg.chain.poses(q) @ np.linalg.inv(leg.T_platform_tip)
    known = leg.postures(poses, device="cpu")
    assert known.there.any(axis=1).all() and known.complete.tolist() == [True, False]


def test_indices_and_pictures_are_of_postures_that_keep_apart():
    """A ball around the first leg's elbow leaves the other side: its Jacobian, and its sticks."""
    pose, fields = np.eye(4), {"region": {"lower_m": [-0.05, -0.05, -1], "upper_m": [0.05, 0.05, 1]}}
    taken = mechanism(three_bars(None)).numeric[0].solve(pose[None]).q[0]
    sides = sorted(elbows(np.array(BASES[0]), CORNERS[0], pose), key=lambda q: np.abs(q - taken).max())
    elbow = np.array([*BASES[0], 0.0]) + LINKS[0] * np.array([np.cos(sides[0][0]), np.sin(sides[0][0]), 0])
    ball = {"environment": {"items": [{"shape": "sphere", "radius_m": 0.03, "position_m": elbow.tolist()}]}}
    mech = mechanism(three_bars(ball))
    found = stand(mech, pose[None])
    assert found.label[0] == REACHABLE
    np.testing.assert_allclose(found.q[0][0], sides[1], atol=1e-5)
    leg, legs = mech.numeric[0], inverse_kinematics(mech, pose[None])
    passive = leg.jacobian(np.array(sides))[:, :, ~leg.actuated]
    left = [np.eye(6) - each @ np.linalg.pinv(each) for each in passive]  # what passive joints leave of a twist
    rows = jacobians(mech, legs, pose[None]).A[0, : leg.rows]
    S = np.eye(6)
    S[:3, 3:] = -np.cross(np.eye(3), leg.T_platform_tip[:3, 3])
    np.testing.assert_allclose(rows.T @ rows, S.T @ left[1] @ S, atol=1e-5)
    assert np.abs(left[0] - left[1]).max() > 0.1
    result = ws.parallel_workspace(three_bars(ball, **fields), voxel_size_m=0.1, refined_volume=None, device="cpu")
    assert np.linalg.norm(result.skeleton[0] - elbow, axis=1).min() > 0.05


def test_a_job_counts_what_serial_legs_collide_with():
    region = {"lower_m": [-0.4, -0.4, -1], "upper_m": [0.4, 0.4, 1]}
    job = {"voxel_size_m": 0.05, "refined_volume": 0.1, "device": "cpu"}
    free, under = (ws.parallel_workspace(three_bars(bodies, region=region), **job).document for bodies in (None, ALL))
    samples = under["samples"]
    assert samples["drawn"] == samples["admitted"] + samples["rejected"]["collision"]
    assert samples["rejected"]["collision"] > 10 and under["sampling"]["undecided"] == 0
    assert under["headline"]["quantity"] == "area" and 0 < under["headline"]["value"] < free["headline"]["value"]


WALL = {"shape": "box", "name": "wall", "size_m": [0.3, 0.3, 0.1], "position_m": [*BASES[1], 0]}


def test_collisions_name_the_shapes():
    """Certain where closed forms know all postures; else undecided, as of a leg with a hinge more than it needs."""
    walled, legs = {"environment": {"items": [WALL]}}, three_bars(None)["legs"]
    told = "collision: leg 2/upper and wall come too near"
    mech = mechanism({"legs": legs, "bodies": walled})
    assert poses_labelled(mech, np.eye(4)[None], device="cpu")[0][0] == UNREACHABLE
    assert fault_at(mech, np.eye(4)) == told
    with pytest.raises(InputError, match="leg 2/upper and wall come too near"):
        ws.parallel_workspace({"legs": legs, "bodies": walled, "home": {}}, voxel_size_m=0.1)
    hinge = '<geom name="hand" size=".03"/><body pos=".05 0 0"><joint name="d" axis="0 0 1" range="-1 1"/>'
    text = (
        legs[1]["robot"]["mjcf"]
        .replace('<geom name="hand" size=".03"/>', hinge)
        .replace("</body></worldbody>", "</body></body></worldbody>")
    )
    more = mechanism({"legs": [legs[0], legs[1] | {"robot": {"mjcf": text}}, legs[2]], "bodies": walled})
    assert poses_labelled(more, np.eye(4)[None], device="cpu")[0][0] == UNDECIDED
    assert fault_at(more, np.eye(4)) == f"{told}, in this posture, and others in every other that was found"


def test_what_serial_legs_cannot_be_asked():
    leg = bar(BASES[0], CORNERS[0])
    bare = leg | {"robot": {"mjcf": leg["robot"]["mjcf"].replace("<geom ", '<geom contype="0" conaffinity="0" ')}}
    with pytest.raises(InputError, match="must have shapes that may collide where the mechanism has bodies") as told:
        mechanism({"legs": [bare], "bodies": {}})
    assert told.value.field == "mechanism.legs.0.robot"
    ups = {"type": "UPS", "base_m": [0, 0, 0], "platform_m": [0, 0, 0], "length_m": [0.1, 1]}
    for legs, bodies, message in (
        ([leg, ups], {}, "is required: the radius"),
        ([leg], {"link_radius_m": 0.1}, "must be null: all legs are serial"),
    ):
        with pytest.raises(DocumentError) as refused:
            ws.parallel_workspace({"legs": legs, "bodies": bodies})
        ((field, text),) = refused.value.problems
        assert field == "mechanism.bodies.link_radius_m" and message in text


def test_too_many_pairs_are_refused(monkeypatch):
    """Before they are listed: twelve legs of a thousand shapes would be 66 million."""
    monkeypatch.setattr("wsrender.mechanisms.leg_bodies.MOST_PAIRS", 9)
    with pytest.raises(ResourceError, match="would keep 10 pairs of shapes of leg 2 apart, more than 9") as told:
        mechanism({"legs": [bar(BASES[0], [0, 0]), bar(BASES[1], [0.1, 0])], "bodies": {}})
    assert told.value.field == "mechanism.bodies"


def test_legs_that_share_a_joint_may_touch_next_to_it():
    """Two bars that meet in one pin, where a crank's link ends too: their hands alone may stand in each other."""
    names = []
    for corner in ([0, 0], [0.05, 0]):
        legs = [bar(BASES[0], [0, 0]), bar(BASES[1], corner), crank(0) | {"platform_m": [*corner, 0]}]
        solids = mechanism({"legs": legs, "bodies": {"link_radius_m": 0.02}}).bodies
        one, two = solids.serial
        names.append({(two.solids[a].name, one.solids[b].name) for a, b in two.earlier[0]})
        assert len(names[-1]) == (8 if corner == [0, 0] else 9)
        hand = next(k for k, solid in enumerate(two.solids) if solid.name == "leg 2/hand")
        assert (hand in two.beside(0, "link")) is False and hand in two.beside(0, "crank")
        assert (hand in one.beside(0, "link")) is (corner != [0, 0])
    assert names[1] - names[0] == {("leg 2/hand", "leg 1/hand")}
