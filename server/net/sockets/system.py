"""Whether kernels can call the system here, and the descriptors with which they may."""

import asyncio
import platform
import socket
import sys
from typing import Final

import numba

AVAILABLE: Final = (
    sys.platform == "linux"
    and sys.maxsize > 2**32
    and sys.byteorder == "little"
    and not numba.config.DISABLE_JIT  # type: ignore[attr-defined]
)
"""Numbers of flags and layouts of structures are those of 64-bit Linux."""

ENTRY_BYTES, ENTRY_AT = (12, 4) if platform.machine() == "x86_64" else (16, 8)
"""The size of a `struct epoll_event`, and where the descriptor stands in it."""

NONE: Final = -1
"""The descriptor of no connection."""


def descriptor_of(transport: asyncio.Transport) -> int:
    """The descriptor of a plain socket under a transport; `NONE` if it must not be used."""
    if not AVAILABLE or transport.get_extra_info("sslcontext") is not None:
        return NONE
    sock = transport.get_extra_info("socket")
    if sock is None or sock.type != socket.SOCK_STREAM:
        return NONE
    found: int = sock.fileno()
    return found
