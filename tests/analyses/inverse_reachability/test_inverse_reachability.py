"""The analysis ``inverse_reachability`` beside arms that are moved, closed forms of others, and integrals."""

import json

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.spatial.transform import Rotation

import wsrender as ws
from tests.reference import closed_form_inverse as closed_form
from tests.reference.published_robots import dh_table
from tests.run.journeys import from_the_command_line
from wsrender.analyses.inverse_reachability.pictures import base_positions
from wsrender.documents.placements import COORDINATES, placed
from wsrender.reach.placements import PlacedAdmission
from wsrender.run import execute, plan
from wsrender.volume.table import CellGrid, Table

TARGET = {"position_m": [0.1, 0.05, 0.3], "rpy_deg": [170, 10, 20]}
PART = {"position_m": [0.4, 0.1, 0.02], "rpy_deg": [0, 10, 30]}
FLOOR = {"shape": "half_space", "name": "floor", "point_m": [0, 0, -0.05]}
POST = {"shape": "box", "name": "post", "size_m": [0.1, 0.1, 1], "position_m": [0.35, 0.3, 0.5]}
AROUND = {"items": [FLOOR, POST]}
JOB = {"analysis": "inverse_reachability", "robot": "ur5e", "target": TARGET, "object_frame": PART, "device": "cpu"}
TILTED = {"x_m": [-0.6, 1.2, 0.3], "y_m": [-0.9, 0.9, 0.3], "pitch_deg": 20, "yaw_deg": [0, 360, 90]}


def target_in_world():
    """The target's pose (4, 4) in the world."""
    T = [np.eye(4), np.eye(4)]
    for each, given in zip(T, (PART, TARGET), strict=True):
        each[:3, :3] = Rotation.from_euler("xyz", given["rpy_deg"], degrees=True).as_matrix()
        each[:3, 3] = given["position_m"]
    return T[0] @ T[1]


def labels_of(result):
    about, table = result.document["bases"], result.tables["bases"]
    return np.array(about["codes"])[table["label"]]


def frames_of(result):
    """Base poses (P, 4, 4) of the rows of the table."""
    table, over = result.tables["bases"], result.document["job"]["over"]
    held = {name: np.full(len(table), over[name]) for name in COORDINATES if name not in table.columns}
    return placed(np.stack([held.get(name, table.columns.get(name)) for name in COORDINATES], axis=1))


@pytest.mark.parametrize("name", ["ur5e", "puma560"])
def test_a_base_reaches_the_target_where_the_arm_reaches_it_seen_from_the_base(name):
    """inv(B) T among all configurations in closed form, of bases all over space, rolled, pitched and turned."""
    table = dh_table(name)
    over = {"x_m": [-0.3, 1.5, 0.3], "y_m": [-0.6, 0.9, 0.3], "z_m": [-0.6, 0.9, 0.3]}
    over |= {"roll_deg": [-30, 60, 45], "pitch_deg": [-60, 60, 40], "yaw_deg": [0, 360, 90]}
    dh = {"dh": table.model_dump(mode="json", exclude_none=True)}
    result, robot = execute(JOB | {"robot": dh, "over": over}), ws.load_robot(table)
    seen = np.linalg.inv(frames_of(result)) @ target_in_world()
    with np.errstate(invalid="ignore"):
        position, rotation = seen[:, :3, 3], seen[:, :3, :3]
        ur = name == "ur5e"
        q = (closed_form.ur5e(position, rotation) if ur else
             closed_form.with_spherical_wrist(name, closed_form.puma560_arm(position), rotation))  # fmt: skip
    reached = closed_form.within_limits(q, robot.lower_limits, robot.upper_limits, robot.chain.revolute).any(axis=1)
    assert (labels_of(result) == np.where(reached, "reachable", "unreachable")).all()
    assert 0.05 < reached.mean() < 0.95
    by_place = reached.reshape(-1, 3 * 4 * 4)
    about = result.document["bases"]
    assert about["labels"] == {"reachable": reached.sum(), "unreachable": (~reached).sum(), "undecided": 0}
    assert about["positions"] == {
        "count": len(by_place), "reached": by_place.any(axis=1).sum(), "all": by_place.all(axis=1).sum()
    }  # fmt: skip
    pitched = [quad(np.cos, *np.radians([p - 20, p + 20]))[0] for p in (-60, -20, 20, 60)]
    weights = np.tile(np.repeat(pitched, 4), 3)
    share = by_place @ weights / weights.sum()
    volume, found = result.volume, np.zeros(len(by_place))
    at = np.argwhere(volume.count > 0)
    place = at + volume.first_voxel - np.array([round(over[axis][0] / 0.3) for axis in ("x_m", "y_m", "z_m")])
    found[np.ravel_multi_index(tuple(place.T), (6, 5, 5))] = volume.statistics["fraction"]["orientations"][tuple(at.T)]
    assert found == pytest.approx(share, abs=1e-6) and about["share"] == pytest.approx(share.mean(), rel=1e-9)
    assert volume.count.sum() == reached.sum()
    centers = result.tables["bases"]["x_m"].reshape(6, -1)[:, 0]
    assert volume.centers(0) == pytest.approx(centers[place[:, 0].min() : place[:, 0].max() + 1], abs=1e-12)


def test_the_floor_is_that_of_arms_that_are_moved():
    """Among what stands in the world: `reachability` of an arm that is placed at each base."""
    result = execute(JOB | {"over": TILTED, "environment": AROUND})
    T, frames, label = target_in_world(), frames_of(result), labels_of(result)
    asked = {"points_m": [T[:3, 3].tolist()], "environment": AROUND, "device": "cpu"}
    asked["quats_wxyz"] = [Rotation.from_matrix(T[:3, :3]).as_quat(scalar_first=True).tolist()]
    kinds = {name: np.flatnonzero(label == name) for name in ("reachable", "unreachable", "blocked_environment")}
    assert sum(map(len, kinds.values())) == len(label) and min(map(len, kinds.values())) >= 4
    picked = [at[len(at) // 3 :: len(at) // 2 + 1] for at in kinds.values()]
    for k in np.concatenate(picked).tolist():
        quat = Rotation.from_matrix(frames[k, :3, :3]).as_quat(scalar_first=True).tolist()
        robot = {"library": "ur5e", "placement": {"position_m": frames[k, :3, 3].tolist(), "quat_wxyz": quat}}
        table = execute({"analysis": "reachability", "robot": robot} | asked).tables["targets"]
        expected = "blocked_environment" if table["reason"][0] == "environment" else table["label"][0]
        assert label[k] == expected, (k, table["reason"][0])
    cells = result.tables["base_map"]
    reached = (label == "reachable").reshape(-1, 4)
    assert (cells["reachable"] == reached.sum(axis=1)).all() and cells["share"] == pytest.approx(reached.mean(axis=1))
    assert cells.grid.axes == ("x_m", "y_m") and (cells["share"] % 1 > 0).any()
    best = result.document["best"]
    robot = ws.load_robot("ur5e")
    q = [result.tables["target"][f"q_{joint}"][0] for joint in robot.joint_names]
    found = np.array(best["T_world_base"]) @ robot.forward_kinematics(np.array(q))[0]
    assert found == pytest.approx(T, abs=2e-5)


def test_from_the_command_line_into_files_and_back(tmp_path, capsys):
    result = from_the_command_line(JOB | {"over": TILTED, "use_symmetry": False}, tmp_path)
    assert "best base" in capsys.readouterr().out and result.plot.base_map() is not None
    result.save(tmp_path / "again", formats=["npz"])
    with np.load(tmp_path / "again" / "bases.npz") as kept:
        assert kept["label"].shape == (6, 6, 4)
    names = {each["name"] for each in json.loads((tmp_path / "again" / "result.json").read_text())["artifacts"]}
    assert {"bases.parquet", "base_map.parquet", "target.parquet", "plots/base_map.png"} <= names


def test_pictures_mark_the_best_base_and_what_is_not_decided():
    line = execute(JOB | {"over": {"x_m": [-0.8, 1.6, 0.2]}})
    (mark,) = [each for each in line.plot.base_map().axes[0].lines if each.get_label() == "best base"]
    assert set(mark.get_xdata()) == {line.document["best"]["x_m"]}
    shape = CellGrid(("x_m", "y_m"), (0.0, 0.0), (1.0, 1.0), (2, 2))
    columns = {"x_m": np.repeat([0.5, 1.5], 2), "y_m": np.tile([0.5, 1.5], 2)}
    columns |= {
        "reachable": np.array([0, 0, 1, 2]),
        "share": np.array([0, 0, 0.5, 1]),
        "undecided": np.array([0, 1, 1, 0]),
    }
    figure = base_positions(Table(columns, {"x_m": "m", "y_m": "m"}, shape), best=(1.5, 1.5), target=(0.5, 0.5))
    (legend,), (axes, _) = figure.legends, figure.axes
    assert [each.get_text() for each in legend.get_texts()] == ["target", "best base", "undecided"]
    _, open_ = (each.get_array().mask.tolist() for each in axes.images)
    assert open_ == [[True, True], [False, True]]  # rows are y


def test_a_point_and_an_axis_ask_for_less():
    over = {"x_m": [-0.8, 1.6, 0.1], "y_m": [-1.2, 1.2, 0.2]}
    free = [TARGET | {"free_axis": "x"}, {"position_m": TARGET["position_m"]}]
    reached = [labels_of(execute(JOB | {"over": over, "target": each})) == "reachable" for each in (TARGET, *free)]
    whole, axis, point = reached
    assert not (whole & ~axis).any() and not (axis & ~point).any() and whole.sum() < axis.sum() <= point.sum()


@pytest.mark.parametrize(
    ("change", "field", "message"),
    [
        ({"target": {"position_m": [0, 0, 0], "quat_wxyz": [1, 1, 0, 0]}}, "target.quat_wxyz", "must have unit length"),
        ({"over": {"x_m": [0, 1, 0.2], "y_m": [0, 1, 0.2], "z_m": [0, 1, 0.1]}}, "over.z_m", "the step of over.x_m"),
        ({"over": {"x_m": [0, 1, 0.2], "y_m": [0.1, 1, 0.2], "z_m": [0, 1, 0.2]}}, "over.y_m", "multiple of its step"),
        ({"over": {"x_m": [0, 1, 1e-4], "y_m": [0, 1, 1e-4]}}, "over", "at most 50,000,000"),
        ({"over": {"roll_deg": 10}, "mounting": "wall"}, "mounting", "over.roll_deg tilts the base"),
        ({"over": {"roll_deg": [0, 9, 1]}, "constraints": {"torque": True}}, "constraints.torque", "would turn"),
        ({"over": {}, "position_tolerance_m": 1e-16}, "position_tolerance_m", "is not allowed"),
    ],
)  # fmt: skip
def test_bad_jobs_are_refused_by_name(change, field, message):
    with pytest.raises((ws.DocumentError, ws.InputError), match=f"{field}.*{message}"):
        plan({**JOB, "over": TILTED} | change)


def test_samples_that_searches_start_from_are_drawn_once(monkeypatch):
    """For the labels, and for the best base's configuration."""
    drawn, samples = [], PlacedAdmission.samples
    monkeypatch.setattr(PlacedAdmission, "samples", lambda *asked: drawn.append(1) or samples(*asked))
    target, over = {"position_m": [0.1, 0, 0.3], "quat_wxyz": [0, 1, 0, 0]}, {"x_m": [-0.6, 0.6, 0.3], "yaw_deg": 20}
    constraints = {"self_collision": True}
    found = ws.inverse_reachability("franka_panda", target=target, over=over, constraints=constraints, device="cpu")
    assert found.document["bases"]["labels"]["reachable"]
    assert len(drawn) == 1
