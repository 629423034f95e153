"""Files and what was made in memory as responses: strong entity tags, conditional requests, one byte range."""

import hashlib
import os
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import BinaryIO
from urllib.parse import quote

from fastapi import Request
from starlette.responses import Response, StreamingResponse
from starlette.types import Receive, Scope, Send

from wsrender_server.problems import HttpProblem

PIECE_BYTES = 1 << 18
LONGEST_NUMBER = 18  # digits, of a place in a file
_RANGE = re.compile(r"bytes=(?:(\d+)-(\d*)|-(\d+))", re.IGNORECASE)
_RANGES = re.compile(r"bytes=(?:\d+-\d*|-\d+)(?:,(?:\d+-\d*|-\d+))+", re.IGNORECASE)
_OTHER_UNIT = re.compile(r"(?!bytes=)[!#$%&'*+.^_`|~0-9A-Za-z-]+=.+", re.IGNORECASE)


def file_response(request: Request, path: Path, sha256: str, media_type: str, name: str = "") -> Response:
    """The file, the range asked for (206), or 304 where the client has it.

    With a ``name`` it is a download. The file is open when this returns: it arrives whole even if it is deleted
    meanwhile. The entity tag is the SHA-256.
    Several ranges at once are answered with the whole file, as RFC 9110 allows. Raises HttpProblem 416 for a range
    beyond the file and one that is none, FileNotFoundError.
    """
    etag = f'"{sha256}"'
    headers = _headers(etag)
    if name:
        headers["Content-Disposition"] = f"attachment; filename*=utf-8''{quote(Path(name).name)}"
    if has_it(request, etag):
        return _not_modified(headers)
    file = path.open("rb")
    size = os.fstat(file.fileno()).st_size
    try:
        part = _range(request, size, etag)
    except HttpProblem:
        file.close()
        raise
    if part is not None:
        headers["Content-Range"] = f"bytes {part.start}-{part.stop - 1}/{size}"
    part = range(size) if part is None else part
    headers["Content-Length"] = str(len(part))
    status = 206 if "Content-Range" in headers else 200
    return _OpenFile(file, range(0) if request.method == "HEAD" else part, status, headers, media_type)


def content_response(
    request: Request, content: bytes, media_type: str, more: Mapping[str, str] | None = None
) -> Response:
    """What was made in memory, with ``more`` headers, as `file_response` answers with a file.

    Equal requests are answered with equal bytes, so that a download goes on. Raises HttpProblem 416.
    """
    etag = f'"{hashlib.sha256(content).hexdigest()}"'
    headers = {**_headers(etag), **(more or {})}
    if has_it(request, etag):
        return _not_modified(headers)
    part = _range(request, len(content), etag)
    if part is None:
        return Response(content, 200, headers, media_type)
    headers["Content-Range"] = f"bytes {part.start}-{part.stop - 1}/{len(content)}"
    return Response(content[part.start : part.stop], 206, headers, media_type)


def _headers(etag: str) -> dict[str, str]:
    return {"ETag": etag, "Cache-Control": "private, no-cache", "Accept-Ranges": "bytes"}


def _not_modified(headers: Mapping[str, str]) -> Response:
    kept = ("ETag", "Cache-Control", "Vary")
    return Response(status_code=304, headers={name: headers[name] for name in kept if name in headers})


def has_it(request: Request, etag: str) -> bool:
    """Whether If-None-Match says that the client has the entity."""
    tags = [tag.strip().removeprefix("W/") for tag in request.headers.get("if-none-match", "").split(",")]
    return etag in tags or "*" in tags


class _OpenFile(StreamingResponse):
    """A part of an open file, closed at the end."""

    def __init__(self, file: BinaryIO, part: range, status: int, headers: dict[str, str], media_type: str):
        super().__init__(_pieces(file, part), status, headers, media_type)
        self._file = file

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        with self._file:
            await super().__call__(scope, receive, send)


def _pieces(file: BinaryIO, part: range) -> Iterator[bytes]:
    file.seek(part.start)
    left = len(part)
    while left and (piece := file.read(min(PIECE_BYTES, left))):
        left -= len(piece)
        yield piece


def _range(request: Request, size: int, etag: str) -> range | None:
    """The bytes that a Range header asks for; None: all, of several ranges and units that nobody knows too.

    Raises HttpProblem 416 where the file ends before them, and for bytes that are no range (RFC 9110, 14.2).
    """
    asked = request.headers.get("range", "").strip().replace(" ", "")
    if not asked or request.headers.get("if-range", etag) != etag or _RANGES.fullmatch(asked):
        return None
    if _OTHER_UNIT.fullmatch(asked):
        return None
    match = _RANGE.fullmatch(asked)
    first, last, suffix = (_place(number) for number in match.groups()) if match else (None, None, None)
    if match is None or (last is not None and first is not None and last < first):
        raise _wrong_range(f"must read like bytes=0-99, bytes=100- or bytes=-100, not {asked[:64]!r}", size)
    start = max(size - suffix, 0) if suffix else size if first is None else first
    if start >= size:
        raise _wrong_range(f"{asked[:64]} begins where nothing is left: there are {size} bytes", size)
    return range(start, size if last is None else min(last + 1, size))


def _place(number: str | None) -> int | None:
    """A number of a range; one of very many digits is beyond any file."""
    digits = (number or "").lstrip("0")
    return None if not number else int(digits or 0) if len(digits) <= LONGEST_NUMBER else 10**LONGEST_NUMBER


def _wrong_range(detail: str, size: int) -> HttpProblem:
    headers = {"Content-Range": f"bytes */{size}"}
    return HttpProblem(416, f"Range: {detail}", errors=[("Range", detail)], headers=headers)
