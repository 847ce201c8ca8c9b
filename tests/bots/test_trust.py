"""Certificates that bots trust: exactly the one that is given, or those of the machine."""

import asyncio
import ssl
from pathlib import Path
from typing import Any, cast

import pytest
from websockets.asyncio.server import ServerConnection, serve

from esplanade import bots
from esplanade.bots.connection import Connection
from esplanade.bots.trust import HIDDEN_BYTES, tls_context
from esplanade.protocol import VERSION, encode
from esplanade.protocol.messages import Hello
from tests.bots.scripted import Person, ScriptedServer
from tests.patience import PATIENCE_S
from tests.server.certificates import Pair, make_pair, openssl
from tests.server.conftest import Serving, room_file, serving, serving_assets

HELLO = Hello(name="Ann", version=VERSION)

__all__ = ["room_file", "serving", "serving_assets"]


async def test_a_bot_trusts_exactly_the_certificate_that_it_is_given(
    serving: Serving, tmp_path: Path
) -> None:
    right, wrong = make_pair(tmp_path, "right"), make_pair(tmp_path, "wrong")
    async with serving(host="127.0.0.2", **right.settings) as server:
        url = f"wss://127.0.0.2:{server.port}"  # not a name of the certificate
        async with bots.connect(url, trust=right.cert) as bot:
            assert bot.welcome.name == "Bot"
        for trust in (wrong.cert, None):
            with pytest.raises(bots.Unreachable, match="certificate verify failed"):
                async with bots.connect(url, trust=trust):
                    pass


async def test_of_a_chain_only_the_first_certificate_is_trusted(
    serving: Serving, tmp_path: Path
) -> None:
    signer, other = make_pair(tmp_path, "signer"), tmp_path / "other.pem"
    leaf = _signed(tmp_path, signer)
    async with serving(**leaf.settings) as server:
        url = f"wss://127.0.0.1:{server.port}"
        async with bots.connect(url, trust=leaf.cert):
            pass
        other.write_bytes(make_pair(tmp_path, "next").cert.read_bytes() + leaf.cert.read_bytes())
        with pytest.raises(bots.Unreachable, match="certificate verify failed"):
            async with bots.connect(url, trust=other):
                pass


def test_a_file_that_is_no_certificate_is_refused_by_name(tmp_path: Path) -> None:
    file = tmp_path / "cert.pem"
    for text in ("", "-----BEGIN CERTIFICATE-----", "\0" * 10):
        file.write_text(text)
        with pytest.raises(ValueError, match=r"cert\.pem cannot be used .* it holds"):
            tls_context(file)
    file.write_text("-----BEGIN CERTIFICATE-----\nabcd\n-----END CERTIFICATE-----\n")
    with pytest.raises(ValueError, match="cannot be used as a certificate"):
        tls_context(file)
    with pytest.raises(ValueError, match="No such file"):
        tls_context(tmp_path / "none.pem")


def test_clients_of_a_process_share_a_context_until_the_file_changes(tmp_path: Path) -> None:
    pair = make_pair(tmp_path, "here")
    first = tls_context(pair.cert)
    assert tls_context(pair.cert) is first
    assert tls_context(None) is tls_context(None)
    make_pair(tmp_path, "here")
    assert tls_context(pair.cert) is not first


async def test_what_a_bot_has_not_read_is_held_back_under_tls_too(tmp_path: Path) -> None:
    """Without a limit of ours a quarter of a megabyte waits within TLS, unseen by the server."""
    pair = make_pair(tmp_path, "here")
    world, chunk = ScriptedServer(), b"\x82\x7e\x10\x00" + bytes(4096)

    async def handler(socket: ServerConnection) -> None:
        await socket.recv()
        await socket.send(encode(world.welcome(Person(1, socket, HELLO, (0.0, 0.0)))))
        while socket.transport.get_write_buffer_size() == 0:
            socket.transport.write(chunk)
            await asyncio.sleep(0.001)
        full.set()
        await socket.wait_closed()

    full = asyncio.Event()
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(pair.cert, pair.key)
    async with serve(handler, "127.0.0.1", 0, ssl=context) as server:
        port = server.sockets[0].getsockname()[1]
        connection = await Connection.open(f"wss://127.0.0.1:{port}", HELLO, pair.cert)
        async with asyncio.timeout(PATIENCE_S):
            await full.wait()
        transport = cast(Any, connection._socket.transport)
        assert HIDDEN_BYTES <= transport.get_read_buffer_size() < 128 * 1024
        transport.abort()


def _signed(folder: Path, signer: Pair) -> Pair:
    """A certificate for localhost that the signer has signed, followed by the signer's."""
    pair = Pair(folder / "leaf.pem", folder / "leaf.key")
    request = folder / "leaf.csr"
    openssl(
        *("req", "-nodes", "-subj", "/CN=localhost", "-newkey", "rsa:2048"),
        *("-keyout", str(pair.key), "-out", str(request)),
    )
    openssl(
        *("x509", "-req", "-days", "2", "-in", str(request), "-out", str(pair.cert)),
        *("-CA", str(signer.cert), "-CAkey", str(signer.key), "-CAcreateserial"),
    )
    pair.cert.write_bytes(pair.cert.read_bytes() + signer.cert.read_bytes())
    return pair
