"""Ports for servers that tests start."""

import random
import socket
from typing import Final

_PORTS: Final = range(20_000, 32_000)
"""From above these the system takes ports for connections: one of them that is free now may be
taken by whatever else runs, before a server that is told its number listens there."""


def free_ports(count: int) -> list[int]:
    """Numbers of ports at which nobody listens, each another one."""
    found: list[int] = []
    for port in random.SystemRandom().sample(_PORTS, len(_PORTS)):
        if len(found) == count:
            break
        with socket.socket() as tried:
            try:
                tried.bind(("127.0.0.1", port))
            except OSError:
                continue
        found.append(port)
    return found
