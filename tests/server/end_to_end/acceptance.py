"""What every kind of server must do, as functions of a client."""

import json
from pathlib import Path

import wsrender as ws
from wsrender.results.export.artifacts import sha256

QUICK = {
    "analysis": "workspace",
    "robot": {"library": "ur5e"},
    "sampling": {"method": "sobol", "count": 4096},
    "indices": ["manipulability"],
    "voxel_size_m": 0.1,
    "device": "cpu",
}
# Many shards of WSRENDER_SHARD_SAMPLES, a few seconds of work in all.
LONG = {**QUICK, "sampling": {"method": "sobol", "count": 24 * 2**18}}
LONG_SHARD_SAMPLES = 2**18
PATIENCE_S = 300.0  # of a test; machines are shared and kernels may have to be compiled


def local_result(document: dict, folder: Path) -> ws.Result:
    """The result of a local run, saved."""
    result = ws.execute(document)
    result.save(folder)
    return result


def comparable(document: dict) -> dict:
    """A result document without what may differ between two runs: seconds, and the host's name."""
    copy = json.loads(json.dumps(document))
    del copy["timing_s"], copy["provenance"]["host"], copy["provenance"]["run"]
    return copy


def assert_same_result(result: ws.Result, local: ws.Result) -> None:
    """Every bit but times and host; artifacts are compared by their SHA-256 within the documents."""
    assert comparable(result.document) == comparable(local.document)
    assert len(result.document["artifacts"]) > 5


def assert_same_files(folder: Path, expected: Path) -> None:
    """Two saved results have the same files, result.json apart."""
    hashes = [
        {path.relative_to(root): sha256(path) for path in root.rglob("*") if path.is_file()}
        for root in (folder, expected)
    ]
    for files in hashes:
        del files[Path("result.json")]
    assert hashes[0] == hashes[1]
