"""Golden jobs of every analysis, each run once for all tests of a process."""

from functools import cache

import pytest

import wsrender as ws
from tests.golden.files import job_of
from wsrender.results.export.formats import asked
from wsrender.run import plan


@cache
def result_of(name):
    """The result of a golden job; not to be changed."""
    return ws.execute(job_of(name))


@cache
def plan_of(name):
    """The plan of a golden job."""
    return plan(job_of(name))


@pytest.fixture(scope="session")
def local():
    """The result of a golden job, by its name."""
    return result_of


@pytest.fixture(scope="session")
def planned():
    """The plan of a golden job, by its name."""
    return plan_of


@pytest.fixture(scope="session")
def saved(tmp_path_factory):
    """The folder of an analysis's golden result with all its pictures, in every format that is offered."""
    root = tmp_path_factory.mktemp("saved")

    @cache
    def folder(analysis):
        result = ws.execute(job_of(analysis))
        result.save(root / analysis, asked(own=True))
        return root / analysis

    return folder
