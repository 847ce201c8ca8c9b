"""Commands over HTTP, on real servers: what they change, who may, and what is refused."""

import asyncio
import json
from typing import Any

import pytest

from esplanade.server.audit.log import Filter
from esplanade.server.audit.verifying import verify
from esplanade.server.store.store import StoreBusyError
from tests.server.conftest import Serving
from tests.server.console.operators import Operator, operator
from tests.server.http import get

RISK = {"op": "set_parameters", "scope": "world", "values": {"risk_weight": 12}}


def _codes(body: Any) -> list[tuple[str, list[Any]]]:
    return [(fault["code"], fault["path"]) for fault in body["faults"]]


async def test_a_change_of_the_world_shows_in_each_actor_and_where_it_comes_from(
    serving: Serving,
) -> None:
    async with serving(actors=2) as server:
        olga = await operator(server, "olga", "tuner")
        status, answer = await olga.send({**RISK, "note": "try"})
        assert (status, answer["faults"]) == (200, [])
        assert answer["before"] == {"world": {"risk_weight": None}}
        assert answer["after"] == {"world": {"risk_weight": 12.0}}
        assert answer["price"] == "tick"
        assert answer["revision"] == answer["command"]
        _, found = await olga.get("/actors/actor-1")
        assert found["id"] == "main/actor-1"
        assert found["parameters"]["risk_weight"] == {
            "value": 12.0,
            "level": "world",
            "group": None,
        }
        assert found["parameters"]["speed_mps"]["level"] == "own"
        assert found["parameters"]["foresight_s"]["level"] == "default"
        for actor in ("main/actor-1", "main/actor-2"):
            assert server.world.parameters(actor).risk_weight == 12.0


async def test_a_row_of_the_audit_is_there_before_the_tick_and_one_of_the_outcome_after(
    serving: Serving,
) -> None:
    async with serving(actors=1) as server:
        olga = await operator(server, "olga", "tuner")
        _, answer = await olga.send({**RISK, "note": "try"})
        page = await server.kept.audit.page(Filter(command="set_parameters"))
        outcome, asked = page.rows
        assert (asked.seq, asked.note, asked.account) == (answer["command"], "try", "olga")
        assert asked.body["after"] == {"world": {"risk_weight": 12.0}}
        assert asked.tick is not None
        assert asked.tick < answer["tick"]
        assert (outcome.refers_to, outcome.outcome) == (asked.seq, "done")
        assert outcome.tick == answer["tick"]
        assert all(chain.fault is None for chain in await verify(server.kept.store))


async def test_who_has_no_token_or_right_or_header_changes_nothing(serving: Serving) -> None:
    async with serving(actors=1) as server:
        olga = await operator(server, "olga", "tuner")
        viewer = await operator(server, "vera", "viewer")
        nobody = Operator(server.private_port, "esplanade_wrong")
        assert (await nobody.send(RISK))[0] == 401
        assert (await nobody.get("/world"))[0] == 401
        assert (await get(server.private_port, "/api/v1/world")).status == 401
        assert (await nobody.request("POST", "/commands", body=b"no json"))[0] == 401
        status, body = await viewer.send(RISK)
        assert (status, _codes(body)) == (403, [("forbidden", [])])
        assert body["faults"][0]["arguments"] == {"right": "parameters"}
        added = {"op": "add_actors", "actors": [{}]}
        assert (await olga.send(added))[0] == 403
        assert (await olga.get("/audit"))[0] == 403
        sent = await olga.request("POST", "/commands", body=json.dumps(RISK).encode())
        assert sent[0] == 403
        assert _codes(sent[1]) == [("header_missing", [])]
        assert server.world.parameters("main/actor-1").risk_weight == 9.5


@pytest.mark.parametrize(
    ("command", "status", "paths"),
    [
        ({"op": "rule"}, 422, [[]]),
        ({**RISK, "values": {}}, 422, [["values"]]),
        ({**RISK, "scope": "everywhere"}, 422, [["scope"]]),
        ({**RISK, "colour": "red"}, 422, [["colour"]]),
        (
            {**RISK, "values": {"risk_weight": -1, "risky_weight": 1}},
            422,
            [["values", "risk_weight"], ["values", "risky_weight"]],
        ),
        ({**RISK, "values": {"max_expansions": 70.5}}, 422, [["values", "max_expansions"]]),
        ({**RISK, "values": {"max_speed_mps": 0.2}}, 422, [["values", "speed_mps"]]),
        ({"op": "send_actor", "actor": "actor-9", "target": [1, 1, 0]}, 422, [["actor"]]),
        (
            {"op": "set_behaviour", "actors": ["actor-1"], "behaviour": {"kind": "fly"}},
            422,
            [["behaviour"]],
        ),
        ({"op": "move_door", "door": "nowhere", "open": True}, 422, [["door"]]),
        ({"op": "revert"}, 404, [["change"]]),
        ({"op": "revert", "change": 77}, 404, [["change"]]),
    ],
)
async def test_a_refusal_says_where_and_leaves_no_trace(
    serving: Serving, command: dict[str, Any], status: int, paths: list[list[Any]]
) -> None:
    async with serving(actors=1) as server:
        anna = await operator(server, "anna", "admin")
        before = server.world.parameters("main/actor-1")
        found, body = await anna.send(command)
        assert (found, [fault["path"] for fault in body["faults"]]) == (status, paths), body
        in_list, body = await anna.send([RISK, command])
        assert in_list == status
        assert [fault["path"] for fault in body["faults"]] == [[1, *path] for path in paths] or (
            "order" in str(body)
        )
        assert server.world.parameters("main/actor-1") == before
        rows = (await server.kept.audit.page(Filter(account="anna"))).rows
        assert rows == ()


async def test_a_dry_run_tells_the_price_and_changes_nothing(serving: Serving) -> None:
    async with serving(actors=1) as server:
        olga = await operator(server, "olga", "tuner")
        status, answer = await olga.send({**RISK, "dry_run": True})
        assert (status, answer["price"], answer["command"]) == (200, "tick", None)
        body = {**RISK, "values": {"radius_m": 0.3}, "dry_run": True}
        assert (await olga.send(body))[1]["price"] == "prepared"
        assert (await olga.send([RISK, body]))[0] == 422
        assert server.world.parameters("main/actor-1").risk_weight == 9.5
        assert (await server.kept.audit.page(Filter(account="olga"))).rows == ()


async def test_a_list_is_one_tick(serving: Serving) -> None:
    async with serving(actors=2) as server:
        dora = await operator(server, "dora", "director")
        commands = [
            RISK,
            {"op": "set_parameters", "scope": "actor:actor-2", "values": {"risk_weight": 3}},
            {"op": "hold_actor", "actor": "actor-1"},
            {"op": "set_behaviour", "actors": ["actor-2"], "behaviour": {"kind": "idle"}},
        ]
        status, answers = await dora.send(commands)
        assert status == 200, answers
        assert len({answer["tick"] for answer in answers}) == 1
        assert (await dora.values("actor-1"))["risk_weight"] == 12.0
        assert server.world.parameters("main/actor-2").risk_weight == 3.0
        _, found = await dora.get("/actors")
        assert [(each["behaviour"], each["held"]) for each in found["actors"]] == [
            ("wander", True),
            ("idle", False),
        ]


async def test_a_body_is_prepared_and_then_changed(serving: Serving) -> None:
    async with serving(actors=2) as server:
        olga = await operator(server, "olga", "tuner")
        status, answer = await olga.send({**RISK, "values": {"radius_m": 0.3}})
        assert (status, answer["price"]) == (200, "prepared")
        assert server.world.parameters("main/actor-2").radius_m == 0.3


async def test_undo_and_redo_are_changes_and_go_back_step_by_step(serving: Serving) -> None:
    async with serving(actors=1) as server:
        olga = await operator(server, "olga", "tuner")
        await olga.send(RISK)
        await olga.send({**RISK, "values": {"risk_weight": 14, "foresight_s": 4}})
        for risk_weight, foresight_s in ((12.0, 3.0), (9.5, 3.0)):
            assert (await olga.send({"op": "revert"}))[0] == 200
            values = await olga.values("actor-1")
            assert (values["risk_weight"], values["foresight_s"]) == (risk_weight, foresight_s)
        assert (await olga.send({"op": "revert"}))[0] == 404
        for risk_weight in (12.0, 14.0):
            assert (await olga.send({"op": "revert", "change": "undone"}))[0] == 200
            assert (await olga.values("actor-1"))["risk_weight"] == risk_weight
        assert (await olga.send({"op": "revert", "change": "undone"}))[0] == 404
        assert server.world.parameters("main/actor-1").foresight_s == 4.0


async def test_what_somebody_else_has_changed_since_is_not_taken_back(serving: Serving) -> None:
    async with serving(actors=1) as server:
        olga = await operator(server, "olga", "tuner")
        oleg = await operator(server, "oleg", "tuner")
        await olga.send(RISK)
        await oleg.send({**RISK, "values": {"risk_weight": 20}})
        status, body = await olga.send({"op": "revert"})
        assert (status, _codes(body)) == (409, [("conflict", ["change"])])
        assert body["faults"][0]["arguments"]["differences"] == [
            {
                "subject": "world",
                "field": "risk_weight",
                "before": None,
                "after": 12.0,
                "now": 20.0,
            }
        ]
        assert server.world.parameters("main/actor-1").risk_weight == 20.0


async def test_an_old_revision_is_refused_with_both_values(serving: Serving) -> None:
    async with serving(actors=1) as server:
        olga = await operator(server, "olga", "tuner")
        _, world = await olga.get("/world")
        known = world["revision"]
        await olga.send(RISK)
        late = {**RISK, "values": {"risk_weight": 5}, "if_revision": known}
        status, body = await olga.send(late)
        assert (status, _codes(body)) == (409, [("conflict", ["if_revision"])])
        (difference,) = body["faults"][0]["arguments"]["differences"]
        assert (difference["yours"], difference["now"]) == (5.0, 12.0)
        other = {**RISK, "values": {"foresight_s": 5}, "if_revision": known}
        assert (await olga.send(other))[0] == 200


async def test_actors_come_and_go_and_come_back(serving: Serving) -> None:
    async with serving(actors=1) as server:
        dora = await operator(server, "dora", "director")
        new = {"op": "add_actors", "actors": [{"tags": ["fast"], "overrides": {"speed_mps": 1.6}}]}
        status, answer = await dora.send([new, RISK])
        assert status == 200, answer
        assert server.world.parameters("main/actor-2").speed_mps == 1.6
        assert server.world.parameters("main/actor-2").risk_weight == 12.0
        group = {"op": "set_parameters", "scope": "group:fast", "values": {"risk_weight": 2}}
        assert (await dora.send(group))[0] == 200
        assert server.world.parameters("main/actor-2").risk_weight == 2.0
        assert server.world.parameters("main/actor-1").risk_weight == 12.0
        assert (await dora.send({"op": "remove_actors", "actors": ["actor-2"]}))[0] == 200
        assert (await dora.get("/actors/actor-2"))[0] == 404
        assert (await dora.send({"op": "revert"}))[0] == 200
        values = await dora.values("actor-2")
        assert (values["speed_mps"], values["risk_weight"]) == (1.6, 2.0)
        taken = {"op": "add_actors", "actors": [{"id": "actor-1"}]}
        assert (await dora.send(taken))[0] == 409


async def test_many_at_once_are_each_done_or_refused(serving: Serving) -> None:
    async with serving(actors=1) as server:
        olga = await operator(server, "olga", "tuner")
        commands = [{**RISK, "values": {"risk_weight": n}} for n in range(1, 41)]
        answers = await asyncio.gather(*(olga.send(each) for each in commands))
        done = [body for status, body in answers if status == 200]
        assert {status for status, _ in answers} <= {200, 503}
        last = max(done, key=lambda body: int(body["command"]))
        value = last["after"]["world"]["risk_weight"]
        assert server.world.parameters("main/actor-1").risk_weight == value


async def test_large_bodies_are_refused(serving: Serving) -> None:
    async with serving(actors=1) as server:
        olga = await operator(server, "olga", "tuner")
        fields = {
            "Authorization": f"Bearer {olga.token}",
            "X-Esplanade": "1",
            "Content-Type": "application/json",
        }
        body = json.dumps({**RISK, "note": "x" * 70_000}).encode()
        path = "/api/v1/commands"
        answer = await get(server.private_port, path, fields, "POST", body)
        assert answer.status == 413


async def test_the_interface_describes_itself(serving: Serving) -> None:
    async with serving(actors=0) as server:
        olga = await operator(server, "olga", "tuner")
        answer = await get(server.private_port, "/openapi.json")
        paths = json.loads(answer.body)["paths"]
        assert {"/api/v1/commands", "/api/v1/actors/{actor_id}", "/api/v1/audit"} <= set(paths)
        _, schema = await olga.get("/schema")
        assert schema["parameters"]["properties"]["risk_weight"]["unit"] == "s/s"
        assert set(schema["commands"]["discriminator"]["mapping"]) >= {"set_parameters", "revert"}


async def test_an_admin_pages_through_the_audit(serving: Serving) -> None:
    async with serving(actors=1) as server:
        anna = await operator(server, "anna", "admin")
        for _ in range(3):
            await anna.send(RISK)
        seen: list[int] = []
        after = ""
        while True:
            status, page = await anna.get(f"/audit?account=anna&limit=2{after}")
            assert status == 200, page
            seen += [row["seq"] for row in page["rows"]]
            if page["next"] is None:
                break
            after = f"&after={page['next']}"
        assert len(seen) == 6
        assert seen == sorted(seen, reverse=True)


async def test_what_cannot_be_written_into_the_audit_is_not_carried_out(
    serving: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with serving(actors=1) as server:
        olga = await operator(server, "olga", "tuner")
        assert (await olga.get("/world"))[0] == 200

        async def full(_: Any) -> None:
            raise StoreBusyError("the disk is full")

        with monkeypatch.context() as patch:
            patch.setattr(server.kept.store, "write", full)
            status, body = await olga.send(RISK)
        assert (status, _codes(body)) == (503, [("busy", [])])
        assert server.world.parameters("main/actor-1").risk_weight == 9.5
        assert (await olga.send(RISK))[0] == 200


async def test_a_refusal_in_the_tick_itself_is_told_and_written_down(
    serving: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with serving(actors=1) as server:
        anna = await operator(server, "anna", "admin")
        monkeypatch.setattr(server.world, "check", lambda command: None)
        low = {**RISK, "values": {"max_speed_mps": 0.2}}
        status, body = await anna.send(low)
        assert (status, _codes(body)) == (422, [("values", ["values", "speed_mps"])])
        _, page = await anna.get("/audit?command=set_parameters")
        assert [row["outcome"] for row in page["rows"]] == ["refused", ""]
        _, found = await anna.get("/parameters")
        assert "world" not in found["scopes"]
