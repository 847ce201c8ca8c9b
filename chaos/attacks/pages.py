"""Pages: asked for without end, and asked for without being read."""

import re
import socket
import time
from contextlib import suppress
from typing import Final

from chaos.attack import Attack, Attacker
from chaos.wire import SERVER, opened

UNREAD: Final = 100
_SMALL_BUFFER: Final = 4096


def _requests(attacker: Attacker) -> None:
    attacker.start_clock()
    while attacker.goes_on:
        try:
            _read_page(attacker.port, "/")
            attacker.counts["pages"] += 1
        except OSError:
            attacker.refused()


def _unread(attacker: Attacker) -> None:
    """Ask for the largest file of the page on many connections and read none of the answers."""
    path = _largest(attacker.port)
    attacker.start_clock()
    held: list[socket.socket] = []
    while attacker.goes_on:
        if len(held) >= UNREAD:
            time.sleep(0.1)
            continue
        try:
            made = opened(attacker.port, receive_bytes=_SMALL_BUFFER)
            made.sendall(_request(path))
            held.append(made)
            attacker.counts["requests"] += 1
        except OSError:
            attacker.refused()
    for each in held:
        each.close()


def _largest(port: int) -> str:
    """The script of the page, or the page itself if there is none."""
    page = _read_page(port, "/").decode(errors="replace")
    scripts = re.findall(r'src="\.?/?([^"]+\.js)"', page)
    return f"/{scripts[0]}" if scripts else "/"


def _read_page(port: int, path: str) -> bytes:
    read = b""
    with opened(port) as made:
        made.sendall(_request(path))
        with suppress(ConnectionResetError):
            while piece := made.recv(1 << 20):
                read += piece
    if not read:
        raise ConnectionResetError("no answer")
    return read


def _request(path: str) -> bytes:
    return f"GET {path} HTTP/1.1\r\nHost: {SERVER}\r\n\r\n".encode()


ATTACKS: Final = (
    Attack("pages", "the page is fetched as fast as it comes", _requests, by_speed=True),
    Attack("unread-answers", f"{UNREAD} answers that nobody reads", _unread, least_s=12.0),
)
