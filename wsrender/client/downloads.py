"""Files of a job, downloaded with resume and verified."""

import hashlib
import re
from pathlib import Path

import httpx2

from wsrender.client.connection import Connection, worth_repeating
from wsrender.errors import ServerError

ATTEMPTS = 2  # at a file that was damaged on its way
_SHA256 = re.compile(r'"([0-9a-f]{64})"')


def download(
    connection: Connection, path: str, target: Path, sha256: str | None = None, format: str | None = None
) -> Path:
    """Download ``path`` of the server to the file ``target``, which appears complete or not at all.

    A lost connection goes on where it was. ``sha256`` is what the file must have; without it, what the server's
    ETag says. ``format`` asks for a conversion. Raises ServerError where the contents are not what they should be,
    ServerConnectionError, NotFoundError.
    """
    target.parent.mkdir(parents=True, exist_ok=True)
    partial = target.with_name(f"{target.name}.part")
    partial.unlink(missing_ok=True)
    try:
        for _ in range(ATTEMPTS):
            announced = _fetch(connection, path, partial, format)
            if (sha256 or announced) in (None, _sha256(partial)):
                return partial.replace(target)
            partial.unlink()
    finally:
        partial.unlink(missing_ok=True)
    raise ServerError(f"{path}: what arrived has another SHA-256 than the server says, in {ATTEMPTS} attempts")


def _fetch(connection: Connection, path: str, partial: Path, format: str | None) -> str | None:
    """Append to ``partial`` until it is complete; the SHA-256 that the server says it has, if it does."""
    pauses = connection.pauses()
    etag = ""
    while True:
        have = partial.stat().st_size if partial.exists() else 0
        headers = {"Accept-Encoding": "identity"}
        if have and etag:
            headers |= {"Range": f"bytes={have}-", "If-Range": etag}
        try:
            with connection.stream(path, headers=headers, params={"format": format} if format else {}) as response:
                if worth_repeating(response) and pauses.after_refusal(response):
                    continue
                if response.status_code == 416:  # nothing was missing but the end of the answer
                    break
                connection.checked(response)
                etag = response.headers.get("ETag", "")
                _write(response, partial)
            break
        except httpx2.TransportError as error:
            if partial.exists() and partial.stat().st_size > have:
                pauses.again()
            pauses.after(error)
    found = _SHA256.fullmatch(etag)
    return found[1] if found else None


def _write(response: httpx2.Response, partial: Path) -> None:
    with partial.open("ab" if response.status_code == 206 else "wb") as file:
        for chunk in response.iter_raw():
            file.write(chunk)


def _sha256(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
