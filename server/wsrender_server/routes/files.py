"""Files as responses: strong entity tags, conditional requests, one byte range."""

import re
from pathlib import Path
from urllib.parse import quote

from fastapi import Request
from starlette.responses import FileResponse, Response

from wsrender_server.problems import HttpProblem

_RANGE = re.compile(r"bytes=(?:(\d+)-(\d*)|-(\d+))")


def file_response(request: Request, path: Path, sha256: str, media_type: str, name: str) -> Response:
    """The file, the range asked for (206), or 304 where the client has it; raises HttpProblem 416.

    The entity tag is the SHA-256. Several ranges at once are answered with the whole file, as RFC 9110 allows.
    """
    etag = f'"{sha256}"'
    headers = {
        "ETag": etag,
        "Cache-Control": "private, no-cache",
        "Content-Disposition": f"attachment; filename*=utf-8''{quote(Path(name).name)}",
    }
    if has_it(request, etag):
        return Response(status_code=304, headers={name: headers[name] for name in ("ETag", "Cache-Control")})
    _check_range(request, path.stat().st_size, etag)
    return FileResponse(path, media_type=media_type, headers=headers)


def has_it(request: Request, etag: str) -> bool:
    """Whether If-None-Match says that the client has the entity."""
    tags = [tag.strip().removeprefix("W/") for tag in request.headers.get("if-none-match", "").split(",")]
    return etag in tags or "*" in tags


def _check_range(request: Request, size: int, etag: str) -> None:
    """Drop a Range header that need not be answered; raise HttpProblem 416 for one beyond the file."""
    asked = request.headers.get("range")
    if asked is None:
        return
    match = _RANGE.fullmatch(asked.strip().replace(" ", ""))
    applies = match and len(match[0]) < 64 and request.headers.get("if-range", etag) == etag
    if match and applies:
        first, last, suffix = match.groups()
        start = int(first) if first else max(size - int(suffix), 0) if int(suffix) else size
        if start < size and not (last and int(last) < start):
            return
        if not last or int(last) >= start:
            raise HttpProblem(416, f"the file has {size} bytes", headers={"Content-Range": f"bytes */{size}"})
    request.scope["headers"] = [(name, value) for name, value in request.scope["headers"] if name != b"range"]
