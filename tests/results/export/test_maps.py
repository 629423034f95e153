import csv
import io
import zipfile

import numpy as np
import pyarrow.parquet as pq
import pytest
import scipy.io

from tests.results.export.sample_data import ODD_NAMES, assert_same_map, random_map
from wsrender.errors import InputError
from wsrender.results.export import (
    parquet,
    read_table_npz,
    read_table_parquet,
    write_table_csv,
    write_table_mat,
    write_table_npz,
    write_table_parquet,
)
from wsrender.volume.distribution_map import DistributionMap

FORMATS = [
    pytest.param(write_table_parquet, read_table_parquet, ".parquet", id="parquet"),
    pytest.param(write_table_npz, read_table_npz, ".npz", id="npz"),
]


@pytest.mark.parametrize(("write", "read", "suffix"), FORMATS)
@pytest.mark.parametrize("kind", [np.float32, np.float64])
@pytest.mark.parametrize("rows", [0, 1, 1000])
def test_map_is_restored(tmp_path, write, read, suffix, kind, rows):
    samples = random_map(rows, kind)
    write(samples, tmp_path / f"map{suffix}")
    assert_same_map(samples, read(tmp_path / f"map{suffix}"))


@pytest.mark.parametrize(("write", "read", "suffix"), FORMATS)
def test_positions_alone_are_restored(tmp_path, write, read, suffix):
    samples = DistributionMap(position=np.eye(3), indices={}, joint_names=("a", "b"))
    write(samples, tmp_path / f"map{suffix}")
    assert_same_map(samples, read(tmp_path / f"map{suffix}"))


@pytest.mark.parametrize(
    ("write", "suffix"),
    [(w.values[0], w.values[2]) for w in FORMATS] + [(write_table_csv, ".csv"), (write_table_mat, ".mat")],
)
def test_equal_maps_give_equal_bytes(tmp_path, monkeypatch, write, suffix):
    write(random_map(), tmp_path / f"a{suffix}")
    monkeypatch.setattr("time.time", lambda: 1.0)
    monkeypatch.setattr("time.asctime", lambda *_: "another time")
    write(random_map(), tmp_path / f"b{suffix}")
    assert (tmp_path / f"a{suffix}").read_bytes() == (tmp_path / f"b{suffix}").read_bytes()
    assert sorted(file.name for file in tmp_path.iterdir()) == [f"a{suffix}", f"b{suffix}"]


def test_parquet_columns_and_units(tmp_path):
    write_table_parquet(random_map(), tmp_path / "map.parquet")
    schema = pq.read_schema(tmp_path / "map.parquet")
    assert schema.names[:10] == ["x", "y", "z", "joint.x", "elbow", "wrist, 'roll'", "qw", "qx", "qy", "qz"]
    assert schema.names[10:] == ["manipulability", "index.x", 'a_b "c", d', "..", "file"]
    assert schema.field("y").metadata[b"unit"] == b"m"
    assert schema.field("manipulability").metadata[b"unit"].decode() == "m³"
    assert b'"frame": "world"' in schema.metadata[b"wsrender"]


def test_parquet_encoding_is_byte_stream_split_zstd_without_dictionary(tmp_path):
    write_table_parquet(random_map(), tmp_path / "map.parquet")
    group = pq.read_metadata(tmp_path / "map.parquet").row_group(0)
    for k in range(group.num_columns):
        column = group.column(k)
        assert column.compression == "ZSTD"
        assert "BYTE_STREAM_SPLIT" in column.encodings
        assert not column.has_dictionary_page


def test_map_is_written_and_read_by_row_groups(tmp_path, monkeypatch):
    monkeypatch.setattr(parquet, "ROWS_PER_GROUP", 300)
    write_table_parquet(random_map(), tmp_path / "map.parquet")
    assert pq.read_metadata(tmp_path / "map.parquet").num_row_groups == 4
    assert_same_map(random_map(), read_table_parquet(tmp_path / "map.parquet"))


def test_pandas_free_readers_see_the_values(tmp_path):
    samples = random_map()
    write_table_parquet(samples, tmp_path / "map.parquet")
    table = pq.read_table(tmp_path / "map.parquet")
    np.testing.assert_array_equal(table["joint.x"].to_numpy(), samples.configuration[:, 0])
    np.testing.assert_array_equal(table["qz"].to_numpy(), samples.quat_wxyz[:, 3])


def test_csv_header_is_quoted_and_values_are_exact(tmp_path):
    samples = random_map(50)
    write_table_csv(samples, tmp_path / "map.csv")
    text = (tmp_path / "map.csv").read_text()
    header, *rows = csv.reader(io.StringIO(text))
    assert header[3:6] == ["joint.x", "elbow", "wrist, 'roll'"]
    assert 'a_b "c", d' in header
    values = np.array(rows, dtype=np.float32)
    np.testing.assert_array_equal(values[:, :3], samples.position)
    np.testing.assert_array_equal(values[:, header.index("index.x")], samples.indices["x"])


def test_csv_of_no_rows_has_a_header(tmp_path):
    write_table_csv(random_map(0), tmp_path / "map.csv")
    assert (tmp_path / "map.csv").read_text().startswith('"x","y","z"')


def test_mat_holds_valid_identifiers_and_units(tmp_path):
    samples = random_map()
    write_table_mat(samples, tmp_path / "map.mat")
    content = scipy.io.loadmat(tmp_path / "map.mat")
    np.testing.assert_array_equal(content["joint_x"][:, 0], samples.configuration[:, 0])
    np.testing.assert_array_equal(content["a_b__c___d"][:, 0], samples.indices[ODD_NAMES[2]])
    assert content["units"]["manipulability"][0, 0][0] == "m³"


def test_unequal_lengths_are_refused_and_leave_no_file(tmp_path):
    samples = DistributionMap(position=np.zeros((3, 3)), indices={"w": np.zeros(2)})
    for write, suffix in ((write_table_parquet, "parquet"), (write_table_npz, "npz"), (write_table_csv, "csv")):
        with pytest.raises(InputError, match=r"w: has shape \(2,\); the map has 3 rows"):
            write(samples, tmp_path / f"map.{suffix}")
    assert not list(tmp_path.iterdir())


def test_failure_while_writing_keeps_the_old_file(tmp_path, monkeypatch):
    path = tmp_path / "map.parquet"
    write_table_parquet(random_map(3), path)
    monkeypatch.setattr(parquet, "ROWS_PER_GROUP", 100)
    broken = random_map()
    monkeypatch.setattr(parquet.np, "ascontiguousarray", _fails_after(5))
    with pytest.raises(MemoryError):
        write_table_parquet(broken, path)
    monkeypatch.undo()
    assert len(read_table_parquet(path)) == 3
    assert [file.name for file in tmp_path.iterdir()] == ["map.parquet"]


def _fails_after(calls):
    real, left = np.ascontiguousarray, [calls]

    def ascontiguousarray(array):
        left[0] -= 1
        if left[0] < 0:
            raise MemoryError
        return real(array)

    return ascontiguousarray


@pytest.mark.parametrize(("write", "read", "suffix"), FORMATS)
def test_truncated_or_foreign_files_are_refused(tmp_path, write, read, suffix):
    path = tmp_path / f"map{suffix}"
    write(random_map(), path)
    path.write_bytes(path.read_bytes()[:-100])
    with pytest.raises(InputError, match="cannot be read"):
        read(path)
    path.write_bytes(b"")
    with pytest.raises(InputError, match="cannot be read"):
        read(path)
    with pytest.raises(InputError, match="cannot be read"):
        read(tmp_path / "absent")


def test_foreign_parquet_is_refused(tmp_path):
    import pyarrow as pa

    pq.write_table(pa.table({"x": [1.0]}), tmp_path / "map.parquet")
    with pytest.raises(InputError, match="not a map or table"):
        read_table_parquet(tmp_path / "map.parquet")


def test_pickled_array_is_never_loaded(tmp_path):
    with zipfile.ZipFile(tmp_path / "map.npz", "w") as file:
        buffer = io.BytesIO()
        np.lib.format.write_array(buffer, np.array([{}]), allow_pickle=True)
        file.writestr("wsrender.npy", buffer.getvalue())
    with pytest.raises(InputError, match="allow_pickle"):
        read_table_npz(tmp_path / "map.npz")
