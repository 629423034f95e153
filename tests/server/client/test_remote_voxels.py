"""Voxels of a job on a server as xarray's arrays, of which only what is used is downloaded; bytes are counted."""

import hashlib
import re
import subprocess
import sys

import httpx2
import numpy as np
import pytest

import wsrender as ws
from tests.results.export.sample_data import random_volume
from tests.server.client.recorded_server import refuses, says
from wsrender.client.range_file import BLOCK_BYTES, RangeFile
from wsrender.results.result import Result
from wsrender.volume.table import CellGrid, Table

xarray = pytest.importorskip("xarray")
SHAPE = (90, 80, 70)
FILE = "/v1/jobs/j1/artifacts/volume.vtkhdf"


@pytest.fixture(scope="module")
def local(tmp_path_factory):
    folder = tmp_path_factory.mktemp("local") / "out"
    heat = Table({"x_m": np.repeat([0.5, 1.5], 2), "y_m": np.tile([0.5, 1.5], 2), "heat": np.arange(4.0)},
                 {"x_m": "m", "y_m": "m"}, CellGrid(("x_m", "y_m"), (0.0, 0.0), (1.0, 1.0), (2, 2)))  # fmt: skip
    result = Result(
        {"analysis": "workspace", "robot": {"name": "arm"}, "sampling": {"method": "sobol", "samples": 8}},
        volume=random_volume(SHAPE),
        volumes={"left": random_volume((4, 3, 2))},
        tables={"heat": heat},
    )
    result.save(folder)
    return result, folder


def ranged(content, etag):
    """A file that is given by ranges, first to last byte."""

    def answer(request):
        if request.headers.get("If-Range") != etag or "Range" not in request.headers:
            return 200, {"ETag": etag}, content
        first, last = map(int, re.fullmatch(r"bytes=(\d+)-(\d+)", request.headers["Range"]).groups())
        assert last < len(content)
        return 206, {"ETag": etag, "Content-Range": f"bytes {first}-{last}/{len(content)}"}, content[first : last + 1]

    return answer


@pytest.fixture
def remote(server, client, local):
    result, folder = local
    server.answer("GET", "/v1/jobs/j1", says({"id": "j1", "state": "succeeded"}))
    server.answer("GET", "/v1/jobs/j1/result", says(result.document))
    for artifact in result.document["artifacts"]:
        content = (folder / artifact["name"]).read_bytes()
        etag = f'"{hashlib.sha256(content).hexdigest()}"'
        server.answer("GET", f"/v1/jobs/j1/artifacts/{artifact['name']}", ranged(content, etag))
    return client.job("j1").result()


def downloaded(server, path=FILE):
    """Bytes of a file that were asked for by ranges; a request without is the whole file."""
    total = 0
    for request in server.sent("GET", path):
        first, last = map(int, request.headers["Range"].removeprefix("bytes=").split("-"))
        total += last - first + 1
    return total


def test_all_of_it_is_that_of_a_local_result(remote, server, local):
    expected = local[0].to_xarray()
    with remote.to_xarray() as found:
        assert list(found.variables) == list(expected.variables)
        xarray.testing.assert_identical(found.load(), expected)
    assert downloaded(server) <= (local[1] / "volume.vtkhdf").stat().st_size + BLOCK_BYTES
    asked = [request.headers for request in server.sent("GET", FILE)]
    assert {(each["Authorization"], each["Accept-Encoding"]) for each in asked} == {("Bearer secret", "identity")}


def test_a_plane_costs_its_layers(remote, server, local):
    size = (local[1] / "volume.vtkhdf").stat().st_size
    expected = local[0].to_xarray()
    with remote.to_xarray("volume") as found:
        opened = downloaded(server)
        assert 0 < opened < size / 10
        name = next(name for name in found.data_vars if name.startswith("maximum"))
        chunk_bytes = np.prod(found[name].shape) * 8
        plane = found[name].sel(z=float(expected.z[7]), method="nearest")
        np.testing.assert_array_equal(plane, expected[name].isel(z=7))
        once = downloaded(server)
        assert opened < once < opened + chunk_bytes and once < size / 3
        plane.load()
        np.testing.assert_array_equal(found[name].isel(z=7), expected[name].isel(z=7))
        assert downloaded(server) == once  # blocks are kept
    assert not [request for request in server.requests if "Range" not in request.headers and FILE in str(request.url)]


@pytest.mark.parametrize(
    "chosen",
    [
        {"x": 3}, {"y": slice(2, 9), "z": 4}, {"x": [5, 1, 1], "y": slice(None, None, -3)}, {"x": 1, "y": 2, "z": 3},
        {"z": slice(0, 0)}, {"x": slice(80, 2, -7), "z": [69, 0]},
    ],
)  # fmt: skip
def test_any_part_is_that_of_the_whole(chosen, remote, local):
    expected = local[0].to_xarray().isel(chosen)
    with remote.to_xarray() as found:
        xarray.testing.assert_identical(found.isel(chosen).load(), expected)


def test_other_volumes_and_maps_have_their_names(remote, server, local):
    with remote.to_xarray("left") as found:
        xarray.testing.assert_identical(found.load(), local[0].to_xarray("left"))
    assert not server.sent("GET", FILE)
    xarray.testing.assert_identical(remote.to_xarray("heat"), local[0].to_xarray("heat"))
    with pytest.raises(ws.InputError, match="name: the result has no volume or map right"):
        remote.to_xarray("right")


def test_what_was_downloaded_is_not_asked_again(remote, server, local):
    assert remote.volume is not None
    asked = len(server.requests)
    with remote.to_xarray() as found:
        xarray.testing.assert_identical(found.load(), local[0].to_xarray())
    assert len(server.requests) == asked


@pytest.mark.parametrize(
    ("answer", "error", "message"),
    [
        ((200, {}, b"other"), ws.ServerError, "the file has changed, or the server gives no ranges"),
        ((206, {}, b"short"), ws.ServerError, "5 bytes came of"),
        (refuses(404, "not_found", detail="no job j1"), ws.NotFoundError, "no job j1"),
        (httpx2.ReadError("reset"), ws.ServerConnectionError, "lost the server"),
    ],
)
@pytest.mark.parametrize("opened", [False, True])
def test_what_goes_wrong_is_told_as_it_is(answer, error, message, opened, remote, server):
    if not opened:
        server.answer("GET", FILE, answer)
        with pytest.raises(error, match=message):
            remote.to_xarray()
        return
    with remote.to_xarray() as found:
        server.answer("GET", FILE, answer)
        with pytest.raises(error, match=message):
            found.load()


def test_a_file_that_is_none_is_refused(remote, server, local):
    content = bytes((local[1] / "volume.vtkhdf").stat().st_size)
    server.answer("GET", FILE, ranged(content, f'"{remote.files.records["volume.vtkhdf"]["sha256"]}"'))
    with pytest.raises(ws.InputError, match="volume: cannot be read as volume data"):
        remote.to_xarray()


ENDS = """
import sys

import httpx2

import wsrender as ws
from tests.server.client.recorded_server import RecordedServer, says
from tests.server.client.test_remote_voxels import FILE

server = RecordedServer()
server.answer("GET", "/v1/jobs/j1", says({"id": "j1", "state": "succeeded"}))
record = {"name": "volume.vtkhdf", "sha256": "0" * 64, "bytes": 1 << 20}
document = {"analysis": "workspace", "robot": {"name": "arm"}, "format": 2, "artifacts": [record]}
server.answer("GET", "/v1/jobs/j1/result", says(document))
server.answer("GET", FILE, httpx2.ReadError("reset"))
with ws.Client("http://lab:8000", transport=server, patience_s=0.0) as client:
    result = client.job("j1").result()
    try:
        result.to_xarray()
    except ws.ServerConnectionError as error:
        kept = error  # with its traceback, as a notebook keeps the last one
        sys.exit(3)
"""


def test_a_process_whose_download_failed_ends_as_it_should():
    """HDF5 crashed after the interpreter's end, of what a traceback had kept."""
    ended = subprocess.run([sys.executable, "-c", ENDS], capture_output=True, text=True, timeout=120)
    assert (ended.returncode, ended.stderr) == (3, "")


@pytest.fixture
def file(server):
    """Eight bytes of the server."""
    with ws.Client("http://lab:8000", transport=server, patience_s=0.0) as client:
        yield RangeFile(client._connection, FILE, '"e"', 8)


def test_a_failed_download_stays_failed(file, server):
    """Zeros that HDF5 was given instead are never taken for data."""
    server.answer("GET", FILE, httpx2.ReadError("reset"), (206, {}, b"12345678"))
    file.check()
    assert file.read(4) == bytes(4)
    for _ in range(2):
        with pytest.raises(ws.ServerConnectionError, match="lost the server"):
            file.check()
    assert file.read(4) == bytes(4) and file.bytes_read == 0


def test_ctrl_c_is_said_once(file, server):
    server.answer("GET", FILE, KeyboardInterrupt())
    assert file.read(4) == bytes(4)
    with pytest.raises(KeyboardInterrupt):
        file.check()
    with pytest.raises(ws.ServerError, match=f"{FILE}: reading was interrupted; open it again"):
        file.check()
