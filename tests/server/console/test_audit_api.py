"""Readers of the audit see whether it is as it was written."""

from tests.server.conftest import Serving
from tests.server.console.browsers import codes, logged_in


async def test_the_chains_are_followed_and_their_ends_told(serving: Serving) -> None:
    async with serving() as server:
        anna = await logged_in(server, "anna", "admin")
        status, found = await anna.send("GET", "/audit/verify")
        assert status == 200
        assert found["faults"] == []
        _, page = await anna.send("GET", "/audit?limit=1")
        newest = page["rows"][0]
        ends = {chain["writer"]: chain["hash"] for chain in found["chains"]}
        assert ends[newest["writer"]] == newest["hash"]
        olga = await logged_in(server, "olga", "tuner")
        status, body = await olga.send("GET", "/audit/verify")
        assert (status, codes(body)) == (403, ["forbidden"])
