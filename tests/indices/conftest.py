import pytest

from wsrender.indices.index_catalogue import _ADDED


@pytest.fixture
def catalogue_as_shipped():
    """Whatever a test registers is forgotten after it."""
    before = dict(_ADDED)
    _ADDED.clear()
    yield
    _ADDED.clear()
    _ADDED.update(before)
