"""Addresses as people type them."""

import pytest

from esplanade.bots.address import websocket_url


@pytest.mark.parametrize(
    ("text", "url"),
    [
        ("ws://localhost:8080", "ws://localhost:8080/ws"),
        ("ws://localhost:8080/", "ws://localhost:8080/ws"),
        ("ws://localhost:8080/ws", "ws://localhost:8080/ws"),
        ("localhost:8080", "ws://localhost:8080/ws"),
        ("http://localhost:8080", "ws://localhost:8080/ws"),
        ("https://plaza.example", "wss://plaza.example/ws"),
        ("wss://plaza.example/worlds/1?x=2", "wss://plaza.example/worlds/1?x=2"),
        ("ws://[::1]:8080", "ws://[::1]:8080/ws"),
        ("ws://plaza.example/world/", "ws://plaza.example/world/ws"),
        ("plaza.example/world/?x=2", "ws://plaza.example/world/ws?x=2"),
        ("https://plaza.example/world", "wss://plaza.example/world/ws"),
        ("https://plaza.example/world/ws", "wss://plaza.example/world/ws"),
        ("http://plaza.example/world/index.html", "ws://plaza.example/world/ws"),
    ],
)
def test_the_path_is_added_when_absent(text: str, url: str) -> None:
    assert websocket_url(text) == url


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("", "expected host and port"),
        ("ftp://localhost", "unknown scheme 'ftp'"),
        ("ws://:8080", "expected host and port"),
        ("ws://localhost:99999", "out of range"),
        ("ws://localhost:0", "expected host and port"),
        ("ws://localhost:port", "Port could not be cast"),
        ("ws://[::1", "Invalid IPv6"),
        ("ws://localhost#top", "a fragment"),
    ],
)
def test_what_is_no_address_is_told(text: str, fault: str) -> None:
    with pytest.raises(ValueError, match=r"^url ") as caught:
        websocket_url(text)
    assert fault in str(caught.value)
