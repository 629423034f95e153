import gc
import json
import subprocess
import sys

import numpy as np
import pytest
import trimesh
from matplotlib.image import AxesImage

import wsrender as ws
from tests.results.export.sample_data import assert_same_map, assert_same_volume, random_map, random_volume
from wsrender.errors import InputError
from wsrender.results.export.artifacts import sha256
from wsrender.results.result import Result
from wsrender.volume.table import Table
from wsrender.volume.volume_data import VolumeData

SKELETON = np.cumsum(np.ones((2, 5, 3)), axis=1)


def document() -> dict:
    return {
        "analysis": "workspace",
        "robot": {"name": "arm"},
        "sampling": {"method": "sobol", "samples": 1000000, "seed": 1},
        "indices": {
            "manipulability": {
                "maximum": 0.5,
                "minimum": 0.0,
                "joint_mean": 0.25,
                "workspace_mean": 0.375,
                "unit": "m³",
            }
        },
        "volume_m3": {"occupied": 1.5, "inner": 1.25, "outer": 1.75},
        "bounds_m": {"lower": [-1.0, -2.0, -3.0], "upper": [1.0, 2.0, 3.0]},
        "global": {"global_isotropy": 1e-4, "structural_length_index": 2.125},
        "convergence": None,
        "provenance": {"precision": "float32"},
        "timing_s": {"total": 1.5},
        "artifacts": [],
    }


def curve() -> Table:
    columns = {"offset": np.arange(4.0), "shared": np.ones(4), "label": np.array(list("abcd"))}
    return Table(columns, {"offset": "m"})


def whole() -> Result:
    meshes = {"surface": trimesh.creation.box((1, 2, 3)), "hull": trimesh.creation.icosphere(subdivisions=1)}
    volumes = {"left": random_volume((2, 3, 4))}
    data = (random_map(50), random_map(20), random_volume((5, 4, 3)), SKELETON)
    return Result(document(), *data, meshes, {"scan": curve()}, volumes)


@pytest.fixture
def result() -> Result:
    return whole()


def names_in(folder) -> set[str]:
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}


def test_load_restores_what_save_wrote(tmp_path, result):
    result.save(tmp_path / "new" / "out")
    loaded = Result.load(tmp_path / "new" / "out")
    assert loaded.document == result.document
    assert {**loaded.document, "artifacts": []} == {"format": 2, **document()}
    assert_same_map(loaded.map, result.map)
    assert_same_map(loaded.sample, result.sample)
    assert_same_volume(loaded.volume, result.volume)
    np.testing.assert_array_equal(loaded.skeleton, SKELETON)
    assert (set(loaded.meshes), set(loaded.tables), set(loaded.volumes)) == ({"surface", "hull"}, {"scan"}, {"left"})
    for name, mesh in result.meshes.items():
        np.testing.assert_allclose(loaded.meshes[name].triangles, mesh.triangles, rtol=1e-7)  # float32 in files
        assert loaded.meshes[name].is_watertight
    assert loaded.tables["scan"]["label"].tolist() == list("abcd")
    assert_same_volume(loaded.volumes["left"], result.volumes["left"])


def test_document_lists_every_file_with_its_hash(tmp_path, result):
    result.save(tmp_path / "out", formats=("npz", "csv", "mat", "stl", "svg"))
    records = {record["name"]: record for record in result.document["artifacts"]}
    assert names_in(tmp_path / "out") == {*records, "result.json"}
    pictures = {f"plots/{name}.{end}" for name in ("robot", "scatter", "slices", "histogram") for end in ("png", "svg")}
    assert pictures < set(records)
    assert {"map.parquet", "sample.parquet", "volume.vtkhdf", "surface.glb", "surface.ply"} < set(records)
    assert {"map.csv", "map.npz", "map.mat", "volume.csv", "volume.npz", "volume.mat", "surface.stl"} < set(records)
    for stem, endings in (("hull", "glb ply stl"), ("scan", "parquet npz csv mat"), ("left", "vtkhdf npz csv mat")):
        assert {f"{stem}.{ending}" for ending in endings.split()} < set(records)
    assert (records["scan.parquet"]["units"], records["scan.parquet"]["frame"]) == (
        {"offset": "m", "shared": "1", "label": "1"},
        None,
    )
    for name, record in records.items():
        path = tmp_path / "out" / name
        assert record["bytes"] == path.stat().st_size > 0
        assert record["sha256"] == sha256(path)
    volume = records["volume.vtkhdf"]
    assert (volume["media_type"], volume["shape"], volume["frame"]) == (
        "application/x-hdf5",
        [5, 4, 3],
        "world",
    )
    assert volume["units"]["maximum_manipulability"] == "m³"
    assert records["map.parquet"]["shape"] == [50, 15]
    assert records["map.parquet"]["units"]["x"] == "m"


def test_equal_results_have_equal_artifacts(tmp_path, result):
    result.save(tmp_path / "a")
    again = whole()
    again.save(tmp_path / "b")
    assert again.document["artifacts"] == result.document["artifacts"]


def test_map_alone_and_document_alone_are_restored(tmp_path):
    for number, result in enumerate([Result(document(), map=random_map(3)), Result(document()), Result({})]):
        result.save(tmp_path / str(number))
        loaded = Result.load(tmp_path / str(number))
        assert loaded.document == result.document
        assert (loaded.map is None) == (result.map is None)
        assert loaded.volume is None
        assert loaded.skeleton is None


def test_empty_map_and_volume_without_samples_are_saved(tmp_path):
    volume = VolumeData(0.1, (0, 0, 0), np.zeros((2, 2, 2), np.int64), {"mean": {"x": np.full((2, 2, 2), np.nan)}})
    Result(document(), map=random_map(0), volume=volume).save(tmp_path / "out")
    assert len(Result.load(tmp_path / "out").map) == 0


def test_numpy_values_in_the_document_become_plain(tmp_path):
    result = Result({"analysis": "workspace", "bounds_m": np.eye(2), "n": np.int64(3), "t": (1, 2)})
    result.save(tmp_path / "out")
    assert result.document == Result.load(tmp_path / "out").document
    assert result.document["t"] == [1, 2]


@pytest.mark.parametrize("value", [float("nan"), float("inf"), object(), np.float64("nan")])
def test_values_that_json_lacks_are_refused_and_nothing_is_written(tmp_path, value):
    with pytest.raises(InputError, match="cannot be written as JSON"):
        Result({"x": value}).save(tmp_path / "out")
    assert not list(tmp_path.iterdir())


def test_saving_again_replaces_the_result_and_keeps_other_files(tmp_path):
    result = Result(document(), random_map(50, names=()), random_map(20, names=()), random_volume((5, 4, 3)))
    folder = tmp_path / "out"
    folder.mkdir()
    (folder / "notes.txt").write_text("mine")
    result.save(folder, formats=("csv",))
    Result(document(), map=random_map(3)).save(folder)
    names = names_in(folder)
    assert (folder / "notes.txt").read_text() == "mine"
    assert not names & {"volume.vtkhdf", "volume.csv", "map.csv", "sample.parquet", "surface.glb"}
    assert len(Result.load(folder).map) == 3
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_saved_pictures_keep_no_images(tmp_path):
    """Not even where nothing collects circles of references: a server's process draws job after job."""
    result = ws.analyze("scara", ws.Sobol(256), ["manipulability"], device="cpu", refined_volume=None)
    gc.collect()
    before = {id(each) for each in gc.get_objects() if isinstance(each, AxesImage)}
    gc.disable()
    try:
        result.save(tmp_path)
        figure = result.plot.robot()
        left = [each for each in gc.get_objects() if isinstance(each, AxesImage) and id(each) not in before]
        assert left and all(each in figure.axes[0].images for each in left)  # of the one that is there alone
    finally:
        gc.enable()


def test_failed_save_changes_nothing(tmp_path, monkeypatch):
    meshes = {"surface": trimesh.creation.box()}
    result = Result(document(), volume=random_volume((5, 4, 3)), meshes=meshes)
    folder = tmp_path / "out"
    result.save(folder)
    before = {name: (folder / name).read_bytes() for name in names_in(folder)}
    listed = result.document["artifacts"]
    monkeypatch.setattr(
        "wsrender.results.export.meshes.write_mesh", lambda *_: (_ for _ in ()).throw(OSError("disk full"))
    )
    changed = Result(result.document, map=random_map(7), volume=result.volume, meshes=meshes)
    for target in (folder, tmp_path / "fresh"):
        with pytest.raises(OSError, match="disk full"):
            changed.save(target)
    assert {name: (folder / name).read_bytes() for name in names_in(folder)} == before
    assert changed.document["artifacts"] is listed
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_changed_missing_or_outside_files_are_refused(tmp_path):
    folder = tmp_path / "out"
    Result(document(), volume=random_volume((5, 4, 3))).save(folder)
    volume = (folder / "volume.vtkhdf").read_bytes()
    (folder / "volume.vtkhdf").write_bytes(volume[:-1] + bytes([volume[-1] ^ 1]))
    with pytest.raises(InputError, match=r"volume\.vtkhdf: has changed since it was saved"):
        Result.load(folder)
    (folder / "volume.vtkhdf").unlink()
    with pytest.raises(InputError, match=r"volume\.vtkhdf: is listed in result\.json but missing"):
        Result.load(folder)
    for name in ("../secret", "/etc/passwd", "a/../../b", "C:\\x", "", 3, None):
        (folder / "result.json").write_text(json.dumps({"artifacts": [{"name": name, "sha256": ""}]}))
        with pytest.raises(InputError, match="is not the name of a file in the result folder"):
            Result.load(folder)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (None, "is missing"),
        ("{", "cannot be read"),
        ("[]", "holds list"),
        ('{"artifacts": 3}', "must be a list"),
        ('{"artifacts": [3]}', "None is not the name"),
    ],
)
def test_folders_without_a_document_are_refused(tmp_path, text, message):
    if text is not None:
        (tmp_path / "result.json").write_text(text)
    with pytest.raises(InputError, match=message):
        Result.load(tmp_path)


def test_hostile_document_cannot_remove_files_outside_its_folder(tmp_path):
    (tmp_path / "precious").write_text("keep")
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "result.json").write_text(json.dumps({"artifacts": [{"name": "../precious"}]}))
    Result(document()).save(tmp_path / "out")
    assert (tmp_path / "precious").read_text() == "keep"


def test_unknown_format_and_file_as_folder_are_refused(tmp_path, result):
    with pytest.raises(InputError, match="formats: 'docx' is not a format that can be added; allowed: npz"):
        result.save(tmp_path / "out", formats=("docx",))
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="is a file, not a folder"):
        result.save(tmp_path / "file")


def test_global_indices_and_summary_show_the_numbers(result):
    assert result.global_indices == {
        "global_isotropy": 1e-4,
        "structural_length_index": 2.125,
        "joint_mean": {"manipulability": 0.25},
        "workspace_mean": {"manipulability": 0.375},
    }
    text = result.summary()
    for part in ("arm · 1,000,000 samples (sobol)", "1.5 m³", "-2.000 … 2.000 m", "2.125", "0.375", "m³"):
        assert part in text
    assert Result({}).summary()


def test_plots_use_the_sample_and_name_the_robot(result):
    for figure in (
        result.plot.scatter("x"),
        result.plot.slice(z=0.6),
        result.plot.histogram(),
        result.plot.robot(),
    ):
        assert figure.get_suptitle() == "arm · 1,000,000 samples (sobol)"
    cloud = result.plot.scatter().axes[0].collections[-1]
    assert len(cloud.get_offsets()) == 20


def test_plots_of_what_is_not_there_say_so():
    empty = Result(document()).plot
    for draw, message in (
        (empty.scatter, "neither a map nor a sample"),
        (empty.slice, "no volume data"),
        (empty.slices, "no volume data"),
        (empty.robot, "no configurations"),
    ):
        with pytest.raises(InputError, match=message):
            draw()


def test_importing_the_result_loads_nothing_heavy():
    code = (
        "import sys; import wsrender.results.result\n"
        "heavy = {'matplotlib', 'h5py', 'pyarrow', 'trimesh', 'scipy', 'skimage', 'mujoco', 'warp'}\n"
        "assert not heavy & set(sys.modules), heavy & set(sys.modules)\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_missing_library_names_the_pip_command(monkeypatch, tmp_path):
    from wsrender.errors import MissingExtraError

    monkeypatch.setitem(sys.modules, "pyarrow", None)
    monkeypatch.delitem(sys.modules, "wsrender.results.export.parquet", raising=False)
    with pytest.raises(MissingExtraError, match=r'pip install "\.\[engine\]"'):
        Result(document(), map=random_map(3)).save(tmp_path / "out")
    assert not list(tmp_path.iterdir())
