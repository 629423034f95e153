"""``wsrender run`` as a user types it, on real robots."""

import hashlib
import json

import pytest

import wsrender as ws
from wsrender.cli import main


def run(*arguments):
    with pytest.raises(SystemExit) as ended:
        main(["run", *arguments, "--device", "cpu"])
    return ended.value.code


def test_a_library_robot(tmp_path, capsys):
    assert run("ur5e", "--samples", "5000", "--voxel-size", "0.05", "-o", str(tmp_path / "out")) == 0
    out = capsys.readouterr().out
    result = ws.Result.load(tmp_path / "out")
    assert result.document["sampling"]["samples"] == 5000
    assert result.volume.count.sum() == 5000
    assert result.volume.voxel_size_m == 0.05
    assert "manipulability" in out
    for artifact in result.document["artifacts"]:
        path = tmp_path / "out" / artifact["name"]
        assert str(path) in out
        assert hashlib.sha256(path.read_bytes()).hexdigest() == artifact["sha256"]


def test_a_file_that_includes_others(tmp_path):
    (tmp_path / "arm.xml").write_text(
        '<mujoco><worldbody><body><joint name="j" range="-60 60"/><geom size=".1"/>'
        '<site name="tcp" pos=".4 0 0"/></body></worldbody></mujoco>'
    )
    (tmp_path / "scene.xml").write_text('<mujoco><include file="arm.xml"/></mujoco>')
    scene = str(tmp_path / "scene.xml")
    assert run(scene, "--tip", "tcp", "--samples", "100", "--voxel-size", "0.05", "-o", str(tmp_path / "out")) == 0
    assert ws.Result.load(tmp_path / "out").document["robot"]["joint_names"] == ["j"]


def test_a_result_holds_the_job_that_made_it(tmp_path):
    first, second = tmp_path / "first", tmp_path / "second"
    assert run("scara", "--grid", "4", "--task", "x,y", "--voxel-size", "0.05", "-o", str(first)) == 0
    document = json.loads((first / "result.json").read_text())
    job = tmp_path / "job.json"
    job.write_text(json.dumps(document["job"]))
    assert run(str(job), "-o", str(second)) == 0
    again = json.loads((second / "result.json").read_text())
    assert again["indices"] == document["indices"]
    assert again["volume_m3"] == document["volume_m3"]


def test_indices_at_given_configurations(tmp_path):
    job = tmp_path / "job.json"
    rows = [[0, -1, 1, 0, 1, 0], [1, -1, 1, 0, 1, 0], [0, 0, 2, 0, 1, 0]]
    job.write_text(json.dumps({"analysis": "indices_at", "robot": "ur5e", "configurations": rows}))
    assert run(str(job), "-o", str(tmp_path / "out")) == 0
    table = ws.Result.load(tmp_path / "out").map
    assert table.configuration.tolist() == rows
    first, second, _ = table.indices["manipulability"]  # a turn of the base changes nothing
    assert first == pytest.approx(second, rel=1e-12)
    assert first > 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["ur5f"], 'has no robot "ur5f"; did you mean "ur5"?'),
        (["missing.urdf"], "missing.urdf"),
        (["ur5e", "--tip", "hand"], "choose one of: "),
        (["ur5e", "--lock", "elbow=0"], "elbow"),
        (["ur5e", "--indices", "manipulabilty"], "manipulability"),
        (["scara", "--indices", "dynamic"], "inertia"),
        (["ur5e", "--grid", "100"], "sobol"),
    ],
)
def test_wrong_requests_are_one_line(tmp_path, capsys, arguments, message):
    assert run(*arguments, "-o", str(tmp_path)) == 2
    err = capsys.readouterr().err.splitlines()[-1]
    assert err.startswith("error: ")
    assert message in err
    assert list(tmp_path.iterdir()) == []
