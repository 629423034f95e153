"""A session ends when one of its sides does, whatever the other is at just then."""

import asyncio
import json
import struct

import pytest
from wsrender_server.problems import HttpProblem
from wsrender_server.routes import view_session

HEADER = json.dumps({"id": 0, "answer": {}, "blobs": []}).encode()


class Page:
    """A page that sends one question too many at the moment at which it has taken in an answer."""

    def __init__(self, later: int):
        self.later = later  # turns of the loop
        self.taken = asyncio.Event()
        self.asked = asyncio.Event()

    async def send_bytes(self, _):
        self.asked.set()
        await self.taken.wait()
        for _ in range(self.later):
            await asyncio.sleep(0)

    async def receive(self):
        await self.asked.wait()
        self.taken.set()
        return {"type": "websocket.receive", "text": "x" * (view_session.LARGEST_QUESTION + 1)}


class Engine:
    """A process that goes on answering."""

    too_large = False

    async def received(self):
        await asyncio.sleep(0.001)
        return struct.pack("<I", len(HEADER)) + HEADER


@pytest.mark.parametrize("later", range(8))
def test_a_session_that_is_refused_while_an_answer_goes_out_ends(later, monkeypatch):
    async def never(*_):
        await asyncio.Event().wait()

    async def pumped():
        async with asyncio.timeout(60):
            await view_session._pump(Page(later), Engine(), None)

    monkeypatch.setattr(view_session, "until_revoked", never)
    with pytest.raises(HttpProblem, match="a question may have"):
        asyncio.run(pumped())
