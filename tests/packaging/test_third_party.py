"""Every work of others that travels in the package is named with its licence."""

import json
import re
from pathlib import Path

CLONE = Path(__file__).parents[2]
TOLD = (CLONE / "THIRD_PARTY.md").read_text()
TEXTS = (CLONE / "server" / "wsrender_server" / "static" / "viewer" / "licences.txt").read_text()
OWN = (".xml", ".md", ".toml")  # in folders of robots, whose shapes are primitives


def test_each_package_in_the_page_is_named_with_its_licence():
    packages = dict(re.findall(r"^== (\S+) (\S+)$", TEXTS, re.MULTILINE))
    wanted = json.loads((CLONE / "server" / "web" / "package.json").read_text())["dependencies"]
    assert wanted.items() <= packages.items()
    rows = [line for line in TOLD.splitlines() if line.startswith("|")]
    for package in packages:
        row = next(line for line in rows if package in line)
        version = wanted.get(package)
        assert version is None or f"{package} {version}" in row
        text = TEXTS.partition(f"== {package} ")[2].partition("\n== ")[0]
        assert ("MIT" in row) == ("Permission is hereby granted, free of charge" in text)


def test_each_file_of_others_beside_a_robot_has_a_row():
    others = [path for path in (CLONE / "mjcf").rglob("*") if path.is_file() and path.suffix not in OWN]
    folders = {path.relative_to(CLONE / "mjcf").parts[0] for path in others}
    assert {folder for folder in folders if f"`mjcf/{folder}/`" not in TOLD} == set()


def test_the_wheel_brings_the_file():
    assert 'license-files = ["LICENSE", "THIRD_PARTY.md"]' in (CLONE / "pyproject.toml").read_text()
