"""The work of operators is there when a server comes back."""

from pathlib import Path

from tests.server.conftest import Serving
from tests.server.console.operators import Operator, operator


async def test_all_that_was_acknowledged_is_there_again(serving: Serving, tmp_path: Path) -> None:
    data = tmp_path / "world"
    async with serving(actors=2, data=data) as server:
        dora = await operator(server, "dora", "director")
        risk = {"op": "set_parameters", "scope": "group:kind:calm", "values": {"risk_weight": 4}}
        later = {"op": "schedule", "when": {"after_s": 3600}, "commands": [risk]}
        for command in (
            {"op": "set_group", "group": "kind:calm", "actors": ["actor-1"]},
            {**risk, "guard": {"figure": "people", "above": 500}},
            {"op": "save_preset", "name": "mine", "from_scope": "group:kind:calm"},
            later,
            {**later, "when": {"figure": {"name": "people", "above": 400}}},
            {"op": "cancel_schedule", "id": "s2"},
            {"op": "mark", "text": "closing time"},
        ):
            status, answer = await dora.send(command)
            assert status == 200, answer
        before = {path: await dora.get(path) for path in ("/groups", "/presets", "/changes")}
        _, schedules = await dora.get("/schedules")
        _, actor = await dora.get("/actors/actor-1")
        assert actor["parameters"]["risk_weight"]["group"] == "kind:calm"
    async with serving(actors=2, data=data) as server:
        dora = Operator(server.private_port, dora.token)
        for path in ("/groups", "/presets"):
            assert await dora.get(path) == before[path]
        _, found = await dora.get("/changes")
        assert [_told(change) for change in found["changes"]] == [
            _told(change) for change in before["/changes"][1]["changes"]
        ]
        _, again = await dora.get("/schedules")
        assert (again["schedules"], again["guards"]) == (
            schedules["schedules"],
            schedules["guards"],
        )
        assert (await dora.values("actor-1"))["risk_weight"] == 4.0
        number = next(c["number"] for c in found["changes"] if c["op"] == "set_parameters")
        status, answer = await dora.send({"op": "revert", "change": number})
        assert status == 200, answer
        assert (await dora.values("actor-1"))["risk_weight"] == 9.5


def _told(change: dict[str, object]) -> dict[str, object]:
    names = ("number", "account", "op", "before", "after", "note", "reverted_by", "can_revert")
    return {name: change[name] for name in names}
