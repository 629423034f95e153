"""Jobs of several robots over HTTP: uploaded models, faults of one of them, planes of a volume by name."""

import io

import httpx2
import numpy as np
import pytest

import wsrender as ws
from tests.server.end_to_end.acceptance import PATIENCE_S

ARM = """<mujoco><worldbody><body><joint name="a" axis="0 0 1" range="-1 1"/><geom size="0.1"/>
<body pos="0.5 0 0"><joint name="b" axis="0 1 0" range="-1 1"/><geom size="0.1"/>
<site name="tool" pos="0.4 0 0"/></body></body></worldbody><compiler angle="radian"/></mujoco>"""
SAMPLING = {"method": "sobol", "count": 2048}
ROBOTS = [
    {"robot": {"library": "scara"}, "sampling": SAMPLING},
    {"robot": {"library": "scara", "placement": {"position_m": [0.3, 0, 0]}}, "sampling": SAMPLING},
]
SHARED = {
    "analysis": "shared_workspace",
    "robots": ROBOTS,
    "voxel_size_m": 0.05,
    "refined_volume": None,
    "device": "cpu",
}


def test_uploaded_robots_of_a_job_of_several(client):
    sha256 = client.upload_model(ARM.encode())
    robots = [{"robot": {"model": sha256}, "sampling": SAMPLING}, ROBOTS[1]]
    document = {**SHARED, "robots": robots, "indices": ["manipulability"], "task": ["y", "z"]}
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
    document = {**SHARED, "robots": [ROBOTS[0], {"robot": robot, "sampling": SAMPLING}]}
    with pytest.raises(ws.InputError) as fault:
        client.submit(document)
    assert fault.value.field == field


def test_planes_of_a_volume_by_name(client, server):
    job = client.submit(SHARED).wait(timeout=PATIENCE_S)
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
