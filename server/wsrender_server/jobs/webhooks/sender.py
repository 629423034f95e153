"""One attempt to deliver a message: signed, to an address that was checked, bounded in time and in what is read."""

import asyncio
import ssl
import time
from concurrent.futures import ThreadPoolExecutor
from types import TracebackType
from typing import Self

import structlog
from httpx2 import URL, AsyncClient, ConnectError, ConnectTimeout, HTTPError, Limits, Timeout

from wsrender import __version__
from wsrender.errors import InputError
from wsrender_server.jobs.records import DeliveryOutcome, DeliveryRecord
from wsrender_server.jobs.webhooks.signature import signed_headers
from wsrender_server.jobs.webhooks.targets import AllowedTargets
from wsrender_server.settings import Settings

ATTEMPT_S = 10.0  # from the look-up of the name to the head of the answer
CONNECT_S = 4.0  # of one address
MOST_ADDRESSES = 3
LOOKUPS = 16  # at a time
LONGEST_SAID = 300  # characters of why an attempt failed
GONE = 410

log = structlog.get_logger("wsrender.webhooks")


class Sender:
    """Sends messages; an asynchronous context manager. Proxies of the environment are not asked.

    ``tls`` replaces what the system trusts.
    """

    def __init__(self, settings: Settings, tls: ssl.SSLContext | None = None):
        self._targets = AllowedTargets(settings.webhook_targets, settings.webhook_networks)
        self._tls = tls
        # Of its own: a resolver that hangs holds up nothing else.
        self._resolver = ThreadPoolExecutor(LOOKUPS, thread_name_prefix="webhook-names")

    async def __aenter__(self) -> Self:
        self._client = AsyncClient(
            follow_redirects=False,
            trust_env=False,
            verify=True if self._tls is None else self._tls,
            timeout=Timeout(ATTEMPT_S, connect=CONNECT_S),
            limits=Limits(max_keepalive_connections=0),
        )
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._resolver.shutdown(wait=False, cancel_futures=True)
        await self._client.aclose()

    async def send(self, message: DeliveryRecord) -> DeliveryOutcome:
        """Try once; any fault is an outcome."""
        try:
            async with asyncio.timeout(ATTEMPT_S):
                url = self._targets.check(message.url)
                status = await self._post(url, await self._targets.addresses(url, self._resolver), message)
        except TimeoutError:
            return DeliveryOutcome(False, f"no answer within {ATTEMPT_S:g} s")
        except InputError as error:
            return DeliveryOutcome(False, error.message[:LONGEST_SAID])
        except (HTTPError, OSError, ValueError) as error:
            return DeliveryOutcome(False, f"no answer: {error or type(error).__name__}"[:LONGEST_SAID])
        except Exception:
            log.exception("a delivery failed by a fault of the server", message=message.id)
            return DeliveryOutcome(False, "a fault of the server")
        said = f"the receiver answered {status}"
        if 300 <= status < 400:
            said += "; redirects are not followed"
        return DeliveryOutcome(200 <= status < 300, said, status == GONE)

    async def _post(self, url: URL, addresses: list[str], message: DeliveryRecord) -> int:
        """The status of the answer, of which no more than its head is read."""
        body = message.body.encode()
        headers = {
            **signed_headers(message.secret, message.id, int(time.time()), body),
            "Host": url.netloc.decode("ascii"),
            "Content-Type": "application/json",
            "User-Agent": f"wsrender/{__version__}",
        }
        fault: Exception = ConnectError("there is no address")
        for address in addresses[:MOST_ADDRESSES]:
            at = url.copy_with(host=address)
            try:
                # The certificate is that of the name; the connection goes to the address that was checked.
                async with self._client.stream(
                    "POST", at, content=body, headers=headers, extensions={"sni_hostname": url.raw_host.decode("ascii")}
                ) as response:
                    return response.status_code
            except (ConnectError, ConnectTimeout) as error:
                fault = error
        raise fault
