"""``wsrender run --dry-run``: options become a job document."""

import json

import pytest

from wsrender.analyses.jobs import parse_job
from wsrender.cli import main


@pytest.fixture
def run(capsys):
    """Run ``wsrender run … --dry-run``: the exit code and what it wrote."""

    def run(*arguments):
        with pytest.raises(SystemExit) as ended:
            main(["run", *arguments, "--dry-run"])
        written = capsys.readouterr()
        return ended.value.code, written.out, written.err

    return run


def document(run, *arguments):
    code, out, err = run(*arguments)
    assert (code, err) == (0, "")
    return json.loads(out)


@pytest.mark.parametrize(
    ("arguments", "fields"),
    [
        ([], {"analysis": "workspace", "indices": "kinematic", "keep_map": False}),
        (["--tip", "tool0", "--base", "base_link"], {"tip": "tool0", "base": "base_link"}),
        (["--grid", "7"], {"sampling": {"method": "grid", "per_joint": 7, "locked": {}}}),
        (["--grid", "3,4"], {"sampling": {"method": "grid", "per_joint": [3, 4], "locked": {}}}),
        (["--samples", "1e6"], {"sampling": {"method": "sobol", "count": 10**6, "seed": 0, "locked": {}}}),
        (
            ["--sampling", "random", "--samples", "50", "--seed", "9", "--lock", "j=a=-0.5", "--lock", "k=1"],
            {"sampling": {"method": "random", "count": 50, "seed": 9, "locked": {"j=a": -0.5, "k": 1.0}}},
        ),
        (["--indices", "dynamic"], {"indices": "dynamic"}),
        (["--indices", "isotropy, yoshikawa"], {"indices": ["isotropy", "yoshikawa"]}),
        (["--task", "full"], {"task": "full"}),
        (["--task", "x,y"], {"task": ["x", "y"]}),
        (
            ["--convention", "wsrender_code", "--precision", "float64"],
            {"convention": "wsrender_code", "precision": "float64"},
        ),
        (["--voxel-size", "0.01", "--device", "cpu"], {"voxel_size_m": 0.01, "device": "cpu"}),
        (["--keep-map"], {"keep_map": True}),
    ],
)
def test_options_become_fields(run, arguments, fields):
    job = document(run, "ur5e", *arguments)
    assert {name: job[name] for name in fields} == fields
    assert job["robot"]["library"] == "ur5e"


@pytest.mark.parametrize("name", ["arm.urdf", "models/arm.xml", "arm.URDF"])
def test_a_robot_file_becomes_a_path(run, name):
    assert document(run, name)["robot"]["path"] == name


def test_options_override_a_job_document(run, tmp_path):
    job = tmp_path / "job.json"
    sampling = {"method": "random", "count": 100, "seed": 1, "locked": {"a": 0.5}}
    job.write_text(json.dumps({"analysis": "workspace", "robot": "scara", "sampling": sampling, "task": "full"}))
    kept = document(run, str(job))
    assert (kept["sampling"], kept["task"]) == (sampling, "full")
    changed = document(run, str(job), "--seed", "2", "--lock", "b=1", "--task", "linear")
    assert changed["sampling"] == {**sampling, "seed": 2, "locked": {"a": 0.5, "b": 1.0}}
    assert changed["task"] == "linear"
    assert document(run, str(job), "--samples", "7")["sampling"]["method"] == "random"
    assert document(run, str(job), "--grid", "5")["sampling"] == {
        "method": "grid", "per_joint": 5, "locked": {"a": 0.5},
    }  # fmt: skip


def test_options_correct_the_robot(run, tmp_path):
    given = ["--limits", "rail=-0.5,1", "--limits", "j=a=0,2", "--length-unit-m", "0.001"]
    corrected = {"limits": {"rail": [-0.5, 1.0], "j=a": [0.0, 2.0]}, "length_unit_m": 0.001}
    robot = document(run, "arm.urdf", *given)["robot"]
    assert {name: robot[name] for name in ("path", *corrected)} == {"path": "arm.urdf", **corrected}
    job = tmp_path / "job.json"
    job.write_text(json.dumps({"analysis": "workspace", "robot": {"library": "scara", "limits": {"k": [0, 1]}}}))
    assert document(run, str(job), *given)["robot"]["limits"] == {"k": [0.0, 1.0], **corrected["limits"]}
    job.write_text(json.dumps({"analysis": "workspace", "robot": "scara"}))
    assert document(run, str(job), "--length-unit-m", "1")["robot"]["length_unit_m"] == 1


def test_a_printed_document_can_be_run_again(run, tmp_path):
    _, out, _ = run("ur5e", "--samples", "1e5", "--task", "x,z")
    job = tmp_path / "again.json"
    job.write_text(out)
    assert parse_job(document(run, str(job))) == parse_job(out)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["ur5e", "--voxel-size", "-1"], "voxel_size_m: must be greater than 0, not -1.0"),
        (["ur5e", "--grid", "many"], '--grid: must be a number, not "many"'),
        (["ur5e", "--samples", "0"], "sampling.count: must be at least 1, not 0"),
        (["ur5e", "--samples", "nan"], "sampling.count: must be a whole number, not NaN"),
        (["ur5e", "--lock", "joint1"], '--lock: must be JOINT=VALUE, not "joint1"'),
        (["ur5e", "--sampling", "halton"], "sampling.method: must be one of"),
        (["ur5e", "--limits", "joint1=1"], '--limits: must be JOINT=LOWER,UPPER, not "joint1=1"'),
        (["ur5e", "--limits", "joint1=0,one"], '--limits: must be a number, not "one"'),
        (["ur5e", "--limits", "joint1=1,0"], "robot.limits.joint1: must have the lower limit below the upper one"),
        (["ur5e", "--grid", "3", "--samples", "9"], "--grid: does not go with --samples"),
        (["ur5e", "--task", "up"], 'task: must be "linear", "angular", "full" or a list of rows from x y z rx ry rz'),
        (["missing.json"], "JOB: missing.json cannot be read: No such file or directory"),
    ],
)
def test_wrong_options_are_one_line_and_exit_code_2(run, arguments, message):
    code, out, err = run(*arguments)
    assert (code, out) == (2, "")
    assert err.startswith(f"error: {message}")
    assert err.count("\n") == 1


def test_a_job_file_that_is_not_an_object(run, tmp_path):
    job = tmp_path / "job.json"
    job.write_text("[]")
    code, _, err = run(str(job))
    assert code == 2
    assert "must hold an object, not list" in err


def test_corrections_need_one_robot(run, tmp_path):
    job = tmp_path / "job.json"
    job.write_text(json.dumps({"analysis": "robot_comparison", "robots": [{"robot": "scara"}]}))
    code, _, err = run(str(job), "--limits", "joint1=0,1")
    assert (code, err) == (2, "error: --limits: goes with a job of one robot\n")
