"""Results of small jobs of every analysis are what they were."""

import copy
import shutil

import pytest

from tests.golden import write
from tests.golden.facts import differences
from tests.golden.files import analyses, golden, golden_names, job_of


def test_every_analysis_has_a_golden_job():
    assert set(analyses()) <= set(golden_names())
    for name in golden_names():
        assert job_of(name)["analysis"] == name.partition(".")[0] in analyses()


@pytest.mark.parametrize("name", golden_names())
def test_a_result_is_what_it_was(name):
    expected = golden(name)
    assert expected["data"]
    assert differences(write.run(expected["job"]), expected) == []


def changed(change):
    """Differences of a golden file whose copy has been changed, from itself."""
    expected = golden("workspace")
    found = copy.deepcopy(expected)
    change(found)
    return differences(found, expected)


def test_changes_are_found():
    """Each of these is one line that names its place; a change within the tolerance is none."""
    count = "volume/count"

    def scaled(factor):
        return lambda found: found["document"]["headline"].update(value=found["document"]["headline"]["value"] * factor)

    assert changed(scaled(1 + 1e-7)) == []
    for change, place in (
        (scaled(1 + 1e-3), "document.headline.value:"),
        (lambda found: found["document"].pop("headline"), "document.headline: missing"),
        (lambda found: found["document"].update(more=1), "document.more: new"),
        (lambda found: found["document"]["warnings"].append({}), "document.warnings:"),
        (lambda found: found["data"][count].update(unit="m"), f"data.{count}.unit:"),
        (lambda found: found["data"][count].update(dtype="int32"), f"data.{count}.dtype:"),
        (lambda found: found["data"][count].update(turned_sum=0.0), f"data.{count}.turned_sum:"),
        (lambda found: found["data"][count].update(not_finite=1), f"data.{count}.not_finite:"),
        (lambda found: found["estimate"].update(bytes=found["estimate"]["bytes"] / 2), "estimate.bytes:"),
        (lambda found: found["estimate"].update(seconds=found["estimate"]["seconds"] * 3), "estimate.seconds:"),
        (lambda found: found["pictures"].append("other"), "pictures:"),
    ):
        (line,) = changed(change)
        assert line.startswith(place)


def test_one_command_writes_them_again(tmp_path, monkeypatch):
    """With the same numbers; the job of a file stays as it is."""
    name = "indices_at"
    before = golden(name)
    shutil.copy(write.DOCUMENTS / f"{name}.json", tmp_path)
    monkeypatch.setattr(write, "DOCUMENTS", tmp_path)
    write.write(name)
    monkeypatch.setattr("tests.golden.files.DOCUMENTS", tmp_path)
    again = golden(name)
    assert again["job"] == before["job"] and list(again) == list(before)
    assert differences(again, before) == []
