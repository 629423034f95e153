"""Settings are described where an administrator looks for them."""

import re
from contextlib import closing
from pathlib import Path

import pytest
from wsrender_server.jobs.store import open_store
from wsrender_server.settings import PREFIX, Settings

from tests.server.jobs.documents import canonical

README = Path(__file__).parent.parent.parent / "server" / "README.md"


def test_the_readme_names_every_setting():
    """By its variable, or after another one by the end of it: `…_CERT_FILE`."""
    said = set(re.findall(r"`([A-Z_…]+)`", README.read_text()))
    ends = tuple(name.removeprefix("…") for name in said if name.startswith("…"))
    names = {PREFIX + name.upper() for name in Settings.model_fields}
    assert {name for name in names if name not in said and not name.endswith(ends)} == set()


DAY_S = 86_400.0


@pytest.mark.parametrize(
    ("settings", "requested", "expected"),
    [
        ({}, None, DAY_S),
        ({}, 60.0, 60.0),
        ({}, 9 * DAY_S, 9 * DAY_S),
        ({"job_timeout_s": 60}, None, 60.0),
        ({"max_job_timeout_s": 60}, None, 60.0),
        ({"max_job_timeout_s": 60}, 90.0, 60.0),
        ({"max_job_timeout_s": 60}, 30.0, 30.0),
        ({"job_timeout_s": None}, None, None),
        ({"job_timeout_s": None, "max_job_timeout_s": 60}, None, 60.0),
    ],
)
def test_every_job_has_a_timeout_unless_the_settings_say_otherwise(tmp_path, settings, requested, expected):
    with closing(open_store(Settings(data_dir=tmp_path, min_free_disk_bytes=0, **settings))) as store:
        assert store.submit("ann", canonical(), timeout_s=requested).job.timeout_s == expected
