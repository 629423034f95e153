"""Rows of numbers in files: read as they were written, refused before memory is taken, by field and file."""

import hashlib
import io
import tracemalloc

import numpy as np
import pyarrow as pa
import pytest
from pyarrow import parquet

from wsrender.documents.array_files import ArrayFile
from wsrender.errors import DocumentError, InputError
from wsrender.robots import array_files
from wsrender.robots.array_files import rows_in
from wsrender.robots.uploaded import MODELS_VARIABLE

HEADERS = (("a", "b", "c"), ("a_m", "b_m", "c_m"))
ROWS = np.random.default_rng(4).normal(size=(7, 3)) * 1e3


def npy(array, **options):
    file = io.BytesIO()
    np.lib.format.write_array(file, np.asarray(array), **options)
    return file.getvalue()


def npy_header(text):
    padded = text.encode().ljust(117) + b"\n"
    return b"\x93NUMPY\x01\x00" + len(padded).to_bytes(2, "little") + padded


def table(columns, names="abc"):
    file = io.BytesIO()
    parquet.write_table(pa.Table.from_arrays([pa.array(each) for each in columns], names=[*names]), file)
    return file.getvalue()


def csv(columns, header="", end="\n"):
    lines = [",".join(map(repr, row)) for row in np.column_stack(columns).tolist()]
    return end.join([header, *lines] if header else lines).encode()


def read(content, folder, monkeypatch):
    """The rows of an upload."""
    sha256 = hashlib.sha256(content).hexdigest()
    (folder / sha256).write_bytes(content)
    monkeypatch.setenv(MODELS_VARIABLE, str(folder))
    return rows_in(ArrayFile(model=sha256), HEADERS, "rows")


A, B, C = ROWS.T


@pytest.mark.parametrize(
    "content",
    [
        npy(ROWS), npy(np.asfortranarray(ROWS)), npy(ROWS.astype(">f8")), npy(ROWS, version=(2, 0)),
        table([A, B, C]), table([C, A, B], "cab"), table([B, A, C], ["b_m", "a_m", "c_m"]), table([A, B, C], "uvw"),
        csv([A, B, C]), csv([B, A, C], "b,a,c"), csv([A, B, C], "u,v,w"), csv([C, B, A], "\ufeff# c, b ,a", "\r\n"),
    ],
    ids=["C order", "Fortran order", "big-endian", "version 2", "named", "named otherwise", "second names",
         "other names", "bare CSV", "CSV by name", "CSV of other names", "CSV of a spreadsheet"],
)  # fmt: skip
def test_rows_are_those_that_were_written(content, tmp_path, monkeypatch):
    """To the last bit, and in the order of the names where columns have them."""
    found = read(content, tmp_path, monkeypatch)
    assert found.values.dtype == np.float64 and found.values.flags.c_contiguous
    assert found.values.tobytes() == ROWS.tobytes()
    assert found.provenance("rows") == {"rows_sha256": hashlib.sha256(content).hexdigest()}


def test_rows_of_other_types_are_their_values(tmp_path, monkeypatch):
    for kind in (np.float32, np.float16, np.int8, np.uint32):
        rows = np.abs(ROWS / 100).astype(kind)
        for content in (npy(rows), table(rows.T)):
            assert np.array_equal(read(content, tmp_path, monkeypatch).values, rows)
    assert not np.signbit(read(npy([[-0.0, 1, 2]]), tmp_path, monkeypatch).values).any()  # as documents have them


def test_a_document_lists_rows_without_a_file():
    found = rows_in(((1, 2.5, 3),), HEADERS, "rows")
    assert found.values.tolist() == [[1, 2.5, 3]] and found.provenance("rows") == {}


SHORT = "rows of 3 finite numbers are needed, 1 … 10,000,000 of them"


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (npy(ROWS[:, :2]), f"has the shape (7, 2); {SHORT}"),
        (npy(ROWS[:0]), f"has the shape (0, 3); {SHORT}"),
        (npy(ROWS[0]), f"has the shape (3,) of float64; {SHORT}"),
        (npy(ROWS.astype(object)), f"has the shape (7, 3) of object; {SHORT}"),
        (npy(ROWS > 0), "of bool"), (npy(ROWS + 0j), "of complex128"), (npy(ROWS.astype(np.longdouble)), "of float128"),
        (npy(ROWS.astype("U9")), "of <U9"),
        (npy(ROWS)[:-1], "its header says 168 bytes of numbers, there are 167"),
        (npy(ROWS) + b"\0", "its header says 168 bytes of numbers, there are 169"),
        (npy_header("{'descr': '<f8', 'fortran_order': False, 'shape': (-1, -3)}") + b"\0" * 24, "shape (-1, -3)"),
        (npy_header("{'descr': '<f8', 'fortran_order': False, 'shape': (9000000000, 3)}"), "header says 216000000000"),
        (npy_header("__import__('os').abort()"), "cannot be read as an array of NumPy"),
        (npy(ROWS, version=(3, 0)), "version 3.0 is of no array of numbers"), (b"\x93NUMPY", "cannot be read"),
        (npy([[0, 1, 2], [3, np.nan, 5]]), "row 2, column 2: must be a finite number, not nan"),
        (npy([[0, 1, -np.inf]]), "row 1, column 3: must be a finite number, not -inf"),
        (table([A, B], "ab"), f"has the shape (7, 2); {SHORT}"),
        (table([A, B, C], "abx"), 'has the columns "a", "b", "x", of which only "a", "b" are known; allowed: "a", "b"'),
        (table([A, B, C], "aab"), 'has the column "a" twice'),
        (table([A, B, ["x"] * 7]), "column c: must hold numbers, not string"),
        (table([A, B, [[1.0]] * 7]), "column c: must hold numbers, not list"),
        (table([[1.0, None], [1, 2], [3, 4]]), "row 2, column a: must be a finite number, not nan"),
        (table([[2**60 + 1], [0], [0]]), "cannot be read as Parquet: Integer value"),
        (table([A, B, C])[:-20], "cannot be read as Parquet"), (b"PAR1" + b"\0" * 99, "cannot be read as Parquet"),
        (b"\n\n", "cannot be read as .npy, Parquet or CSV"), (b"a,b,c\n# none\n", "it holds none"),
        (b"a,b,c\n1,2\n", "has 3 columns in its header, 2 below"), (b"1,2,3\n1,2\n", "number of columns changed"),
        (b"a;b;c\n1;2;3\n", "could not convert string"), (b"a,b,c\n0,1e999,0\n", "row 1, column b: must be a finite"),
        (b"\xff\xfe\0", "utf-8"),
    ],
)  # fmt: skip
def test_what_is_no_rows_is_refused_by_field_and_file(content, message, tmp_path, monkeypatch):
    with pytest.raises(InputError) as told:
        read(content, tmp_path, monkeypatch)
    assert told.value.field == "rows.model" and message in str(told.value)
    assert f"the upload {hashlib.sha256(content).hexdigest()[:12]}…" in str(told.value)


def test_what_is_too_large_is_refused_before_it_is_read(tmp_path, monkeypatch):
    """Rows, numbers and bytes have limits; Parquet and CSV of many rows are told by what they say."""
    many = np.zeros((300_000, 3))
    for content in (npy(many), table(many.T)):
        monkeypatch.setattr(array_files, "MOST_ROWS", len(many) - 1)
        tracemalloc.start()
        with pytest.raises(InputError, match=r"has the shape \(300000, 3\); .* 1 … 299,999 of them"):
            read(content, tmp_path, monkeypatch)
        assert tracemalloc.get_traced_memory()[1] < len(content) + 2**20
        tracemalloc.stop()
        monkeypatch.setattr(array_files, "MOST_ROWS", len(many))
        assert len(read(content, tmp_path, monkeypatch).values) == len(many)
    monkeypatch.setattr(array_files, "MOST_NUMBERS", 20)
    for content in (npy(ROWS), table([A, B, C])):
        with pytest.raises(InputError, match="1 … 6 of them"):
            read(content, tmp_path, monkeypatch)
    with pytest.raises(InputError, match="holds more than 20 numbers"):
        read(csv([A, B, C]) + b"\n", tmp_path, monkeypatch)
    monkeypatch.setattr(array_files, "MOST_UNPACKED", 10)
    with pytest.raises(InputError, match="unpacked; at most"):
        read(table([A, B, C]), tmp_path, monkeypatch)


@pytest.mark.parametrize("said", [200_000, 400_000])
def test_parquet_of_other_rows_than_it_says_is_refused(said, tmp_path, monkeypatch):
    """However many there are, no more are read than were said."""
    content = table(np.zeros((3, 300_000)))
    footer = len(content) - 8 - int.from_bytes(content[-8:-4], "little")
    lie = content[:footer] + content[footer:].replace(_varint(300_000), _varint(said), 1)
    with pytest.raises(InputError, match=f"it says {said} rows, and has others"):
        read(lie, tmp_path, monkeypatch)


def _varint(number):
    """As Thrift's compact protocol writes numbers of three bytes."""
    number *= 2
    return bytes([number & 127 | 128, number >> 7 & 127 | 128, number >> 14])


def test_files_of_a_path_name_it(tmp_path, monkeypatch):
    np.save(tmp_path / "r.npy", ROWS)
    assert rows_in(ArrayFile(tmp_path / "r.npy"), HEADERS, "rows").values.tobytes() == ROWS.tobytes()
    for path, message in (
        (tmp_path / "none.npy", "cannot be read: No such file"),
        (tmp_path / "r.npy", "more than 0 MiB"),
    ):
        monkeypatch.setattr(array_files, "MOST_BYTES", 100)
        with pytest.raises(InputError, match=message) as told:
            rows_in(ArrayFile(path), HEADERS, "rows")
        assert told.value.field == "rows.path" and str(path) in str(told.value)


def test_uploads_that_are_gone_or_damaged_are_told(tmp_path, monkeypatch):
    monkeypatch.setenv(MODELS_VARIABLE, str(tmp_path))
    with pytest.raises(InputError, match="is not among the uploaded models"):
        rows_in(ArrayFile(model="0" * 64), HEADERS, "rows")
    (tmp_path / ("0" * 64)).write_bytes(npy(ROWS))
    with pytest.raises(InputError, match="is damaged on the server"):
        rows_in(ArrayFile(model="0" * 64), HEADERS, "rows")


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({}, 'path: must be given, or else "model": one of the two'),
        ({"path": "a.npy", "model": "0" * 64}, 'path: must be given, or else "model"'),
        ({"path": "a.npz"}, "path: must end in .csv, .parquet, .npy"),
        ({"model": "../../etc/passwd"}, "model: must match"),
    ],
)
def test_documents_name_one_file(fields, message):
    with pytest.raises(DocumentError, match=message):
        ArrayFile(**fields)
