"""Tables of targets: read as they are meant, and refused by row and column."""

import re
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest
from pyarrow import parquet
from scipy.spatial.transform import Rotation

import wsrender as ws
from wsrender.documents.target_lists import LONGEST_TEXT, TargetTable
from wsrender.reach import target_list as tables
from wsrender.reach.target_list import target_list
from wsrender.robots import array_files

EXAMPLE = Path(__file__).parents[2] / "docs" / "examples" / "targets.csv"
HALF = np.sqrt(0.5)
COLUMNS = {
    "name": ["a", "b", "c"],
    "x_m": [0.1, 0.2, 0.3],
    "y_m": [0.0, -0.1, 0.5],
    "z_m": [1.0, 2.0, 3.0],
    "qw": [1.0, HALF, None],
    "qx": [0.0, 0.0, None],
    "qy": [0.0, 0.0, None],
    "qz": [0.0, HALF, None],
    "free_axis": ["", "y", None],
    "weight": [2.0, None, 0.5],
    "position_tolerance_m": [None, 1e-3, None],
    "angle_tolerance_rad": [0.1, None, None],
}


def csv_of(columns):
    rows = [["" if cell is None else f"{cell}" for cell in row] for row in zip(*columns.values(), strict=True)]
    return "\n".join(",".join(row) for row in [list(columns), *rows]) + "\n"


def read(folder, content, name="t.csv", **options):
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return target_list(TargetTable(path, **options))


def refusal(folder, content, name="t.csv", **options):
    with pytest.raises(ws.InputError) as error:
        read(folder, content, name, **options)
    assert error.value.field == "targets.path"
    return error.value.message


def parquet_of(folder, columns, **options):
    parquet.write_table(pa.table(columns), folder / "t.parquet", **options)
    return (folder / "t.parquet").read_bytes()


@pytest.mark.parametrize("kind", ["csv", "excel", "parquet"])
def test_a_table_says_what_it_holds(kind, tmp_path):
    content = {"csv": csv_of(COLUMNS), "excel": "\ufeff" + csv_of(COLUMNS).replace("\n", "\r\n")}.get(kind)
    found = read(tmp_path, content or parquet_of(tmp_path, COLUMNS), f"t.{'parquet' if kind == 'parquet' else 'csv'}")
    assert found.position.tolist() == np.array([COLUMNS[name] for name in ("x_m", "y_m", "z_m")]).T.tolist()
    assert found.name.tolist() == ["a", "b", "c"] and found.free_axis.tolist() == ["", "y", ""]
    assert found.weight.tolist() == [2, 1, 0.5] and found.oriented.tolist() == [True, True, False]
    assert found.quat_wxyz[1] == pytest.approx([HALF, 0, 0, HALF])
    assert np.array_equal(found.tolerances, [[np.nan, 0.1], [1e-3, np.nan], [np.nan, np.nan]], equal_nan=True)


def test_angles_are_those_of_placements(tmp_path):
    found = read(tmp_path, "x_m,y_m,z_m,roll_deg,pitch_deg,yaw_deg\n0,0,0,20,-30,140\n1,0,0,,,\n")
    turned = Rotation.from_quat(found.quat_wxyz[0], scalar_first=True).as_matrix()
    assert turned == pytest.approx(ws.Transform(rpy_deg=(20, -30, 140)).matrix()[:3, :3])
    assert found.oriented.tolist() == [True, False]


def test_measured_points_need_no_header(tmp_path):
    np.save(tmp_path / "cloud.npy", np.array([[1, 2, 3], [4, 5, 6]], np.float32))
    of_file = target_list(TargetTable(tmp_path / "cloud.npy", length_unit_m=0.001))
    of_text = read(tmp_path, "1,2,3\n4,5,6\n", length_unit_m=0.001)
    assert of_file.position.tolist() == of_text.position.tolist() == [[0.001, 0.002, 0.003], [0.004, 0.005, 0.006]]


def test_listed_targets_are_the_same(tmp_path):
    of_table = read(tmp_path, csv_of(COLUMNS))
    targets = [
        ws.Target(position_m=(0.1, 0, 1), quat_wxyz=(1, 0, 0, 0), name="a", weight=2, angle_tolerance_rad=0.1),
        ws.Target(position_m=(0.2, -0.1, 2), rpy_deg=(0, 0, 90), name="b", free_axis="y", position_tolerance_m=1e-3),
        ws.Target(position_m=(0.3, 0.5, 3), name="c", weight=0.5),
    ]
    listed = target_list(tuple(targets))
    assert listed.quat_wxyz[:2] == pytest.approx(of_table.quat_wxyz[:2])
    for name in ("position", "weight", "name", "free_axis", "tolerances"):
        same = np.array_equal(getattr(listed, name), getattr(of_table, name), equal_nan=name == "tolerances")
        assert same, name
    assert listed.sha256 is None and len(str(of_table.sha256)) == 64


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        ({"colour": ["red"] * 3}, 'column "colour", which no table of targets has; allowed: x_m, y_m, z_m, qw'),
        ({"x_mm": [1] * 3}, 'column "x_mm".*in millimetres call it x_m … and give length_unit_m 0.001; allowed'),
        ({"z_m": None}, "lacks the column z_m; allowed"),
        ({"qy": None}, "lacks the column qy"),
        ({name: [0] * 3 for name in ("roll_deg", "pitch_deg", "yaw_deg")}, "says orientations twice"),
        ({"y_m": [0, "nan", 0]}, 'row 2, column y_m: must be a finite number, not "nan"'),
        ({"y_m": [0, 0, "1,2"]}, "row 3 has 13 cells, not 12"),
        ({"y_m": [0, 0, "1e400"]}, "row 3, column y_m: must be a finite number"),
        ({"y_m": [0, None, 0]}, "row 2, column y_m: must be given, not empty"),
        ({"x_m": [0, 0, 2e6]}, r"row 3, column x_m: must be within ±1e\+06 m, not 2000000"),
        ({"qw": [1, 0.5, None]}, "row 2, columns qw qx qy qz: must be a quaternion of unit length, not of length 0.8"),
        ({"qx": [0, None, None]}, "row 2, column qx: must be given, as the others of its rotation, not empty"),
        ({"free_axis": ["", "w", ""]}, 'row 2, column free_axis: must be empty or one of "x", "y", "z", not w'),
        ({"free_axis": ["", "", "z"]}, "row 3, column free_axis: must be empty where there is no orientation, not z"),
        ({"weight": [1, 0, 1]}, "row 2, column weight: must be greater than 0"),
        ({"position_tolerance_m": [1, 1, -1]}, "row 3, column position_tolerance_m: must be greater than 0"),
        ({"angle_tolerance_rad": [1, 4, 1]}, "row 2, column angle_tolerance_rad: must be at most 3.14"),
        ({"name": ["", "n" * (LONGEST_TEXT + 1), ""]}, "row 2, column name: must have at most 64 characters"),
    ],
)  # fmt: skip
def test_wrong_tables_are_refused_by_row_and_column(columns, message, tmp_path):
    changed = {name: cells for name, cells in (COLUMNS | columns).items() if cells is not None}
    assert re.search(message, refusal(tmp_path, csv_of(changed)))


@pytest.mark.parametrize(
    ("content", "name", "message"),
    [
        ("", "t.csv", "lacks the column x_m, y_m, z_m"),
        ("x_m,y_m,z_m\n", "t.csv", "has 0 rows of targets; allowed: 1 … 1000000"),
        ("x_m;y_m;z_m\n1;2;3\n", "t.csv", 'has the column "x_m;y_m;z_m"'),
        ("x_m,x_m,y_m,z_m\n1,1,2,3\n", "t.csv", 'has the column "x_m" twice'),
        (b"\xff\xfe\x00", "t.csv", "must be UTF-8 text; byte 0 is not"),
        ('x_m,y_m,z_m\n"1"2,2,3\n', "t.csv", "cannot be read as CSV"),
        (b"PAR1 and no more", "t.parquet", "cannot be read as Parquet"),
        (b"\x93NUMPY and no more", "t.npy", "cannot be read as an array of NumPy"),
    ],
)
def test_what_is_no_table_is_refused(content, name, message, tmp_path):
    assert message in refusal(tmp_path, content, name)


def test_arrays_of_other_shapes_and_pickles_are_refused(tmp_path):
    for wrong in (np.zeros((2, 4)), np.zeros(3), np.array([["a", "b", "c"]]), np.array([[{}, {}, {}]])):
        np.save(tmp_path / "t.npy", wrong)
        with pytest.raises(ws.InputError, match=r"\(N, 3\) are needed|cannot be read"):
            target_list(TargetTable(tmp_path / "t.npy"))
    np.save(tmp_path / "t.npy", [[0, 0, 0], [0, np.inf, 0]])
    with pytest.raises(ws.InputError, match="row 2, column y_m: must be a finite number"):
        target_list(TargetTable(tmp_path / "t.npy"))
    with pytest.raises(ws.InputError, match="cannot be read: No such file"):
        target_list(TargetTable(tmp_path / "none.npy"))


def test_parquet_of_other_types_is_refused(tmp_path):
    position = {"x_m": [0.0], "y_m": [0.0], "z_m": [0.0]}
    for extra, message in (
        ({"weight": ["1"]}, "column weight: must hold numbers, not string"),
        ({"name": [1]}, "column name: must hold text, not int64"),
        ({"weight": [[1.0]]}, "column weight: must hold numbers, not list"),
        ({"weight": [float("nan")]}, "row 1, column weight: must be a finite number"),
        ({"mass": [1.0]}, 'column "mass"'),
    ):
        assert message in refusal(tmp_path, parquet_of(tmp_path, position | extra), "t.parquet")


def test_large_tables_are_refused_before_they_are_unpacked(tmp_path, monkeypatch):
    """Texts that are stored once stay so, and are cut; rows, bytes and what they unpack to have limits."""
    many = {name: [0.0] * 2000 for name in ("x_m", "y_m", "z_m")}
    small = parquet_of(tmp_path, many | {"name": ["n" * 500_000] * 2000}, compression="zstd")
    assert len(small) < 10_000
    assert "row 1, column name: must have at most 64 characters" in refusal(tmp_path, small, "t.parquet")
    monkeypatch.setattr(tables, "MOST_TARGETS", 1999)
    assert "has 2000 rows of targets; allowed: 1 … 1999" in refusal(tmp_path, small, "t.parquet")
    assert "has 2000 rows" in refusal(tmp_path, csv_of(many))
    monkeypatch.setattr(array_files, "MOST_UNPACKED", 1000)
    assert "unpacked; at most" in refusal(tmp_path, small, "t.parquet")
    monkeypatch.setattr(array_files, "MOST_BYTES", 1000)
    assert "has more than" in refusal(tmp_path, csv_of(many))


def test_the_example_is_one():
    found = target_list(TargetTable(EXAMPLE))
    assert len(found) == 13 and found.weight.sum() == 14 and found.name[-1] == "camera"
    assert (found.free_axis == "z").sum() == 12 and found.oriented.sum() == 12
