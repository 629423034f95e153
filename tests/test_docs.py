"""What the pages of the docs show works as it is written."""

import pytest

from tests.snippets import CLONE, blocks, run

PAGES = [page for page in sorted(CLONE.glob("docs/*/*.md")) if page.stem != "ten_minutes"]  # which test_ten_minutes has


def with_blocks(language):
    pages = [page for page in PAGES if blocks(page.read_text(encoding="utf-8"), language)]
    return pytest.mark.parametrize("page", pages, ids=lambda page: page.stem)


@with_blocks("python")
def test_snippets(page, tmp_path, monkeypatch):
    run(page, tmp_path, monkeypatch)


@with_blocks("python")
def test_snippets_are_small(page):
    """A snippet is read at a glance."""
    for snippet in blocks(page.read_text(encoding="utf-8"), "python"):
        assert snippet.count("\n") <= 25
