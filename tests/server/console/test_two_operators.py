"""Two operators who set, clear, take back and try at random: the world is as a plain model says."""

import asyncio
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, cast

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from esplanade.actors import ActorParameters
from esplanade.protocol.commands import COMMAND
from esplanade.server.accounts.identity import Identity
from esplanade.server.accounts.rights import ROLES
from esplanade.server.audit.log import AuditLog
from esplanade.server.console.console import Console
from esplanade.server.console.moderation import Moderation
from esplanade.server.console.refusals import RefusedError
from esplanade.server.store.location import Location
from esplanade.server.store.sql_store import open_store
from esplanade.server.world.inputs import SetParameters
from esplanade.server.world.zone import Zone
from tests.server.populated import Populated, spec

WHO = {
    name: Identity(account=name, role="tuner", rights=ROLES["tuner"], via="token t")
    for name in ("olga", "oleg")
}
SCOPES = ("world", "group:fast", "actor:main/a1", "actor:main/a2")
ACTORS: dict[str, tuple[str, ...]] = {"main/a1": ("fast",), "main/a2": ()}
NAMES = ["risk_weight", "speed_mps", "max_speed_mps"]
Acts = list[tuple[str, list[dict[str, Any]]]]


NOBODY = cast(Moderation, None)
"""A world without people, whom no command here is about."""


_values = st.dictionaries(
    st.sampled_from(NAMES), st.sampled_from([-1.0, 0.5, 1.0, 2.0, 3.5]), min_size=1
)
_commands = st.one_of(
    st.builds(
        lambda scope, values, dry: {
            "op": "set_parameters",
            "scope": scope,
            "values": values,
            "dry_run": dry,
        },
        st.sampled_from(SCOPES),
        _values,
        st.booleans(),
    ),
    st.builds(
        lambda scope, names: {"op": "clear_parameters", "scope": scope, "names": sorted(names)},
        st.sampled_from(SCOPES),
        st.sets(st.sampled_from(NAMES)),
    ),
    st.builds(
        lambda change: {"op": "revert", "change": change}, st.sampled_from(["latest", "undone"])
    ),
)


@dataclass
class Model:
    """Values by scope, and what each actor should have."""

    set_: dict[str, dict[str, float]] = field(default_factory=dict)

    def effective(self, actor: str, tags: tuple[str, ...], name: str, usual: float) -> float:
        for scope in (f"actor:{actor}", *(f"group:{tag}" for tag in reversed(tags)), "world"):
            if name in self.set_.get(scope, {}):
                return self.set_[scope][name]
        return usual

    def take(self, after: dict[str, dict[str, Any]]) -> None:
        for scope, values in after.items():
            for name, value in values.items():
                if value is None:
                    self.set_.get(scope, {}).pop(name, None)
                else:
                    self.set_.setdefault(scope, {})[name] = value


@pytest.fixture(scope="module")
def world() -> Iterator[Populated]:
    populated = Populated([spec(1, tags=["fast"]), spec(2)])
    populated.frame()
    yield populated
    populated.population.close()


@settings(max_examples=40, deadline=None)
@given(
    acts=st.lists(
        st.tuples(st.sampled_from(sorted(WHO)), st.lists(_commands, min_size=1, max_size=3)),
        max_size=12,
    )
)
def test_the_world_is_as_the_answers_say(world: Populated, acts: Acts) -> None:
    usual = ActorParameters().model_dump()
    fault = world.zone.check(SetParameters(0, tuple(ACTORS), usual))
    assert fault is None
    world.frame(SetParameters(0, tuple(ACTORS), usual))
    asyncio.run(_play(world, acts))


async def _play(world: Populated, acts: Acts) -> None:
    async with open_store(Location.of(None)) as store:
        console = Console(world.zone, NOBODY, store, AuditLog(store, "server"))
        ticking = asyncio.create_task(_tick(world, console))
        try:
            await _act(world.zone, console, acts)
        finally:
            ticking.cancel()


async def _tick(world: Populated, console: Console) -> None:
    while True:
        console.take(world.frame(*console.drain()))
        await asyncio.sleep(0.0)


async def _act(zone: Zone, console: Console, acts: Acts) -> None:
    model = Model()
    for who, given_ in acts:
        commands = [COMMAND.validate_python(each) for each in given_]
        before = [zone.parameters(actor) for actor in ACTORS]
        revision = console.changes.revision
        try:
            answers = await console.carry_out(WHO[who], commands)
        except RefusedError:
            changed = False
        else:
            changed = not commands[0].dry_run
            assert len({answer.tick for answer in answers}) == 1
            assert all((answer.command is not None) is changed for answer in answers)
        if not changed:
            assert [zone.parameters(actor) for actor in ACTORS] == before
            assert console.changes.revision == revision
            continue
        for answer in answers:
            model.take(answer.after)
        for actor, tags in ACTORS.items():
            found = zone.parameters(actor).model_dump()
            usual = ActorParameters().model_dump()
            for name in NAMES:
                assert found[name] == model.effective(actor, tags, name, usual[name])


async def test_a_dry_run_of_the_same_tells_the_same(world: Populated) -> None:
    async with open_store(Location.of(None)) as store:
        console = Console(world.zone, NOBODY, store, AuditLog(store, "server"))
        ticking = asyncio.create_task(_tick(world, console))
        command = {"op": "set_parameters", "scope": "group:fast", "values": {"risk_weight": 7}}
        tried, done = [
            (await console.carry_out(WHO["olga"], [COMMAND.validate_python(command | more)]))[0]
            for more in ({"dry_run": True}, {})
        ]
        ticking.cancel()
        told = {"before", "after", "price", "shadowed", "faults"}
        assert tried.model_dump(include=told) == done.model_dump(include=told)
