"""Models named by their hash, in the folder of a server."""

import hashlib

import pytest

import wsrender as ws
from wsrender.robots.uploaded import MODELS_VARIABLE

ROBOT = {"analysis": "indices_at", "configurations": [[0.0, 0.0]], "task": ["y", "z"]}
MJCF = """<mujoco><compiler angle="radian"/><worldbody><body><joint name="a" axis="0 0 1" range="-1 1"/>
<geom size="0.1"/><body pos="0.5 0 0"><joint name="b" axis="0 1 0" range="-1 1"/><geom size="0.1"/>
<site name="tool" pos="0.4 0 0"/></body></body></worldbody></mujoco>"""
URDF = """<robot name="arm"><link name="base"/><link name="upper"/><link name="tool"/>
<joint name="a" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="b" type="revolute"><origin xyz="0.5 0 0"/><parent link="upper"/><child link="tool"/><axis xyz="0 1 0"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"""


@pytest.fixture
def models(tmp_path, monkeypatch):
    monkeypatch.setenv(MODELS_VARIABLE, str(tmp_path))
    return tmp_path


def uploaded(models, text):
    """A robot whose model a server keeps."""
    sha256 = hashlib.sha256(text.encode()).hexdigest()
    (models / sha256).write_text(text)
    return {"model": sha256}


@pytest.mark.parametrize(("language", "text"), [("mjcf", MJCF), ("urdf", URDF)])
def test_a_model_is_found_by_its_hash(models, language, text):
    robot = uploaded(models, text)
    named, given = ws.execute(ROBOT | {"robot": robot}), ws.execute(ROBOT | {"robot": {language: text}})
    assert named.document["indices"] == given.document["indices"]
    assert named.document["robot"] == given.document["robot"]
    assert named.document["job"]["robot"]["model"] == robot["model"]


def test_what_is_there_and_no_model(models):
    with pytest.raises(ws.InputError, match="not among the uploaded models"):
        ws.execute(ROBOT | {"robot": {"model": "0" * 64}})
    robot = uploaded(models, "<html/>")
    with pytest.raises(ws.ModelError, match="root element is <html>"):
        ws.execute(ROBOT | {"robot": robot})
    (models / robot["model"]).write_text("<html />")
    with pytest.raises(ws.InputError, match="is damaged on the server; upload it again"):
        ws.execute(ROBOT | {"robot": robot})


def test_files_beside_a_model_are_not_read(models):
    (models / "mesh.stl").write_bytes(b"solid")
    robot = uploaded(
        models,
        '<mujoco><asset><mesh file="mesh.stl"/></asset><worldbody><body><joint name="a" limited="true" range="-1 1"/>'
        '<geom type="mesh" mesh="mesh"/><site name="tool" pos="1 0 0"/></body></worldbody></mujoco>',
    )
    with pytest.raises(ws.ModelError, match=r"mesh\.stl, which is not there"):
        ws.execute(ROBOT | {"robot": robot})


def test_only_a_server_knows_uploaded_models(monkeypatch):
    monkeypatch.delenv(MODELS_VARIABLE, raising=False)
    with pytest.raises(ws.InputError, match="known to its server only"):
        ws.execute(ROBOT | {"robot": {"model": "0" * 64}})
