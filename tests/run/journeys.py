"""Jobs and results on their ways: through the command line, through files, to another process."""

import json

import pytest

import wsrender as ws
from wsrender.__main__ import main
from wsrender.run import finish, plan, run_shard
from wsrender.run.partial_files import load_partial, save_partial


def from_the_command_line(document, folder):
    """The result that ``wsrender run`` of a job document leaves in ``folder/out``."""
    (folder / "job.json").write_text(json.dumps(document))
    with pytest.raises(SystemExit) as ended:
        main(["run", str(folder / "job.json"), "-o", str(folder / "out")])
    assert not ended.value.code
    return ws.Result.load(folder / "out")


def from_a_partial_file(document, folder, progress=None):
    """The result of a job whose only shard another process computes, which knows what planning has settled."""
    here = plan(document)
    save_partial(run_shard(here, 0, progress), folder / "partial.npz")
    there = plan(document, resolved=json.loads(json.dumps(here.resolved())))
    return finish(there, load_partial(folder / "partial.npz", there))


def hashes_of_two_saves(result, folder):
    """SHA-256 of every file by its name, of a result that is saved twice."""
    hashes = []
    for name in ("a", "b"):
        result.save(folder / name)
        hashes.append({each["name"]: each["sha256"] for each in result.document["artifacts"]})
    return hashes
