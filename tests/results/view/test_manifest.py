"""What a view is made of has one description in Python and one in TypeScript, which say the same."""

import re
from pathlib import Path
from typing import get_type_hints

import pytest
from pydantic import ValidationError

from wsrender.results.view import manifest, robot_view

CONTRACT = Path(__file__).parents[3] / "server/web/src/contract.ts"


def interfaces():
    """Fields of each interface of the contract, inner objects left out; those that may be absent end in "?"."""
    text = re.sub(r"/\*.*?\*/|//[^\n]*", "", CONTRACT.read_text(encoding="utf-8"), flags=re.DOTALL)
    found = {}
    for match in re.finditer(r"export interface (\w+) \{", text):
        depth, at = 1, match.end()
        while depth:
            depth += {"{": 1, "}": -1}.get(text[at], 0)
            at += 1
        body = text[match.end() : at - 1]
        while "{" in (flat := re.sub(r"\{[^{}]*\}", "object", body)) or flat != body:
            body = flat
        found[match[1]] = set(re.findall(r"(?:^|[;\n])\s*(\w+\??)\s*:", body))
    return found


VIEW = ["ViewChain", "ViewRobot", "ViewLink", "ViewMesh", "ViewPoints", "ViewCurves"]
OTHERS = ["Data", "Skeleton", "Channel", "Volume", "Glyphs", "FloorMap", "Plot", "Mapping", "Manifest"]


@pytest.mark.parametrize("name", [*VIEW, *OTHERS])
def test_both_descriptions_have_the_same_fields(name):
    kind = getattr(manifest, name)
    own = {field + "?" * (field in kind.__optional_keys__) for field in get_type_hints(kind)}
    assert own == interfaces()[name.removeprefix("View")]


def test_a_manifest_that_is_none():
    shown = robot_view("spherical").manifest
    for change in ({"more": 1}, {"format": 2}, {"volumes": [{}]}, {"title": None}):
        with pytest.raises(ValidationError):
            manifest.MANIFEST.validate_python(shown | change)
