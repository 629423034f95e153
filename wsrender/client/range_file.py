"""A file on a server of which only what is read is downloaded."""

import io
from collections import OrderedDict

import httpx2

from wsrender.client.connection import Connection
from wsrender.client.requests import Request, asked
from wsrender.errors import ServerError

BLOCK_BYTES = 1 << 16
KEPT_BLOCKS = 512  # of the newest; a reader that comes back finds them


class RangeFile(io.RawIOBase):
    """Reads ``path`` by ranges, whole blocks at a time, of which the newest are kept.

    ``etag`` is what the file must still be. ``bytes_read`` counts what was downloaded. Reading raises nothing, for HDF5
    passes no exception on: once it has failed, it gives zeros for ever, which are nobody's data. So whoever reads asks
    `check` afterwards.
    """

    def __init__(self, connection: Connection, path: str, etag: str, size: int):
        self._connection, self._path, self._etag, self._size = connection, path, etag, size
        self._blocks: OrderedDict[int, bytes] = OrderedDict()
        self._at = 0
        self.bytes_read = 0
        self._error: BaseException | None = None

    def check(self) -> None:
        """Raise why reading failed, if it did.

        ServerError where the file is another one by now or the server gives no ranges, ServerConnectionError,
        NotFoundError.
        """
        error = self._error
        if error is not None:
            if not isinstance(error, Exception):  # Ctrl-C is said once
                self._error = ServerError(f"{self._path}: reading was interrupted; open it again")
            raise error from None

    def readable(self) -> bool:
        """It is."""
        return True

    def seekable(self) -> bool:
        """It is."""
        return True

    def tell(self) -> int:
        """Where the next byte is read."""
        return self._at

    def seek(self, offset: int, whence: int = io.SEEK_SET) -> int:
        """Go there, as `io.IOBase.seek`."""
        self._at = offset + {io.SEEK_SET: 0, io.SEEK_CUR: self._at, io.SEEK_END: self._size}[whence]
        return self._at

    def readinto(self, buffer: "memoryview | bytearray") -> int:  # type: ignore[override]
        """Fill the buffer as far as there is something; the number of bytes."""
        view = memoryview(buffer).cast("B")
        wanted = min(len(view), max(self._size - self._at, 0))
        content = bytes(wanted)
        if wanted and self._error is None:
            try:
                content = self._bytes(self._at, self._at + wanted)
            except BaseException as error:  # Ctrl-C, too, must not pass through HDF5
                self._error = error
        view[:wanted] = content
        self._at += wanted
        return wanted

    def _bytes(self, begin: int, end: int) -> bytes:
        first, last = begin // BLOCK_BYTES, (end - 1) // BLOCK_BYTES
        missing = [k for k in range(first, last + 1) if k not in self._blocks]
        found = {k: self._blocks[k] for k in range(first, last + 1) if k in self._blocks}
        if missing:  # one request for all of them: what lies between is read anew
            start = missing[0] * BLOCK_BYTES
            content = self._asked(start, min((missing[-1] + 1) * BLOCK_BYTES, self._size))
            for k in range(missing[0], missing[-1] + 1):
                found[k] = content[k * BLOCK_BYTES - start :][:BLOCK_BYTES]
        for k, block in found.items():
            self._blocks[k] = block
            self._blocks.move_to_end(k)
        while len(self._blocks) > KEPT_BLOCKS:
            self._blocks.popitem(last=False)
        joined = b"".join(found[k] for k in range(first, last + 1))
        return joined[begin - first * BLOCK_BYTES : end - first * BLOCK_BYTES]

    def _asked(self, start: int, end: int) -> bytes:
        headers = {"Range": f"bytes={start}-{end - 1}", "If-Range": self._etag, "Accept-Encoding": "identity"}
        response = self._connection.run(asked(self._connection.server, Request("GET", self._path, headers=headers)))
        self._check(response, start, end)
        self.bytes_read += len(response.content)
        return response.content

    def _check(self, response: httpx2.Response, start: int, end: int) -> None:
        if response.status_code != 206 or response.headers.get("ETag", self._etag) != self._etag:
            raise ServerError(f"{self._path}: the file has changed, or the server gives no ranges of it; use save")
        if len(response.content) != end - start:
            raise ServerError(f"{self._path}: {len(response.content)} bytes came of {end - start}")
