"""Bots outlive additions to the protocol."""

import msgpack
import pytest
from websockets.asyncio.server import ServerConnection

from esplanade import bots
from esplanade.protocol import encode
from tests.bots.scripted import ScriptedServer, listening, scripted_server, until


async def test_a_bot_goes_on_and_keeps_the_newest_token() -> None:
    async with scripted_server() as server, bots.connect(server.url, name="Ann") as bot:
        (person,) = server.all_people
        await person.socket.send(msgpack.packb([99, {"what": 1}]))
        await person.socket.send(msgpack.packb([70, {"error": "of_tomorrow", "text": "wait"}]))
        again = server.welcome(person).model_copy(update={"resume": "token-next"})
        await person.socket.send(encode(again))
        await until(lambda: bot.resume_token == "token-next")
        tick = bot.tick
        await until(lambda: bot.tick > tick)


class Tomorrow(ScriptedServer):
    """Refuses everyone for a reason that is not known yet, after a message that is not either."""

    async def talk(self, socket: ServerConnection) -> None:
        await socket.send(msgpack.packb([99, {}]))
        await socket.send(msgpack.packb([70, {"error": "of_tomorrow", "text": "wait"}]))
        await socket.wait_closed()


async def test_a_refusal_of_a_later_version_has_its_name() -> None:
    async with listening(Tomorrow()) as server:
        with pytest.raises(bots.Refused, match="wait") as refused:
            async with bots.connect(server.url):
                pass
        assert refused.value.code == "of_tomorrow"
