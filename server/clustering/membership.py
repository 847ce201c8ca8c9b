"""The membership of a process in a cluster: its name, the database and the broker."""

import re
import secrets
import socket
from dataclasses import dataclass
from typing import Final, Self

from esplanade.server.store.location import Location
from esplanade.server.store.store import StoreError

_NAME: Final = re.compile(r"[a-z0-9][a-z0-9-]{0,31}")
_SERVER: Final = re.compile(r"(nats|tls)://[^\s,]+")


@dataclass(frozen=True)
class Membership:
    """The facts that make a process part of a cluster."""

    name: str
    location: Location
    servers: tuple[str, ...]
    """The brokers, any of which will do."""
    health_host: str
    health_port: int

    @classmethod
    def of(cls, store: str, nats: str, name: str, health_host: str, health_port: int) -> Self:
        """The membership that options say.

        Raises
        ------
        ValueError
            One of them cannot be; the message says which and why.
        """
        if name and _NAME.fullmatch(name) is None:
            raise ValueError(
                f"name: {name!r} is not made of 1 to 32 lower-case letters, digits and hyphens"
            )
        servers = tuple(each.strip() for each in nats.split(","))
        for server in servers:
            if _SERVER.fullmatch(server) is None:
                raise ValueError(f"nats: {server!r} is no address such as nats://127.0.0.1:4222")
        try:
            location = Location.of(None, store)
        except StoreError as error:
            raise ValueError(str(error)) from None
        return cls(name or _some_name(), location, servers, health_host, health_port)


def _some_name() -> str:
    machine = re.sub(r"[^a-z0-9]+", "-", socket.gethostname().lower()).strip("-")[:20]
    return f"{machine or 'process'}-{secrets.token_hex(3)}"
