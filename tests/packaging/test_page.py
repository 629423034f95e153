"""The viewer's page as it is delivered."""

import gzip
import json
import re
from pathlib import Path

import pytest

from wsrender.results.view.page import built

WEB = Path(__file__).parents[2] / "server" / "web"


def test_the_page_is_small():
    module = built("viewer.js")
    assert len(module) <= 1_200_000
    assert len(gzip.compress(module)) <= 350_000


def test_the_page_loads_nothing_from_elsewhere():
    for name in ("index.html", "served.js"):
        assert not re.search(rb"(src|href|from)\s*=?\s*[\"'](https?:)?//", built(name))
    assert not re.search(rb"import\s*\(?\s*[\"']", built("viewer.js"))


def test_licences_of_what_is_in_the_page_are_beside_it():
    text = built("licences.txt").decode()
    for name, version in json.loads((WEB / "package.json").read_text())["dependencies"].items():
        assert f"== {name} {version}\n" in text


@pytest.mark.parametrize("word", ["resolved", "http://", "registry"])
def test_the_lock_names_no_host(word):
    lock = json.loads((WEB / "package-lock.json").read_text())
    entries = {name: {k: v for k, v in entry.items() if k != "funding"} for name, entry in lock["packages"].items()}
    assert word not in json.dumps(entries)
