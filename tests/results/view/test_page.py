"""A view within another page: how much it adds, and what is left out."""

import base64
import random
import re
import zlib

import pytest

import wsrender as ws
from wsrender.results.view import page, robot_view, view_of


@pytest.fixture(scope="module")
def result():
    return ws.analyze("ur5e", ws.Sobol(1 << 16), indices="all", voxel_size_m=0.06, refined_volume=None, device="cpu")


def held(text, part):
    (found,) = re.findall(rf'data-part="{part}">([^<]*)<', text)
    return zlib.decompress(base64.b64decode(found))


def test_a_page_holds_the_module_and_the_view():
    view = robot_view("ur5e")
    text = page.embedded(view)
    assert held(text, "module") == page.built("viewer.js")
    assert held(text, "view") == view.to_file_bytes(1 << 30)


@pytest.mark.parametrize("more", [200_000, 1_000_000])
def test_what_does_not_fit_is_left_out_and_named(result, monkeypatch, more):
    view, module = view_of(result), len(page._part("module", page.built("viewer.js")))
    monkeypatch.setattr(page, "MOST_EMBEDDED", module + more)
    text = page.embedded(view)
    assert module + more / 2 < len(text) <= module + more
    assert b"does not fit in the file" in held(text, "view")


def test_long_lines_of_a_manifest_count(result, monkeypatch):
    view, module = view_of(result), len(page._part("module", page.built("viewer.js")))
    view.manifest["warnings"] = ["".join(random.Random(1).choices("0123456789abcdef", k=400_000))]
    monkeypatch.setattr(page, "MOST_EMBEDDED", module + 600_000)
    assert len(page.embedded(view)) <= module + 600_000


def test_a_view_of_nothing_is_not_shown(result):
    assert page.shows_something(robot_view("scara"))
    empty = view_of(result)
    assert page.shows_something(empty)
    for part in page._DRAWN:
        empty.manifest[part] = []
    assert not page.shows_something(empty)
