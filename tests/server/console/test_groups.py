"""Groups by purpose: at most one for each, values by group, undo."""

from esplanade.server.store.sql_store import SqlStore
from tests.server.console.consoles import desk
from tests.server.populated import Populated

HURRIED = {"op": "set_group", "group": "kind:hurried", "actors": ["a1", "a2"]}


async def test_values_of_a_group_hold_for_its_actors(world: Populated, memory: SqlStore) -> None:
    async with desk(world, memory) as at:
        risk = {"op": "set_parameters", "scope": "group:kind:hurried", "values": {"risk_weight": 4}}
        await at.send(risk)
        await at.send(HURRIED)
        assert [at.value(f"main/a{k}", "risk_weight") for k in (1, 2, 3)] == [4.0, 4.0, 9.5]
        await at.send({"op": "set_parameters", "scope": "group:fast", "values": {"risk_weight": 6}})
        assert at.value("main/a1", "risk_weight") == 4.0
        await at.send({**HURRIED, "actors": ["a1"], "remove": True})
        assert at.value("main/a1", "risk_weight") == 6.0
        await at.send({"op": "revert"})
        assert at.value("main/a1", "risk_weight") == 4.0


async def test_an_actor_has_one_group_for_a_purpose(world: Populated, memory: SqlStore) -> None:
    async with desk(world, memory) as at:
        await at.send(HURRIED)
        (answer,) = await at.send({**HURRIED, "group": "kind:calm", "actors": ["a2"]})
        assert answer.before == {"actor:main/a2": {"group:kind": "hurried"}}
        await at.send({**HURRIED, "group": "cohort:b", "actors": ["a2"]})
        assert at.console.state.groups.of("main/a2") == {"kind": "calm", "cohort": "b"}
        wrong = {**HURRIED, "actors": ["a1", "a2", "a9"], "remove": True}
        refused = await at.refused(wrong)
        assert [(fault.code, fault.path) for fault in refused.faults] == [
            ("not_in_group", [0, "actors", 1]),
            ("unknown_actor", [0, "actors", 2]),
        ]
        assert ("about", {"about": "groups"}) in at.told


async def test_an_actor_that_comes_back_is_in_its_group_again(
    world: Populated, memory: SqlStore
) -> None:
    async with desk(world, memory) as at:
        risk = {"op": "set_parameters", "scope": "group:kind:hurried", "values": {"risk_weight": 4}}
        await at.send(HURRIED, risk)
        await at.send({"op": "remove_actors", "actors": ["a2"]})
        assert at.console.state.groups.members() == {"kind:hurried": ["main/a1"]}
        await at.send({"op": "revert"})
        assert at.value("main/a2", "risk_weight") == 4.0
        groups = at.console.state.groups
        assert type(groups).load(groups.save()).members() == groups.members()
