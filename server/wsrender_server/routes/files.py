"""Files as responses: strong entity tags, conditional requests, one byte range."""

import os
import re
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO
from urllib.parse import quote

from fastapi import Request
from starlette.responses import Response, StreamingResponse
from starlette.types import Receive, Scope, Send

from wsrender_server.problems import HttpProblem

PIECE_BYTES = 1 << 18
_RANGE = re.compile(r"bytes=(?:(\d+)-(\d*)|-(\d+))")


def file_response(request: Request, path: Path, sha256: str, media_type: str, name: str = "") -> Response:
    """The file, the range asked for (206), or 304 where the client has it.

    With a ``name`` it is a download. The file is open when this returns: it arrives whole even if it is deleted
    meanwhile. The entity tag is the SHA-256.
    Several ranges at once are answered with the whole file, as RFC 9110 allows. Raises HttpProblem 416 for a range
    beyond the file, FileNotFoundError.
    """
    etag = f'"{sha256}"'
    headers = {
        "ETag": etag,
        "Cache-Control": "private, no-cache",
        "Accept-Ranges": "bytes",
    }
    if name:
        headers["Content-Disposition"] = f"attachment; filename*=utf-8''{quote(Path(name).name)}"
    if has_it(request, etag):
        return Response(status_code=304, headers={name: headers[name] for name in ("ETag", "Cache-Control")})
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
    """The bytes that a Range header asks for; None: all. Raises HttpProblem 416 where the file ends before them."""
    asked = request.headers.get("range", "")
    match = _RANGE.fullmatch(asked.strip().replace(" ", ""))
    if not match or len(match[0]) >= 64 or request.headers.get("if-range", etag) != etag:
        return None
    first, last, suffix = match.groups()
    if last and int(last) < int(first):
        return None
    start = int(first) if first else max(size - int(suffix), 0) if int(suffix) else size
    if start >= size:
        raise HttpProblem(416, f"the file has {size} bytes", headers={"Content-Range": f"bytes */{size}"})
    return range(start, min(int(last) + 1, size) if last else size)
