"""Every analysis has a function in Python, whose parameters are the fields of its job document."""

import inspect
import json
import pydoc
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import wsrender as ws
from tests.golden.facts import bits_of
from tests.golden.files import analyses, job_of
from tests.python_door.write import PATH, function_name, module_text
from wsrender import python
from wsrender.analyses.registry import job_classes
from wsrender.documents.document import Document
from wsrender.documents.sampling import PYTHON_COUNT, SEVERAL_COUNT
from wsrender.robot import Robot
from wsrender.run import from_python

EXECUTION = {"progress", "threads", "chunk_size"}
BESIDE = {
    "shared_workspace": {"sampling", "names"},
    "robot_comparison": {"sampling", "names"},
    "base_placement": {"names"},
    "master_slave_mapping": {"sampling"},
    "design_optimization": {"resume"},
    "five_bar": {"mechanism"},
}
INSTEAD = {"five_bar": {"base_m", "proximal_m", "distal_m", "limits_rad"}}
EVERY = pytest.mark.parametrize("analysis", analyses())


def function_of(analysis):
    return getattr(python, function_name(analysis))


def parameters_of(analysis):
    return inspect.signature(function_of(analysis)).parameters


def fields_of(analysis):
    return {
        name: field
        for name, field in job_classes()[analysis].model_fields.items()
        if name not in ("analysis", "format")
    }


def test_the_module_is_what_the_job_classes_say():
    """``python -m tests.python_door.write`` writes it again."""
    assert PATH.read_text(encoding="utf-8") == module_text()


@EVERY
def test_every_analysis_has_a_public_function(analysis):
    function = function_of(analysis)
    assert getattr(ws, function.__name__) is function
    assert function.__name__ in ws.__all__


def test_names_that_were_there_stay():
    assert ws.workspace is ws.analyze
    positional = {
        ws.analyze: ["robot", "sampling", "indices", "task"],
        ws.kinetostatic_field: ["robot", "sampling"],
        ws.planar_boundary: ["robot", "sampling"],
        ws.all_postures: ["robot", "position_m"],
        ws.reachability: ["robot", "points_m", "quats_wxyz"],
        ws.shared_workspace: ["robots", "sampling"],
        ws.robot_comparison: ["robots", "sampling"],
        ws.collaborative_volume: ["left", "right"],
        ws.master_slave_mapping: ["master", "slave"],
        ws.parallel_workspace: ["mechanism"],
        ws.method_comparison: ["mechanism"],
        ws.five_bar: ["mechanism"],
        ws.boundary_patches: ["robot"],
        ws.design_optimization: ["design", "parameters", "objectives"],
    }
    for function, names in positional.items():
        parameters = inspect.signature(function).parameters.values()
        assert [each.name for each in parameters if each.kind is each.POSITIONAL_OR_KEYWORD] == names
    assert ws.exact_boundary and ws.reachable and ws.evaluate_indices and ws.postures


@EVERY
def test_the_parameters_are_the_fields(analysis):
    expected = fields_of(analysis).keys() - INSTEAD.get(analysis, set()) | BESIDE.get(analysis, set()) | EXECUTION
    parameters = parameters_of(analysis)
    assert parameters.keys() == expected
    kinds = {each.kind for each in parameters.values()}
    assert kinds <= {inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY}  # no **fields
    assert not [name for name, each in parameters.items() if each.annotation in (each.empty, "Any")]
    for name, field in fields_of(analysis).items():
        if name not in parameters:
            continue
        assert parameters[name].default == (inspect.Parameter.empty if field.is_required() else field.default), name


@EVERY
def test_help_says_what_every_parameter_means(analysis):
    told = " ".join(pydoc.plain(pydoc.render_doc(function_of(analysis))).split())
    assert job_classes()[analysis].__doc__.partition("\n")[0] in told
    own_words = {"robot", "robots", "left", "right", "master", "slave", "configurations"}
    for name in parameters_of(analysis):
        meaning = fields_of(analysis)[name].description if name in fields_of(analysis) else None
        assert f"``{name}``: " in told
        if meaning and name not in own_words:
            text = meaning.replace("null", "None").replace("false:", "False:").replace("true:", "True:")
            assert f"``{name}``: {' '.join(text.split())}" in told


@EVERY
def test_a_parameter_that_is_not_there_is_a_type_error(analysis):
    function = function_of(analysis)
    with pytest.raises(TypeError, match=rf"{function.__name__}\(\) has no parameter colour; allowed: \w+, "):
        function(colour=1)
    required = next(name for name, each in parameters_of(analysis).items() if each.default is each.empty)
    with pytest.raises(TypeError, match=rf"{function.__name__}\(\): missing a required argument: '{required}'"):
        function()


def test_a_misspelt_parameter_names_the_one_that_is_meant():
    with pytest.raises(TypeError, match=r"capability\(\) has no parameter direction; did you mean directions\? "):
        ws.capability("ur5e", direction=10)


def arguments(analysis):
    """A golden job as arguments of its function."""
    fields = {name: value for name, value in job_of(analysis).items() if name not in ("analysis", "format")}
    if analysis == "five_bar":
        both = [(value, value) if isinstance(value, float | int) else value for value in map(fields.pop, LENGTHS)]
        fields["mechanism"] = ws.FiveBar(fields.pop("base_m"), *both, fields.pop("limits_rad"))
    return fields


LENGTHS = ("proximal_m", "distal_m")


@EVERY
def test_a_function_gives_what_its_document_gives(analysis):
    result = function_of(analysis)(**arguments(analysis))
    assert isinstance(result, ws.Result)
    assert bits_of(result) == bits_of(ws.execute(job_of(analysis)))


@pytest.fixture
def written(monkeypatch):
    """The canonical document and the robots of a call, which does not run."""

    def call(function, *args, **named):
        found = []
        monkeypatch.setattr(from_python, "execute", lambda job, progress, robots, **_: found.append((job, robots)))
        function(*args, **named)
        ((job, robots),) = found
        return job.model_dump(mode="json"), robots

    return call


class Slide:
    """A user's robot."""

    limits = ((0.0, 1.0),)

    def forward_kinematics(self, q):
        poses = np.tile(np.eye(4), (len(q), 1, 1))
        poses[:, 0, 3] = q[:, 0]
        return poses


def test_a_robot_may_be_whatever_load_robot_takes(written):
    """And its part of a document, which is the same job; loaded already, it is not loaded again."""
    robot = ws.load_robot("scara")
    documents = [written(ws.capability, each)[0] for each in (robot, "scara", {"library": "scara"}, robot.spec)]
    assert documents == [documents[0]] * 4
    assert written(ws.capability, robot)[1] is robot
    assert written(ws.capability, {"library": "scara"})[1] is None
    assert isinstance(written(ws.capability, Slide())[1], Robot)


def test_base_and_tip_are_those_of_the_robot(written):
    loaded = ws.load_robot("ur5e", base="link1", tip="link5")
    document, robot = written(ws.capability, "ur5e", base="link1", tip="link5")
    assert document == written(ws.capability, loaded)[0]
    assert (document["base"], document["tip"]) == ("link1", "link5") == (robot.base, robot.tip)
    assert written(ws.capability, {"library": "ur5e"}, base="link1", tip="link5")[0] == document
    with pytest.raises(ws.InputError, match=r"tip: must not be given beside a robot that has its own: load_robot\("):
        ws.capability(loaded, tip="tool")
    with pytest.raises(ws.InputError, match="base: must not be given"):
        ws.capability(Slide(), base="link1")


def test_only_what_is_given_is_in_the_document(written):
    """A default may depend on other fields: of two robots the volume is refined, unless None says that it is not."""
    points = np.eye(4, 3)
    assert written(ws.collaborative_volume, "scara", "scara")[0]["refined_volume"] == 0.01
    assert written(ws.collaborative_volume, "scara", "scara", refined_volume=None)[0]["refined_volume"] is None
    document, robots = written(ws.collaborative_volume, {"robot": "scara"}, points)
    assert document["refined_volume"] is None and robots == [None]
    assert document["right"]["points"] == points.tolist()
    assert written(ws.analyze, "scara", keep_map=True)[0]["sampling"]["count"] == SEVERAL_COUNT
    assert written(ws.analyze, "scara", None, "dynamic", "full")[0]["sampling"]["count"] == 2**24
    exact = written(ws.parallel_workspace, "stewart_gough", method="exact")[0]
    assert exact["refined_volume"] is None


def test_a_python_class_is_sampled_more_sparsely(written):
    assert written(ws.analyze, Slide())[0]["sampling"]["count"] == PYTHON_COUNT
    document, robots = written(ws.shared_workspace, [Slide(), "scara"])
    assert [each["sampling"]["count"] for each in document["robots"]] == [PYTHON_COUNT, SEVERAL_COUNT]
    assert all(isinstance(robot, Robot) for robot in robots)
    assert written(ws.master_slave_mapping, Slide(), np.eye(4, 3))[0]["master"]["sampling"]["count"] == 20_000


def test_robots_have_samplings_and_names_of_their_own(written):
    two = ["scara", {"robot": "scara", "sampling": {"method": "grid", "per_joint": 7}}]
    document, robots = written(ws.robot_comparison, two, ws.Sobol(64), names=["left", "right"])
    assert [each["name"] for each in document["robots"]] == ["left", "right"]
    assert [each["sampling"]["method"] for each in document["robots"]] == ["sobol", "grid"]
    assert isinstance(robots[0], Robot) and robots[1] is None
    each_own = written(ws.robot_comparison, ["scara"] * 2, [ws.Sobol(64), None])[0]
    assert [one["sampling"]["count"] for one in each_own["robots"]] == [64, SEVERAL_COUNT]
    with pytest.raises(ws.InputError, match="robots: there are 1 samplings and 2 names for 2 robots"):
        ws.shared_workspace(["scara"] * 2, [ws.Sobol(64)])
    mapped = written(ws.master_slave_mapping, "scara", {"robot": "scara"}, sampling=ws.Random(99))[0]
    assert [mapped[side]["sampling"]["count"] for side in ("master", "slave")] == [99, 99]


def test_documents_of_every_default_are_frozen():
    """One object is the default of all calls."""
    for analysis in analyses():
        defaults = [each.default for each in parameters_of(analysis).values()]
        assert all(each.model_config["frozen"] for each in defaults if isinstance(each, Document))


SNIPPET = """
import numpy as np
import wsrender as ws

arm = ws.load_robot("ur5e")
ws.capability(arm, voxel_size_m=0.1, directions=50).document
ws.analyze("ur5e", ws.Sobol(100), ["manipulability"], task=["x", "y"], progress=True, surfaces=["convex_hull"])
ws.analyze(arm, None, "isotropy", constraints={"region": {"sphere": {"radius_m": 1}}}, index_options={"own": {"a": 1}})
ws.indices_at(arm, np.zeros((3, 6)), base="link1")
ws.shared_workspace([arm, "ur5e", {"robot": "ur5e"}], [ws.Sobol(10), None, ws.Grid(3)], names=["a", "b", "c"])
ws.collaborative_volume(arm, np.zeros((9, 3)), cells=(6, 6, 6))
ws.master_slave_mapping(arm, "ur5e", scale=2, search={"scale": [0.1, 2]})
ws.parallel_workspace({"library": "delta"}, indices="kinematic", orientation=ws.Transform())
ws.five_bar(ws.FiveBar.symmetric(6, 8, 5), points_m=[[5, 7]])
ws.capability(arm, direction=50)
ws.capability(arm, directions="many")
ws.capability(arm, approach_axis="w")
ws.analyze(arm, indices=6)
ws.analyze(arm, sampling=1000)
ws.indices_at(arm)
"""
WRONG = {
    15: "reportCallIssue",
    16: "reportArgumentType",
    17: "reportArgumentType",
    18: "reportArgumentType",
    19: "reportArgumentType",
    20: "reportCallIssue",
}


@pytest.mark.skipif(shutil.which("pyright") is None, reason="pyright is not installed: pip install pyright[nodejs]")
def test_a_type_checker_sees_wrong_arguments(tmp_path):
    """And no fault in right ones."""
    (tmp_path / "snippet.py").write_text(SNIPPET)
    roots = Path(ws.__file__).parent.parent
    settings = {"extraPaths": [str(roots), str(roots / "kernels")], "typeCheckingMode": "standard"}
    (tmp_path / "pyrightconfig.json").write_text(json.dumps({"include": ["snippet.py"], **settings}))
    command = ["pyright", "--outputjson", "--pythonpath", sys.executable, "-p", str(tmp_path)]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    found = {each["range"]["start"]["line"] + 1: each["rule"] for each in json.loads(run.stdout)["generalDiagnostics"]}
    assert found == WRONG
