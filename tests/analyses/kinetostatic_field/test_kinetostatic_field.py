"""The force field over a workspace, against the field of single configurations."""

import h5py
import numpy as np
import pytest

import wsrender as ws
from wsrender.run import execute, finish, plan, run_shard
from wsrender.run.partial_files import load_partial, save_partial

JOB = {
    "analysis": "kinetostatic_field",
    "robot": "scara",
    "field": {"task": ["x", "y"], "form": "normalised"},
    "sampling": {"method": "sobol", "count": 3000, "seed": 3},
    "voxel_size_m": 0.06,
    "device": "cpu",
}


@pytest.fixture(scope="module")
def result():
    return execute(JOB)


def forces_by_voxel(size):
    """Mean force of the configurations in each voxel, one by one."""
    robot = ws.load_robot("scara")
    field = ws.force_field(robot, task=["x", "y"], form="normalised")
    q = ws.analyze(
        robot, ws.Sobol(3000, seed=3), ["manipulability"], keep_map=True, map_columns=["configuration"],
        precision="float64", voxel_size_m=size,
    ).map.configuration  # fmt: skip
    cells = np.floor(robot.forward_kinematics(q)[:, :3, 3] / size + 1e-9).astype(int)
    voxels: dict[tuple, list] = {}
    for cell, force in zip(cells, field.forces(q), strict=True):
        voxels.setdefault(tuple(cell.tolist()), []).append(force)
    return voxels


def test_a_voxel_holds_the_mean_of_its_configurations(result):
    volume, expected = result.volume, forces_by_voxel(0.06)
    assert np.count_nonzero(volume.occupied) == len(expected)
    for cell, forces in expected.items():
        at = tuple(np.subtract(cell, volume.first_voxel))
        assert volume.count[at] == len(forces)
        assert volume.vectors["force"][at] == pytest.approx(np.mean(forces, axis=0), abs=1e-5)
        sizes = np.linalg.norm(forces, axis=1)
        assert volume.statistics["maximum"]["force"][at] == pytest.approx(sizes.max(), abs=1e-5)
        assert volume.statistics["mean"]["force"][at] == pytest.approx(sizes.mean(), abs=1e-5)
    assert np.isnan(volume.vectors["force"][~volume.occupied]).all()


def test_document(result):
    entry = result.document["kinetostatic_field"]
    assert entry["form"] == "normalised"
    assert entry["characteristic_length"]["method"] == "rms"
    assert 0 < entry["mean_force_n"] < entry["largest_force_n"] <= 6.4 + 1e-9
    passivity = entry["passivity"]
    assert passivity["stiffness_bound_n_per_m"] == pytest.approx(1000)
    assert passivity["loops"] > 0
    assert (
        passivity["largest_loop_work_j"] <= passivity["loop_work_bound_j"] <= 6.4 * passivity["loop_length_m"] * 1.001
    )
    assert passivity["conservative"].startswith("no: unit directions are no gradient")
    assert "work of closed paths" in result.summary() and " J at most, bound " in result.summary()
    assert result.document["warnings"] == []
    assert result.document["headline"]["value"] is None and result.document["headline"]["reason"]


def test_a_potential_that_is_clipped_says_where_it_is_none():
    field = {"task": ["x", "y"], "form": "potential"}
    document = execute({**JOB, "field": field, "sampling": {"method": "sobol", "count": 64}}).document
    passivity = document["kinetostatic_field"]["passivity"]
    assert "no singular posture is near" in passivity["conservative"]
    (warning,) = document["warnings"]
    assert (warning["code"], warning["field"]) == ("force_clipped", "field.haptic_device.peak_force_n")
    assert passivity["share_of_loops_clipped"] > 0 and "not conservative" in warning["message"]
    assert 0 < passivity["largest_loop_work_j"] <= passivity["loop_work_bound_j"]
    strong = {"peak_force_n": 1e6, "continuous_force_n": 1e6}
    soft = {"joint_limits": {"stiffness_n_m_per_rad": 0.5, "stiffness_n_per_m": 10.0}}
    field |= {"haptic_device": strong, "conditioning": None, **soft}
    document = execute({**JOB, "field": field, "sampling": {"method": "sobol", "count": 64}}).document
    assert document["warnings"] == []


def test_vectors_in_files(result, tmp_path):
    result.save(tmp_path, formats=["npz", "csv", "mat"])
    restored = ws.Result.load(tmp_path).volume
    np.testing.assert_array_equal(restored.vectors["force"], result.volume.vectors["force"])
    assert restored.units["force"] == "N"
    with h5py.File(tmp_path / "volume.vtkhdf") as file:
        stored = file["VTKHDF/CellData/force"]
        assert stored.shape == (*result.volume.count.shape[::-1], 3)
        assert stored.attrs["unit"] == "N"
    header = (tmp_path / "volume.csv").read_text().splitlines()[0]
    assert '"force_x","force_y","force_z"' in header
    for name in ("field", "posture"):
        assert (tmp_path / "plots" / f"{name}.png").stat().st_size > 10_000
    from wsrender.results.export import read_volume_npz

    np.testing.assert_array_equal(
        read_volume_npz(tmp_path / "volume.npz").vectors["force"], result.volume.vectors["force"]
    )


def test_vtk_reads_the_vectors(result, tmp_path):
    pytest.importorskip("vtk")
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOHDF import vtkHDFReader

    result.save(tmp_path)
    reader = vtkHDFReader()
    reader.SetFileName(str(tmp_path / "volume.vtkhdf"))
    reader.Update()
    cells = reader.GetOutput().GetCellData()
    force = vtk_to_numpy(cells.GetArray("force"))
    expected = result.volume.vectors["force"].transpose(2, 1, 0, 3).reshape(-1, 3)
    np.testing.assert_array_equal(force, expected)


def test_torques_of_a_wrench_device():
    field = {"haptic_device": {"kind": "wrench"}, "task": "full"}
    result = ws.kinetostatic_field("phantom_omni", ws.Sobol(500), field=field, voxel_size_m=0.05)
    assert set(result.volume.vectors) == {"force", "torque"}
    assert np.nanmax(np.abs(result.volume.vectors["torque"])) > 0
    assert result.volume.units["torque"] == "N m"


def test_a_partial_result_travels(result, tmp_path):
    here = plan(JOB)
    reports = []
    save_partial(run_shard(here, 0, reports.append), tmp_path / "partial.npz")
    assert reports[-1] == 3000
    there = plan(JOB, resolved=here.resolved())
    again = finish(there, load_partial(tmp_path / "partial.npz", there))
    np.testing.assert_array_equal(again.volume.vectors["force"], result.volume.vectors["force"])
    assert again.document["kinetostatic_field"] == result.document["kinetostatic_field"]


def test_default_voxels():
    size = plan({**JOB, "voxel_size_m": None}).resolved()["voxel_size_m"]
    assert 0.005 < size < 0.1


def test_pictures_of_vectors():
    result = execute(JOB)
    result.plot.vectors(at=(None, None, 0.0))
    result.plot.posture()
    with pytest.raises(ws.InputError, match="no 'torque'; it holds force"):
        result.plot.vectors("torque")
    with pytest.raises(ws.InputError, match="holds no vectors"):
        ws.analyze("scara", ws.Sobol(64), voxel_size_m=0.1).plot.vectors()
