"""The Python client against real servers, and its faults."""

import pytest

from esplanade import operators
from esplanade.operators import RefusedError, UnreachableError
from tests.server.conftest import Serving, room_file, serving, serving_assets
from tests.server.console.operators import operator

__all__ = ["room_file", "serving", "serving_assets"]


async def test_a_script_sets_takes_back_and_makes_anew(serving: Serving) -> None:
    async with serving(actors=2) as server:
        token = (await operator(server, "olga", "tuner")).token
        url = f"http://127.0.0.1:{server.private_port}"
        async with operators.connect(url, token) as op:
            answer = await op.set(actor="actor-1", risk_weight=12, note="queue")
            assert answer.after == {"actor:main/actor-1": {"risk_weight": 12.0}}
            assert (await op.actor("actor-1"))["parameters"]["risk_weight"]["level"] == "own"
            assert (await op.undo()).after == {"actor:main/actor-1": {"risk_weight": None}}
            assert (await op.redo()).after == answer.after
            assert [actor["id"] for actor in await op.actors()] == ["main/actor-1", "main/actor-2"]
            both = await op.send_all(
                {"op": "set_parameters", "scope": "world", "values": {"foresight_s": 4}},
                {"op": "hold_actor", "actor": "actor-2"},
            )
            assert both[0].tick == both[1].tick
            dry = await op.set(foresight_s=5, dry_run=True)
            assert dry.command is None
        assert server.world.parameters("main/actor-2").foresight_s == 4.0


async def test_a_refusal_tells_status_places_and_differences(serving: Serving) -> None:
    async with serving(actors=1) as server:
        url = f"http://127.0.0.1:{server.private_port}"
        token = (await operator(server, "olga", "tuner")).token
        async with operators.connect(url, token) as op:
            with pytest.raises(RefusedError, match=r"values\.risk_weight") as refused:
                await op.set(risk_weight=-3)
            assert refused.value.status == 422
            revision = (await op.world())["revision"]
            await op.set(risk_weight=3)
            with pytest.raises(RefusedError, match=r"now 3\.0, yours 4\.0") as refused:
                await op.set(risk_weight=4, if_revision=revision)
            assert refused.value.status == 409


async def test_a_wrong_token_and_a_wrong_address_are_told_apart(serving: Serving) -> None:
    async with serving() as server:
        with pytest.raises(RefusedError, match="token") as refused:
            async with operators.connect(f"http://127.0.0.1:{server.private_port}", "wrong"):
                pass
        assert refused.value.status == 401
    with pytest.raises(UnreachableError, match="refused"):
        async with operators.connect("http://127.0.0.1:1", "wrong"):
            pass
    with pytest.raises(UnreachableError, match="no address"):
        async with operators.connect("file:///etc/passwd", "wrong"):
            pass


async def test_a_script_works_with_presets_groups_schedules_and_actors(serving: Serving) -> None:
    async with serving(actors=2) as server:
        token = (await operator(server, "dora", "director")).token
        url = f"http://127.0.0.1:{server.private_port}"
        async with operators.connect(url, token) as op:
            await op.group("kind:slow", "actor-1")
            await op.apply_preset("museum-guide", group="kind:slow")
            assert (await op.actor("actor-1"))["parameters"]["risk_weight"]["group"] == "kind:slow"
            await op.save_preset("mine", from_scope="group:kind:slow", note="as it is now")
            assert (await op.preset("mine"))["by"] == "dora"
            assert "mine" in [each["name"] for each in await op.presets()]
            await op.delete_preset("mine")
            assert [each["group"] for each in await op.groups()] == ["kind:slow"]
            added = await op.add({"id": "extra", "behaviour": {"kind": "idle"}})
            assert added.price == "prepared"
            await op.behave("wander", "extra")
            await op.hold("extra")
            await op.send_actor("extra", (1.0, 1.0, 0.0))
            await op.remove("extra")
            await op.announce("hello")
            await op.mark("now")
            later = {"op": "clear_parameters", "scope": "world"}
            await op.schedule(later, when={"after_s": 3600.0})
            (made,) = (await op.schedules())["schedules"]
            await op.cancel(made["id"])
            await op.set(risk_weight=4)
            await op.clear("risk_weight")
            changes = await op.changes(3)
            assert [each["op"] for each in changes] == [
                *("clear_parameters", "set_parameters", "cancel_schedule"),
            ]
            undone = await op.undo(anybody=True)
            assert undone.after == {"world": {"risk_weight": 4.0}}
            diff = await op.diff("default", f"world@{changes[0]['number']}", "world")
            assert diff["columns"][2] == "world"
            assert await op.people() == []
