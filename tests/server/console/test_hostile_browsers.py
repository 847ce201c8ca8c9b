"""A hostile page, name, header or cookie reaches nothing on the private port."""

import asyncio
import json
from itertools import product
from typing import Any

import pytest

from esplanade.server.accounts.identity import MACHINE
from esplanade.server.accounts.rights import Right
from esplanade.server.console.callers import Callers, Credential
from tests.patience import PATIENCE_S
from tests.server.conftest import Serving
from tests.server.console.browsers import PASSWORD, Browser, codes, logged_in
from tests.server.http import get

RISK = {"op": "set_parameters", "scope": "world", "values": {"risk_weight": 12}}
FOREIGN = [
    "http://evil.example",
    "https://evil.example",
    "null",
    "http://localhost",
    "http://localhost:8080",
    "http://localhost.evil.example:{port}",
    "http://evil@localhost:{port}",
    "http://localhost:{port}@evil.example",
    "http://localhost:{port}/",
    "http://localhost:{port}.evil.example",
    "http://[::1]:{port}",
    "http://127.0.0.1:{port}",
    "file://",
    "ftp://localhost:{port}",
    "javascript:alert(1)",
    "http://localhost:99999999",
    "http://[",
    "",
]
NAMES = [
    "evil.example",
    "evil.example:{port}",
    "localhost.evil.example:{port}",
    "evil-localhost:{port}",
    "user@localhost:{port}",
    "localhost:{port}/x",
    "127.0.0.1.nip.io:{port}",
    "[::1",
    "localhost:port",
]


async def test_pages_of_others_change_nothing(serving: Serving) -> None:
    async with serving(actors=1) as server:
        browser = await logged_in(server, "anna", "admin")
        asked = {
            "/commands": RISK,
            "/logout": None,
            "/passes": None,
            "/accounts": {"name": "eve", "role": "admin", "password": PASSWORD},
            "/login": {"name": "anna", "password": PASSWORD},
            "/first": {"token": "x", "name": "eve", "password": PASSWORD},
        }
        tries = [(FOREIGN[0], path) for path in asked] + [(origin, "/login") for origin in FOREIGN]
        for origin, path in tries:
            body = asked[path]
            page = {"Origin": origin.format(port=server.private_port)}
            answer = await browser.raw("POST", path, body, page)
            assert answer.status == 403, (origin, path, answer.body)
            assert codes(json.loads(answer.body)) == ["foreign_origin"]
            assert "access-control-allow-origin" not in answer.headers
        assert (await browser.send("GET", "/me"))[0] == 200
        assert server.world.parameters("main/actor-1").risk_weight == 9.5
        assert [each.name for each in await server.kept.directory.list()] == ["anna"]


async def test_what_the_browser_itself_says_of_the_page_counts(serving: Serving) -> None:
    async with serving(actors=0) as server:
        browser = await logged_in(server, "anna", "admin")
        requests = (("GET", "/audit"), ("POST", "/passes"))
        for site, (method, path) in product(("cross-site", "same-site", "other"), requests):
            headers = {"Sec-Fetch-Site": site, "Origin": None}
            assert (await browser.raw(method, path, None, headers)).status == 403


async def test_a_name_that_others_have_pointed_here_opens_nothing(serving: Serving) -> None:
    async with serving(actors=0) as server:
        known = await logged_in(server, "anna", "admin")
        for name in NAMES:
            host = name.format(port=server.private_port)
            rebound = Browser(server.private_port, host, known.cookie)
            log_in = {"name": "anna", "password": PASSWORD}
            assert (await rebound.raw("GET", "/audit")).status in {400, 403}, name
            assert (await rebound.raw("POST", "/passes")).status in {400, 403}, name
            assert (await rebound.raw("POST", "/login", log_in)).status in {400, 403}, name


async def test_names_of_this_port_are_taken(serving: Serving) -> None:
    async with serving(actors=0, private_names="ops.example.org, other") as server:
        await server.kept.directory.add(MACHINE, "anna", "admin", PASSWORD)
        for name in ("localhost", "127.0.0.1", "[::1]", "ops.example.org", "OTHER", "10.1.2.3"):
            browser = Browser(server.private_port, f"{name}:{server.private_port}")
            assert (await browser.log_in("anna"))[0] == 200, name
            assert (await browser.send("GET", "/me"))[0] == 200, name


async def test_a_preflight_of_another_page_is_allowed_nothing(serving: Serving) -> None:
    async with serving(actors=0) as server:
        headers = {
            "Origin": "http://evil.example",
            "Access-Control-Request-Method": "POST",
            "Access-Control-Request-Headers": "x-esplanade",
        }
        answer = await get(server.private_port, "/api/v1/commands", headers, "OPTIONS")
        assert answer.status in {401, 405}
        assert not [name for name in answer.headers if name.startswith("access-control")]


async def test_a_form_of_any_page_lacks_the_header(serving: Serving) -> None:
    async with serving(actors=0) as server:
        browser = await logged_in(server, "anna", "admin")
        for path in ("/passes", "/logout", "/login"):
            answer = await browser.raw("POST", path, None, {"X-Esplanade": None, "Origin": None})
            assert (answer.status, codes(json.loads(answer.body))) == (403, ["header_missing"])


async def _raw(port: int, head: str) -> int:
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    writer.write(head.replace("\n", "\r\n").encode())
    async with asyncio.timeout(PATIENCE_S):
        received = await reader.read()
    writer.close()
    return int(received.split(b" ", 2)[1]) if received else 0


BROKEN = [
    "Host: localhost\n",
    "Authorization: Bearer esplanade_other\nAuthorization: Bearer esplanade_third\n",
    "Cookie: esplanade_session=other\n",
    "Cookie: a=b; esplanade_session=other\n",
    "Content-Length: 0\nContent-Length: 5\n",
    "Transfer-Encoding: xchunked\n",
    "X-Esplanade : 1\n",
    "Origin: http://localhost\nOrigin: http://evil.example\n",
]


async def test_headers_that_come_twice_or_broken_are_refused(serving: Serving) -> None:
    async with serving(actors=0) as server:
        browser = await logged_in(server, "anna", "admin")
        head = (
            f"POST /api/v1/logout HTTP/1.1\nHost: localhost:{server.private_port}\n"
            f"Cookie: esplanade_session={browser.cookie}\nX-Esplanade: 1\nConnection: close\n"
        )
        for more in BROKEN:
            status = await _raw(server.private_port, f"{head}{more}\n")
            assert status in {400, 401, 403, 501}, more
        assert (await browser.send("GET", "/me"))[0] == 200


RESEMBLING = [
    {"Cookie": "esplanade_session="},
    {"Cookie": "esplanade_session=" + "x" * 8000},
    {"Cookie": "esplanade_session=%00"},
    {"Cookie": 'esplanade_session="; DROP TABLE sessions'},
    {"Cookie": "ESPLANADE_SESSION={cookie}"},
    {"Cookie": "esplanade_session={cookie}x"},
    {"Authorization": "Bearer {cookie}"},
    {"Authorization": "Basic YW5uYTp4"},
    {"Authorization": "Bearer"},
    {"X-Forwarded-User": "anna", "X-Remote-User": "anna"},
]


async def test_what_only_resembles_a_secret_opens_nothing(serving: Serving) -> None:
    async with serving(actors=0) as server:
        known = await logged_in(server, "anna", "admin")
        for headers in RESEMBLING:
            given = {name: value.format(cookie=known.cookie) for name, value in headers.items()}
            answer = await get(server.private_port, "/api/v1/audit", given)
            assert answer.status == 401, headers


async def test_the_cookie_of_a_session_is_no_token_and_the_other_way_round(
    serving: Serving,
) -> None:
    async with serving(actors=0) as server:
        await server.kept.directory.add(MACHINE, "anna", "admin", PASSWORD)
        token = await server.kept.tokens.add(MACHINE, "anna", "script")
        status, _ = await Browser(server.private_port, cookie=token).send("GET", "/me")
        assert status == 401


SPELLINGS = [
    "/api/v1//audit",
    "/api/v1/./audit",
    "/api/v1/../v1/audit",
    "/api/v1/audit/",
    "/API/V1/audit",
    "/api/v1/%61udit",
    "/console/../api/v1/audit",
    "/api/v1/audit%2f",
    "//localhost/api/v1/audit",
    "/healthz/../api/v1/audit",
    "http://localhost/api/v1/audit",
    "/api/v1/audit;x",
    "/api/v1/audit?token=esplanade_x",
]


async def test_no_spelling_of_a_path_is_a_way_around_its_guard(serving: Serving) -> None:
    async with serving(actors=0) as server:
        for path in SPELLINGS:
            assert (await get(server.private_port, path)).status in {400, 401, 404}, path


async def test_other_methods_are_no_way_around_either(serving: Serving) -> None:
    async with serving(actors=0) as server:
        for method in ("PUT", "DELETE", "PATCH", "TRACE", "CONNECT", "get", "XPOST"):
            headers = {"X-HTTP-Method-Override": "GET"}
            answer = await get(server.private_port, "/api/v1/audit", headers, method)
            assert answer.status in {400, 401, 404, 405}, method


async def test_an_oversized_login_is_not_read(serving: Serving) -> None:
    async with serving(actors=0) as server:
        browser = Browser(server.private_port)
        big = {"name": "anna", "password": "x" * 70_000}
        assert (await browser.raw("POST", "/login", big)).status == 413
        long = {"name": "anna", "password": "x" * 2000}
        assert (await browser.send("POST", "/login", long))[0] == 422
        fields = {"X-Esplanade": "1", "Content-Type": "application/json"}
        deep = b"[" * 30_000
        answer = await get(server.private_port, "/api/v1/login", fields, "POST", deep)
        assert answer.status == 400


async def test_whoever_has_a_socket_open_is_looked_up_again(serving: Serving) -> None:
    """A right that is taken away, a revoked token and an ended session end what is open."""
    async with serving(actors=0) as server:
        kept = server.kept
        await kept.directory.add(MACHINE, "anna", "admin", PASSWORD)
        await kept.directory.add(MACHINE, "olga", "tuner", PASSWORD)
        browser = Browser(server.private_port)
        await browser.log_in("olga")
        token = await kept.tokens.add(MACHINE, "olga", "script")
        callers = server.gate.callers
        by_session = await _standing(callers, browser.cookie, is_session=True)
        by_token = await _standing(callers, token, is_session=False)
        assert Right.PARAMETERS in by_session.identity.rights
        await kept.directory.set_role(MACHINE, "olga", "viewer")
        for standing in (by_session, by_token):
            assert (await standing.renew()).rights == {Right.WATCH}
        await kept.tokens.revoke(MACHINE, "olga", "script")
        with pytest.raises(Exception, match="opens nothing"):
            await by_token.renew()
        await kept.directory.set_password(MACHINE, "olga", "another password")
        with pytest.raises(Exception, match="has ended"):
            await by_session.renew()


async def _standing(callers: Callers, secret: str, *, is_session: bool) -> Any:
    credential = Credential(secret, is_session=is_session, address="192.0.2.1")
    return await callers.standing(credential)
