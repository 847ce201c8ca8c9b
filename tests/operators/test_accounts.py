"""Accounts, tokens, invitations and bots by the Python client and on the command line."""

import asyncio
import os
import subprocess
import sys

import pytest

from esplanade.operators import RefusedError, connect
from tests.patience import PATIENCE_S
from tests.server.conftest import Serving, room_file, serving, serving_assets
from tests.server.console.operators import operator

__all__ = ["room_file", "serving", "serving_assets"]


async def test_an_admin_sees_to_accounts_in_python(serving: Serving) -> None:
    async with serving() as server:
        token = (await operator(server, "anna", "admin")).token
        url = f"http://127.0.0.1:{server.private_port}"
        async with connect(url, token) as op:
            await op.accounts.add("olga", "tuner", "a long password")
            await op.accounts.set_role("olga", "viewer")
            made = await op.accounts.add_token("olga", "report", rights=["watch"], days=1)
            found = {account["name"]: account for account in await op.accounts.list()}
            assert found["olga"]["role"] == "viewer"
            assert [each["name"] for each in found["olga"]["tokens"]] == ["report"]
            async with connect(url, made) as other:
                with pytest.raises(RefusedError) as refused:
                    await other.accounts.list()
                assert refused.value.status == 403
            await op.accounts.revoke_token("olga", "report")
            with pytest.raises(RefusedError):
                async with connect(url, made):
                    pass
            assert "#invitation=" in await op.accounts.invite(uses=3, label="class")
            assert (await op.accounts.add_bot("crowd", connections=5)).startswith("esplanade_bot_")
            await op.accounts.set_password("olga", "another long password")
            await op.accounts.remove("olga")
            with pytest.raises(RefusedError, match="no account"):
                await op.accounts.remove("olga")


async def test_an_admin_sees_to_accounts_on_the_command_line(serving: Serving) -> None:
    async with serving() as server:
        token = (await operator(server, "anna", "admin")).token
        url = f"http://127.0.0.1:{server.private_port}"

        async def run(*words: str, given: str = "") -> subprocess.CompletedProcess[str]:
            return await asyncio.to_thread(
                subprocess.run,
                [sys.executable, "-m", "esplanade", "op", *words],
                input=given,
                env={**os.environ, "ESPLANADE_URL": url, "ESPLANADE_TOKEN": token},
                capture_output=True,
                text=True,
                timeout=PATIENCE_S,
                check=False,
            )

        add = ("account", "add", "olga", "--role", "tuner", "--password-stdin")
        made = await run(*add, given="a long password\n")
        assert (made.returncode, made.stdout) == (0, ""), made.stderr
        assert (await run("account", "role", "olga", "viewer")).returncode == 0
        listed = (await run("account", "list")).stdout
        assert [word for word in ("olga", "viewer", "anna", "admin") if word not in listed] == []
        invited = await run("invite", "--uses", "2", "--hours", "1")
        assert "#invitation=" in invited.stdout
        refused = await run("account", "remove", "nobody")
        assert refused.returncode == 1
        assert "there is no account 'nobody'" in refused.stderr
