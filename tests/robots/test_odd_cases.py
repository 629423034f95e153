"""Odd models with their right values: what they warn of, and which jobs they are refused for.

``expected.json`` of a folder of tests/robots/cases, or of a file under its ``files``: ``warns``, the code of the only
warning (none without it); ``job``, "runs" or "refused …" with its ``field``; ``lower``, ``upper``, ``periodic``;
``pos0``, the tip's position at zero, and ``base_world_pos0``, that with the base "world".
"""

import json
import warnings
from pathlib import Path

import mujoco
import numpy as np
import pytest

import wsrender as ws
from wsrender.errors import InputError
from wsrender.run.steps import plan

FOLDER = Path(__file__).parent / "cases"
NAMES = [
    "07-continuous-with-limits",
    "08-limit-without-positions",
    "11-floating-root",
    "16-joint-and-link-share-name",
    "17-world-link-not-root",
    "22-four-dof-manipulability",
    "23-negative-mesh-scale",
    "34-huge-slide-limits",
    "35-scientific-and-odd-numbers",
    "37-mm-units",
    "38-world-root-with-zero-inertial",
    "41-planar-not-at-root",
    "43-degrees-in-urdf",
]
FIELDS = {"units_length": "robot.length_unit_m", "no_usable_limits": "robot.limits"}


def expected(file):
    wanted = json.loads((file.parent / "expected.json").read_text())
    return wanted | wanted.get("files", {}).get(file.name, {})


def loading(file):
    """Every file of the cases that loads (`test_cases` has those that are refused)."""
    loads = json.loads((file.parent / "expected.json").read_text()).get("loads", True)
    return loads is True or file.name not in loads


FILES = [
    file for name in NAMES for file in sorted((FOLDER / name).iterdir()) if file.suffix != ".json" and loading(file)
]
files = pytest.mark.parametrize("file", FILES, ids=lambda file: f"{file.parent.name}/{file.name}")
with_jobs = pytest.mark.parametrize(
    "file", [file for file in FILES if "job" in expected(file)], ids=lambda file: f"{file.parent.name}/{file.name}"
)


def quietly(act, *arguments, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ws.robots.ModelWarning)
        return act(*arguments, **options)


def load(file, **options):
    wanted = expected(file)
    return quietly(ws.load_robot, file, **{"tip": wanted["tip"], "base": wanted.get("base")} | options)


def document(file, **robot):
    return {
        "analysis": "workspace",
        "robot": {"path": str(file)} | robot,
        "tip": expected(file)["tip"],
        "sampling": {"method": "sobol", "count": 1000},
        "indices": ["manipulability"],
    }


@files
def test_what_a_model_warns_of(file):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        robot = ws.load_robot(file, tip=expected(file)["tip"], base=expected(file).get("base"))
    assert [str(warning.message) for warning in caught] == [str(notice) for notice in robot.notices]
    assert [notice.code for notice in robot.notices] == ([expected(file)["warns"]] if "warns" in expected(file) else [])
    assert all(Path(warning.filename) == Path(__file__) for warning in caught)


@files
def test_limits_and_positions(file):
    wanted, robot = expected(file), load(file)
    for name, limits in (("lower", robot.lower_limits), ("upper", robot.upper_limits)):
        np.testing.assert_array_equal(limits, wanted.get(name, limits))
    assert robot.chain.periodic.all() == wanted.get("periodic", robot.chain.periodic.all())
    zero = np.zeros(robot.chain.n)
    if "pos0" in wanted:
        np.testing.assert_allclose(robot.forward_kinematics(zero)[0, :3, 3], wanted["pos0"], atol=1e-15)
    if "base_world_pos0" in wanted:
        position = load(file, base="world").forward_kinematics(zero)[0, :3, 3]
        np.testing.assert_allclose(position, wanted["base_world_pos0"], atol=1e-15)


@with_jobs
def test_jobs_run_or_are_refused_with_the_field(file):
    wanted = expected(file)
    if wanted["job"] == "runs":
        result = quietly(ws.execute, document(file))
        of_loading = {"code": wanted.get("warns"), "field": "robot.limits_deg"}
        told = [entry for entry in result.document["warnings"] if of_loading.items() <= entry.items()]
        assert len(told) == ("warns" in wanted)
        return
    with pytest.raises(InputError) as caught:
        quietly(plan, document(file))
    assert caught.value.field == FIELDS[wanted["warns"]] == wanted.get("field", caught.value.field)


def test_manipulability_of_four_joints_is_that_of_the_positions():
    file = FOLDER / "22-four-dof-manipulability" / "m.urdf"
    robot, q = load(file), expected(file)["q"]
    singular = np.linalg.svd(robot.jacobian(q)[0, :3], compute_uv=False)
    found = ws.evaluate_indices(robot, q, ["manipulability"], device="cpu")["manipulability"]
    assert singular.min() > 0.01
    assert found == pytest.approx(singular.prod(), rel=1e-12)


def test_the_inertia_of_a_mirrored_mesh_is_mujocos():
    file = FOLDER / "23-negative-mesh-scale" / "m.xml"
    model = mujoco.MjModel.from_xml_path(str(file))
    data, M = mujoco.MjData(model), np.zeros((1, 1))
    mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, M)
    assert load(file).inertia_matrix([0.0], device="cpu")[0, 0, 0] == pytest.approx(M[0, 0], rel=1e-12)
