"""People's port with a certificate: pages, the socket, and what happens when files change."""

import asyncio
import ssl
from pathlib import Path

import pytest
import structlog
from websockets.asyncio.client import connect

from esplanade.protocol import VERSION
from esplanade.protocol.messages import Hello, Snapshot
from esplanade.server.net import tls
from esplanade.server.net.tls import Tls, TlsError
from tests.patience import PATIENCE_S
from tests.server.certificates import Pair, make_pair, openssl
from tests.server.client import Client
from tests.server.conftest import Serving


@pytest.fixture
def pair(tmp_path: Path) -> Pair:
    return make_pair(tmp_path, "here")


async def test_pages_and_the_socket_are_encrypted(serving: Serving, pair: Pair) -> None:
    async with serving(**pair.settings) as server:
        assert (await page(server.port, pair)).startswith(b"HTTP/1.1 200 OK\r\n")
        url = f"wss://127.0.0.1:{server.port}/ws"
        async with connect(url, ssl=pair.trusting(), proxy=None) as connection:
            client = Client(connection)
            await client.send(Hello(name="Ann", version=VERSION))
            await client.until(Snapshot)
            await client.move(0.0, 1.0)
            await client.ticks(3)


async def test_who_speaks_no_tls_is_cut_off(serving: Serving, pair: Pair) -> None:
    async with serving(**pair.settings) as server:
        reader, writer = await asyncio.open_connection("127.0.0.1", server.port)
        writer.write(b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")
        async with asyncio.timeout(PATIENCE_S):
            assert not (await reader.read()).startswith(b"HTTP")
        writer.close()
        assert await page(server.port, pair)


async def test_connections_in_a_handshake_are_counted_and_hold_no_stop_up(
    serving: Serving, pair: Pair
) -> None:
    async with serving(**pair.settings, address_sockets=2) as server:
        streams = [
            await asyncio.open_connection("127.0.0.1", server.port, local_addr=("127.0.0.2", 0))
            for _ in range(3)
        ]
        async with asyncio.timeout(PATIENCE_S):
            assert await streams[2][0].read() == b""
        assert b"esplanade_sockets 2.0" in server.metrics.exposition()
    for reader, writer in streams[:2]:
        async with asyncio.timeout(PATIENCE_S):
            assert await reader.read() == b""
        writer.close()
    streams[2][1].close()


async def test_a_handshake_must_be_done_in_time(
    serving: Serving, pair: Pair, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("esplanade.server.net.door.HANDSHAKE_S", 0.1)
    async with serving(**pair.settings) as server:
        reader, writer = await asyncio.open_connection("127.0.0.1", server.port)
        async with asyncio.timeout(PATIENCE_S):
            assert await reader.read() == b""
        writer.close()


async def test_a_new_certificate_is_taken_and_connections_go_on(
    serving: Serving, pair: Pair, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tls, "POLL_S", 0.02)
    old_client, other = pair.trusting(), make_pair(tmp_path, "there", "rsa")
    new_client = other.trusting()
    async with serving(**pair.settings) as server:
        url = f"wss://127.0.0.1:{server.port}/ws"
        async with connect(url, ssl=old_client, proxy=None) as connection:
            client = Client(connection)
            await client.send(Hello(name="Ann", version=VERSION))
            pair.replace_by(other)
            async with asyncio.timeout(PATIENCE_S):
                while not await trusts(server.port, new_client):  # noqa: ASYNC110
                    await asyncio.sleep(0.02)
            assert not await trusts(server.port, old_client)
            await client.until(Snapshot)


def test_a_broken_new_pair_is_told_and_the_old_one_stays(pair: Pair, tmp_path: Path) -> None:
    held = Tls(pair.cert, pair.key)
    before, other = held.context, make_pair(tmp_path, "there")
    with structlog.testing.capture_logs() as lines:
        other.cert.replace(pair.cert)
        held.look()
        held.look()
        assert held.context is before
        other.key.replace(pair.key)
        held.look()
        assert held.context is not before
        pair.key.unlink()
        held.look()
    events = [line["event"] for line in lines]
    refused = "new certificate refused, the one before stays"
    assert events == [refused, "certificate renewed", refused]
    assert "does not belong to the certificate" in lines[0]["fault"]
    assert "cannot be read: No such file" in lines[2]["fault"]


@pytest.mark.parametrize(
    ("fault", "told"),
    [
        ("no cert", "tls_cert: {cert}: cannot be read: No such file or directory"),
        ("no key", "tls_key: {key}: cannot be read: No such file or directory"),
        ("folder", "tls_key: {key}: cannot be read: Is a directory"),
        ("junk cert", "tls_cert: {cert}: holds no certificate in PEM form"),
        ("junk key", "tls_key: {key}: holds no private key in PEM form"),
        ("other key", "tls_key: {key}: it does not belong to the certificate in {cert}"),
        ("other kind", "tls_key: {key}: it does not belong to the certificate in {cert}"),
        ("encrypted", "tls_key: {key}: the key is encrypted; give one without a password"),
    ],
)
def test_what_cannot_be_used_is_refused_by_name(
    pair: Pair, tmp_path: Path, fault: str, told: str
) -> None:
    match fault:
        case "no cert":
            pair.cert.unlink()
        case "no key":
            pair.key.unlink()
        case "folder":
            pair.key.unlink()
            pair.key.mkdir()
        case "junk cert":
            pair.cert.write_bytes(pair.key.read_bytes())
        case "junk key":
            pair.key.write_bytes(pair.cert.read_bytes())
        case "other key":
            make_pair(tmp_path, "there").key.replace(pair.key)
        case "other kind":
            make_pair(tmp_path, "there", "rsa").key.replace(pair.key)
        case "encrypted":
            hidden = tmp_path / "hidden.key"
            words = ("pkey", "-aes256", "-passout", "pass:word", "-in")
            openssl(*words, str(pair.key), "-out", str(hidden))
            hidden.replace(pair.key)
    with pytest.raises(TlsError) as refused:
        Tls(pair.cert, pair.key)
    assert str(refused.value).startswith(told.format(cert=pair.cert, key=pair.key))


async def page(port: int, pair: Pair) -> bytes:
    reader, writer = await asyncio.open_connection("127.0.0.1", port, ssl=pair.trusting())
    writer.write(b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")
    async with asyncio.timeout(PATIENCE_S):
        answer = await reader.read()
    writer.close()
    await writer.wait_closed()
    return answer


async def trusts(port: int, client: ssl.SSLContext) -> bool:
    """Whether a new connection gets a certificate that this client trusts."""
    try:
        _, writer = await asyncio.open_connection("127.0.0.1", port, ssl=client)
    except ssl.SSLCertVerificationError:
        return False
    writer.close()
    await writer.wait_closed()
    return True
