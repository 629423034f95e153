"""Points in a plane may stand in a file, by path or as an upload, of planar arms and five-bars."""

import hashlib
import json

import numpy as np
import pytest
from wsrender_server.jobs.documents import CanonicalDocument

import wsrender as ws
from tests.golden.files import job_of
from wsrender.analyses.jobs import canonical_json, parse_job

FIELDS = [("planar_boundary", "points_m"), ("five_bar", "points_m"), ("five_bar", "joint_angles_rad")]
ROWS = [[0.3, 0.1], [2.0, 2.0], [0.4, -0.2]]


@pytest.mark.parametrize(("analysis", "field"), FIELDS)
def test_a_file_gives_what_the_list_gives(tmp_path, analysis, field):
    swapped = tmp_path / "rows.csv"
    names = {"points_m": "y,x", "joint_angles_rad": "theta2,theta1"}[field]
    swapped.write_text("\n".join([names, *(f"{b},{a}" for a, b in ROWS)]))
    np.save(tmp_path / "rows.npy", np.array(ROWS))
    listed = ws.execute(job_of(analysis) | {field: ROWS})
    assert f"{field}_sha256" not in listed.document["provenance"]
    for path in (swapped, tmp_path / "rows.npy"):
        found = ws.execute(job_of(analysis) | {field: {"path": str(path)}})
        digest = hashlib.sha256(path.read_bytes()).hexdigest()
        assert found.document["provenance"][f"{field}_sha256"] == digest
        for part in ("points", "assemblies", "exact"):
            assert found.document.get(part) == listed.document.get(part)
        if "points" in listed.tables:
            for name in listed.tables["points"].columns:
                np.testing.assert_array_equal(found.tables["points"][name], listed.tables["points"][name])


@pytest.mark.parametrize(("analysis", "field"), FIELDS)
def test_what_is_wrong_in_a_file_names_the_field(tmp_path, analysis, field):
    np.save(tmp_path / "wide.npy", np.zeros((2, 3)))
    for path in (tmp_path / "wide.npy", tmp_path / "none.csv"):
        with pytest.raises(ws.InputError) as refused:
            ws.execute(job_of(analysis) | {field: {"path": str(path)}})
        assert refused.value.field == f"{field}.path"
    with pytest.raises(ws.DocumentError, match=field):
        parse_job(job_of(analysis) | {field: {"path": "rows.txt"}})


def test_of_a_five_bar_only_so_many(tmp_path):
    np.save(tmp_path / "many.npy", np.zeros((10_001, 2)))
    with pytest.raises(ws.InputError, match="at most 10000 rows, not 10001"):
        ws.execute(job_of("five_bar") | {"points_m": {"path": str(tmp_path / "many.npy")}})


@pytest.mark.parametrize(("analysis", "field"), FIELDS)
def test_a_server_knows_the_upload_and_takes_no_path(analysis, field):

    upload = parse_job(job_of(analysis) | {field: {"model": "0" * 64}})
    document = CanonicalDocument.of(json.loads(canonical_json(upload)))
    assert (f"{field}.model", "0" * 64) in document.uploads
    local = parse_job(job_of(analysis) | {field: {"path": "rows.npy"}})
    with pytest.raises(ws.InputError, match="is for local runs"):
        CanonicalDocument.of(json.loads(canonical_json(local)))
