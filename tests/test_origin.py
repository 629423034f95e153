"""Where results come from: citation, date, command, and no host's name unless asked."""

import json
import platform
import re
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

import wsrender as ws
from wsrender.cli import main
from wsrender.origin import STYLES, citation

ROOT = Path(__file__).parent.parent
JOB = {"analysis": "indices_at", "robot": "scara", "configurations": [[0, 0, 0, 0]]}


def test_citations_are_of_this_version_and_released_as_the_changelog_says():
    released = re.search(rf"^## \[{re.escape(ws.__version__)}\] - (\S+)$", (ROOT / "CHANGELOG.md").read_text(), re.M)
    for style in STYLES:
        assert ws.__version__ in citation(style)
        assert released[1][:4] in citation(style)
    assert f"date-released: {released[1]}\n" in citation("cff")


def test_the_file_in_the_repository_is_what_the_command_prints(capsys):
    with pytest.raises(SystemExit) as ended:
        main(["cite", "--format", "cff"])
    assert ended.value.code == 0
    assert capsys.readouterr().out == (ROOT / "CITATION.cff").read_text()


def test_bibtex_has_balanced_entries():
    text = citation("bibtex")
    assert [*re.findall(r"^@(\w+)\{(\w+),$", text, re.M)] == [("software", "wsrender"), ("article", "wsr2019")]
    assert text.count("{") == text.count("}")


def test_a_result_has_date_and_citation_and_no_name_of_the_host(monkeypatch):
    origin = ws.execute(JOB).document["provenance"]
    assert timedelta(0) <= datetime.now(UTC) - datetime.fromisoformat(origin["run"]["date"]) < timedelta(minutes=1)
    assert origin["citation"] == citation()
    assert "name" not in origin["host"] and "command" not in origin["run"]
    monkeypatch.setenv("WSRENDER_SAY_HOST", "1")
    assert ws.execute(JOB).document["provenance"]["host"]["name"] == platform.node()


def test_the_command_is_what_was_typed_and_no_other_file_holds_it(tmp_path):
    arguments = ["run", "scara", "--samples", "100", "--voxel-size", "0.1", "-o"]
    with pytest.raises(SystemExit):
        main([*arguments, str(tmp_path / "a b")])
    document = json.loads((tmp_path / "a b" / "result.json").read_text())
    assert document["provenance"]["run"]["command"] == f"wsrender {' '.join(arguments)} '{tmp_path}/a b'"
    with pytest.raises(SystemExit):
        main([*arguments, str(tmp_path / "b")])
    again = json.loads((tmp_path / "b" / "result.json").read_text())
    assert again["provenance"]["run"] != document["provenance"]["run"]
    assert again["artifacts"] == document["artifacts"]  # by their SHA-256
    assert "command" not in ws.execute(JOB).document["provenance"]["run"]
