"""The migrations give exactly the tables that the code uses, on both databases."""

import json
import time
import zipfile
from contextlib import closing
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
import wsrender_server.migrations
from alembic import command
from alembic.autogenerate import compare_metadata
from alembic.config import Config
from alembic.migration import MigrationContext
from sqlalchemy import text
from wsrender_server.jobs.database import open_database
from wsrender_server.jobs.files import FOLDERS
from wsrender_server.jobs.retention import Retention
from wsrender_server.jobs.store import open_store
from wsrender_server.jobs.tables import Row
from wsrender_server.migrations import upgrade
from wsrender_server.settings import Settings

from wsrender.errors import InputError


def test_migrated_tables_equal_the_declared_ones(database):
    with database.connect() as connection:
        context = MigrationContext.configure(connection, opts={"compare_type": True})
        assert compare_metadata(context, Row.metadata) == []


def test_computations_of_the_first_version_are_its_own(tmp_path):
    engine, config = open_database(f"sqlite:///{tmp_path / 'jobs.db'}"), Config()
    config.set_main_option("script_location", str(Path(wsrender_server.migrations.__file__).parent))
    with engine.execution_options(writes=True).begin() as connection:
        config.attributes["connection"] = connection
        command.upgrade(config, "0001")
        connection.execute(text("INSERT INTO computations VALUES ('a','k','ann','succeeded','{}',0,1,0,NULL,NULL)"))
    upgrade(engine)
    with engine.connect() as connection:
        assert list(connection.execute(text("SELECT id, version FROM computations"))) == [("a", "0.1.0")]
    engine.dispose()


@pytest.mark.parametrize("check_only", [False, True])
@pytest.mark.parametrize(
    ("statements", "said"),
    [
        (["UPDATE alembic_version SET version_num = '9999'"], "is of a newer version of wsrender: its tables are 9999"),
        (["DELETE FROM alembic_version"], "has tables .*jobs.* says of no version"),
        (["DROP TABLE alembic_version"], "the table alembic_version is missing"),
        (["INSERT INTO alembic_version VALUES ('0001')"], "is of several versions, .*0001"),
    ],
)
def test_a_database_of_no_known_version_is_said_as_it_is_and_left_alone(database, statements, said, check_only):
    with database.execution_options(writes=True).begin() as connection:
        for statement in statements:
            connection.execute(text(statement))
    for _ in range(2):
        with pytest.raises(InputError, match=said) as refused:
            upgrade(database, check_only=check_only)
        assert refused.value.field == "database" and "restore a backup" in str(refused.value)


@pytest.mark.parametrize("kind", ["sqlite", "postgresql"])
def test_a_store_of_the_version_before_is_taken_over_whole(tmp_path, request, kind):
    """Its rows as that version wrote them, and its files (``stores/0002.zip``): results, and jobs in every state."""
    data = tmp_path / "data"
    with zipfile.ZipFile(Path(__file__).parent / "stores/0002.zip") as archive:
        archive.extractall(data)
    for folder in FOLDERS:
        (data / folder).mkdir(exist_ok=True)
    rows = json.loads((data / "rows.json").read_text())
    if kind == "sqlite":
        settings = Settings(data_dir=data)
        engine = open_database(settings.database_url)
    else:
        settings = Settings(data_dir=data, database=request.getfixturevalue("postgres_url"))
        engine = open_database(settings.database_url)
        Row.metadata.drop_all(engine)
    config = Config()
    config.set_main_option("script_location", str(Path(wsrender_server.migrations.__file__).parent))
    with engine.execution_options(writes=True).begin() as connection:
        connection.execute(text("DROP TABLE IF EXISTS alembic_version"))
        config.attributes["connection"] = connection
        command.upgrade(config, "0002")
        for table, of_table in rows.items():
            for row in of_table:
                names = ", ".join(row)
                values = ", ".join(f":{name}" for name in row)
                connection.execute(text(f"INSERT INTO {table} ({names}) VALUES ({values})"), row)
    upgrade(engine)
    engine.dispose()

    with closing(open_store(settings)) as store, store.claimed():
        retention = Retention(store, Settings(data_dir=data, keep_results_s=3600))
        assert not retention.due()  # nothing is old at the upgrade
        jobs = {row["id"]: row for row in rows["jobs"]}
        assert {job: store.get(row["owner"], job).state for job, row in jobs.items()} == {
            job: row["state"] for job, row in jobs.items()
        }
        size = 0
        done = [job for job, row in jobs.items() if row["state"] == "succeeded"]
        for job in done:
            owner = jobs[job]["owner"]
            assert store.result_document(owner, job)["analysis"] == "workspace"
            records = store.artifacts(owner, job)
            assert records and all(store.artifact_path(owner, job, record.name) for record in records)
            size = sum(record.bytes for record in records)
        assert len(done) == 2 and store.usage() == {"results": size, "models": 9}
        assert store.list_models("ann") and store.list_keys() and store.news("ann", done[0], 0)[1][0].id == 1
        expired = retention.sweep(datetime.now(UTC) + timedelta(hours=2))
        assert [each.bytes for each in expired if each.what == "result"] == [size]
        assert {store.get("ann", job).state for job in done} == {"expired"}
        unfinished = [job for job, row in jobs.items() if row["state"] in ("queued", "running")]
        store.recover()
        assert len(unfinished) == 2 and len(store.unfinished()) == 2
        began = time.monotonic()
        for computation, (_, attempt) in store.unfinished().items():
            assert store.begin(computation, attempt)
        assert store.time_out(began) == [] and set(store.time_out(began + 3601)) == set(unfinished)
        (failed,) = [job for job, row in jobs.items() if row["state"] == "failed"]
        assert store.retry("bob", failed).state == "queued"
        assert store.retry("ann", done[0]).state == "queued"
