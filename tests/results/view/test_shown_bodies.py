"""Pictures show the bodies of an arm where its skeleton stands, as the viewer has them."""

import numpy as np
import pytest

import wsrender as ws
from wsrender.results.drawing.faces import Faces
from wsrender.results.view.shown_bodies import LINKS, bodies_shown
from wsrender.robot import link_shapes

SMALL = {"voxel_size_m": 0.2, "refined_volume": None, "indices": ["manipulability"]}
FEW = {"method": "sobol", "count": 512}
LIMITED = {"joint1": [0.2, 0.8], "joint2": [-1.0, 0.5]}
MESH = """<mujoco><worldbody><body><joint name="turn" axis="0 0 1" range="-90 90"/>
    <geom type="capsule" size=".05" fromto="0 0 0 .4 0 0" rgba="0 .5 1 1"/>
    <site name="tool" pos=".5 0 0"/></body></worldbody></mujoco>"""


def moved_to(robot: ws.Robot, q: np.ndarray, body: Faces) -> float:
    """How far the bodies are from those of a configuration [m]."""
    vertices = np.concatenate([each.vertices for each in link_shapes(robot, q)])
    assert body.vertices.shape == vertices.shape
    return float(np.abs(body.vertices - vertices).max())


@pytest.mark.parametrize("name", ["ur5e", "fanuc_lrmate200id", "scara"])
def test_every_row_of_a_skeleton_has_its_bodies(name: str) -> None:
    robot = ws.load_robot(name)
    result = ws.execute({"analysis": "workspace", "robot": {"library": name}, "sampling": FEW, **SMALL})
    bodies = result.plot.bodies
    assert len(bodies) == 3
    for body, share in zip(bodies, (0.25, 0.5, 0.75), strict=True):
        assert body is not None and set(body.colors.values()) <= set(LINKS)
        assert moved_to(robot, robot.chain.within(share), body) < 1e-12


def test_limits_locked_joints_and_constraints() -> None:
    """In the ranges that the job draws from; under constraints at samples that they admit."""
    arm = {"library": "ur5e", "limits": LIMITED}
    job = {"analysis": "workspace", "robot": arm, "sampling": FEW | {"locked": {"joint6": 0.3}}, **SMALL}
    bodies = ws.execute(job).plot.bodies
    q = ws.load_robot("ur5e").chain.within(0.5)
    q[[0, 1, 5]] = 0.5, -0.25, 0.3
    assert bodies[1] is not None and moved_to(ws.load_robot("ur5e"), q, bodies[1]) < 1e-12
    constrained = job | {"robot": {"library": "ur5e"}, "constraints": {"self_collision": True}, "sampling": FEW}
    result = ws.execute(constrained)
    assert result.sample is not None and result.sample.configuration is not None and result.skeleton is not None
    robot, shown = ws.load_robot("ur5e"), result.plot.bodies
    for body, skeleton in zip(shown, result.skeleton, strict=True):
        (k,) = np.flatnonzero(np.abs(robot.skeleton(result.sample.configuration) - skeleton).max(axis=(1, 2)) < 1e-9)
        assert body is not None and moved_to(robot, result.sample.configuration[k], body) < 1e-12


def test_several_robots_each_have_their_own() -> None:
    second = {"robot": {"library": "scara", "placement": {"position_m": [0.5, 0, 0]}}}
    job = {"analysis": "shared_workspace", "robots": [{"robot": {"library": "ur5e"}}, second], **SMALL}
    job.pop("indices")
    first, other = ws.execute(job).plot.bodies
    assert first is not None and other is not None
    robot = ws.load_robot("scara")
    moved = other.vertices - [0.5, 0, 0]
    vertices = np.concatenate([each.vertices for each in link_shapes(robot, robot.chain.within(0.5))])
    assert np.abs(moved - vertices).max() < 1e-12


def test_colours_of_a_model_stay_and_what_is_not_told_is_drawn_as_sticks() -> None:
    result = ws.execute({"analysis": "workspace", "robot": {"mjcf": MESH}, "sampling": FEW, **SMALL})
    (body, *_) = result.plot.bodies
    assert body is not None and result.skeleton is not None
    assert list(body.colors.values()) == [(0.0, 0.5, 1.0)]
    elsewhere = result.skeleton + np.array([0, 0, 0.1])
    document = result.document
    assert bodies_shown(document, {}, None, elsewhere) == [None] * 3
    assert bodies_shown(document | {"job": None}, {}, None, result.skeleton) == [None] * 3
    dh = {"dh": {"convention": "standard", "rows": [{"a": 0.4, "limits": [-2, 2]}]}}
    assert ws.execute({"analysis": "workspace", "robot": dh, "sampling": FEW, **SMALL}).plot.bodies == [None] * 3


@pytest.mark.parametrize(("name", "entries"), [("abb_irb120", ["tip"]), (None, ["base", "joint", "tip"])])
def test_a_picture_is_of_bodies_where_there_are_any(name: str | None, entries: list[str]) -> None:
    """Three surfaces; the legend names no joints, which are not seen."""
    dh = {"dh": {"convention": "standard", "rows": [{"a": 0.4, "limits": [-2, 2]}]}}
    robot = {"library": name} if name else dh
    figure = ws.execute({"analysis": "workspace", "robot": robot, "sampling": FEW, **SMALL}).plot.robot()
    axes = figure.axes[0]
    legend = axes.get_legend()
    assert legend is not None and [text.get_text() for text in legend.get_texts()] == entries
    assert len(axes.get_images()) == (3 if name else 0)
