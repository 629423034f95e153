"""Cursors of lists: where a page ended, as text that says nothing to its reader."""

import base64
import binascii
from datetime import UTC, datetime

from wsrender.errors import InputError
from wsrender_server.jobs.records import JobRecord


def cursor_after(record: JobRecord) -> str:
    """The cursor of the page that follows a job."""
    text = f"{round(record.created_at.timestamp() * 1e6)}.{record.id}"
    return base64.urlsafe_b64encode(text.encode()).decode().rstrip("=")


def place_of(cursor: str) -> tuple[datetime, str]:
    """Time and id of the job before a cursor; InputError for a text that is no cursor."""
    try:
        text = base64.urlsafe_b64decode(cursor + "=" * (-len(cursor) % 4)).decode("ascii")
        time, job_id = text.split(".")
        return datetime.fromtimestamp(int(time) / 1e6, UTC), job_id
    except (binascii.Error, ValueError, OverflowError, OSError) as error:
        raise InputError("cursor", "is not one that a list of jobs has given") from error
