"""Every analysis over HTTP gives what a local run gives: the server knows none of them by name."""

import io

import httpx2
import numpy as np
import pytest
from wsrender_server.app import artifacts

import wsrender as ws
from tests.server.end_to_end.acceptance import PATIENCE_S, QUICK, assert_same_files, comparable, local_result
from wsrender.export.headline import headline_lines
from wsrender.spec import ANALYSES

ARM = """<mujoco><worldbody><body><joint name="a" axis="0 0 1" range="-1 1"/><geom size="0.1"/>
<body pos="0.5 0 0"><joint name="b" axis="0 1 0" range="-1 1"/><geom size="0.1"/>
<site name="tool" pos="0.4 0 0"/></body></body></worldbody><compiler angle="radian"/></mujoco>"""
SAMPLING = {"method": "sobol", "count": 2048}
ROBOTS = [
    {"robot": {"library": "scara"}, "sampling": SAMPLING},
    {"robot": {"library": "scara", "placement": {"position_m": [0.3, 0, 0]}}, "sampling": SAMPLING},
]
DOCUMENTS = {
    "workspace": QUICK,
    "indices_at": {"analysis": "indices_at", "robot": "scara", "configurations": [[0, 0, 0, 0]], "device": "cpu"},
    "capability": {
        "analysis": "capability",
        "robot": {"library": "scara", "placement": {"position_m": [0, 0, 0.05]}},
        "voxel_size_m": 0.1,
        "directions": 7,
        "angle_tolerance_rad": 0.5,
        "device": "cpu",
    },
    "master_slave_mapping": {
        "analysis": "master_slave_mapping",
        "master": {"robot": "spherical", "sampling": SAMPLING},
        "slave": {"points": [[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]]},
        "offsets_m": [[0.3, 0, 0], [0.25, 0, 0]],
        "search": {"scale": [0.1, 2.0], "steps": 10},
        "device": "cpu",
    },
    "kinetostatic_field": {
        "analysis": "kinetostatic_field",
        "robot": "scara",
        "field": {
            "task": ["x", "y"],
            "obstacles": {"items": [{"shape": "sphere", "center_m": [0.3, 0, 0], "radius_m": 0.1}]},
        },
        "sampling": SAMPLING,
        "device": "cpu",
    },
    "shared_workspace": {"analysis": "shared_workspace", "robots": ROBOTS, "voxel_size_m": 0.05, "device": "cpu"},
    "parallel_workspace": {
        "analysis": "parallel_workspace",
        "mechanism": {"library": "six_pus", "link_m": 2.5},
        "voxel_size_m": 0.1,
        "indices": ["manipulability"],
        "device": "cpu",
    },
    "five_bar": {
        "analysis": "five_bar",
        "base_m": 1,
        "proximal_m": [1, 1.2],
        "distal_m": 0.8,
        "limits_rad": [[0, 3], None],
        "working_modes": ["+-", "-+"],
        "voxel_size_m": 0.05,
        "joint_steps": 30,
        "points_m": [[0.5, 0.9]],
    },
    "method_comparison": {
        "analysis": "method_comparison",
        "mechanism": "six_pus",
        "voxel_sizes_m": [0.2],
        "ball_subdivisions": [2],
        "device": "cpu",
    },
    "design_optimization": {
        "analysis": "design_optimization",
        "design": {
            "analysis": "workspace",
            "robot": {"library": "scara", "tool": {"position_m": [0, 0, 0]}},
            "sampling": SAMPLING,
            "voxel_size_m": 0.05,
            "device": "cpu",
        },
        "parameters": [{"name": "height", "pointers": ["/robot/tool/position_m/2"], "bounds": [0, 0.1]}],
        "objectives": [{"value": "/volume_m3/occupied"}],
        "search": {"method": "sweep", "steps": 2},
    },
    "reachability": {
        "analysis": "reachability",
        "robot": "scara",
        "points_m": [[0.2, 0.1, 0.0], [9.0, 0.0, 0.0]],
        "device": "cpu",
    },
    "collaborative_volume": {
        "analysis": "collaborative_volume",
        "left": {"robot": ROBOTS[0]["robot"]},
        "right": {"robot": ROBOTS[1]["robot"]},
        "samples": 2048,
        "seeds": 2,
        "device": "cpu",
    },
    "robot_comparison": {"analysis": "robot_comparison", "robots": ROBOTS, "voxel_size_m": 0.05, "device": "cpu"},
}


@pytest.mark.parametrize("analysis", [name for name in DOCUMENTS if name in ANALYSES])
def test_a_job_equals_the_local_run(client, tmp_path, analysis):
    document = DOCUMENTS[analysis]
    local = local_result(document, tmp_path / "local")
    job = client.submit(document)
    assert job.record["analysis"] == analysis
    result = job.wait(timeout=PATIENCE_S).result()
    assert comparable(result.document) == comparable(local.document)
    stated = artifacts.ResultDocument.model_validate(local.document)
    assert headline_lines(local.document) and (stated.headline.value is not None or stated.headline.reason)
    result.save(tmp_path / "remote")
    assert_same_files(tmp_path / "remote", tmp_path / "local")
    assert [found.id for found in client.jobs(analysis=analysis)] == [job.id]


@pytest.mark.parametrize("analysis", [name for name in DOCUMENTS if name in ANALYSES])
def test_a_job_is_estimated(client, analysis):
    assert client.estimate(DOCUMENTS[analysis])["samples"] > 0


def test_uploaded_robots_of_a_job_of_several(client):
    sha256 = client.upload_model(ARM.encode())
    robots = [{"robot": {"model": sha256}, "sampling": SAMPLING}, ROBOTS[1]]
    document = {**DOCUMENTS["shared_workspace"], "robots": robots, "indices": ["manipulability"], "task": ["y", "z"]}
    result = client.submit(document).wait(timeout=PATIENCE_S).result()
    local = ws.execute({**document, "robots": [{**robots[0], "robot": {"mjcf": ARM}}, robots[1]]})
    assert result.document["volume_m3"] == local.document["volume_m3"]
    assert result.document["job"]["robots"][0]["robot"]["model"] == sha256
    with pytest.raises(ws.NotFoundError):
        client.submit({**document, "robots": [robots[1], {**robots[0], "robot": {"model": "0" * 64}}]})


@pytest.mark.parametrize(
    ("robot", "field"),
    [({"library": "nobody"}, "robots.1.robot.library"), ({"mjcf": "<!DOCTYPE a><mujoco/>"}, "robots.1.robot.mjcf")],
)
def test_faults_say_which_of_several_robots(client, robot, field):
    document = {**DOCUMENTS["shared_workspace"], "robots": [ROBOTS[0], {"robot": robot, "sampling": SAMPLING}]}
    with pytest.raises(ws.InputError) as fault:
        client.submit(document)
    assert fault.value.field == field


def test_planes_of_a_volume_by_name(client, server):
    job = client.submit(DOCUMENTS["shared_workspace"]).wait(timeout=PATIENCE_S)
    volume = job.result().volumes["robot_scara"]
    path = f"{server.url}/v1/jobs/{job.id}/volume/slice"
    plane = httpx2.get(path, params={"volume": "robot_scara", "statistic": "count"}, timeout=60)
    assert plane.headers["x-array"] == "count"
    counts = np.load(io.BytesIO(plane.content), allow_pickle=False)
    layer = int(np.floor(float(plane.headers["x-at-m"]) / volume.voxel_size_m)) - round(
        volume.origin_m[2] / volume.voxel_size_m
    )
    np.testing.assert_array_equal(np.nan_to_num(counts), volume.count[:, :, layer])
    picture = httpx2.get(path, params={"volume": "robot_scara"}, headers={"Accept": "image/png"}, timeout=60)
    assert picture.content.startswith(b"\x89PNG")
    assert httpx2.get(path, params={"volume": "nobody"}, timeout=60).status_code == 404
