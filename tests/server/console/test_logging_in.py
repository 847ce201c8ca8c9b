"""Logging in and out on the private port, the first account, passwords, passes and the page."""

import asyncio
import re
from pathlib import Path

import pytest

from esplanade.server.accounts.identity import MACHINE
from esplanade.server.accounts.lockout import WRONG
from esplanade.server.assets import SECURITY_HEADERS, Assets
from esplanade.server.audit.log import Filter
from tests.server.conftest import Serving, ServingAssets
from tests.server.console.browsers import PASSWORD, Browser, codes, logged_in
from tests.server.http import get


async def test_a_session_begins_with_a_password_and_ends_with_a_logout(serving: Serving) -> None:
    async with serving() as server:
        browser = await logged_in(server, "olga", "tuner")
        status, me = await browser.send("GET", "/me")
        assert (status, me["account"], me["role"], me["via"]) == (200, "olga", "tuner", "session")
        assert "parameters" in me["rights"]
        assert "accounts" not in me["rights"]
        assert (await browser.send("GET", "/world"))[0] == 200
        kept = browser.cookie
        answer = await browser.raw("POST", "/logout")
        assert answer.status == 204
        browser.cookie = kept
        status, body = await browser.send("GET", "/me")
        assert (status, codes(body)) == (401, ["unauthorized"])
        assert body["faults"][0]["arguments"] == {"first": False}
        rows = (await server.kept.audit.page(Filter(account="olga"))).rows
        assert [row.command for row in rows] == ["log_out", "log_in"]


async def test_the_cookie_is_out_of_reach_of_scripts_and_other_sites(serving: Serving) -> None:
    async with serving() as server:
        await server.kept.directory.add(MACHINE, "olga", "tuner", PASSWORD)
        browser = Browser(server.private_port)
        answer = await browser.raw("POST", "/login", {"name": "olga", "password": PASSWORD})
        words = {word.strip().lower() for word in answer.headers["set-cookie"].split(";")[1:]}
        assert words == {"httponly", "samesite=strict", "path=/api/v1", "max-age=43200"}
        assert answer.headers["cache-control"] == "no-store"
        assert browser.cookie not in answer.body.decode()


async def test_behind_a_proxy_the_cookie_goes_over_encrypted_connections_only(
    serving: Serving,
) -> None:
    async with serving(behind_proxy=True, private_names="ops.example.org") as server:
        await server.kept.directory.add(MACHINE, "olga", "tuner", PASSWORD)
        browser = Browser(server.private_port, "ops.example.org")
        page = {"Origin": "https://ops.example.org"}
        answer = await browser.raw("POST", "/login", {"name": "olga", "password": PASSWORD}, page)
        assert answer.status == 200
        assert "; secure" in answer.headers["set-cookie"].lower()


async def test_a_wrong_password_says_no_more_than_that_and_five_lock(serving: Serving) -> None:
    async with serving() as server:
        await server.kept.directory.add(MACHINE, "olga", "tuner", PASSWORD)
        browser = Browser(server.private_port)
        told = set()
        for name in ("olga", "nobody", "olga", "No Name", "olga"):
            status, body = await browser.log_in(name, "not the password")
            assert (status, codes(body)) == (401, ["wrong_password"])
            told.add(body["faults"][0]["text"])
        assert len(told) == 1
        answer = await browser.raw("POST", "/login", {"name": "olga", "password": PASSWORD})
        assert answer.status == 429
        assert 0 < int(answer.headers["retry-after"]) <= 60
        assert browser.cookie == ""


async def test_many_tries_at_once_are_no_way_around_the_lock(serving: Serving) -> None:
    async with serving() as server:
        await server.kept.directory.add(MACHINE, "olga", "tuner", PASSWORD)
        browsers = [Browser(server.private_port) for _ in range(24)]
        tries = [browser.log_in("olga", f"guess number {n}") for n, browser in enumerate(browsers)]
        answers = [status for status, _ in await asyncio.gather(*tries)]
        assert answers.count(401) == WRONG
        assert answers.count(429) == len(browsers) - WRONG
        rows = (await server.kept.audit.page(Filter(account="olga"))).rows
        assert len(rows) == WRONG


async def test_the_first_link_makes_one_admin_once(serving: Serving) -> None:
    async with serving() as server:
        token = await server.kept.one_time.first_link()
        assert token is not None
        browser = Browser(server.private_port)
        status, body = await browser.send("GET", "/me")
        assert (status, body["faults"][0]["arguments"]) == (401, {"first": True})
        given = {"token": token, "name": "anna", "password": "short"}
        status, body = await browser.send("POST", "/first", given)
        assert (status, codes(body)) == (422, ["password_length"])
        wrong = {**given, "token": "x" * 43, "password": PASSWORD}
        status, body = await browser.send("POST", "/first", wrong)
        assert (status, codes(body)) == (403, ["link"])
        status, me = await browser.send("POST", "/first", {**given, "password": PASSWORD})
        assert (status, me["account"], me["role"]) == (200, "anna", "admin")
        assert (await browser.send("GET", "/accounts"))[0] == 200
        again = {"token": token, "name": "eve", "password": PASSWORD}
        status, body = await Browser(server.private_port).send("POST", "/first", again)
        assert (status, codes(body)) == (403, ["link"])


async def test_another_password_ends_other_sessions_and_keeps_this_one(serving: Serving) -> None:
    async with serving() as server:
        browser = await logged_in(server, "olga", "tuner")
        other = Browser(server.private_port)
        await other.log_in("olga")
        new = "quite another password"
        status, body = await browser.send("POST", "/password", {"old": "a guess", "new": new})
        assert (status, codes(body), body["faults"][0]["path"]) == (
            422,
            ["wrong_old_password"],
            ["old"],
        )
        answer = await browser.raw("POST", "/password", {"old": PASSWORD, "new": new})
        assert answer.status == 204
        assert (await browser.send("GET", "/me"))[0] == 200
        assert (await other.send("GET", "/me"))[0] == 401
        assert (await other.log_in("olga"))[0] == 401
        assert (await other.log_in("olga", new))[0] == 200


async def test_a_pass_is_given_to_who_is_logged_in_only(serving: Serving) -> None:
    async with serving() as server:
        browser = await logged_in(server, "dora", "director")
        status, body = await browser.send("POST", "/passes")
        assert (status, body["seconds"]) == (200, 60)
        assert re.fullmatch(rf"http://localhost:{server.port}/#pass=[\w-]{{43}}", body["url"])
        token = await server.kept.tokens.add(MACHINE, "dora", "script")
        script = Browser(server.private_port, headers={"Authorization": f"Bearer {token}"})
        status, body = await script.send("POST", "/passes")
        assert (status, codes(body)) == (422, ["session_needed"])


@pytest.mark.parametrize("body", [{}, {"name": "olga"}, {"name": 1, "password": "x"}, [], "olga"])
async def test_what_is_no_login_is_refused_without_telling_it_again(
    serving: Serving, body: object
) -> None:
    async with serving() as server:
        status, told = await Browser(server.private_port).send("POST", "/login", body)
        assert status == 422
        assert set(codes(told)) == {"invalid"}


async def test_the_page_comes_with_its_assets_and_nothing_else(
    serving_assets: ServingAssets, tmp_path: Path
) -> None:
    (tmp_path / "assets").mkdir()
    files = {"index.html": "people", "console.html": "operators", "assets/a.js": "let a = 1;"}
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    async with serving_assets(Assets.load(tmp_path)) as server:
        port = server.private_port
        moved = await get(port, "/console")
        assert (moved.status, moved.headers["location"]) == (308, "/console/")
        page = await get(port, "/console/")
        assert (page.status, page.body) == (200, b"operators")
        for name, value in SECURITY_HEADERS.items():
            assert page.headers[name.lower()] == value
        script = await get(port, "/console/assets/a.js")
        assert script.headers["content-type"].startswith("text/javascript")
        known = {"If-None-Match": script.headers["etag"]}
        assert (await get(port, "/console/assets/a.js", known)).status == 304
        assert (await get(port, "/console/", method="HEAD")).body == b""
        assert (await get(port, "/console/", method="POST")).status == 405
        for path in ("index.html", "assets/b.js", "assets/../index.html", "%2e%2e/index.html"):
            assert (await get(port, f"/console/{path}")).status == 404, path
        for path in ("assets/%2e%2e/index.html", "assets/..%2findex.html", "//etc/passwd"):
            assert (await get(port, f"/console/{path}")).status == 404, path
        assert (await get(server.port, "/console/")).status == 404


async def test_a_page_that_is_not_built_says_how_to_build_it(serving: Serving) -> None:
    async with serving() as server:
        page = await get(server.private_port, "/console/")
        assert page.status == 503
        assert b"make client" in page.body
