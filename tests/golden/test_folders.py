"""Result folders that earlier versions have saved are read: document, data, summary and list of pictures."""

import json
import zipfile

import pytest

import wsrender as ws
from tests.golden.files import FOLDERS, UNSAVED, analyses, saved_folder, saved_versions
from wsrender.analyses.jobs import parse_job

SAVED = [(path.parent.name, path.stem) for path in sorted(FOLDERS.glob("*/*.zip"))]


def test_there_is_one_of_every_analysis():
    assert "0.2.0" in saved_versions()
    assert {analysis for _, analysis in SAVED} == set(analyses()) - UNSAVED


@pytest.mark.parametrize(("version", "analysis"), SAVED)
def test_a_saved_result_is_read(version, analysis, tmp_path):
    folder = saved_folder(version, analysis, tmp_path)
    written = json.loads((folder / "result.json").read_text(encoding="utf-8"))
    assert written["provenance"]["wsrender"] == version
    result = ws.Result.load(folder)
    assert result.document["analysis"] == analysis
    assert result.document["headline"] == written["headline"]
    assert result.document["job"] == written["job"]
    names = {record["name"] for record in written["artifacts"]}
    assert names == set(zipfile.ZipFile(FOLDERS / version / f"{analysis}.zip").namelist()) - {"result.json"}
    held = {**result.tables, **result.volumes, "volume": result.volume, "sample": result.sample, "map": result.map}
    data = {name for name in names if name.endswith((".parquet", ".vtkhdf"))}
    assert data == {name for name in data if held.get(name.rpartition(".")[0]) is not None}
    assert set(result.meshes) == {name.removesuffix(".ply") for name in names if name.endswith(".ply")}
    assert (result.skeleton is not None) == ("skeleton.npy" in names)
    assert result.summary().strip()
    assert result.plot.pictures


@pytest.mark.parametrize(("version", "analysis"), SAVED)
def test_a_saved_job_is_a_job(version, analysis, tmp_path):
    """The job of a result can be run again."""
    document = ws.Result.load(saved_folder(version, analysis, tmp_path)).document
    assert parse_job(document["job"]).analysis == analysis
