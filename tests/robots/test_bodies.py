"""Shapes and pairs of robots against MuJoCo's own compile of the same model, and its contacts."""

import warnings

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wsrender as ws
from wsrender.errors import InputError, ModelError
from wsrender.robots.model_warning import ModelWarning
from wsrender.robots.shapes import geom_name

ARM = """<mujoco><compiler angle="radian"/>
  <option><flag filterparent="{filterparent}"/></option>
  <asset><mesh name="wedge" vertex="0 0 0 .2 0 0 0 .1 0 0 0 .3 .05 .02 .05"/></asset>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 1"/>
    <body name="foot" pos="1 2 3" euler=".1 .2 .3"><geom size=".05 .1" type="cylinder" euler=".3 0 .1"/>
      <body name="a"><joint name="i" axis="1 2 3" ref=".2" range="-1 1"/>
        <geom type="box" size=".1 .2 .3" pos=".1 0 .2" euler="0 .3 0"/>
        <body name="welded" pos=".1 .1 0"><geom name="ball" size=".1"/></body>
        <body name="jaw" pos="0 .3 0"><joint name="follower" axis="0 1 0"/>
          <geom name="jaw" type="capsule" size=".03 .1" pos="0 0 .1"/></body>
        <body name="b" pos=".4 0 0"><joint name="j" type="slide" axis="0 1 1" range="0 .5"/>
          <geom name="wedge" type="mesh" mesh="wedge" pos=".2 0 0"/>
          <geom name="seen" type="mesh" mesh="wedge" contype="0" conaffinity="0"/>
          <body name="c" pos=".3 .1 0"><joint name="k" axis="0 1 0.2" range="-2 2"/>
            <geom name="egg" type="ellipsoid" size=".05 .1 .07" margin="1" pos=".1 0 0"/>
            <site name="tool" pos=".2 0 .1" euler="0 0 .4"/></body></body></body>
      <body name="shelf" pos="0 0 .5"><joint name="off" ref=".1"/><geom name="shelf" size=".2"/></body></body>
  </worldbody>
  <equality><joint joint1="follower" joint2="i" polycoef=".1 -.5 0 0 0"/></equality>
  <contact><exclude body1="c" body2="foot"/><pair geom1="egg" geom2="wedge"/></contact></mujoco>"""
POSE = 1e-12


def arm(filterparent="enable"):
    return ARM.format(filterparent=filterparent)


def configurations(robot, count=5):
    return np.random.default_rng(3).uniform(robot.lower_limits, robot.upper_limits, (count, robot.chain.n))


def contacts_of(model):
    """Pairs of geoms that MuJoCo tests: all that it reports as spheres with a huge margin, the world's aside."""
    own = model.geom_bodyid > 0
    model.geom_type[own], model.geom_size[own] = mujoco.mjtGeom.mjGEOM_SPHERE, 1.0
    model.geom_margin[:] = model.pair_margin[:] = model.body_margin[:] = 1e3
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    geoms = [sorted(contact.geom) for contact in data.contact]
    return {frozenset(map(int, pair)) for pair in geoms if all(model.geom_bodyid[geom] for geom in pair)}


@pytest.mark.parametrize("base", [None, "a"])
def test_shapes_are_where_mujoco_puts_them(base):
    """Also those on bodies that a follower moves, off the path from base to tip."""
    T = np.array([[0, -1, 0, 0.5], [1, 0, 0, 0.1], [0, 0, 1, -0.3], [0, 0, 0, 1.0]])
    robot = ws.load_robot(arm(), base=base, placement=T)
    bodies, q = robot.bodies, configurations(robot)
    reference = mujoco.MjModel.from_xml_string(arm())
    data, poses = mujoco.MjData(reference), bodies.poses(q)
    assert {shape.name for shape in bodies.shapes} == {
        "floor", "foot/0", "a/0", "ball", "jaw", "wedge", "egg", "shelf"
    }  # fmt: skip
    for row, found in zip(q, poses, strict=True):
        values = dict(zip(robot.joint_names, row, strict=True))
        values["follower"] = 0.1 - 0.5 * (values.get("i", 0.2) - 0.2)
        for joint, value in values.items():
            data.joint(joint).qpos = value
        mujoco.mj_kinematics(reference, data)
        T_model_base = np.eye(4)
        if base:
            T_model_base[:3, :3], T_model_base[:3, 3] = data.body(base).xmat.reshape(3, 3), data.body(base).xpos
        T_world_model = T @ np.linalg.inv(T_model_base)
        for shape, T_shape in zip(bodies.shapes, found, strict=True):
            geom = reference.geom(shape.name).id if "/" not in shape.name else reference.body(shape.body).geomadr[0]
            R, p = data.geom_xmat[geom].reshape(3, 3), data.geom_xpos[geom]
            if shape.kind == "mesh":
                assert robot.joint_names[bodies.chain.joint_source[shape.frame]] == "j"
            np.testing.assert_allclose(T_shape[:3, 3], (T_world_model @ [*p, 1])[:3], atol=POSE)
            np.testing.assert_allclose(T_shape[:3, :3], T_world_model[:3, :3] @ R, atol=POSE)


def test_the_model_with_shapes_takes_configurations():
    robot = ws.load_robot(arm())
    bodies, q = robot.bodies, configurations(robot)
    data = mujoco.MjData(bodies.model)
    for qpos, poses in zip(bodies.qpos(q), bodies.poses(q), strict=True):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(bodies.model, data)
        geoms = [shape.geom for shape in bodies.shapes]
        np.testing.assert_allclose(poses[:, :3, 3], data.geom_xpos[geoms], atol=POSE)
    assert not bodies.model.geom_margin.any()


def test_kinds_and_sizes_and_hulls():
    shapes = {shape.name: shape for shape in ws.load_robot(arm()).bodies.shapes}
    assert [shapes[name].kind for name in ("floor", "foot/0", "a/0", "ball", "jaw", "wedge", "egg")] == [
        "plane", "cylinder", "box", "sphere", "capsule", "mesh", "ellipsoid"
    ]  # fmt: skip
    assert shapes["a/0"].size.tolist() == [0.1, 0.2, 0.3]
    assert shapes["floor"].surroundings and not shapes["foot/0"].surroundings
    assert shapes["ball"].frame == shapes["a/0"].frame
    wedge = shapes["wedge"]
    assert wedge.vertices.shape == (4, 3) and wedge.faces.shape == (4, 3)  # the fifth vertex lies within
    edges = wedge.vertices[wedge.faces[:, 1:]] - wedge.vertices[wedge.faces[:, :1]]
    normals = np.cross(edges[:, 0], edges[:, 1])
    outwards = wedge.vertices[wedge.faces[:, 0]] - wedge.vertices.mean(axis=0)
    assert (np.einsum("fi,fi->f", normals, outwards) > 0).all()


@pytest.mark.parametrize("filterparent", ["enable", "disable"])
def test_pairs_are_those_that_mujoco_tests(filterparent):
    """Bits, weld groups, parent and child, excludes, an explicit pair, the world as parent, and the flag."""
    bodies = ws.load_robot(arm(filterparent)).bodies
    reference = mujoco.MjModel.from_xml_string(arm(filterparent))
    names = [{bodies.shapes[k].name for k in pair} for pair in bodies.pairs]
    expected = [{geom_name(reference, geom) for geom in pair} for pair in contacts_of(reference)]
    assert sorted(map(sorted, names)) == sorted(map(sorted, expected))
    assert {"egg", "wedge"} in names  # an explicit pair of parent and child
    assert ({"ball", "jaw"} in names) == (filterparent == "disable")


BITS = st.integers(0, 3)


@st.composite
def models(draw):
    """Trees of bodies with joints or none, geoms with any bits, excludes and explicit pairs."""
    count = draw(st.integers(2, 7))
    parents = [0, *(draw(st.integers(0, k)) for k in range(1, count))]  # of body k + 1; 0 is the world
    tree = dict.fromkeys(range(count + 1), "")
    for body in range(count, 0, -1):
        joint = f"<joint name='j{body}' range='-1 1'/>" if body == 1 or draw(st.booleans()) else ""
        geoms = "".join(
            f"<geom name='g{body}{k}' type='{draw(st.sampled_from(['sphere', 'capsule']))}' size='.1 .1 .1' "
            f"contype='{draw(BITS)}' conaffinity='{draw(BITS)}' mass='1'/>"
            for k in range(draw(st.integers(1, 2)))
        )
        tree[parents[body - 1]] += f"<body name='b{body}' pos='.1 .2 .3'>{joint}{geoms}{tree[body]}</body>"
    two = st.lists(st.integers(1, count), min_size=2, max_size=2, unique=True).map(tuple)
    excluded = draw(st.lists(two, max_size=3, unique_by=frozenset))
    paired = draw(st.lists(two, max_size=2, unique_by=frozenset))
    contact = "".join(f"<exclude body1='b{i}' body2='b{j}'/>" for i, j in excluded)
    contact += "".join(f"<pair geom1='g{i}0' geom2='g{j}0'/>" for i, j in paired)
    flag = draw(st.sampled_from(["enable", "disable"]))
    option = f"<option><flag filterparent='{flag}'/></option>"
    return f"<mujoco>{option}<worldbody>{tree[0]}</worldbody><contact>{contact}</contact></mujoco>"


@settings(max_examples=60, deadline=None)
@given(models())
def test_pairs_of_any_model_are_those_that_mujoco_tests(text):
    bodies = ws.load_robot(text, tip="b1").bodies
    reference = mujoco.MjModel.from_xml_string(text)
    named = [{bodies.shapes[k].name for k in pair} for pair in bodies.pairs]
    expected = [{reference.geom(geom).name for geom in pair} for pair in contacts_of(reference)]
    assert sorted(map(sorted, named)) == sorted(map(sorted, expected))


def test_pairs_that_are_excluded():
    whole = ws.load_robot(arm()).pairs
    less = ws.load_robot(arm(), exclude=[("egg", "foot/0"), ("shelf", "b")]).pairs
    assert {"shelf", "wedge"} in pairs_in(whole) and {"shelf", "wedge"} not in pairs_in(less)
    assert len(less) == len(whole) - 1
    more = ws.load_robot(arm(), exclude=[("shelf", "c"), ("b", "shelf")]).pairs
    assert len(more) == len(whole) - 2


def test_a_body_stands_for_all_of_its_shapes():
    text = arm().replace(
        '<geom name="shelf" size=".2"/>', '<geom name="shelf" size=".2"/><geom name="lamp" size=".1"/>'
    )
    whole, less = ws.load_robot(text).pairs, ws.load_robot(text, exclude=[("shelf", "egg")]).pairs
    assert [pair for pair in pairs_in(whole) if pair not in pairs_in(less)] == [{"egg", "shelf"}, {"egg", "lamp"}]


def test_a_models_unit_is_that_of_its_shapes():
    small, whole = ws.load_robot(arm(), length_unit_m=0.1).shapes, ws.load_robot(arm()).shapes
    for name in ("size_m", "position_m"):
        np.testing.assert_allclose(small[name], whole[name] / 10, atol=1e-8)


def pairs_in(table):
    return [{*names} for names in zip(table["first"], table["second"], strict=True)]


def test_excludes_that_name_nothing():
    with pytest.raises(InputError, match="is named 'eg'; did you mean 'egg'") as caught:
        ws.load_robot(arm(), exclude=[("shelf", "c"), ("eg", "shelf")])
    assert caught.value.field == "exclude.1"
    job = {"analysis": "workspace", "robot": {"mjcf": arm(), "exclude": [["egg", "zebra"]]}, "sampling": {"count": 9}}
    with pytest.raises(InputError, match=r"is named 'zebra'; there are floor, ") as caught:
        ws.execute(job | {"sampling": {"method": "random", "count": 9}, "device": "cpu"})
    assert caught.value.field == "robot.exclude.0"
    shapes = "".join(f"<geom name='s{k}' size='.01'/>" for k in range(20))
    with pytest.raises(InputError, match=r"is named 'zebra'; there are s0, (\w+, ){8}s8 and 24 more$"):
        ws.load_robot(arm().replace("<geom", shapes + "<geom", 1), exclude=[("s1", "zebra")])


SRDF = """<robot name="arm"><disable_collisions link1="shelf" link2="c" reason="Never"/>
  <disable_collisions link1="nothing" link2="c"/><group name="all"/></robot>"""


@pytest.mark.parametrize("as_file", [True, False])
def test_pairs_that_an_srdf_disables(tmp_path, as_file):
    (tmp_path / "arm.srdf").write_text(SRDF)
    robot = ws.load_robot(arm(), srdf=tmp_path / "arm.srdf" if as_file else SRDF)
    with pytest.warns(ModelWarning, match="names 1 links that the robot does not have: nothing"):
        pairs = pairs_in(robot.pairs)
    whole = pairs_in(ws.load_robot(arm()).pairs)
    assert [pair for pair in whole if pair not in pairs] == [{"egg", "shelf"}]
    assert robot.spec is not None and robot.spec.srdf == SRDF  # a job document holds it
    touching = {"self_collision": True}  # which refuses a job that has asked for shapes
    with pytest.warns(ModelWarning, match="names 1 links") as caught, pytest.raises(InputError, match="in every conf"):
        ws.workspace(ws.load_robot(arm(), srdf=SRDF), ws.Random(1000), constraints=touching)
    assert [each.filename for each in caught if each.category is ModelWarning] == [__file__]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<mujoco/>", "the root element is <mujoco>; <robot> is needed"),
        ("<robot><disable_collisions link1='a'/></robot>", "has no link1 or no link2"),
        ("<robot><disable_default_collisions link='a'/></robot>", "is not supported: name the pairs"),
        ("<!DOCTYPE a [<!ENTITY b 'c'>]><robot/>", "are refused"),
        ("no.srdf", "there is no file 'no.srdf'"),
    ],
)
def test_srdf_that_is_refused(text, message):
    with pytest.raises(ModelError, match=message) as caught:
        ws.load_robot(arm(), srdf=text)
    assert caught.value.field == "srdf"


def test_an_srdf_in_another_encoding_is_refused(tmp_path):
    (tmp_path / "arm.srdf").write_bytes('<robot name="é"/>'.encode("latin-1"))
    with pytest.raises(ModelError, match=r"srdf: arm\.srdf is not UTF-8"):
        ws.load_robot(arm(), srdf=tmp_path / "arm.srdf")


def test_tables():
    robot = ws.load_robot(arm())
    shapes, visuals = robot.shapes, robot.visuals
    assert shapes["name"].tolist() == [shape.name for shape in robot.bodies.shapes]
    assert shapes["frame"].tolist() == [shape.frame for shape in robot.bodies.shapes]
    assert "seen" not in shapes["name"] and "seen" in visuals["name"] and "floor" not in visuals["name"]
    row = shapes["name"].tolist().index("a/0")
    assert shapes["size_m"][row].tolist() == [0.1, 0.2, 0.3]
    assert shapes.units["position_m"] == "m"
    assert len(robot.pairs) == len(robot.bodies.pairs)


def test_robots_without_shapes_have_empty_tables():
    table = ws.DHTable(convention="standard", rows=(ws.DHRow(a=1.0),))
    robot = ws.load_robot(table)
    assert len(robot.shapes) == len(robot.pairs) == len(robot.visuals) == 0

    class Class:
        limits = ((-1, 1),)

        def forward_kinematics(self, q):
            return np.tile(np.eye(4), (len(q), 1, 1))

    with pytest.raises(InputError, match="defined by a Python class, which has no shapes"):
        _ = ws.robot.as_robot(Class()).shapes


BRANCHES = """<mujoco><compiler angle="radian"/><worldbody><body name="a"><joint name="i" range="-1 1"/>
    <geom name="a" size=".1"/><site name="tool" pos="1 0 0"/>
    <body name="jaw" pos=".5 0 0"><joint name="grip" axis="0 1 0" ref=".1"/><geom size=".1" pos=".3 0 0"/></body>
    <body name="jaw2" pos=".5 0 0"><joint name="second"/><geom size=".1" pos=".3 0 0"/></body></body></worldbody>
  <equality><joint joint1="second" joint2="grip" polycoef=".2 -.5 .1 0 0"/></equality></mujoco>"""


def test_branches_stand_at_their_reference():
    """Shapes, and what the arm carries; what follows such a joint stands where that puts it."""
    robot = ws.load_robot(BRANCHES, reference={"grip": 0.6})
    model = mujoco.MjModel.from_xml_string(BRANCHES)
    data, M = mujoco.MjData(model), np.empty((3, 3))
    data.joint("i").qpos, data.joint("grip").qpos = 0.4, 0.6
    data.joint("second").qpos = 0.2 - 0.5 * 0.5 + 0.1 * 0.25
    mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, M)
    q = np.array([[0.4]])
    np.testing.assert_allclose(robot.bodies.poses(q)[0, :, :3, 3], data.geom_xpos, atol=POSE)
    for method in ("kernel", "mujoco"):
        np.testing.assert_allclose(robot.inertia_matrix(q, method=method, device="cpu")[0, 0, 0], M[0, 0], rtol=1e-12)
    assert robot.spec is not None and robot.spec.model_dump(mode="json")["reference"] == {"grip": 0.6}
    assert ws.robot.robot_of_spec(robot.spec).bodies.qpos(q).tolist() == robot.bodies.qpos(q).tolist()


@pytest.mark.parametrize("name", ["i", "second", "gripp", "nothing"])
def test_references_of_what_does_not_stand_by_itself(name):
    with pytest.raises(InputError, match=r"is no joint that stands still beside the chain; .*grip") as caught:
        ws.load_robot(BRANCHES, reference={name: 0.0})
    assert caught.value.field == f"reference.{name}"


def test_the_number_of_shapes_is_bounded():
    text = arm().replace(
        '<geom name="shelf"', '<replicate count="1000" offset="0 0 1"><geom size=".1"/></replicate><geom'
    )
    with pytest.raises(ModelError, match="the model has 1008 shapes; at most 1000 are supported"):
        _ = ws.load_robot(text).pairs


@pytest.mark.parametrize(
    ("geom", "message"),
    [
        (
            "<geom name='g' type='mesh' mesh='m'/>",
            "geom 'g' of body 'a' may collide, but its file 'm.stl' is not there",
        ),
        ("<geom name='g' type='hfield' hfield='h'/>", "geom 'g' .* may collide, but heights are read from"),
    ],
)
def test_shapes_that_cannot_be_had(geom, message):
    """An error of those who ask for shapes; others load the model as before."""
    text = f"""<mujoco><asset><mesh name="m" file="m.stl"/><hfield name="h" nrow="2" ncol="2" size="1 1 1 1"/></asset>
      <worldbody><body name="a"><inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/><joint range="-1 1"/>{geom}
      <geom name="s" size="1"/><site name="tool" pos="1 0 0"/></body></worldbody></mujoco>"""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        robot = ws.load_robot(text)
    with pytest.raises(ModelError, match=message) as caught:
        _ = robot.shapes
    assert caught.value.field == "robot.mjcf"


@pytest.mark.parametrize("filterparent", ["enable", "disable"])
def test_models_made_with_mujoco_keep_their_shapes_and_pairs(filterparent):
    """What is text in a job document has the shapes of the MjSpec or MjModel; a mesh that may collide, its hull."""
    right, spec = ws.load_robot(arm(filterparent)), mujoco.MjSpec.from_string(arm(filterparent))
    q = configurations(right)
    for source in (spec, spec.compile()):
        robot = ws.load_robot(source)
        assert robot.shapes["name"].tolist() == right.shapes["name"].tolist()
        assert pairs_in(robot.pairs) == pairs_in(right.pairs)
        for ours, theirs, T, T_right in zip(
            robot.bodies.shapes, right.bodies.shapes, robot.bodies.poses(q)[0], right.bodies.poses(q)[0], strict=True
        ):
            assert (ours.kind, ours.size.tolist()) == (theirs.kind, theirs.size.tolist())
            if ours.kind != "mesh":
                np.testing.assert_allclose(T, T_right, atol=1e-14)
            corners, expected = (
                each.vertices @ pose[:3, :3].T + pose[:3, 3] for each, pose in ((ours, T), (theirs, T_right))
            )
            gaps = np.linalg.norm(corners[:, None] - expected[None], axis=2)
            assert not len(gaps) or max(gaps.min(axis=0).max(), gaps.min(axis=1).max()) < 1e-7
