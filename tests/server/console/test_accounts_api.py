"""Accounts and tokens over HTTP, and what nobody may do with them."""

from esplanade.server.accounts.identity import MACHINE
from esplanade.server.accounts.rights import Right
from esplanade.server.audit.log import Filter
from tests.server.conftest import Serving
from tests.server.console.browsers import PASSWORD, Browser, codes, logged_in


async def test_an_admin_makes_changes_and_removes_accounts(serving: Serving) -> None:
    async with serving() as server:
        anna = await logged_in(server, "anna", "admin")
        new = {"name": "olga", "role": "tuner", "password": PASSWORD}
        assert (await anna.send("POST", "/accounts", new))[0] == 201
        status, body = await anna.send("POST", "/accounts", new)
        assert (status, codes(body)) == (409, ["taken"])
        olga = Browser(server.private_port)
        await olga.log_in("olga")
        assert (await anna.send("PATCH", "/accounts/olga", {"role": "viewer"}))[0] == 204
        assert (await olga.send("GET", "/me"))[1]["role"] == "viewer"
        other = {"password": "another password"}
        assert (await anna.send("PATCH", "/accounts/olga", other))[0] == 204
        assert (await olga.send("GET", "/me"))[0] == 401
        _, found = await anna.send("GET", "/accounts")
        assert [
            (each["name"], each["role"], each["has_password"]) for each in found["accounts"]
        ] == [
            ("anna", "admin", True),
            ("olga", "viewer", True),
        ]
        assert (await anna.send("DELETE", "/accounts/olga"))[0] == 204
        status, body = await anna.send("DELETE", "/accounts/olga")
        assert (status, codes(body)) == (404, ["unknown_account"])
        rows = (await server.kept.audit.page(Filter(account="anna"))).rows
        assert [row.command for row in rows] == [
            "user_remove",
            "user_password",
            "user_role",
            "user_add",
            "log_in",
        ]


async def test_a_token_is_told_once_and_revoked(serving: Serving) -> None:
    async with serving() as server:
        anna = await logged_in(server, "anna", "admin")
        await server.kept.directory.add(MACHINE, "olga", "tuner", None)
        body = {"name": "nightly", "rights": ["watch"], "expires_days": 7}
        status, made = await anna.send("POST", "/accounts/olga/tokens", body)
        assert status == 201
        script = Browser(server.private_port, headers={"Authorization": f"Bearer {made['token']}"})
        status, me = await script.send("GET", "/me")
        assert (status, me["via"], me["rights"]) == (200, "token", ["watch"])
        _, found = await anna.send("GET", "/accounts")
        (token,) = found["accounts"][1]["tokens"]
        assert (token["name"], token["rights"]) == ("nightly", ["watch"])
        assert token["last_us"] is not None
        assert made["token"] not in str(found)
        assert (await anna.send("DELETE", "/accounts/olga/tokens/nightly"))[0] == 204
        assert (await script.send("GET", "/me"))[0] == 401
        status, told = await anna.send("DELETE", "/accounts/olga/tokens/other")
        assert (status, codes(told)) == (404, ["unknown_token"])


async def test_nobody_removes_the_last_admin(serving: Serving) -> None:
    async with serving() as server:
        anna = await logged_in(server, "anna", "admin")
        for method, path, body in (
            ("DELETE", "/accounts/anna", None),
            ("PATCH", "/accounts/anna", {"role": "director"}),
        ):
            status, told = await anna.send(method, path, body)
            assert (status, codes(told)) == (409, ["last_admin"])
        await server.kept.directory.add(MACHINE, "berta", "admin", PASSWORD)
        assert (await anna.send("PATCH", "/accounts/anna", {"role": "director"}))[0] == 204
        assert (await anna.send("GET", "/accounts"))[0] == 403


async def test_a_token_for_accounts_alone_gives_nobody_more_than_it_has(serving: Serving) -> None:
    async with serving() as server:
        await server.kept.directory.add(MACHINE, "anna", "admin", PASSWORD)
        token = await server.kept.tokens.add(
            MACHINE, "anna", "few", rights=frozenset({Right.ACCOUNTS, Right.WATCH})
        )
        few = Browser(server.private_port, headers={"Authorization": f"Bearer {token}"})
        viewer = {"name": "vera", "role": "viewer"}
        assert (await few.send("POST", "/accounts", viewer))[0] == 201
        for method, path, body in (
            ("POST", "/accounts", {"name": "eve", "role": "admin", "password": PASSWORD}),
            ("PATCH", "/accounts/vera", {"role": "admin"}),
            ("PATCH", "/accounts/anna", {"password": "taken over by a token"}),
            ("PATCH", "/accounts/anna", {"role": "viewer"}),
            ("DELETE", "/accounts/anna", None),
            ("POST", "/accounts/anna/tokens", {"name": "all"}),
            ("DELETE", "/accounts/anna/tokens/few", None),
        ):
            status, told = await few.send(method, path, body)
            assert (status, codes(told)) == (403, ["beyond_reach"]), (method, path)


async def test_names_in_paths_are_names_and_nothing_else(serving: Serving) -> None:
    async with serving() as server:
        anna = await logged_in(server, "anna", "admin")
        for name in ("..%2fanna", "anna%00", "ANNA", "anna%20", "a" * 65, "%c3%a4"):
            status, _ = await anna.send("DELETE", f"/accounts/{name}")
            assert status in {404, 422}, name
        assert (await anna.send("GET", "/me"))[0] == 200
