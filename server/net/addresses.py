"""Addresses of clients: what counts as one of them, and which one a trusted proxy speaks for."""

from collections.abc import Iterable
from ipaddress import IPv4Address, IPv4Network, IPv6Address, IPv6Network, ip_address, ip_network
from typing import Final

LOCAL_KEYS: Final = frozenset({"127.0.0.1", "::1"})
"""Limits for each address do not hold for these two: bots and tests of this machine come from them.

Other loopback addresses are like any other.
"""

MAX_HOPS: Final = 32
"""A longer chain of proxies is followed no further."""

_NETWORK_BITS: Final = 64


def address_key(text: str) -> str:
    """The key by which an IP address is counted, since one person may have many of them.

    An IPv4 address is its own key. Of IPv6 it is the network of 64 bits, which a provider hands
    out to one customer as a whole; but `::1` is its own key. An IPv4 address that is written in
    IPv6 (`::ffff:192.0.2.1`) counts as the IPv4 address.

    Raises
    ------
    ValueError
        The text is no IP address.
    """
    return _key(_parsed(text))


class TrustedProxies:
    """The networks whose word about the address of a client is taken.

    `networks` are separated by commas, `10.0.0.0/8, ::1`; an empty text trusts nobody.

    Raises
    ------
    ValueError
        One of them is no network; the message says which.
    """

    def __init__(self, networks: str) -> None:
        self._networks = [_network(item) for item in map(str.strip, networks.split(",")) if item]

    def trusts(self, text: str) -> bool:
        """Whether an IP address belongs to a trusted proxy."""
        return bool(self._networks) and self._covers(_parsed(text))

    def client_key(self, peer: str, forwarded: Iterable[str]) -> str:
        """The key of the client behind a peer, from the lines of its X-Forwarded-For headers.

        Every proxy appends the address that it saw, so the chain is read from its end for as
        long as proxies are trusted; what stands before the first address that is not trusted
        can be forged and is not read. An entry that is no address ends the chain as well: what
        counts is then the proxy that passed it on.
        """
        client = _parsed(peer)
        entries = ",".join(forwarded).split(",")
        for entry in entries[: -MAX_HOPS - 1 : -1]:
            if not self._covers(client):
                break
            try:
                client = _parsed(_without_port(entry.strip()))
            except ValueError:
                break
        return _key(client)

    def _covers(self, address: IPv4Address | IPv6Address) -> bool:
        return any(address in network for network in self._networks)


def _network(text: str) -> IPv4Network | IPv6Network:
    try:
        return ip_network(text, strict=False)
    except ValueError:
        raise ValueError(
            f"trusted_proxies: {text!r} is no address or network such as 10.0.0.0/8"
        ) from None


def _parsed(text: str) -> IPv4Address | IPv6Address:
    address = ip_address(text.partition("%")[0])
    if isinstance(address, IPv6Address) and address.ipv4_mapped is not None:
        return address.ipv4_mapped
    return address


def _key(address: IPv4Address | IPv6Address) -> str:
    text = str(address)
    if isinstance(address, IPv4Address) or text in LOCAL_KEYS:
        return text
    return str(IPv6Network((address, _NETWORK_BITS), strict=False))


def _without_port(entry: str) -> str:
    """An entry of X-Forwarded-For without the port that some proxies add."""
    if entry.startswith("["):
        return entry[1:].partition("]")[0]
    return entry.partition(":")[0] if entry.count(":") == 1 else entry
