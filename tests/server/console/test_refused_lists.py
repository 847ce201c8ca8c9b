"""A refused list of commands leaves no trace: in the planner, in actors, or in what is set."""

import asyncio
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from esplanade.protocol.commands import COMMAND
from esplanade.server.audit.log import AuditLog, Filter
from esplanade.server.console.console import Console
from esplanade.server.console.preset_folder import read_presets
from esplanade.server.console.presets import Presets
from esplanade.server.console.refusals import RefusedError
from esplanade.server.store.location import Location
from esplanade.server.store.sql_store import open_store
from tests.server.console.consoles import Nobody, tuner
from tests.server.populated import Populated, spec

RIGHT: list[dict[str, Any]] = [
    {"op": "set_parameters", "scope": "world", "values": {"risk_weight": 12}},
    {"op": "set_parameters", "scope": "group:kind:calm", "values": {"speed_mps": 1.2}},
    {"op": "set_parameters", "scope": "actor:a1", "values": {"radius_m": 0.3}},
    {"op": "set_parameters", "scope": "world", "values": {"risk_weight": 20}, "over_s": 5},
    {"op": "clear_parameters", "scope": "world"},
    {"op": "apply_preset", "scope": "group:fast", "preset": "timid"},
    {"op": "save_preset", "name": "mine", "values": {"risk_weight": 12}},
    {"op": "set_group", "group": "kind:calm", "actors": ["a1", "a2"]},
    {"op": "set_behaviour", "actors": ["a1"], "behaviour": {"kind": "wander"}},
    {"op": "hold_actor", "actor": "a2"},
    {"op": "send_actor", "actor": "a3", "target": "east"},
    {"op": "add_actors", "actors": [{"behaviour": {"kind": "idle"}, "tags": ["new"]}]},
    {"op": "remove_actors", "actors": ["a3"]},
    {"op": "move_door", "door": "gate", "open": False},
    {"op": "announce", "text": "hello"},
    {"op": "mark", "text": "now"},
    {
        "op": "schedule",
        "when": {"after_s": 60},
        "commands": [{"op": "clear_parameters", "scope": "world"}],
    },
]
WRONG: list[dict[str, Any]] = [
    {"op": "set_parameters", "scope": "actor:a1", "values": {"risk_weight": -1}},
    {"op": "set_parameters", "scope": "world", "values": {"speed_mps": 2.9, "max_speed_mps": 0.2}},
    {"op": "set_parameters", "scope": "world", "values": {"wall_weight": 1}, "if_revision": 0},
    {"op": "set_parameters", "scope": "world", "values": {"radius_m": 0.3}, "over_s": 5},
    {"op": "apply_preset", "scope": "world", "preset": "bold"},
    {"op": "delete_preset", "name": "timid"},
    {"op": "save_preset", "name": "other", "values": {"speed_mps": 3.0}},
    {"op": "set_group", "group": "kind:calm", "actors": ["a9"]},
    {"op": "set_behaviour", "actors": ["a1"], "behaviour": {"kind": "go_to", "target": "nowhere"}},
    {"op": "send_actor", "actor": "a1", "target": [1000.0, 1000.0, 0.0]},
    {"op": "add_actors", "actors": [{"id": "a1"}]},
    {"op": "add_actors", "actors": [{"overrides": {"speed_mps": 2.5}}]},
    {"op": "remove_actors", "actors": ["a9"]},
    {"op": "move_door", "door": "nowhere", "open": True},
    {"op": "kick", "person": 1},
    {"op": "cancel_schedule", "id": "s7"},
    {"op": "revert", "change": 999},
    {"op": "schedule", "when": {"at_tick": 1}, "commands": [{"op": "mark", "text": "late"}]},
]


class Listening(Nobody):
    """A world without people, in which announcements are counted."""

    announced = 0

    def announce(self, text: str, people: Iterable[int]) -> int:
        self.announced += 1
        return 0


@pytest.fixture(scope="module")
def three() -> Iterator[Populated]:
    world = Populated([spec(1, tags=["fast"]), spec(2), spec(3)], outside=True)
    world.frame()
    yield world
    world.population.close()


@settings(max_examples=60, deadline=None, derandomize=True)
@given(
    before=st.lists(st.sampled_from(RIGHT), max_size=3),
    wrong=st.sampled_from(WRONG),
    after=st.lists(st.sampled_from(RIGHT), max_size=2),
)
def test_a_refused_list_leaves_no_trace(
    three: Populated,
    before: list[dict[str, Any]],
    wrong: dict[str, Any],
    after: list[dict[str, Any]],
) -> None:
    # One preset that is saved twice would be a second fault.
    assume(sum(each["op"] == "save_preset" for each in (*before, *after)) <= 1)
    asyncio.run(_refused(three, [*before, wrong, *after], len(before)))


async def _refused(world: Populated, given_: list[dict[str, Any]], place: int) -> None:
    async with open_store(Location.of(None)) as store:
        audit, people = AuditLog(store, "server"), Listening()
        console = Console(world.zone, people, store, audit, presets=Presets(read_presets(None)))
        console.changes.revision = 5
        console.changes._touched["wall_weight"] = 5
        found = _all_of_it(world, console)
        commands = [COMMAND.validate_python(each) for each in given_]
        sending = asyncio.create_task(console.carry_out(tuner("olga"), commands))
        while not sending.done():
            console.take(world.frame(*console.drain()))
            await asyncio.sleep(0.001)
        with pytest.raises(RefusedError) as refused:
            await sending
        paths = [fault.path[:1] for fault in refused.value.faults]
        # A fault that the world finds with all of it together has no place. An actor that comes in
        # with values that do not go together is refused where it comes in.
        newcomers = [index for index, each in enumerate(given_) if each["op"] == "add_actors"]
        places = [[place], [], ["values"], *([index] for index in newcomers if index > place)]
        assert any(path in places for path in paths)
        world.frames(3)
        assert _all_of_it(world, console) == found
        assert (await audit.page(Filter())).rows == ()
        assert people.announced == 0
        await console.close()


def _all_of_it(world: Populated, console: Console) -> dict[str, Any]:
    """All that commands could change."""
    zone, state = world.zone, console.state
    table = world.population.table
    actors = sorted(zone.actors, key=str)
    rows = [table.row(actor) for actor in actors]
    return {
        "specs": {actor: zone.actors[actor] for actor in actors},
        "held": [world.population.held(actor) for actor in actors],
        "planner": table.agents.parameters[rows].tobytes(),
        "kinds of body": len(world.population.grid._rows.all()),
        "waiting": zone.commands_waiting,
        "avatars": zone.state.ids[zone.state.live()].tolist(),
        "bodies": np.round(zone.state.radii[zone.state.live()], 6).tolist(),
        "doors": (zone.doors.states(), zone.doors.waiting()),
        "overrides": dict(state.overrides.values),
        "groups": state.groups.save(),
        "presets": [preset.plain() for preset in state.presets.all()],
        "schedules": [each.plain() for each in state.schedules],
        "guards": list(console.scheduler.guards),
        "held wishes": set(state.held),
        "changes": console.changes.save(),
        "ongoing": console.ongoing.under_way,
    }
