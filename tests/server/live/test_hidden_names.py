"""With `--hide-names`, no answer to an operator who does not moderate has the name of a person."""

import json
from typing import Final

from esplanade.protocol.messages import ChatLine
from tests.server.client import joined
from tests.server.conftest import Serving
from tests.server.console.operators import operator
from tests.server.live.consoles import live_console

NAME: Final = "Evelyn"
ANSWERS: Final = (
    "/world",
    "/people",
    "/actors",
    "/actors/actor-1",
    "/actors/actor-1/why",
    "/events?limit=500",
    "/changes",
    "/series",
    "/groups",
    "/schedules",
)


async def test_no_answer_to_a_viewer_has_the_name_of_a_person(serving: Serving) -> None:
    async with serving(hide_names=True, keep_chat=True, actors=1) as server:
        vera = await operator(server, "vera", "viewer")
        mo = await operator(server, "mo", "moderator")
        async with (
            live_console(server.private_port, vera.token) as console,
            joined(server.port, NAME) as eve,
        ):
            for channel in ("map", "events", "changes", "actor:actor-1"):
                await console.subscribe(channel)
            await eve.send(ChatLine(text="hello"))
            for command in (
                {"op": "warn", "person": eve.id, "text": "Please."},
                {"op": "mute", "person": eve.id, "seconds": 60, "note": "shouts"},
                {"op": "ban", "name_pattern": f"{NAME}*", "text": "No."},
            ):
                status, answer = await mo.send(command)
                assert status == 200, answer
            await console.until(lambda: "leave" in json.dumps(console.told) or None)
        for path in ANSWERS:
            status, answer = await vera.get(path)
            assert status == 200, path
            assert NAME not in json.dumps(answer), path
        assert NAME not in json.dumps(console.told)
        for path in ("/chat", "/reports", "/bans", "/audit"):
            assert (await vera.get(path))[0] == 403, path
