"""The membership of a process in a cluster: its name, the database and the broker."""

import os
import re
import secrets
import socket
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Self

from esplanade.server.link.broker_login import (
    PASSWORD_VARIABLE,
    USER_VARIABLE,
    BrokerLogin,
)
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
    login: BrokerLogin
    """The login at them."""
    health_host: str
    health_port: int

    @classmethod
    def of(
        cls,
        store: str,
        nats: str,
        nats_login: Path | None,
        nats_ca: Path | None,
        nats_cert: Path | None,
        nats_key: Path | None,
        name: str,
        health_host: str,
        health_port: int,
    ) -> Self:
        """The membership that options and environment say.

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
            if "@" in server:
                raise ValueError(
                    "nats: an address has no user and password, since lists of processes and logs "
                    f"show it; put them into --nats-login, or {USER_VARIABLE} and "
                    f"{PASSWORD_VARIABLE}"
                )
            if _SERVER.fullmatch(server) is None:
                raise ValueError(f"nats: {server!r} is no address such as nats://127.0.0.1:4222")
        try:
            location = Location.of(None, store)
        except StoreError as error:
            raise ValueError(str(error)) from None
        login = BrokerLogin.of(os.environ, nats_login, nats_ca, nats_cert, nats_key)
        return cls(name or _some_name(), location, servers, login, health_host, health_port)


def _some_name() -> str:
    machine = re.sub(r"[^a-z0-9]+", "-", socket.gethostname().lower()).strip("-")[:20]
    return f"{machine or 'process'}-{secrets.token_hex(3)}"
