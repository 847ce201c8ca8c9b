"""The channels beside the map, on real sockets of real servers."""

import asyncio
import base64
import json
from typing import Any

import numpy as np
import pytest

from esplanade.protocol.messages import ChatLine
from esplanade.server.world.stage_times import STAGES
from tests.patience import PATIENCE_S
from tests.server.client import joined
from tests.server.conftest import Serving
from tests.server.console.operators import Operator, operator
from tests.server.live.consoles import live_console


async def _until(vera: Operator, path: str, done: Any) -> Any:
    """Ask until an answer is as it should be."""
    async with asyncio.timeout(PATIENCE_S):
        while True:
            status, body = await vera.get(path)
            assert status == 200, body
            if done(body):
                return body
            await asyncio.sleep(0.1)


async def test_figures_come_each_second_and_can_be_asked_for_later(serving: Serving) -> None:
    async with serving(actors=2) as server, joined(server.port, "Eve"):
        vera = await operator(server, "vera", "viewer")
        async with live_console(server.private_port, vera.token) as console:
            await console.subscribe("series")
            told = await console.next("series")
            assert told["step_s"] == 1
            assert told["values"]["actors"] == 2
            assert told["values"]["people"] == 1
            assert told["values"]["tick_p99_ms"] >= told["values"]["tick_p50_ms"] > 0
            assert {f"stage_{name}_ms" for name in STAGES} <= told["values"].keys()
            shares = [v for name, v in told["values"].items() if name.startswith("share_")]
            assert sum(shares) == pytest.approx(1.0, abs=0.01)
        body = await _until(
            vera, "/series?names=people,actors&step_s=1", lambda found: len(found["at_us"]) >= 2
        )
        assert set(body["values"]) == {"people", "actors"}
        assert body["values"]["actors"][-1] == 2
        assert told["at_us"] in body["at_us"]
        _, names = await vera.get("/series/names")
        assert {"people", "contacts", "near_misses", "time_ratio"} <= {
            each["name"] for each in names["series"]
        }
        _, pinned = await vera.get("/series?actor=actor-1")
        assert set(pinned["values"]) == {"speed", "reason", "wait"}
        assert len(pinned["at_us"]) == len(pinned["values"]["speed"]) > 0
        assert (await vera.get("/series?names=nothing"))[0] == 422
        assert (await vera.get("/series?step_s=7"))[0] == 422


async def test_changes_and_marks_are_lines_in_all_series(serving: Serving) -> None:
    async with serving() as server:
        vera = await operator(server, "vera", "viewer")
        async with live_console(server.private_port, vera.token) as console:
            await console.subscribe("changes")
            await console.subscribe("events")
            await console.settled()
            change = {"number": 12, "op": "set_parameters", "account": "olga", "subjects": []}
            server.live.bulletin.heard("change", change)
            server.live.bulletin.heard("mark", {"text": "here", "account": "olga"})
            report = {"report": 1, "who": 3, "other": 4, "text": "pushes", "place": (1.0, 1.0, 0.0)}
            server.live.bulletin.heard("report", report)
            server.live.bulletin.heard("about", {"about": "presets"})
            assert (await console.next("changes", about="presets"))["channel"] == "changes"
            assert {"channel": "changes", "change": change} in console.told
            assert (await console.event("command"))["arguments"]["number"] == 12
            assert (await console.event("mark"))["text"] == "here"
            told = await console.event("report")
            assert (told["who"], told["other"], told["arguments"]) == (3, 4, {"report": 1})
            assert told["text"].endswith(": pushes")
        body = await _until(vera, "/series", lambda found: len(found["marks"]) == 2)
        assert [each["text"] for each in body["marks"]] == ["set_parameters", "here"]
        assert {each["account"] for each in body["marks"]} == {"olga"}


async def test_a_command_is_told_as_change_event_mark_and_group(serving: Serving) -> None:
    async with serving(actors=1) as server:
        olga = await operator(server, "olga", "director")
        async with live_console(server.private_port, olga.token) as console:
            for channel in ("changes", "events", "map"):
                await console.subscribe(channel)
            await console.settled()
            grouped = {"op": "set_group", "group": "kind:hurried", "actors": ["actor-1"]}
            status, answer = await olga.send({**grouped, "note": "queue"})
            assert status == 200, answer
            told = await console.until(
                lambda: next((each["change"] for each in console.told if "change" in each), None)
            )
            assert (told["op"], told["account"], told["note"]) == ("set_group", "olga", "queue")
            assert told["number"] == answer["command"]
            assert (await console.event("command"))["arguments"]["op"] == "set_group"
            await console.until(
                lambda: any(
                    "kind:hurried" in e.get("groups", []) for e in console.entities.values()
                )
            )
            status, _ = await olga.send({"op": "mark", "text": "here"})
            assert (await console.event("mark"))["text"] == "here"
        body = await _until(olga, "/series", lambda found: len(found["marks"]) == 2)
        assert [each["text"] for each in body["marks"]] == ["set_group", "here"]


async def test_a_guard_and_a_schedule_that_act_are_in_events_and_changes(serving: Serving) -> None:
    async with serving(actors=1) as server:
        olga = await operator(server, "olga", "tuner")
        async with live_console(server.private_port, olga.token) as console:
            await console.subscribe("events", kinds=["command"])
            await console.subscribe("changes")
            risk = {"op": "set_parameters", "scope": "world", "values": {"risk_weight": 12}}
            guard = {"figure": "actors", "above": 0, "for_s": 0}
            status, answer = await olga.send({**risk, "guard": guard})
            assert status == 200, answer
            why = f"guard g{answer['command']}: actors is 1, above 0"
            await console.event("command", text=f"olga: revert, {why}")
            status, answer = await olga.send(
                {"op": "schedule", "commands": [risk], "when": {"after_s": 0.1}}
            )
            assert status == 200, answer
            name = next(iter(answer["after"])).removeprefix("schedule:")
            await console.event("command", text=f"olga: set_parameters, schedule {name}")
        _, found = await olga.get("/changes")
        notes = [each["note"] for each in found["changes"]]
        assert why in notes
        assert f"schedule {name}" in notes


async def test_events_tell_who_came_spoke_and_left(serving: Serving) -> None:
    async with serving(hide_names=True) as server:
        vera = await operator(server, "vera", "viewer")
        mo = await operator(server, "mo", "moderator")
        async with (
            live_console(server.private_port, vera.token) as viewer,
            live_console(server.private_port, mo.token) as moderator,
        ):
            await viewer.subscribe("events", kinds=["join", "chat"])
            await moderator.subscribe("events")
            await viewer.settled()
            await moderator.settled()
            async with joined(server.port, "Eve") as eve:
                who = eve.id
                await eve.send(ChatLine(text="hello {other}"))
                assert (await moderator.event("join"))["text"] == "Eve came in"
                assert (await viewer.event("join"))["text"] == f"Person {who} came in"
                said = await viewer.event("chat", who=who)
                assert said["text"] == f"Person {who}: hello {{other}}"
                assert len(said["place"]) == 3
        _, body = await vera.get("/events?kind=join,chat")
        assert [each["kind"] for each in body["events"]] == ["chat", "join"]
        assert "Eve" not in json.dumps(body)
        _, body = await mo.get(f"/events?who={who}&limit=1")
        assert len(body["events"]) == 1


async def test_an_actor_is_told_with_its_plan(serving: Serving) -> None:
    async with serving(actors=1) as server:
        vera = await operator(server, "vera", "viewer")
        async with live_console(server.private_port, vera.token) as console:
            await console.subscribe("actor:actor-1", hz=10)
            await console.subscribe("actor:nobody")
            await console.subscribe("map.layers", ways=True, goals=True, circles=True)
            told = await console.next("actor:actor-1")
            assert told["id"] == server.world.avatar_of("main/actor-1")
            assert {"x", "y", "z", "reason", "path", "goal", "behaviour"} <= told.keys()
            assert all(len(point) == 4 for point in told["path"])
            told = await console.until(
                lambda: next((e for e in console.told if e["channel"] == "actor:nobody"), None)
            )
            assert told["faults"][0]["code"] == "unknown_actor"
            layers = await console.next("map.layers")
            assert all(len(point) == 3 for point in layers["ways"]["main/actor-1"])
            await console.send(unsubscribe="actor:actor-1")
            await console.send(unsubscribe="map.layers")
            async with asyncio.timeout(PATIENCE_S):
                while {"layers", "actor:main/actor-1"} & server.live.tap.probes.keys():  # noqa: ASYNC110 - of another thread
                    await asyncio.sleep(0.05)


async def test_why_says_who_holds_an_actor_and_for_how_long(serving: Serving) -> None:
    async with serving(actors=1) as server:
        olga = await operator(server, "olga", "director")
        held = {"op": "hold_actor", "actor": "actor-1", "held": True}
        assert (await olga.send(held))[0] == 200

        def stands(body: Any) -> bool:
            last = body["spans"][-1] if body["spans"] else {"reason": "", "seconds": 0}
            return last["reason"] in {"waiting", "giving_way"} and last["seconds"] > 0.5

        body = await _until(olga, "/actors/actor-1/why", stands)
        ends = [span["to_tick"] for span in body["spans"]]
        begins = [span["from_tick"] for span in body["spans"]]
        assert begins[1:] == ends[:-1], "spans follow each other without a gap"
        first, *_, last = body["moments"]
        assert first[0] <= begins[0] < last[0] <= body["tick"]
        _, later = await olga.get(f"/actors/actor-1/why?from_us={last[1] - 1}")
        assert isinstance(later, dict)
        assert [span["to_tick"] >= last[0] for span in later["spans"]] == [True]
        assert (await olga.get("/actors/nobody/why"))[0] == 404


async def test_heat_maps_are_told_for_each_storey(serving: Serving) -> None:
    async with serving(actors=3) as server:
        vera = await operator(server, "vera", "viewer")
        _, plan = await vera.get("/map")

        def warm(body: Any) -> bool:
            return _values(body["storeys"][0]).max() > 0

        body = await _until(vera, "/heat?kind=density&window_s=60", warm)
        storey = body["storeys"][0]
        assert len(body["storeys"]) == len(plan["storeys"])
        assert _values(storey).shape == (storey["width"] * storey["height"],)
        for kind in ("speed", "waiting", "contacts", "risk"):
            assert (await vera.get(f"/heat?kind={kind}&window_s=3600"))[0] == 200
        assert (await vera.get("/heat?kind=other"))[0] == 422
        assert (await vera.get("/heat?window_s=61"))[0] == 422


async def test_a_stream_tells_the_same_without_a_socket(serving: Serving) -> None:
    async with serving() as server:
        vera = await operator(server, "vera", "viewer")
        reader, writer = await asyncio.open_connection("127.0.0.1", server.private_port)
        writer.write(
            b"GET /api/v1/live.sse?channels=series,changes HTTP/1.1\r\nHost: localhost\r\n"
            b"Authorization: Bearer " + vera.token.encode() + b"\r\n\r\n"
        )
        async with asyncio.timeout(PATIENCE_S):
            head = await reader.readuntil(b"\r\n\r\n")
            assert b"200 OK" in head
            assert b"text/event-stream" in head
            while b'"channel": "series"' not in (line := await reader.readline()):
                pass
            assert json.loads(line.removeprefix(b"data: "))["values"]["people"] == 0
        writer.close()
        await writer.wait_closed()
        assert (await vera.get("/live.sse?channels=map"))[0] == 422
        async with asyncio.timeout(PATIENCE_S):
            while server.live.subscribers:  # noqa: ASYNC110 - of another thread
                await asyncio.sleep(0.05)


def _values(storey: Any) -> Any:
    return np.frombuffer(base64.b64decode(storey["values"]), "<f4")


async def test_a_world_that_stands_is_shown_all_the_same(serving: Serving) -> None:
    async with serving(actors=1) as server:
        olga = await operator(server, "olga", "director")
        status, answer = await olga.send({"op": "pace", "pause": True})
        assert status == 200, answer
        async with live_console(server.private_port, olga.token) as console:
            await console.subscribe("map")
            await console.subscribe("actor:actor-1")
            await console.subscribe("map.layers", goals=True)
            await console.until(lambda: console.records)
            told = await console.next("actor:actor-1")
            assert {told["id"]} == set(console.records)
            await console.next("map.layers")
        _, found = await olga.get("/events?kind=pace")
        assert [each["arguments"]["account"] for each in found["events"]] == ["olga"]
