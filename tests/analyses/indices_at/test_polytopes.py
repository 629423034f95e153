"""Polytopes of the job ``indices_at``: meshes, tables and picture; what is rejected has none."""

import numpy as np
import pytest

import wsrender as ws
from tests.run.journeys import from_the_command_line
from wsrender.results.export.meshes import read_mesh
from wsrender.run import execute, plan

Q = [[0, -1, 1, 0, 1, 0], [0.3, -1.5, 1.5, 0.2, 1, 0]]
ROBOT = {"library": "ur5e", "velocity_limits": {f"joint{k}": 3.14 for k in range(1, 7)}}
JOB = {"analysis": "indices_at", "robot": ROBOT, "configurations": Q, "indices": ["manipulability"], "device": "cpu"}


def test_a_result_holds_them_in_tables_meshes_and_a_picture(tmp_path):
    job = JOB | {"polytopes": ["force", "velocity"], "gravity_m_s2": [0, 1, -3]}
    result = from_the_command_line(job, tmp_path)
    table = result.tables["polytopes"]
    assert table["kind"].tolist() == ["velocity"] * 2 + ["force"] * 2 and table["configuration"].tolist() == [
        0,
        1,
        0,
        1,
    ]
    robot = ws.load_robot("ur5e", velocity_limits=ROBOT["velocity_limits"])
    of_vertices, of_facets = result.tables["polytope_vertices"], result.tables["polytope_facets"]
    for row in range(4):
        kind, k = str(table["kind"][row]), int(table["configuration"][row])
        found = ws.polytope(robot, Q[k], kind, gravity_m_s2=(0, 1, -3))
        assert (table["radius"][row], table["dimension"][row]) == (pytest.approx(found.radius), 3)
        assert table["volume"][row] == pytest.approx(found.volume) and table["unit"][row] == found.unit
        at = (of_vertices["kind"].astype(str) == kind) & (of_vertices["configuration"] == k)
        assert of_vertices["vertex"][at] == pytest.approx(found.vertices)
        at = (of_facets["kind"].astype(str) == kind) & (of_facets["configuration"] == k)
        assert of_facets["normal"][at] == pytest.approx(found.facets[:, :3])
        assert of_facets["offset"][at] == pytest.approx(found.facets[:, 3])
        mesh = read_mesh(tmp_path / "out" / f"{kind}_polytope_{k}.ply")
        offset = (mesh.vertices - found.position) / table["mesh_m_per_unit"][row]
        assert offset == pytest.approx(found.vertices, abs=1e-5 * np.abs(found.vertices).max())
    assert (tmp_path / "out" / "plots" / "polytopes.png").read_bytes().startswith(b"\x89PNG")
    (first, second) = result.plot.polytopes(configuration=1).legends[0].get_texts()
    scale = table["mesh_m_per_unit"][(table["kind"].astype(str) == "force") & (table["configuration"] == 1)]
    radius = ws.polytope(robot, Q[1], "force", gravity_m_s2=(0, 1, -3)).radius
    assert first.get_text().startswith("velocity: radius ") and 1 / scale[0] > 1000
    assert second.get_text() == f"force: radius {radius:.0f} N,\n1 m stands for {round(1 / scale[0], -1):,.0f} N"
    with pytest.raises(ws.InputError, match="configuration: 2 has no mesh of a polytope; 0, 1 have"):
        result.plot.polytopes(configuration=2)


def test_forces_are_cut_as_their_index_is():
    indices = {"indices": ["force_radius"], "index_options": {"force_radius": {"limit_N": 100}}}
    result = execute(JOB | indices | {"polytopes": ["force"]})
    assert result.tables["polytopes"]["radius"] == pytest.approx(result.map.indices["force_radius"])
    assert result.tables["polytopes"]["radius"].max() == pytest.approx(100)


def test_rejected_configurations_have_none():
    kept = {"constraints": {"region": {"half_space": {"point_m": [0, 0, 0.45]}}}, "polytopes": ["acceleration"]}
    tips = ws.load_robot("ur5e").forward_kinematics(Q)[:, 2, 3]
    assert tips[0] > 0.45 > tips[1] or tips[1] > 0.45 > tips[0]
    result = execute(JOB | kept)
    (admitted,) = np.flatnonzero(tips > 0.45)
    assert result.tables["polytopes"]["configuration"].tolist() == [admitted]
    assert list(result.meshes) == [f"acceleration_polytope_{admitted}"] and len(result.skeleton) == 1
    none = execute(JOB | kept | {"constraints": {"region": {"half_space": {"point_m": [0, 0, 9]}}}})
    assert len(none.tables["polytopes"]) == len(none.meshes) == 0


def test_jobs_without_them_are_what_they_were():
    result = execute(JOB)
    assert "polytopes" not in result.document["job"] and not result.tables and result.skeleton is None
    assert "polytopes" not in [each.name for each in result.plot.pictures]


def test_what_cannot_be_made_is_refused_before_anything_runs():
    bare = JOB | {"robot": "ur5e", "polytopes": ["velocity"]}
    with pytest.raises(ws.InputError, match="polytopes: the polytope of velocity needs speeds"):
        plan(bare)
    with pytest.raises(ws.DocumentError, match="polytopes: must not be given with 21 configurations; 20 at most"):
        plan(JOB | {"configurations": [Q[0]] * 21, "polytopes": ["force"]})
    for wrong in (["power"], ["force", "force"], "force"):
        with pytest.raises(ws.DocumentError, match="polytopes"):
            plan(JOB | {"polytopes": wrong})
    stated = '<mujoco><option gravity="0 0 -1"/><worldbody><body><joint name="j" range="-60 60"/><geom size=".1"/>'
    stated += '<site name="tool" pos=".4 0 0"/></body></worldbody><actuator><motor joint="j" forcerange="-1 1"/>'
    job = {"analysis": "indices_at", "robot": {"mjcf": stated + "</actuator></mujoco>"}, "configurations": [[0.1]]}
    for kinds, noticed in ((["force"], True), ([], False)):
        found = execute(job | {"indices": ["manipulability"], "device": "cpu", "polytopes": kinds})
        assert any(each["code"] == "gravity" for each in found.document["warnings"]) == noticed
