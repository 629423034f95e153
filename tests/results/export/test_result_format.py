"""Result folders of this and of earlier versions: one form is read, whatever version wrote it."""

import json

import pytest

import wsrender as ws
from wsrender.errors import InputError
from wsrender.results.result import Result

JOB = {"analysis": "indices_at", "robot": "scara", "configurations": [[0.1, 1.2, 0.3, 0.0]], "device": "cpu"}


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """A saved result: the folder and its document."""
    folder = tmp_path_factory.mktemp("written") / "out"
    result = ws.execute(JOB)
    assert next(iter(result.document)) == "format"  # before it is saved, too
    result.save(folder)
    return folder, json.loads((folder / "result.json").read_text())


def rewritten(written, tmp_path, change):
    """A copy of the saved result whose document is changed; its folder."""
    folder, document = written
    for record in document["artifacts"]:
        target = tmp_path / record["name"]
        target.parent.mkdir(exist_ok=True)
        target.write_bytes((folder / record["name"]).read_bytes())
    document = json.loads(json.dumps(document))
    change(document)
    (tmp_path / "result.json").write_text(json.dumps(document))
    return tmp_path


def of_version(version):
    """A change into what a version wrote: no format; 0.1 wrote no headline and no warnings either."""

    def change(document):
        del document["format"], document["job"]["format"]
        document["provenance"]["wsrender"] = version
        if version.startswith("0.1"):
            del document["headline"], document["warnings"]

    return change


def test_documents_begin_with_their_format(written):
    _, document = written
    assert next(iter(document.items())) == next(iter(document["job"].items())) == ("format", 2)


def test_a_result_of_0_2_is_read_as_it_is(written, tmp_path):
    document = Result.load(rewritten(written, tmp_path, of_version("0.2.0"))).document
    expected = json.loads(json.dumps(written[1]))
    expected["provenance"]["wsrender"] = "0.2.0"
    del expected["job"]["format"]
    assert document == expected


def test_a_result_of_0_1_gets_what_every_result_has(written, tmp_path):
    result = Result.load(rewritten(written, tmp_path, of_version("0.1.0")))
    headline = result.document["headline"]
    assert (headline["value"], headline["ci95"]) == (None, None)
    assert headline["reason"] == "results of wsrender 0.1.0 have no headline"
    assert (result.document["format"], result.document["warnings"]) == (2, [])
    assert len(result.map) == 1 and "configurations: 1" in result.summary()
    result.save(tmp_path / "again")
    assert Result.load(tmp_path / "again").document["headline"] == headline


@pytest.mark.parametrize("found", [1, 3, "2", None, True])
def test_another_format_is_refused(written, tmp_path, found):
    folder = rewritten(written, tmp_path, lambda document: document.update(format=found))
    with pytest.raises(InputError) as caught:
        Result.load(folder)
    assert caught.value.field == "format"
    allowed = f"must be 2 or missing, as in results of wsrender 0.1 and 0.2, not {json.dumps(found)}"
    assert caught.value.message.startswith(allowed)
    assert caught.value.message.endswith("a newer wsrender has written it") == (found == 3)


def test_a_result_without_format_of_a_version_that_writes_one_is_refused(written, tmp_path):
    with pytest.raises(InputError, match=r'^format: is missing, and provenance\.wsrender is "0\.3\.0"'):
        Result.load(rewritten(written, tmp_path, of_version("0.3.0")))


def test_a_result_made_by_hand_is_saved_and_read(tmp_path):
    Result({"analysis": "workspace"}).save(tmp_path / "out")
    assert Result.load(tmp_path / "out").document == {"format": 2, "analysis": "workspace", "artifacts": []}
