"""Where webhooks may go: what a user names is asked by this server, from within its network (SSRF)."""

import asyncio
import socket
from collections.abc import Sequence
from concurrent.futures import Executor
from ipaddress import IPv4Address, IPv4Network, IPv6Address, IPv6Network, ip_address

from httpx2 import URL, InvalidURL

from wsrender_server.jobs.faults import TargetNotAllowed

LONGEST_URL = 2048  # characters
PORTS = {"http": 80, "https": 443}
# Wrapped IPv4 (6to4), and what was private before fc00::/7.
NOT_PUBLIC = (IPv6Network("2002::/16"), IPv6Network("fec0::/10"))


class AllowedTargets:
    """Origins that the settings allow, and networks that they allow beside public addresses."""

    def __init__(self, origins: Sequence[str], networks: Sequence[IPv4Network | IPv6Network]):
        self._origins = origins
        self._networks = networks

    def check(self, url: str) -> URL:
        """The URL, read once: what is checked is what is asked. Raises TargetNotAllowed."""
        if len(url) > LONGEST_URL:
            raise TargetNotAllowed(f"must have at most {LONGEST_URL} characters, not {len(url)}")
        if not (url.isascii() and url.isprintable()) or " " in url:
            raise TargetNotAllowed("must be of printable ASCII characters without spaces")
        try:
            parsed = URL(url)
            host, port = parsed.host, parsed.port or PORTS.get(parsed.scheme)
        except (InvalidURL, ValueError) as error:  # ValueError: names that are none by IDNA
            raise TargetNotAllowed(f"must be a URL: {error}") from None
        if (port is not None and not 0 < port < 65536) or parsed.port == 0:
            raise TargetNotAllowed(f"must have a port between 1 and 65535, not {parsed.port}")
        if parsed.scheme not in PORTS or not host:
            raise TargetNotAllowed("must begin with https:// or http:// and a host")
        if parsed.userinfo or parsed.fragment or "#" in url:
            raise TargetNotAllowed("must hold neither a user, a password nor a fragment")
        if not any(_matches(parsed.scheme, host, port, origin) for origin in self._origins):
            allowed = ", ".join(self._origins) or "nothing: this server sends no webhooks"
            raise TargetNotAllowed(f"must be of an origin that WSRENDER_WEBHOOK_TARGETS names, which is {allowed}")
        try:
            address = ip_address(host)
        except ValueError:  # a name, which is looked up when it is needed
            return parsed
        self._check([address], host)
        return parsed

    async def addresses(self, url: URL, resolver: Executor) -> list[str]:
        """The addresses of a URL's host, by one look-up; whoever connects takes one of these, and asks no name again.

        Raises TargetNotAllowed where any of them may not be reached.
        """
        loop, port = asyncio.get_running_loop(), url.port or PORTS[url.scheme]
        options = {"type": socket.SOCK_STREAM, "flags": socket.AI_ADDRCONFIG}
        try:
            found = await loop.run_in_executor(resolver, lambda: socket.getaddrinfo(url.host, port, **options))
        except (OSError, UnicodeError):
            raise TargetNotAllowed(f"{url.host} has no address") from None
        addresses = list(dict.fromkeys(str(entry[4][0]) for entry in found))
        self._check([ip_address(each) for each in addresses], url.host)
        return addresses

    def _check(self, addresses: Sequence[IPv4Address | IPv6Address], host: str) -> None:
        if not addresses or not all(map(self._reachable, addresses)):
            text = f"{host} has an address that is not public, and that WSRENDER_WEBHOOK_NETWORKS does not name"
            raise TargetNotAllowed(text)

    def _reachable(self, address: IPv4Address | IPv6Address) -> bool:
        if isinstance(address, IPv6Address) and address.ipv4_mapped is not None:
            address = address.ipv4_mapped
        if any(address in network for network in self._networks):
            return True
        odd = address.is_multicast or address.is_reserved or any(address in network for network in NOT_PUBLIC)
        return address.is_global and not odd


def _matches(scheme: str, host: str, port: int | None, origin: str) -> bool:
    """Whether an origin allows a host; ``*`` is any, ``*.`` at its beginning any name below."""
    allowed_scheme, _, rest = origin.partition("://")
    name, colon, digits = rest.rpartition(":") if not rest.endswith("]") else (rest, "", "")
    name = name if colon else rest
    allowed_port = int(digits) if colon else PORTS[allowed_scheme]
    if (scheme, port) != (allowed_scheme, allowed_port):
        return False
    if name == "*":
        return True
    host = f"[{host}]" if ":" in host else host.lower()
    return host.endswith(name[1:]) and host != name[1:] if name.startswith("*.") else host == name
