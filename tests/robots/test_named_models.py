"""Robots by the names of collections and of other programs; what a collection downloads is in its cache here."""

import json
import subprocess
import sys

import numpy as np
import pytest

import wsrender as ws
from tests.robots import model_packages
from wsrender.cli.job_command import job_document
from wsrender.errors import MissingExtraError, ModelError
from wsrender.robots import library, load, named_models

ARM = """<mujoco model="{}"><worldbody><body><joint name="j" axis="0 0 1" range="-60 60"/><geom size=".1"/>
  <site name="tool" pos=".5 0 0"/></body></worldbody></mujoco>"""


@pytest.fixture
def menagerie(tmp_path, monkeypatch):
    """A cache of MuJoCo Menagerie that has one robot."""
    mujoco_menagerie = pytest.importorskip("mujoco_menagerie")
    robot = mujoco_menagerie.get("universal_robots_ur5e")
    monkeypatch.setenv("MENAGERIE_CACHE_DIR", str(tmp_path))
    monkeypatch.setenv("MENAGERIE_BASE_URL", "file:///nowhere")
    folder = mujoco_menagerie.Cache().model_path(robot)
    folder.mkdir(parents=True)
    (folder / "ur5e.xml").write_text(ARM.format("ur5e"))
    (folder / "scene.xml").write_text('<mujoco model="scene"><include file="ur5e.xml"/></mujoco>')
    (folder / ".complete").write_text(json.dumps({"oid": robot.oid, "files": {}}))
    return folder


def test_menagerie(menagerie):
    robot = ws.load_robot("menagerie:universal_robots_ur5e")
    assert robot.name == "ur5e" and robot.spec.path == str(menagerie / "ur5e.xml")
    assert load("menagerie:universal_robots_ur5e/scene").chain.name == "scene"
    document = job_document("menagerie:universal_robots_ur5e")
    assert document == {"analysis": "workspace", "robot": {"path": str(menagerie / "ur5e.xml")}}
    assert ws.execute(document | {"sampling": {"method": "grid", "per_joint": 5}, "device": "cpu"}).document["headline"]


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("menagerie:universal_robots_ur5", "MuJoCo Menagerie has no 'universal_robots_ur5'; did you mean 'universal_"),
        ("menagerie:universal_robots_ur5e/none", "Menagerie's universal_robots_ur5e has no 'none'; it has"),
        ("menagerie:franka_emika_panda", "MuJoCo Menagerie cannot give 'franka_emika_panda': .*nowhere"),
        ("menagerie:../../etc", "MuJoCo Menagerie has no '..'"),
    ],
)
def test_what_menagerie_does_not_have(menagerie, name, message):
    with pytest.raises(ModelError, match=message):
        ws.load_robot(name)


def test_robot_descriptions(tmp_path, monkeypatch):
    """Its cache is a clone at the commit that it wants."""
    pytest.importorskip("robot_descriptions")
    clone = tmp_path / "clone"
    (clone / "universal_robots_ur5e").mkdir(parents=True)
    (clone / "universal_robots_ur5e" / "ur5e.xml").write_text(ARM.format("described"))
    identity = ["-c", "user.name=a", "-c", "user.email=a@b.c"]
    for command in (["init", "-q"], ["add", "."], [*identity, "commit", "-q", "-m", "a"]):
        subprocess.run(["git", *command], cwd=clone, check=True)
    head = subprocess.run(["git", "rev-parse", "HEAD"], cwd=clone, check=True, capture_output=True, text=True)
    commit = head.stdout.strip()
    (tmp_path / f"mujoco_menagerie-{commit}").mkdir()
    clone.rename(tmp_path / f"mujoco_menagerie-{commit}" / "mujoco_menagerie")
    monkeypatch.setenv("ROBOT_DESCRIPTIONS_CACHE", str(tmp_path))
    monkeypatch.setenv("ROBOT_DESCRIPTION_COMMIT", commit)
    monkeypatch.delitem(sys.modules, "robot_descriptions.ur5e_mj_description", raising=False)
    assert ws.load_robot("robot_descriptions:ur5e_mj_description").name == "described"
    monkeypatch.delitem(sys.modules, "robot_descriptions.ur5e_mj_description")
    with pytest.raises(ModelError, match="robot_descriptions has no 'ur5e'; did you mean"):
        ws.load_robot("robot_descriptions:ur5e")
    with pytest.raises(ModelError, match="robot_descriptions has no '_cache'"):  # no module but a description
        ws.load_robot("robot_descriptions:_cache")


def test_example_robot_data():
    if not any("example-robot-data" in str(path) for path in model_packages.files()):
        pytest.skip("example-robot-data is not installed")
    robot = ws.load_robot("example-robot-data:ur5_robot", tip="tool0")
    assert len(robot.joint_names) == 6
    assert ws.load_robot("example-robot-data:ur_description/urdf/ur5_robot.urdf", tip="tool0").spec == robot.spec
    with pytest.raises(ModelError, match="example-robot-data has no 'ur5_robots'; did you mean 'ur5_robot'"):
        ws.load_robot("example-robot-data:ur5_robots")


@pytest.mark.parametrize("name", ["menagerie:a", "robot_descriptions:a"])
def test_a_collection_that_is_not_installed_says_which_extra_has_it(name, monkeypatch):
    def absent(module):
        raise ImportError(module)

    monkeypatch.setattr(named_models, "import_module", absent)
    with pytest.raises(MissingExtraError, match=r"pip install \"\.\[models\]\""):
        ws.load_robot(name)


def test_what_is_given_goes_before_what_the_collection_says(monkeypatch, tmp_path):
    model = named_models.NamedModel(tmp_path / "a.xacro", {"a": "1", "b": "2"}, {"p": "here"})
    monkeypatch.setitem(named_models._COLLECTIONS, "menagerie", lambda name: model)
    found = named_models.resolved("menagerie:arm", {"a": "3"}, {"p": "there", "q": "here"})
    assert found == (model.path, {"a": "3", "b": "2"}, {"p": "there", "q": "here"})


def test_a_folder_of_a_drive_and_a_name_with_a_colon_are_no_collection():
    assert named_models.collection_of("C:robot.xml") is named_models.collection_of("a:b") is None


ALIASES = {alias: robot.name for robot in library.describe() for alias in robot.aliases}


@pytest.mark.parametrize("alias", ALIASES)
def test_other_programs_names(alias):
    robot, own = ws.load_robot(alias), ws.load_robot(ALIASES[alias])
    assert alias not in library.names()
    assert robot.spec == own.spec and robot.spec.library == robot.name == ALIASES[alias]
    np.testing.assert_array_equal(robot.chain.upper_limits, own.chain.upper_limits)


def test_ssik_has_the_names_that_are_called_its():
    manifest = pytest.importorskip("ssik.prebuilt._manifest")
    named = {alias for alias in ALIASES if alias.endswith("_ik")}
    assert named and named <= set(manifest.load_manifest())
