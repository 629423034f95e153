"""Programs that recipes are checked by, and a database for each."""

import shutil
import sys
from pathlib import Path

import pytest
from sqlalchemy import create_engine, make_url, text

RECIPES = Path(__file__).parents[3] / "deploy"


def require(*programs: str) -> None:
    """Skip the test where a program is missing; those of this environment's packages come first."""
    for program in programs:
        if shutil.which(program) is None:
            pytest.skip(f"{program} is missing")


@pytest.fixture(autouse=True)
def path(monkeypatch):
    """Programs of this environment and of administrators."""
    folder = Path(sys.executable).parent
    monkeypatch.setenv("PATH", f"{folder}:/usr/sbin:/usr/bin:/sbin:/bin", prepend=":")


@pytest.fixture
def database(postgres_url):
    """URL of an empty database."""
    engine = create_engine(postgres_url, isolation_level="AUTOCOMMIT")
    with engine.connect() as connection:
        connection.execute(text("CREATE DATABASE recipe"))
        yield make_url(postgres_url).set(database="recipe").render_as_string(hide_password=False)
        connection.execute(text("DROP DATABASE recipe WITH (FORCE)"))
    engine.dispose()
