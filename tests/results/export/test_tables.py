"""Tables ↔ files: every kind of column comes back as it was."""

import csv

import numpy as np
import pyarrow.parquet as pq
import pytest
import scipy.io

from wsrender.errors import InputError
from wsrender.results.export import (
    read_table_npz,
    read_table_parquet,
    write_table_csv,
    write_table_mat,
    write_table_npz,
    write_table_parquet,
)
from wsrender.volume.table import Table

FORMATS = [
    pytest.param(write_table_parquet, read_table_parquet, "t.parquet", id="parquet"),
    pytest.param(write_table_npz, read_table_npz, "t.npz", id="npz"),
]


def points(rows=5) -> Table:
    columns = {
        "offset": np.linspace(0, 1, rows),
        "position": np.arange(3.0 * rows).reshape(rows, 3),
        "position_1": np.arange(rows),
        "inside": np.arange(rows) % 2 == 0,
        "label": np.array(["reachable", "undecided, why"])[np.arange(rows) % 2],
        "wsrender": np.arange(rows, dtype=np.float32),
    }
    return Table(columns, {"offset": "m", "position": "m"})


@pytest.mark.parametrize(("write", "read", "name"), FORMATS)
@pytest.mark.parametrize("rows", [0, 1, 5])
def test_tables_are_restored(tmp_path, write, read, name, rows):
    table = points(rows)
    write(table, tmp_path / name)
    found = read(tmp_path / name)
    assert (list(found.columns), found.units, len(found)) == (list(table.columns), table.units, rows)
    for column, values in table.columns.items():
        assert found[column].shape == values.shape
        assert found[column].dtype.kind == values.dtype.kind
        np.testing.assert_array_equal(found[column], values)


def test_files_have_one_plain_column_each(tmp_path):
    write_table_parquet(points(), tmp_path / "t.parquet")
    table = pq.read_table(tmp_path / "t.parquet")
    wide = ["position_0", "position_1", "position_2"]
    assert table.column_names == ["offset", *wide, "column.position_1", "inside", "label", "column.wsrender"]
    assert table.schema.field("position_2").metadata[b"unit"] == b"m"
    assert table["label"].to_pylist()[1] == "undecided, why"
    write_table_csv(points(), tmp_path / "t.csv")
    with (tmp_path / "t.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [float(row["position_2"]) for row in rows] == points()["position"][:, 2].tolist()
    assert [row["inside"] for row in rows] == ["true", "false", "true", "false", "true"]
    write_table_mat(points(), tmp_path / "t.mat")
    content = scipy.io.loadmat(tmp_path / "t.mat")
    assert content["position_2"][:, 0].tolist() == points()["position"][:, 2].tolist()
    assert [text.strip() for text in content["label"]] == points()["label"].tolist()
    assert content["units"]["offset"][0, 0][0] == "m"


def test_columns_of_different_lengths_are_refused():
    with pytest.raises(InputError, match=r"b: has shape \(3,\); the table has 2 rows"):
        Table({"a": np.zeros(2), "b": np.zeros(3)})
    with pytest.raises(InputError, match=r"a: has shape \(2, 1, 1\)"):
        Table({"a": np.zeros((2, 1, 1))})
    assert len(Table({})) == 0
