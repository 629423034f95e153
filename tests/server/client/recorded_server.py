"""A server made of answers: what it is asked is recorded, what it says is written down beforehand."""

import hashlib
from pathlib import Path

import httpx2

import wsrender as ws


class Lost(httpx2.SyncByteStream, httpx2.AsyncByteStream):
    """A body that ends with a lost connection."""

    def __init__(self, sent: bytes):
        self.sent = sent

    def __iter__(self):
        yield self.sent
        raise httpx2.ReadError("connection reset by peer")

    async def __aiter__(self):
        for piece in self:
            yield piece


class RecordedServer(httpx2.BaseTransport, httpx2.AsyncBaseTransport):
    """Answers by (method, path), one after another, the last one for ever; exceptions are raised."""

    def __init__(self):
        self.requests = []
        self._answers = {("GET", "/v1/version"): [says({"wsrender": ws.__version__})]}

    def answer(self, method, path, *answers):
        self._answers[method, path] = list(answers)

    def handle_request(self, request):
        request.read()
        self.requests.append(request)
        answers = self._answers[request.method, request.url.path]
        answer = answers.pop(0) if len(answers) > 1 else answers[0]
        if callable(answer):
            answer = answer(request)
        if isinstance(answer, BaseException):
            raise answer
        # A Response can be sent only once, and one made of bytes has been read already.
        status, headers, body = answer
        stream = httpx2.ByteStream(body) if isinstance(body, bytes) else body
        return httpx2.Response(status, headers=headers, stream=stream)

    async def handle_async_request(self, request):
        return self.handle_request(request)

    def sent(self, method, path):
        return [r for r in self.requests if (r.method, r.url.path) == (method, path)]


def says(body, status=200, **headers):
    """A JSON answer."""
    content = httpx2.Response(200, json=body).read()
    names = {name.replace("_", "-"): value for name, value in headers.items()}
    return status, {"Content-Type": "application/json", **names}, content


def refuses(status, code, **members):
    """A problem document."""
    headers = members.pop("headers", {})
    code, named, body = says({"title": "refused", "status": status, "code": code, **members}, status)
    return code, {**named, "Content-Type": "application/problem+json", **headers}, body


def serves(path: Path, breaks=()):
    """A file with Range and ETag; the n-th answer breaks off after breaks[n] bytes."""
    broken = list(breaks)
    content = path.read_bytes()

    def answer(request):
        etag = f'"{hashlib.sha256(content).hexdigest()}"'
        first = 0
        if "Range" in request.headers and request.headers.get("If-Range") == etag:
            first = int(request.headers["Range"].removeprefix("bytes=").removesuffix("-"))
        status = 206 if first else 200
        if broken:
            return status, {"ETag": etag}, Lost(content[first:][: broken.pop(0)])
        return status, {"ETag": etag}, content[first:]

    return answer
