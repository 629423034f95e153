"""Malformed, hostile and unsupported models: one clear exception each."""

from xml.etree.ElementTree import fromstring
from xml.sax.saxutils import quoteattr

import mujoco
import pytest

from wsrender import robots
from wsrender.errors import ModelError
from wsrender.robots import xml_source
from wsrender.robots.mjcf import _expanded

BOMB = "".join(f'<!ENTITY e{i} "{f"&e{i - 1};" * 10}">' for i in range(1, 9))
INERTIAL = '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'


def mjcf(body='<joint name="j"/>', more="", inertial=INERTIAL):
    return f'<mujoco><worldbody><body name="a" pos="1 0 0">{body}{inertial}</body></worldbody>{more}</mujoco>'


LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
LINKS = '<link name="a"/><link name="b"/>'


def joint(more=LIMIT, kind="revolute", parent="a", child="b", name="j"):
    return f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>{more}</joint>'


def urdf(joints=None, links=LINKS):
    return f'<robot name="r">{links}{joint() if joints is None else joints}</robot>'


def link(mass="1", ixx="1", more=""):
    inertia = f'<inertia ixx="{ixx}" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
    return f'<link name="a"/><link name="b"><inertial><mass value="{mass}"/>{inertia}</inertial>{more}</link>'


XML = {
    "empty": ("", "the model is empty"),
    "blank": (" \n\t", "the model is empty"),
    "binary garbage": (b"\x89PNG\r\n\x1a\n\x00\xff", "not well-formed XML"),
    "plain text": ("six joints, please", "not well-formed XML: syntax error .line 1"),
    "cut short": ("<mujoco><worldbody>", "not well-formed XML: no element found"),
    "mismatched tags": ("<mujoco><a></b></mujoco>", "not well-formed XML: mismatched tag"),
    "attribute twice": ('<robot name="a" name="b"/>', "not well-formed XML: duplicate attribute"),
    "lone surrogate": ("<robot>\ud800</robot>", "not well-formed XML"),
    "XML bomb": (f'<!DOCTYPE m [<!ENTITY e0 "ha">{BOMB}]><mujoco>&e8;</mujoco>', "entities .* are refused"),
    "external entity": (
        '<!DOCTYPE m [<!ENTITY x SYSTEM "file:///etc/passwd">]><mujoco>&x;</mujoco>',
        "refused",
    ),
    "external document type": ('<!DOCTYPE robot SYSTEM "http://localhost/x.dtd"><robot/>', "refused"),
    "undefined entity": ("<mujoco>&nbsp;</mujoco>", "not well-formed XML: undefined entity"),
    "nested too deep": ("<mujoco>" + "<body>" * 300, f"nested deeper than {xml_source.MAX_DEPTH}"),
    "too many elements": ("<mujoco>" + "<a/>" * 30_000, f"more than {xml_source.MAX_ELEMENTS} elements"),
    "too large": ("<mujoco>" + " " * 2**24, "has 16777224 characters; at most 16777216"),
    "wrong root": ("<collada/>", "the root element is <collada>; <(mujoco|robot)> is needed"),
}

MJCF = {
    "URDF given as MJCF": (urdf(), "the root element is <robot>; <mujoco> is needed"),
    "include": (mjcf(more='<include file="/etc/passwd"/>'), "includes are refused .*: inline the file, by"),
    "include in a body": (mjcf('<include file="arm.xml"/>'), "includes are refused"),
    "model asset": (mjcf(more='<asset><model name="m" file="m.xml"/></asset>'), "model assets are refused"),
    "attach": (mjcf('<attach model="m" prefix="p"/>'), "attached models are refused"),
    "composite": (mjcf('<composite type="cable" count="9 1 1"/>'), "composite bodies are not supported"),
    "flexcomp": (mjcf('<flexcomp type="grid" count="99 99 99"/>'), "flexible bodies are not supported"),
    "replicas by the million": (
        mjcf('<replicate count="999"><replicate count="999"><geom size="1"/></replicate></replicate>'),
        "replicas make .* elements; at most",
    ),
    "replicas fewer than none": (
        mjcf('<replicate count="0"><replicate count="99999"><geom size="1"/></replicate></replicate>'),
        "replicas make .* elements; at most",
    ),
    "names replicated to gigabytes": (
        mjcf(f'<replicate count="999"><geom size="1" name="{"a" * 99_999}"/></replicate>'),
        "replicas make 99900.* characters; at most",
    ),
    "a long word for a number": (mjcf(f'<joint axis="0 0 {"x" * 9999}"/>'), "'x{100}'…; a finite number is needed"),
    "digits of another script": (mjcf('<joint axis="0 0 ١"/>'), "axis is '١'; a finite number is needed"),
    "meshes made by the million": (
        mjcf(more='<asset><mesh name="m" builtin="plate" params="2000 1"/></asset>'),
        r"make up to 4e\+06 vertices; at most 100000",
    ),
    "a cone of a thousand million edges": (
        mjcf(more='<asset><mesh name="m" builtin="cone" params="1000000000 1"/></asset>'),
        r"make up to 1e\+18 vertices; at most 100000",
    ),
    "unknown element": (mjcf("<jiont/>"), "unrecognized element"),
    "unknown attribute": (mjcf('<joint nmae="j"/>'), "unrecognized attribute: 'nmae'"),
    "no joint": (mjcf(""), "there is no joint between base 'world' and tip 'a'"),
    "no body": ("<mujoco/>", "there is nothing to move"),
    "ball joint": (
        mjcf('<joint name="j" type="ball"/>'),
        "'j' is a ball joint on the chain from 'world' to 'a'",
    ),
    "free joint": (mjcf('<freejoint name="f"/>'), "'f' is a free joint on the chain from 'world' to 'a'"),
    "unnamed free joint": (mjcf("<freejoint/>"), "'joint1' is a free joint on the chain"),
    "unknown joint type": (mjcf('<joint type="screw"/>'), "invalid keyword: 'screw'"),
    "inverted limits": (mjcf('<joint name="j" range="1 -1"/>'), "joint 'j': its range is 1 … -1"),
    "NaN in a position": (
        mjcf('<site name="s" pos="0 nan 0"/>'),
        "<site> 's': pos is 'nan'; a finite number",
    ),
    "infinite limit": (
        mjcf('<joint name="j" range="-inf 1"/>'),
        "<joint> 'j': range is '-inf'; a finite number",
    ),
    "overflowing number": (
        mjcf('<joint name="j" ref="1e999"/>'),
        "<joint> 'j': ref is '1e999'; a finite number",
    ),
    "not a number": (mjcf('<joint name="j" axis="0 0 up"/>'), "<joint> 'j': axis is 'up'; a finite number"),
    "too few numbers": (mjcf('<joint name="j" axis="0 1"/>'), "'axis' does not have enough data"),
    "no room between limits": (mjcf('<joint name="j" range="1 1"/>'), "joint 'j': its range is 1 … 1"),
    "mesh of no use": (
        mjcf('<joint/><geom type="mesh"/>', "", ""),
        "comes from geometry, which is not there",
    ),
    "zero axis": (mjcf('<joint name="j" axis="0 0 0"/>'), "axis too small.*'j'"),
    "absurd length": (
        mjcf('<joint/><site name="tool" pos="1e200 0 0"/>'),
        "numbers are too large: T_tip is beyond 1e.09",
    ),
    "duplicate joint": (mjcf('<joint name="j"/><joint name="j"/>'), "repeated name 'j' in joint"),
    "duplicate body": (mjcf('<joint/><body name="a"/>'), "repeated name 'a' in body"),
    "negative mass": (
        mjcf(inertial='<inertial pos="0 0 0" mass="-1" diaginertia="1 1 1"/>'),
        "link 'a': its mass is -1 kg",
    ),
    "negative inertia": (
        mjcf(inertial='<inertial pos="0 0 0" mass="1" diaginertia="1 1 -1"/>'),
        "link 'a': its inertia is -1",
    ),
    "coupling to nothing": (
        mjcf(more='<equality><joint joint1="j" joint2="k"/></equality>'),
        "unknown element 'k' in equality",
    ),
    "nonlinear coupling": (
        mjcf(
            '<joint name="j"/><joint name="k"/>',
            '<equality><joint joint1="j" joint2="k" polycoef="0 1 1 0 0"/></equality>',
        ),
        "joint 'j' follows another joint by a polynomial of higher degree",
    ),
    "closed loop": (
        mjcf(
            '<joint/><body name="b"><joint/><geom size="1"/></body>',
            '<equality><connect body1="b" anchor="0 0 0"/></equality>',
        ),
        "an equality ties b, world into a closed loop",
    ),
    "mesh that gives the inertia": (
        mjcf('<joint/><geom type="mesh" mesh="m"/>', '<asset><mesh name="m" file="m.stl"/></asset>', ""),
        "the inertia of body 'a' comes from m.stl, which is not there",
    ),
}

URDF = {
    "MJCF given as URDF": (mjcf(), "the root element is <mujoco>; <robot> is needed"),
    "no link": ("<robot name='r'/>", "the URDF has no <link>"),
    "SDF that includes a file": (
        "<sdf version='1.7'><include><uri>/etc</uri></include></sdf>",
        "the included model '/etc' is not there",
    ),
    "SDF that includes a page": (
        "<sdf version='1.7'><include><uri>http://127.0.0.1:1/a</uri></include></sdf>",
        "is not local; models are not downloaded",
    ),
    "SDF posed by itself": (
        "<sdf version='1.7'><model name='m'><link name='a'><pose relative_to='a'/></link></model></sdf>",
        "is said by its own",
    ),
    "SDF of many frames": (
        "<sdf version='1.7'><model name='m'><link name='a'><pose relative_to='f0'>0 0 0 0 0 0</pose></link>"
        + "".join(f"<frame name='f{k}'><pose relative_to='f{k + 1}'/></frame>" for k in range(3000))
        + "</model></sdf>",
        "is said by its own, or over too many frames",
    ),
    "unexpanded xacro": ("<robot name='r'><xacro:arm/></robot>", "<xacro:arm> is not expanded: give the path"),
    "xacro expression": (
        urdf(joint('<origin xyz="0 0 ${h}"/>' + LIMIT)),
        "origin xyz.*'.{h}'; a finite number",
    ),
    "no joint": (urdf("", '<link name="a"/>'), "there is no joint between base 'world' and tip 'a'"),
    "only fixed joints": (urdf(joint("", "fixed")), "there is no joint between base 'world' and tip 'b'"),
    "link without name": (urdf(links="<link/>" + LINKS), "a <link> has no name"),
    "joint without name": (urdf(joint(name="")), "a <joint> has no name"),
    "two links of a name": (urdf(links=LINKS + '<link name="a"/>'), "two links are named 'a'"),
    "two joints of a name": (
        urdf(joint() + joint(child="c"), LINKS + '<link name="c"/>'),
        "two joints are named 'j'",
    ),
    "unknown joint type": (
        urdf(joint(kind="screw")),
        "joint 'j' has type 'screw'; allowed: revolute, contin",
    ),
    "no child": (
        urdf('<joint name="j" type="fixed"><parent link="a"/></joint>'),
        "joint 'j' has no <child link",
    ),
    "unknown link": (urdf(joint(child="c")), "joint 'j' refers to link 'c', which does not exist"),
    "two roots": (urdf(links=LINKS + '<link name="c"/>'), "links a, c have no parent joint"),
    "two parents": (
        urdf(joint() + joint(parent="c", name="k"), LINKS + '<link name="c"/>'),
        "link 'b' is the child of two joints: 'j' and 'k'",
    ),
    "mimics in a cycle": (
        urdf(
            joint(LIMIT + '<mimic joint="k"/>') + joint(LIMIT + '<mimic joint="j"/>', "revolute", "b", "c", "k"),
            LINKS + '<link name="c"/>',
        ),
        "the couplings of joint 'j' form a cycle",
    ),
    "cycle": (urdf(joint() + joint(parent="b", child="a", name="k")), "the joints form a cycle through link"),
    "cycle beside a tree": (
        urdf(
            joint() + joint(parent="c", child="d", name="k") + joint(parent="d", child="c", name="l"),
            LINKS + '<link name="c"/><link name="d"/>',
        ),
        "the joints form a cycle through link",
    ),
    "nested too deep": (
        urdf(
            "".join(joint(parent=f"l{i}", child=f"l{i + 1}", name=f"j{i}") for i in range(400)),
            "".join(f'<link name="l{i}"/>' for i in range(401)),
        ),
        "links are nested deeper than",
    ),
    "missing limits": (urdf(joint("")), "revolute joint 'j' has no <limit>: give its limits"),
    "inverted limits": (
        urdf(joint('<limit lower="1" upper="-1"/>')),
        "its lower limit 1 is above its upper limit -1",
    ),
    "no room between limits": (
        urdf(joint('<limit lower="1" upper="1"/>')),
        "its limits are both 1, which leaves",
    ),
    "NaN limit": (urdf(joint('<limit lower="nan" upper="1"/>')), "joint 'j': lower limit is 'nan'"),
    "negative effort": (urdf(joint('<limit lower="0" upper="1" effort="-1"/>')), "its effort limit is -1"),
    "zero axis": (
        urdf(joint('<axis xyz="0 0 0"/>' + LIMIT)),
        "joint 'j': its axis is '0 0 0'; it must not be",
    ),
    "short axis": (
        urdf(joint('<axis xyz="0 1"/>' + LIMIT)),
        "joint 'j': axis is '0 1'; 3 numbers are needed",
    ),
    "bad origin": (urdf(joint('<origin rpy="0 0 left"/>' + LIMIT)), "origin rpy is 'left'; a finite number"),
    "floating joint": (urdf(joint("", "floating")), "joint 'j' is floating: name a base below it"),
    "planar joint": (urdf(joint("", "planar")), "joint 'j' is planar: name a base below it"),
    "mimic of itself": (urdf(joint(LIMIT + '<mimic joint="j"/>')), "joint 'j' mimics 'j', which is no other"),
    "mimic of nothing": (
        urdf(joint(LIMIT + '<mimic joint="k"/>')),
        "joint 'j' mimics 'k', which is no other",
    ),
    "negative mass": (urdf(links=link(mass="-1")), "link 'b': its mass is -1 kg; it must not be negative"),
    "negative inertia": (urdf(links=link(ixx="-1")), "link 'b': its inertia is -1; it must not be negative"),
    "infinite mass": (urdf(links=link(mass="inf")), "link 'b': mass is 'inf'; a finite number is needed"),
    "mass without number": (urdf(links=link(mass="")), "link 'b': mass is ''; a finite number is needed"),
    "inertial without mass": (
        urdf(links='<link name="a"/><link name="b"><inertial/></link>'),
        "its <inertial> has no <mass>",
    ),
    "indefinite inertia": (
        urdf(links=link().replace('ixy="0"', 'ixy="5"')),
        "link 'b': its inertia is not positive",
    ),
    "absurd inertia": (urdf(links=link(ixx="1e400")), "link 'b': ixx is '1e400'; a finite number is needed"),
}


@pytest.mark.parametrize("load", [robots.load_mjcf, robots.load_urdf])
@pytest.mark.parametrize(("text", "message"), XML.values(), ids=XML.keys())
def test_texts_that_are_no_model(load, text, message):
    with pytest.raises(ModelError, match=message):
        load(text)


@pytest.mark.filterwarnings("ignore::wsrender.robots.ModelWarning")
@pytest.mark.parametrize(("text", "message"), MJCF.values(), ids=MJCF.keys())
def test_mjcf(text, message):
    with pytest.raises(ModelError, match=message):
        robots.load_mjcf(text)


@pytest.mark.parametrize(("text", "message"), URDF.values(), ids=URDF.keys())
def test_urdf(text, message):
    with pytest.raises(ModelError, match=message):
        robots.load_urdf(text)


@pytest.mark.parametrize("name", ["garbage.xml", "wrong.urdf"])
def test_files(tmp_path, name):
    (tmp_path / "garbage.xml").write_bytes(b"\x00\x01\x02")
    (tmp_path / "wrong.urdf").write_text("<html/>")
    with pytest.raises(ModelError, match=r"not well-formed XML|<html>; <mujoco>, <robot> \(URDF\) or <sdf> is needed"):
        robots.load(tmp_path / name)


def test_an_inverted_range_off_the_chain_is_a_note():
    odd = '<body name="b"><joint name="odd" range="1 -1"/><geom size=".1"/></body>'
    text = mjcf('<joint name="j" range="-1 1"/>').replace("</worldbody>", f"{odd}</worldbody>")
    with pytest.warns(robots.ModelWarning, match="off the chain, .* joint 'odd': its range is 1 … -1") as caught:
        assert robots.load_mjcf(text, tip="a").chain.joint_names == ("j",)
    assert len(caught) == 1
    with pytest.raises(ModelError, match="joint 'odd': its range is 1 … -1"):
        robots.load_mjcf(text, tip="b")


@pytest.mark.parametrize("error", [ValueError("what"), KeyError("what"), RuntimeError("what"), IndexError("what")])
@pytest.mark.parametrize("stage", ["chain_extraction.extract", "urdf_model.read_urdf"])
def test_every_error_while_a_model_is_built_is_a_model_error(monkeypatch, error, stage):
    def broken(*_):
        raise error

    monkeypatch.setattr(f"wsrender.robots.{stage}", broken)
    with pytest.raises(ModelError, match=r"model: .*what"):
        robots.load_urdf(urdf(joint(LIMIT)))


COUNTS = ("+3", "", " 3", "3 ", "\t3\n", "3.0", "3e0", "1_0", "0x3", "٣", "０３", "3\u00a0", "3 4", "-3", "9" * 10, "x")


@pytest.mark.parametrize("count", COUNTS)
def test_counts_that_are_no_plain_digits_are_refused(count):
    """Some of these MuJoCo reads, as what Python might not: +3 as three."""
    text = mjcf(f'<joint range="-1 1"/><replicate count={quoteattr(count)}><geom size="1"/></replicate>')
    with pytest.raises(ModelError, match=r"<replicate>: count is .*; up to nine plain digits are needed"):
        robots.load_mjcf(text)


@pytest.mark.parametrize("count", ["0", "1", "007", "300"])
def test_counts_of_plain_digits_are_those_of_mujoco(count):
    inside = f'<replicate count="{count}"><replicate count="2"><geom size="1"/></replicate></replicate>'
    element = fromstring(mjcf(inside))
    made = mujoco.MjSpec.from_string(mjcf(inside))
    others = 3 + 1  # mujoco, worldbody, body; inertial
    # What is replicated no times is counted once: no bound needs to know.
    assert _expanded(element, "model")[0] == others + 1 + max(int(count), 1) * 3
    assert len(made.geoms) == 2 * int(count)


def test_what_a_model_could_make_large_or_slow_beside_its_kinematics_is_left_out():
    """Arrays of a chosen size, and a simulation of the muscles that would take years; the kinematics stay."""
    large = '<joint name="j" range="-1 1" user="1 2 3"/>'
    actuators = (
        '<compiler><lengthrange mode="all" inttotal="1e9" interval="1" timestep="1e-6"/></compiler><actuator>'
        '<general joint="j" dyntype="user" actdim="500000000"/><muscle joint="j" delay="1" nsample="16777216"/>'
        "</actuator>"
    )
    plain = robots.load_mjcf(mjcf('<joint name="j" range="-1 1"/>'))
    loaded = robots.load_mjcf(mjcf(large, actuators))
    assert (loaded.chain.T_tip == plain.chain.T_tip).all()
    assert loaded.chain.joint_names == ("j",)
