"""``figure.show()`` from a script."""

import time
from pathlib import Path

import pytest

from wsrender.results.drawing import shown_figure
from wsrender.results.drawing.style import new_figure


@pytest.fixture
def figure():
    figure = new_figure(2, 1)
    figure.add_subplot()
    return figure


@pytest.fixture
def nowhere(monkeypatch):
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(shown_figure.sys, "platform", "linux")
    return monkeypatch


def test_without_a_display_it_says_what_to_do(figure, nowhere):
    with pytest.warns(UserWarning, match=r'no display or viewer .* figure\.savefig\("picture\.png"\)') as said:
        figure.show()
    assert said[0].filename == __file__
    figure.show(warn=False)


def test_the_systems_viewer_opens_the_picture(figure, nowhere, tmp_path):
    viewer, opened = tmp_path / "xdg-open", tmp_path / "opened"
    viewer.write_text(f'#!/bin/sh\ncp "$1" {opened}.part && mv {opened}.part {opened}\n')
    viewer.chmod(0o755)
    nowhere.setenv("PATH", str(tmp_path), prepend=":")
    nowhere.setenv("DISPLAY", ":0")
    nowhere.setattr(shown_figure.tempfile, "mkdtemp", lambda prefix: str(tmp_path))
    figure.show()
    ends = time.monotonic() + 20
    while not opened.exists() and time.monotonic() < ends:
        time.sleep(0.02)
    assert Path(opened).read_bytes() == figure._repr_png_() and figure._repr_png_().startswith(b"\x89PNG")
