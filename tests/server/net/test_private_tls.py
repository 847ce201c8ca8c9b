"""The private port with a certificate, and where it must have one."""

import asyncio
import json
import ssl
from pathlib import Path

import pytest
from pydantic import ValidationError

from esplanade.server.accounts.identity import MACHINE
from esplanade.server.net import tls
from esplanade.server.settings import ServerSettings
from tests.patience import PATIENCE_S
from tests.server.certificates import Pair, make_pair
from tests.server.conftest import Serving
from tests.server.console.browsers import PASSWORD


@pytest.fixture
def pair(tmp_path: Path) -> Pair:
    return make_pair(tmp_path, "here")


@pytest.mark.parametrize("host", ["", "::", "192.0.2.1", "ops.example.org"])
def test_operators_are_not_served_in_the_clear_over_a_network(host: str) -> None:
    with pytest.raises(ValidationError, match="without encryption; give --private-tls-cert"):
        ServerSettings(private_host=host)
    assert ServerSettings(private_host=host, behind_proxy=True).private_host == host


@pytest.mark.parametrize("host", ["127.0.0.1", "127.0.0.2", "::1", "localhost"])
def test_the_machine_itself_needs_no_certificate(host: str) -> None:
    assert ServerSettings(private_host=host).private_host == host


def test_a_certificate_will_do_of_either_port(pair: Pair) -> None:
    everywhere = "0.0.0.0"
    ServerSettings(private_host=everywhere, tls_cert=pair.cert, tls_key=pair.key)
    ServerSettings(private_host=everywhere, private_tls_cert=pair.cert, private_tls_key=pair.key)
    with pytest.raises(ValidationError, match="give both of them, or none"):
        ServerSettings(private_tls_cert=pair.cert)


async def _ask(port: int, context: ssl.SSLContext, text: str) -> bytes:
    reader, writer = await asyncio.open_connection("127.0.0.1", port, ssl=context)
    writer.write(text.replace("\n", "\r\n").encode())
    async with asyncio.timeout(PATIENCE_S):
        answer = await reader.read()
    writer.close()
    return answer


HEALTH = "GET /healthz HTTP/1.1\nHost: localhost\nConnection: close\n\n"


async def test_the_private_port_is_encrypted_and_its_cookies_are_secure(
    serving: Serving, pair: Pair
) -> None:
    async with serving(private_tls_cert=pair.cert, private_tls_key=pair.key) as server:
        await server.kept.directory.add(MACHINE, "anna", "admin", PASSWORD)
        port = server.private_port
        assert b"alive" in await _ask(port, pair.trusting(), HEALTH)
        body = json.dumps({"name": "anna", "password": PASSWORD})
        for scheme, status in (("https", b"200"), ("http", b"403")):
            answer = await _ask(
                port,
                pair.trusting(),
                f"POST /api/v1/login HTTP/1.1\nHost: localhost:{port}\nX-Esplanade: 1\n"
                f"Origin: {scheme}://localhost:{port}\nContent-Type: application/json\n"
                f"Connection: close\nContent-Length: {len(body)}\n\n{body}",
            )
            assert answer.split(b" ")[1] == status, answer
            assert (b"; secure" in answer.lower()) == (status == b"200")


async def test_people_s_certificate_is_renewed_on_the_private_port_too(
    serving: Serving, pair: Pair, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tls, "POLL_S", 0.05)
    async with serving(**pair.settings, private_host="0.0.0.0") as server:
        assert b"alive" in await _ask(server.private_port, pair.trusting(), HEALTH)
        other = make_pair(tmp_path, "other")
        trusting = other.trusting()
        pair.replace_by(other)
        async with asyncio.timeout(PATIENCE_S):
            while True:
                try:
                    assert b"alive" in await _ask(server.private_port, trusting, HEALTH)
                    break
                except ssl.SSLError:
                    await asyncio.sleep(0.05)
