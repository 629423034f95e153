"""What holds of every robot of the library: its README, names, shapes, closed form and second source."""

import math
from dataclasses import replace

import mujoco
import numpy as np
import pytest

import wsrender as ws
from tests.library import readme, table
from tests.library.second_sources import SECOND_SOURCES
from wsrender.robots import library

ROBOTS = {robot.name: robot for robot in library.describe()}
QUATERNIONS_OF_SIX_DIGITS = ("unitree_g1_left_arm", "unitree_g1_right_arm")  # of the second source
PRODUCTS = [name for name, robot in ROBOTS.items() if robot.second_source]


def text_of(name):
    return (library.find(name).parent / "README.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", ROBOTS)
def test_the_readme_repeats_the_model_file(name):
    """``python -m tests.library.readme`` writes what is compared here."""
    assert readme.written(text_of(name), name) == text_of(name)


@pytest.mark.parametrize("name", ROBOTS)
def test_the_readme_has_the_sources(name):
    sources = text_of(name).split(readme.SOURCES)[1]
    assert len(sources.split()) > 10
    if ROBOTS[name].second_source:
        assert ROBOTS[name].second_source in text_of(name)


def test_a_changed_number_of_a_model_is_seen_in_its_readme(monkeypatch, tmp_path):
    changed = tmp_path / "ur5e.xml"
    original = library.find("ur5e")
    changed.write_text(original.read_text().replace("-0.425 0 0", "-0.4251 0 0"))
    monkeypatch.setattr(readme.library, "find", lambda name: changed)
    text = (original.parent / "README.md").read_text(encoding="utf-8")
    now = readme.written(text, "ur5e")
    assert "−0.4251, 0, 0" in now and now != text


def test_the_table_of_all_robots_marks_what_is_odd():
    """In the wrong unit, or with shapes too coarse, a robot stands out."""
    row = next(table.rows(["pincherx100"]))
    assert (row.joints, row.payload_kg, row.reach_m, row.odd) == (4, 0.05, 0.3, [])
    # A solid of revolution: cells of its section, of 1, 2 and 4 mm, counted by 4e6 configurations, towards none.
    assert row.volume_m3 == pytest.approx(0.0350, rel=0.02)
    assert row.of_the_ball == pytest.approx(row.volume_m3 / (0.036 * math.pi))
    assert replace(row, volume_m3=row.volume_m3 * 1e-9).odd == ["volume"]
    assert replace(row, volume_m3=None, touching=31.0).odd == ["touching"]


def test_every_product_has_a_second_source():
    assert sorted(SECOND_SOURCES) == sorted(PRODUCTS)


def test_names_and_aliases_are_of_one_robot_each():
    every = [*ROBOTS, *(alias for robot in ROBOTS.values() for alias in robot.aliases)]
    assert len(every) == len(set(every))
    for robot in ROBOTS.values():
        assert all(library.find(alias) == robot.path for alias in robot.aliases)
    assert ws.load_robot("universalUR5e").chain.name == "ur5e"


@pytest.mark.parametrize("name", PRODUCTS)
def test_kinematics_are_those_of_the_second_source(name):
    chain, theirs = ws.load_robot(name).chain, SECOND_SOURCES[name]()
    lower = np.where(np.isfinite(chain.lower_limits), chain.lower_limits, -np.pi)
    upper = np.where(np.isfinite(chain.upper_limits), chain.upper_limits, np.pi)
    q = np.random.default_rng(20261126).uniform(lower, upper, (100, chain.n))
    away = np.abs(chain.poses(q) - theirs(q))
    assert away[:, :3, 3].max() < 1e-6
    assert away[:, :3, :3].max() < (2e-6 if name in QUATERNIONS_OF_SIX_DIGITS else 1e-6)


@pytest.mark.parametrize("name", ROBOTS)
def test_the_closed_form_is_the_one_that_is_said(name):
    assert ws.load_robot(name).closed_form == ROBOTS[name].closed_form


@pytest.mark.parametrize("name", ROBOTS)
def test_links_have_shapes(name):
    """All of a product; of an arm of a paper those whose axes do not meet the next one's."""
    model = mujoco.MjModel.from_xml_path(str(library.find(name)))
    bare = [model.body(k).name for k in range(1, model.nbody) if model.body_geomnum[k] == 0]
    assert model.ngeom > 0 and (not bare or name not in PRODUCTS)


@pytest.mark.parametrize("name", ROBOTS)
def test_the_home_posture_is_free(name):
    """The key frame "home" where a model has one, else the middle of the ranges."""
    model = mujoco.MjModel.from_xml_path(str(library.find(name)))
    data = mujoco.MjData(model)
    data.qpos[:] = np.where(model.jnt_limited, model.jnt_range.mean(axis=1), 0.0)
    if model.nkey:
        data.qpos[:] = model.key("home").qpos
    mujoco.mj_kinematics(model, data)
    mujoco.mj_collision(model, data)
    assert not [contact.geom.tolist() for contact in data.contact if contact.dist < 0]


@pytest.mark.parametrize("name", ROBOTS)
def test_the_share_of_collisions_is_the_one_that_is_said(name):
    """Of 1,000 configurations: five standard deviations of both."""
    said = readme.SHARE.search(text_of(name))
    share = float(said[2]) / 100 if said else 0.0
    count = int(said[1].replace(" ", "")) if said else math.inf
    spread = 5 * math.sqrt(max(share * (1 - share), 1e-3) * (1 / 1000 + 1 / count))
    assert readme.collision_share(name, 1000) / 100 == pytest.approx(share, abs=spread if said else 0.0)


@pytest.mark.parametrize("name", PRODUCTS)
def test_the_reach_is_near_the_makers(name):
    """Makers measure from the first or the second axis to the wrist, the flange or a gripper's fingers."""
    robot = ws.load_robot(name)
    if ROBOTS[name].reach_m is None:
        pytest.skip("its maker publishes no reach")
    chain = robot.chain
    q = np.random.default_rng(1).uniform(
        np.maximum(chain.lower_limits, -np.pi), np.minimum(chain.upper_limits, np.pi), (20_000, chain.n)
    )
    model = mujoco.MjModel.from_xml_path(str(library.find(name)))
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    farthest = np.linalg.norm(chain.poses(q)[:, :3, 3] - data.xanchor[1], axis=1).max()
    assert 0.65 < farthest / ROBOTS[name].reach_m < 1.55
