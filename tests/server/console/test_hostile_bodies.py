"""Bodies that nobody should send: each is refused by name, and the server goes on."""

import json

from tests.server.conftest import Serving
from tests.server.console.operators import operator
from tests.server.http import get

SET = '{"op": "set_parameters", "scope": "world", "values": %s}'
BODIES = [
    b"",
    b"\xff\xfe",
    b"null",
    b"12",
    b'"set_parameters"',
    b"{}",
    b"[]",
    b"[" * 30_000,
    b'{"op":' * 5_000,
    b"[" + b",".join([b'{"op": "revert"}'] * 65) + b"]",
    b'[{"op": "revert"}, null]',
    (SET % '{"risk_weight": NaN}').encode(),
    (SET % '{"risk_weight": 1e999}').encode(),
    (SET % '{"risk_weight": true, "x": {}}').encode(),
    (SET % '{"max_expansions": 1e30}').encode(),
    (SET % ('{"risk_weight": ' + "9" * 5_000 + "}")).encode(),
    (SET % r'{"\ud800": 1}').encode(),
    (SET % r'{"risk_weight": -5}').encode(),
    rb'{"op": "announce", "text": "\ud800"}',
    rb'{"op": "announce", "text": "a\u0000b"}',
    rb'{"op": "revert", "note": "\u0000"}',
    b'{"op": "revert", "change": 99999999999999999999999999}',
    b'{"op": "kick", "person": 99999999999999999999999999}',
    b'{"op": "hold_actor", "actor": "../../etc"}',
    b'{"op": "set_behaviour", "actors": ["actor-1"], "behaviour": {"kind": ["go_to"]}}',
    b'{"op": "set_behaviour", "actors": ["actor-1"], "behaviour": {"kind": "go_to", "target": 3}}',
    rb'{"op": "send_actor", "actor": "actor-1", "target": "\ud800"}',
    b'{"op": "send_actor", "actor": "actor-1", "target": "no such place"}',
    b'{"op": "send_actor", "actor": "actor-1", "target": [1e5, 1e5, 1e5]}',
    b'{"op": "add_actors", "actors": [{"id": "actor-1"}]}',
    b'{"op": "add_actors", "actors": [{"id": "b"}, {"id": "main/b"}]}',
    b'{"op": "add_actors", "actors": [{"tags": ["No Tag"]}]}',
    b'{"op": "add_actors", "actors": [{"place": [1e5, 1e5, 0]}]}',
    b'{"op": "add_actors", "actors": [{"overrides": {"speed_mps": 3}}]}',
    b'{"op": "remove_actors", "actors": ["actor-1", "actor-1"]}',
]


async def test_each_is_refused_by_name_and_nothing_is_changed(serving: Serving) -> None:
    async with serving(actors=1) as server:
        anna = await operator(server, "anna", "admin")
        before = server.world.parameters("main/actor-1")
        headers = {
            "Authorization": f"Bearer {anna.token}",
            "X-Esplanade": "1",
            "Content-Type": "application/json",
        }
        unexpected = []
        for body in BODIES:
            path = "/api/v1/commands"
            answer = await get(server.private_port, path, headers, "POST", body)
            try:
                faults = json.loads(answer.body)["faults"]
            except (ValueError, KeyError):
                faults = answer.body
            named = isinstance(faults, list) and all(fault["text"] for fault in faults)
            if answer.status not in {400, 404, 409, 422} or not named:
                unexpected.append((body[:80], answer.status, faults))
        assert unexpected == []
        assert server.world.parameters("main/actor-1") == before
        assert server.world.count()[1] == 1
        assert (await anna.get("/actors/actor-1"))[0] == 200


async def test_hostile_paths_are_refused_too(serving: Serving) -> None:
    async with serving(actors=1) as server:
        anna = await operator(server, "anna", "admin")
        for path in (
            *("/actors/%00", "/actors/%ff", "/actors/", "/actors/../audit", "/actors/a/b/c"),
            *("/audit?limit=0", "/audit?limit=x", "/audit?after=1", "/audit?since_us=1e5"),
            *("/audit?since_us=99999999999999999999", "/audit?after=999999999999999999-1"),
            *("/audit?account=%00", "/audit?account=%ff", "/nothing"),
        ):
            headers = {"Authorization": f"Bearer {anna.token}"}
            answer = await get(server.private_port, f"/api/v1{path}", headers)
            assert answer.status in {200, 404, 422}, (path, answer)
