"""The socket that requests come in by."""

import asyncio
import socket

import pytest
from wsrender_server.serving import listen
from wsrender_server.settings import Settings


@pytest.mark.parametrize("host", ["127.0.0.1", "::1"])
def test_answers_on_kept_connections_are_not_held_back(host, tmp_path):
    """Accepted connections have Nagle's algorithm off: with it every answer but the first waits 40 ms for the client's
    acknowledgement."""
    with listen(Settings(host=host, port=0, data_dir=tmp_path)) as listener:
        assert asyncio.run(no_delay_of_accepted(listener)) == 1


async def no_delay_of_accepted(listener):
    """TCP_NODELAY of a connection that asyncio has accepted."""
    found = asyncio.get_running_loop().create_future()

    async def accepted(reader, writer):
        taken = writer.get_extra_info("socket")
        found.set_result(taken.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY))
        writer.close()

    async with await asyncio.start_server(accepted, sock=listener):
        _, writer = await asyncio.open_connection(*listener.getsockname()[:2])
        try:
            return await found
        finally:
            writer.close()
