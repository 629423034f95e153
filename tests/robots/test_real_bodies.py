"""Bodies of real robots against MuJoCo's own reader of URDF; skipped where example-robot-data is not installed."""

import re
import warnings
from pathlib import Path

import mujoco
import numpy as np
import pytest

import wsrender as ws
from tests.robots.model_packages import folders
from tests.robots.test_bodies import contacts_of, pairs_in
from tests.robots.test_mesh_files import compare
from wsrender.robots import mesh_files
from wsrender.robots.compiled_model import quiet
from wsrender.robots.model_warning import ModelWarning

if not (ROBOTS := next((each for each in folders() if each.parent.name == "example-robot-data"), None)):
    pytest.skip('example-robot-data is not installed: pip install ".[test-models]"', allow_module_level=True)

# STL, OBJ and primitives, several shapes on a link, fixed links between, other branches, mimic joints.
CASES = [
    ("panda_description/urdf/panda.urdf", "panda_link0", "panda_hand_tcp"),
    ("ur_description/urdf/ur5_robot.urdf", "world", "tool0"),
    ("xarm_description/urdf/xarm7.urdf", "world", "link_eef"),
    ("talos_data/robots/talos_left_arm.urdf", None, "gripper_left_base_link"),
    ("allegro_hand_description/urdf/allegro_left_hand.urdf", None, "link_3.0_tip"),
    ("ur_description/urdf/ur10_robot.urdf", None, "tool0"),
    ("ur_description/urdf/ur3_robot.urdf", None, "tool0"),
]


def load(file, base, tip, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        return ws.load_robot(ROBOTS / file, base=base, tip=tip, **options)


def bodies_of(robot):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        return robot.bodies


def of_mujoco(file):
    """MuJoCo's model of a URDF: without visuals, every link a body of its own, meshes by their convex hulls."""
    path, assets = ROBOTS / file, {}
    read = mesh_files.from_folder(path.parent)

    def renamed(found):
        name = f"{len(assets)}{Path(found[1]).suffix.lower()}"
        assets[name] = read(found[1])
        return f'filename="{name}"'

    text = re.sub(r"<visual>.*?</visual>|<visual .*?</visual>|<\?xml.*?\?>", "", path.read_text(), flags=re.DOTALL)
    text = re.sub(r'(?<=<mesh )filename="([^"]*)"', renamed, text)
    compiler = '<compiler fusestatic="false" balanceinertia="true" boundmass="1e-9" boundinertia="1e-12"/>'
    with quiet():
        return mujoco.MjModel.from_xml_string(
            re.sub(r"(<robot[^>]*>)", rf"\1<mujoco>{compiler}</mujoco>", text), assets
        )


@pytest.mark.parametrize(("file", "base", "tip"), CASES, ids=lambda each: Path(str(each)).stem)
def test_shapes_and_pairs_are_those_of_mujoco(file, base, tip):
    robot = load(file, base, tip)
    bodies = bodies_of(robot)
    reference = of_mujoco(file)
    compare(robot, reference, 2)
    geoms = [geom for geom in range(reference.ngeom) if reference.geom_contype[geom]]
    of = {geom: shape.name for geom, shape in zip(geoms, bodies.shapes, strict=True)}
    root = {shape.name for shape in bodies.shapes if shape.body == bodies.shapes[0].body}
    expected = [{of[geom] for geom in pair} for pair in contacts_of(reference)]
    found = pairs_in(robot.pairs)
    found = [pair for pair in found if reference.geom_bodyid[geoms[0]] or not pair & root]  # the root may be its world
    assert sorted(map(sorted, found)) == sorted(map(sorted, expected))


def test_an_srdf_that_moveit_uses_disables_its_pairs():
    file, base, tip = CASES[0]
    srdf = ROBOTS / "panda_description/srdf/panda.srdf"
    disabled = [{*names} for names in re.findall(r'disable_collisions link1="(.*?)" link2="(.*?)"', srdf.read_text())]
    pairs, kept = load(file, base, tip).pairs, pairs_in(load(file, base, tip, srdf=srdf).pairs)
    links = [{first, second} for first, second in zip(pairs["first_body"], pairs["second_body"], strict=True)]
    expected = [pair for pair, of in zip(pairs_in(pairs), links, strict=True) if of not in disabled]
    assert kept == expected and 0 < len(kept) < len(pairs)


def test_pairs_of_a_robot_by_its_panda_hand_move_with_both_fingers():
    """The right finger follows the left one, the tip: its shapes move though it is on another branch."""
    robot = load("panda_description/urdf/panda.urdf", "panda_link0", "panda_leftfinger")
    bodies = bodies_of(robot)
    q = np.tile((robot.lower_limits + robot.upper_limits) / 2, (2, 1))
    q[:, -1] = 0.0, 0.04
    shapes = {shape.body: number for number, shape in enumerate(bodies.shapes)}
    left, right = (bodies.poses(q)[:, shapes[f"panda_{side}finger"], :3, 3] for side in ("left", "right"))
    for moved in (left[1] - left[0], right[1] - right[0]):
        assert np.linalg.norm(moved) == pytest.approx(0.04)
