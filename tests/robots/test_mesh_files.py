"""Meshes of files: their triangles, URDF shapes of them against MuJoCo's own compile, hulls that are simplified."""

import mujoco
import numpy as np
import pytest
import trimesh
from scipy.spatial import ConvexHull

import wsrender as ws
from wsrender.errors import ModelError
from wsrender.robots import hulls, load, load_urdf, mesh_files
from wsrender.robots.model_warning import ModelWarning

BRICK = trimesh.creation.box((0.1, 0.2, 0.3))
BRICK.apply_translation((0.05, 0.0, 0.1))
DAE = """<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit meter="0.01"/><up_axis>Y_UP</up_axis></asset>
  <library_geometries><geometry id="g"><mesh>
    <source id="p"><float_array id="a" count="12">0 0 0 1 0 0 0 2 0 0 0 3</float_array></source>
    <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
    <triangles><input semantic="VERTEX" source="#v" offset="0"/><input semantic="NORMAL" source="#n" offset="1"/>
      <p>0 0 1 0 2 0 0 1 1 1 3 1</p></triangles>
    <polylist count="1"><input semantic="VERTEX" source="#v" offset="0"/><vcount>4</vcount><p>0 1 2 3</p></polylist>
  </mesh></geometry></library_geometries>
  <library_nodes><node id="n"><instance_geometry url="#g"/></node></library_nodes>
  <library_visual_scenes><visual_scene id="s">
    <node><translate>10 0 0</translate><rotate>0 0 1 90</rotate><scale>2 1 1</scale><instance_geometry url="#g"/></node>
    <node><matrix>1 0 0 5 0 1 0 0 0 0 1 0 0 0 0 1</matrix><instance_node url="#n"/></node>
  </visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#s"/></scene></COLLADA>"""


def same_triangles(found, mesh, atol):
    vertices, faces = found
    assert len(faces) == len(mesh.faces)
    ours, theirs = (
        np.sort(np.asarray(each).reshape(-1, 9).round(9), axis=0) for each in (vertices[faces], mesh.triangles)
    )
    np.testing.assert_allclose(ours, theirs, atol=atol)


@pytest.mark.parametrize("suffix", ["stl", "stl_ascii", "obj"])
def test_files_have_the_triangles_that_were_written(suffix):
    written = BRICK.export(file_type=suffix)
    content = written.encode() if isinstance(written, str) else written
    same_triangles(mesh_files.triangles(content, f"brick.{suffix[:3].upper()}", "model"), BRICK, 1e-7)


def test_obj_counts_from_the_end_and_has_polygons():
    content = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n# v\nvt 0 0\nf -4/1 -3/1 -2/1 -1/1\nv 0 0 1\nf 1//2 2//2 -1//2\n"
    vertices, faces = mesh_files.triangles(content, "a.obj", "model")
    assert vertices.shape == (5, 3) and faces.tolist() == [[0, 1, 2], [0, 2, 3], [0, 1, 4]]


def test_collada_has_units_places_and_instances_but_no_axis_that_is_up():
    vertices, faces = mesh_files.triangles(DAE.encode(), "a.dae", "model")
    assert len(faces) == 8 and faces.max() == len(vertices) - 1
    corners = {tuple(row) for row in vertices.round(9) + 0.0}
    assert corners == {(0.1, 0, 0), (0.1, 0.02, 0), (0.08, 0, 0), (0.1, 0, 0.03),
                       (0.05, 0, 0), (0.06, 0, 0), (0.05, 0.02, 0), (0.05, 0, 0.03)}  # fmt: skip


@pytest.mark.parametrize(
    ("content", "name", "message"),
    [
        (b"", "a.stl", "0 bytes are no file of 0 triangles"),
        (b"x" * 84 + b"x" * 49, "a.stl", "are no file of"),
        (b"solid a\nendsolid", "a.stl", "has no triangles"),
        (bytes(84), "a.stl", "has no triangles"),
        (b"solid a\nvertex 1 2\n", "a.stl", "three numbers"),
        (b"v 0 0 nan\nv 0 0 1\nv 0 1 1\nf 1 2 3", "a.obj", "must hold finite numbers"),
        (b"v 0 0 0\nf 1 2 3", "a.obj", "names vertices that it does not have"),
        (b"v 0 0 0\nf 1 two 3", "a.obj", "invalid literal"),
        (b"v 0 0 0\nf -9 1 1", "a.obj", "names vertices that it does not have"),
        (b"<COLLADA/>", "a.dae", "has no triangles"),
        (DAE.replace('url="#g"', 'url="other.dae#g"').encode(), "a.dae", "cannot be read as .dae"),
        (b"<!DOCTYPE a [<!ENTITY b SYSTEM '/etc/passwd'>]><a>&b;</a>", "a.dae", "external references are refused"),
        (b"fbx", "a.fbx", r"of a format that is not read; allowed: .*\.dae.*\.obj, .*\.stl"),
        (b"", "mesh", "of a format that is not read"),
    ],
)
def test_files_that_are_refused(content, name, message):
    with pytest.raises(ModelError, match=message):
        mesh_files.triangles(content, name, "model")


def test_a_node_that_holds_itself_is_refused():
    loop = DAE.replace('<node id="n">', '<node id="n"><instance_node url="#n"/>')
    with pytest.raises(ModelError, match="a node is an instance of itself"):
        mesh_files.triangles(loop.encode(), "a.dae", "model")


def test_nodes_that_double_are_refused():
    twice = "".join(f'<node id="d{k}">{2 * f"""<instance_node url="#d{k + 1}"/>"""}</node>' for k in range(60))
    doubling = DAE.replace('<node id="n">', f'{twice}<node id="d60"/><node id="n"><instance_node url="#d0"/>')
    with pytest.raises(ModelError, match="its nodes are instances of more than 20000 others"):
        mesh_files.triangles(doubling.encode(), "a.dae", "model")


def test_the_number_of_vertices_without_triangles_is_bounded(monkeypatch):
    bare = DAE.replace("<p>0 0 1 0 2 0 0 1 1 1 3 1</p>", "").replace("<p>0 1 2 3</p>", "")
    bare = bare.replace("<vcount>4</vcount>", "")
    monkeypatch.setattr(mesh_files, "MAX_CORNERS", 6)
    with pytest.raises(ModelError, match="more than 2 triangles"):
        mesh_files.triangles(bare.encode(), "a.dae", "model")


def test_the_number_of_triangles_is_bounded(monkeypatch):
    monkeypatch.setattr(mesh_files, "MAX_CORNERS", 6)
    with pytest.raises(ModelError, match="has 12 triangles; allowed: 2"):
        mesh_files.triangles(BRICK.export(file_type="stl"), "a.stl", "model")
    with pytest.raises(ModelError, match="more than 2 triangles"):
        mesh_files.triangles(DAE.encode(), "a.dae", "model")


@pytest.mark.parametrize("address", ["meshes/a.stl", "package://arm/meshes/a.stl", "file://{}/meshes/a.stl"])
def test_files_are_where_their_addresses_say(tmp_path, address):
    folder = tmp_path / "arm" / "urdf"
    (tmp_path / "arm" / "meshes").mkdir(parents=True)
    (tmp_path / "arm" / "meshes" / "a.stl").write_bytes(b"there")
    folder.mkdir()
    base = tmp_path / "arm" if address.startswith("meshes") else folder
    assert mesh_files.from_folder(base)(address.format(tmp_path / "arm")) == b"there"
    assert mesh_files.from_folder(base)("package://leg/meshes/a.stl") is None


def test_packages_are_looked_for_where_ros_has_them(tmp_path, monkeypatch):
    (tmp_path / "ws" / "arm").mkdir(parents=True)
    (tmp_path / "ws" / "arm" / "a.stl").write_bytes(b"there")
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "ws"))
    assert mesh_files.from_folder(tmp_path / "elsewhere")("package://arm/a.stl") == b"there"


URDF = """<robot name="arm"><material name="red"><color rgba="1 0 0 1"/></material>
  <link name="foot"><collision><geometry><cylinder radius=".1" length=".2"/></geometry></collision></link>
  <link name="a"><visual><geometry><mesh filename="seen.obj"/></geometry><material name="red"/></visual>
    <collision name="brick"><origin xyz=".1 0 .2" rpy=".1 .2 .3"/><geometry>
      <mesh filename="meshes/brick.{suffix}" scale="{scale}"/></geometry></collision>
    <collision><origin xyz="0 .1 0"/><geometry><box size=".1 .2 .3"/></geometry></collision></link>
  <link name="b"><collision><geometry><sphere radius=".05"/></geometry></collision></link>
  <link name="tip"/>
  <joint name="i" type="revolute"><parent link="foot"/><child link="a"/><origin xyz="0 0 .1"/><axis xyz="0 0 1"/>
    <limit lower="-2" upper="2" effort="1"/></joint>
  <joint name="j" type="revolute"><parent link="a"/><child link="b"/><origin xyz=".3 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" effort="1"/></joint>
  <joint name="k" type="fixed"><parent link="b"/><child link="tip"/><origin xyz=".2 0 0"/></joint></robot>"""
FILES = {"stl": BRICK.export(file_type="stl"), "obj": BRICK.export(file_type="obj").encode()}


def loaded(tmp_path, suffix="stl", scale="1 1 1", urdf=URDF, content=None):
    (tmp_path / "meshes").mkdir(exist_ok=True)
    (tmp_path / "meshes" / f"brick.{suffix}").write_bytes(FILES[suffix] if content is None else content)
    (tmp_path / "arm.urdf").write_text(urdf.format(suffix=suffix, scale=scale))
    return ws.load_robot(tmp_path / "arm.urdf", tip="tip")


@pytest.mark.parametrize("scale", ["1 1 1", ".5 -1 2"])
@pytest.mark.parametrize("suffix", ["stl", "obj"])
def test_collisions_of_a_urdf_are_those_of_mujoco(tmp_path, suffix, scale):
    robot = loaded(tmp_path, suffix, scale)
    text = URDF.format(suffix=suffix, scale=scale)
    compiler = '<mujoco><compiler strippath="false" fusestatic="false"/></mujoco><link name="foot">'
    text = text.replace('<link name="foot">', compiler, 1).replace("<link ", "<link ")
    reference = mujoco.MjModel.from_xml_string(text, {f"meshes/brick.{suffix}": FILES[suffix]})
    compare(robot, reference, 5)


def compare(robot, reference, count, tolerance=1e-7):
    """Every shape where MuJoCo's own reader of URDF has it; of meshes, all vertices of the hull."""
    bodies, data = robot.bodies, mujoco.MjData(reference)
    q = np.random.default_rng(2).uniform(robot.lower_limits, robot.upper_limits, (count, robot.chain.n))
    geoms = [geom for geom in range(reference.ngeom) if reference.geom_contype[geom]]
    assert len(geoms) == len(bodies.shapes)
    for row, poses in zip(q, bodies.poses(q), strict=True):
        for joint, value in zip(robot.joint_names, row, strict=True):
            data.joint(joint).qpos = value
        mujoco.mj_kinematics(reference, data)
        for geom, shape, T in zip(geoms, bodies.shapes, poses, strict=True):
            R, p = data.geom_xmat[geom].reshape(3, 3), data.geom_xpos[geom]
            if shape.kind == "mesh":
                theirs = hulls.hull_of(reference, geom)[0] @ R.T + p
                ours = shape.vertices @ T[:3, :3].T + T[:3, 3]
                assert len(ours) == len(theirs)
                gaps = np.linalg.norm(ours[:, None] - theirs[None], axis=2)
                assert max(gaps.min(axis=0).max(), gaps.min(axis=1).max()) < tolerance
            else:
                np.testing.assert_allclose(T[:3, 3], p, atol=1e-12)
                np.testing.assert_allclose(T[:3, :3], R, atol=1e-12)
                np.testing.assert_array_equal(shape.size, reference.geom_size[geom])


def test_visuals_of_a_urdf_are_kept_apart(tmp_path):
    (tmp_path / "seen.obj").write_bytes(FILES["obj"])
    robot = loaded(tmp_path)
    assert robot.shapes["kind"].tolist() == ["cylinder", "mesh", "box", "sphere"]
    assert robot.shapes["frame"].tolist() == [-1, 0, 0, 1]
    visuals = robot.visuals
    assert (visuals["kind"].tolist(), visuals["rgba"].tolist()) == (["mesh"], [[1, 0, 0, 1]])
    assert len(robot.bodies.pairs) == 3 and not robot.bodies.shapes[0].surroundings


def test_visuals_that_are_not_there_are_told(tmp_path):
    robot = loaded(tmp_path)
    with pytest.warns(ModelWarning, match=r"1 shapes are not drawn: link 'a': its visual <mesh>: the file 'seen.obj'"):
        assert len(robot.visuals) == 0


def test_a_urdf_without_visuals_is_seen_by_what_collides(tmp_path):
    robot = loaded(tmp_path, urdf=URDF.replace("<visual>", "<nothing>").replace("</visual>", "</nothing>"))
    assert robot.visuals["kind"].tolist() == robot.shapes["kind"].tolist()


def test_meshes_in_millimetres_are_noticed(tmp_path):
    large = BRICK.copy()
    large.apply_scale(1000)
    robot = loaded(tmp_path, content=large.export(file_type="stl"))
    with pytest.warns(ModelWarning, match=r"mesh of 'a/0' is \d+ m long, and the arm reaches .* scale 0.001"):
        _ = robot.shapes
    assert len(loaded(tmp_path, content=large.export(file_type="stl"), scale=".001 .001 .001").shapes) == 4


def test_a_models_unit_is_that_of_its_meshes(tmp_path):
    loaded(tmp_path)
    small = ws.load_robot(tmp_path / "arm.urdf", tip="tip", length_unit_m=0.001)
    whole = ws.load_robot(tmp_path / "arm.urdf", tip="tip")
    for name in ("size_m", "position_m"):
        np.testing.assert_allclose(small.shapes[name], whole.shapes[name] / 1000, atol=1e-9)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("brick.{suffix}", "none.stl"), "link 'a': its collision <mesh>: the file 'meshes/none.stl' is not there"),
        (("{scale}", "1 0 1"), "encloses no volume: its vertices lie in a plane"),
        (("{scale}", "1 1"), "scale is '1 1'; 3 numbers are needed"),
        (
            ('.1 .2 .3"/></geometry></collision></link>', '-.1 .2 .3"/></geometry></collision></link>'),
            "must be positive",
        ),
        (('<sphere radius=".05"/>', "<torus/>"), "link 'b': its collision <torus> is of no known kind; allowed: box, "),
    ],
)
def test_collisions_that_are_refused(tmp_path, change, message):
    robot = loaded(tmp_path, urdf=URDF.replace(*change))
    with pytest.raises(ModelError, match=message) as caught:
        _ = robot.pairs
    assert caught.value.field == "robot.path"


def test_text_reads_no_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    loaded(tmp_path)
    text = URDF.format(suffix="stl", scale="1 1 1")
    with pytest.warns(ModelWarning, match="meshes is dropped"):
        robot = ws.load_robot(text, tip="tip")
    given = load_urdf(text, assets={"brick.stl": FILES["stl"]}, tip="tip")
    with pytest.raises(ModelError, match=r"the file 'meshes/brick\.stl' is not there"):
        _ = robot.shapes
    assert [shape.kind for shape in given.bodies.shapes] == ["cylinder", "mesh", "box", "sphere"]


def test_large_hulls_are_simplified_outwards(tmp_path, monkeypatch):
    """The model that MuJoCo tests has the same hull; on bodies that turn their own axes as well."""
    ball = trimesh.creation.icosphere(3, 0.1)
    ball.apply_scale((1, 2, 3))
    ball.apply_transform(trimesh.transformations.euler_matrix(0.3, 0.4, 0.5))  # its principal axes are not the file's
    robot = loaded(tmp_path, content=ball.export(file_type="stl"))
    exact = robot.bodies
    monkeypatch.setattr(hulls, "MOST_VERTICES", 600)
    simpler = loaded(tmp_path, content=ball.export(file_type="stl"))
    with pytest.warns(
        ModelWarning, match=r"hulls are simplified, by at most 0.5 % of their size outwards: a/0 642 → \d+ vertices"
    ):
        bodies = simpler.bodies
    q = np.zeros((1, 2))
    before, after = (each.shapes[1].vertices @ T[:3, :3].T + T[:3, 3]
                     for each in (exact, bodies) for T in [each.poses(q)[0, 1]])  # fmt: skip
    assert len(before) == 642 > 600 >= len(after)
    planes = ConvexHull(after).equations
    assert (before @ planes[:, :3].T + planes[:, 3]).max() < 1e-7
    closest = trimesh.proximity.closest_point_naive(trimesh.Trimesh(before, ConvexHull(before).simplices), after)[1]
    assert closest.max() <= 5e-3 * 0.6 + 1e-6
    monkeypatch.setattr(hulls, "MOST_VERTICES", 20)
    with pytest.raises(ModelError, match=r"hull of shape 'a/0' has 642 vertices; 20 that hold it go more than 0.5 %"):
        _ = loaded(tmp_path, content=ball.export(file_type="stl")).bodies


def test_a_mesh_of_three_vertices_is_not_drawn_and_does_not_collide(tmp_path):
    """Files that others publish have such among their visuals."""
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    text = (
        '<robot name="r"><link name="a"/><link name="b">{}</link><joint name="j" type="revolute"><parent link="a"/>'
        '<child link="b"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>'
    )
    mesh = '<geometry><mesh filename="a.obj"/></geometry>'
    (tmp_path / "seen.urdf").write_text(text.format(f"<visual>{mesh}</visual>"))
    seen = load(tmp_path / "seen.urdf").visuals
    assert seen.shapes == () and "'a.obj' has 3 vertices; at least 4" in seen.notices[0].message
    (tmp_path / "meets.urdf").write_text(text.format(f"<collision>{mesh}</collision>"))
    with pytest.raises(ModelError, match=r"'a.obj' has 3 vertices; at least 4"):
        _ = load(tmp_path / "meets.urdf").bodies
